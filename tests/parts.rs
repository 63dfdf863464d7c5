//! Parameters, parts in files of their own, repeat and mute, as the command meets them.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use command::{SKETCH, file, maquette, str};
use serde_json::Value as Json;
use tempfile::TempDir;

fn json(arguments: &[&str]) -> (i32, Json) {
    let (code, out, error) = maquette(arguments);
    (code, serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}{error}")))
}

fn points(said: &Json, result: &str) -> u64 {
    let results = said["results"].as_array().unwrap();
    results.iter().find(|r| r["name"] == result).unwrap()["points"].as_u64().unwrap()
}

/// The sketched line of `SKETCH`, with the number of points a parameter.
fn with_parameter() -> String {
    SKETCH
        .replace("    nodes: {", "    parameters: {\n        \"samples\": (\n            value: 16,\n            range: (2.0, 99.0),\n            description: \"Points.\",\n        ),\n    },\n    nodes: {")
        .replace("\"count\": 16,", "\"count\": Parameter(\"samples\"),")
}

#[test]
fn a_parameter_is_set_by_its_name() {
    let folder = TempDir::new().unwrap();
    let graph = file(&folder, "g.ron", with_parameter());
    let (code, said) = json(&["run", str(&graph), "--json"]);
    assert_eq!((code, points(&said, "lines")), (0, 16));
    let (code, said) = json(&["run", str(&graph), "--json", "--set", "samples=32"]);
    assert_eq!((code, points(&said, "lines")), (0, 32));
    // An input that a parameter drives can be set all the same.
    let (code, said) = json(&["run", str(&graph), "--json", "--set", "even.count=8"]);
    assert_eq!((code, points(&said, "lines")), (0, 8));
    for (set, expected) in [
        ("sample=3", "--set sample=3: the graph has no parameter \"sample\"; did you mean \"samples\"?"),
        ("zzz=3", "--set zzz=3: the graph has no parameter \"zzz\"; it has samples"),
        ("samples=100", "--set samples=100: parameter \"samples\": 100 is out of range: give 2 to 99"),
        ("samples=many", "\"many\" is not a whole number, such as 64"),
        ("samples", "write it as NODE.PORT=VALUE, or PARAMETER=VALUE"),
    ] {
        let (code, _, error) = maquette(&["run", str(&graph), "--set", set]);
        assert!(code == 2 && error.contains(expected), "{error}");
    }
    let (code, out, _) = maquette(&["check", "--parameters", str(&graph)]);
    assert!(code == 0 && out.contains("  samples = 16 (integer, 2 to 99): Points.\n"), "{out}");
}

/// A graph whose lines are made by a part.
const USING: &str = r#"(
    version: 1,
    nodes: {
        "line": (
            kind: "graph",
            inputs: {
                "samples": 5,
            },
            body: File("parts/line.ron"),
        ),
        "lines": (
            kind: "curves-out",
            inputs: {
                "curves": Link("line.curves"),
            },
        ),
    },
)
"#;

fn part() -> String {
    let sketch = with_parameter();
    let (head, _) = sketch.split_once("        \"lines\": (").unwrap();
    format!(
        "{head}    }},\n    outputs: {{\n        \"curves\": (\n            from: \"even.curves\",\n        ),\n    }},\n)\n"
    )
}

fn using() -> (TempDir, std::path::PathBuf) {
    let folder = TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    file(&folder, "parts/line.ron", part());
    let graph = file(&folder, "g.ron", USING);
    (folder, graph)
}

