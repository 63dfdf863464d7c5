//! **Pick sections**: some sections of a stack, in the order asked for, as series and as curves.

use maquette_graph::{AtPort, NodeKind};

use crate::fitting::as_curve;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "pick-sections",
        1,
        "section",
        "Some sections of a stack: what was fitted together, with angles that correspond, becomes parts that share sections.",
    );
    let sections = node.input::<wire::EllipticSections>("sections", "The stack.");
    let which = node.text(
        "which",
        "",
        "Numbers from 0, ranges or names, with commas between them: 0-5, 8, crown. Empty takes all.",
    );
    let count = node.integer("count", 128, 3..=65_536, "Points on each curve, at equal steps of the angle.");
    node.soft_range(count, 8.0..=256.0);
    let picked = node.output::<wire::EllipticSections>("sections", "The sections in the order asked for.");
    let curves = node.output::<wire::Curves>("curves", "The same as curves; sections that are a point are left out.");
    node.evaluate(move |ports| {
        let all = &ports.read(sections).0;
        let chosen = chosen(ports.read(which).as_str(), all).at(which)?;
        let points = ports.count(count);
        let mut drawn = Vec::new();
        for named in &chosen {
            ports.progress(0.5)?;
            drawn.extend(as_curve(&named.name, &named.section, points));
        }
        ports.write(curves, wire::Curves(drawn));
        ports.write(picked, wire::EllipticSections::new(chosen));
        Ok(())
    });
    node
}

/// Most sections that are picked; the same may be picked again and again.
const MOST: usize = 65_536;

fn chosen(which: &str, all: &[wire::NamedSection]) -> Result<Vec<wire::NamedSection>, String> {
    let mut chosen = Vec::new();
    let mut entries = which.split(',').map(str::trim).filter(|entry| !entry.is_empty()).peekable();
    if entries.peek().is_none() {
        return Ok(all.to_vec());
    }
    for entry in entries {
        let named: Vec<_> = all.iter().filter(|named| named.name == entry).collect();
        match (named.as_slice(), range(entry)) {
            ([named], _) => chosen.push((*named).clone()),
            ([], Some((from, to))) if from.max(to) < all.len() => {
                if chosen.len() + from.abs_diff(to) >= MOST {
                    return Err(format!("more than {MOST} sections are asked for: take fewer"));
                }
                let upward = all.get(from..=to).unwrap_or_default().iter();
                let downward = all.get(to..=from).unwrap_or_default().iter().rev();
                chosen.extend(if from <= to {
                    upward.cloned().collect()
                } else {
                    downward.cloned().collect::<Vec<_>>()
                });
            }
            ([], _) => {
                let shown: String = entry.chars().take(24).collect();
                let last = all.len().saturating_sub(1);
                return Err(match all.len() {
                    0 => "the stack has no sections: fit some".to_owned(),
                    _ => format!("no section is called {shown:?}; there are 0 to {last}"),
                });
            }
            (several, _) => {
                return Err(format!("{} sections are named {entry:?}: give a number instead", several.len()));
            }
        }
    }
    Ok(chosen)
}

/// `3`, `0-5`, or downward `5-0`.
fn range(entry: &str) -> Option<(usize, usize)> {
    match entry.split_once('-') {
        Some((from, to)) => Some((from.trim().parse().ok()?, to.trim().parse().ok()?)),
        None => entry.parse().ok().map(|only| (only, only)),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use maquette_geometry::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    use super::*;

    fn named(name: &str) -> wire::NamedSection {
        let series = Series::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
        let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
        let section = EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Z), true, vec![segment]).unwrap();
        wire::NamedSection { name: name.to_owned(), section, fit: None }
    }

    #[test]
    fn numbers_ranges_and_names() {
        let all: Vec<_> = ["a", "b", "crown", "twin", "twin"].map(named).to_vec();
        let names =
            |which: &str| chosen(which, &all).map(|found| found.iter().map(|n| n.name.clone()).collect::<Vec<_>>());
        assert_eq!(names("0-2").unwrap(), ["a", "b", "crown"]);
        assert_eq!(names("2-0, 3").unwrap(), ["crown", "b", "a", "twin"]);
        assert_eq!(names(" crown ,1").unwrap(), ["crown", "b"]);
        assert_eq!(names("").unwrap().len(), 5);
        for (which, said) in
            [("5", "there are 0 to 4"), ("0-9", "no section"), ("twin", "2 sections are named"), ("-1", "no section")]
        {
            assert!(names(which).unwrap_err().contains(said), "{which}");
        }
        assert!(chosen("0", &[]).unwrap_err().contains("has no sections"));
        let many = ["0-4"; 20_000].join(",");
        assert!(names(&many).unwrap_err().contains("take fewer"));
    }
}
