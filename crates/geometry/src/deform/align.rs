//! Placing a primitive along the axis of silhouettes.

use glam::{DQuat, DVec2, DVec3};

use super::silhouette::pair::Pair;
use super::silhouette::track::Track;
use super::silhouette::{Silhouette, StrokeMatching, StrokesError, common_axis, nearest_axis};
use crate::curve::{ArcLength, Curve, CurveError, SmoothError, smooth};
use crate::sections::{Sections, SectionsError};
use crate::view::View;

/// Points of the axis that is found.
const POINTS: usize = 128;

/// The line along which a primitive is placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisShape {
    /// Half way between the silhouettes, bent where they bend.
    #[default]
    Bent,
    /// The straight line through its middle, from its start to its end.
    Straight,
}

/// How a primitive is placed, and what is changed by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignOptions {
    /// The line along which it is placed.
    pub axis: AxisShape,
    /// How points of both sides find each other.
    pub matching: StrokeMatching,
    /// How much sections follow the local width of the silhouettes, 0 to 1: at 0 the primitive keeps its profile, as wide
    /// on average as the silhouettes; at 1 each section is as wide as they are beside it.
    pub taper: f64,
    /// Added to the place, metres.
    pub offset: DVec3,
    /// Factors of the width across the view whose axis is longest (x), of the length (y) and of the depth in that view
    /// (z), each above 0.
    pub scale: DVec3,
    /// Turn about the axis, radians.
    pub twist: f64,
}

impl Default for AlignOptions {
    /// Along the bent axis, with the primitive's own profile, and nothing changed by hand.
    fn default() -> Self {
        Self {
            axis: AxisShape::default(),
            matching: StrokeMatching::default(),
            taper: 0.0,
            offset: DVec3::ZERO,
            scale: DVec3::ONE,
            twist: 0.0,
        }
    }
}

/// A primitive in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Aligned {
    /// The sections in their place, each across the axis, with the rails of the primitive.
    pub sections: Sections,
    /// The axis, from the first section to the last where it is not scaled.
    pub axis: Curve,
    /// Mean half width and half depth that the sections were given, before scaling, metres.
    pub half_size: DVec2,
    /// What will probably disappoint the artist, and what to do about it, one sentence each.
    pub warnings: Vec<String>,
}

