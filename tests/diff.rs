//! `maquette diff`: what differs between two graphs, in words, as data, in millimetres, and within git.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use std::path::Path;
use std::process::Command;

use command::{SKETCH, file, maquette, said, str};
use serde_json::Value as Json;
use tempfile::TempDir;

/// What `diff` says about the sketch and a change of it, without the two lines that name the files.
fn changed(change: impl Fn(&str) -> String, options: &[&str]) -> (i32, String) {
    let folder = TempDir::new().unwrap();
    let (a, b) = (file(&folder, "a.ron", SKETCH), file(&folder, "b.ron", change(SKETCH)));
    let (code, out, error) = maquette(&[&["diff", str(&a), str(&b)], options].concat());
    assert_eq!(error, "");
    let header = format!("--- {}\n+++ {}\n", str(&a), str(&b));
    if code == 0 { (code, out) } else { (code, out.strip_prefix(&header).unwrap().to_owned()) }
}

fn replaced(from: &str, to: &str) -> (i32, String) {
    assert!(SKETCH.contains(from));
    changed(|graph| graph.replace(from, to), &[])
}

#[test]
fn order_comments_layout_and_written_defaults_make_no_difference() {
    let folder = TempDir::new().unwrap();
    let a = file(&folder, "a.ron", SKETCH);
    let node = |name: &str| {
        let start = SKETCH.find(&format!("        \"{name}\": (\n            kind")).unwrap();
        &SKETCH[start..start + SKETCH[start..].find("\n        ),\n").unwrap() + 12]
    };
    let (line, even, lines) = (node("line"), node("even"), node("lines"));
    let content = format!("(nodes: {{ // turned round\n{lines}{even}{line} }}, version: 1)")
        .replace("\"count\": 16,", "\"count\": 16, \"by\": Choice(\"count\"),");
    assert!(content.contains("kind: \"sketch\"") && content.len() > 500);
    let b = file(&folder, "b.ron", &content);
    let (code, out, error) = maquette(&["diff", str(&a), str(&b)]);
    assert_eq!((code, out.as_str(), error.as_str()), (0, "", ""));
    let (code, out, _) = maquette(&["diff", str(&a), str(&b), "--layout"]);
    assert_eq!(code, 1);
    assert!(out.ends_with("~ \"line\": layout (10, 20) -> nowhere\n"), "{out}");
}

#[test]
fn every_kind_of_difference_is_said_on_its_line() {
    for (from, to, expected) in [
        ("\"count\": 16", "\"count\": 24", "~ \"even.count\": 16 -> 24\n"),
        ("\n                \"count\": 16,", "", "~ \"even.count\": 16 -> 64\n"),
        ("(0.1, 0.0)", "(0.103, 0.004)", "~ \"line.strokes\": stroke \"hem\": 1 of 3 points moved, by at most 5 mm\n"),
        (
            "(0.1, 0.0),",
            "(0.1, 0.0), (0.1, 0.05),",
            "~ \"line.strokes\": stroke \"hem\": 3 points -> 4, at most 0 mm apart\n",
        ),
        ("closed: false", "closed: true", "~ \"line.strokes\": stroke \"hem\" is now closed\n"),
        ("name: \"hem\"", "name: \"rim\"", "~ \"line.strokes\": stroke \"hem\" is now \"rim\"\n"),
        (
            "Link(\"even.curves\")",
            "Link(\"line.curves\")",
            "~ \"lines.curves\": Link(\"even.curves\") -> Link(\"line.curves\")\n",
        ),
        (
            "kind: \"sketch\",",
            "kind: \"sketch\",\n            note: \"by hand\",",
            "~ \"line\": note \"\" -> \"by hand\"\n",
        ),
        ("version: 1,", "version: 1,\n    notes: \"A hem.\",", "~ notes \"\" -> \"A hem.\"\n"),
        ("kind: \"sketch\",", "kind: \"sketch\",\n            colour: 3,", "~ \"line\": field colour: nothing -> 3\n"),
        ("\"count\": 16,", "\"count\": 16,\n \"cuont\": 3,", "~ \"even.cuont\": nothing -> 3\n"),
        ("\"even\": (", "\"more\": (kind: \"sketch\"), \"even\": (", "+ node \"more\" (sketch)\n"),
    ] {
        assert_eq!(replaced(from, to), (1, expected.to_owned()), "{from} to {to}");
    }
    let gone = changed(|_| "(version: 1, nodes: {})".to_owned(), &[]);
    assert_eq!(gone.1, "- node \"line\" (sketch)\n- node \"even\" (resample)\n- node \"lines\" (curves-out)\n");
}

