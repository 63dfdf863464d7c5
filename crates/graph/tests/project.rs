//! What a graph may read: the files of its project and those that the user named.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod kinds;

use kinds::{Rig, state};
use maquette_graph::file::{OpenError, Project, open};
use maquette_graph::{Literal, Request};

#[test]
fn what_the_user_named_is_allowed_and_nothing_else_is() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("project")).unwrap();
    for name in ["secret.txt", "other.txt", "project/own.txt"] {
        std::fs::write(folder.path().join(name), name).unwrap();
    }
    let root = folder.path().join("project");
    let mut project = Project::within(&root);
    let secret = folder.path().join("secret.txt");
    assert_eq!(project.read(&root.join("own.txt")).unwrap(), b"project/own.txt");
    let said = project.read(&secret).unwrap_err();
    let expected = format!(
        "the file {} lies outside of the project folder {}: move it there, or widen the project (--project \
         FOLDER), or allow everything (--allow-outside)",
        secret.display(),
        root.display()
    );
    assert_eq!(said, expected);
    project.allow(&secret);
    assert_eq!(project.read(&secret).unwrap(), b"secret.txt");
    assert!(project.read(&folder.path().join("other.txt")).is_err());
    assert!(Project::within(folder.path()).read(&secret).is_ok());
    assert!(Project::anywhere().read(&secret).is_ok());
    assert!(project.read(&root.join("none.txt")).unwrap_err().contains("does not exist"));
}

#[test]
#[cfg(unix)]
fn links_are_followed_before_a_file_is_read() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("project/deep")).unwrap();
    std::fs::write(at("secret.txt"), "secret").unwrap();
    std::fs::write(at("project/own.txt"), "own").unwrap();
    symlink("../secret.txt", at("project/link")).unwrap();
    symlink("..", at("project/up")).unwrap();
    symlink("../nothing.txt", at("project/dangling")).unwrap();
    symlink("own.txt", at("project/good")).unwrap();
    symlink("project", at("alias")).unwrap();
    let project = Project::within(at("project"));
    for outside in ["link", "up/secret.txt", "dangling", "deep/../up/secret.txt", "up/none.txt"] {
        assert!(project.check(&at("project").join(outside)).is_err(), "{outside}");
    }
    for inside in ["good", "own.txt", "deep/../own.txt", "none.txt", "no/folder.txt"] {
        assert!(project.check(&at("project").join(inside)).is_ok(), "{inside}");
    }
    // The project itself may be reached by a link.
    assert!(Project::within(at("alias")).check(&at("alias/own.txt")).is_ok());
    assert!(Project::within(at("alias")).check(&at("alias/link")).is_err());
}

/// A project with a file of its own, a file beside it, and a graph that reads one of them.
fn reading(path: &str) -> (tempfile::TempDir, Rig) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("project")).unwrap();
    std::fs::write(folder.path().join("secret.txt"), "secret").unwrap();
    std::fs::write(folder.path().join("project/own.txt"), "own").unwrap();
    let mut rig = Rig::default();
    rig.add("read-file", "reader");
    rig.put("reader.file", Literal::File(path.to_owned()));
    (folder, rig)
}

#[test]
fn a_node_reads_nothing_outside_and_says_why() {
    let (folder, mut rig) = reading("../secret.txt");
    let (id, base) = (rig.id("reader"), folder.path().join("project"));
    let refused = format!(
        "failed: input \"file\": the file {} lies outside of the project folder {}: move it there, or widen the \
         project (--project FOLDER), or allow everything (--allow-outside)",
        base.join("../secret.txt").display(),
        base.display()
    );
    assert_eq!(state(&rig.request(Request::nodes(&[id]).base(&base)), id), refused);
    // What was read in a wider project is not answered in a narrower one.
    let wide = Project::within(folder.path());
    assert_eq!(state(&rig.request(Request::nodes(&[id]).base(&base).project(&wide)), id), "done: \"secret\"");
    assert_eq!(state(&rig.request(Request::nodes(&[id]).base(&base)), id), refused);
    let mut named = Project::within(&base);
    named.allow(base.join("../secret.txt"));
    assert_eq!(state(&rig.request(Request::nodes(&[id]).base(&base).project(&named)), id), "done: \"secret\"");
    rig.put("reader.file", Literal::File("own.txt".to_owned()));
    assert_eq!(state(&rig.request(Request::nodes(&[id]).base(&base)), id), "done: \"own\"");
    // A refused file is not looked for, so that nothing is said about whether it is there.
    rig.put("reader.file", Literal::File("../nothing.txt".to_owned()));
    assert!(state(&rig.request(Request::nodes(&[id]).base(&base)), id).contains("lies outside"));
}

#[test]
fn a_graph_is_opened_within_its_project_only() {
    let (folder, rig) = reading("own.txt");
    let at = |name: &str| folder.path().join(name);
    maquette_graph::file::save(&rig.graph, &at("project/a.ron")).unwrap();
    maquette_graph::file::save(&rig.graph, &at("b.ron")).unwrap();
    let project = Project::of_graph(&at("project/a.ron"));
    assert!(!open(&rig.catalogue, &at("project/a.ron"), &project).unwrap().has_errors());
    let refused = |name: &str| open(&rig.catalogue, &at(name), &project).unwrap_err();
    assert!(matches!(refused("b.ron"), OpenError::Outside { .. }));
    assert!(matches!(refused("project/../b.ron"), OpenError::Outside { .. }));
    assert!(matches!(refused("project/none.ron"), OpenError::Missing(_)));
    assert!(matches!(refused("project"), OpenError::Unreadable { .. }));
    assert!(matches!(refused("project/own.txt"), OpenError::File { .. }));
    assert!(refused("project/own.txt").to_string().contains("own.txt:1:1: error: "), "{}", refused("project/own.txt"));
}
