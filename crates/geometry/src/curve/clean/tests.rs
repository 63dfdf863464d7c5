use super::*;
use crate::curve::{ArcLength, closest};
use glam::DVec3;
use proptest::prelude::*;

const CLEANING: Cleaning = Cleaning { distance: 0.05, angle: 0.6, wave: 0.1 };

/// A stroke along a function, from one parameter to another, moved by another one.
fn stroke(name: &str, range: [f64; 2], line: impl Fn(f64) -> DVec3, off: impl Fn(f64) -> DVec3) -> Curve {
    let count = 150;
    let at = |k: i32| range[0] + (range[1] - range[0]) * f64::from(k) / f64::from(count);
    Curve::new(name, (0..=count).map(|k| line(at(k)) + off(at(k))).collect(), false).unwrap()
}

/// An arm: 1 m, bent, in space.
fn arm(t: f64) -> DVec3 {
    DVec3::new(t, 0.2 * (3.0 * t).sin(), 0.1 * t * t)
}

/// A closed head: about 0.5 m wide.
fn head(t: f64) -> DVec3 {
    let angle = std::f64::consts::TAU * t;
    DVec3::new(0.25 * angle.cos() + 0.03 * (2.0 * angle).cos(), 0.35 * angle.sin(), 0.0)
}

/// A slow sway of the hand of about this size.
fn sway(size: f64, phase: f64) -> impl Fn(f64) -> DVec3 {
    move |t| size * DVec3::new((5.0 * t + phase).sin(), (4.0 * t + 2.3 * phase).cos(), (3.0 * t - phase).sin())
}

/// Root of the mean squared distance of points of a curve from a function's line, its ends apart.
fn off(curve: &Curve, line: impl Fn(f64) -> DVec3, closed: bool) -> f64 {
    let points = (0..2000).map(|k| line(f64::from(k) / 2000.0)).collect();
    let truth = Curve::new("truth", points, closed).unwrap();
    let feet: Vec<_> = curve.points().iter().map(|p| closest(&truth, *p)).collect();
    let inner = feet.iter().filter(|foot| closed || (foot.fraction > 0.0 && foot.fraction < 1.0));
    (inner.clone().map(|foot| foot.distance.powi(2)).sum::<f64>() / inner.count() as f64).sqrt()
}

fn still(_: f64) -> DVec3 {
    DVec3::ZERO
}

#[test]
fn strokes_over_one_another_become_one_whichever_way_they_run() {
    let strokes: Vec<Curve> = (0..5)
        .map(|k| {
            let drawn = stroke(&format!("stroke {k}"), [0.0, 1.0], arm, sway(0.008, 1.7 * f64::from(k)));
            if k % 2 == 0 { drawn } else { drawn.reversed() }
        })
        .collect();
    let lines = clean(&strokes, &CLEANING).unwrap();
    assert_eq!(lines.len(), 1);
    let line = &lines[0];
    assert_eq!(line.strokes, [0, 1, 2, 3, 4]);
    assert!(!line.curve.is_closed());
    let each = strokes.iter().map(|stroke| off(stroke, arm, false)).sum::<f64>() / 5.0;
    let found = off(&line.curve, arm, false);
    assert!(found < each / 5.0_f64.sqrt(), "{found} {each}");
    assert!(line.spread > 0.3 * each && line.spread < 1.5 * each && line.largest < 0.03, "{} {each}", line.spread);
    let (first, last) = (line.curve.start(), line.curve.end());
    let ends =
        [first.distance(arm(0.0)).min(first.distance(arm(1.0))), last.distance(arm(1.0)).min(last.distance(arm(0.0)))];
    assert!(ends.iter().all(|end| *end < 0.01), "{ends:?}");
}

#[test]
fn pieces_that_go_on_are_chained_and_a_gap_is_bridged() {
    let piece = |name: &str, range, phase| stroke(name, range, arm, sway(0.004, phase));
    let pieces =
        [piece("middle", [0.3, 0.8], 0.0), piece("first", [0.0, 0.4], 1.0).reversed(), piece("last", [0.82, 1.0], 2.0)];
    let lines = clean(&pieces, &CLEANING).unwrap();
    assert_eq!(lines.len(), 1, "{lines:?}");
    let length = ArcLength::of(&lines[0].curve).length();
    let whole = ArcLength::of(&stroke("", [0.0, 1.0], arm, still)).length();
    assert!((length - whole).abs() < 0.02, "{length} {whole}");
    assert!(off(&lines[0].curve, arm, false) < 0.008);
    assert_eq!(lines[0].curve.name(), "middle");
}

