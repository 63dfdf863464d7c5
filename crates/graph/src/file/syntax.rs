//! What RON says about a text that it can't read, in the words of those who write graphs.

use ron::error::{Error, SpannedError};
use ron::value::RawValue;

use crate::file::FileError;
use crate::file::place::LineIndex;
use crate::file::tree::FileTree;

/// What is wrong, in plain words.
pub(super) fn in_words(error: &Error) -> String {
    match error {
        Error::Eof => "the text ends where more is expected".to_owned(),
        Error::ExpectedStringEnd => "a text has no closing quote".to_owned(),
        Error::UnclosedBlockComment => "a comment /* has no end */".to_owned(),
        Error::ExceededRecursionLimit => "brackets are nested too deeply to be read".to_owned(),
        Error::ExpectedNamedStructLike(_) | Error::ExpectedStructLike => "a '(' is expected here".to_owned(),
        Error::ExpectedMap => "a '{' is expected here".to_owned(),
        Error::ExpectedMapColon => "a ':' is expected here".to_owned(),
        Error::ExpectedComma => "a ',' or a closing bracket is expected here".to_owned(),
        Error::TrailingCharacters => "more text follows where the end is expected".to_owned(),
        Error::ExpectedIdentifier => "the name of a field is expected here, without quotes".to_owned(),
        Error::NoSuchEnumVariant { found, .. } => format!("\"{found}\" is not known"),
        // The names of Rust types say nothing to those who write graphs.
        other => other.to_string().replace("tuple variant Tagged::", "").replace("newtype variant Tagged::", ""),
    }
}

pub(super) fn syntax_error(text: &str, lines: &LineIndex, error: &SpannedError) -> FileError {
    let byte = |place: &ron::error::Position| lines.byte(text, place.line, place.col);
    let (start, end) = (byte(&error.span.start), byte(&error.span.end));
    let ends_early = matches!(error.code, Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment)
        || (error.code != Error::TrailingCharacters && text.get(end..).is_none_or(|rest| rest.trim().is_empty()));
    // Where the end comes too early, what was begun last is no mistake; but an open quote or comment is.
    let at = match error.code {
        Error::Eof => text.trim_end().len(),
        Error::UnclosedBlockComment => text.get(..start).and_then(|before| before.rfind("/*")).unwrap_or(start),
        _ => start,
    };
    // RON may point at the white space before what it stumbled over.
    let rest = text.get(at..).unwrap_or_default();
    let at = if rest.trim().is_empty() { at } else { at + rest.len() - rest.trim_start().len() };
    let (line, column) = lines.place(at);
    let remedy = if text.trim().is_empty() {
        "the file is empty: an empty graph is (version: 1, nodes: {})"
    } else if ends_early {
        "the file may have been cut off: compare it with a backup"
    } else {
        "a graph is written (version: 1, nodes: { \"name\": (kind: \"...\", inputs: { ... }) })"
    };
    FileError::Syntax { line, column, message: in_words(&error.code), remedy: remedy.to_owned() }
}

/// Where the file begins with attributes, which RON allows, but which a graph has no use for.
pub(super) fn attributes(text: &str, tree: &FileTree<'_>) -> Option<usize> {
    let fields = [tree.version, tree.notes].into_iter().flatten().chain(tree.unknown.iter().map(|(_, raw)| *raw));
    let places = fields.map(|raw| (raw.get_ron().as_ptr() as usize).saturating_sub(text.as_ptr() as usize));
    let head = text.get(..places.min().unwrap_or(text.len()))?;
    // Before the first attribute there is nothing but white space and comments, and so a value may follow.
    let mut candidates = head.match_indices("#![").map(|(at, _)| at);
    candidates.find(|at| RawValue::from_ron(&format!("{}0", &head[..*at])).is_ok())
}
