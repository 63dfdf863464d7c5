//! `run --hashes`, `verify` and `run --fail-if`: sameness proved, limits kept.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use command::{SKETCH, file, maquette, str};
use tempfile::TempDir;

#[test]
fn hashes_agree_across_runs_and_threads() {
    let folder = TempDir::new().unwrap();
    for name in ["vest", "head", "neck", "leg"] {
        let graph = format!("graphs/{name}.ron");
        let hashes = folder.path().join(format!("{name}.ron"));
        assert_eq!(maquette(&["run", &graph, "-q", "--threads", "1", "--hashes", str(&hashes)]).0, 0);
        for threads in ["1", "2", "8"] {
            let (code, out, error) = maquette(&["verify", &graph, "--against", str(&hashes), "--threads", threads]);
            assert_eq!((code, error.as_str()), (0, ""));
            assert!(out.contains("nodes are the same as in"), "{out}");
        }
    }
}

#[test]
fn hashes_go_to_stdout_as_well_and_every_node_has_one() {
    let folder = TempDir::new().unwrap();
    let graph = file(&folder, "g.ron", SKETCH);
    let hashes = folder.path().join("hashes.ron");
    let (code, out, _) = maquette(&["run", str(&graph), "--hashes"]);
    assert_eq!(code, 0);
    let (_, said, _) = maquette(&["run", str(&graph), "--hashes", str(&hashes)]);
    assert!(said.contains("wrote") && said.contains("hashes.ron"), "{said}");
    assert_eq!(std::fs::read_to_string(&hashes).unwrap(), out);
    let names: Vec<_> = out.lines().filter(|line| line.contains("name:")).collect();
    assert_eq!(names.len(), 3);
    assert!(names[0].contains("\"line\", kind: \"sketch\"") && names[2].contains("\"lines\""), "{out}");
    assert!(out.lines().any(|line| line.trim().len() == "\"curves\": \"\",".len() + 32), "{out}");
}

#[test]
fn the_first_node_that_differs_in_the_order_of_evaluation_is_named() {
    let folder = TempDir::new().unwrap();
    let hashes = folder.path().join("hashes.ron");
    let graph = file(&folder, "g.ron", SKETCH);
    maquette(&["run", str(&graph), "-q", "--hashes", str(&hashes)]);
    let verify = |graph: &str, options: &[&str]| {
        let path = file(&folder, "other.ron", graph);
        maquette(&[&["verify", str(&path), "--against", str(&hashes)], options].concat())
    };
    let (code, _, said) = verify(SKETCH, &["--set", "even.count=17"]);
    assert_eq!(code, 1);
    let lines: Vec<_> = said.lines().collect();
    assert!(
        lines[0].contains("error: node \"even\": output \"curves\" is ") && lines[0].contains(" and was "),
        "{said}"
    );
    assert!(lines.len() == 2 && lines[1].starts_with("1 more differ"), "{said}");

    // Last in the file, first in the order of evaluation.
    let start = SKETCH.find("        \"line\": (").unwrap();
    let end = SKETCH.find("        \"even\": (").unwrap();
    let line = SKETCH[start..end].replace("(0.1, 0.0)", "(0.1, 0.01)");
    let turned = format!(
        "{}    }},\n)\n",
        SKETCH[..SKETCH.find("    },\n    layout").unwrap()].replace(&SKETCH[start..end], "") + &line
    );
    let (code, _, said) = verify(&turned, &[]);
    assert!(code == 1 && said.lines().next().unwrap().contains("node \"line\""), "{said}");

    let (code, _, said) =
        verify(&SKETCH.replace("kind: \"resample\"", "kind: \"smooth\"").replace("\"count\": 16,", ""), &[]);
    assert!(code == 1 && said.contains("its kind is smooth here and was resample there"), "{said}");
    let (code, _, said) = verify(&SKETCH.replace("Link(\"even.curves\")", "Link(\"line.curves\")"), &[]);
    assert!(code == 1 && said.contains("error: node \"even\": it was there, and is not here"), "{said}");
    let (code, _, said) =
        verify(&SKETCH.replace("\"line\": (\n", "\"hem\": (\n").replace("line.curves", "hem.curves"), &[]);
    assert!(code == 1 && said.contains("error: node \"line\": it was there, and is not here"), "{said}");
}

