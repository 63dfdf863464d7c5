//! Text that stays on its line.

use std::borrow::Cow;

/// The text with line breaks and whatever else could tear a message apart written as `\n`, `\u{..}`. Letters of all
/// scripts, quotes and backslashes stay.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    let breaks = |c: char| {
        // Line and paragraph separators, and marks that turn the direction of writing.
        c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(breaks) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if breaks(c) { line.extend(c.escape_default()) } else { line.push(c) }
    }
    Cow::Owned(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_breaks_the_line_is_escaped() {
        assert_eq!(one_line("größe \"C:\\x\" 𝄞"), "größe \"C:\\x\" 𝄞");
        assert_eq!(one_line("a\nb\r\tc\u{2028}d\u{202e}e\u{1b}[1m"), "a\\nb\\r\\tc\\u{2028}d\\u{202e}e\\u{1b}[1m");
    }
}
