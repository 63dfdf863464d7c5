//! A graph reads what its project holds, and the user may say otherwise.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use command::{SKETCH, file, maquette, str};
use tempfile::TempDir;

/// `project/a.ron` reads `outside.json`, which lies beside the project.
fn outside() -> TempDir {
    let folder = TempDir::new().unwrap();
    let sketch = file(&folder, "sketch.ron", SKETCH);
    assert_eq!(maquette(&["run", str(&sketch), "-q", "-o", str(&folder.path().join("outside.json"))]).0, 0);
    std::fs::create_dir(folder.path().join("project")).unwrap();
    let graph = r#"(
    version: 1,
    nodes: {
        "file": (kind: "import-curves", inputs: {"file": File("../outside.json")}),
        "lines": (kind: "curves-out", inputs: {"curves": Link("file.curves")}),
    },
)"#;
    file(&folder, "project/a.ron", graph);
    folder
}

#[test]
fn what_lies_outside_is_refused_with_node_input_path_folder_and_remedy() {
    let folder = outside();
    let graph = folder.path().join("project/a.ron");
    let (path, root) = (graph.parent().unwrap().join("../outside.json"), graph.parent().unwrap());
    let expected = format!(
        "{}:4:58: error: node \"file\", input \"file\": the file {} lies outside of the project folder {}: move it \
         there, or widen the project (--project FOLDER), or allow everything (--allow-outside)",
        graph.display(),
        path.display(),
        root.display()
    );
    let evaluated = ["check", str(&graph), "--evaluate"];
    for (arguments, expected_code) in [
        (["check", str(&graph)].as_slice(), 2),
        (evaluated.as_slice(), 2),
        (["run", str(&graph)].as_slice(), 1),
        (["verify", str(&graph), "--consistency"].as_slice(), 1),
        (["render", str(&graph), "-o", str(&folder.path().join("a.png"))].as_slice(), 1),
        (["diff", str(&graph), str(&graph), "--geometry"].as_slice(), 2),
    ] {
        let (code, _, said) = maquette(arguments);
        assert_eq!(code, expected_code, "{arguments:?}: {said}");
        assert!(said.lines().any(|line| line == expected), "{arguments:?}: {said}");
    }
}

#[test]
fn the_user_widens_the_project_lifts_it_or_names_the_file() {
    let folder = outside();
    let graph = folder.path().join("project/a.ron");
    let (wide, narrow) = (folder.path(), folder.path().join("project"));
    for allowed in [["--project", str(wide)].as_slice(), ["--allow-outside"].as_slice()] {
        for command in ["check", "run"] {
            let (code, _, said) = maquette(&[&[command, str(&graph)], allowed].concat());
            assert_eq!(code, 0, "{command} {allowed:?}: {said}");
        }
        let (code, _, said) = maquette(&[&["diff", str(&graph), str(&graph), "--geometry"], allowed].concat());
        assert_eq!(code, 0, "{allowed:?}: {said}");
    }
    assert_eq!(maquette(&["run", str(&graph), "--project", str(&narrow)]).0, 1);
    assert_eq!(maquette(&["run", str(&graph), "--project", str(wide), "--allow-outside"]).0, 2);
    let set = format!("file.file={}", str(&folder.path().join("outside.json")));
    let (code, _, said) = maquette(&["run", str(&graph), "--set", &set]);
    assert_eq!(code, 0, "{said}");
}