#[test]
fn files_that_hold_no_hashes_are_neither_believed_nor_replaced() {
    let folder = TempDir::new().unwrap();
    let graph = file(&folder, "g.ron", SKETCH);
    let (code, _, said) = maquette(&["verify", str(&graph), "--against", str(&graph)]);
    assert!(code == 2 && said.contains("this is no file of hashes"), "{said}");
    let (code, _, said) = maquette(&["verify", str(&graph), "--against", "none.ron"]);
    assert!(code == 2 && said.contains("there is no such file"), "{said}");
    let newer = file(&folder, "newer.ron", "(hashes_version: 9, nodes: [])");
    let (code, _, said) = maquette(&["verify", str(&graph), "--against", str(&newer)]);
    assert!(code == 2 && said.contains("version 9"), "{said}");
    assert_eq!(maquette(&["verify", str(&graph)]).0, 2, "nothing to verify");
    // Meant was: run --hashes, with the graph behind it.
    let other = file(&folder, "other.ron", SKETCH);
    let (code, _, said) = maquette(&["run", "--hashes", str(&other), str(&graph)]);
    assert!(code == 2 && said.contains("it is not replaced"), "{said}");
    assert_eq!(std::fs::read_to_string(other).unwrap(), SKETCH);
    assert_eq!(maquette(&["run", str(&graph), "--json", "--hashes"]).0, 2, "both on stdout");
}

#[test]
fn the_memo_answers_what_a_fresh_evaluation_gives() {
    for name in ["vest", "neck"] {
        let (code, out, error) = maquette(&["verify", &format!("graphs/{name}.ron"), "--consistency"]);
        assert_eq!((code, error.as_str()), (0, ""));
        let numbers: Vec<usize> = out.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        assert!(matches!(numbers[..], [values, answers] if values > 30 && answers > 500), "{out}");
    }
}

#[test]
fn what_is_measured_on_request_can_be_limited_and_is_not_measured_otherwise() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("human.glb");
    let run = |more: &[&str]| {
        let arguments = ["run", "graphs/human.ron", "-o", str(&out), "--json"];
        maquette(&[&arguments, more].concat())
    };
    // The node that measures is not the result but before it.
    let (code, _, said) =
        run(&["--fail-if", "joints.largest-gap > 1e-9", "--fail-if", "max(joints.joints.gap) > 1e-9"]);
    assert_eq!((code, said.as_str()), (0, ""));
    let (code, _, said) = run(&["--fail-if", "joints.joints.angle < 200"]);
    assert!(code == 1 && said.contains("node \"joints\", joint \"parts 0 and 1\": angle is "), "{said}");
    let (code, plain, _) = run(&[]);
    assert!(code == 0 && !plain.contains("largest-part-angle"), "{plain}");
    let (code, report, _) = run(&["--report"]);
    assert!(code == 0 && report.contains("largest-part-angle"), "{report}");
}

#[test]
fn limits_fail_the_run_and_say_node_and_value() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("vest.glb");
    let run = |limits: &[&str], more: &[&str]| {
        let mut arguments = vec!["run", "graphs/vest.ron", "--output", "vest", "-o", str(&out)];
        limits.iter().for_each(|limit| arguments.extend(["--fail-if", limit]));
        arguments.extend(more);
        maquette(&arguments)
    };
    let (code, _, said) = run(&["body.largest-gap > 1e-6", "largest-gap >= 1"], &[]);
    assert_eq!(code, 1);
    let exceeded = "graphs/vest.ron: error: node \"body\": largest-gap is 0.000";
    assert!(said.starts_with(exceeded) && said.contains(" m; it fails 'body.largest-gap > 1e-6'\n"), "{said}");
    assert!(said.ends_with("--keep-going writes what succeeded\n") && !out.exists(), "{said}");
    let (code, _, _) = run(&["largest-gap > 1e-6"], &["--keep-going"]);
    assert!(code == 1 && out.exists());
    let (code, _, said) = run(&["body.largest-gap > 0.01", "largest-gap < 0"], &[]);
    assert_eq!((code, said.as_str()), (0, ""));

    for limit in ["body.largest-gape > 1", "bodies.largest-gap > 1", "surface.largest-gap > 1"] {
        let (code, _, said) = run(&[limit], &[]);
        assert!(
            code == 2 && said.contains("no node measures that; did you mean \"body.largest-gap\"? known figures: "),
            "{limit}: {said}"
        );
    }
    for limit in ["body.largest-gap", "body.largest-gap > wide"] {
        let (code, _, said) = run(&[limit], &[]);
        assert!(code == 2 && said.contains("write it as 'NODE.figure > 0.01'"), "{limit}: {said}");
    }
    for (limit, exceeded) in [
        ("body.rails.start-gap > 1e-4", "node \"body\", rail \"left side\": start-gap is 0.00019"),
        ("max(rails.start-gap) > 1e-4", "node \"body\": max of rails.start-gap is 0.00019"),
        ("vest.holes > 1", "node \"vest\": holes is 2; it fails 'vest.holes > 1'"),
    ] {
        let (code, _, said) = run(&[limit], &[]);
        assert!(code == 1 && said.contains(exceeded), "{limit}: {said}");
    }
    let (code, _, said) = run(&["vest.faults > 0", "folded-faces > 0", "warnings"], &[]);
    assert_eq!((code, said.as_str()), (0, ""));
    let (code, out, _) = run(&["largest-gap > 1e-6"], &["--json"]);
    let said: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(code == 1 && said["ok"] == false && said["errors"].as_array().unwrap().len() == 1, "{out}");
}
