//! `maquette run --watch`: follows the graph and the files it names, runs what changed, waits for what is broken to be
//! mended, and ends when it is told to.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use command::{SKETCH, file, maquette, str};
use tempfile::TempDir;

/// Long enough for a busy machine; a test that passes does not wait for it.
const PATIENCE: Duration = Duration::from_secs(30);

/// A graph that reads `drawn.json`: `drawn` -> `even` -> `lines`, and a sketch beside it.
const IMPORT: &str = r#"(
    version: 1,
    nodes: {
        "drawn": (
            kind: "import-curves",
            inputs: {
                "file": File("drawn.json"),
            },
        ),
        "even": (
            kind: "resample",
            inputs: {
                "curves": Link("drawn.curves"),
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
)
"#;

struct Watch {
    folder: TempDir,
    process: Child,
    said: Receiver<String>,
    complained: Receiver<String>,
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn lines(stream: impl std::io::Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

impl Watch {
    /// Draws the curves, starts watching the graph, and waits for the first evaluation.
    fn start(options: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        draw(folder.path(), "0.1");
        let graph = file(&folder, "g.ron", IMPORT);
        let out = folder.path().join("out.json");
        let mut process = Command::new(env!("CARGO_BIN_EXE_maquette"))
            .args(["run", str(&graph), "--watch", "-o", str(&out)])
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let said = lines(process.stdout.take().unwrap());
        let complained = lines(process.stderr.take().unwrap());
        Self { folder, process, said, complained }
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out.json")
    }

    /// The next line on stdout, without the path before it.
    fn next(&self) -> String {
        let line = self.said.recv_timeout(PATIENCE).unwrap();
        line.split_once("g.ron: ").unwrap().1.to_owned()
    }

    fn complaint(&self) -> String {
        self.complained.recv_timeout(PATIENCE).unwrap()
    }

    /// Puts another graph in place, whole: what is half written would be complained about once more.
    fn write(&self, graph: &str) {
        let beside = file(&self.folder, "beside.ron", graph);
        std::fs::rename(beside, self.folder.path().join("g.ron")).unwrap();
    }

    /// Waits for the process to end by itself: its exit code.
    fn end(&mut self) -> i32 {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.process.try_wait().unwrap() {
                return status.code().unwrap();
            }
            assert!(begun.elapsed() < PATIENCE, "it does not end");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// Writes `drawn.json` with a corner at this height, as a whole.
fn draw(folder: &Path, height: &str) {
    let graph = folder.join("sketch.ron");
    std::fs::write(&graph, SKETCH.replace("(0.1, 0.1)", &format!("(0.1, {height})"))).unwrap();
    assert_eq!(maquette(&["run", str(&graph), "-q", "-o", str(&folder.join("drawn.json"))]).0, 0);
}

#[test]
fn only_what_changed_runs_again_and_outputs_follow() {
    let mut watch = Watch::start(&[]);
    let line = watch.next();
    assert!(line.starts_with("ran 3 (drawn, even, lines), 0 hits, "), "{line}");
    assert!(line.ends_with(&format!(" ms, wrote {}", watch.out().display())), "{line}");
    let first = std::fs::read(watch.out()).unwrap();

    watch.write(&IMPORT.replace("\"count\": 16", "\"count\": 24"));
    let line = watch.next();
    assert!(line.starts_with("ran 2 (even, lines), 1 hits, "), "{line}");
    let second = std::fs::read(watch.out()).unwrap();
    assert_ne!(first, second);

    // A broken state is complained about, and the last result stays until it is mended.
    watch.write(&IMPORT[..120]);
    assert!(watch.complaint().contains("the file may have been cut off"));
    assert_eq!(std::fs::read(watch.out()).unwrap(), second);
    std::fs::remove_file(watch.folder.path().join("g.ron")).unwrap();
    assert!(watch.complaint().contains("there is no such file"));
    watch.write(IMPORT);
    let line = watch.next();
    assert!(line.starts_with("ran 0, 3 hits, "), "what was computed before the accident is remembered: {line}");
    assert_eq!(std::fs::read(watch.out()).unwrap(), first);

    // The file that the graph reads.
    draw(watch.folder.path(), "0.2");
    let line = watch.next();
    assert!(line.starts_with("ran 3 (drawn, even, lines), 0 hits, "), "{line}");
    assert_ne!(std::fs::read(watch.out()).unwrap(), first);
    // And while that is missing, a node fails and says so.
    std::fs::remove_file(watch.folder.path().join("drawn.json")).unwrap();
    assert!(watch.complaint().contains("error: node \"drawn\", input \"file\": the file"));
    let line = watch.next();
    assert!(line.ends_with(", failed"), "{line}");
    draw(watch.folder.path(), "0.1");
    let line = watch.next();
    assert!(line.starts_with("ran 0, 3 hits, "), "{line}");

    let quiet = watch.said.recv_timeout(Duration::from_millis(400));
    assert_eq!(quiet, Err(RecvTimeoutError::Timeout), "nothing changed, nothing is said");
    drop(watch.process.stdin.take());
    assert_eq!(watch.end(), 0, "the end of stdin ends it");
}

#[test]
fn a_graph_that_begins_to_read_a_file_is_followed_there() {
    let watch = Watch::start(&["--json"]);
    let ran = || -> u64 {
        let line = watch.said.recv_timeout(PATIENCE).unwrap();
        let said: serde_json::Value = serde_json::from_str(&line).unwrap();
        said["ran"].as_u64().unwrap()
    };
    assert_eq!(ran(), 3);
    let other = watch.folder.path().join("other.json");
    std::fs::copy(watch.folder.path().join("drawn.json"), &other).unwrap();
    watch.write(&IMPORT.replace("drawn.json", "other.json"));
    // Its content is the same, so nothing behind it runs.
    assert_eq!(ran(), 1);
    draw(watch.folder.path(), "0.3");
    std::fs::rename(watch.folder.path().join("drawn.json"), other).unwrap();
    assert_eq!(ran(), 3);
}

#[test]
#[cfg(unix)]
fn signals_end_it_cleanly() {
    for signal in ["INT", "TERM"] {
        let mut watch = Watch::start(&[]);
        watch.next();
        let id = watch.process.id().to_string();
        assert!(Command::new("kill").args(["-s", signal, &id]).status().unwrap().success());
        assert_eq!(watch.end(), 0, "{signal}");
        let left: Vec<_> = std::fs::read_dir(watch.folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert!(left.iter().all(|name| !name.to_str().unwrap().starts_with(".maquette-")), "{left:?}");
    }
}

#[test]
fn what_can_not_be_watched_is_refused() {
    let (code, _, said) = maquette(&["run", "graphs/none.ron", "--watch"]);
    assert!(code == 2 && said.contains("there is no such file"), "{said}");
    // Writing what is read would go on without end.
    let watch = Watch::start(&[]);
    watch.next();
    watch.write(&IMPORT.replace("drawn.json", "out.json"));
    assert!(watch.complaint().contains("the graph reads this file; with --watch, write to another one"));
    watch.write(IMPORT);
    watch.next();
}

#[test]
fn parts_and_what_they_read_are_followed() {
    let mut watch = Watch::start(&[]);
    watch.next();
    let folder = watch.folder.path().to_owned();
    std::fs::create_dir(folder.join("parts")).unwrap();
    let (head, _) = IMPORT.split_once("        \"lines\": (").unwrap();
    let part = format!("{head}    }},\n    outputs: {{ \"curves\": (from: \"even.curves\") }},\n)\n");
    let put = |name: &str, content: &str| {
        std::fs::write(folder.join("beside"), content).unwrap();
        std::fs::rename(folder.join("beside"), folder.join("parts").join(name)).unwrap();
    };
    std::fs::copy(folder.join("drawn.json"), folder.join("parts/drawn.json")).unwrap();
    put("line.ron", &part);
    let using = r#"(version: 1, nodes: {
        "line": (kind: "graph", body: File("parts/line.ron")),
        "lines": (kind: "curves-out", inputs: { "curves": Link("line.curves") }),
    })"#;
    watch.write(using);
    let line = watch.next();
    assert!(line.starts_with("ran 1 (line), 1 hits, "), "{line}");
    // The part, broken, mended, and what it reads.
    put("line.ron", &part.replace("resample", "resampel"));
    let complaints = [watch.complaint(), watch.complaint()];
    assert!(complaints[0].contains("\"line\" gives nothing at \"curves\""), "{complaints:?}");
    assert!(complaints[1].contains("parts/line.ron:11:19: error: node \"even\": the node kind"), "{complaints:?}");
    put("line.ron", &part.replace("\"count\": 16", "\"count\": 24"));
    let line = watch.next();
    assert!(line.starts_with("ran 2 (line, lines), 0 hits, "), "{line}");
    draw(&folder, "0.3");
    std::fs::rename(folder.join("drawn.json"), folder.join("parts/drawn.json")).unwrap();
    let line = watch.next();
    assert!(line.starts_with("ran 2 (line, lines), 0 hits, "), "{line}");
    drop(watch.process.stdin.take());
    assert_eq!(watch.end(), 0);
}
