//! What is said to the person at the terminal: results on stdout, everything else on stderr, one message a line.

use std::io::Write as _;

/// Writes a line to stdout. A closed pipe (`| head`) is not an error.
pub fn say(line: impl AsRef<str>) {
    let _ = writeln!(std::io::stdout(), "{}", line.as_ref());
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
