//! What RON says about a text that it can't read, in the words of those who write graphs.

use ron::error::{Error, SpannedError};
use ron::value::RawValue;

use crate::file::FileError;
use crate::file::place::LineIndex;
use crate::file::tree::{FileTree, trimmed};

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
        other => other.to_string(),
    }
}

pub(super) fn syntax_error(text: &str, lines: &LineIndex, error: &SpannedError) -> FileError {
    let byte = |place: &ron::error::Position| lines.byte(text, place.line, place.col);
    let (start, end) = (byte(&error.span.start), byte(&error.span.end));
    let ends_early = matches!(error.code, Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment)
        || (error.code != Error::TrailingCharacters && text.get(end..).is_none_or(|rest| rest.trim().is_empty()));
    // Where the end comes too early, what was begun last is no mistake; but an open quote or comment is.
    let at = if error.code == Error::Eof { text.trim_end().len() } else { start };
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
    let at = text.find("#![")?;
    let first = [tree.version, tree.notes].into_iter().flatten().chain(tree.unknown.iter().map(|(_, raw)| *raw));
    let before_first =
        first.map(|raw| (trimmed(raw).as_ptr() as usize).saturating_sub(text.as_ptr() as usize)).min()?;
    // RON itself says whether that is an attribute or part of a comment: a raw value must have none.
    let head = text.get(..before_first)?;
    (at < before_first && RawValue::from_ron(&format!("{head}0)")).is_err()).then_some(at)
}
