//! The command as a person or a build farm meets it: outputs, messages, exit codes.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value as Json;
use tempfile::TempDir;

const SQUARE: &str = "points: [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1)]";

fn maquette(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_maquette")).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn file(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

/// A graph of the given nodes.
fn graph(nodes: &str) -> String {
    format!("(\n    version: 1,\n    nodes: {{\n{nodes}\n    }},\n)\n")
}

/// Runs a wrong graph: the exit code and what was said on stderr, with the folder's path taken out.
fn wrong(content: impl AsRef<[u8]>) -> (i32, String) {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "g.ron", content);
    let out = folder.path().join("out.glb");
    let output = maquette(&["run", path.to_str().unwrap(), "-o", out.to_str().unwrap()]);
    assert!(!out.exists(), "nothing is written for a wrong graph");
    let said = text(&output.stderr).replace(&format!("{}/", folder.path().display()), "");
    (code(&output), said)
}

fn sketch(strokes: &str) -> String {
    graph(&format!(
        "\"s\": (kind: \"sketch\", inputs: {{ \"strokes\": Strokes([{strokes}]) }}),
         \"lines\": (kind: \"curves-out\", inputs: {{ \"curves\": Link(\"s.curves\") }}),"
    ))
}

#[test]
fn the_first_command_of_the_readme_writes_a_model() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("vest.glb");
    let output = maquette(&["run", "graphs/vest.ron", "-o", out.to_str().unwrap()]);
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    let said = text(&output.stdout);
    for part in ["nodes run", "0 hits", "detail-generator", "result vest:", "vertices", "faces", "wrote"] {
        assert!(said.contains(part), "{part} in {said}");
    }
    assert_eq!(&std::fs::read(out).unwrap()[..4], b"glTF");
}

#[test]
fn every_format_is_written_and_an_unknown_one_refused_before_anything_runs() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let mut arguments = vec!["run".to_owned(), "graphs/neck.ron".to_owned(), "--quiet".to_owned()];
    for name in ["a.glb", "a.gltf", "a.obj", "a.ply", "a.json"] {
        arguments.extend(["-o".to_owned(), path(name)]);
    }
    let output = maquette(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!((code(&output), text(&output.stdout), text(&output.stderr)), (0, String::new(), String::new()));
    let start = |name: &str, bytes: usize| std::fs::read(path(name)).unwrap()[..bytes].to_vec();
    assert_eq!(start("a.ply", 4), b"ply\n");
    assert!(text(&std::fs::read(path("a.obj")).unwrap()).contains("mtllib a.mtl"));
    assert!(Path::new(&path("a.mtl")).exists());
    for name in ["a.gltf", "a.json"] {
        serde_json::from_slice::<Json>(&std::fs::read(path(name)).unwrap()).unwrap();
    }
    let output = maquette(&["run", "graphs/neck.ron", "-o", "neck.fbx"]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains(".glb, .gltf, .obj, .ply"), "{}", text(&output.stderr));
}

#[test]
fn json_says_the_same_as_data() {
    let output = maquette(&["run", "graphs/vest.ron", "--json"]);
    let said: Json = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["ok"], true);
    assert_eq!(said["ran"].as_u64().unwrap() as usize, said["nodes"].as_array().unwrap().len());
    let vest = said["results"].as_array().unwrap().iter().find(|r| r["name"] == "vest").unwrap();
    assert!(vest["vertices"].as_u64().unwrap() > 1000 && vest["bounds"]["max"][1].as_f64().unwrap() > 1.3);
    let sorted = said["nodes"].as_array().unwrap().iter().find(|n| n["name"] == "sorted").unwrap();
    assert!(sorted["notes"].as_array().unwrap().len() >= 7, "five rails and two closed curves are explained");

    let output = maquette(&["run", "graphs/none.ron", "--json"]);
    let said: Json = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((code(&output), &said["ok"]), (2, &Json::Bool(false)));
}

