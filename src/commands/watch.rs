//! `run --watch`: evaluates again whenever the graph or a file it names changes.

use std::collections::BTreeMap;
use std::io::{IsTerminal as _, Read as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use maquette_graph::CancelToken;

use super::run::Runner;
use super::{Ended, console};

/// How often the files are looked at. Asking is used in place of the system's notifications because those don't come
/// from network drives.
const INTERVAL: Duration = Duration::from_millis(100);

/// What tells one state of a file from another; `None` where there is none.
type Stamp = Option<(SystemTime, u64, u64)>;

fn stamp(path: &Path) -> Stamp {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len(), identity(&data)))
}

/// A file that was put in the place of another differs in this although time and size may be equal.
#[cfg(unix)]
fn identity(data: &std::fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(data)
}

#[cfg(not(unix))]
fn identity(_: &std::fs::Metadata) -> u64 {
    0
}

/// Evaluates, then waits for a change, until it is stopped.
pub(super) fn watch(runner: &mut Runner<'_>, graph: &Path) -> Ended {
    if !graph.exists() {
        return runner.refuse(&[format!("{}: error: there is no such file: check the path", graph.display())]);
    }
    if let Err(error) = stop_on_signals(&runner.cancel) {
        console::error(format!("Ctrl-C can't be listened for: {error}"));
        return Ended::Wrong;
    }
    stop_at_end_of_input(&runner.cancel);
    let mut files: Vec<PathBuf> = Vec::new();
    while !runner.cancel.is_cancelled() {
        // Taken before the files are read, so that a change while they are read is seen.
        let mut stamps: BTreeMap<PathBuf, Stamp> = std::iter::once(graph)
            .chain(files.iter().map(PathBuf::as_path))
            .map(|p| (p.to_owned(), stamp(p)))
            .collect();
        match runner.open() {
            Ok(opened) => {
                files = opened.file.files();
                stamps.retain(|path, _| path == graph || files.contains(path));
                stamp_new(&mut stamps, &files);
                match overwritten(runner, graph, &files) {
                    Some(message) => drop(runner.refuse(&[message])),
                    None => drop(runner.pass(opened)),
                }
            }
            Err(messages) => {
                // What is wrong may lie in a file that the graph includes.
                files.extend(runner.files());
                stamp_new(&mut stamps, &files);
                let _ = runner.refuse(&messages);
            }
        }
        while !runner.cancel.is_cancelled() && stamps.iter().all(|(path, before)| stamp(path) == *before) {
            std::thread::sleep(INTERVAL);
        }
    }
    Ended::Done
}

/// Stamps the files that were not followed before.
fn stamp_new(stamps: &mut BTreeMap<PathBuf, Stamp>, files: &[PathBuf]) {
    for path in files {
        stamps.entry(path.clone()).or_insert_with(|| stamp(path));
    }
}

/// A result that would be written over what is read would be read again, without end.
fn overwritten(runner: &Runner<'_>, graph: &Path, files: &[PathBuf]) -> Option<String> {
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let read: Vec<PathBuf> = files.iter().map(PathBuf::as_path).chain([graph]).map(real).collect();
    let written = runner.written_files().find(|path| read.contains(&real(path)))?;
    Some(format!("error: {}: the graph reads this file; with --watch, write to another one", written.display()))
}

/// Stops what this token is given to on Ctrl-C and on signals that end a program; may be asked for once in a process.
pub(super) fn stop_on_signals(cancel: &CancelToken) -> Result<(), ctrlc::Error> {
    let cancel = cancel.clone();
    ctrlc::set_handler(move || cancel.cancel())
}

/// Stops when a terminal says so (Ctrl-D) or a pipe is closed, which is how an editor or a script that started the
/// watch ends it. A stdin that is closed or empty from the beginning, as that of a service, says nothing.
fn stop_at_end_of_input(cancel: &CancelToken) {
    if !std::io::stdin().is_terminal() && !stdin_is_pipe() {
        return;
    }
    let cancel = cancel.clone();
    std::thread::spawn(move || {
        let mut buffer = [0; 256];
        while std::io::stdin().read(&mut buffer).is_ok_and(|count| count > 0) {}
        cancel.cancel();
    });
}

#[cfg(unix)]
fn stdin_is_pipe() -> bool {
    use std::os::fd::AsFd as _;
    use std::os::unix::fs::FileTypeExt as _;
    let data = std::io::stdin().as_fd().try_clone_to_owned().and_then(|fd| std::fs::File::from(fd).metadata());
    data.is_ok_and(|data| data.file_type().is_fifo() || data.file_type().is_socket())
}

#[cfg(not(unix))]
fn stdin_is_pipe() -> bool {
    true
}
