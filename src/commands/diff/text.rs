//! Differences as lines of text.

use super::differences::Difference;
use super::geometry::{Content, Distance, OutputDifference};
use super::strokes::StrokeDifference;

/// A length in metres, as millimetres with four places.
fn millimetres(metres: f64) -> String {
    let rounded = (metres * 1e7).round() / 1e4;
    if rounded == 0.0 && metres != 0.0 { format!("{:e} mm", metres * 1e3) } else { format!("{rounded} mm") }
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// One difference on one line, strokes on one line each.
pub(super) fn lines(difference: &Difference) -> Vec<String> {
    let whose = |node: &Option<String>| node.as_ref().map_or(String::new(), |node| format!("\"{node}\": "));
    let line = match difference {
        Difference::NodeRemoved { node, kind } => format!("- node \"{node}\" ({kind})"),
        Difference::NodeAdded { node, kind } => format!("+ node \"{node}\" ({kind})"),
        Difference::NodeRenamed { from, to, kind } => format!("~ node \"{from}\" is now \"{to}\" ({kind})"),
        Difference::Kind { node, from, to } => format!("~ \"{node}\": kind {from} -> {to}"),
        Difference::Input { node, input, from, to } => format!("~ \"{node}.{input}\": {from} -> {to}"),
        Difference::Strokes { node, input, strokes } => {
            return strokes.iter().map(|stroke| format!("~ \"{node}.{input}\": {}", stroke_line(stroke))).collect();
        }
        Difference::Note { node, from, to } => {
            let what = if node.is_some() { "note" } else { "notes" };
            format!("~ {}{what} {from:?} -> {to:?}", whose(node))
        }
        Difference::Field { node, field, from, to } => {
            let shown = |text: &Option<String>| {
                text.as_ref().map_or("nothing".to_owned(), |t| t.split_whitespace().collect::<Vec<_>>().join(" "))
            };
            format!("~ {}field {field}: {} -> {}", whose(node), shown(from), shown(to))
        }
        Difference::Parameter { parameter, from, to } => declared("parameter", parameter, from.as_ref(), to.as_ref()),
        Difference::Output { output, from, to } => declared("output", output, from.as_ref(), to.as_ref()),
        Difference::Muted { node, muted } => format!("~ \"{node}\" is {}", if *muted { "muted" } else { "not muted" }),
        Difference::Body { node, from, to } => format!("~ \"{node}\": body {from} -> {to}"),
        Difference::Within { node, difference } => {
            return lines(difference).iter().map(|line| format!("in \"{node}\": {line}")).collect();
        }
        Difference::Layout { node, from, to } => {
            let shown = |place: &Option<[f64; 2]>| place.map_or("nowhere".to_owned(), |[x, y]| format!("({x}, {y})"));
            format!("~ \"{node}\": layout {} -> {}", shown(from), shown(to))
        }
    };
    vec![line]
}

/// Something that the whole graph declares.
fn declared(what: &str, name: &str, from: Option<&String>, to: Option<&String>) -> String {
    match (from, to) {
        (Some(from), Some(to)) => format!("~ {what} \"{name}\": {from} -> {to}"),
        (Some(from), None) => format!("- {what} \"{name}\": {from}"),
        (None, to) => format!("+ {what} \"{name}\": {}", to.map_or("", String::as_str)),
    }
}

fn stroke_line(difference: &StrokeDifference) -> String {
    match difference {
        StrokeDifference::Removed { stroke, points } => {
            format!("stroke {stroke} removed ({})", count(*points, "point"))
        }
        StrokeDifference::Added { stroke, points } => format!("stroke {stroke} added ({})", count(*points, "point")),
        StrokeDifference::Renamed { from, to } => format!("stroke {from:?} is now {to:?}"),
        StrokeDifference::Moved { stroke, points, of, largest } => {
            let largest = millimetres(*largest);
            format!("stroke {stroke}: {points} of {} moved, by at most {largest}", count(*of, "point"))
        }
        StrokeDifference::Redrawn { stroke, from, to, largest } => {
            let apart = largest.map(|largest| format!(", at most {} apart", millimetres(largest))).unwrap_or_default();
            format!("stroke {stroke}: {from} points -> {to}{apart}")
        }
        StrokeDifference::Closed { stroke, closed } => {
            format!("stroke {stroke} is now {}", if *closed { "closed" } else { "open" })
        }
        StrokeDifference::Pressure { stroke, points } => {
            format!("stroke {stroke}: pressure of {} differs", count(*points, "point"))
        }
        StrokeDifference::Reordered => "strokes are in another order".to_owned(),
    }
}

/// How a result differs, on one line.
pub(super) fn output_line(difference: &OutputDifference) -> String {
    let OutputDifference { output, identical, from, to, there, back } = difference;
    let content = |content: &Content| match content {
        Content::Mesh { vertices, faces } => format!("{}, {}", vertices_of(*vertices), count(*faces, "face")),
        Content::Curves { curves, points } => format!("{}, {}", count(*curves, "curve"), count(*points, "point")),
    };
    let distance = |d: &Option<Distance>| match d {
        Some(Distance { largest, mean }) => format!("at most {}, mean {}", millimetres(*largest), millimetres(*mean)),
        None => "not to be measured".to_owned(),
    };
    match (from, to) {
        (Some(from), Some(to)) if *identical => {
            debug_assert_eq!(from, to);
            format!("= result \"{output}\": identical; {}", content(to))
        }
        (Some(from), Some(to)) => {
            let counts = if from == to { content(to) } else { format!("{} -> {}", content(from), content(to)) };
            format!("~ result \"{output}\": there {}; back {}; {counts}", distance(there), distance(back))
        }
        (Some(from), None) => format!("- result \"{output}\": {}", content(from)),
        (None, Some(to)) => format!("+ result \"{output}\": {}", content(to)),
        (None, None) if *identical => format!("= result \"{output}\": identical"),
        (None, None) => format!("~ result \"{output}\": no geometry to be measured"),
    }
}

fn vertices_of(number: usize) -> String {
    format!("{number} {}", if number == 1 { "vertex" } else { "vertices" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_keep_what_matters() {
        for (metres, expected) in
            [(0.0, "0 mm"), (0.004, "4 mm"), (0.000_123_4, "0.1234 mm"), (2e-12, "2e-9 mm"), (1.5, "1500 mm")]
        {
            assert_eq!(millimetres(metres), expected);
        }
    }
}
