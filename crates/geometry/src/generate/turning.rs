//! Generators between two rails, blended in a frame that turns with the closed curves.
//!
//! Equations 6.2 and 6.3 of the thesis blend the sculpting forces of two rails as vectors. Two rails a quarter of a turn
//! apart that both swell by 1 then swell by 0.71 between them: four rails drawn for a round vase give one with a belly
//! like a diamond. Here what a rail adds to the loft between the closed curves turns about the running axis as the
//! closed curves do,
//!
//! `d = base + m + (1-w) R(theta - theta_5) (delta_5 - m) + w R(theta - theta_6) (delta_6 - m)`,
//!
//! where `base = a H00 + b H01` joins the ends of the generator (with closed curves between them, the sum of its points
//! there times their cardinal functions), `delta` is a rail less the base through its own points, and `theta` the angle
//! at which the closed curves are seen from their centres; where rails meet in an apex, that of the rails about the
//! normal of their tangents. `m` is what all rails have in common:
//! the rest turns, that does not, or a bent tube would be pinched between its rails as the vase was. It is the vector
//! in the best fit, by least squares over the rails, of `m + R(theta_k) r` to `delta_k`. So surfaces of revolution come
//! out round from any two rails, and so do tubes bent sideways where the rails do not all stand on one side. Rails and
//! closed curves are reproduced as by [`blend_generators`](super::blend_generators), and with `R = 1` it is the same
//! surface. The price of `m` is that a swelling of one rail of `n` reaches all patches, by `(1 - cos(pi/n))/n` of itself.

use std::f64::consts::TAU;

use glam::DVec3;

use super::winding::{NoWinding, Winding};
use crate::beam::OpenCardinals;
use crate::curve::Curve;

/// A closed curve this many times smaller than the other one is too small to say how it turns.
const TINY: f64 = 0.01;

/// Least cosine between the normals of both closed curves for which the axis between them is still defined.
const LEAST_COSINE: f64 = -0.9;

/// Least denominator of the common displacement: rails that all stand on one side (two closer than a quarter of a
/// turn) cannot tell a shift from a swelling, which then counts for more.
const LEAST_SPREAD: f64 = 0.5;

/// What stands at one place along the rails, for telling angles.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stand<'a> {
    /// A closed curve; the first foot lies `origin` metres along it.
    Ring {
        /// The curve.
        curve: &'a Curve,
        /// Arc length of the first foot, metres.
        origin: f64,
    },
    /// The apex of a fan of rails about this unit normal; offsets are angles.
    Fan(DVec3),
    /// Nothing that tells angles.
    Point,
}

/// How the frames turn from rail to rail and from section to section.
#[derive(Clone, Debug)]
pub(super) struct Turning<'a> {
    places: Places<'a>,
    /// Angles of each foot behind the first at each place; at last a whole turn.
    feet: Vec<Vec<f64>>,
    rows: Vec<Row>,
    /// What each rail adds to the base, one point a section.
    displacements: Vec<Vec<DVec3>>,
}

impl<'a> Turning<'a> {
    /// The frames for sampled rails past the places that `functions` hold; `offsets` are those of the feet behind the
    /// first one at each place.
    ///
    /// # Errors
    /// A clause for the artist: why the closed curves do not tell how to turn.
    pub(super) fn new(
        stands: &[Stand<'a>],
        offsets: &[&[f64]],
        sampled: &[Vec<DVec3>],
        functions: &OpenCardinals,
    ) -> Result<Self, String> {
        let places = Places::new(stands)?;
        let foot = |rail: usize| places.angles(&offsets.iter().map(|of| of[rail]).collect::<Vec<f64>>());
        let mut feet: Vec<Vec<f64>> = (0..sampled.len()).map(foot).collect();
        feet.push(vec![TAU; stands.len()]);
        let displacements: Vec<Vec<DVec3>> = sampled.iter().map(|rail| displacement(rail, functions)).collect();
        let rows = (0..functions.nodes())
            .map(|i| {
                let weights: Vec<f64> = functions.positions().iter().map(|function| function[i]).collect();
                let axis = places.normals.iter().zip(&weights).map(|(n, w)| *n * *w).sum::<DVec3>().normalize_or_zero();
                let angles: Vec<f64> = feet.iter().map(|foot| blend(foot, &weights)).collect();
                let common = common(axis, &angles, |rail| displacements[rail][i]);
                Row { axis, weights, common }
            })
            .collect();
        Ok(Self { places, feet, rows, displacements })
    }

    /// The generator with the weight `w` of the rail behind `patch` against the rail at it through the points `through`,
    /// which lie `offsets` behind the first foot at each place.
    pub(super) fn generator(
        &self,
        patch: usize,
        w: f64,
        offsets: &[f64],
        through: &[DVec3],
        functions: &OpenCardinals,
    ) -> Vec<DVec3> {
        let next = (patch + 1) % self.displacements.len();
        let here = self.places.angles(offsets);
        let behind = |foot: &[f64]| -> Vec<f64> { here.iter().zip(foot).map(|(a, b)| a - b).collect() };
        let (from_this, from_next) = (behind(&self.feet[patch]), behind(&self.feet[patch + 1]));
        let mut generator: Vec<DVec3> = self
            .rows
            .iter()
            .enumerate()
            .map(|(i, row)| {
                let base: DVec3 = through.iter().zip(&row.weights).map(|(p, h)| *p * *h).sum();
                let turned = |rail: usize, angles: &[f64]| {
                    rotate(row.axis, blend(angles, &row.weights), self.displacements[rail][i] - row.common)
                };
                base + row.common + turned(patch, &from_this) * (1.0 - w) + turned(next, &from_next) * w
            })
            .collect();
        for (node, point) in functions.held().iter().zip(through) {
            generator[*node] = *point;
        }
        generator
    }
}

/// The frame of one section.
#[derive(Clone, Debug)]
struct Row {
    /// Unit axis about which displacements turn.
    axis: DVec3,
    /// Share of each place in angles; they add up to 1.
    weights: Vec<f64>,
    /// What all rails have in common, `m`; metres.
    common: DVec3,
}

/// How one place tells angles.
#[derive(Clone, Debug)]
enum Angles<'a> {
    Ring(Winding<'a>, f64),
    Fan,
    /// As the place of this index does, to which the offsets belong as well.
    Like(usize),
}

/// All places in order, of which some may be unable to tell angles and are then stood in for by the nearest one that is.
#[derive(Clone, Debug)]
struct Places<'a> {
    angles: Vec<Angles<'a>>,
    normals: Vec<DVec3>,
}

