//! Ordering sketched curves into rails that correspond: what has to be known before sections can be drawn between
//! them (thesis 6.2 and 6.4, paper 4.2).
//!
//! The order of work: open curves become rails that all run the same way ([`run`]; two that cross are cut first,
//! [`crossing`]), an axis is laid through them ([`axis`]), they are put in order about it ([`order`]), and closed
//! curves are turned to fit ([`ring`]), those between the ends as the rails pass them ([`passing`]). What was decided is told in plain words ([`explain`]), and what would twist the
//! surface is found before it does ([`twist`]).

mod axis;
mod closest_pair;
mod crossing;
mod error;
mod explain;
mod order;
mod passing;
mod ring;
mod run;
mod twist;

pub use axis::AxisSource;
pub use error::SortError;
pub use explain::Decision;
pub(crate) use explain::{metres, place};
pub(crate) use ring::{Started, start_nearest};

use super::Curve;
use axis::{Axis, Station};
use explain::label;
use glam::DVec3;

/// Share of the size of all curves within which they count as meeting.
const MEETING: f64 = 0.02;
/// Share of the size of all curves within which two rails count as one.
const SAME: f64 = 0.001;
/// Sizes (metres) between which products of several lengths stay well inside the numbers.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// How rails are put in order.
#[derive(Clone, Debug, PartialEq)]
pub struct SortOptions {
    /// Direction from the centre in which rail 0 lies; only its part across the axis counts. By default +X, the
    /// model's left.
    pub seam: DVec3,
    /// Rails in the order wanted, by name or by number (counted from 0 among the open curves as given; where two curves
    /// that cross are cut, 0 and 1 are the halves of the first one, 2 and 3 those of the second). Empty: by angle about
    /// the axis.
    pub order: Vec<String>,
    /// Whether to run the rails the other way: start and end, and the order of the closed curves, change places.
    pub reverse_run: bool,
    /// Whether the faces look towards the axis, as those of an opening one looks into: rails and closed curves are
    /// turned to run clockwise, rail 0 staying where it is.
    pub inwards: bool,
}

impl Default for SortOptions {
    fn default() -> Self {
        Self { seam: DVec3::X, order: vec![], reverse_run: false, inwards: false }
    }
}

/// Curves that correspond.
#[derive(Clone, Debug, PartialEq)]
pub struct Sorted {
    /// Open curves, all running the same way, counter-clockwise about the axis. The tangent of a section (from rail 0
    /// towards rail 1) times the direction of the rails points outwards; inwards where
    /// [`inwards`](SortOptions::inwards) asks for that, and all runs clockwise.
    pub rails: Vec<Curve>,
    /// Closed curves in the order in which the rails meet them, counter-clockwise, their first point being the one
    /// closest to the end of rail 0.
    pub closed: Vec<Curve>,
    /// The point at which all rails end, exactly (with `reverse_run`: begin).
    pub apex: Option<DVec3>,
    /// What was decided, in order.
    pub decisions: Vec<Decision>,
    /// What will twist or fold the surface unless it is mended, in an artist's words.
    pub warnings: Vec<String>,
}

/// A rail in the making.
#[derive(Clone, Debug)]
struct Rail {
    curve: Curve,
    /// What to call it in messages.
    label: String,
    /// Its number for [`SortOptions::order`].
    number: usize,
    flipped: bool,
}

/// Orders curves into rails and closed curves that correspond.
///
/// - **Closed curves** count in the order given: rails run from the first to the last, past those between. Each rail is
///   flipped where its ends are nearer to the wrong one.
/// - **One closed curve**: rails run from it, to an apex where their far ends coincide.
/// - **Two open curves that cross** or come within 2 % of the size of all curves, inside both (with no closed curve, or
///   with one from which all four ends start): both are cut at the middle P of the two points where they are closest
///   (where they meet several times, the one nearest to the middle of both), and the four pieces run to P.
/// - **Open curves alone**: they run to the end where they all coincide (to 2 % of the size and 10 % of the spread of
///   their middles), or else as the first one was drawn.
/// - Rail ends at an apex are moved onto it; the shift fades out along the rail over ten times its length.
///
/// **Axis**: mean of end minus start over the rails, normalised. Where it is shorter than 5 % of the rails' mean chord
/// (curves about a flat opening), the normal of the first closed curve, else of the plane through the starts.
/// **Order**: by the polar angle of each rail's point at half its arc length, counter-clockwise about the axis. That
/// point, other than a mean of points, does not depend on how densely a stroke was drawn, nor on hooks at its ends. The
/// centre is the centroid of the convex hull of these points seen along the axis, so that many rails on one side do not
/// pull it over. Rail 0 is the nearest to the seam direction (of two equally near ones the counter-clockwise one); a
/// seam along the axis is replaced by +Z, then +X.
/// **Closed curves** run counter-clockwise about the direction in which the rails pass them, which about a straight
/// limb is the axis, and about a bent one still the right side; those between the ends run in the order in which the
/// rails pass them. With [`inwards`](SortOptions::inwards) all is turned to
/// run clockwise in the end, so that the surface made from it looks inwards.
///
/// # Errors
/// [`SortError`] where there are too few or too many curves, they do not meet, or the pinned order does not name them.
pub fn sort(curves: &[Curve], options: &SortOptions) -> Result<Sorted, SortError> {
    sort_while(curves, options, &|| true)
}

/// Answers whether to go on.
type GoOn<'a> = dyn Fn() -> Result<(), SortError> + 'a;