#[test]
fn two_runs_and_runs_with_1_2_and_8_threads_give_identical_bytes() {
    let folder = TempDir::new().unwrap();
    for name in ["vest", "head", "neck", "leg", "legs"] {
        let bytes = |threads: &str, try_: u8| {
            let path = |extension: &str| {
                let path = folder.path().join(format!("{name}-{threads}-{try_}.{extension}"));
                path.to_str().unwrap().to_owned()
            };
            let graph = format!("graphs/{name}.ron");
            let files = ["glb", "gltf", "obj", "ply", "json"].map(path);
            let mut arguments = vec!["run", &graph, "-q", "--threads", threads];
            files.iter().for_each(|file| arguments.extend(["-o", file]));
            assert_eq!(code(&maquette(&arguments)), 0);
            let written = files.map(|file| std::fs::read(file).unwrap());
            // The .obj names its .mtl, whose name differs here on purpose.
            written.map(|bytes| String::from_utf8_lossy(&bytes).replace(&format!("{name}-{threads}-{try_}"), ""))
        };
        let first = bytes("1", 0);
        for (threads, try_) in [("1", 1), ("2", 0), ("8", 0), ("8", 1)] {
            assert!(bytes(threads, try_) == first, "{name} with {threads} threads");
        }
    }
}

#[test]
fn values_are_set_by_the_type_of_their_port() {
    let faces = |set: &[&str]| {
        let mut arguments = vec!["run", "graphs/vest.ron", "--json", "--output", "vest"];
        set.iter().for_each(|value| arguments.extend(["--set", value]));
        let output = maquette(&arguments);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let said: Json = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(said["results"].as_array().unwrap().len(), 1, "only the output asked for");
        said["results"][0]["faces"].as_u64().unwrap()
    };
    let plain = faces(&[]);
    assert_eq!(faces(&["surface.rows=4"]), 4 * plain);
    assert!(faces(&["surface.cap-start=flat", "surface.cap-end=Choice(\"flat\")"]) > plain);
    assert_eq!(faces(&["body.k_s=0", "vest.colour=1,0.5,0", "vest.double-sided=false"]), plain);

    for (set, expected) in [
        ("surface.rows", "write it as NODE.PORT=VALUE"),
        ("surfaces.rows=2", "did you mean \"surface\"?"),
        ("surface.row=2", "has no input \"row\""),
        ("surface.rows=two", "\"two\" is not a whole number"),
        ("surface.rows=0", "out of range: give 1 to 64"),
        ("surface.cap-start=round", "choose one of none, flat"),
        ("surface.sections=1", "from a link"),
        ("vest.colour=red", "three or four numbers"),
    ] {
        let output = maquette(&["run", "graphs/vest.ron", "--set", set]);
        assert_eq!(code(&output), 2, "{set}");
        assert!(text(&output.stderr).contains(expected), "{set}: {}", text(&output.stderr));
    }
}

#[test]
fn unknown_kind() {
    let (code, said) = wrong(graph("\"a\": (kind: \"resampel\"),"));
    assert_eq!(code, 2);
    assert!(said.starts_with("g.ron:4:13: error: node \"a\": the node kind \"resampel\" is unknown"), "{said}");
    assert!(said.contains("did you mean \"resample\"?"), "{said}");
}

#[test]
fn wrong_type() {
    let (code, said) = wrong(graph(
        "\"s\": (kind: \"sketch\"),
         \"m\": (kind: \"mesh-out\", inputs: { \"mesh\": Link(\"s.curves\") }),",
    ));
    assert_eq!(code, 2);
    assert!(
        said.contains("g.ron:5:") && said.contains("\"s.curves\" gives curves, but \"m.mesh\" takes mesh"),
        "{said}"
    );
}

#[test]
fn missing_file() {
    let (code, said) = wrong(graph(
        "\"i\": (kind: \"import-curves\", inputs: { \"file\": File(\"gone.json\") }),
         \"o\": (kind: \"curves-out\", inputs: { \"curves\": Link(\"i.curves\") }),",
    ));
    assert_eq!(code, 1);
    assert!(
        said.contains("error: node \"i\", input \"file\": the file") && said.contains("gone.json does not exist"),
        "{said}"
    );
    assert!(said.contains("error: node \"o\": not made, because \"i\" failed"), "{said}");
}

