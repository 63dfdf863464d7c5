//! What is said to the person at the terminal: results on stdout, everything else on stderr, one message a line.

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};

static LOST: AtomicBool = AtomicBool::new(false);

/// Writes a line to stdout. A closed pipe (`| head`) is fine; anything else that goes wrong is remembered.
pub fn say(line: impl AsRef<str>) {
    let mut out = std::io::stdout();
    let written = writeln!(out, "{}", line.as_ref()).and_then(|()| out.flush());
    if written.is_err_and(|error| error.kind() != std::io::ErrorKind::BrokenPipe) {
        LOST.store(true, Ordering::Relaxed);
    }
}

/// Whether something could not be written to stdout, because the disk is full, say.
pub fn lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Writes an error to stderr.
pub fn error(message: impl AsRef<str>) {
    line("error: ", message.as_ref());
}

/// Writes a warning to stderr.
pub fn warning(message: impl AsRef<str>) {
    line("warning: ", message.as_ref());
}

/// Writes a line to stderr as it is.
pub fn remark(message: impl AsRef<str>) {
    line("", message.as_ref());
}

fn line(prefix: &str, message: &str) {
    let _ = writeln!(std::io::stderr(), "{prefix}{message}");
}
