//! `maquette migrate`: nothing to do for files of today, and files that are no graphs are left alone.
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
fn a_file_of_today_stays_as_it_is_to_the_byte() {
    let folder = TempDir::new().unwrap();
    let odd = format!("\u{feff}// a comment\r\n{}", SKETCH.replace("    ", "\t"));
    let graph = file(&folder, "a.ron", &odd);
    for arguments in [["migrate", str(&graph)].as_slice(), &["migrate", str(&graph), "--check"]] {
        let (code, said, complained) = maquette(arguments);
        assert_eq!((code, complained.as_str()), (0, ""));
        assert_eq!(said, format!("{}: of the present version\n", graph.display()));
    }
    assert_eq!(std::fs::read_to_string(&graph).unwrap(), odd);
    let (code, said, _) = maquette(&["migrate", "--quiet", str(&graph)]);
    assert_eq!((code, said.as_str()), (0, ""));
}

#[test]
fn what_is_no_graph_is_said_and_the_others_are_looked_at() {
    let folder = TempDir::new().unwrap();
    let text = file(&folder, "letter.ron", "Dear all,");
    let graph = file(&folder, "a.ron", SKETCH);
    let (code, said, complained) = maquette(&["migrate", str(&text), "none.ron", str(&graph)]);
    assert_eq!(code, 2);
    assert!(said.contains("a.ron: of the present version"), "{said}");
    assert!(
        complained.contains("letter.ron:1:1: error: ") && complained.contains("none.ron: error: there is no such file"),
        "{complained}"
    );
    assert_eq!(std::fs::read_to_string(&text).unwrap(), "Dear all,");
}
