//! What nodes that fit sections share: their choices, and how what they found is shown.

use std::f64::consts::PI;

use maquette_geometry::curve::Curve;
use maquette_geometry::trigonometric::{Angles, Continuity, EllipticSection, Joint, Solution};
use maquette_graph::{Cell, Choices, NodeKind, TableHandle, Unit};

use crate::wire::NamedSection;

/// Points of a section where it is made a curve without being asked for a number.
const POINTS: usize = 128;

#[derive(Clone, Copy)]
pub(crate) struct AnglesChoice(pub Angles);

impl Choices for AnglesChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Angles::Auto), "auto", "polar where every section is clearly star-shaped, else arc-length"),
        (Self(Angles::Polar), "polar", "the angle around the centre"),
        (Self(Angles::ArcLength), "arc-length", "in proportion to the length along the curve"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct ContinuityChoice(pub Continuity);

impl Choices for ContinuityChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Continuity::C1), "c1", "without a corner"),
        (Self(Continuity::C0), "c0", "with a corner where the curve has one"),
        (Self(Continuity::C2), "c2", "without a jump of curvature"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct SolutionChoice(pub Solution);

impl Choices for SolutionChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Solution::Together), "together", "all segments of a section at once: the best fit"),
        (Self(Solution::InTurn), "in-turn", "one after the other, as the thesis does"),
    ];
}

/// Joints from a text: angles in degrees, separated by commas, each with its continuity behind a colon where it is
/// another than `continuity`: `45, 180:C0, 300`.
///
/// # Errors
/// Says which entry can't be read, and how it is written.
pub(crate) fn joints(text: &str, continuity: Continuity) -> Result<Vec<Joint>, String> {
    let entries = text.split(',').map(str::trim).filter(|entry| !entry.is_empty());
    entries
        .map(|entry| {
            let wrong = || {
                let shown: String = entry.chars().take(24).collect();
                format!("{shown:?} is no joint: write an angle in degrees, such as 45, or 45:C0 where it is a corner")
            };
            let (angle, kind) = entry.split_once(':').map_or((entry, None), |(angle, kind)| (angle, Some(kind)));
            let angle = angle.trim().parse::<f64>().ok().filter(|angle| angle.is_finite()).ok_or_else(wrong)?;
            let continuity = match kind.map(|kind| kind.trim().to_ascii_lowercase()).as_deref() {
                None => continuity,
                Some("c0") => Continuity::C0,
                Some("c1") => Continuity::C1,
                Some("c2") => Continuity::C2,
                Some(_) => return Err(wrong()),
            };
            Ok(Joint { angle: angle * PI / 180.0, continuity })
        })
        .collect()
}

/// Declares the table of how well sections fit.
pub(crate) fn fit_table(node: &mut NodeKind) -> TableHandle {
    node.table(
        "sections",
        &[
            ("section", Unit::None),
            ("harmonics", Unit::None),
            ("mean", Unit::None),
            ("max", Unit::None),
            ("diagonal", Unit::Length),
            ("distance", Unit::Length),
            ("angle", Unit::Angle),
            ("met", Unit::None),
        ],
        "Each section: the most harmonics of its segments, mean and largest error as shares of its diagonal, the \
         largest distance with its angle, and whether the tolerances are met.",
    )
}

/// The row of that table for a section; without errors where it is no fit.
pub(crate) fn fit_row(named: &NamedSection) -> Vec<Cell> {
    let mut row: Vec<Cell> = vec![named.name.as_str().into(), named.section.harmonics().into()];
    match &named.fit {
        Some(fit) => row.extend([
            fit.mean.into(),
            fit.maximum.into(),
            fit.diagonal.into(),
            fit.worst_distance.into(),
            turned(fit.worst_angle, named.section.is_closed()).into(),
            Cell::from(fit.met),
        ]),
        None => row.extend([0.0.into(), 0.0.into(), 0.0.into(), 0.0.into(), 0.0.into(), Cell::from("exact")]),
    }
    row
}

/// An angle in degrees; of a closed section from 0 to below 360.
fn turned(angle: f64, closed: bool) -> f64 {
    let degrees = angle.to_degrees();
    if closed { degrees.rem_euclid(360.0) } else { degrees }
}

/// A section as a polyline of `count` points at equal steps of its angle.
///
/// # Errors
/// The section is a single point.
pub(crate) fn as_curve(name: &str, section: &EllipticSection, count: usize) -> Result<Curve, String> {
    Curve::new(name, section.sampled(count), section.is_closed())
        .map_err(|error| format!("section \"{name}\" is no curve: {error}"))
}

/// All sections as curves.
///
/// # Errors
/// A section is a single point.
pub(crate) fn as_curves(sections: &[NamedSection]) -> Result<Vec<Curve>, String> {
    sections.iter().map(|named| as_curve(&named.name, &named.section, POINTS)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_read_from_text() {
        let found = joints(" 45, 180:c0 ,300 : C2,", Continuity::C1).unwrap();
        let wanted = [(45.0, Continuity::C1), (180.0, Continuity::C0), (300.0, Continuity::C2)];
        assert_eq!(found.len(), 3);
        for (joint, (degrees, continuity)) in found.iter().zip(wanted) {
            assert!((joint.angle.to_degrees() - degrees).abs() < 1e-12 && joint.continuity == continuity);
        }
        assert_eq!(joints("", Continuity::C0), Ok(vec![]));
        for wrong in ["x", "45:C3", "45:", "inf", "1e999", "1:2:3"] {
            assert!(joints(wrong, Continuity::C1).unwrap_err().contains("is no joint"), "{wrong}");
        }
    }
}