#[test]
fn cycle() {
    let (code, said) = wrong(graph(
        "\"a\": (kind: \"transform\", inputs: { \"curves\": Link(\"b.curves\") }),
         \"b\": (kind: \"transform\", inputs: { \"curves\": Link(\"a.curves\") }),",
    ));
    assert_eq!(code, 2);
    assert!(said.contains("would close the cycle") && said.contains("b -> a -> b"), "{said}");
    assert_eq!(said.matches("cycle").count(), 1, "{said}");
}

#[test]
fn truncated() {
    let whole = std::fs::read("graphs/vest.ron").unwrap();
    let (code, said) = wrong(&whole[..whole.len() / 2]);
    assert_eq!(code, 2);
    assert!(said.contains("error:") && said.contains("cut off"), "{said}");
}

#[test]
fn not_utf8() {
    let (code, said) = wrong(b"(\n  version: 1, \xff");
    assert_eq!(
        (code, said.as_str()),
        (2, "g.ron:2:15: error: the file is not UTF-8 text; save it as UTF-8, or restore it from a backup\n")
    );
}

#[test]
fn not_finite() {
    let (code, said) = wrong(sketch("(points: [(0.0, 0.0), (NaN, 1.0)])"));
    assert_eq!(code, 2);
    assert!(said.contains("node \"s\", input \"strokes\"") && said.contains("point 1"), "{said}");
    assert!(said.contains("not a finite number"), "{said}");
}

#[test]
fn too_few_points() {
    let (code, said) = wrong(sketch("(name: \"ring\", closed: true, points: [(0.0, 0.0), (1.0, 1.0)])"));
    assert_eq!(code, 1);
    assert!(said.contains("curve \"ring\" has 2 distinct point(s)") && said.contains("at least 3"), "{said}");
}

#[test]
fn no_strokes() {
    let (code, said) = wrong(sketch(""));
    assert_eq!(code, 1);
    assert!(said.contains("error: node \"s\", input \"strokes\": there are no strokes"), "{said}");
}

#[test]
fn nothing_connected_and_no_result() {
    let (code, said) = wrong(graph("\"m\": (kind: \"mesh-out\"),"));
    assert_eq!(code, 2);
    assert!(said.contains("error: node \"m\", input \"mesh\": nothing is connected"), "{said}");
    let (code, said) = wrong(graph(""));
    assert_eq!(code, 2);
    assert!(said.contains("no result"), "{said}");
}

#[test]
fn missing_graph_and_bad_arguments() {
    let output = maquette(&["run", "graphs/none.ron"]);
    assert_eq!(code(&output), 2);
    assert_eq!(text(&output.stderr), "graphs/none.ron: error: there is no such file: check the path\n");
    for arguments in [["run", "--frobnicate"], ["frobnicate", "x"], ["render", "graphs/vest.ron"]] {
        assert_eq!(code(&maquette(&arguments)), 2);
    }
    let output = maquette(&["run", "graphs/vest.ron", "--output", "coat"]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("there is vest, sketch lines"), "{}", text(&output.stderr));
}

#[test]
fn a_partial_result_is_written_only_on_request() {
    let folder = TempDir::new().unwrap();
    let content = graph(&format!(
        "\"good\": (kind: \"sketch\", inputs: {{ \"strokes\": Strokes([({SQUARE})]) }}),
         \"bad\": (kind: \"sketch\"),
         \"lines\": (kind: \"curves-out\", inputs: {{ \"curves\": Link(\"good.curves\") }}),
         \"more\": (kind: \"curves-out\", inputs: {{ \"curves\": Link(\"bad.curves\") }}),"
    ));
    let path = file(&folder, "g.ron", content);
    let out = folder.path().join("lines.json");
    let mut arguments = vec!["run", path.to_str().unwrap(), "-o", out.to_str().unwrap()];
    assert_eq!(code(&maquette(&arguments)), 1);
    assert!(!out.exists());
    arguments.push("--keep-going");
    assert_eq!(code(&maquette(&arguments)), 1);
    assert!(out.exists());
}

#[test]
fn a_result_that_cannot_be_written_has_its_own_exit_code() {
    let output = maquette(&["run", "graphs/neck.ron", "-q", "-o", "no/such/folder/neck.glb"]);
    assert_eq!(code(&output), 3);
    assert!(text(&output.stderr).contains("the folder does not exist"), "{}", text(&output.stderr));
}

