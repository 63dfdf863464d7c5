//! A literal as a file spells it.

use serde::Deserialize;

use crate::file::place::LineIndex;
use crate::file::syntax::in_words;
use crate::literal::{Literal, Stroke};

/// What a file may say at an input.
pub(crate) enum Spelled {
    Literal(Literal),
    /// "node.output"
    Link(String),
    /// The name of a parameter of the graph.
    Parameter(String),
}

#[derive(Deserialize)]
enum Tagged {
    Link(String),
    Parameter(String),
    Text(String),
    Choice(String),
    File(String),
    Vector(f64, f64, f64),
    Colour(f64, f64, f64, f64),
    Strokes(Vec<Stroke>),
}

/// Why a text is no literal.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct LiteralError {
    /// Byte within the text.
    pub offset: usize,
    /// What is wrong and what is expected.
    pub message: String,
}

const EXPECTED: &str = "write a number, true, false, Link(\"node.output\"), Parameter(\"...\"), Text(\"...\"), \
                        Choice(\"...\"), Vector(x, y, z), Colour(r, g, b, a), File(\"...\") or Strokes([...])";

/// Reads a literal as a file spells it, such as `0.5`, `Choice("smooth")` or `Vector(0.0, 1.0, 0.0)`.
///
/// # Errors
/// The text is no literal; says where and what is expected.
pub fn parse_literal(text: &str) -> Result<Literal, LiteralError> {
    match parse(text)? {
        Spelled::Literal(literal) => Ok(literal),
        Spelled::Link(_) => {
            Err(LiteralError { offset: 0, message: "a link can't stand here; write a value".to_owned() })
        }
        Spelled::Parameter(_) => {
            Err(LiteralError { offset: 0, message: "a parameter can't stand here; write a value".to_owned() })
        }
    }
}

/// A text in double quotes as it is mostly written, without anything that has a meaning of its own. To read all of RON
/// takes many times as long, and large graphs are mostly names and links.
pub(super) fn plain_text(piece: &str) -> Option<&str> {
    let inside = piece.strip_prefix('"')?.strip_suffix('"')?;
    (!inside.bytes().any(|byte| byte == b'"' || byte == b'\\')).then_some(inside)
}

/// A link as it is mostly written.
fn plain_link(piece: &str) -> Option<&str> {
    plain_text(piece.strip_prefix("Link(")?.strip_suffix(')')?)
}

/// A number as it is mostly written: digits, a sign, a point, an exponent.
fn plain_number(piece: &str) -> Option<Literal> {
    let digits = piece.strip_prefix('-').unwrap_or(piece);
    if !digits.starts_with(|c: char| c.is_ascii_digit()) || digits.ends_with('.') {
        return None;
    }
    if digits.len() < 18 && digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return piece.parse().ok().map(Literal::Integer);
    }
    let mut marks = digits.bytes().filter(|byte| !byte.is_ascii_digit());
    let is_fraction = marks.next() == Some(b'.') && marks.next().is_none();
    if is_fraction { piece.parse().ok().map(Literal::Number) } else { None }
}

pub(crate) fn parse(text: &str) -> Result<Spelled, LiteralError> {
    let text = text.trim();
    if let Some(address) = plain_link(text) {
        return Ok(Spelled::Link(address.to_owned()));
    }
    if let Some(number) = plain_number(text) {
        return Ok(Spelled::Literal(number));
    }
    let fail = |error: ron::error::SpannedError| LiteralError {
        offset: LineIndex::new(text).byte(error.span.start.line, error.span.start.col),
        message: format!("{}; {EXPECTED}", in_words(&error.code)),
    };
    let literal = match text.chars().next() {
        None => return Err(LiteralError { offset: 0, message: format!("nothing is written; {EXPECTED}") }),
        Some('"') => {
            return Err(LiteralError {
                offset: 0,
                message: "a bare text does not say what it is; write Link(\"node.output\"), Text(\"...\"), \
                          Choice(\"...\") or File(\"...\")"
                    .to_owned(),
            });
        }
        Some(c) if c.is_ascii_digit() || "+-.".contains(c) || text == "NaN" || text == "inf" => {
            match ron::from_str::<i64>(text) {
                Ok(integer) => Literal::Integer(integer),
                Err(_) => Literal::Number(ron::from_str(text).map_err(fail)?),
            }
        }
        _ if text == "true" || text == "false" => Literal::Boolean(text == "true"),
        _ => match ron::from_str(text).map_err(fail)? {
            Tagged::Link(address) => return Ok(Spelled::Link(address)),
            Tagged::Parameter(name) => return Ok(Spelled::Parameter(name)),
            Tagged::Text(text) => Literal::Text(text),
            Tagged::Choice(option) => Literal::Choice(option),
            Tagged::File(path) => Literal::File(path),
            Tagged::Vector(x, y, z) => Literal::Vector([x, y, z]),
            Tagged::Colour(r, g, b, a) => Literal::Colour([r, g, b, a]),
            Tagged::Strokes(strokes) => Literal::Strokes(strokes),
        },
    };
    Ok(Spelled::Literal(literal))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_plainly_written_reads_as_ron_reads_it() {
        for text in [
            "0",
            "-0",
            "7",
            "-12",
            "0.5",
            "-0.0",
            "00.10",
            "12345678901234567",
            "0.1e5",
            "1.",
            "-",
            "1.2.3",
            "1e5",
            "0x1",
            "1_0",
            "1f64",
        ] {
            match plain_number(text) {
                Some(Literal::Integer(integer)) => assert_eq!(ron::from_str::<i64>(text), Ok(integer), "{text}"),
                Some(Literal::Number(number)) => {
                    assert_eq!(ron::from_str::<f64>(text).unwrap().to_bits(), number.to_bits(), "{text}");
                    assert!(ron::from_str::<i64>(text).is_err(), "{text}");
                }
                other => assert_eq!(other, None, "{text}"),
            }
        }
        assert_eq!(plain_number("0.25"), Some(Literal::Number(0.25)));
        for text in ["\"\"", "\"a b\"", "\"é\n//\"", "\"a\\n\"", "\"a\"b\"", "r\"a\"", "a", "\""] {
            if let Some(plain) = plain_text(text) {
                assert_eq!(ron::from_str::<String>(text).as_deref(), Ok(plain), "{text}");
            }
        }
        assert_eq!(plain_text("\"a b\""), Some("a b"));
        assert_eq!((plain_text("\"a\\n\""), plain_text("\"a\"b\""), plain_text("\"")), (None, None, None));
        assert_eq!(plain_link("Link(\"a.b\")"), Some("a.b"));
        assert_eq!((plain_link("Link(\"a\", \"b\")"), plain_link("Link( \"a.b\")")), (None, None));
    }
}
