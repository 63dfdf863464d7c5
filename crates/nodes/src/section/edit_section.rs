//! **Edit section**: a drawn contour, or moved handles, in the place of one section of a stack.
//! Reference: thesis 3.1, 4.1.

use glam::{DQuat, DVec3};
use maquette_geometry::curve::{Curve, CurveError};
use maquette_geometry::trigonometric::{
    EllipticSection, FitError, HandlesError, Harmonics, PlaneFrame, RefitOptions, Tolerances, refit,
};
use maquette_graph::{AtPort, Choices, NodeKind, Unit};

use crate::fitting::{AnglesChoice, fit_row, fit_table};
use crate::wire;

#[derive(Clone, Copy)]
enum Place {
    Plane,
    AsDrawn,
}

impl Choices for Place {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Plane, "plane", "turned into the plane of the section it replaces, its centre on that one's"),
        (Self::AsDrawn, "as-drawn", "where it is"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "edit-section",
        1,
        "section",
        "Puts a drawn contour, or the section pulled by handles, in the place of one section of a stack.",
    );
    node.reference("thesis 3.1, 3.2, 4.1; angles and joints stay those of the stack");
    let sections = node.input::<wire::EllipticSections>("sections", "The stack.");
    let index = node.integer("index", 0, 0..=65_536, "Which section, counted from 0.");
    node.soft_range(index, 0.0..=32.0);
    let contour = node.optional::<wire::Curve>("contour", "The contour that takes its place; closed where it is.");
    let place = node.choice::<Place>("place", "Where the contour goes.");
    let handles = node.optional::<wire::Curve>(
        "handles",
        "Instead of a contour: points that the section is pulled through, of which the first is at its first angle and the \
         others follow at equal steps. pick-sections gives them as they are before they are moved.",
    );
    let angles = node.choice::<AnglesChoice>("angles", "Angles of the contour; auto is as in the section it replaces.");
    let harmonics = node.integer(
        "harmonics",
        0,
        0..=100,
        "Harmonics of every segment of the contour; 0 is the fewest that meet the tolerances.",
    );
    node.soft_range(harmonics, 0.0..=15.0);
    let most = node.integer("most-harmonics", 30, 1..=100, "Most harmonics tried, where harmonics is 0.");
    let mean = node.number("mean-error", 0.01, 1e-12..=1.0, "Mean error allowed, as a share of the diagonal.");
    node.soft_range(mean, 0.001..=0.05);
    let maximum = node.number("max-error", 0.025, 1e-12..=1.0, "Largest error allowed, as a share of the diagonal.");
    node.soft_range(maximum, 0.002..=0.1);
    let distance =
        node.length("largest-distance", 0.0, 0.0..=1e3, "Besides, the largest distance allowed; 0 is no limit.");
    node.soft_range(distance, 0.0..=0.02);
    let edited = node.output::<wire::EllipticSections>("sections", "The stack with the new section.");
    let moved =
        node.figure("moved", Unit::Length, "Largest distance between the old and the new section at one angle.");
    let table = fit_table(&mut node);
    node.evaluate(move |ports| {
        let stack = &ports.read(sections).0;
        let at = ports.count(index);
        let Some(old) = stack.get(at) else {
            let message = match stack.len() {
                0 => "the stack has no sections".to_owned(),
                count => format!("there is no section {at}: the last one is {}", count - 1),
            };
            return Err(message).at(index);
        };
        ports.progress(0.0)?;
        let new = match (ports.read_optional(contour), ports.read_optional(handles)) {
            (Some(drawn), None) => {
                let placed = match ports.choice(place) {
                    Place::AsDrawn => drawn.0.clone(),
                    Place::Plane => laid(&drawn.0, &old.section).at(contour)?,
                };
                let options = RefitOptions {
                    harmonics: match ports.count(harmonics) {
                        0 => Harmonics::Smallest { most: ports.count(most) },
                        fixed => Harmonics::Fixed(fixed),
                    },
                    tolerances: Tolerances { mean: ports.value(mean), maximum: ports.value(maximum) },
                    largest_distance: Some(ports.value(distance)).filter(|limit| *limit > 0.0),
                    angles: ports.choice(angles).0,
                };
                use FitError as E;
                let fitted = match refit(&old.section, &placed, &options) {
                    Err(E::Mixed { closed, .. }) => {
                        let [new, old] = if closed { ["closed", "open"] } else { ["open", "closed"] };
                        let message = format!("the contour is {new} and the section {old}: draw it {old}");
                        return Err(message).at(contour);
                    }
                    Err(error @ (E::PolarOpen { .. } | E::NotStarShaped { .. })) => return Err(error).at(angles),
                    Err(error @ E::TooManyHarmonics { .. }) => return Err(error).at(harmonics),
                    Err(error @ E::TooFewHarmonics { .. }) => {
                        return if ports.count(harmonics) > 0 { Err(error).at(harmonics) } else { Err(error).at(most) };
                    }
                    fitted => fitted.at(contour)?,
                };
                fitted.report.warnings.iter().for_each(|warning| ports.warn(warning));
                wire::NamedSection::fitted(drawn.0.name(), &fitted)
            }
            (None, Some(pulled)) => {
                let section = match old.section.with_handles(pulled.0.points()) {
                    Err(error @ HandlesError::LocalAngle { .. }) => return Err(error).at(sections),
                    section => section.at(handles)?,
                };
                wire::NamedSection { name: old.name.clone(), section, fit: None }
            }
            (Some(_), Some(_)) => {
                return Err("a contour and handles arrive: disconnect one of them").at(handles);
            }
            (None, None) => {
                return Err("nothing takes the section's place: connect a contour, or handles").at(contour);
            }
        };
        let pairs = old.section.sampled(256).into_iter().zip(new.section.sampled(256));
        ports.figure(moved, pairs.map(|(a, b)| a.distance(b)).fold(0.0, f64::max));
        let mut all = stack.to_vec();
        if let Some(section) = all.get_mut(at) {
            *section = new;
        }
        ports.table(table, all.iter().map(fit_row).collect());
        ports.write(edited, wire::EllipticSections::new(all));
        Ok(())
    });
    node
}

/// The curve turned into the plane of the section by the smallest rotation, its centre on the section's.
fn laid(curve: &Curve, section: &EllipticSection) -> Result<Curve, CurveError> {
    let own = PlaneFrame::of(curve);
    let frame = section.frame();
    let towards = if own.normal.dot(frame.normal) < 0.0 { -own.normal } else { own.normal };
    let turn = DQuat::from_rotation_arc(towards, frame.normal);
    let (from, to) = (centre(curve), centre_of(section));
    curve.map(|p| to + turn * (p - from))
}

/// Mean of the curve over its length.
fn centre(curve: &Curve) -> DVec3 {
    let segments = (0..curve.segment_count()).map(|segment| curve.segment(segment));
    let (sum, length) = segments.fold((DVec3::ZERO, 0.0), |(sum, length), (a, b)| {
        (sum + a.distance(b) * a.midpoint(b), length + a.distance(b))
    });
    sum / length
}

fn centre_of(section: &EllipticSection) -> DVec3 {
    let points = section.sampled(256);
    match Curve::new("", points, section.is_closed()) {
        Ok(curve) => centre(&curve),
        // A section that is one point.
        Err(_) => section.point(0.0),
    }
}
