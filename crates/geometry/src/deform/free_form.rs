//! Deforming a stack of sections until it passes through curves drawn anywhere on it (thesis 5.5, Figure 5.6b).

use glam::DVec3;
use nalgebra::{DMatrix, DVector};

use crate::beam::closed_form::ExactHermite;
use crate::beam::{BeamError, Stiffness, TensionSpline};
use crate::curve::{CubicSpline, Curve};
use crate::mesh::measure::vector_area;
use crate::sections::{Sections, SectionsError};

/// How curves deform a stack of sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeFormOptions {
    /// Stiffness of the displacement.
    pub stiffness: Stiffness,
    /// Whether the rails of the sections stay in place, so that silhouettes met before stay exact. Those beside a curve
    /// give way to it.
    pub hold_rails: bool,
    /// Length along the stack over which sections beyond the ends of a curve still follow it, metres, 0 or more.
    pub fade: f64,
}

impl Default for FreeFormOptions {
    /// The thesis' stiffness, rails held, ends faded out over 5 cm.
    fn default() -> Self {
        Self { stiffness: Stiffness::default(), hold_rails: true, fade: 0.05 }
    }
}

/// A stack through curves.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeFormDeformed {
    /// The sections, with the rails they had.
    pub sections: Sections,
    /// What each curve moves, in their order.
    pub curves: Vec<FollowedCurve>,
    /// How far the point moved that moved farthest, metres.
    pub largest_move: f64,
    /// What will probably disappoint the artist, and what to do about it, one sentence each.
    pub warnings: Vec<String>,
}

/// What a curve moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowedCurve {
    /// The first section that passes through the curve.
    pub first: usize,
    /// The last one.
    pub last: usize,
    /// Largest distance of the curve from the sections before, metres.
    pub largest_move: f64,
}

