//! `maquette freeze`: a node's inputs and outputs as a golden file.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use command::maquette;
use maquette_graph::freeze::Golden;
use tempfile::TempDir;

#[test]
fn a_node_is_frozen_updated_and_runs_without_its_graph() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("hem.ron");
    let name = path.to_str().unwrap();
    let (code, out, said) = maquette(&["freeze", "graphs/vest.ron", "hem", "-o", name, "--absolute", "0.5"]);
    assert!(code == 0 && out.starts_with(&format!("wrote {name} (")), "{code} {out} {said}");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.contains("from: \"node \\\"hem\\\" of vest.ron\"") && text.contains("(absolute: 0.5, relative: 1e-9)")
    );
    let catalogue = maquette_nodes::catalogue().unwrap();
    assert_eq!(Golden::from_text(&text).unwrap().differences(&catalogue).unwrap(), []);

    let (code, out, _) = maquette(&["freeze", "--update", name]);
    assert_eq!((code, out), (0, format!("{name}: unchanged\n")));
    // What it gave once was something else, by more than the tolerance.
    let (head, outputs) = text.split_once("outputs:").unwrap();
    let spoilt = format!(
        "{head}outputs:{}",
        outputs.replacen('(', "(9", 1).replacen("Points([", "Points([(7.0, 7.0, 7.0), ", 1)
    );
    std::fs::write(&path, spoilt.replacen("(9\"", "(\"", 1)).unwrap();
    let golden = Golden::from_text(&std::fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(golden.differences(&catalogue).unwrap().len(), 1);
    assert_eq!(maquette(&["freeze", "--update", name]).0, 0);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
}

#[test]
fn values_can_be_put_first_and_stdout_takes_the_file() {
    let (code, out, _) = maquette(&["freeze", "graphs/neck.ron", "even contours", "--set", "even contours.count=5"]);
    assert_eq!(code, 0);
    assert!(out.contains("from: \"node \\\"even contours\\\" of neck.ron, even contours.count=5\""), "{out}");
    assert!(out.contains("(\"count\", Integers([5]))"), "{out}");
    let golden = Golden::from_text(&out).unwrap();
    assert_eq!(golden.differences(&maquette_nodes::catalogue().unwrap()).unwrap(), []);
}

#[test]
fn what_can_not_be_frozen_says_why() {
    for (arguments, code, wanted) in [
        (&["freeze", "graphs/vest.ron", "hemm"][..], 2, "no node is named \"hemm\"; did you mean \"hem\"?"),
        (&["freeze", "graphs/none.ron", "hem"], 2, "there is no such file"),
        (
            &["freeze", "graphs/vest.ron", "body", "--set", "body.snap=1e-9"],
            1,
            "the node has no result: input \"rails\"",
        ),
        (&["freeze", "graphs/vest.ron", "hem", "--relative", "-1"], 2, ""),
        (&["freeze", "graphs/vest.ron"], 2, ""),
        (&["freeze", "--update", "graphs/vest.ron"], 2, "this is no golden file"),
        (&["freeze", "graphs/vest.ron", "hem", "-o", "no/such/folder.ron"], 3, "the folder does not exist"),
    ] {
        let (found, _, said) = maquette(arguments);
        assert!(found == code && said.contains(wanted), "{arguments:?}: {found} {said}");
    }
}