impl<'a> Places<'a> {
    fn new(stands: &[Stand<'a>]) -> Result<Self, String> {
        let mut found: Vec<Option<(Angles<'a>, DVec3)>> = Vec::new();
        let mut sizes = Vec::new();
        let mut flat = Vec::new();
        for stand in stands {
            let (angles, size) = match *stand {
                Stand::Ring { curve, origin } => match Winding::of(curve) {
                    Ok(winding) => {
                        let (normal, size) = (winding.normal, winding.size);
                        (Some((Angles::Ring(winding, origin), normal)), size)
                    }
                    Err(NoWinding::Folded) => {
                        let name = curve.name();
                        return Err(format!("closed curve \"{name}\" turns back on itself as seen from its centre"));
                    }
                    Err(NoWinding::Flat) => {
                        flat.push(format!("\"{}\"", curve.name()));
                        (None, 0.0)
                    }
                },
                Stand::Fan(normal) => (Some((Angles::Fan, normal)), f64::INFINITY),
                Stand::Point => (None, 0.0),
            };
            found.push(angles);
            sizes.push(size);
        }
        let largest = sizes.iter().copied().filter(|size| size.is_finite()).fold(0.0, f64::max);
        for (found, size) in found.iter_mut().zip(sizes) {
            if size < TINY * largest {
                *found = None;
            }
        }
        let able: Vec<usize> = (0..found.len()).filter(|k| found[*k].is_some()).collect();
        if able.is_empty() {
            let (curves, verb) = if flat.len() > 1 { ("curves", "enclose") } else { ("curve", "encloses") };
            return Err(format!("closed {curves} {} {verb} next to no area", flat.join(" and ")));
        }
        let nearest = |k: usize| able.iter().copied().min_by_key(|other| other.abs_diff(k)).unwrap_or(k);
        let normal = |k: usize| found[nearest(k)].as_ref().map_or(DVec3::ZERO, |found| found.1);
        let normals: Vec<DVec3> = (0..found.len()).map(normal).collect();
        if normals.windows(2).any(|pair| pair[0].dot(pair[1]) < LEAST_COSINE) {
            return Err("the closed curves face opposite ways, so that no axis runs from one to the other".to_owned());
        }
        let stand_ins: Vec<usize> = (0..found.len()).map(nearest).collect();
        let angles = found
            .into_iter()
            .zip(stand_ins)
            .map(|(found, nearest)| found.map_or(Angles::Like(nearest), |found| found.0))
            .collect();
        Ok(Self { angles, normals })
    }

    /// Angles behind the first foot of what lies `offsets` behind it at each place, radians.
    fn angles(&self, offsets: &[f64]) -> Vec<f64> {
        let of = |k: usize| match &self.angles[k] {
            Angles::Ring(winding, origin) => winding.angle_at(origin + offsets[k]) - winding.angle_at(*origin),
            Angles::Fan | Angles::Like(_) => offsets[k],
        };
        let place = |k: usize| if let Angles::Like(other) = self.angles[k] { of(other) } else { of(k) };
        (0..self.angles.len()).map(place).collect()
    }
}

fn blend(angles: &[f64], weights: &[f64]) -> f64 {
    angles.iter().zip(weights).map(|(angle, weight)| angle * weight).sum()
}

/// What a rail adds to the base through its own points: nothing there.
fn displacement(rail: &[DVec3], functions: &OpenCardinals) -> Vec<DVec3> {
    let mut rest = rail.to_vec();
    for (node, function) in functions.held().iter().zip(functions.positions()) {
        for (point, weight) in rest.iter_mut().zip(function) {
            *point -= rail[*node] * *weight;
        }
    }
    rest
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
