//! Rails between closed curves.

use super::neighbour::Neighbour;
use super::sweep::{Drawing, sweep};
use super::{GenerateError, GenerateOptions, Generated};
use crate::curve::Curve;

/// A tube between two closed curves that follows the rails drawn between them (thesis 6.3 with a second closed curve,
/// Figures 6.8, 6.9).
///
/// `rails` are two or more open curves in counter-clockwise order, each from `start` to `end`; the closed curves run
/// counter-clockwise too. The feet of the rails cut both into pieces. A generator at the share `s` of the way between
/// two rails runs from a point of the piece of `start` to one of the piece of `end`. Its weight is [`Weights::at`](super::Weights::at) of
/// `s`; smooth weights also walk the closed curves at a speed that does not jump at the feet, so that the surface does
/// not crease along the rails; linear weights use plain shares of the arc length between two feet, as printed.
///
/// In the thesis the generator is the beam curve bent by the blended sculpting forces of both rails
/// ([`blend_generators`](super::blend_generators), [`Frame::Fixed`](super::Frame::Fixed)). Forces of rails a quarter of a turn apart partly cancel: of a round belly
/// drawn by four rails 0.71 are left between them. [`Frame::Turning`](super::Frame::Turning) turns what the rails add to the loft between the
/// closed curves about the axis as these turn, apart from a shift that all rails share: surfaces of revolution and tubes
/// bent sideways stay round. The axis goes over from the normal of the one to that of the other closed curve. Where a
/// closed curve turns back by more than 3 degrees as seen from its centre, both enclose next to no area, or they face
/// opposite ways, the frame is fixed instead, with a note.
///
/// Section 0 lies on `start`, the last one on `end`, exactly on their polylines: resample a smooth closed curve of few
/// points finely first, or its facets show. Rail columns are the rails, sampled at equal arc length; where a rail ends
/// beside its curve it is bent there by the Hermite basis, at most by the snap. The points of a section are shared out
/// among the patches by the mean length of their pieces, two at least; fewer are raised to two a patch, with a note.
///
/// A gap bridged that is more than 2 % of the size of all curves together (the diagonal of the box around them) comes
/// with a warning: within the snap as it may be, it is more than a hand's shake.
///
/// # Errors
/// [`GenerateError`] for fewer than 4 sections, fewer than 2 rails, closed rails or open curves, an end farther from its
/// curve than the snap, rails that cross or share a foot, and where `progress` asked to stop.
pub fn between_closed(
    rails: &[Curve],
    start: &Curve,
    end: &Curve,
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    let drawing = Drawing {
        rails,
        profiles: vec![start, end],
        closed: true,
        apex: false,
        neighbours: [None, None],
        sides: [None, None],
    };
    sweep(&drawing, options, progress)
}

