//! The command, as tests start it.
#![allow(dead_code, reason = "each test file takes what it needs")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Runs the command to its end: exit code, stdout, stderr.
pub fn maquette(arguments: &[&str]) -> (i32, String, String) {
    said(&Command::new(env!("CARGO_BIN_EXE_maquette")).args(arguments).output().unwrap())
}

/// Exit code, stdout, stderr.
pub fn said(output: &Output) -> (i32, String, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

/// Writes a file into a folder.
pub fn file(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

pub fn str(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A sketched line, evenly sampled, as a result: `line` -> `even` -> `lines`. In the stable form.
pub const SKETCH: &str = r#"(
    version: 1,
    nodes: {
        "line": (
            kind: "sketch",
            inputs: {
                "strokes": Strokes([
                    (
                        name: "hem",
                        closed: false,
                        points: [
                            (0.0, 0.0),
                            (0.1, 0.0),
                            (0.1, 0.1),
                        ],
                    ),
                ]),
            },
        ),
        "even": (
            kind: "resample",
            inputs: {
                "curves": Link("line.curves"),
                "count": 16,
            },
        ),
        "lines": (
            kind: "curves-out",
            inputs: {
                "curves": Link("even.curves"),
            },
        ),
    },
    layout: {
        "line": (10.0, 20.0),
    },
)
"#;
