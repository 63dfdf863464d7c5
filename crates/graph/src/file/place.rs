//! Lines and columns of a text.

/// Bytes between the places that are noted: to find a byte's line, no more than these are read.
const STEP: usize = 256;

/// Line and column of any byte of a text, without reading the text again for each, and without taking more memory than
/// a tenth of the text.
pub(super) struct LineIndex<'a> {
    text: &'a str,
    /// At every `STEP`th byte.
    notes: Vec<Note>,
}

/// What lies before a byte.
#[derive(Clone, Copy, Default)]
struct Note {
    newlines: u32,
    characters: u32,
    /// Where the byte's line begins, and how many characters lie before that.
    line_start: u32,
    line_characters: u32,
}

impl Note {
    fn pass(&mut self, at: usize, byte: u8) {
        // Bytes that continue a character have no column of their own.
        self.characters += u32::from(byte & 0b1100_0000 != 0b1000_0000);
        if byte == b'\n' {
            self.newlines += 1;
            self.line_start = as_u32(at + 1);
            self.line_characters = self.characters;
        }
    }
}

/// Texts of graphs are far shorter than 4 GB; of a longer one, places far behind would be wrong.
fn as_u32(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

impl<'a> LineIndex<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let mut notes = Vec::with_capacity(text.len() / STEP + 1);
        let mut note = Note::default();
        for (index, piece) in text.as_bytes().chunks(STEP).enumerate() {
            notes.push(note);
            for (at, byte) in piece.iter().enumerate() {
                note.pass(index * STEP + at, *byte);
            }
        }
        Self { text, notes }
    }

    /// Line and column, both counted from 1, the column in characters.
    pub(super) fn place(&self, offset: usize) -> (usize, usize) {
        let index = (offset / STEP).min(self.notes.len().saturating_sub(1));
        let mut note = self.notes.get(index).copied().unwrap_or_default();
        let end = offset.min(self.text.len());
        for (at, byte) in self.text.as_bytes().get(index * STEP..end).unwrap_or_default().iter().enumerate() {
            note.pass(index * STEP + at, *byte);
        }
        (1 + note.newlines as usize, 1 + (note.characters - note.line_characters) as usize)
    }

    /// Byte of a line and column, the inverse of [`LineIndex::place`]; the end of the line where it is shorter.
    pub(super) fn byte(&self, line: usize, column: usize) -> usize {
        let wanted = as_u32(line.saturating_sub(1));
        let index = self.notes.partition_point(|note| note.newlines < wanted).saturating_sub(1);
        let near = self.text.as_bytes().get(index * STEP..).unwrap_or_default();
        let mut newlines = self.notes.get(index).map_or(0, |note| note.newlines);
        let mut start =
            if newlines == wanted { self.notes.get(index).map(|note| note.line_start as usize) } else { None };
        for (at, byte) in near.iter().enumerate() {
            if newlines >= wanted {
                break;
            }
            newlines += u32::from(*byte == b'\n');
            start = Some(index * STEP + at + 1);
        }
        if newlines < wanted {
            return self.text.len();
        }
        let start = start.unwrap_or(0);
        let rest = self.text.get(start..).unwrap_or_default();
        let end = rest.find('\n').unwrap_or(rest.len());
        start + rest.char_indices().nth(column.saturating_sub(1)).map_or(end, |(byte, _)| byte.min(end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_newlines() {
        let short = "ab\nçdé€f\r\n\n𝄞x";
        let long = [short, &"é".repeat(700), "\n", &"\n".repeat(600), &short.repeat(100)].concat();
        for text in [short, &long] {
            let index = LineIndex::new(text);
            let mut expected = (1, 1);
            for (at, c) in text.char_indices() {
                assert_eq!(index.place(at), expected, "byte {at}");
                assert_eq!(index.byte(expected.0, expected.1), at);
                expected = if c == '\n' { (expected.0 + 1, 1) } else { (expected.0, expected.1 + 1) };
            }
            assert_eq!(index.place(text.len()), expected);
        }
        assert_eq!(LineIndex::new(short).place(short.len()), (4, 3));
        assert_eq!(LineIndex::new("").place(0), (1, 1));
    }

    #[test]
    fn places_beyond_the_text_are_its_end_or_the_end_of_the_line() {
        let index = LineIndex::new("ab\ncd");
        assert_eq!(index.byte(1, 99), 2);
        assert_eq!(index.byte(2, 99), 5);
        assert_eq!(index.byte(99, 1), 5);
        assert_eq!(index.place(99), (2, 3));
    }
}
