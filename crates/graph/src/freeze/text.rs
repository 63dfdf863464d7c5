//! Golden files as text: RON, long lists wrapped, numbers to the last bit.

use std::fmt::Write as _;

use super::Frozen;
use crate::file::{number, quoted};

/// Columns after which a list is wrapped.
const WIDTH: usize = 110;

/// Writes plain data as RON, its continuation lines indented by so many levels.
pub(super) fn write(text: &mut String, frozen: &Frozen, level: usize) {
    match frozen {
        Frozen::Number(single) => {
            let _ = write!(text, "Number({})", number(*single));
        }
        Frozen::Numbers(numbers) => wrapped(text, "Numbers", numbers.iter().map(|n| number(*n)), level),
        Frozen::Points(points) => {
            let point = |[x, y, z]: &[f64; 3]| format!("({}, {}, {})", number(*x), number(*y), number(*z));
            wrapped(text, "Points", points.iter().map(point), level);
        }
        Frozen::Integers(integers) => wrapped(text, "Integers", integers.iter().map(ToString::to_string), level),
        Frozen::Boolean(flag) => {
            let _ = write!(text, "Boolean({flag})");
        }
        Frozen::Text(content) => {
            let _ = write!(text, "Text({})", quoted(content));
        }
        Frozen::Bytes(content) => {
            let _ = write!(text, "Bytes({})", quoted(content));
        }
        Frozen::Nothing => text.push_str("Nothing"),
        Frozen::List(parts) => block(text, "List([", parts, "])", level, write),
        Frozen::Record(fields) => block(text, "Record([", fields, "])", level, |text, (name, value), level| {
            let _ = write!(text, "({}, ", quoted(name));
            write(text, value, level);
            text.push(')');
        }),
    }
}

fn block<T>(
    text: &mut String,
    open: &str,
    parts: &[T],
    close: &str,
    level: usize,
    part: impl Fn(&mut String, &T, usize),
) {
    text.push_str(open);
    for item in parts {
        indent(text, level + 1);
        part(text, item, level + 1);
        text.push(',');
    }
    if !parts.is_empty() {
        indent(text, level);
    }
    text.push_str(close);
}

fn wrapped(text: &mut String, name: &str, parts: impl Iterator<Item = String>, level: usize) {
    let _ = write!(text, "{name}([");
    let parts: Vec<String> = parts.collect();
    let short = parts.iter().map(|part| part.len() + 2).sum::<usize>() + 4 * level < WIDTH;
    if short {
        let _ = write!(text, "{}])", parts.join(", "));
        return;
    }
    let mut column = WIDTH;
    for part in &parts {
        if column + part.len() + 2 > WIDTH {
            indent(text, level + 1);
            column = 4 * (level + 1);
        } else {
            text.push(' ');
        }
        let _ = write!(text, "{part},");
        column += part.len() + 2;
    }
    indent(text, level);
    text.push_str("])");
}

fn indent(text: &mut String, level: usize) {
    text.push('\n');
    text.extend(std::iter::repeat_n("    ", level));
}