/// The same, asking `go_on` every few milliseconds where curves have some ten thousand points.
///
/// # Errors
/// As [`sort`], and [`SortError::Stopped`] where `go_on` answers `false`.
pub fn sort_while(curves: &[Curve], options: &SortOptions, go_on: &dyn Fn() -> bool) -> Result<Sorted, SortError> {
    let asked = || if go_on() { Ok(()) } else { Err(SortError::Stopped) };
    asked()?;
    if !options.seam.is_finite() || options.seam == DVec3::ZERO {
        return Err(SortError::Seam { seam: options.seam });
    }
    if curves.is_empty() {
        return Err(SortError::NoCurves);
    }
    let (low, high) = curves
        .iter()
        .map(Curve::bounds)
        .reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
        .unwrap_or((DVec3::ZERO, DVec3::ZERO));
    let size = (high - low).length();
    if !SIZES.contains(&size) {
        return Err(SortError::Size { size });
    }
    let mut closed: Vec<(String, Curve)> = curves
        .iter()
        .filter(|curve| curve.is_closed())
        .enumerate()
        .map(|(i, curve)| (label(curve, "closed", i), curve.clone()))
        .collect();
    let open: Vec<Rail> = curves
        .iter()
        .filter(|curve| !curve.is_closed())
        .enumerate()
        .map(|(i, c)| Rail { curve: c.clone(), label: label(c, "open", i), number: i, flipped: false })
        .collect();
    if open.len() < 2 {
        return Err(SortError::TooFewRails { found: open.len() });
    }

    let mut decisions = vec![];
    let mut warnings = vec![];
    // Rails are told their way by where they start and end.
    let rings: Vec<&Curve> = match &closed[..] {
        [(_, first), .., (_, last)] => vec![first, last],
        few => few.iter().map(|(_, curve)| curve).collect(),
    };
    let run::Run { mut rails, apex, halves } = run::run(open, &rings, size, (&mut decisions, &mut warnings), &asked)?;
    if options.reverse_run {
        for rail in &mut rails {
            asked()?;
            rail.curve = rail.curve.clone().reversed();
            rail.flipped = !rail.flipped;
        }
        closed.reverse();
        decisions.push(Decision::RunReversed);
    }

    let rings: Vec<&Curve> = closed.iter().map(|(_, curve)| curve).collect();
    asked()?;
    let axis = Axis::of(&rails, rings.first().copied(), options.seam).ok_or(SortError::NoAxis)?;
    decisions.push(Decision::Axis { axis: axis.direction, source: axis.source });
    if axis.seam_replaced {
        decisions.push(Decision::SeamReplaced { seam: options.seam, used: axis.seam });
    }
    asked()?;
    let middle = order::middle(&rails, &axis);
    let mut rails = order::automatic(rails, &middle);
    if halves {
        run::name_halves(&mut rails);
    }
    asked()?;
    if !options.order.is_empty() {
        rails = order::pinned(rails, &options.order)?;
    }
    for (rail, drawn) in rails.iter().enumerate() {
        asked()?;
        decisions.push(Decision::Rail {
            rail,
            curve: drawn.label.clone(),
            flipped: drawn.flipped,
            angle: middle.angle(order::mid_arc(&drawn.curve)).rem_euclid(std::f64::consts::TAU),
            pinned: !options.order.is_empty(),
        });
    }

    // The closed curves belong to the starts and to the ends; a single one, run backwards, to the ends. Those between lie
    // where the rails pass them.
    let mut stations = [Station::at_starts(&rails, &axis), Station::at_ends(&rails, &axis)];
    let count = closed.len();
    let first_end = usize::from(count == 1 && options.reverse_run);
    let mut turned = Vec::with_capacity(count);
    for (i, (label, curve)) in closed.into_iter().enumerate() {
        asked()?;
        let end = if i == 0 { Some(first_end) } else { (i + 1 == count).then_some(1) };
        let (oriented, reversed, meets) = match end {
            Some(end) => {
                let (oriented, reversed) = ring::counter_clockwise(curve, stations[end].direction);
                stations[end].turn_to(&oriented, &axis);
                (oriented, reversed, [rails[0].curve.start(), rails[0].curve.end()][end])
            }
            None => {
                let passing = passing::Passing::of(&rails, &curve, axis.direction, &asked)?;
                let oriented = if passing.backwards { curve.reversed() } else { curve };
                (oriented, passing.backwards, passing.first)
            }
        };
        let ring::Started { curve, moved } = ring::start_nearest(&oriented, meets);
        decisions.push(Decision::Closed { curve: label.clone(), reversed, moved });
        turned.push((label, curve));
    }
    let at_starts = turned.first().filter(|_| first_end == 0);
    let at_ends = if first_end == 0 { turned.get(1..).and_then(<[_]>::last) } else { turned.first() };
    let scene = twist::Scene {
        rails: &rails,
        rings: [at_starts, at_ends],
        stations: &stations,
        middle: &middle,
        size,
        pinned: !options.order.is_empty(),
    };
    warnings.extend(scene.warnings(&asked)?);
    if options.inwards {
        rails[1..].reverse();
        // Closed curves keep their first point.
        for (_, curve) in &mut turned {
            asked()?;
            *curve = curve.clone().reversed();
        }
        decisions.push(Decision::Inwards);
    }
    Ok(Sorted {
        rails: rails.into_iter().map(|rail| rail.curve).collect(),
        closed: turned.into_iter().map(|(_, curve)| curve).collect(),
        apex,
        decisions,
        warnings,
    })
}

#[cfg(test)]
mod tests;
