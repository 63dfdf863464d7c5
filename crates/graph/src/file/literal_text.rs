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

pub(crate) fn parse(text: &str) -> Result<Spelled, LiteralError> {
    let text = text.trim();
    let fail = |error: ron::error::SpannedError| LiteralError {
        offset: LineIndex::new(text).byte(text, error.span.start.line, error.span.start.col),
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
