//! Fitting sections to curves.

use super::composite::on_joint;
use super::crossing::crossing;
use super::error::{FitError, FitWarning};
use super::joints::{Automatic, Joints, automatic};
use super::options::{Angles, FitOptions, Harmonics, Sampling, Split};
use super::order_search::Tolerances;
use super::plane_frame::mean;
use super::report::{FitReport, Fitted, FittedStack, WorstPoint};
use super::samples::{Samples, Wanted};
use super::section::EllipticSection;
use super::solve::{Goal, Method, Outcome, Prepared, errors, placed, solve};
use crate::curve::Curve;
use glam::DVec3;
use nalgebra::DMatrix;

/// Most harmonics of a segment.
const MOST_HARMONICS: usize = 100;

/// Fits a generalized ellipse, or composite segments, to one curve: see [`fit_sections`].
///
/// # Errors
/// As [`fit_sections`].
pub fn fit(curve: &Curve, options: &FitOptions) -> Result<Fitted, FitError> {
    fit_sections(std::slice::from_ref(curve), options)?.sections.pop().ok_or(FitError::NoCurves)
}

/// Fits generalized ellipses, or composite segments, to the curves of a stack (thesis 3.1, 3.2).
///
/// Each curve is sampled, closed ones counter-clockwise about its frame, whose `e1` is carried along the stack; samples
/// get angles, of one kind in all sections; x, y and z are fitted by least squares with one orthogonal factorization,
/// never by normal equations (factors below 1e-12 of the largest are dropped). A planar curve has a planar fit. Joints
/// are at the same angles in all sections.
///
/// The fit of a single curve does not depend on where the curve stands in space or, with the defaults and even points,
/// on where it starts. Of a closed curve run the other way, the frame's normal and angles are reversed.
///
/// # Errors
/// [`FitError`] where options are out of range, the curves are of two kinds or too small or large, angles or joints do
/// not fit the curves, or harmonics do not fit the samples.
pub fn fit_sections(curves: &[Curve], options: &FitOptions) -> Result<FittedStack, FitError> {
    fit_sections_while(curves, options, &|_| true)
}

/// The same, asking `progress` with the fraction done whether to go on.
///
/// # Errors
/// As [`fit_sections`], and [`FitError::Stopped`] where `progress` answers `false`.
pub fn fit_sections_while(
    curves: &[Curve],
    options: &FitOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<FittedStack, FitError> {
    check(options)?;
    let Some(first) = curves.first() else { return Err(FitError::NoCurves) };
    let closed = first.is_closed();
    if let Some(other) = curves.iter().find(|curve| curve.is_closed() != closed) {
        return Err(FitError::Mixed { curve: other.name().to_owned(), closed: !closed });
    }
    let (angles, stack) = prepared(curves, options, progress)?;
    let method = Method { solution: options.solution, local_angles: options.local_angles };
    let (most, fixed) = match options.harmonics {
        Harmonics::Smallest { most } => (most, None),
        Harmonics::Fixed(harmonics) => (harmonics, Some(harmonics)),
    };
    let joints = match &options.split {
        Split::None => Joints::default(),
        Split::At(joints) if joints.is_empty() => Joints::default(),
        Split::At(joints) => Joints::given(joints, closed, stack.len())?,
        Split::Corners { angle } => Joints::at_corners(&stack, closed, *angle, options.continuity),
        Split::Automatic { most: beyond, corner_angle } => {
            let most = (*beyond).min(most);
            automatic(
                &stack,
                closed,
                Automatic { most, corner: *corner_angle, continuity: options.continuity, method },
                &|| go_on(progress, 0.4),
            )?
        }
    };
    let goal = match fixed {
        Some(harmonics) => Goal::Given(vec![harmonics; joints.angles.len() + 1]),
        None => Goal::Smallest { most },
    };
    let outcomes = solve_stack(&stack, &joints, closed, &goal, method, options.common_harmonics, progress)?;
    let sections = stack
        .iter()
        .zip(outcomes)
        .enumerate()
        .map(|(i, (prepared, outcome))| {
            let done = 0.9 + 0.1 * i as f64 / stack.len() as f64;
            finished(prepared, outcome, closed, angles, options, &|| go_on(progress, done))
        })
        .collect::<Result<_, _>>()?;
    Ok(FittedStack { sections, angles, joints: joints.common() })
}

fn go_on(progress: &dyn Fn(f64) -> bool, done: f64) -> Result<(), FitError> {
    if progress(done) { Ok(()) } else { Err(FitError::Stopped) }
}

pub(super) fn check(options: &FitOptions) -> Result<(), FitError> {
    let mut counts = vec![match options.harmonics {
        Harmonics::Smallest { most } => most,
        Harmonics::Fixed(harmonics) => harmonics,
    }];
    let mut positive = vec![
        ("a tolerance of the mean error", options.tolerances.mean),
        ("a tolerance of the maximum error", options.tolerances.maximum),
    ];
    positive.extend(options.largest_distance.map(|distance| ("a largest distance", distance)));
    match &options.split {
        Split::Corners { angle } => positive.push(("a corner angle", *angle)),
        Split::Automatic { most, corner_angle } => {
            counts.push(*most);
            positive.push(("a corner angle", *corner_angle));
        }
        Split::None | Split::At(_) => {}
    }
    if let Some(harmonics) = counts.into_iter().find(|count| !(1..=MOST_HARMONICS).contains(count)) {
        return Err(FitError::Harmonics { harmonics });
    }
    match positive.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((what, value)) => Err(FitError::NotPositive { what, value }),
        None => Ok(()),
    }
}

