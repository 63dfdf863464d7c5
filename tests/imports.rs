//! Imports go one way: what ARCHITECTURE.md says, read off `cargo tree`.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::process::Command;

/// The packages that a package of the workspace builds with.
fn dependencies(package: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--offline",
            "--edges",
            "normal,build",
            "--prefix",
            "none",
            "--format",
            "{p}",
            "--package",
            package,
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

fn ours(package: &str) -> Vec<String> {
    let mut ours: Vec<_> =
        dependencies(package).into_iter().filter(|name| name.starts_with("maquette") && name != package).collect();
    ours.sort();
    ours.dedup();
    ours
}

#[test]
fn geometry_and_graph_import_nothing_of_ours_and_nodes_imports_both() {
    assert_eq!(ours("maquette-geometry"), Vec::<String>::new());
    assert_eq!(ours("maquette-graph"), Vec::<String>::new());
    assert_eq!(ours("maquette-nodes"), ["maquette-geometry", "maquette-graph"]);
}

#[test]
fn the_headless_build_is_free_of_windows() {
    for package in ["maquette", "maquette-geometry", "maquette-graph", "maquette-nodes"] {
        let windows: Vec<_> = dependencies(package)
            .into_iter()
            .filter(|name| ["egui", "eframe", "winit", "wgpu"].iter().any(|window| name.starts_with(window)))
            .collect();
        assert_eq!(windows, Vec::<String>::new(), "{package}");
    }
}

#[test]
fn only_the_command_and_the_import_nodes_touch_files() {
    let mut offenders = Vec::new();
    let mut folders: Vec<_> =
        ["geometry", "graph", "nodes"].map(|name| std::path::PathBuf::from(format!("crates/{name}/src"))).into();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if std::fs::read_to_string(&path).unwrap().contains("std::fs")
                && path != std::path::Path::new("crates/nodes/src/source_file.rs")
            {
                offenders.push(path);
            }
        }
    }
    assert_eq!(offenders, Vec::<std::path::PathBuf>::new());
}
