//! Tests of the deformation by a cross-section.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::*;
use crate::curve::{Curve, closest};
use crate::sections::Sections;

/// A tube around +Y of `rows` sections 10 cm apart, with fine detail on it.
fn tube(rows: usize) -> Sections {
    let row = |k: usize| {
        (0..64)
            .map(|j| {
                let a = TAU * j as f64 / 64.0;
                let r = 0.2 + 0.002 * (9.0 * a + k as f64).sin();
                DVec3::new(r * a.cos(), 0.1 * k as f64, -r * a.sin())
            })
            .collect()
    };
    Sections::new((0..rows).map(row).collect(), true, vec![0, 16, 32, 48]).unwrap()
}

/// A closed contour at a height, its radius a function of the angle.
fn contour(height: f64, radius: impl Fn(f64) -> f64) -> Curve {
    let points = (0..300).map(|j| {
        let a = TAU * f64::from(j) / 300.0;
        DVec3::new(radius(a) * a.cos(), height, -radius(a) * a.sin())
    });
    Curve::new("waist", points.collect(), true).unwrap()
}

fn pear(a: f64) -> f64 {
    0.24 + 0.04 * (2.0 * a).cos() + 0.02 * (a - 0.3).sin()
}

fn options(reach: f64) -> CrossSectionOptions {
    CrossSectionOptions { before: reach, after: reach, ..CrossSectionOptions::default() }
}

fn apply(sections: &Sections, contour: &Curve, options: &CrossSectionOptions) -> Deformed {
    deform_by_cross_section(sections, contour, options, &|_| true).unwrap()
}

#[test]
fn the_contour_replaces_the_closest_section_exactly() {
    let (tube, waist) = (tube(11), contour(0.42, pear));
    let made = apply(&tube, &waist, &options(0.31));
    assert_eq!((made.section, made.first, made.last, made.notes.len()), (4, 1, 7, 0));
    assert_eq!(made.sections.rails(), tube.rails());
    for point in made.sections.section(4) {
        assert!(closest(&waist, *point).distance < 1e-15 && (point.y - 0.42).abs() < 1e-15);
    }
    // Every point of the contour has a point of the section within the section's own spacing.
    let ring = Curve::new("", made.sections.section(4).to_vec(), true).unwrap();
    assert!(waist.points().iter().all(|p| closest(&ring, *p).distance < 1e-3));
    for (from, to) in tube.section(4).iter().zip(made.sections.section(4)) {
        let about = |p: &DVec3| *p - super::contour_matching::centroid(waist.points());
        let (from, to) = (about(from).with_y(0.0), about(to).with_y(0.0));
        assert!(from.cross(to).length() < 1e-14 && from.dot(to) > 0.0, "points move radially");
    }
}

#[test]
fn nothing_moves_outside_of_the_range() {
    let tube = tube(11);
    for continuity in [Continuity::Position, Continuity::PositionAndTangent] {
        let made = apply(&tube, &contour(0.42, pear), &CrossSectionOptions { continuity, ..options(0.31) });
        for row in (0..=1).chain(7..11) {
            assert_eq!(made.sections.section(row), tube.section(row));
        }
        for row in 2..7 {
            assert_ne!(made.sections.section(row), tube.section(row));
        }
    }
}

#[test]
fn detail_is_kept_because_displacements_are_solved() {
    let (bumpy, waist) = (tube(13), contour(0.6, pear));
    let made = apply(&bumpy, &waist, &options(0.41));
    // One displacement, scaled section by section.
    let displacement = |row: usize| -> Vec<DVec3> {
        made.sections.section(row).iter().zip(bumpy.section(row)).map(|(p, q)| *p - *q).collect()
    };
    let pinned = displacement(6);
    for row in 3..=9 {
        let moved = displacement(row);
        let share = moved[5].length() / pinned[5].length();
        assert!(share > 0.1 && share <= 1.0 + 1e-12);
        assert!(moved.iter().zip(&pinned).all(|(m, p)| m.distance(*p * share) < 1e-12), "row {row}");
    }
}

