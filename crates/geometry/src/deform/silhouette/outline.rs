//! A stack seen end on, with one outline around it.

use glam::DVec3;

use super::deformed::Fits;
use super::error::{SilhouetteError, StrokesError, names};
use super::pair::Silhouette;
use super::{SilhouetteDeformed, SilhouetteOptions, StrokeMatching};
use crate::beam::{EndCondition, OpenBeam, OpenValues};
use crate::curve::Curve;
use crate::deform::contour_matching::{Culprit, Ring};
use crate::mesh::measure::vector_area;
use crate::sections::Sections;

/// Gives the largest section, as seen, the shape of the outline, in the coordinates that are seen; the others follow by
/// the beam along the stack, at rest at its ends.
///
/// [`StrokeMatching::ArcLength`] keeps the share of the way around; [`StrokeMatching::Height`] moves points straight out
/// from the outline's centre.
pub(super) fn deform(
    sections: &Sections,
    silhouette: &Silhouette<'_>,
    options: &SilhouetteOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<SilhouetteDeformed, SilhouetteError> {
    let go_on = |done: usize| match progress(done as f64 / sections.len() as f64) {
        true => Ok(()),
        false => Err(SilhouetteError::Cancelled),
    };
    go_on(0)?;
    let view = silhouette.view;
    let [drawn] = silhouette.strokes else { return Err(SilhouetteError::OutlineNeeded { view: view.name() }) };
    if !drawn.is_closed() {
        return Err(SilhouetteError::OutlineNeeded { view: view.name() });
    }
    let strokes = || names(silhouette.strokes);
    if drawn.points().iter().any(|p| p.abs().max_element() > 1e100) {
        return Err(StrokesError::TooLarge { strokes: strokes() }.into());
    }
    let no_area = || StrokesError::NoArea { view: view.name(), strokes: strokes() };
    let flat = drawn.map(|p| view.place(view.flat(p), 0.0)).map_err(|_| no_area())?;
    let (low, high) = flat.bounds();
    let diagonal = (high - low).length();
    let area = flat.area_vector();
    if area.length() <= 1e-6 * diagonal * diagonal {
        return Err(no_area().into());
    }
    // The section of the largest area as seen, and the way it runs around.
    let areas: Vec<f64> = sections.iter().map(|s| vector_area(s.iter().copied()).dot(view.depth())).collect();
    let widest = (1..areas.len()).fold(0, |best, k| if areas[k].abs() > areas[best].abs() { k } else { best });
    let (from, to) = sections
        .points()
        .iter()
        .map(|p| view.place(view.flat(*p), 0.0))
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let distance = (low - to).max(from - high).max(DVec3::ZERO).length();
    if distance > 0.0 {
        return Err(SilhouetteError::Apart { view: view.name(), strokes: strokes(), distance });
    }
    let normal = view.depth() * areas[widest].signum();
    let turned = if area.dot(normal) < 0.0 { flat.reversed() } else { flat };
    let ring = Ring::new(&turned, normal);
    let seen: Vec<DVec3> = sections.section(widest).iter().map(|p| view.place(view.flat(*p), 0.0)).collect();
    let targets = match options.matching {
        StrokeMatching::ArcLength => ring.by_arc_length(&seen),
        StrokeMatching::Height => ring.by_angle(&seen).map_err(|culprit| SilhouetteError::NotStarShaped {
            what: match culprit {
                Culprit::Contour => format!("stroke{}", strokes()),
                Culprit::Section => format!("section {widest}"),
            },
        })?,
    };
    let shares = shares(sections.len(), widest, options)?;
    let mut fits = Fits::new(Vec::new(), diagonal);
    let mut rows = Vec::with_capacity(sections.len());
    for (k, (section, share)) in sections.iter().zip(shares).enumerate() {
        go_on(k)?;
        let moves = targets.iter().zip(&seen).map(|(target, from)| (*target - *from) * share);
        let row: Vec<DVec3> = section.iter().zip(moves).map(|(point, moved)| *point + moved).collect();
        fits.section(k, section, &row, &[]);
        rows.push(row);
    }
    let mut deformed = fits.finish(Sections::new(rows, true, sections.rails().to_vec())?);
    deformed.notes.push(format!("The {} view looks along the stack: section {widest} is the outline.", view.name()));
    deformed.warnings.extend(beyond(&deformed.sections, &turned, widest, diagonal, silhouette));
    Ok(deformed)
}

/// How far each section follows one that moves by 1.
fn shares(count: usize, moved: usize, options: &SilhouetteOptions) -> Result<Vec<f64>, SilhouetteError> {
    let last = count - 1;
    // An open beam has four nodes at least; so few sections follow in proportion.
    if count < 4 {
        return Ok((0..count).map(|k| if k == moved { 1.0 } else { 0.0 }).collect());
    }
    let (pins, values): (&[usize], &[f64]) = if moved == 0 || moved == last { (&[], &[]) } else { (&[moved], &[1.0]) };
    let beam = OpenBeam::new(count, pins, EndCondition::Natural, EndCondition::Natural, options.stiffness)?;
    let end = |k: usize| if k == moved { 1.0 } else { 0.0 };
    Ok(beam.solve(&OpenValues { pins: values, ..OpenValues::ends(end(0), end(last)) })?)
}

/// A warning where another section is seen outside of the outline.
fn beyond(
    sections: &Sections,
    outline: &Curve,
    widest: usize,
    diagonal: f64,
    silhouette: &Silhouette<'_>,
) -> Option<String> {
    let view = silhouette.view;
    let line: Vec<_> = outline.points().iter().map(|p| view.flat(*p)).collect();
    let mut worst = (0.0, widest);
    for (k, section) in sections.iter().enumerate().filter(|(k, _)| *k != widest) {
        for point in section {
            let p = view.flat(*point);
            let around = line.iter().zip(line.iter().cycle().skip(1));
            let crossings = around
                .filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y));
            if crossings.count() % 2 == 0 {
                let off = crate::curve::closest(outline, view.place(p, 0.0)).distance;
                if off > worst.0 {
                    worst = (off, k);
                }
            }
        }
    }
    (worst.0 > 0.0005 * diagonal).then(|| {
        format!(
            "Section {} stands out by {:.5} m beyond the outline of the {} view: start from a primitive that lies within \
             it.",
            worst.1,
            worst.0,
            view.name()
        )
    })
}
