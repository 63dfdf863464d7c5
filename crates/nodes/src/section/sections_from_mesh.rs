//! **Sections from mesh**: cross-sections of a template mesh along a bone.
//! Reference: thesis 4.1.

use glam::DVec3;
use maquette_geometry::mesh::slice::{
    AlongOptions, Concern, Hit, Method, Positions, SectionOptions, SliceError, along_while,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
struct MethodChoice(Method);

impl Choices for MethodChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Method::Loop), "loop", "the outline around the bone, its points at equal distances; sees folds"),
        (
            Self(Method::Rays(Hit::Last)),
            "rays",
            "rays from the bone to the outermost surface, at equal angles (thesis 4.1); sees no folds, bridges holes \
             that no ray meets",
        ),
        (Self(Method::Rays(Hit::First)), "rays-first", "rays from the bone to the nearest surface"),
    ];
}

/// Numbers separated by commas or blanks.
fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split([',', ' ', '\n', '\t']).filter(|word| !word.is_empty());
    words
        .map(|word| match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let word: String = word.chars().take(40).collect();
                Err(format!("\"{word}\" is no number: give shares of the bone's length, separated by commas"))
            }
        })
        .collect()
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "sections-from-mesh",
        1,
        "section",
        "Cuts a template mesh along a bone: planes that turn smoothly with it, and in each the outline around the bone.",
    );
    node.reference("thesis 4.1");
    let mesh = node.input::<wire::Mesh>("mesh", "The template: a body, or a part of one.");
    let bone = node.input::<wire::Curve>(
        "bone",
        "Open curve inside of the mesh from one joint to the next: drawn, or from `import-skeleton`.",
    );
    let count = node.integer("count", 12, 1..=4096, "Sections, evenly along the bone; a single one in the middle.");
    node.soft_range(count, 2.0..=64.0);
    let from = node.number("from", 0.0, -10.0..=11.0, "Place of the first section: 0 is the bone's start, 1 its end.");
    node.soft_range(from, -0.5..=1.0);
    let to =
        node.number("to", 1.0, -10.0..=11.0, "Place of the last section; beyond its ends the bone goes on straight.");
    node.soft_range(to, 0.0..=1.5);
    let places = node.text(
        "at",
        "",
        "Places one by one, growing, separated by commas: \"0.1, 0.5, 0.9\". Empty takes `count` from `from` to `to`.",
    );
    let turning = node.number(
        "turning",
        0.3,
        0.0..=1.0,
        "Stretch around a joint over which the planes turn, as a share of the bone; longer where sections cross.",
    );
    let points = node.integer("points", 64, 3..=65_536, "Points of each section.");
    node.soft_range(points, 16.0..=256.0);
    let front = node.vector("front", [0.0, 0.0, 1.0], Unit::None, "Direction in which sections begin.");
    let method = node.choice::<MethodChoice>("method", "How the section is found in its plane.");
    let curves = node.output::<wire::Curves>(
        "curves",
        "The sections along the bone: closed, counter-clockwise about its direction, begun at the front.",
    );
    let found = node.figure("found", Unit::None, "Sections found.");
    let missed = node.figure("missed", Unit::None, "Planes that do not meet the mesh.");
    let off = node.figure("largest-offset", Unit::Length, "Largest distance of a section's middle from the bone.");
    let table = node.table(
        "sections",
        &[
            ("section", Unit::None),
            ("at", Unit::None),
            ("perimeter", Unit::Length),
            ("area", Unit::None),
            ("offset", Unit::Length),
            ("other-loops", Unit::None),
        ],
        "The sections: place along the bone, size (area in square metres), distance of the middle from the bone, other \
         closed loops in the plane.",
    );
    node.evaluate(move |ports| {
        let one_by_one = numbers(ports.read(places).as_str()).at(places)?;
        let evenly = one_by_one.is_empty();
        let options = AlongOptions {
            positions: match evenly {
                true => Positions::Count { count: ports.count(count), extent: [ports.value(from), ports.value(to)] },
                false => Positions::At(one_by_one),
            },
            turning: ports.value(turning),
            section: SectionOptions {
                points: ports.count(points),
                front: DVec3::from_array(ports.read(front).0),
                method: ports.choice(method).0,
            },
        };
        let sliced = along_while(&ports.read(mesh).0, &ports.read(bone).0, &options, &ports.progress_callback());
        let sliced = match sliced {
            Err(SliceError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ (SliceError::NoPolygons | SliceError::Curve { .. } | SliceError::Resample { .. })) => {
                return Err(error).at(mesh);
            }
            Err(error @ (SliceError::SectionCount { .. } | SliceError::OutOfReach { .. })) if evenly => {
                return Err(error).at(count);
            }
            Err(error @ (SliceError::Extent { .. } | SliceError::NotGrowing { .. })) if evenly => {
                return Err(error).at(to);
            }
            Err(
                error @ (SliceError::SectionCount { .. }
                | SliceError::OutOfReach { .. }
                | SliceError::NotGrowing { .. }),
            ) => return Err(error).at(places),
            Err(error @ SliceError::Turning { .. }) => return Err(error).at(turning),
            Err(error @ SliceError::PointCount { .. }) => return Err(error).at(points),
            Err(error @ SliceError::Front { .. }) => return Err(error).at(front),
            sliced => sliced.at(bone)?,
        };
        sliced.warnings.iter().for_each(|warning| ports.warn(warning));
        let shares = options.positions.fractions().at(places)?;
        let rows = sliced.sections.iter().map(|section| {
            let others = section.others.map_or(0, |others| others.around + others.beside);
            vec![
                section.index.into(),
                shares.get(section.index).copied().unwrap_or(0.0).into(),
                section.perimeter.into(),
                section.area.into(),
                section.offset.into(),
                others.into(),
            ]
        });
        ports.table(table, rows.collect());
        let planes_missed: usize = sliced
            .warnings
            .iter()
            .filter(|warning| warning.what == Concern::Missed)
            .map(|warning| warning.last - warning.first + 1)
            .sum();
        #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
        {
            ports.figure(found, sliced.sections.len() as f64);
            ports.figure(missed, planes_missed as f64);
        }
        ports.figure(off, sliced.sections.iter().map(|section| section.offset).fold(0.0, f64::max));
        ports.write(curves, wire::Curves(sliced.sections.into_iter().map(|section| section.curve).collect()));
        Ok(())
    });
    node
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_numbers_between_commas() {
        assert_eq!(numbers(" 0.1,0.5, 1e0\n"), Ok(vec![0.1, 0.5, 1.0]));
        assert_eq!(numbers(", ,"), Ok(vec![]));
        let refusal = "\"half\" is no number: give shares of the bone's length, separated by commas";
        assert_eq!(numbers("0.1, half"), Err(refusal.to_owned()));
        assert!(numbers("0.1, inf").is_err());
    }
}