#[test]
fn check_says_everything_in_one_go() {
    let folder = TempDir::new().unwrap();
    let content = graph(
        "\"a\": (kind: \"resampel\"),
         \"b\": (kind: \"resample\", inputs: { \"curves\": Link(\"c.curves\"), \"count\": 1, \"cuont\": 3 }, colour: 3),
         \"i\": (kind: \"import-curves\", inputs: { \"file\": File(\"gone.json\") }),
         \"m\": (kind: \"mesh-out\"),",
    );
    let path = file(&folder, "g.ron", content);
    let output = maquette(&["check", path.to_str().unwrap(), "graphs/vest.ron"]);
    let said = text(&output.stderr);
    assert_eq!(code(&output), 2);
    for part in [
        "the node kind \"resampel\" is unknown",
        "linked to \"c\"",
        "out of range: give 2 to 65536",
        "did you mean \"count\"?",
        "the field \"colour\" is unknown",
        "gone.json does not exist",
        "nothing is connected",
    ] {
        assert!(said.contains(part), "{part} in {said}");
    }
    assert!(said.lines().all(|line| line.starts_with(path.to_str().unwrap())), "each line has a place: {said}");
    let verdicts = text(&output.stdout);
    assert!(verdicts.contains("g.ron: not sound") && verdicts.contains("graphs/vest.ron: sound"), "{verdicts}");
    assert_eq!(code(&maquette(&["check", "graphs/vest.ron"])), 0);
}

#[test]
fn nodes_lists_describes_and_exports_the_catalogue() {
    let list = text(&maquette(&["nodes"]).stdout);
    assert!(list.lines().any(|line| line.starts_with("detail-generator  ")), "{list}");
    let one = text(&maquette(&["nodes", "resample"]).stdout);
    for part in ["spacing (number, m, 0.01,", "thesis 6.4", "Points on each curve"] {
        assert!(one.contains(part), "{part} in {one}");
    }
    let json: Json = serde_json::from_slice(&maquette(&["nodes", "--json"]).stdout).unwrap();
    assert_eq!(json.as_array().unwrap().len(), list.lines().count());
    let output = maquette(&["nodes", "resampel"]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("did you mean \"resample\"?"));
}

#[test]
fn render_draws_a_picture_of_the_size_asked_for() {
    let folder = TempDir::new().unwrap();
    for view in ["front", "side", "top", "three-quarter"] {
        let path = folder.path().join(format!("{view}.png"));
        let path = path.to_str().unwrap();
        let output =
            maquette(&["render", "graphs/neck.ron", "-o", path, "--view", view, "--size", "120x80", "--curves"]);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let png = std::fs::read(path).unwrap();
        // Width and height stand in the first chunk.
        assert_eq!((&png[1..4], &png[16..24]), (b"PNG".as_slice(), [0, 0, 0, 120, 0, 0, 0, 80].as_slice()));
    }
    let output = maquette(&["render", "graphs/neck.ron", "-o", "neck.jpg"]);
    assert_eq!(code(&output), 2);
    let output = maquette(&["render", "graphs/neck.ron", "-o", "neck.png", "--size", "big"]);
    assert_eq!(code(&output), 2);
}

#[test]
fn formats_that_do_not_suit_the_results_are_refused_before_anything_runs() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "g.ron", sketch(&format!("({SQUARE})")));
    let (model, lines) = (folder.path().join("a.ply"), folder.path().join("a.json"));
    let output =
        maquette(&["run", path.to_str().unwrap(), "-o", lines.to_str().unwrap(), "-o", model.to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("a .ply file holds a mesh"), "{}", text(&output.stderr));
    assert!(!lines.exists() && !model.exists());
}

