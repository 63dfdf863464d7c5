//! Generators between two rails, blended in a frame that turns with the closed curves.
//!
//! Equations 6.2 and 6.3 of the thesis blend the sculpting forces of two rails as vectors. Two rails a quarter of a turn
//! apart that both swell by 1 then swell by 0.71 between them: four rails drawn for a round vase give one with a belly
//! like a diamond. Here what a rail adds to the loft between the closed curves turns about the running axis as the
//! closed curves do,
//!
//! `d = base + m + (1-w) R(theta - theta_5) (delta_5 - m) + w R(theta - theta_6) (delta_6 - m)`,
//!
//! where `base = a H00 + b H01` joins the ends of the generator, `delta` is a rail less the base between its own ends,
//! and `theta` the angle at which the closed curves are seen from their centres. `m` is what all rails have in common:
//! the rest turns, that does not, or a bent tube would be pinched between its rails as the vase was. It is the vector
//! in the best fit, by least squares over the rails, of `m + R(theta_k) r` to `delta_k`. So surfaces of revolution come
//! out round from any two rails, and so do tubes bent sideways where the rails do not all stand on one side. Rails and
//! closed curves are reproduced as by [`blend_generators`](super::blend_generators), and with `R = 1` it is the same
//! surface. The price of `m` is that a swelling of one rail of `n` reaches all patches, by `(1 - cos(pi/n))/n` of itself.

use std::f64::consts::TAU;

use glam::DVec3;

use super::winding::{NoWinding, Winding};
use crate::beam::HermiteBasis;
use crate::curve::Curve;

/// A closed curve this many times smaller than the other one is too small to say how it turns.
const TINY: f64 = 0.01;

/// Least cosine between the normals of both closed curves for which the axis between them is still defined.
const LEAST_COSINE: f64 = -0.9;

/// Least denominator of the common displacement: rails that all stand on one side (two closer than a quarter of a
/// turn) cannot tell a shift from a swelling, which then counts for more.
const LEAST_SPREAD: f64 = 0.5;

/// How the frames turn from rail to rail and from section to section.
#[derive(Clone, Debug)]
pub(super) struct Turning<'a> {
    sides: Sides<'a>,
    /// Angles of each foot behind the first; at last a whole turn.
    feet: Vec<[f64; 2]>,
    rows: Vec<Row>,
    /// What each rail adds to the base, one point a section.
    displacements: Vec<Vec<DVec3>>,
}

