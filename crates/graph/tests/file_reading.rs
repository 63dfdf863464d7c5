//! Nodes that read files run again when the content of the file changes, and only then.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use kinds::{Block, Rig, kind, state};
use maquette_graph::{Evaluation, EvaluatorOptions, FilePath, Literal, Request};

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
    assert_eq!(rig.log, ["hit twice", "planned 0"]);

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
    let missing = format!(
        "failed: input \"file\": the file {} does not exist: put it there, or correct the path (it starts at the \
         graph's folder)",
        path.display()
    );
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
fn only_needed_files_are_read_and_unchanged_ones_not_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("words.txt");
    std::fs::write(&path, "ab").unwrap();
    settle();
    let mut rig = rig("words.txt");
    rig.add("add", "aside");
    let aside = rig.id("aside");
    assert_eq!(rig.request(Request::nodes(&[aside]).base(folder.path())).run_count(), 1);
    assert_eq!(rig.evaluator.file_reads(), 0, "not needed");
    evaluate(&mut rig, folder.path());
    assert_eq!((ran(&rig), rig.evaluator.file_reads()), (vec!["file", "twice"], 1), "once for hash and node");
    for count in 3..6 {
        rig.put("twice.count", Literal::Integer(count));
        evaluate(&mut rig, folder.path());
        assert_eq!((ran(&rig), rig.evaluator.file_reads()), (vec!["twice"], 1));
    }
    // Another node that reads it, and a graph of its own.
    rig.add("read-file", "again");
    rig.put("again.file", Literal::File("./words.txt".to_owned()));
    let again = rig.id("again");
    rig.request(Request::nodes(&[again]).base(folder.path()));
    assert_eq!(rig.evaluator.file_reads(), 2, "another path is another node, which needs the bytes");
    std::fs::write(&path, "cd").unwrap();
    settle();
    let both = [rig.id("twice"), again];
    let evaluation = rig.request(Request::nodes(&both).base(folder.path()));
    assert_eq!(evaluation.value::<String>(again, "text"), Some(&"cd".to_owned()));
    assert_eq!(rig.evaluator.file_reads(), 3, "once for both");
    rig.evaluator.forget();
    rig.request(Request::nodes(&both).base(folder.path()));
    assert_eq!(rig.evaluator.file_reads(), 4);
}

/// Until the file's times tell a further change.
fn settle() {
    std::thread::sleep(Duration::from_millis(200));
}

#[test]
fn nodes_that_read_one_file_at_the_same_time_share_one_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("words.txt"), "ab").unwrap();
    settle();
    for threads in [1, 2, 8] {
        let mut rig = Rig::with_threads(threads);
        rig.register(kind("read-and-add", |node| {
            let file = node.file("file", &[], "What to read.");
            let number = node.number("number", 0.0, -1e9..=1e9, "Makes nodes differ.");
            let out = node.output::<f64>("number", "Number of bytes and that.");
            node.reads_file(file);
            node.evaluate(move |ports| {
                let bytes = ports.file(file)?.len();
                ports.write(out, ports.value(number) + f64::from(u32::try_from(bytes).unwrap_or(0)));
                Ok(())
            });
        }));
        let ids: Vec<_> = (0..20)
            .map(|i| {
                let id = rig.add("read-and-add", &format!("n{i}"));
                rig.put(&format!("n{i}.file"), Literal::File("words.txt".to_owned()));
                rig.set(&format!("n{i}.number"), f64::from(i));
                id
            })
            .collect();
        let evaluation = rig.request(Request::nodes(&ids).base(folder.path()));
        assert_eq!((evaluation.run_count(), rig.evaluator.file_reads()), (20, 1));
        assert_eq!(evaluation.value::<f64>(ids[19], "number"), Some(&21.0));
    }
}

#[test]
fn a_change_while_nodes_run_poisons_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("words.txt");
    std::fs::write(&path, "old").unwrap();
    settle();
    let mut rig = Rig::default();
    rig.register(kind("scribble", |node| {
        let out = node.output::<FilePath>("file", "The file it wrote to.");
        let path = path.clone();
        node.evaluate(move |ports| {
            std::fs::write(&path, "new")?;
            ports.write(out, FilePath("words.txt".to_owned()));
            Ok(())
        });
    }));
    rig.add("scribble", "scribble");
    for name in ["before", "behind"] {
        rig.add("read-file", name);
    }
    rig.put("before.file", Literal::File("words.txt".to_owned()));
    rig.link("scribble.file", "behind.file");
    let (before, behind) = (rig.id("before"), rig.id("behind"));
    let texts = |rig: &mut Rig| {
        let evaluation = rig.request(Request::nodes(&[before, behind]).base(folder.path()));
        [before, behind].map(|id| evaluation.value::<String>(id, "text").cloned().unwrap())
    };
    assert_eq!(texts(&mut rig), ["old", "old"], "one evaluation sees one content, that of the first look");
    assert_eq!(texts(&mut rig), ["new", "new"]);
    std::fs::write(&path, "old").unwrap();
    assert_eq!(texts(&mut rig), ["old", "old"]);
    assert_eq!(ran(&rig), NOTHING, "the memo holds the right text under the right content");
}