#[test]
fn json_holds_every_error_and_warning() {
    let said = |arguments: &[&str]| -> Json { serde_json::from_slice(&maquette(arguments).stdout).unwrap() };
    let lost = said(&["run", "graphs/neck.ron", "--json", "-o", "no/such/neck.glb"]);
    assert!(lost["errors"][0].as_str().unwrap().contains("the folder does not exist"), "{lost}");
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "g.ron", sketch(&format!("({SQUARE})")).replace("version: 1,", "version: 1, titel: 3,"));
    let warned = said(&["run", path.to_str().unwrap(), "--json"]);
    assert_eq!(warned["ok"], true);
    assert!(warned["warnings"][0].as_str().unwrap().contains("titel"), "{warned}");
    let checked = said(&["run", "graphs/neck.ron", "--json", "--report"]);
    let node = |name: &str| checked["nodes"].as_array().unwrap().iter().find(|n| n["name"] == name).unwrap();
    let figure = |name: &str| node("neck")["figures"].as_array().unwrap().iter().find(|f| f["name"] == name).unwrap();
    assert_eq!((&figure("faults")["value"], &figure("holes")["value"]), (&0.0.into(), &2.0.into()), "{checked}");
    assert_eq!(figure("largest-fold")["unit"], "degrees");
    let rails = &node("sorted")["tables"][0];
    assert_eq!((&rails["columns"][2]["unit"], rails["rows"].as_array().unwrap().len()), (&"degrees".into(), 4));
    assert!(checked["threads"].as_u64().unwrap() >= 1);
}

#[test]
fn a_result_asked_for_twice_is_written_once() {
    let output = maquette(&["run", "graphs/neck.ron", "--json", "--output", "neck", "--output", "neck"]);
    let said: Json = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["results"].as_array().unwrap().len(), 1);
    let output = maquette(&["run", "graphs/neck.ron", "--output", "neck.glb"]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("to write a file say -o neck.glb"), "{}", text(&output.stderr));
}

#[cfg(unix)]
#[test]
fn a_link_still_leads_to_the_file_and_a_full_disk_is_noticed() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = TempDir::new().unwrap();
    let real = file(&folder, "real.glb", "old");
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o600)).unwrap();
    let link = folder.path().join("link.glb");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    assert_eq!(code(&maquette(&["run", "graphs/neck.ron", "-q", "-o", link.to_str().unwrap()])), 0);
    assert!(link.is_symlink());
    assert_eq!(&std::fs::read(&real).unwrap()[..4], b"glTF");
    assert_eq!(std::fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o600);
    if let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") {
        let status = Command::new(env!("CARGO_BIN_EXE_maquette")).arg("nodes").stdout(full).status().unwrap();
        assert_eq!(status.code(), Some(3));
    }
}

#[test]
fn an_svg_drawing_comes_in_life_size() {
    let folder = TempDir::new().unwrap();
    let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="297mm" viewBox="0 0 210 297">
        <path id="limb" d="M 60,20 L 60,180" stroke="black" fill="none"/></svg>"#;
    file(&folder, "drawing.svg", drawing);
    let content = graph(
        "\"i\": (kind: \"import-curves\", inputs: { \"file\": File(\"drawing.svg\") }),
         \"lines\": (kind: \"curves-out\", inputs: { \"curves\": Link(\"i.curves\") }),",
    );
    let path = file(&folder, "g.ron", content);
    let output = maquette(&["run", path.to_str().unwrap(), "--json"]);
    let said: Json = serde_json::from_slice(&output.stdout).unwrap();
    let height = |end: &str| said["results"][0]["bounds"][end][1].as_f64().unwrap();
    assert!((height("max") - height("min") - 0.160).abs() < 1e-6, "{said}");
}

#[test]
fn check_can_evaluate_every_node() {
    let folder = TempDir::new().unwrap();
    let content = sketch("(closed: true, points: [(0.0, 0.0), (1.0, 1.0)])");
    let path = file(&folder, "g.ron", content);
    assert_eq!(code(&maquette(&["check", path.to_str().unwrap()])), 0);
    let output = maquette(&["check", "--evaluate", path.to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("at least 3"), "{}", text(&output.stderr));
    let empty = file(&folder, "e.ron", graph("\"i\": (kind: \"import-curves\"), \"s\": (kind: \"sketch\"),"));
    let output = maquette(&["check", "--evaluate", empty.to_str().unwrap()]);
    let said = text(&output.stderr);
    assert_eq!(code(&output), 2);
    assert_eq!(said.matches("no file is named").count(), 1, "{said}");
    assert_eq!(said.matches("there are no strokes").count(), 1, "{said}");
}
