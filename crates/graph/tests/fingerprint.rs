//! Nodes that read files run again when the content of the file changes, and only then.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinds::{Rig, kind, state};
use maquette_graph::{ContentHasher, Evaluation, Literal, Request};

const NOTHING: [&str; 0] = [];

fn rig(file: &str) -> Rig {
    let mut rig = Rig::default();
    rig.add("read-file", "file");
    rig.add("count", "twice");
    rig.link("file.text", "twice.text");
    rig.put("twice.count", Literal::Integer(2));
    rig.put("file.file", Literal::File(file.to_owned()));
    rig
}

fn evaluate(rig: &mut Rig, base: &Path) -> Evaluation {
    let target = rig.id("twice");
    rig.request(Request::nodes(&[target]).base(base))
}

fn ran(rig: &Rig) -> Vec<&str> {
    rig.log.iter().filter_map(|line| line.strip_prefix("finished ")).collect()
}

#[test]
fn content_counts_and_time_stamps_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("words.txt");
    let mut rig = rig("words.txt");
    let twice = rig.id("twice");
    std::fs::write(&path, "ab").unwrap();
    assert_eq!(evaluate(&mut rig, folder.path()).value::<String>(twice, "text"), Some(&"abab".to_owned()));
    assert_eq!(ran(&rig), ["file", "twice"]);

    evaluate(&mut rig, folder.path());
    assert_eq!(rig.log, ["planned 0", "hit twice"]);

    std::fs::write(&path, "ab").unwrap();
    evaluate(&mut rig, folder.path());
    assert_eq!(ran(&rig), NOTHING, "written anew with the same content");

    std::fs::write(&path, "cd").unwrap();
    assert_eq!(evaluate(&mut rig, folder.path()).value::<String>(twice, "text"), Some(&"cdcd".to_owned()));
    assert_eq!(ran(&rig), ["file", "twice"]);

    std::fs::write(&path, "ab").unwrap();
    assert_eq!(evaluate(&mut rig, folder.path()).value::<String>(twice, "text"), Some(&"abab".to_owned()));
    assert_eq!(ran(&rig), NOTHING, "known from before");
}

#[test]
fn a_missing_file_is_an_error_until_it_appears() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("words.txt");
    let mut rig = rig("words.txt");
    let (file, twice) = (rig.id("file"), rig.id("twice"));
    let missing = format!("failed: input \"file\": \"{}\" can't be read: NotFound", path.display());
    for _ in 0..2 {
        let evaluation = evaluate(&mut rig, folder.path());
        assert_eq!(state(&evaluation, file), missing);
        assert_eq!(state(&evaluation, twice), "waiting on file");
    }
    std::fs::write(&path, "x").unwrap();
    assert_eq!(evaluate(&mut rig, folder.path()).value::<String>(twice, "text"), Some(&"xx".to_owned()));
    std::fs::remove_file(&path).unwrap();
    assert_eq!(state(&evaluate(&mut rig, folder.path()), file), missing, "what is gone is not shown from memory");
    std::fs::write(&path, "x").unwrap();
    evaluate(&mut rig, folder.path());
    assert_eq!(ran(&rig), NOTHING);
}

#[test]
fn no_file_named_is_an_error_at_the_input() {
    let mut rig = rig("");
    let evaluation = evaluate(&mut rig, Path::new(""));
    assert_eq!(
        state(&evaluation, rig.id("file")),
        "failed: input \"file\": no file is named: give a path, relative to the folder of the graph"
    );
}

#[test]
fn another_base_folder_is_another_file() {
    let (one, two) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    std::fs::write(one.path().join("words.txt"), "1").unwrap();
    std::fs::write(two.path().join("words.txt"), "2").unwrap();
    let mut rig = rig("words.txt");
    let twice = rig.id("twice");
    for (folder, text) in [(&one, "11"), (&two, "22"), (&one, "11")] {
        assert_eq!(evaluate(&mut rig, folder.path()).value::<String>(twice, "text"), Some(&text.to_owned()));
    }
}

#[test]
fn a_path_may_come_from_a_link() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("words.txt"), "ab").unwrap();
    let mut rig = Rig::default();
    rig.register(kind("path", |node| {
        let file = node.file("file", &[], "The path.");
        let out = node.output::<maquette_graph::FilePath>("file", "The same.");
        node.evaluate(move |ports| {
            let path = ports.read(file).clone();
            ports.write(out, path);
            Ok(())
        });
    }));
    rig.add("path", "path");
    rig.put("path.file", Literal::File("words.txt".to_owned()));
    rig.add("read-file", "file");
    rig.link("path.file", "file.file");
    let file = rig.id("file");
    let evaluate = |rig: &mut Rig| rig.request(Request::nodes(&[file]).base(folder.path()));
    assert_eq!(evaluate(&mut rig).value::<String>(file, "text"), Some(&"ab".to_owned()));
    assert_eq!(evaluate(&mut rig).run_count(), 0);
    std::fs::write(folder.path().join("words.txt"), "cd").unwrap();
    let evaluation = evaluate(&mut rig);
    assert_eq!((evaluation.run_count(), evaluation.value::<String>(file, "text")), (1, Some(&"cd".to_owned())));
}

#[test]
fn fingerprints_are_taken_of_needed_nodes_only() {
    let asked = Arc::new(AtomicUsize::new(0));
    let mut rig = Rig::default();
    let counter = asked.clone();
    rig.register(kind("clock", |node| {
        let out = node.output::<f64>("number", "Always 1.");
        node.fingerprint(move |_| {
            counter.fetch_add(1, Ordering::SeqCst);
            Ok(ContentHasher::of_bytes(b"never changes"))
        });
        node.evaluate(move |ports| {
            ports.write(out, 1.0);
            Ok(())
        });
    }));
    rig.add("clock", "clock");
    rig.add("add", "sum");
    rig.link("clock.number", "sum.a");
    rig.add("add", "aside");
    assert_eq!(rig.ran(&["sum", "aside"]), ["clock", "sum", "aside"]);
    let before = asked.swap(0, Ordering::SeqCst);
    assert!((1..=2).contains(&before), "{before}");
    rig.set("aside.a", 7.0);
    assert_eq!(rig.ran(&["aside"]), ["aside"]);
    assert_eq!(asked.load(Ordering::SeqCst), 0);
    assert_eq!(rig.ran(&["sum"]), NOTHING);
    assert_eq!(asked.load(Ordering::SeqCst), 1);
}

#[test]
fn a_panicking_fingerprint_is_that_nodes_failure() {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let mut rig = Rig::default();
    rig.register(kind("broken", |node| {
        node.fingerprint(|_| unreachable!("no luck"));
        node.evaluate(|_| Ok(()));
    }));
    rig.add("broken", "broken");
    let evaluation = rig.evaluate(&["broken"]);
    std::panic::set_hook(hook);
    assert_eq!(
        state(&evaluation, rig.id("broken")),
        "failed: the node kind \"broken\" broke down (internal error: entered unreachable code: no luck); \
         this is a mistake in the kind, please report it"
    );
}
