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
    assert_eq!(ours("maquette-editor"), ["maquette-geometry", "maquette-graph", "maquette-nodes"]);
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

/// Calls that touch files; `fs` by any path is one as well.
const FILE_CALLS: [&str; 14] = [
    "File::open",
    "File::create",
    "File::options",
    "OpenOptions",
    "TcpStream",
    ".exists()",
    ".try_exists()",
    ".is_file()",
    ".is_dir()",
    ".is_symlink()",
    ".metadata()",
    ".symlink_metadata()",
    ".canonicalize()",
    ".read_dir()",
];

/// What in a source text touches files.
fn file_access(text: &str) -> Option<&str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let words = |line: &str| line.split(|c| !is_word(c)).any(|word| word == "fs");
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.into_iter().find(|line| words(line) || FILE_CALLS.iter().any(|call| line.contains(call)))
}

#[test]
fn the_search_for_file_access_finds_every_spelling() {
    for line in [
        "use std::fs;",
        "use std::{fs, io};",
        "use std::{io, fs::File};",
        "use std::fs as files;",
        "let bytes = std::fs::read(path)?;",
        "    let bytes = fs::read(path)?;",
        "let mut file = File::open(path)?;",
        "if path.exists() {",
        "if Path::new(name).is_file() {",
        "let size = path.metadata()?.len();",
    ] {
        assert_eq!(file_access(&format!("fn before() {{}}\n{line}\n")), Some(line));
    }
    for line in ["// std::fs is not for us", "let mut file = File::default();", "let coeffs = offs, beliefs;"] {
        assert_eq!(file_access(line), None);
    }
}

#[test]
fn only_the_command_the_file_cache_and_the_graphs_file_touch_files() {
    let mut touching = Vec::new();
    let mut folders: Vec<_> =
        ["geometry", "graph", "nodes"].map(|name| std::path::PathBuf::from(format!("crates/{name}/src"))).into();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if file_access(&std::fs::read_to_string(&path).unwrap()).is_some() {
                touching.push(path);
            }
        }
    }
    touching.sort();
    // They are there, so that the search can't silently find nothing.
    let expected = ["evaluate/file_cache.rs", "file/disk.rs"].map(|file| format!("crates/graph/src/{file}").into());
    assert_eq!(touching, expected as [std::path::PathBuf; 2]);
}

#[test]
fn one_file_names_the_back_end_of_sparse_matrices() {
    let mut naming = Vec::new();
    let mut folders = vec![std::path::PathBuf::from("crates/geometry/src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if std::fs::read_to_string(&path).unwrap().contains("faer::") {
                naming.push(path);
            }
        }
    }
    assert_eq!(naming, [std::path::PathBuf::from("crates/geometry/src/linear_solver.rs")]);
}