#[test]
fn displacements_are_those_of_the_reference_beam() {
    // Nine sections, the contour at the fourth: a displacement of 1 spreads as the reference says.
    let natural = [
        0.0,
        0.4193848615828,
        0.7749293312649,
        1.0,
        1.02225522995,
        0.8919817751833,
        0.6527932598096,
        0.3435382740387,
        0.0,
    ];
    let clamped = [
        0.0,
        0.2339268617391,
        0.6572999400496,
        1.0,
        0.9883783621053,
        0.7580329044764,
        0.4349923381111,
        0.1412299629997,
        0.0,
    ];
    let tube = tube(9);
    let target: Vec<DVec3> = tube.section(3).iter().map(|p| *p + DVec3::new(0.0, 0.03, 0.0)).collect();
    let raised = Curve::new("raised", target, true).unwrap();
    for (continuity, wanted) in [(Continuity::Position, natural), (Continuity::PositionAndTangent, clamped)] {
        let made = apply(&tube, &raised, &CrossSectionOptions { continuity, ..options(9.0) });
        assert_eq!((made.section, made.first, made.last), (3, 0, 8));
        for (row, share) in wanted.iter().enumerate() {
            let moved = made.sections.section(row).iter().zip(tube.section(row)).map(|(p, q)| *p - *q);
            for step in moved {
                assert!(step.distance(DVec3::new(0.0, 0.03 * share, 0.0)) < 1e-12, "row {row}: {step}");
            }
        }
        assert!(made.notes.iter().any(|n| n.contains("before section 3 is 9 m, but the stack ends after 0.3")));
    }
}

#[test]
fn tangents_are_kept_at_the_ends_of_the_range_by_default() {
    // A 1 m tube with ever more sections: the slope of the displacement beside the border, per metre.
    let slope = |rows: usize, continuity: Continuity| {
        let height = |k: usize| k as f64 / (rows - 1) as f64;
        let ring = |r: f64, y: f64| -> Vec<DVec3> {
            (0..16).map(|j| DQuat::from_rotation_y(TAU * f64::from(j) / 16.0) * DVec3::X * r + DVec3::Y * y).collect()
        };
        let sections = Sections::new((0..rows).map(|k| ring(0.3, height(k))).collect(), true, vec![]).unwrap();
        let waist = Curve::new("waist", ring(0.2, 0.5), true).unwrap();
        let made = apply(&sections, &waist, &CrossSectionOptions { continuity, ..options(1.0) });
        (made.sections.section(1)[0] - sections.section(1)[0]).length() * (rows - 1) as f64
    };
    let (coarse, fine) = (slope(65, Continuity::PositionAndTangent), slope(129, Continuity::PositionAndTangent));
    assert!(fine < 0.02 && (coarse / fine - 2.0).abs() < 0.05, "{coarse} {fine}");
    let crease = slope(129, Continuity::Position);
    assert!((crease - 0.3).abs() < 0.01, "{crease}");
}

#[test]
fn start_and_direction_of_the_contour_do_not_matter() {
    let tube = tube(11);
    let drawn = contour(0.42, pear);
    for matching in [Matching::Auto, Matching::Angle, Matching::ArcLength] {
        let options = CrossSectionOptions { matching, ..options(0.31) };
        let wanted = apply(&tube, &drawn, &options);
        for (turn, reversed) in [(0, true), (77, false), (211, true)] {
            let mut points = drawn.points().to_vec();
            points.rotate_left(turn);
            if reversed {
                points.reverse();
            }
            let found = apply(&tube, &Curve::new("waist", points, true).unwrap(), &options);
            let apart = found.sections.points().iter().zip(wanted.sections.points()).map(|(p, q)| p.distance(*q));
            assert!(apart.fold(0.0, f64::max) < 1e-12, "{matching:?}, {turn}, {reversed}");
        }
    }
}

#[test]
fn a_tilted_contour_is_followed_into_its_plane() {
    let tilt = DQuat::from_rotation_x(0.5);
    let waist = contour(0.0, pear).map(|p| tilt * p + DVec3::Y * 0.42).unwrap();
    let made = apply(&tube(11), &waist, &options(0.31));
    assert!(made.sections.section(4).iter().all(|p| closest(&waist, *p).distance < 1e-14));
}

#[test]
fn a_bent_contour_is_matched_by_arc_length() {
    // A thick C around the tube's axis.
    let c: Vec<DVec3> = (0..=60)
        .map(|k| (0.28, 0.4 + f64::from(k) * 0.09))
        .chain((0..=60).rev().map(|k| (0.18, 0.4 + f64::from(k) * 0.09)))
        .map(|(r, a)| DVec3::new(r * a.cos(), 0.42, -r * a.sin()))
        .collect();
    let c = Curve::new("c", c, true).unwrap();
    let made = apply(&tube(11), &c, &options(0.31));
    assert!(made.notes.len() == 1 && made.notes[0].contains("contour \"c\" is not star-shaped"), "{:?}", made.notes);
    let section = Curve::new("", made.sections.section(4).to_vec(), true).unwrap();
    assert!(section.points().iter().all(|p| closest(&c, *p).distance < 1e-14));
    let by_angle = CrossSectionOptions { matching: Matching::Angle, ..options(0.31) };
    let error = deform_by_cross_section(&tube(11), &c, &by_angle, &|_| true).unwrap_err();
    assert_eq!(error, CrossSectionError::NotStarShaped { what: "contour \"c\"".into() });
}