#[test]
fn a_part_is_found_from_the_graphs_folder_and_checked_with_its_name() {
    let (folder, graph) = using();
    let (code, said) = json(&["run", str(&graph), "--json"]);
    assert_eq!((code, points(&said, "lines")), (0, 5));
    let part_path = folder.path().join("parts/line.ron");
    let (code, out, error) = maquette(&["check", "--evaluate", str(&graph), str(&part_path)]);
    assert_eq!(code, 0, "{out}{error}");
    assert!(out.contains("line.ron: sound; 2 nodes, 0 results, 0 errors, 0 warnings"), "{out}");
    let (code, out, error) = maquette(&["fmt", "--check", str(&graph), str(&part_path)]);
    assert_eq!(code, 0, "{out}{error}");

    std::fs::write(&part_path, part().replace("resample", "resampel")).unwrap();
    let (code, _, error) = maquette(&["run", str(&graph)]);
    let place = format!("{}:", part_path.display());
    assert!(code == 2 && error.contains(&place) && error.contains("did you mean \"resample\"?"), "{error}");
    std::fs::write(&part_path, part().replace("\"even.curves\"", "\"even.curves\", rest")).unwrap();
    let (code, _, error) = maquette(&["run", str(&graph)]);
    assert!(code == 2 && error.contains(&place) && error.contains("its body can't be had"), "{error}");
    std::fs::remove_file(&part_path).unwrap();
    let (code, _, error) = maquette(&["run", str(&graph)]);
    let missing =
        "g.ron:9:19: error: node \"line\": its body can't be had: the file parts/line.ron: there is no such file";
    assert!(code == 2 && error.contains(missing), "{error}");
    // What can't be loaded is not lost by being rewritten.
    let (code, out, error) = maquette(&["fmt", "--print", str(&graph)]);
    assert_eq!((code, out.as_str()), (0, USING), "{error}");
}

#[test]
fn what_a_part_measures_gates_the_graph() {
    let (_folder, graph) = using();
    let (code, out, error) = maquette(&["run", str(&graph), "--report"]);
    assert_eq!(code, 0, "{error}");
    let figure = out.lines().find_map(|line| line.trim().strip_prefix("even/")?.split(':').next().map(str::to_owned));
    let figure = figure.unwrap_or_else(|| panic!("{out}"));
    let (code, _, error) = maquette(&["run", str(&graph), "--fail-if", &format!("line.even/{figure} >= 0")]);
    assert!(code == 1 && error.contains(&format!("node \"line\": even/{figure} is ")), "{error}");
    let (code, _, error) = maquette(&["run", str(&graph), "--fail-if", "line.even/no-such > 0"]);
    assert!(code == 2 && error.contains("no node measures that"), "{error}");
}

#[test]
fn differences_in_parameters_bodies_and_muting_are_named() {
    let (folder, graph) = using();
    let embedded =
        USING.replace("body: File(\"parts/line.ron\")", &format!("body: {}", part().replace("    version: 1,\n", "")));
    let a = file(&folder, "a.ron", &embedded);
    let (code, out, error) = maquette(&["diff", str(&graph), str(&a), "--geometry"]);
    assert_eq!(code, 1, "{error}");
    assert!(out.contains("~ \"line\": body File(\"parts/line.ron\") -> embedded"), "{out}");
    assert!(out.contains("= result \"lines\": identical"), "{out}");
    let b = embedded
        .replace("(0.1, 0.1),", "(0.1, 0.2),")
        .replace("value: 16", "value: 17")
        .replace("            kind: \"curves-out\",", "            kind: \"curves-out\",\n            muted: true,");
    let b = file(&folder, "b.ron", b);
    let (code, out, _) = maquette(&["diff", str(&a), str(&b)]);
    assert_eq!(code, 1);
    for line in [
        "in \"line\": ~ parameter \"samples\": (value: 16, range: (2.0, 99.0), description: \"Points.\") -> (value: 17,",
        "in \"line\": ~ \"line.strokes\": stroke \"hem\": 1 of 3 points moved, by at most 100 mm",
        "~ \"lines\" is muted",
    ] {
        assert!(out.contains(line), "{line}\n{out}");
    }
    let (_, said) = json(&["diff", str(&a), str(&b), "--json"]);
    assert_eq!(said["differences"][0]["what"], "within");
    let (code, _, error) = maquette(&["run", str(&b)]);
    assert!(code == 2 && error.contains("the graph has no result"), "{error}");
}

#[test]
fn results_are_proved_the_same_through_parts() {
    let folder = TempDir::new().unwrap();
    let hashes = folder.path().join("hashes.ron");
    let (code, _, error) = maquette(&["run", "graphs/legs.ron", "--quiet", "--threads", "1", "--hashes", str(&hashes)]);
    assert_eq!(code, 0, "{error}");
    let arguments = ["verify", "graphs/legs.ron", "--threads", "8", "--against", str(&hashes), "--consistency"];
    let (code, out, error) = maquette(&arguments);
    assert_eq!(code, 0, "{out}{error}");
    let (code, _, error) = maquette(&["freeze", "graphs/legs.ron", "left"]);
    assert!(code == 2 && error.contains("a node of kind graph does nothing by itself"), "{error}");
}
