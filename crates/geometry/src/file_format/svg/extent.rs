//! How large a drawing is: how far its paths reach, and how many and how deep its elements are once every `use` shows a copy of what it names: a few lines can ask for millions
//! of elements.

use std::collections::HashMap;

use usvg::roxmltree::{Document, Node};

use super::malformed;
use crate::file_format::ReadError;

/// Deepest nesting of elements that is read.
pub(super) const MAX_DEPTH: u32 = 256;

/// Largest number in the data of a path. Arcs are cut into the more parts the larger they are; those of 1e30 pixels take
/// hundreds of thousands each.
const MAX_NUMBER: f64 = 1e9;

/// Most elements of a drawing of so many bytes; without copies, an element takes four.
fn most_elements(bytes: usize) -> u64 {
    100_000 + bytes as u64 / 4
}

/// What an element becomes, itself included.
#[derive(Clone, Copy, Default)]
struct Extent {
    elements: u64,
    depth: u32,
}

#[derive(Clone, Copy)]
enum State {
    New,
    /// What it shows is being counted. What shows itself shows nothing more.
    Open,
    Done(Extent),
}

/// Refuses a drawing that would become too deep or too large. Without recursion, unlike what comes behind it.
pub(super) fn check_extent(document: &Document<'_>, bytes: usize) -> Result<(), ReadError> {
    for node in document.descendants() {
        if let Some(number) = node.attribute("d").and_then(too_far) {
            let row = document.text_pos_at(node.range().start).row;
            let problem = format!("a path has the number {number:e}: draw within {MAX_NUMBER:e} pixels");
            return Err(malformed(format!("line {row}"), problem));
        }
    }
    let mut named: HashMap<&str, Node<'_, '_>> = HashMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            named.entry(id).or_insert(node);
        }
    }
    let shown = |node: Node<'_, '_>| {
        let reference = node.attributes().find(|attribute| attribute.name() == "href");
        let id = reference.filter(|_| node.tag_name().name() == "use")?.value().trim().strip_prefix('#')?;
        named.get(id).copied()
    };
    let mut states = vec![State::New; document.descendants().count()];
    let mut pending = vec![(document.root(), false)];
    while let Some((node, is_counted)) = pending.pop() {
        let index = node.id().get_usize();
        let parts = || node.children().filter(Node::is_element).chain(shown(node));
        match states.get(index) {
            Some(State::New) => {
                states[index] = State::Open;
                pending.push((node, true));
                pending.extend(parts().map(|part| (part, false)));
            }
            Some(State::Open) if is_counted => {
                let mut extent = Extent { elements: 1, depth: 0 };
                for part in parts() {
                    if let Some(State::Done(part)) = states.get(part.id().get_usize()) {
                        extent.elements = extent.elements.saturating_add(part.elements);
                        extent.depth = extent.depth.max(part.depth);
                    }
                }
                extent.depth = extent.depth.saturating_add(1);
                // The document itself is no element.
                if extent.depth > MAX_DEPTH + 1 {
                    let row = document.text_pos_at(node.range().start).row;
                    let problem = format!("elements are nested deeper than {MAX_DEPTH}, copies by \"use\" included");
                    return Err(malformed(format!("line {row}"), problem));
                }
                if extent.elements > most_elements(bytes) {
                    let row = document.text_pos_at(node.range().start).row;
                    let problem = format!(
                        "it becomes more than {} elements, copies by \"use\" included: draw fewer copies",
                        most_elements(bytes)
                    );
                    return Err(malformed(format!("line {row}"), problem));
                }
                states[index] = State::Done(extent);
            }
            _ => {}
        }
    }
    Ok(())
}

/// A number of a path's data that is too large, signs apart.
fn too_far(data: &str) -> Option<f64> {
    let bytes = data.as_bytes();
    let digits = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_digit()).count();
    let mut at = 0;
    while at < bytes.len() {
        let start = at;
        at += digits(at);
        if bytes.get(at) == Some(&b'.') {
            at += 1 + digits(at + 1);
        }
        if at > start && matches!(bytes.get(at), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
            let exponent = digits(at + 1 + sign);
            at += if exponent > 0 { 1 + sign + exponent } else { 0 };
        }
        if let Some(number) = data.get(start..at).and_then(|text| text.parse().ok()).filter(|n: &f64| *n > MAX_NUMBER) {
            return Some(number);
        }
        at = at.max(start + 1);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_paths_are_found_however_they_are_written() {
        for fine in
            ["", "M0 0L1e9-1e9", "M.5.5.5e1h1e-30", "e99", "a1 1 0 0110 10", ".", "1e", "1e+", "M1é2", "999999999.9"]
        {
            assert_eq!(too_far(fine), None, "{fine}");
        }
        for (far, number) in
            [("M0 0L1e10", 1e10), ("1.5.5E+30", 5e29), ("-2000000000", 2e9), ("M1,1e999", f64::INFINITY)]
        {
            assert_eq!(too_far(far), Some(number), "{far}");
        }
    }
}