#[test]
fn a_renamed_node_is_one_difference_and_so_is_a_renamed_chain() {
    let rename = |graph: &str, from: &str, to: &str| {
        graph
            .replace(&format!("\"{from}\": ("), &format!("\"{to}\": ("))
            .replace(&format!("\"{from}."), &format!("\"{to}."))
    };
    let (code, said) = changed(|graph| rename(graph, "line", "hem line"), &[]);
    assert_eq!((code, said.as_str()), (1, "~ node \"line\" is now \"hem line\" (sketch)\n"));
    let (_, said) = changed(|graph| rename(&rename(&rename(graph, "line", "a"), "even", "b"), "lines", "c"), &[]);
    let expected = "~ node \"line\" is now \"a\" (sketch)\n~ node \"even\" is now \"b\" (resample)\n\
                    ~ node \"lines\" is now \"c\" (curves-out)\n";
    assert_eq!(said, expected);
    // Renamed and changed at once it is another node.
    let (_, said) = changed(|graph| rename(graph, "even", "b").replace("16", "17"), &[]);
    assert!(said.starts_with("- node \"even\" (resample)\n+ node \"b\" (resample)\n~ \"lines.curves\": "), "{said}");
}

#[test]
fn geometry_is_measured_both_ways() {
    let folder = TempDir::new().unwrap();
    let vest = std::fs::read_to_string("graphs/vest.ron").unwrap();
    let a = file(&folder, "a.ron", &vest);
    let (code, out, error) = maquette(&["diff", str(&a), "graphs/vest.ron", "--geometry"]);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(out.lines().count() >= 2 && out.lines().all(|line| line.starts_with("= result \"")), "{out}");

    let moved = vest.replace("(0.1345, 1.01)", "(0.1365, 1.01)");
    assert_ne!(moved, vest);
    let b = file(&folder, "b.ron", &moved);
    let (code, out, _) = maquette(&["diff", str(&a), str(&b), "--geometry", "--json"]);
    assert_eq!(code, 1);
    let said: Json = serde_json::from_str(&out).unwrap();
    assert_eq!(said["differences"].as_array().unwrap().len(), 1, "{out}");
    let stroke = &said["differences"][0]["strokes"][0];
    assert!((stroke["largest"].as_f64().unwrap() - 0.002).abs() < 1e-12, "{stroke}");
    let mesh = said["outputs"].as_array().unwrap().iter().find(|o| o["output"] == "vest").unwrap();
    assert_eq!((&mesh["identical"], &mesh["from"]), (&Json::Bool(false), &mesh["to"]));
    for way in ["there", "back"] {
        let [largest, mean] = ["largest", "mean"].map(|key| mesh[way][key].as_f64().unwrap());
        // The rail moved by 2 mm in its middle: the surface does not move much more, nor much less.
        assert!(largest > 0.0005 && largest < 0.004, "{way} {largest}");
        assert!(mean > 0.0 && mean < 0.2 * largest, "{way} {mean}");
    }
    let (_, text, _) = maquette(&["diff", str(&a), str(&b), "--geometry"]);
    assert!(text.contains("~ result \"vest\": there at most "), "{text}");
}

#[test]
fn results_that_can_not_be_made_and_wrong_arguments_exit_with_2() {
    let folder = TempDir::new().unwrap();
    let a = file(&folder, "a.ron", SKETCH);
    let gone = SKETCH
        .replace("kind: \"sketch\"", "kind: \"import-curves\"")
        .replace("\"strokes\": Strokes([", "\"file\": File(\"gone.json\"), \"strokes\": Strokes([");
    let b = file(&folder, "b.ron", gone.replace("\"strokes\"", "\"scale\": 1.0, \"strokes\""));
    assert_eq!(maquette(&["diff", str(&a), str(&b)]).0, 1, "files need not be there to be compared");
    let (code, _, said) = maquette(&["diff", str(&a), str(&b), "--geometry"]);
    assert!(code == 2 && said.contains("b.ron"), "{said}");
    let cut = file(&folder, "cut.ron", &SKETCH[..300]);
    let (code, _, said) = maquette(&["diff", str(&cut), str(&folder.path().join("none.ron"))]);
    assert!(
        code == 2 && said.contains("cut.ron:") && said.contains("none.ron: error: there is no such file"),
        "{said}"
    );
    assert_eq!(maquette(&["diff", str(&a)]).0, 2);
    let (code, out, _) = maquette(&["diff", str(&cut), str(&a), "--json"]);
    assert!(code == 2 && serde_json::from_str::<Json>(&out).unwrap()["equal"].is_null(), "{out}");
}

#[test]
fn a_long_renamed_chain_is_followed() {
    let chain = |prefix: &str, count: usize| {
        let mut graph = format!("(version: 1, nodes: {{ \"{prefix}0\": (kind: \"sketch\"),");
        for i in 1..count {
            let before = i - 1;
            graph += &format!(
                "\"{prefix}{i}\": (kind: \"transform\", inputs: {{ \"curves\": Link(\"{prefix}{before}.curves\") }}),\n"
            );
        }
        graph + "})"
    };
    let folder = TempDir::new().unwrap();
    let a = file(&folder, "a.ron", chain("a", 10_000));
    let b = file(&folder, "b.ron", chain("b", 10_000));
    let begun = std::time::Instant::now();
    let (code, out, _) = maquette(&["diff", str(&a), str(&b)]);
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
    assert_eq!((code, out.lines().filter(|line| line.contains("is now")).count()), (1, 10_000));
    assert_eq!(out.lines().count(), 10_002);
}

