//! A smooth transition between two closed borders.

use glam::DVec3;

use super::alignment::Alignment;
use super::arch::arc_speed;
use super::neighbour::Neighbour;
use super::{GenerateError, GenerateOptions, Generated, check_size, report};
use crate::beam::closed_form::ExactHermite;
use crate::curve::Curve;
use crate::sections::Sections;

/// One border of a [`blend`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlendBorder<'a> {
    /// The border: a closed curve on its surface.
    pub curve: &'a Curve,
    /// The surface it bounds: its directions lead into the blend.
    pub neighbour: Neighbour<'a>,
    /// How far the blend keeps the direction of that surface, above 0: 1 is the arc of a circle, more is fuller, less
    /// tighter.
    pub strength: f64,
}

impl BlendBorder<'_> {
    /// Largest strength permitted: beyond it generators loop.
    pub const LARGEST_STRENGTH: f64 = 10.0;
}

/// A tube from the border of one surface to that of another which continues both smoothly (paper 5.2.5): between two
/// limbs, or from a limb into a hole cut into a body.
///
/// Each generator is the beam curve between corresponding points with the tangents of both surfaces,
/// `P0 H00 + T0 H10 + P1 H01 + T1 H11` of the differential equation itself (thesis 5.5). The paper only cites its
/// blending method. Tangents have the speed of an arc of a circle over the chord, times the border's strength.
///
/// Points correspond at equal shares of both borders' arc lengths: both run the same way about the direction in which
/// the blend goes, whichever way they are drawn and wherever they begin, and `end` is turned until both fit best with the
/// least twist; `twist` radians more are added, counter-clockwise about that direction. Section 0 is `start`, the last
/// one is `end`.
///
/// A border of as many points as `options.nodes` keeps them, so that the blend can be welded to its surface; where both
/// do, they correspond point by point, and are turned by whole points.
///
/// # Errors
/// [`GenerateError`] for fewer than 4 sections or 8 nodes, open borders or such that enclose nothing, a strength or twist
/// out of range, a neighbour without directions, and where `progress` asked to stop.
pub fn blend(
    start: &BlendBorder<'_>,
    end: &BlendBorder<'_>,
    twist: f64,
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    options.check(4)?;
    if options.nodes < 8 {
        return Err(GenerateError::TooFewNodes { found: options.nodes, needed: 8 });
    }
    if !twist.is_finite() {
        return Err(GenerateError::Twist { twist });
    }
    for (border, which) in [(start, "start"), (end, "end")] {
        check_size([border.curve])?;
        if let Neighbour::Curve(curve) = border.neighbour {
            check_size([curve])?;
        }
        let name = || border.curve.name().to_owned();
        if !border.curve.is_closed() {
            return Err(GenerateError::CurveIsOpen { which, name: name() });
        }
        if !(border.strength > 0.0 && border.strength <= BlendBorder::LARGEST_STRENGTH) {
            return Err(GenerateError::Strength { border: name(), strength: border.strength });
        }
        border.neighbour.check(border.curve)?;
    }
    let alignment = Alignment::of([start, end], options.nodes, twist)?;
    let hermite = ExactHermite::new(options.stiffness);
    let last = options.sections - 1;
    let weights: Vec<[f64; 4]> = (0..=last).map(|i| hermite.values(i as f64 / last as f64)).collect();
    let mut rows = vec![Vec::with_capacity(options.nodes); options.sections];
    for node in 0..options.nodes {
        report(progress, node, options.nodes)?;
        let [(p0, out), (p1, back)] = alignment.places(node)?;
        let chord = p1 - p0;
        let (t0, t1) = (
            out * (arc_speed(out, chord, 1.0) * start.strength),
            back * (-arc_speed(back, -chord, 1.0) * end.strength),
        );
        for (row, weights) in rows.iter_mut().zip(&weights) {
            row.push(generator([p0, p1], [t0, t1], *weights));
        }
    }
    report(progress, 1, 1)?;
    let rails = Vec::new();
    Ok(Generated {
        sections: Sections::new(rows, true, rails)?,
        notes: Vec::new(),
        warnings: Vec::new(),
        largest_gap: 0.0,
        gaps: Vec::new(),
    })
}

/// A point between two, from their tangents `dP/du`, by the Hermite basis of the beam.
pub(super) fn generator(p: [DVec3; 2], t: [DVec3; 2], [h00, h10, h01, h11]: [f64; 4]) -> DVec3 {
    p[0] * h00 + t[0] * h10 + p[1] * h01 + t[1] * h11
}