/// Why a primitive cannot be aligned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AlignError {
    /// The strokes are no two sides.
    #[error(transparent)]
    Strokes(#[from] StrokesError),
    /// An option out of its range.
    #[error("{what} is {value}: it must be {wanted}")]
    Option {
        /// The option.
        what: &'static str,
        /// What was given.
        value: f64,
        /// What is permitted.
        wanted: &'static str,
    },
    /// A primitive without an axis.
    #[error("the first and the last section of the primitive have the same centre, so that it has no axis to align")]
    NoAxis,
    /// A primitive without width.
    #[error("the primitive has no width across its axis: give it radii above 0")]
    NoWidth,
    /// Strokes that cannot be matched by height.
    #[error(
        "a stroke of the {view} view is as high at its end as at its start, and cannot be matched by height: match by arc \
         length"
    )]
    Level {
        /// The view.
        view: &'static str,
    },
    /// The line between the strokes cannot be smoothed.
    #[error("the axis between the strokes: {0}")]
    Smooth(#[from] SmoothError),
    /// The line between the strokes is no curve.
    #[error("the axis between the strokes is no curve: {0}")]
    Axis(#[from] CurveError),
    /// The result is no stack of sections.
    #[error("the aligned points are no sections: {0}")]
    Sections(#[from] SectionsError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// Places a primitive, a stack of sections about its own axis, along the axis of silhouettes of one or two views (thesis
/// 5.1: the super-ellipsoid is put at the place of the input sketch).
///
/// The axis runs half way between the two strokes of a view, points matched as in [`StrokeMatching`], smoothed over the
/// width of the shape. Of two views the one with the longer axis leads, and the other gives the depth at the same height
/// (at the same share of the way where the axis turns back in height). With one view the axis lies at the strokes' depth.
/// Sections go to the place along the axis that is their share of the primitive's height, across it; their mean half
/// width is that of the silhouettes in that view, and their depth that of the other view, or in proportion where there is
/// none.
///
/// # Errors
/// [`AlignError`] for strokes that are no pair, a primitive without axis or width, options out of range, and where
/// `progress`, called with the fraction done, asked to stop.
pub fn align_primitive(
    primitive: &Sections,
    silhouettes: &[Silhouette<'_>],
    options: &AlignOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Aligned, AlignError> {
    options.check()?;
    let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(AlignError::Cancelled) };
    go_on(0.0)?;
    let profile = Profile::of(primitive)?;
    let medial = medial_axes(silhouettes, profile.axis, options.matching)?;
    go_on(0.3)?;
    let limb = Limb::new(medial, options.axis)?;
    go_on(0.5)?;
    // The primitive is turned onto the chord first, the short way, so that what faces a view still does.
    let turn = DQuat::from_rotation_arc(profile.axis, limb.chord);
    let [across, depth] = limb.frame(limb.chord);
    let local: Vec<DVec2> = profile
        .offsets
        .iter()
        .map(|offset| {
            let turned = turn * *offset;
            DVec2::from_angle(options.twist).rotate(DVec2::new(turned.dot(across), turned.dot(depth)))
        })
        .collect();
    let nodes = primitive.nodes();
    let halves: Vec<DVec2> =
        local.chunks_exact(nodes).map(|row| row.iter().fold(DVec2::ZERO, |most, p| most.max(p.abs()))).collect();
    let mean = profile.mean(&halves);
    if !(mean.x > 0.0 && mean.y > 0.0) {
        return Err(AlignError::NoWidth);
    }
    let wanted = limb.mean_half();
    let factor = match wanted.y {
        Some(y) => DVec2::new(wanted.x / mean.x, y / mean.y),
        None => DVec2::splat(wanted.x / mean.x),
    };
    let mut rows = Vec::with_capacity(primitive.len());
    for (k, (row, half)) in local.chunks_exact(nodes).zip(&halves).enumerate() {
        go_on(0.5 + 0.5 * k as f64 / primitive.len() as f64)?;
        let share = 0.5 + (profile.shares[k] - 0.5) * options.scale.y;
        let station = limb.at(share);
        let follow = |half: f64, factor: f64, local: f64| {
            let tapered = if half > 0.0 { local / half } else { 0.0 };
            factor + (tapered - factor) * options.taper
        };
        // Without a second view the depth follows the width in proportion.
        let x = follow(half.x, factor.x, station.half);
        let z = station.half_depth.map_or_else(
            || follow(half.y, factor.y, station.half / wanted.x * factor.y * mean.y),
            |depth| follow(half.y, factor.y, depth),
        );
        let [across, depth] = limb.frame(station.tangent);
        let (x, z) = (across * (x * options.scale.x), depth * (z * options.scale.z));
        rows.push(row.iter().map(|p| station.point + options.offset + x * p.x + z * p.y).collect::<Vec<_>>());
    }
    let mut warnings = Vec::new();
    if let Some(k) = (1..rows.len()).find(|k| {
        let way = limb.at(profile.shares[*k]).tangent;
        rows[*k].iter().zip(&rows[k - 1]).any(|(p, q)| (*p - *q).dot(way) < 0.0)
    }) {
        warnings.push(format!(
            "Sections {} and {k} cross, as the axis bends more tightly than the primitive is wide: make it narrower, or \
             its axis straight.",
            k - 1
        ));
    }
    go_on(1.0)?;
    let sections = Sections::new(rows, primitive.is_closed(), primitive.rails().to_vec())?;
    let half_size = DVec2::new(mean.x * factor.x, mean.y * factor.y);
    Ok(Aligned { sections, axis: limb.axis, half_size, warnings })
}

impl AlignOptions {
    fn check(&self) -> Result<(), AlignError> {
        if !(0.0..=1.0).contains(&self.taper) {
            return Err(AlignError::Option { what: "the taper", value: self.taper, wanted: "from 0 to 1" });
        }
        for value in self.scale.to_array() {
            if !(value.is_finite() && value > 0.0) {
                return Err(AlignError::Option { what: "a scale", value, wanted: "a finite number above 0" });
            }
        }
        let numbers = [("the offset", self.offset.to_array().to_vec()), ("the twist", vec![self.twist])];
        for (what, values) in numbers {
            if let Some(value) = values.into_iter().find(|value| !value.is_finite()) {
                return Err(AlignError::Option { what, value, wanted: "a finite number" });
            }
        }
        Ok(())
    }
}

/// A primitive about its own axis.
struct Profile {
    /// Unit direction from the centre of the first section to that of the last.
    axis: DVec3,
    /// Offsets of all points from the axis.
    offsets: Vec<DVec3>,
    /// Height of the centre of each section, as a share of the whole.
    shares: Vec<f64>,
}

impl Profile {
    fn of(primitive: &Sections) -> Result<Self, AlignError> {
        let base = primitive.centre(0);
        let way = primitive.centre(primitive.len() - 1) - base;
        let height = way.length();
        let axis = way.try_normalize().ok_or(AlignError::NoAxis)?;
        if height <= 1e-9 * primitive.diagonal() {
            return Err(AlignError::NoAxis);
        }
        let offsets = primitive.points().iter().map(|p| (*p - base).reject_from_normalized(axis)).collect();
        let shares = (0..primitive.len()).map(|k| (primitive.centre(k) - base).dot(axis) / height).collect();
        Ok(Self { axis, offsets, shares })
    }

    /// Mean over the height.
    fn mean(&self, halves: &[DVec2]) -> DVec2 {
        let steps = self.shares.windows(2).zip(halves.windows(2));
        let (sum, height) = steps.fold((DVec2::ZERO, 0.0), |(sum, height), (share, half)| {
            let step = (share[1] - share[0]).abs();
            (sum + (half[0] + half[1]) * (step / 2.0), height + step)
        });
        sum / height
    }
}

/// The line half way between the silhouettes of a view.
struct Medial {
    view: View,
    along: DVec3,
    points: Vec<DVec2>,
    /// Half the distance of the silhouettes across the line.
    halves: Vec<f64>,
    /// Mean depth of the strokes.
    depth: f64,
}

impl Medial {
    fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    fn mean_half(&self) -> f64 {
        self.halves.iter().sum::<f64>() / self.halves.len() as f64
    }
}

fn medial_axes(
    silhouettes: &[Silhouette<'_>],
    axis: DVec3,
    matching: StrokeMatching,
) -> Result<Vec<Medial>, AlignError> {
    let views: Vec<View> = silhouettes.iter().map(|silhouette| silhouette.view).collect();
    let along = match silhouettes {
        [only] => drawn_along(only),
        _ => common_axis(&views)?,
    };
    // Far away, so that only the direction counts.
    let sense = if along.dot(axis) < 0.0 { -1.0 } else { 1.0 };
    let far = along * (sense * 1e6);
    silhouettes
        .iter()
        .map(|silhouette| {
            let view = silhouette.view;
            let pair = Pair::new(silhouette, -far, far)?;
            let [left, right] = pair.sides.each_ref().map(|side| {
                Track::new(side, matching, view.flat(along)).ok_or(AlignError::Level { view: view.name() })
            });
            let (left, right) = (left?, right?);
            let ends: Vec<[DVec2; 2]> =
                (0..=POINTS).map(|k| k as f64 / POINTS as f64).map(|share| [left.at(share), right.at(share)]).collect();
            let points: Vec<DVec2> = ends.iter().map(|[l, r]| l.midpoint(*r)).collect();
            let halves = (0..=POINTS)
                .map(|k| {
                    let way = points[(k + 1).min(POINTS)] - points[k.saturating_sub(1)];
                    let across = ends[k][0] - ends[k][1];
                    way.try_normalize().map_or(across.length(), |way| across.reject_from_normalized(way).length()) / 2.0
                })
                .collect();
            Ok(Medial { view, along, points, halves, depth: pair.depth })
        })
        .collect()
}

/// The axis of the picture along which strokes run.
fn drawn_along(silhouette: &Silhouette<'_>) -> DVec3 {
    let view = silhouette.view;
    let way = match silhouette.strokes {
        [one, other] if !one.is_closed() && !other.is_closed() => {
            let chord = |curve: &Curve| view.flat(curve.end() - curve.start()).abs();
            chord(one) + chord(other)
        }
        strokes => strokes.iter().fold(DVec2::ZERO, |most, stroke| {
            let (low, high) = stroke.bounds();
            most.max(view.flat(high - low).abs())
        }),
    };
    nearest_axis(view, way)
}

/// The axis in space with the widths along it.
struct Limb {
    axis: Curve,
    /// Unit direction from its start to its end.
    chord: DVec3,
    /// Direction of sight of the leading view.
    sight: DVec3,
    halves: Vec<f64>,
    depths: Option<Vec<f64>>,
}

/// A place on the axis.
struct Station {
    point: DVec3,
    tangent: DVec3,
    half: f64,
    half_depth: Option<f64>,
}

/// Mean half width, and half depth where a second view gives it.
struct MeanHalf {
    x: f64,
    y: Option<f64>,
}

impl Limb {
    fn new(mut medial: Vec<Medial>, shape: AxisShape) -> Result<Self, AlignError> {
        if medial.len() == 2 && medial[1].length() > medial[0].length() * (1.0 + 1e-9) {
            medial.swap(0, 1);
        }
        let [lead, others @ ..] = medial.as_slice() else { return Err(StrokesError::Views { found: 0 }.into()) };
        let other = others.first();
        let along = lead.along;
        let height = |k: usize| lead.view.lift(lead.points[k]).dot(along);
        let (first, last) = (height(0), height(POINTS));
        let rising = (0..POINTS).all(|k| (height(k + 1) - height(k)) * (last - first) > 0.0);
        // The share of the other view's way for each point of the leading one.
        let shares: Vec<f64> = (0..=POINTS).map(|k| k as f64 / POINTS as f64).collect();
        let found: Option<Vec<(DVec2, f64)>> = other.map(|other| {
            let line: Vec<DVec2> = other.points.clone();
            let level = |p: DVec2| other.view.lift(p).dot(along);
            let (low, high) = (level(line[0]), level(line[POINTS]));
            let widths: Vec<DVec2> = shares.iter().zip(&other.halves).map(|(s, h)| DVec2::new(*h, *s)).collect();
            let track = Track::new(&line, StrokeMatching::Height, other.view.flat(along));
            let given: Option<Vec<f64>> = track.as_ref().map(|track| track.given().collect());
            shares
                .iter()
                .enumerate()
                .map(|(k, share)| match (&track, &given) {
                    (Some(track), Some(given)) if rising => {
                        let at = ((height(k) - low) / (high - low)).clamp(0.0, 1.0);
                        let next = given.partition_point(|g| *g <= at).clamp(1, POINTS);
                        let part = ((at - given[next - 1]) / (given[next] - given[next - 1])).clamp(0.0, 1.0);
                        let part = if part.is_nan() { 0.0 } else { part };
                        (track.at(at), widths[next - 1].lerp(widths[next], part).x)
                    }
                    _ => {
                        let at = (share * POINTS as f64) as usize;
                        (line[at.min(POINTS)], other.halves[at.min(POINTS)])
                    }
                })
                .collect()
        });
        let sight = lead.view.depth();
        let points: Vec<DVec3> = (0..=POINTS)
            .map(|k| {
                let depth = match (&found, other) {
                    (Some(found), Some(other)) => other.view.lift(found[k].0).dot(sight),
                    _ => lead.depth,
                };
                lead.view.place(lead.points[k], depth)
            })
            .collect();
        let axis = Curve::new("axis", points, false)?;
        let length = ArcLength::of(&axis).length();
        let axis = match shape {
            AxisShape::Bent => smooth(&axis, (2.0 * lead.mean_half()).clamp(1e-6 * length, 0.5 * length))?,
            AxisShape::Straight => straightened(&axis)?,
        };
        let chord = (axis.end() - axis.start()).try_normalize().ok_or(AlignError::NoAxis)?;
        let depths = found.map(|found| found.into_iter().map(|(_, half)| half).collect());
        Ok(Self { axis, chord, sight, halves: lead.halves.clone(), depths })
    }

    fn mean_half(&self) -> MeanHalf {
        let mean = |halves: &[f64]| halves.iter().sum::<f64>() / halves.len() as f64;
        MeanHalf { x: mean(&self.halves), y: self.depths.as_deref().map(mean) }
    }

    /// Directions across the axis and along the line of sight where the axis runs along `tangent`.
    fn frame(&self, tangent: DVec3) -> [DVec3; 2] {
        let across = self.sight.cross(tangent).try_normalize().unwrap_or_else(|| tangent.any_orthonormal_vector());
        [across, tangent.cross(across)]
    }

    /// The place at a share of the axis's length; beyond its ends it runs on straight.
    fn at(&self, share: f64) -> Station {
        let arc = ArcLength::of(&self.axis);
        let length = arc.length();
        let s = share * length;
        let inside = s.clamp(0.0, length);
        let reach = length / 64.0;
        let (before, after) = (arc.point_at(inside - reach), arc.point_at(inside + reach));
        let tangent = (after - before).try_normalize().unwrap_or(self.chord);
        let point = arc.point_at(inside) + tangent * (s - inside);
        let place = share.clamp(0.0, 1.0) * POINTS as f64;
        let from = (place as usize).min(POINTS - 1);
        let lerp = |values: &[f64]| values[from] + (values[from + 1] - values[from]) * (place - from as f64);
        let half = lerp(&self.halves);
        Station { point, tangent, half, half_depth: self.depths.as_deref().map(lerp) }
    }
}

/// The straight line through the middle of a curve, along its chord, as long as the curve reaches along it.
fn straightened(curve: &Curve) -> Result<Curve, AlignError> {
    let way = (curve.end() - curve.start()).try_normalize().ok_or(AlignError::NoAxis)?;
    let middle = curve.points().iter().copied().sum::<DVec3>() / curve.points().len() as f64;
    let at = |p: DVec3| middle + way * (p - middle).dot(way);
    Ok(Curve::new(curve.name(), vec![at(curve.start()), at(curve.end())], false)?)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn stack(rows: usize, radius: impl Fn(f64) -> f64) -> Sections {
        let ring = |k: usize| {
            let y = k as f64 / (rows - 1) as f64;
            let at = |j: u32| DQuat::from_rotation_y(TAU * f64::from(j) / 32.0) * DVec3::X * radius(y) + DVec3::Y * y;
            (0..32).map(at).collect()
        };
        Sections::new((0..rows).map(ring).collect(), true, vec![0, 8]).unwrap()
    }

    fn stroke(at: impl Fn(f64) -> DVec3) -> Curve {
        Curve::new("", (0..=100).map(|i| at(f64::from(i) / 100.0)).collect(), false).unwrap()
    }

    fn go(primitive: &Sections, silhouettes: &[(View, &[Curve])], options: &AlignOptions) -> Aligned {
        let silhouettes: Vec<Silhouette<'_>> =
            silhouettes.iter().map(|(view, strokes)| Silhouette { view: *view, strokes }).collect();
        align_primitive(primitive, &silhouettes, options, &|_| true).unwrap()
    }

    #[test]
    fn a_straight_limb_in_two_views() {
        let front = [0.6, 0.2].map(|x| stroke(|t| DVec3::new(x, 1.0 + 2.0 * t, 0.0)));
        let side = [-0.1, 0.2].map(|z| stroke(|t| DVec3::new(0.0, 1.0 + 2.0 * t, z)));
        let cylinder = stack(11, |_| 0.5);
        let made = go(&cylinder, &[(View::FRONT, &front), (View::SIDE, &side)], &AlignOptions::default());
        assert!(made.half_size.distance(DVec2::new(0.2, 0.15)) < 1e-12 && made.warnings.is_empty());
        assert_eq!(made.sections.rails(), [0, 8]);
        for (k, section) in made.sections.iter().enumerate() {
            let centre = DVec3::new(0.4, 1.0 + 0.2 * k as f64, 0.05);
            for (j, point) in section.iter().enumerate() {
                let from = cylinder.section(k)[j];
                let wanted = centre + DVec3::new(from.x * 0.4, 0.0, from.z * 0.3);
                assert!(point.distance(wanted) < 1e-12, "section {k}, point {j}: {point} {wanted}");
            }
        }
        // By hand.
        let options = AlignOptions {
            offset: DVec3::new(0.1, 0.0, 0.0),
            scale: DVec3::new(2.0, 0.5, 1.0),
            twist: TAU / 4.0,
            ..AlignOptions::default()
        };
        let made = go(&cylinder, &[(View::FRONT, &front), (View::SIDE, &side)], &options).sections;
        assert!(made.centre(0).distance(DVec3::new(0.5, 1.5, 0.05)) < 1e-12);
        assert!(made.centre(10).distance(DVec3::new(0.5, 2.5, 0.05)) < 1e-12);
        let (low, high) = Curve::new("", made.section(3).to_vec(), true).unwrap().bounds();
        assert!((high - low).distance(DVec3::new(0.8, 0.0, 0.3)) < 1e-12);
        assert!((made.section(3)[0] - made.centre(3)).x.abs() < 1e-12, "turned by a quarter");
    }

    #[test]
    fn a_bent_limb_is_followed_and_a_primitive_that_lies_is_raised() {
        let ring = |r: f64| stroke(move |t| DVec3::new((TAU / 4.0 * t).cos() * r, (TAU / 4.0 * t).sin() * r, 0.3));
        let front = [ring(1.2), ring(0.8)];
        let upright = stack(41, |_| 0.5);
        let made = go(&upright, &[(View::FRONT, &front)], &AlignOptions::default());
        assert!(made.warnings.is_empty(), "{:?}", made.warnings);
        for (k, section) in made.sections.iter().enumerate() {
            let a = TAU / 4.0 * k as f64 / 40.0;
            let (out, along) = (DVec3::new(a.cos(), a.sin(), 0.0), DVec3::new(-a.sin(), a.cos(), 0.0));
            let centre = made.sections.centre(k);
            assert!(centre.distance(out + DVec3::Z * 0.3) < 2e-3, "section {k}: {centre}");
            for point in section {
                assert!((*point - centre).dot(along).abs() < 1e-2, "section {k} is across the axis");
                assert!(((*point - centre).length() - 0.2).abs() < 1e-4);
            }
        }
        let rows = upright.iter().map(|row| row.iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect());
        let lying = Sections::new(rows.collect(), true, vec![]).unwrap();
        let raised = go(&lying, &[(View::FRONT, &front)], &AlignOptions::default()).sections;
        for k in 0..41 {
            assert!(raised.centre(k).distance(made.sections.centre(k)) < 1e-12);
        }
        let straight = AlignOptions { axis: AxisShape::Straight, ..AlignOptions::default() };
        let made = go(&upright, &[(View::FRONT, &front)], &straight);
        let way = (made.sections.centre(40) - made.sections.centre(0)).normalize();
        assert!(way.distance(DVec3::new(-1.0, 1.0, 0.0).normalize()) < 1e-12);
    }

    #[test]
    fn taper_follows_the_width() {
        let front = [1.0, -1.0].map(|s| stroke(move |t| DVec3::new(s * (0.4 - 0.2 * t), t, 0.0)));
        let width = |made: &Aligned, k: usize| made.sections.section(k)[0].distance(made.sections.section(k)[16]);
        let keep = go(&stack(5, |_| 1.0), &[(View::FRONT, &front)], &AlignOptions::default());
        assert!((0..5).all(|k| (width(&keep, k) - 0.6).abs() < 1e-12));
        let follow = AlignOptions { taper: 1.0, ..AlignOptions::default() };
        let made = go(&stack(5, |_| 1.0), &[(View::FRONT, &front)], &follow);
        for k in 0..5 {
            assert!((width(&made, k) - (0.8 - 0.1 * k as f64)).abs() < 1e-12);
        }
        // On the mean a primitive of any profile is as wide as the silhouettes.
        let spindle = go(&stack(101, |y| y * (1.0 - y)), &[(View::FRONT, &front)], &AlignOptions::default());
        let mean: f64 = (1..=100).map(|k| (width(&spindle, k) + width(&spindle, k - 1)) / 200.0).sum();
        assert!((mean - 0.6).abs() < 1e-12, "{mean}");
    }

    #[test]
    fn what_cannot_be_aligned_is_refused() {
        let front = [0.2, -0.2].map(|x| stroke(|t| DVec3::new(x, t, 0.0)));
        let silhouettes = [Silhouette { view: View::FRONT, strokes: &front }];
        let error = |primitive: &Sections, options: &AlignOptions| {
            align_primitive(primitive, &silhouettes, options, &|_| true).unwrap_err()
        };
        let cylinder = stack(5, |_| 1.0);
        let options = AlignOptions::default();
        for bad in [
            AlignOptions { taper: 1.5, ..options },
            AlignOptions { scale: DVec3::new(1.0, 0.0, 1.0), ..options },
            AlignOptions { twist: f64::NAN, ..options },
        ] {
            assert!(matches!(error(&cylinder, &bad), AlignError::Option { .. }));
        }
        assert_eq!(error(&stack(5, |_| 0.0), &options), AlignError::NoWidth);
        let ring = cylinder.section(0).to_vec();
        let flat = Sections::new(vec![ring.clone(), ring], true, vec![]).unwrap();
        assert_eq!(error(&flat, &options), AlignError::NoAxis);
        let none = align_primitive(&cylinder, &[], &options, &|_| true);
        assert!(matches!(none, Err(AlignError::Strokes(StrokesError::Views { found: 0 }))));
        let stopped = align_primitive(&cylinder, &silhouettes, &options, &|_| false);
        assert_eq!(stopped, Err(AlignError::Cancelled));
    }
}
