//! Lines and columns of a text.

/// Line and column of any byte of a text, without reading the text again for each.
pub(super) struct LineIndex {
    /// Byte at which each line begins.
    lines: Vec<usize>,
    /// Bytes that continue a character and so have no column of their own.
    continuations: Vec<usize>,
}

impl LineIndex {
    pub(super) fn new(text: &str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        let continuations =
            text.bytes().enumerate().filter(|(_, byte)| byte & 0b1100_0000 == 0b1000_0000).map(|(at, _)| at).collect();
        Self { lines, continuations }
    }

    /// Line and column, both counted from 1, the column in characters.
    pub(super) fn place(&self, offset: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|start| *start <= offset).max(1);
        let start = self.lines[line - 1];
        let before = |byte| self.continuations.partition_point(|at| *at < byte);
        (line, 1 + (offset - start) - (before(offset) - before(start)))
    }

    /// Byte of a line and column, the inverse of [`LineIndex::place`]; the end of the line where it is shorter.
    pub(super) fn byte(&self, text: &str, line: usize, column: usize) -> usize {
        let Some(start) = self.lines.get(line.saturating_sub(1)) else { return text.len() };
        let rest = text.get(*start..).unwrap_or_default();
        let end = rest.find('\n').unwrap_or(rest.len());
        start + rest.char_indices().nth(column.saturating_sub(1)).map_or(end, |(byte, _)| byte.min(end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_newlines() {
        let text = "ab\nçdé€f\r\n\n𝄞x";
        let index = LineIndex::new(text);
        let mut expected = (1, 1);
        for (at, c) in text.char_indices() {
            assert_eq!(index.place(at), expected, "byte {at}");
            if c != '\n' {
                assert_eq!(index.byte(text, expected.0, expected.1), at);
            }
            expected = if c == '\n' { (expected.0 + 1, 1) } else { (expected.0, expected.1 + 1) };
        }
        assert_eq!(index.place(text.len()), (4, 3));
    }

    #[test]
    fn places_beyond_the_text_are_its_end_or_the_end_of_the_line() {
        let index = LineIndex::new("ab\ncd");
        assert_eq!(index.byte("ab\ncd", 1, 99), 2);
        assert_eq!(index.byte("ab\ncd", 2, 99), 5);
        assert_eq!(index.byte("ab\ncd", 99, 1), 5);
    }
}
