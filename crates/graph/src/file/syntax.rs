//! What RON says about a text that it can't read, in the words of those who write graphs.

use ron::error::{Error, SpannedError};

use crate::file::FileError;
use crate::file::place::LineIndex;

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
        Error::NoSuchStructField { expected, found, outer } => {
            let whose = noun(outer.as_deref());
            format!("{whose} has no field \"{found}\"; it has {}", expected.join(", "))
        }
        Error::MissingStructField { field, outer } => {
            format!("{} lacks the field \"{field}\"", noun(outer.as_deref()))
        }
        Error::DuplicateStructField { field, outer } => {
            format!("{} has the field \"{field}\" twice", noun(outer.as_deref()))
        }
        Error::ExpectedDifferentLength { expected, found } => wrong_length(expected, *found),
        Error::InvalidValueForType { expected, found } => format!("{} is expected here, not {found}", thing(expected)),
        Error::ExpectedArray => "a '[' is expected here".to_owned(),
        Error::ExpectedArrayEnd => "a ',' or a ']' is expected here".to_owned(),
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => {
            "a ')' is expected here: nothing more belongs into these brackets".to_owned()
        }
        Error::ExpectedMapEnd => "a ',' or a '}' is expected here".to_owned(),
        Error::ExpectedBoolean => "true or false is expected here".to_owned(),
        Error::ExpectedInteger => "a whole number is expected here".to_owned(),
        Error::ExpectedFloat => "a number is expected here".to_owned(),
        Error::ExpectedString => "a text in double quotes is expected here".to_owned(),
        Error::FloatUnderscore | Error::UnderscoreAtBeginning => "a number has a '_' in the wrong place".to_owned(),
        Error::IntegerOutOfBounds => "a whole number is too large".to_owned(),
        Error::InvalidIntegerDigit { digit, base } => {
            format!("{digit:?} is no digit of a whole number of base {base}")
        }
        Error::InvalidEscape(_) => {
            "a text has a '\\' that means nothing: write \\\\ for a backslash, or a raw text r\"...\"".to_owned()
        }
        Error::UnexpectedChar(found) => format!("{found:?} can't stand here"),
        Error::InvalidIdentifier(found) | Error::SuggestRawIdentifier(found) => {
            format!("{found:?} is not the name of a field")
        }
        Error::ExpectedDifferentStructName { found, .. } => format!("the name {found:?} can't stand before this '('"),
        Error::NoSuchExtension(name) => format!("the attribute for {name:?} means nothing in a graph"),
        Error::Message(message) => message.clone(),
        other => format!("this can't be understood ({other})"),
    }
}

/// What a type of this library is called in a file.
fn noun(outer: Option<&str>) -> &'static str {
    match outer {
        Some("Stroke") => "a stroke",
        _ => "this",
    }
}

/// What a value should have been, in plain words.
fn thing(expected: &str) -> String {
    match expected {
        "f64" | "f32" => "a number".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a string" => "a text in double quotes".to_owned(),
        "a sequence" => "a list [...]".to_owned(),
        other => plain(other),
    }
}

/// Names of Rust types say nothing to those who write graphs.
fn plain(expected: &str) -> String {
    expected.replace("tuple variant Tagged::", "").replace("newtype variant Tagged::", "").replace("struct ", "")
}

/// What has too few or too many parts. RON says what it expected as "tuple variant Tagged::Vector with 3 elements".
fn wrong_length(expected: &str, found: usize) -> String {
    let given = match found {
        0 => "none is given".to_owned(),
        1 => "1 is given".to_owned(),
        many => format!("{many} are given"),
    };
    let plain = plain(expected);
    match plain.strip_suffix(" elements").and_then(|rest| rest.rsplit_once(" with ")) {
        Some((name, count)) => format!("{name} takes {count} numbers, and {given}"),
        None => format!("{plain} is expected here, and of its numbers {given}"),
    }
}

pub(super) fn syntax_error(text: &str, lines: &LineIndex<'_>, error: &SpannedError) -> FileError {
    let byte = |place: &ron::error::Position| lines.byte(place.line, place.col);
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
pub(super) fn attributes(text: &str) -> Option<usize> {
    let at = text.len() - behind_blanks(text).len();
    text[at..].starts_with('#').then_some(at)
}

/// The text behind white space and comments.
fn behind_blanks(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        rest = if let Some(line) = rest.strip_prefix("//") {
            line.find('\n').map_or("", |end| &line[end..])
        } else if rest.starts_with("/*") {
            behind_comment(rest)
        } else {
            return rest;
        }
        .trim_start();
    }
}

/// The text behind a block comment, which may hold others.
fn behind_comment(text: &str) -> &str {
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(found) = text[at..].find(['/', '*']) {
        at += found;
        let rest = &text[at..];
        if rest.starts_with("/*") {
            (at, depth) = (at + 2, depth + 1);
        } else if rest.starts_with("*/") {
            (at, depth) = (at + 2, depth.saturating_sub(1));
            if depth == 0 {
                return &text[at..];
            }
        } else {
            at += 1;
        }
    }
    ""
}