/// Samples, frames and angles of all curves, and the kind of angles.
pub(super) fn prepared(
    curves: &[Curve],
    options: &FitOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<(Angles, Vec<Prepared>), FitError> {
    let split = options.split != Split::None;
    let fixed = match options.harmonics {
        Harmonics::Fixed(harmonics) => Some(harmonics),
        Harmonics::Smallest { .. } => None,
    };
    let wanted = Wanted { sampling: options.sampling, split, fixed };
    let sampled = |(i, curve): (usize, &Curve)| {
        go_on(progress, 0.3 * i as f64 / curves.len() as f64)?;
        Samples::of(curve, wanted)
    };
    let mut stack = curves.iter().enumerate().map(sampled).collect::<Result<Vec<_>, _>>()?;
    align(&mut stack, options.about);
    let kind = kind_of_angles(&stack, options.angles)?;
    let first_angle = stack[0].frame.angle(stack[0].points[0]);
    let with_angles = stack.into_iter().map(|samples| {
        let angles = match kind {
            Angles::Polar => samples.polar().angles,
            _ => samples.by_arc_length(options.start, first_angle),
        };
        let (origin, diagonal) = (samples.frame.origin, samples.diagonal);
        let right = DMatrix::from_fn(samples.points.len(), 3, |i, c| (samples.points[i] - origin)[c] / diagonal);
        let limit = options.largest_distance.map_or(f64::INFINITY, |distance| distance / diagonal);
        let tolerances = Tolerances { maximum: options.tolerances.maximum.min(limit), ..options.tolerances };
        let turns = match options.split {
            Split::Corners { .. } | Split::Automatic { .. } => samples.turns(),
            Split::None | Split::At(_) => Vec::new(),
        };
        Prepared { samples, angles, right, tolerances, turns }
    });
    Ok((kind, with_angles.collect()))
}

/// Runs closed sections about one direction and carries the frame along the stack.
fn align(stack: &mut [Samples], about: Option<DVec3>) {
    let centres: Vec<DVec3> = stack.iter().map(|samples| mean(&samples.points)).collect();
    let along = match (about, &centres[..]) {
        (Some(about), _) => about,
        (None, [first, second, ..]) => *second - *first,
        (None, _) => DVec3::ZERO,
    };
    let mut before: Option<super::PlaneFrame> = None;
    for samples in stack {
        let towards = before.map_or(along, |frame| frame.normal);
        if samples.frame.normal.dot(towards) < 0.0 {
            if samples.closed {
                samples.reverse();
            } else {
                // An open section has no direction of its own about its normal.
                samples.frame = super::PlaneFrame::new(samples.frame.origin, -samples.frame.normal);
            }
        }
        if let Some(before) = &before {
            samples.carry(before);
        }
        before = Some(samples.frame);
    }
}

fn kind_of_angles(stack: &[Samples], asked: Angles) -> Result<Angles, FitError> {
    match asked {
        Angles::ArcLength => Ok(Angles::ArcLength),
        Angles::Auto => {
            let polar = stack.iter().all(|samples| samples.closed && samples.polar().clear);
            Ok(if polar { Angles::Polar } else { Angles::ArcLength })
        }
        Angles::Polar => {
            for samples in stack {
                if !samples.closed {
                    return Err(FitError::PolarOpen { curve: samples.name.clone() });
                }
                if let Some(back) = samples.polar().back {
                    return Err(FitError::NotStarShaped { curve: samples.name.clone(), at: samples.points[back] });
                }
            }
            Ok(Angles::Polar)
        }
    }
}

/// Solves all sections, then again those whose local angles, or harmonics where they are to be common, are not those
/// of the others.
fn solve_stack(
    stack: &[Prepared],
    joints: &Joints,
    closed: bool,
    goal: &Goal,
    method: Method,
    common: bool,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Vec<Outcome>, FitError> {
    let layouts: Vec<_> = (0..stack.len()).map(|i| joints.layout(i, closed)).collect();
    let segments = layouts[0].count();
    let solve_one = |i: usize, goal: &Goal, local| {
        go_on(progress, 0.4 + 0.5 * i as f64 / stack.len() as f64)?;
        solve(&stack[i], &layouts[i], goal, method, local)
    };
    let goal = match goal {
        Goal::Given(harmonics) => Goal::Given(harmonics[..segments].to_vec()),
        Goal::Smallest { .. } => goal.clone(),
    };
    let mut outcomes = (0..stack.len()).map(|i| solve_one(i, &goal, None)).collect::<Result<Vec<_>, _>>()?;
    let local: Vec<bool> = (0..segments).map(|s| outcomes.iter().any(|outcome| outcome.local()[s])).collect();
    for (i, outcome) in outcomes.iter_mut().enumerate() {
        if outcome.local() != local {
            *outcome = solve_one(i, &goal, Some(&local))?;
        }
    }
    if common {
        let most = |s: usize| outcomes.iter().map(|outcome| outcome.harmonics[s]).max().unwrap_or(1);
        let harmonics: Vec<usize> = (0..segments).map(most).collect();
        for (i, outcome) in outcomes.iter_mut().enumerate() {
            if outcome.harmonics != harmonics {
                *outcome = solve_one(i, &Goal::Given(harmonics.clone()), Some(&local))?;
            }
        }
    }
    Ok(outcomes)
}

/// The section in its place, and its report.
pub(super) fn finished(
    prepared: &Prepared,
    outcome: Outcome,
    closed: bool,
    kind: Angles,
    options: &FitOptions,
    go_on: &dyn Fn() -> Result<(), FitError>,
) -> Result<Fitted, FitError> {
    go_on()?;
    let Prepared { samples, angles, .. } = prepared;
    let Outcome { solved, harmonics, met } = outcome;
    let curve = || samples.name.clone();
    let distances = &solved.distances;
    let worst = (0..distances.len()).fold(0, |worst, i| if distances[i] > distances[worst] { i } else { worst });
    let (point, at, distance) = (samples.points[worst], angles[worst], distances[worst] * samples.diagonal);
    let errors = errors(distances.iter().copied());
    let most = harmonics.iter().copied().max().unwrap_or(0);

    let mut warnings = Vec::new();
    // A curve with polar angles goes around its centre once and can't cross itself.
    if closed
        && kind != Angles::Polar
        && let Some(at) = crossing(&samples.points, &samples.frame, go_on)?
    {
        warnings.push(FitWarning::Crossing { curve: curve(), at });
    }
    let count = samples.points.len();
    if options.sampling == Sampling::AsGiven && harmonics.len() == 1 && most > (count - 1) / 4 {
        let (curve, harmonics, most) = (curve(), most, ((count - 1) / 4).max(1));
        warnings.push(FitWarning::FewPoints { curve, harmonics, points: count, most });
    }
    if !met && matches!(options.harmonics, Harmonics::Smallest { .. }) {
        warnings.push(FitWarning::NotMet { curve: curve(), harmonics: most, distance, at: point });
    }

    let segments = solved
        .segments
        .into_iter()
        .map(|segment| placed(segment, samples.frame.origin, samples.diagonal))
        .collect::<Result<_, _>>()
        .map_err(|source| FitError::NotFinite { curve: curve(), source })?;
    let section = EllipticSection::new(samples.frame, closed, segments)?;
    let report = FitReport {
        errors,
        diagonal: samples.diagonal,
        met,
        harmonics,
        worst: WorstPoint { point, angle: on_joint(at, &section), distance },
        samples: count,
        reversed: samples.reversed,
        warnings,
    };
    Ok(Fitted { section, report })
}