impl<'a> Turning<'a> {
    /// The frames between two closed curves for sampled rails; `offsets` are the arc lengths of the feet behind the
    /// first one, at `origins`, on both curves.
    ///
    /// # Errors
    /// A clause for the artist: why the closed curves do not tell how to turn.
    pub(super) fn new(
        curves: [&'a Curve; 2],
        origins: [f64; 2],
        offsets: [&[f64]; 2],
        sampled: &[Vec<DVec3>],
        basis: &HermiteBasis,
    ) -> Result<Self, String> {
        let sides = Sides::new(curves, origins)?;
        let mut feet: Vec<[f64; 2]> =
            (0..sampled.len()).map(|k| sides.angles([offsets[0][k], offsets[1][k]])).collect();
        feet.push([TAU; 2]);
        let displacements: Vec<Vec<DVec3>> = sampled.iter().map(|rail| displacement(rail, basis)).collect();
        let rows = (0..basis.nodes())
            .map(|i| {
                let of_end = basis.h01[i];
                let axis = sides.normals[0].lerp(sides.normals[1], of_end).normalize_or_zero();
                let angles: Vec<f64> = feet.iter().map(|foot| blend(*foot, of_end)).collect();
                Row { axis, of_end, common: common(axis, &angles, |rail| displacements[rail][i]) }
            })
            .collect();
        Ok(Self { sides, feet, rows, displacements })
    }

    /// The generator with the weight `w` of the rail behind `patch` against the rail at it, from `ends.0` to `ends.1`,
    /// which lie `offsets` behind the first foot on the closed curves.
    pub(super) fn generator(
        &self,
        patch: usize,
        w: f64,
        offsets: [f64; 2],
        ends: (DVec3, DVec3),
        basis: &HermiteBasis,
    ) -> Vec<DVec3> {
        let next = (patch + 1) % self.displacements.len();
        let here = self.sides.angles(offsets);
        let behind = |foot: [f64; 2]| [here[0] - foot[0], here[1] - foot[1]];
        let (from_this, from_next) = (behind(self.feet[patch]), behind(self.feet[patch + 1]));
        let mut generator: Vec<DVec3> = self
            .rows
            .iter()
            .enumerate()
            .map(|(i, row)| {
                let base = ends.0 * basis.h00[i] + ends.1 * basis.h01[i];
                let turned = |rail: usize, angles: [f64; 2]| {
                    rotate(row.axis, blend(angles, row.of_end), self.displacements[rail][i] - row.common)
                };
                base + row.common + turned(patch, from_this) * (1.0 - w) + turned(next, from_next) * w
            })
            .collect();
        if let Some(first) = generator.first_mut() {
            *first = ends.0;
        }
        if let Some(last) = generator.last_mut() {
            *last = ends.1;
        }
        generator
    }
}

/// The frame of one section.
#[derive(Clone, Copy, Debug)]
struct Row {
    /// Unit axis about which displacements turn.
    axis: DVec3,
    /// Share of the end in angles, 0 to 1.
    of_end: f64,
    /// What all rails have in common, `m`; metres.
    common: DVec3,
}

/// Start and end, of which one may be unable to tell angles and is then stood in for by the other.
#[derive(Clone, Debug)]
struct Sides<'a> {
    windings: [Option<Winding<'a>>; 2],
    normals: [DVec3; 2],
    /// Arc length of the first foot.
    origins: [f64; 2],
}

impl<'a> Sides<'a> {
    fn new(curves: [&'a Curve; 2], origins: [f64; 2]) -> Result<Self, String> {
        let [start, end] = curves.map(Winding::of);
        for (found, curve) in [(&start, curves[0]), (&end, curves[1])] {
            if found.as_ref().is_err_and(|why| *why == NoWinding::Folded) {
                let name = curve.name();
                return Err(format!("closed curve \"{name}\" turns back on itself as seen from its centre"));
            }
        }
        let (start, end) = match (start.ok(), end.ok()) {
            (Some(start), Some(end)) if start.size < TINY * end.size => (None, Some(end)),
            (Some(start), Some(end)) if end.size < TINY * start.size => (Some(start), None),
            both => both,
        };
        let normals = match (&start, &end) {
            (Some(start), Some(end)) => [start.normal, end.normal],
            (Some(one), None) | (None, Some(one)) => [one.normal; 2],
            (None, None) => {
                let (one, other) = (curves[0].name(), curves[1].name());
                return Err(format!("closed curves \"{one}\" and \"{other}\" enclose next to no area"));
            }
        };
        if normals[0].dot(normals[1]) < LEAST_COSINE {
            return Err("the closed curves face opposite ways, so that no axis runs from one to the other".to_owned());
        }
        Ok(Self { windings: [start, end], normals, origins })
    }

    /// Angles behind the first foot of the points `offsets` behind it on start and end, radians.
    fn angles(&self, offsets: [f64; 2]) -> [f64; 2] {
        let of = |side: usize| {
            let origin = self.origins[side];
            self.windings[side]
                .as_ref()
                .map(|winding| winding.angle_at(origin + offsets[side]) - winding.angle_at(origin))
        };
        match (of(0), of(1)) {
            (Some(start), Some(end)) => [start, end],
            (Some(one), None) | (None, Some(one)) => [one; 2],
            (None, None) => [0.0; 2],
        }
    }
}

fn blend(angles: [f64; 2], of_end: f64) -> f64 {
    angles[0] * (1.0 - of_end) + angles[1] * of_end
}

/// What a rail adds to the base between its own ends: nothing at both.
fn displacement(rail: &[DVec3], basis: &HermiteBasis) -> Vec<DVec3> {
    let (Some(first), Some(last)) = (rail.first().copied(), rail.last().copied()) else {
        return Vec::new();
    };
    rail.iter().zip(&basis.h00).zip(&basis.h01).map(|((p, h00), h01)| *p - first * *h00 - last * *h01).collect()
}

/// The part across the axis that all rails have in common: `m` of the fit of `m + R(theta_k) r` to their displacements,
/// each counting for the angle around it. `angles` has one entry more than there are rails, a turn behind the first.
fn common(axis: DVec3, angles: &[f64], displacement: impl Fn(usize) -> DVec3) -> DVec3 {
    let rails = angles.len() - 1;
    // The mean direction of the rails as a complex number, and the means of their displacements as they are and turned
    // back to the first rail: the normal equations of the fit.
    let (mut total, mut direction) = (0.0, (0.0, 0.0));
    let (mut mean, mut mean_back) = (DVec3::ZERO, DVec3::ZERO);
    for k in 0..rails {
        let before = if k == 0 { angles[rails] - angles[rails - 1] } else { angles[k] - angles[k - 1] };
        // A curve drawn by an unsteady hand may turn back a little.
        let weight = (before + angles[k + 1] - angles[k]).max(0.0);
        let (sin, cos) = angles[k].sin_cos();
        let d = displacement(k);
        let across = d - axis * axis.dot(d);
        total += weight;
        direction = (direction.0 + weight * cos, direction.1 + weight * sin);
        mean += across * weight;
        mean_back += rotate(axis, -angles[k], across) * weight;
    }
    if total <= 0.0 {
        return DVec3::ZERO;
    }
    let (re, im) = (direction.0 / total, direction.1 / total);
    let turned = (mean_back * re + axis.cross(mean_back) * im) / total;
    (mean / total - turned) / (1.0 - re * re - im * im).max(LEAST_SPREAD)
}

/// `v` turned by `angle` about the unit `axis` (Rodrigues).
fn rotate(axis: DVec3, angle: f64, v: DVec3) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}