#[test]
fn neighbours_crossings_and_branches_stay_apart() {
    let beside = |t: f64| arm(t) + DVec3::Z * 0.08;
    let lines =
        clean(&[stroke("a", [0.0, 1.0], arm, still), stroke("b", [0.0, 1.0], beside, still)], &CLEANING).unwrap();
    assert_eq!(lines.iter().map(|line| line.curve.name()).collect::<Vec<_>>(), ["a", "b"]);
    for (line, wanted) in lines.iter().zip([0.0, 0.08]) {
        assert!(off(&line.curve, |t| arm(t) + DVec3::Z * wanted, false) < 1e-3);
    }
    let straight = |slope: f64| move |t: f64| DVec3::new(t, slope * (t - 0.5), 0.0);
    for slope in [0.3, 1.0, 5.0] {
        let crossing = [stroke("a", [0.0, 1.0], straight(0.0), still), stroke("b", [0.0, 1.0], straight(slope), still)];
        assert_eq!(clean(&crossing, &CLEANING).unwrap().len(), 2, "{slope}");
    }
    let branch = |side: f64| move |t: f64| DVec3::new(t, side * (t - 0.2).max(0.0), 0.0);
    let fork = [stroke("a", [0.0, 1.0], branch(0.3), still), stroke("b", [0.0, 1.0], branch(-0.3), still)];
    assert_eq!(clean(&fork, &CLEANING).unwrap().len(), 2);
}

#[test]
fn rings_stay_closed_and_a_stroke_that_comes_around_becomes_one() {
    let ring = |phase: f64| {
        let sway = sway(0.004, phase);
        let points = (0..200).map(|k| head(f64::from(k) / 200.0 + phase) + sway(phase)).collect();
        Curve::new("ring", points, true).unwrap()
    };
    let lines = clean(&[ring(0.0), ring(0.3), ring(0.7).reversed()], &CLEANING).unwrap();
    assert!(lines.len() == 1 && lines[0].curve.is_closed());
    assert!(off(&lines[0].curve, head, true) < 0.004, "{}", off(&lines[0].curve, head, true));
    // One stroke that runs past its beginning.
    let past = stroke("past", [0.0, 1.12], head, |t| head(t) * 0.02 * t);
    let lines = clean(&[past], &CLEANING).unwrap();
    assert!(lines.len() == 1 && lines[0].curve.is_closed());
    let around = ArcLength::of(&stroke("", [0.0, 1.0], head, still)).length();
    assert!((ArcLength::of(&lines[0].curve).length() - around).abs() < 0.06);
}

/// Length of a closed line of `head`'s kind.
fn around(line: impl Fn(f64) -> DVec3) -> f64 {
    ArcLength::of(&stroke("", [0.0, 1.0], line, still)).length()
}

#[test]
fn arcs_that_come_around_together_close() {
    // Overlapping, with gaps that are bridged, and of very different lengths.
    let cases: [&[[f64; 2]]; 6] = [
        &[[0.0, 0.4], [0.35, 0.7], [0.65, 1.05]],
        &[[0.0, 0.55], [0.5, 1.05]],
        &[[0.0, 0.24], [0.25, 0.49], [0.5, 0.74], [0.75, 0.99]],
        &[[0.0, 0.8], [0.78, 1.02]],
        &[[0.0, 0.3], [0.2, 0.6], [0.4, 0.8], [0.6, 1.0], [0.8, 1.2]],
        &[[0.0, 0.9], [0.87, 0.95], [0.93, 1.01]],
    ];
    for arcs in cases {
        for turned in 0..1 << arcs.len() {
            let piece = |(k, range): (usize, &[f64; 2])| {
                let drawn = stroke("arc", *range, head, sway(0.003, range[0]));
                if turned & (1 << k) == 0 { drawn } else { drawn.reversed() }
            };
            let mut strokes: Vec<Curve> = arcs.iter().enumerate().map(piece).collect();
            strokes.rotate_left(turned % arcs.len());
            let lines = clean(&strokes, &CLEANING).unwrap();
            assert_eq!(lines.len(), 1, "{arcs:?}");
            let curve = &lines[0].curve;
            assert!(curve.is_closed(), "{arcs:?}, turned {turned}");
            let (length, off) = (ArcLength::of(curve).length(), off(curve, head, true));
            assert!((length - around(head)).abs() < 0.06 && off < 0.008, "{arcs:?}: {length}, {off}");
        }
    }
}