#[test]
fn a_pole_at_the_border_stays_a_pole() {
    let rows = (0..9).map(|k| {
        let r = 0.2 * (PI / 2.0 * f64::from(k) / 8.0).cos();
        let r = if k == 8 { 0.0 } else { r };
        (0..32)
            .map(|j| DQuat::from_rotation_y(TAU * f64::from(j) / 32.0) * DVec3::X * r + DVec3::Y * 0.05 * f64::from(k))
            .collect()
    });
    let cap = Sections::new(rows.collect(), true, vec![]).unwrap();
    let made = apply(&cap, &contour(0.2, |_| 0.17), &options(1.0));
    assert!(made.sections.is_pole(8) && made.last == 8);
}

#[test]
fn errors_say_what_to_do() {
    let tube = tube(11);
    let error = |sections: &Sections, contour: &Curve, options: &CrossSectionOptions| {
        deform_by_cross_section(sections, contour, options, &|_| true).unwrap_err()
    };
    let waist = contour(0.42, pear);
    let open = Curve::new("waist", waist.points().to_vec(), false).unwrap();
    assert!(matches!(error(&tube, &open, &options(0.31)), CrossSectionError::ContourIsOpen { .. }));
    let sheet = Sections::new(tube.iter().map(<[DVec3]>::to_vec).collect(), false, vec![]).unwrap();
    assert_eq!(error(&sheet, &waist, &options(0.31)), CrossSectionError::SectionsAreOpen);
    let short = Sections::new(tube.iter().take(4).map(<[DVec3]>::to_vec).collect(), true, vec![]).unwrap();
    assert_eq!(error(&short, &waist, &options(0.31)), CrossSectionError::TooFewSections { found: 4 });
    for reach in [-0.1, f64::NAN, f64::INFINITY] {
        let bad = CrossSectionOptions { after: reach, ..options(0.31) };
        assert!(matches!(error(&tube, &waist, &bad), CrossSectionError::Reach { which: "after", .. }));
    }
    let narrow = error(&tube, &waist, &CrossSectionOptions { before: 0.15, ..options(0.31) });
    let CrossSectionError::RangeTooSmall { which: "before", section: 4, needed } = narrow else { panic!("{narrow}") };
    assert!(apply(&tube, &waist, &CrossSectionOptions { before: needed, ..options(0.31) }).first == 2);
    for (height, border) in [(0.08, "first"), (0.93, "last")] {
        let low = error(&tube, &contour(height, pear), &options(0.31));
        assert!(matches!(&low, CrossSectionError::NoRoom { border: b, .. } if *b == border), "{low}");
    }
    let far = error(&tube, &contour(0.42, pear).map(|p| p + DVec3::X).unwrap(), &options(0.31));
    assert!(matches!(far, CrossSectionError::TooFar { section: 4, distance, .. } if distance > 0.9), "{far}");
    let upright = waist.map(|p| DQuat::from_rotation_z(1.2) * (p - DVec3::Y * 0.4) + DVec3::Y * 0.4).unwrap();
    let turned = error(&tube, &upright, &options(0.31));
    assert!(matches!(turned, CrossSectionError::Turned { degrees, .. } if (degrees - 68.75).abs() < 0.1), "{turned}");
    let line = Curve::new("line", vec![DVec3::Y * 0.4, DVec3::new(0.1, 0.4, 0.0), DVec3::new(0.2, 0.4, 0.0)], true);
    assert!(matches!(error(&tube, &line.unwrap(), &options(0.31)), CrossSectionError::ContourIsFlat { .. }));
    let ribbon = tube.iter().map(|row| row.iter().map(|p| p.with_z(0.0)).collect()).collect();
    let ribbon = Sections::new(ribbon, true, vec![]).unwrap();
    assert!(matches!(error(&ribbon, &waist, &options(0.31)), CrossSectionError::SectionIsFlat { section: 4, .. }));
    let needle = (0..6).map(|k| vec![DVec3::Y * f64::from(k); 8]).collect();
    let needle = Sections::new(needle, true, vec![]).unwrap();
    assert!(matches!(error(&needle, &waist, &options(0.31)), CrossSectionError::SectionIsFlat { .. }));
}