#[test]
fn alike_nodes_are_told_apart_by_what_takes_them() {
    let graph = |left: &str, right: &str| {
        format!(
            "(version: 1, nodes: {{ \"{left}\": (kind: \"sketch\"), \"{right}\": (kind: \"sketch\"),
             \"both\": (kind: \"join\", inputs: {{ \"a\": Link(\"{left}.curves\"), \"b\": Link(\"{right}.curves\") }}) }})"
        )
    };
    let folder = TempDir::new().unwrap();
    let a = file(&folder, "a.ron", graph("one", "two"));
    // In the other order in the file.
    let swapped = graph("x", "y").replace(
        "\"x\": (kind: \"sketch\"), \"y\": (kind: \"sketch\")",
        "\"y\": (kind: \"sketch\"), \"x\": (kind: \"sketch\")",
    );
    let b = file(&folder, "b.ron", swapped);
    let (_, out, _) = maquette(&["diff", str(&a), str(&b)]);
    let lines: Vec<_> = out.lines().skip(2).collect();
    assert_eq!(lines, ["~ node \"two\" is now \"y\" (sketch)", "~ node \"one\" is now \"x\" (sketch)"]);
}

/// Runs git in a folder, away from the settings of whoever runs the test.
fn git(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new("git")
        .args(["-c", "user.name=Test", "-c", "user.email=test@example.org", "-c", "core.pager=cat"])
        .args(arguments)
        .current_dir(folder)
        .env("GIT_CONFIG_GLOBAL", "/dev/null")
        .env("GIT_CONFIG_SYSTEM", "/dev/null")
        .stdin(std::process::Stdio::null())
        .output()
        .unwrap();
    said(&output)
}

#[test]
fn git_shows_graphs_by_diff_by_difftool_and_by_textconv() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let run = |arguments: &[&str]| {
        let (code, out, error) = git(path, arguments);
        assert_eq!(code, 0, "{arguments:?}: {error}");
        out
    };
    run(&["init", "--quiet"]);
    std::fs::create_dir(path.join("graphs")).unwrap();
    let graph = path.join("graphs/hem.ron");
    std::fs::write(path.join(".gitattributes"), "*.ron diff=maquette\n").unwrap();
    std::fs::write(&graph, SKETCH).unwrap();
    run(&["add", "."]);
    run(&["commit", "--quiet", "--message", "first"]);
    std::fs::write(&graph, SKETCH.replace("\"count\": 16", "\"count\": 24")).unwrap();
    std::fs::write(path.join("graphs/new.ron"), SKETCH).unwrap();
    run(&["add", "--intent-to-add", "graphs/new.ron"]);

    // As the README has it, with this build in the place of an installed program.
    let program = env!("CARGO_BIN_EXE_maquette");
    let program = format!("'{program}'");
    run(&["config", "diff.maquette.command", &format!("{program} diff --git")]);
    let shown = run(&["diff", "HEAD"]);
    let expected = "--- graphs/hem.ron\n+++ graphs/hem.ron\n~ \"even.count\": 16 -> 24\n\
                    --- graphs/new.ron\n+++ graphs/new.ron\n+ node \"line\" (sketch)\n+ node \"even\" (resample)\n\
                    + node \"lines\" (curves-out)\n";
    assert_eq!(shown, expected);
    run(&["config", "diff.maquette.command", &format!("{program} diff --geometry --git")]);
    let shown = run(&["diff", "HEAD", "--", "graphs/hem.ron"]);
    assert!(shown.contains("~ result \"lines\": there at most"), "{shown}");
    std::fs::write(&graph, &SKETCH[..300]).unwrap();
    let shown = run(&["diff", "HEAD", "--", "graphs/hem.ron"]);
    assert!(shown.starts_with("graphs/hem.ron: not to be compared: "), "{shown}");

    std::fs::write(&graph, SKETCH.replace("\"count\": 16", "\"count\": 24")).unwrap();
    run(&["config", "--unset", "diff.maquette.command"]);
    run(&["config", "difftool.maquette.cmd", &format!("{program} diff \"$LOCAL\" \"$REMOTE\"")]);
    let shown = run(&["difftool", "--no-prompt", "--tool", "maquette", "HEAD", "--", "graphs/hem.ron"]);
    assert!(shown.contains("~ \"even.count\": 16 -> 24\n"), "{shown}");

    // Another layout of the text is no difference in the stable form.
    run(&["config", "diff.maquette.textconv", &format!("{program} fmt --print")]);
    std::fs::write(&graph, SKETCH.replace("\n                \"count\": 16", " \"count\":   24")).unwrap();
    let shown = run(&["diff", "--unified=0", "HEAD", "--", "graphs/hem.ron"]);
    let lines: Vec<_> = shown.lines().filter(|line| line.starts_with(['+', '-'])).skip(2).collect();
    assert_eq!(lines, ["-                \"count\": 16,", "+                \"count\": 24,"]);
}