#[test]
fn a_file_that_vanishes_after_the_memo_let_its_import_go_leaves_no_stale_keys() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("words.txt");
    std::fs::write(&path, "ab").unwrap();
    settle();
    let remove = Arc::new(AtomicBool::new(false));
    let mut rig = Rig::with_options(&EvaluatorOptions { threads: 1, byte_budget: Block::BYTES + 100_000 });
    let living = Arc::default();
    rig.register(kind("block", |node| {
        let tag = node.number("tag", 0.0, -1e9..=1e9, "What to tell blocks apart by.");
        let out = node.output::<Block>("block", "Fills the memo.");
        node.evaluate(move |ports| {
            ports.write(out, Block::new(ports.value(tag), &living));
            Ok(())
        });
    }));
    rig.register(kind("remover", |node| {
        let (path, remove) = (path.clone(), remove.clone());
        let out = node.output::<f64>("number", "One.");
        node.evaluate(move |ports| {
            if remove.load(Ordering::SeqCst) {
                std::fs::remove_file(&path)?;
            }
            ports.write(out, 1.0);
            Ok(())
        });
    }));
    rig.register(kind("joint", |node| {
        let first = node.optional::<f64>("first", "Looked at first.");
        let text = node.input::<String>("second", "A text.");
        let out = node.output::<String>("text", "The text.");
        node.evaluate(move |ports| {
            let _ = ports.read_optional(first);
            let text = ports.read(text).clone();
            ports.write(out, text);
            Ok(())
        });
    }));
    rig.add("remover", "remover");
    rig.add("read-file", "file");
    rig.put("file.file", Literal::File("words.txt".to_owned()));
    std::fs::write(folder.path().join("copy.txt"), "ab").unwrap();
    rig.add("read-file", "copy");
    rig.put("copy.file", Literal::File("copy.txt".to_owned()));
    for (name, from) in [("joint", "file"), ("aside", "file"), ("joint of copy", "copy"), ("aside of copy", "copy")] {
        rig.add("joint", name);
        rig.link(&format!("{from}.text"), &format!("{name}.second"));
    }
    rig.link("remover.number", "joint.first");
    rig.link("remover.number", "joint of copy.first");
    rig.add("block", "block");
    let evaluate = |rig: &mut Rig, name: &str| {
        let id = rig.id(name);
        state(&rig.request(Request::nodes(&[id]).base(folder.path())), id)
    };
    for name in ["joint", "aside"] {
        assert_eq!(evaluate(&mut rig, name), "done: \"ab\"");
    }
    // The memo lets go of all but the last block, and the file vanishes when the import is about to run again.
    for tag in [1.0, 2.0] {
        rig.set("block.tag", tag);
        evaluate(&mut rig, "block");
    }
    remove.store(true, Ordering::SeqCst);
    assert_eq!(evaluate(&mut rig, "joint"), "waiting on file");
    assert!(rig.log.iter().any(|line| line.starts_with("failed file: input \"file\": the file")), "{:?}", rig.log);
    remove.store(false, Ordering::SeqCst);
    // The copy brings the old results back into the memo, where stale keys would find them.
    for name in ["joint of copy", "aside of copy"] {
        assert_eq!(evaluate(&mut rig, name), "done: \"ab\"");
    }
    for name in ["joint", "aside"] {
        assert_eq!(evaluate(&mut rig, name), "waiting on file", "what is gone is not shown from memory");
    }
    std::fs::write(&path, "cd").unwrap();
    for name in ["aside", "joint"] {
        assert_eq!(evaluate(&mut rig, name), "done: \"cd\"");
    }
}

#[test]
fn bytes_are_not_kept_after_the_evaluation() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("words.txt"), "ab").unwrap();
    let kept: Arc<Mutex<Option<std::sync::Weak<[u8]>>>> = Arc::default();
    let mut rig = Rig::default();
    rig.register(kind("keep", |node| {
        let file = node.file("file", &[], "What to read.");
        node.reads_file(file);
        let kept = kept.clone();
        node.evaluate(move |ports| {
            let bytes = ports.file(file)?;
            if let Ok(mut kept) = kept.lock() {
                *kept = Some(Arc::downgrade(&bytes));
            }
            Ok(())
        });
    }));
    let keep = rig.add("keep", "keep");
    rig.put("keep.file", Literal::File("words.txt".to_owned()));
    assert!(rig.request(Request::nodes(&[keep]).base(folder.path())).is_complete());
    assert_eq!(kept.lock().unwrap().as_ref().unwrap().strong_count(), 0);
}

#[test]
fn a_kind_that_reads_without_saying_so_is_told() {
    let mut rig = Rig::default();
    rig.register(kind("sly", |node| {
        let file = node.file("file", &[], "Read on the sly.");
        node.evaluate(move |ports| ports.file(file).map(drop));
    }));
    let sly = rig.add("sly", "sly");
    assert_eq!(
        state(&rig.evaluate(&["sly"]), sly),
        "failed: input \"file\": the node kind \"sly\" reads this file without declaring it with `reads_file`; \
         this is a mistake in the kind"
    );
}