/// Why sections cannot be deformed to curves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurvesError {
    /// No curves.
    #[error("there are no curves to follow")]
    NoCurves,
    /// Sections that do not close.
    #[error("the sections are open: only closed sections are deformed to curves drawn on them")]
    SectionsAreOpen,
    /// A curve that passes no section.
    #[error(
        "curve \"{curve}\" passes through the plane of no section within the section's own width of it: draw it on the \
         surface or close to it, and along the sections"
    )]
    Beside {
        /// Name of the curve.
        curve: String,
        /// Index of the curve, counted from 0.
        index: usize,
    },
    /// A length that is none.
    #[error("the length {fade} m over which curves fade out must be a finite number of metres of 0 or more")]
    Fade {
        /// The length given.
        fade: f64,
    },
    /// Coordinates beyond all use.
    #[error("curve \"{curve}\" has coordinates above 1e100 m: scale it down")]
    TooLarge {
        /// Name of the curve.
        curve: String,
    },
    /// The displacement cannot be computed.
    #[error("the displacement of section {section} cannot be computed: {source}")]
    Beam {
        /// Index of the section, counted from 0.
        section: usize,
        /// Why.
        source: BeamError,
    },
    /// The result is no stack of sections.
    #[error("the deformed points are no sections: {0}")]
    Sections(#[from] SectionsError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// Share of the way around within which rails give way to a curve: the more, the closer it comes.
const GIVES_WAY: f64 = 1.0 / 12.0;

/// Most turns in which several rails that give way agree.
const TURNS: usize = 64;

/// Most steps of Newton's method.
const NEWTON: usize = 24;

/// Distance from a section's plane, in the section's size, of what lies in it.
const IN_PLANE: f64 = 1e-9;

/// A place on a section that is moved.
#[derive(Clone, Copy)]
struct Pin {
    /// Share of the way around, counted in points: between 0 and 1.
    u: f64,
    moved: DVec3,
}

/// Deforms closed sections until they pass through curves that run along them anywhere, in all three coordinates (thesis
/// 5.5, Figure 5.6b): what silhouettes have shaped can be shaped further, as often as one likes.
///
/// - **Matching.** Each section whose plane a curve passes through, no farther from the section than that is wide, is
///   pinned there: the place nearest to the point of passage, at or between points of the section, goes to it, to 1e-12
///   of the section's size. Between its points the section is the smooth closed curve through them, a cubic spline over
///   their number. Of several passages the nearest counts.
/// - **Displacement.** The section is a closed beam, and the displacement of its points the exact solution of its
///   equation, `k_b d'''' - k_s d'' = 0`, around it through all pins ([`TensionSpline`]), so that it keeps its own shape.
///   Rails that are held are pins that stay; within a twelfth of the way around from a curve they give way, all the more
///   the closer it is, so that a curve may cross them without a crease. Without held rails, one curve moves whole
///   sections.
/// - **Ends.** Beyond the ends of a curve sections follow less and less over `fade`, as a clamped beam does. A curve that
///   begins and ends on the surface needs none of it.
///
/// Poles and sections without area stay as they are. Which way curves run, and in which order they come, does not matter,
/// except where two curves meet on a section: there the first counts.
///
/// # Errors
/// [`CurvesError`] for no curves, curves beside the sections, open sections, a length that is none, and where
/// `progress`, called with the fraction done, asked to stop.
pub fn deform_to_curves(
    sections: &Sections,
    curves: &[Curve],
    options: &FreeFormOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<FreeFormDeformed, CurvesError> {
    let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(CurvesError::Cancelled) };
    go_on(0.0)?;
    if curves.is_empty() {
        return Err(CurvesError::NoCurves);
    }
    if !sections.is_closed() {
        return Err(CurvesError::SectionsAreOpen);
    }
    if !(options.fade.is_finite() && options.fade >= 0.0) {
        return Err(CurvesError::Fade { fade: options.fade });
    }
    if let Some(large) = curves.iter().find(|c| c.points().iter().any(|p| p.abs().max_element() > 1e100)) {
        return Err(CurvesError::TooLarge { curve: large.name().to_owned() });
    }
    let planes: Vec<Option<Plane>> = sections.iter().map(Plane::of).collect();
    let mut pins: Vec<Vec<Pin>> = vec![Vec::new(); sections.len()];
    let mut followed = Vec::with_capacity(curves.len());
    let mut meetings = 0;
    for (index, curve) in curves.iter().enumerate() {
        let mut own: Vec<Option<Pin>> = Vec::with_capacity(sections.len());
        for (section, plane) in sections.iter().zip(&planes) {
            let done = (index as f64 + own.len() as f64 / sections.len() as f64) / curves.len() as f64;
            go_on(0.5 * done)?;
            own.push(plane.as_ref().and_then(|plane| plane.pin(section, curve)));
        }
        let Some((first, last)) = own.iter().position(Option::is_some).zip(own.iter().rposition(Option::is_some))
        else {
            return Err(CurvesError::Beside { curve: curve.name().to_owned(), index });
        };
        let largest_move = own.iter().flatten().map(|pin| pin.moved.length()).fold(0.0, f64::max);
        followed.push(FollowedCurve { first, last, largest_move });
        fade_out(sections, &planes, &mut own, [first, last], options);
        for (all, pin) in pins.iter_mut().zip(own) {
            let Some(pin) = pin else { continue };
            let meets = all.iter().any(|other| apart(other.u, pin.u) * (sections.nodes() as f64) < 1.0);
            meetings += usize::from(meets);
            if !meets {
                all.push(pin);
            }
        }
    }
    let mut rows = Vec::with_capacity(sections.len());
    let mut largest_move = 0.0_f64;
    for (k, (section, pins)) in sections.iter().zip(&pins).enumerate() {
        go_on(0.5 + 0.5 * k as f64 / sections.len() as f64)?;
        let mut row = section.to_vec();
        if !pins.is_empty() {
            let held: &[usize] = if options.hold_rails { sections.rails() } else { &[] };
            let moved = displacement(pins, held, section.len(), options.stiffness)
                .map_err(|source| CurvesError::Beam { section: k, source })?;
            for (point, moved) in row.iter_mut().zip(moved) {
                *point += moved;
                largest_move = largest_move.max(moved.length());
            }
        }
        rows.push(row);
    }
    go_on(1.0)?;
    let mut warnings = Vec::new();
    if meetings > 0 {
        warnings.push(format!(
            "On {meetings} section(s) curves come within one point of each other, and the first of them counts: keep them \
             apart, or give sections more points."
        ));
    }
    let sections = Sections::new(rows, true, sections.rails().to_vec())?;
    Ok(FreeFormDeformed { sections, curves: followed, largest_move, warnings })
}

/// The plane of a section.
struct Plane {
    centre: DVec3,
    normal: DVec3,
    /// Diagonal of the box around the section.
    size: f64,
    /// The smooth curve through the points of the section.
    smooth: CubicSpline,
}

impl Plane {
    /// None of a section that encloses nothing.
    fn of(section: &[DVec3]) -> Option<Self> {
        let centre = section.iter().copied().sum::<DVec3>() / section.len() as f64;
        let (low, high) =
            section.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        let size = (high - low).length();
        let area = vector_area(section.iter().copied());
        let normal = (area.length() > 1e-9 * size * size).then(|| area.try_normalize())??;
        Some(Self { centre, normal, size, smooth: smooth(section.to_vec())? })
    }

    /// Where a curve that passes this plane pins its section.
    fn pin(&self, section: &[DVec3], curve: &Curve) -> Option<Pin> {
        // A curve that ends in the plane passes it.
        let height = |p: DVec3| {
            let height = (p - self.centre).dot(self.normal);
            if height.abs() <= IN_PLANE * self.size { 0.0 } else { height }
        };
        let mut best: Option<(f64, Pin)> = None;
        for segment in 0..curve.segment_count() {
            let (from, to) = curve.segment(segment);
            let (below, above) = (height(from), height(to));
            if below * above > 0.0 || below == above {
                continue;
            }
            let passage = from.lerp(to, below / (below - above));
            let (u, foot) = self.nearest(section, passage);
            let distance = passage.distance(foot);
            if distance <= self.size && best.is_none_or(|best| distance < best.0) {
                best = Some((distance, Pin { u, moved: passage - foot }));
            }
        }
        best.map(|best| best.1)
    }

    /// The place of the smooth section nearest to a point, by Newton's method from the nearest place between its points:
    /// its share of the way around, counted in points, and itself.
    fn nearest(&self, section: &[DVec3], point: DVec3) -> (f64, DVec3) {
        let count = section.len() as f64;
        let mut best = (f64::INFINITY, 0.0);
        for (j, from) in section.iter().enumerate() {
            let way = section[(j + 1) % section.len()] - *from;
            let square = way.length_squared();
            let share = if square > 0.0 { ((point - *from).dot(way) / square).clamp(0.0, 1.0) } else { 0.0 };
            let distance = point.distance_squared(*from + way * share);
            if distance < best.0 {
                best = (distance, j as f64 + share);
            }
        }
        let mut at = best.1;
        for _ in 0..NEWTON {
            let off = self.smooth.position(at) - point;
            let (along, bend) = (self.smooth.derivative(at), self.smooth.second_derivative(at));
            let rise = along.length_squared() + off.dot(bend);
            // Beyond the centre of curvature the nearest place is not where the distance is stationary.
            if rise <= 0.0 {
                break;
            }
            let step = (off.dot(along) / rise).clamp(-0.5, 0.5);
            at = (at - step).rem_euclid(count) % count;
            if step.abs() <= 1e-15 * count {
                break;
            }
        }
        (at / count, self.smooth.position(at))
    }
}

/// The smooth closed curve through the values at the points of a section, by their number: what surfaces make of a
/// section. None where values are not finite.
fn smooth(values: Vec<DVec3>) -> Option<CubicSpline> {
    let numbers = (0..=values.len()).map(|j| j as f64).collect();
    CubicSpline::periodic(numbers, values).ok()
}

/// Pins beyond the ends of a curve, which move less and less, and between them where the curve passes no plane.
fn fade_out(
    sections: &Sections,
    planes: &[Option<Plane>],
    own: &mut [Option<Pin>],
    [first, last]: [usize; 2],
    options: &FreeFormOptions,
) {
    let mut before = first;
    for k in first + 1..=last {
        if own[k].is_none() {
            continue;
        }
        if let (Some(from), Some(to)) = (own[before], own[k]) {
            for (between, pin) in own.iter_mut().enumerate().take(k).skip(before + 1) {
                let share = (between - before) as f64 / (k - before) as f64;
                let turn = (to.u - from.u + 0.5).rem_euclid(1.0) - 0.5;
                let u = (from.u + turn * share).rem_euclid(1.0) % 1.0;
                *pin = planes[between].as_ref().map(|_| Pin { u, moved: from.moved.lerp(to.moved, share) });
            }
        }
        before = k;
    }
    let beam = ExactHermite::new(options.stiffness);
    let beyond: [(usize, Vec<usize>); 2] =
        [(first, (0..first).rev().collect()), (last, (last + 1..sections.len()).collect())];
    for (end, others) in beyond {
        let Some(pin) = own[end] else { continue };
        let (mut way, mut at) = (0.0, sections.centre(end));
        for k in others {
            let centre = sections.centre(k);
            way += centre.distance(at);
            at = centre;
            if way >= options.fade {
                break;
            }
            let [weight, ..] = beam.values(way / options.fade);
            own[k] = planes[k].as_ref().map(|_| Pin { moved: pin.moved * weight, ..pin });
        }
    }
}

/// Distance of two places on a section, 0 to 1/2.
fn apart(u: f64, v: f64) -> f64 {
    let between = (u - v).rem_euclid(1.0);
    between.min(1.0 - between)
}

/// The displacement of each of `nodes` points around a section.
fn displacement(pins: &[Pin], held: &[usize], nodes: usize, stiffness: Stiffness) -> Result<Vec<DVec3>, BeamError> {
    let mut all: Vec<Pin> = pins.to_vec();
    let mut give_way = Vec::new();
    let mut rails = held.to_vec();
    rails.sort_unstable();
    rails.dedup();
    for rail in rails {
        let u = rail as f64 / nodes as f64;
        let near = pins.iter().map(|pin| apart(pin.u, u)).fold(f64::INFINITY, f64::min);
        if near >= GIVES_WAY {
            all.push(Pin { u, moved: DVec3::ZERO });
        } else if near * nodes as f64 >= 1.0 {
            // All of what it would move by without being held where the curve is one point off, and nothing farther off.
            let t = (GIVES_WAY - near) / (GIVES_WAY - 1.0 / nodes as f64);
            give_way.push((u, t * t * (3.0 - 2.0 * t)));
        }
    }
    // Each in its turn by its share of what the others leave it free to do, until they agree: one alone at once, several
    // within a few turns, as they hardly feel each other. Thus none appears or vanishes at once along the stack.
    let fixed = all.len();
    all.extend(give_way.iter().map(|(u, _)| Pin { u: *u, moved: DVec3::ZERO }));
    let size = pins.iter().map(|pin| pin.moved.length()).fold(0.0, f64::max);
    for _ in 0..TURNS {
        let mut changed = 0.0_f64;
        for (k, (u, share)) in give_way.iter().enumerate() {
            let own = all.swap_remove(fixed + k);
            let moved = Around::through(&all, nodes, stiffness)?.spline.value(*u) * *share;
            changed = changed.max(moved.distance(own.moved));
            all.push(Pin { u: *u, moved });
            let last = all.len() - 1;
            all.swap(fixed + k, last);
        }
        if give_way.len() < 2 || changed <= 1e-15 * size {
            break;
        }
    }
    Ok(Around::through(&all, nodes, stiffness)?.at_points())
}

/// A displacement around a section.
struct Around {
    spline: TensionSpline<DVec3>,
    nodes: usize,
}

impl Around {
    /// The displacement whose values at the points move each pin's place on the smooth curve through them by what it
    /// says.
    ///
    /// A pin between points is a knot of the displacement, which the smooth curve through the points rounds a little: the
    /// values at the pins are those that solve the small system of what it makes of the cardinal functions.
    fn through(pins: &[Pin], nodes: usize, stiffness: Stiffness) -> Result<Self, BeamError> {
        let mut pins = pins.to_vec();
        pins.sort_by(|a, b| a.u.total_cmp(&b.u));
        let parameters: Vec<f64> = pins.iter().map(|pin| pin.u).collect();
        let count = pins.len();
        let mut seen = DMatrix::zeros(count, count);
        for column in 0..count {
            let mut unit = vec![DVec3::ZERO; count];
            unit[column] = DVec3::X;
            let cardinal = Self { spline: TensionSpline::periodic(&parameters, &unit, stiffness)?, nodes };
            let rounded = cardinal.rounded()?;
            for (row, u) in parameters.iter().enumerate() {
                seen[(row, column)] = rounded.position(u * nodes as f64).x;
            }
        }
        let factor = seen.lu();
        let mut values = vec![DVec3::ZERO; count];
        for axis in 0..3 {
            let wanted = DVector::from_iterator(count, pins.iter().map(|pin| pin.moved[axis]));
            let solved = factor.solve(&wanted).ok_or(BeamError::NotSolvable)?;
            for (value, solved) in values.iter_mut().zip(solved.iter()) {
                value[axis] = *solved;
            }
        }
        Ok(Self { spline: TensionSpline::periodic(&parameters, &values, stiffness)?, nodes })
    }

    /// The displacement of each point.
    fn at_points(&self) -> Vec<DVec3> {
        (0..self.nodes).map(|j| self.spline.value(j as f64 / self.nodes as f64)).collect()
    }

    /// What the smooth curve through the points makes of it.
    fn rounded(&self) -> Result<CubicSpline, BeamError> {
        smooth(self.at_points()).ok_or(BeamError::NotSolvable)
    }
}