/// A tube along rails past two or more closed curves, as [`between_closed()`] makes one between two: several profile
/// curves shape it at once.
///
/// Between the first and the last of the `profiles` a generator is pinned where it passes each other one, at the section
/// nearest to the mean share of the rails' lengths; it bends smoothly there, as the beam does at a pin. With `neighbours`
/// the tube leaves the first profile, or reaches the last one, in the direction of the surface beyond it; a rail that
/// does not is bent there, with a warning.
///
/// # Errors
/// As [`between_closed()`], and for fewer than 2 profiles or 2 sections for each, profiles that a rail does not meet in
/// their order, and a neighbour without directions.
pub fn through_closed(
    rails: &[Curve],
    profiles: &[Curve],
    neighbours: [Option<Neighbour<'_>>; 2],
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    let drawing = Drawing {
        rails,
        profiles: profiles.iter().collect(),
        closed: true,
        apex: false,
        neighbours,
        sides: [None, None],
    };
    sweep(&drawing, options, progress)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{ArcLength, closest};
    use crate::generate::Weights;
    use crate::sections::Sections;
    use glam::DVec3;
    use std::f64::consts::TAU;

    const RING: usize = 4000;

    /// An ellipse around +Y, counter-clockwise, tilted to the front.
    fn ring(name: &str, height: f64, half: (f64, f64), tilt: f64) -> Curve {
        let points = (0..RING).map(|k| {
            let a = TAU * k as f64 / RING as f64;
            DVec3::new(half.0 * a.cos(), height - tilt * half.1 * a.sin(), -half.1 * a.sin())
        });
        Curve::new(name, points.collect(), true).unwrap()
    }

    /// Hips and neck of a vest, and rails from one to the other by way of waist and chest.
    fn vest(feet: &[(usize, usize)]) -> (Vec<Curve>, Curve, Curve) {
        let (hips, neck) = (ring("hips", 0.9, (0.18, 0.12), 0.0), ring("neck", 1.45, (0.09, 0.07), 0.3));
        let rails = feet.iter().enumerate().map(|(k, (from, to))| {
            let (a, b) = (hips.points()[*from], neck.points()[*to]);
            let rail = (0..=60).map(|i| {
                let t = f64::from(i) / 60.0;
                let swell = 1.0
                    + (0.5 * t - 0.35) * 4.0 * t * (1.0 - t)
                    + 0.1 * (k as f64).sin() * (3.0 * TAU / 2.0 * t).sin() * t * (1.0 - t);
                let p = a.lerp(b, t);
                DVec3::new(p.x * swell, p.y, p.z * swell)
            });
            Curve::new(format!("rail {k}"), rail.collect(), false).unwrap()
        });
        (rails.collect(), hips, neck)
    }

    const FIVE: [(usize, usize); 5] = [(0, 150), (700, 900), (1500, 1900), (2400, 2500), (3300, 3000)];

    fn options(weights: Weights) -> GenerateOptions {
        GenerateOptions { sections: 48, nodes: 64, weights, ..GenerateOptions::default() }
    }

    fn generate(weights: Weights) -> Generated {
        let (rails, hips, neck) = vest(&FIVE);
        between_closed(&rails, &hips, &neck, &options(weights), &|_| true).unwrap()
    }

    /// Largest angle, in degrees, between the tangent planes at both sides of a column, by one-sided differences of
    /// third order along the sections.
    fn crease(sections: &Sections, column: usize) -> f64 {
        let n = sections.nodes();
        let at =
            |row: usize, step: isize| sections.section(row)[(column as isize + step).rem_euclid(n as isize) as usize];
        (1..sections.len() - 1)
            .map(|row| {
                let side =
                    |d: isize| at(row, 0) * -11.0 + at(row, d) * 18.0 - at(row, 2 * d) * 9.0 + at(row, 3 * d) * 2.0;
                let up = at(row + 1, 0) - at(row - 1, 0);
                side(1).cross(up).angle_between(up.cross(side(-1))).to_degrees()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn smooth_weights_do_not_crease_along_the_rails() {
        let worst = |made: &Generated, at_rails: bool| {
            (0..64_usize)
                .filter(|column| {
                    // Away from the rails, differences must not reach across one.
                    let near = made.sections.rails().iter().map(|r| column.abs_diff(*r).min(64 - column.abs_diff(*r)));
                    near.min().is_some_and(|near| if at_rails { near == 0 } else { near > 3 })
                })
                .map(|column| crease(&made.sections, column))
                .fold(0.0, f64::max)
        };
        let (smooth, linear) = (generate(Weights::Smooth), generate(Weights::Linear));
        let found = [worst(&smooth, true), worst(&smooth, false), worst(&linear, true), worst(&linear, false)];
        assert!(found[0] < 1.0 && found[1] < 1.0 && found[3] < 1.0, "{found:?}");
        assert!(found[2] > 5.0, "{found:?}");
    }

    #[test]
    fn borders_lie_on_the_closed_curves_and_columns_on_the_rails() {
        for weights in [Weights::Smooth, Weights::Linear] {
            let ((rails, hips, neck), made) = (vest(&FIVE), generate(weights));
            assert_eq!((made.sections.len(), made.sections.nodes(), made.notes.len()), (48, 64, 0));
            assert!(made.sections.is_closed() && made.largest_gap < 1e-12);
            for (row, curve) in [(0, &hips), (47, &neck)] {
                assert!(made.sections.section(row).iter().all(|p| closest(curve, *p).distance < 1e-12));
            }
            assert_eq!(made.sections.rails().len(), 5);
            for (rail, column) in rails.iter().zip(made.sections.rails()) {
                let arc = ArcLength::of(rail);
                for (row, section) in made.sections.iter().enumerate() {
                    let wanted = arc.point_at_fraction(row as f64 / 47.0);
                    assert!(section[*column].distance(wanted) < 1e-12, "row {row}, {}", rail.name());
                }
            }
        }
    }

    #[test]
    fn linear_weights_walk_the_pieces_by_arc_length() {
        let (_, hips, _) = vest(&FIVE);
        let made = generate(Weights::Linear);
        let columns = made.sections.rails();
        let arcs = [columns[1], columns[1] + 1, columns[1] + 2, columns[2]]
            .map(|column| closest(&hips, made.sections.section(0)[column]).arc_length);
        let intervals = (columns[2] - columns[1]) as f64;
        let share = |k: usize| (arcs[k] - arcs[0]) / (arcs[3] - arcs[0]);
        assert!((share(1) - 1.0 / intervals).abs() < 1e-9 && (share(2) - 2.0 / intervals).abs() < 1e-9);
    }

    #[test]
    fn a_gap_within_the_snap_is_bent_shut() {
        let (mut rails, hips, neck) = vest(&FIVE);
        let gap = DVec3::new(0.0, 0.01, 0.0);
        rails[1] = rails[1].map(|p| if p.y < 1.0 { p + gap * ((1.0 - p.y) / 0.1).min(1.0) } else { p }).unwrap();
        let made = between_closed(&rails, &hips, &neck, &options(Weights::Smooth), &|_| true).unwrap();
        assert!((made.largest_gap - 0.01).abs() < 1e-3 && made.warnings.is_empty(), "{}", made.largest_gap);
        let gapped: Vec<bool> = made.gaps.iter().map(|[start, end]| *start > 1e-3 || *end > 1e-3).collect();
        assert_eq!(gapped, [false, true, false, false, false], "{:?}", made.gaps);
        assert_eq!(made.gaps[1][0], made.largest_gap);
        let column = made.sections.rails()[1];
        assert!(closest(&hips, made.sections.section(0)[column]).distance < 1e-12);
        let off = made.sections.iter().map(|section| closest(&rails[1], section[column]).distance);
        assert!(off.fold(0.0, f64::max) <= made.largest_gap + 1e-12);
    }

    #[test]
    fn a_gap_large_for_the_shape_is_warned_of() {
        let (mut rails, hips, neck) = vest(&FIVE);
        rails[1] = rails[1].map(|p| DVec3::new(p.x, 0.9 + (p.y - 0.9) * 0.95 + 0.0275, p.z)).unwrap();
        let options = GenerateOptions { snap: 0.1, ..options(Weights::Smooth) };
        let made = between_closed(&rails, &hips, &neck, &options, &|_| true).unwrap();
        assert!(made.largest_gap > 0.02 && made.warnings.len() == 1, "{} {:?}", made.largest_gap, made.warnings);
        assert!(made.warnings[0].contains("lower the snap"), "{:?}", made.warnings);
    }

    #[test]
    fn two_rails_and_rings_in_one_plane_will_do() {
        let (rails, hips, neck) = vest(&[(0, 0), (2000, 2000)]);
        assert!(between_closed(&rails, &hips, &neck, &options(Weights::Smooth), &|_| true).is_ok());
        let reversed = between_closed(&rails, &hips, &neck.clone().reversed(), &options(Weights::Smooth), &|_| true);
        assert_eq!(reversed.unwrap_err(), GenerateError::CurveIsReversed { which: "end", curve: "neck".into() });

        let (outer, inner) = (ring("outer", 0.0, (0.03, 0.03), 0.0), ring("inner", 0.0, (0.015, 0.01), 0.0));
        let spoke = |k: usize| Curve::new("spoke", vec![outer.points()[k], inner.points()[k]], false).unwrap();
        let rails: Vec<Curve> = [0, 1000, 2000, 3000].map(spoke).into();
        let made = between_closed(&rails, &outer, &inner, &options(Weights::Smooth), &|_| true).unwrap();
        assert!(made.sections.points().iter().all(|p| p.y.abs() < 1e-15));
        let reversed = between_closed(&rails[1..3], &outer, &inner.reversed(), &options(Weights::Smooth), &|_| true);
        assert!(matches!(reversed, Err(GenerateError::CurveIsReversed { .. })));
    }

    #[test]
    fn progress_rises_and_cancels() {
        let (rails, hips, neck) = vest(&FIVE);
        let (calls, last) = (std::cell::Cell::new(0), std::cell::Cell::new(0.0));
        let listen = |done: f64| {
            assert!((last.get()..=1.0).contains(&done));
            last.set(done);
            calls.set(calls.get() + 1);
            true
        };
        between_closed(&rails, &hips, &neck, &options(Weights::Smooth), &listen).unwrap();
        assert_eq!((calls.get(), last.get()), (65, 1.0));
        let stopped = between_closed(&rails, &hips, &neck, &options(Weights::Smooth), &|done| done < 0.5);
        assert_eq!(stopped, Err(GenerateError::Cancelled));
    }

    #[test]
    fn errors_name_the_curve_and_the_remedy() {
        let (rails, hips, neck) = vest(&FIVE);
        let run = |rails: &[Curve], start: &Curve, end: &Curve| {
            between_closed(rails, start, end, &options(Weights::Smooth), &|_| true).unwrap_err()
        };
        let with = |k: usize, rail: Curve| {
            let mut rails = rails.clone();
            rails[k] = rail;
            rails
        };
        assert_eq!(run(&rails[..1], &hips, &neck), GenerateError::TooFewRails { found: 1 });
        assert!(matches!(run(&with(3, hips.clone()), &hips, &neck), GenerateError::RailIsClosed { rail: 3, .. }));
        assert!(matches!(run(&rails, &rails[0], &neck), GenerateError::CurveIsOpen { which: "start", .. }));
        assert!(matches!(run(&rails, &hips, &rails[0]), GenerateError::CurveIsOpen { which: "end", .. }));

        let short = rails[2].map(|p| DVec3::new(p.x, p.y.min(1.3), p.z)).unwrap();
        let error = run(&with(2, short), &hips, &neck);
        assert!(matches!(&error, GenerateError::Gap { rail: 2, ends: "ends", distance, .. } if *distance > 0.1));
        let message = error.to_string();
        assert!(["rail 2", "\"neck\"", "raise the snap"].iter().all(|part| message.contains(part)), "{message}");

        let reversed = run(&with(4, rails[4].clone().reversed()), &hips, &neck);
        assert_eq!(reversed, GenerateError::RailIsReversed { rail: 4, name: "rail 4".into() });
        let twice = run(&with(4, rails[1].clone()), &hips, &neck);
        assert!(matches!(twice, GenerateError::SameFoot { first: 1, second: 4, which: "start", .. }));
        let (crossing, hips, neck) = vest(&[(0, 150), (700, 900), (1500, 2500), (2400, 1900), (3300, 3000)]);
        let error = run(&crossing, &hips, &neck);
        assert!(matches!(error, GenerateError::Crossing { first: 2, second: 3, which: "end", .. }), "{error}");
        assert!(error.to_string().starts_with("rails 2 and 3 cross"), "{error}");
        let against = run(&rails, &hips.clone().reversed(), &neck);
        assert_eq!(against, GenerateError::CurveIsReversed { which: "start", curve: "hips".into() });
        let wound_up: Vec<Curve> = [0, 2, 4, 1, 3].map(|k| rails[k].clone()).into();
        assert!(matches!(run(&wound_up, &hips, &neck), GenerateError::Crossing { .. }));

        let with_options = |change: fn(&mut GenerateOptions)| {
            let mut options = options(Weights::Smooth);
            change(&mut options);
            between_closed(&rails, &hips, &neck, &options, &|_| true)
        };
        let huge = neck.map(|p| p * 1e300).unwrap();
        assert_eq!(run(&rails, &hips, &huge), GenerateError::TooFarOut { name: "neck".into() });
        let few = with_options(|o| o.sections = 3);
        assert_eq!(few, Err(GenerateError::TooFewSections { found: 3, needed: 4 }));
        for huge in [with_options(|o| o.nodes = usize::MAX), with_options(|o| o.sections = 8193)] {
            assert!(matches!(huge, Err(GenerateError::TooLarge { .. })));
        }
        assert!(matches!(with_options(|o| o.snap = f64::NAN), Err(GenerateError::Snap { .. })));
        assert!(with_options(|o| (o.sections, o.nodes) = (4, 0)).is_ok_and(|made| made.sections.nodes() == 10));
    }
}
