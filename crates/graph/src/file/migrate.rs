//! Old files: brought to the present, in memory whenever they are read, on disk by [`migrate`].
//!
//! Two things change. The *format*: a step for each version leads to the next, on the text, before anything is read. The
//! *kinds*: names that they had before, and defaults, which the reader replaces. What is written back is the text of the
//! file with just these places changed, so that comments, order and layout stay.

use std::ops::Range;

use crate::catalogue::Catalogue;
use crate::file::limit::Meter;
use crate::file::read::{BYTE_ORDER_MARK, from_text};
use crate::file::tree::{take_apart, trimmed};
use crate::file::{FORMAT_VERSION, FileError, Problem, Severity, to_text};

/// Leads a text of one version to the next; the number itself is changed apart from it. Lines stay where they are, because
/// what is said about a file names them.
pub(super) type Step = fn(&str) -> String;

/// The first leads from version 1 to 2. There must be one for each version but the present.
pub(super) const STEPS: [Step; FORMAT_VERSION as usize - 1] = [];

/// A text of the present version and the version that it had, where that is older. `version` is the piece of the text
/// that says it.
pub(super) fn to_present(text: &str, version: Option<&str>, steps: &[Step]) -> Option<(String, u32)> {
    let present = u32::try_from(steps.len()).ok()? + 1;
    let was: u32 = ron::from_str(version?).ok()?;
    let steps = steps.get(usize::try_from(was.checked_sub(1)?).ok()?..)?;
    let mut text = text.to_owned();
    for (number, step) in (was + 1..).zip(steps) {
        text = step(&text);
        // What a step makes unreadable is for the reader to report.
        let Some(at) = version_place(&text) else { break };
        text.replace_range(at, &number.to_string());
    }
    (was < present).then_some((text, was))
}

/// Where a text says its version.
fn version_place(text: &str) -> Option<Range<usize>> {
    let tree = take_apart(text, &Meter::default()).ok()?;
    let piece = trimmed(tree.version?);
    let start = (piece.as_ptr() as usize).checked_sub(text.as_ptr() as usize)?;
    Some(start..start + piece.len())
}

/// A place of a text with what belongs there now.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Rewrite {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) text: String,
}

fn rewritten(text: &str, rewrites: &[Rewrite]) -> String {
    let mut rewrites: Vec<_> = rewrites.iter().collect();
    rewrites.sort();
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for Rewrite { start, end, text: new } in rewrites {
        out.push_str(text.get(done..*start).unwrap_or_default());
        out.push_str(new);
        done = (*end).max(done);
    }
    out.push_str(text.get(done..).unwrap_or_default());
    out
}

/// A file as the present version writes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Migrated {
    /// The text; the same as before where there are no notes.
    pub text: String,
    /// What changed, in the order of the file.
    pub notes: Vec<Problem>,
}

/// Brings the text of a file to the present: format, names of kinds, inputs, outputs and options, defaults that were other
/// ones. Everything else stays as it is written, comments too. What is wrong with the file otherwise is no matter here.
///
/// # Errors
/// Nothing in it can be understood.
pub fn migrate(catalogue: &Catalogue, text: &str) -> Result<Migrated, FileError> {
    let (mark, plain) = match text.strip_prefix(BYTE_ORDER_MARK) {
        Some(plain) => (BYTE_ORDER_MARK.to_string(), plain),
        None => (String::new(), text),
    };
    let loaded = from_text(catalogue, plain)?;
    let notes: Vec<_> = loaded.problems.iter().filter(|p| p.severity == Severity::Note).cloned().collect();
    if notes.is_empty() {
        return Ok(Migrated { text: text.to_owned(), notes });
    }
    let version = version_place(plain).and_then(|at| plain.get(at));
    let present = to_present(plain, version, &STEPS).map_or_else(|| plain.to_owned(), |(text, _)| text);
    let mut changed = rewritten(&present, &loaded.rewrites);
    let stable = to_text(&loaded.graph);
    // To be sure: what is written must read as what was read. Where a place was hard to find, the stable form is.
    let is_good = from_text(catalogue, &changed).is_ok_and(|again| {
        to_text(&again.graph) == stable && again.problems.iter().all(|p| p.severity != Severity::Note)
    });
    if !is_good {
        changed = stable;
    }
    Ok(Migrated { text: mark + &changed, notes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lead_from_any_version_to_the_present() {
        let first: Step = |text| text.replace("one", "two");
        let second: Step = |text| text.replace("two", "three");
        let steps = [first, second];
        let at =
            |version: &str, word: &str| format!("( // {word}\n version: {version} /* here */, nodes: {{}}, x: {word})");
        let led = |version: &str, word: &str| to_present(&at(version, word), Some(version), &steps);
        assert_eq!(led("1", "one"), Some((at("3", "three"), 1)));
        assert_eq!(led("2", "two"), Some((at("3", "three"), 2)));
        for present in ["3", "4", "0", "-1", "4294967295", "99999999999", "\"1\"", "x"] {
            assert_eq!(led(present, "one"), None, "{present}");
        }
        assert_eq!(to_present("(nodes: {})", None, &steps), None);
    }

    #[test]
    fn a_step_that_breaks_the_text_is_left_to_the_reader() {
        let breaks: Step = |_| "(".to_owned();
        let fine: Step = |text| text.to_owned();
        assert_eq!(to_present("(version: 1, nodes: {})", Some("1"), &[breaks, fine]), Some(("(".to_owned(), 1)));
    }

    #[test]
    fn rewrites_change_their_places_alone() {
        let rewrite = |start, end, text: &str| Rewrite { start, end, text: text.to_owned() };
        let rewrites = [rewrite(6, 7, "C"), rewrite(0, 1, "alpha"), rewrite(3, 3, "+")];
        assert_eq!(rewritten("a, b, c.", &rewrites), "alpha, +b, C.");
    }
}