#[test]
fn points_beyond_the_numbers_do_not_panic() {
    let tube = tube(7);
    let huge = Sections::new(tube.iter().map(|r| r.iter().map(|p| *p * 1e300).collect()).collect(), true, vec![]);
    let huge = huge.unwrap();
    let waist = contour(0.3, pear);
    let grown = waist.map(|p| p * 1e300).unwrap();
    for (sections, contour) in [(&huge, &grown), (&tube, &grown), (&huge, &waist)] {
        assert!(deform_by_cross_section(sections, contour, &options(0.2), &|_| true).is_err());
    }
}

#[test]
fn progress_rises_and_cancels_and_the_largest_move_is_told() {
    let (sections, contour) = (tube(11), contour(0.5, |_| 0.3));
    let calls = std::cell::RefCell::new(Vec::new());
    let listen = |done: f64| {
        calls.borrow_mut().push(done);
        true
    };
    let made = deform_by_cross_section(&sections, &contour, &options(0.3), &listen).unwrap();
    let calls = calls.into_inner();
    assert!(calls.len() > made.last - made.first && calls.windows(2).all(|w| w[0] <= w[1]) && calls[0] >= 0.0);
    let moved = sections.points().iter().zip(made.sections.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!((made.largest_move - moved).abs() < 1e-12 && moved > 0.09, "{} {moved}", made.largest_move);
    let stopped = deform_by_cross_section(&sections, &contour, &options(0.3), &|done| done < 0.5);
    assert_eq!(stopped.unwrap_err(), CrossSectionError::Cancelled);
}

#[test]
fn a_range_counted_in_sections_is_that_many() {
    let tube = tube(11);
    let counted = CrossSectionOptions { range: RangeBy::Sections, before: 3.0, after: 2.0, ..options(0.0) };
    let made = apply(&tube, &contour(0.42, pear), &counted);
    assert_eq!((made.section, made.first, made.last), (4, 1, 6));
    let metres = CrossSectionOptions { before: 0.31, after: 0.21, ..options(0.0) };
    assert_eq!(made.sections, apply(&tube, &contour(0.42, pear), &metres).sections);
    let short = CrossSectionOptions { after: 1.0, ..counted };
    let error = deform_by_cross_section(&tube, &contour(0.42, pear), &short, &|_| true).unwrap_err();
    assert_eq!(error, CrossSectionError::TooFewInRange { which: "after", section: 4 });
    let far = apply(&tube, &contour(0.42, pear), &CrossSectionOptions { after: 50.0, ..counted });
    assert!(far.last == 10 && far.notes[0].contains("is 50 sections, but the stack ends after 6 sections"));
}

#[test]
fn several_contours_are_exact_at_once_and_share_what_lies_between() {
    let tube = tube(21);
    let (low, high, far) = (contour(0.5, pear), contour(0.9, |_| 0.15), contour(1.6, |_| 0.3));
    let go = |contours: &[Curve], options: &CrossSectionOptions| {
        deform_by_cross_sections(&tube, contours, options, &|_| true).unwrap()
    };
    for continuity in [Continuity::Position, Continuity::PositionAndTangent] {
        let options = CrossSectionOptions { continuity, ..options(0.31) };
        let made = go(&[far.clone(), low.clone(), high.clone()], &options);
        let found: Vec<_> = made.replaced.iter().map(|r| (r.section, r.first, r.last)).collect();
        assert_eq!(found, [(16, 13, 19), (5, 2, 8), (9, 6, 12)]);
        for (contour, replaced) in [&far, &low, &high].into_iter().zip(&made.replaced) {
            assert!(made.sections.section(replaced.section).iter().all(|p| closest(contour, *p).distance < 1e-14));
        }
        assert_eq!(made.sections, go(&[high.clone(), far.clone(), low.clone()], &options).sections);
        // Apart from others a contour does what it does alone; 12 and 13 are ends of ranges.
        let alone = apply(&tube, &far, &options);
        for row in (0..=2).chain(12..21) {
            let wanted = if row < 12 { &tube } else { &alone.sections };
            assert_eq!(made.sections.section(row), wanted.section(row), "row {row}");
        }
        let one = apply(&tube, &low, &options);
        assert_ne!(made.sections.section(7), one.sections.section(7), "both pull");
        let moved = tube.points().iter().zip(made.sections.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert_eq!(made.largest_move, moved);
    }
    let error = |contours: &[Curve]| deform_by_cross_sections(&tube, contours, &options(0.31), &|_| true).unwrap_err();
    assert_eq!(error(&[]), CrossSectionError::NoContour);
    let same = error(&[low.clone(), high, contour(0.51, |_| 0.3).renamed("chest")]);
    assert_eq!(same, CrossSectionError::SameSection { one: "waist".into(), other: "chest".into(), section: 5 });
}
