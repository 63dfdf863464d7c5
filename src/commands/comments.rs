//! Comments in the text of a graph.

/// Line and column, both counted from 1, of each comment: `// ..` and `/* .. */`, which may be nested. Marks within
/// texts, raw texts and characters are none.
pub(super) fn comments(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        at += match rest[0] {
            b'/' if rest.starts_with(b"//") => {
                found.push(at);
                rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len())
            }
            b'/' if rest.starts_with(b"/*") => {
                found.push(at);
                block(rest)
            }
            b'"' => quoted(rest, b'"'),
            b'\'' => quoted(rest, b'\''),
            b'r' => raw(rest).unwrap_or(1),
            _ => 1,
        };
    }
    let place = |at: &usize| {
        let line = text[..*at].rfind('\n').map_or(0, |end| end + 1);
        (1 + text[..*at].matches('\n').count(), 1 + text[line..*at].chars().count())
    };
    found.iter().map(place).collect()
}

/// Bytes of the block comment that this begins with.
fn block(text: &[u8]) -> usize {
    let (mut at, mut depth) = (0, 0);
    while at < text.len() {
        let rest = &text[at..];
        if rest.starts_with(b"/*") {
            (at, depth) = (at + 2, depth + 1);
        } else if rest.starts_with(b"*/") {
            (at, depth) = (at + 2, depth - 1);
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    at
}

/// Bytes of the text or character that this begins with.
fn quoted(text: &[u8], quote: u8) -> usize {
    let mut at = 1;
    while at < text.len() {
        match text[at] {
            b'\\' => at += 2,
            byte if byte == quote => return at + 1,
            _ => at += 1,
        }
    }
    text.len()
}

/// Bytes of the raw text that this begins with; `None` where it is a name.
fn raw(text: &[u8]) -> Option<usize> {
    let hashes = text[1..].iter().take_while(|b| **b == b'#').count();
    if text.get(1 + hashes) != Some(&b'"') {
        return None;
    }
    let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
    let start = 2 + hashes;
    let length = text[start..].windows(end.len()).position(|w| w == end);
    Some(length.map_or(text.len(), |length| start + length + end.len()))
}

#[cfg(test)]
mod tests {
    use super::comments;

    #[test]
    fn comments_are_found_and_nothing_else() {
        for (text, expected) in [
            ("(a: 1)", vec![]),
            ("// x\n(a: 1) // y", vec![(1, 1), (2, 8)]),
            ("(a: \"// no\", b: \"\\\"/* no\")", vec![]),
            ("(a: r#\"\" // no\"#, c: r\"//\") /* yes */", vec![(1, 29)]),
            ("(r#type: '\"', b: '\\'') // yes", vec![(1, 24)]),
            ("/* a /* b */ // c */ (a: 1)\n  // é\n", vec![(1, 1), (2, 3)]),
            ("(é: \"é\" // x", vec![(1, 9)]),
            ("(a: 1 / 2 * 3)", vec![]),
            ("/* open", vec![(1, 1)]),
            ("\"open // x\\", vec![]),
            ("r#\"open // x\"", vec![]),
            ("r", vec![]),
            ("/", vec![]),
        ] {
            assert_eq!(comments(text), expected, "{text}");
        }
    }
}