#[test]
fn what_does_not_come_around_stays_open() {
    // A gap of twice the distance, and a spiral whose end passes its beginning by far.
    let wide = [[0.0, 0.5], [0.45, 0.93]].map(|range| stroke("arc", range, head, sway(0.003, range[0])));
    let spiral = |t: f64| head(t) * (1.0 + 0.6 * t);
    let spiral = [[0.0, 0.5], [0.45, 1.1]].map(|range| stroke("arc", range, spiral, still));
    for arcs in [wide, spiral] {
        let lines = clean(&arcs, &CLEANING).unwrap();
        assert!(lines.len() == 1 && !lines[0].curve.is_closed(), "{lines:?}");
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let arm = [stroke("arm", [0.0, 1.0], arm, still)];
    let with = |change: &dyn Fn(&mut Cleaning)| {
        let mut cleaning = CLEANING;
        change(&mut cleaning);
        clean(&arm, &cleaning).unwrap_err()
    };
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(with(&|c| c.distance = wrong), CleanError::Distance { .. }));
        assert!(matches!(with(&|c| c.angle = wrong), CleanError::Angle { .. }));
        assert!(matches!(with(&|c| c.wave = wrong), CleanError::Wave { .. }));
    }
    let fine = with(&|c| c.distance = 1e-6);
    assert!(matches!(fine, CleanError::TooFine { least, .. } if least > 1e-5 && least < 1e-3), "{fine}");
    assert_eq!(clean(&[], &CLEANING), Ok(vec![]));
    assert_eq!(clean_while(&arm, &CLEANING, &|_| false), Err(CleanError::Stopped));
}

/// How a hand draws an arc: off by up to 4 mm each way, shaking by 1.5 mm, and which way.
struct Arc {
    off: (f64, f64),
    phase: f64,
    turned: bool,
}

/// A closed line of the size of a head.
fn ellipse(height: f64) -> impl Fn(f64) -> DVec3 + Copy {
    move |t: f64| {
        let angle = std::f64::consts::TAU * t;
        DVec3::new(0.3 * angle.cos(), height * angle.sin(), 0.0)
    }
}

/// Arcs that go around an ellipse from `start`, each into the next one by `overlap` of a turn.
fn arcs(height: f64, start: f64, overlap: f64, arcs: &[Arc]) -> Vec<Curve> {
    let share = 1.0 / arcs.len() as f64;
    let drawn = |(k, arc): (usize, &Arc)| {
        let from = start + share * k as f64;
        let rough = |t: f64| {
            0.004 * DVec3::new(arc.off.0, arc.off.1, 0.0) + DVec3::Y * 0.0015 * f64::sin(200.0 * t + arc.phase)
        };
        let curve = stroke("arc", [from, from + share + overlap], ellipse(height), rough);
        if arc.turned { curve.reversed() } else { curve }
    };
    arcs.iter().enumerate().map(drawn).collect()
}

/// What cleaning makes of arcs of an ellipse, where it is wrong.
fn wrong_ellipse(strokes: &[Curve], height: f64) -> Option<String> {
    let lines = clean(strokes, &CLEANING).unwrap();
    if lines.len() != 1 || !lines[0].curve.is_closed() {
        return Some(format!("{} lines, or open", lines.len()));
    }
    let line = ellipse(height);
    let (length, off) = (ArcLength::of(&lines[0].curve).length() - around(line), off(&lines[0].curve, line, true));
    (length.abs() >= 0.05 || off >= 0.008).then(|| format!("longer by {length}, off by {off}"))
}

