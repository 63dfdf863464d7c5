//! `maquette fmt`: the stable form, and what is never lost on the way to it.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use command::{SKETCH, file, maquette, str};
use tempfile::TempDir;

/// The same graph in another layout of the text.
fn untidy() -> String {
    SKETCH.replacen("\n                \"count\": 16,", "", 1).replacen(
        "inputs: {\n                \"curves\"",
        "inputs: { \"count\": 16, \"curves\"",
        1,
    )
}

#[test]
fn untidy_graphs_are_rewritten_and_stable_ones_left_alone() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "g.ron", untidy());
    let (code, _, said) = maquette(&["fmt", "--check", str(&path), "graphs/vest.ron"]);
    assert_eq!(code, 2);
    assert!(said.contains("g.ron: error: not in the stable form") && !said.contains("vest"), "{said}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), untidy(), "--check changes nothing");

    let (code, printed, _) = maquette(&["fmt", "--print", str(&path)]);
    assert_eq!((code, printed.as_str()), (0, SKETCH));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), untidy(), "--print changes nothing");

    let (code, said, _) = maquette(&["fmt", str(&path)]);
    assert_eq!(code, 0);
    assert!(said.ends_with("g.ron: rewritten\n"), "{said}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), SKETCH);

    let before = std::fs::metadata(&path).unwrap().modified().unwrap();
    let (code, said, _) = maquette(&["fmt", str(&path)]);
    assert!(code == 0 && said.ends_with("g.ron: stable\n"), "{said}");
    assert_eq!(std::fs::metadata(&path).unwrap().modified().unwrap(), before, "not even touched");
    assert_eq!(maquette(&["fmt", "--check", "--quiet", str(&path)]), (0, String::new(), String::new()));
}

#[test]
fn comments_are_dropped_only_where_that_is_wanted() {
    let folder = TempDir::new().unwrap();
    let commented = SKETCH.replace("nodes: {", "nodes: { // the hem\n/* and */");
    let path = file(&folder, "g.ron", &commented);
    let (code, _, said) = maquette(&["fmt", str(&path)]);
    assert_eq!(code, 2);
    assert!(said.contains("g.ron:3:14: error: left as it is, because 2 comments would be dropped"), "{said}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), commented);
    let (code, said, _) = maquette(&["fmt", str(&path), "--drop-comments"]);
    assert!(code == 0 && said.contains("rewritten, comments dropped"), "{said}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), SKETCH);

    // Within what is not understood a comment stays, and so does a text that looks like one.
    let kept =
        untidy().replace("layout: {", "odd: [1, /* kept */ 2],\n    notes: \"http://example.org\",\n    layout: {");
    let path = file(&folder, "h.ron", kept);
    assert_eq!(maquette(&["fmt", "-q", str(&path)]).0, 0);
    let now = std::fs::read_to_string(&path).unwrap();
    assert!(now.contains("/* kept */") && now.contains("http://example.org"), "{now}");
}

#[test]
fn what_would_lose_something_is_not_touched() {
    let folder = TempDir::new().unwrap();
    for (name, content, expected) in [
        ("cut.ron", SKETCH[..200].to_owned(), "the file may have been cut off"),
        ("twice.ron", SKETCH.replace("\"count\": 16,", "\"count\": 8, \"count\": 16,"), "the input occurs twice"),
        ("name.ron", SKETCH.replace("\"line\"", "\"a.b\""), "\"a.b\" can't name a node"),
        ("attribute.ron", format!("#![enable(implicit_some)]\n{SKETCH}"), "has no meaning in a graph"),
    ] {
        let path = file(&folder, name, &content);
        let (code, _, said) = maquette(&["fmt", str(&path), "--drop-comments"]);
        assert!(code == 2 && said.contains(expected), "{name}: {said}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), content, "{name}");
    }
    let path = file(&folder, "bytes.ron", b"(version: 1, \xff)");
    assert!(maquette(&["fmt", str(&path)]).2.contains("not UTF-8"));
    let (code, _, said) = maquette(&["fmt", str(&folder.path().join("none.ron"))]);
    assert!(code == 2 && said.contains("there is no such file"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 5, "no temporary file is left");

    // What is not understood is kept, so such graphs can be rewritten.
    let path = file(&folder, "unknown.ron", untidy().replace("\"sketch\"", "\"scetch\""));
    assert_eq!(maquette(&["fmt", "-q", str(&path)]).0, 0);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), SKETCH.replace("\"sketch\"", "\"scetch\""));
}

#[test]
#[cfg(unix)]
fn links_and_permissions_stay_and_protected_files_are_left_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "g.ron", untidy());
    let mode = |mode| std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
    mode(0o444);
    let (code, _, said) = maquette(&["fmt", str(&path)]);
    assert!(code == 3 && said.contains("protected against writing"), "{said}");
    mode(0o660);
    let link = folder.path().join("link.ron");
    std::os::unix::fs::symlink(&path, &link).unwrap();
    assert_eq!(maquette(&["fmt", "-q", str(&link)]).0, 0);
    assert!(link.is_symlink());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), SKETCH);
    assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o660);
}