#[test]
fn arcs_that_meet_in_a_tight_bend_close() {
    // Where the ends meet, at the tip of a flat ellipse, what leads there and what leads away point different ways.
    let arc = |off, phase| Arc { off, phase, turned: false };
    for (start, overlap) in [(0.885, 0.0669), (0.386, 0.0408), (0.849, 0.0904)] {
        for count in 3..=5 {
            let arcs = arcs(0.15, start, overlap, &[0.0, 1.0, 3.1354, 4.0, 5.0].map(|at| arc((0.0, 0.0), at))[..count]);
            assert_eq!(wrong_ellipse(&arcs, 0.15), None, "{count} from {start}");
        }
    }
    // Two hands, 8 mm apart where they meet.
    let off = [(0.0, 0.974), (0.0, 0.0), (0.5063, 0.0), (-0.7006, -0.5806)];
    let hands: Vec<Arc> = off.into_iter().zip([0.0, 0.0, 0.0, 3.8725]).map(|(off, phase)| arc(off, phase)).collect();
    assert_eq!(wrong_ellipse(&arcs(0.15, 0.655_356_5, 0.0478, &hands), 0.15), None);
    // A line whose straight end crosses its straight beginning goes on otherwise.
    let corners = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.01, 0.3], [0.01, -0.01]];
    let crossing = Curve::new("crossing", corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(), false).unwrap();
    assert!(!clean(&[crossing], &CLEANING).unwrap()[0].curve.is_closed());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Five copies, each moved, turned around by chance and shaking: the line comes back within the deviation over the
    /// root of five, with room for what five draws scatter.
    #[test]
    fn five_jittered_copies_give_the_line_back(
        moves in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0, any::<bool>()), 5),
        size in 0.001..0.008,
    ) {
        let moves: Vec<(DVec3, bool)> =
            moves.into_iter().map(|(x, y, z, turned)| (size * DVec3::new(x, y, z), turned)).collect();
        let strokes: Vec<Curve> = moves
            .iter()
            .enumerate()
            .map(|(k, (moved, turned))| {
                // A shaking of 23 waves, which smoothing takes away.
                let shake = |t: f64| *moved + DVec3::Y * 0.3 * size * (145.0 * t + k as f64).sin();
                let drawn = stroke("drawn", [0.0, 1.0], arm, shake);
                if *turned { drawn.reversed() } else { drawn }
            })
            .collect();
        let lines = clean(&strokes, &CLEANING).unwrap();
        prop_assert_eq!(lines.len(), 1);
        // Exactly where the copies' mean lies.
        let mean = moves.iter().map(|(moved, _)| *moved).sum::<DVec3>() / 5.0;
        let from_mean = off(&lines[0].curve, |t| arm(t) + mean, false);
        prop_assert!(from_mean < 0.2 * size + 3e-4, "{from_mean} {size}");
        prop_assert!(off(&lines[0].curve, arm, false) < 1.3 * size / 5.0_f64.sqrt() + mean.length());
    }

    /// Rough arcs of an ellipse, three to five, that overlap, in any order, each drawn either way.
    #[test]
    fn rough_arcs_of_an_ellipse_close(
        count in 3..=5_usize,
        height in 0.15..0.4,
        start in 0.0..1.0,
        overlap in 0.02..0.1,
        drawn in prop::collection::vec((-1.0..1.0, -1.0..1.0, 0.0..6.3, any::<bool>(), any::<u32>()), 5),
    ) {
        // The hand is off by 4 mm, and shakes by 1.5 mm.
        let hands: Vec<Arc> = drawn[..count]
            .iter()
            .map(|(x, y, phase, turned, _)| Arc { off: (*x, *y), phase: *phase, turned: *turned })
            .collect();
        let mut strokes: Vec<_> = drawn.iter().zip(arcs(height, start, overlap, &hands)).collect();
        strokes.sort_by_key(|((.., order), _)| *order);
        let strokes: Vec<Curve> = strokes.into_iter().map(|(_, arc)| arc).collect();
        prop_assert_eq!(wrong_ellipse(&strokes, height), None);
    }

    #[test]
    fn any_strokes_give_sound_lines(
        strokes in prop::collection::vec(
            (prop::collection::vec((-1.0..1.0, -1.0..1.0, -0.2..0.2), 3..8), any::<bool>()), 0..6),
        distance in 0.01..0.6,
        angle in 0.0..1.57,
    ) {
        let strokes: Vec<Curve> = strokes
            .into_iter()
            .map(|(points, closed)| {
                let points = points.into_iter().map(|(x, y, z)| DVec3::new(x, y, z)).collect();
                Curve::new("any", points, closed).unwrap()
            })
            .collect();
        if let Ok(lines) = clean(&strokes, &Cleaning { distance, angle, wave: 0.0 }) {
            let mut seen: Vec<usize> = lines.iter().flat_map(|line| line.strokes.clone()).collect();
            seen.sort_unstable();
            prop_assert_eq!(seen, (0..strokes.len()).collect::<Vec<_>>());
            for line in &lines {
                prop_assert!(line.curve.is_closed() || line.strokes.iter().all(|k| !strokes[*k].is_closed()));
                prop_assert!(line.spread.is_finite() && line.spread <= line.largest + 1e-12);
            }
        }
    }
}
