//! Tests of the deformation to silhouettes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DQuat, DVec2, DVec3};

use super::*;
use crate::curve::Curve;

/// A stack about +Y; the radius depends on the height, 0 to 1.
fn stack(rows: usize, nodes: usize, radius: impl Fn(f64) -> f64) -> Sections {
    let ring = |k: usize| {
        let y = k as f64 / (rows - 1) as f64;
        let at = |j: usize| DQuat::from_rotation_y(-TAU * j as f64 / nodes as f64) * DVec3::X * radius(y);
        (0..nodes).map(|j| at(j) + DVec3::Y * y).collect()
    };
    Sections::new((0..rows).map(ring).collect(), true, vec![]).unwrap()
}

fn stroke(name: &str, count: u32, at: impl Fn(f64) -> DVec3) -> Curve {
    Curve::new(name, (0..=count).map(|i| at(f64::from(i) / f64::from(count))).collect(), false).unwrap()
}

/// Two strokes of one view from functions of the height.
fn pair(view: View, left: impl Fn(f64) -> f64, right: impl Fn(f64) -> f64) -> [Curve; 2] {
    let at = |x: f64, y: f64| view.place(DVec2::new(x, y), 0.8);
    [stroke("one", 400, |t| at(left(t), t)), stroke("other", 400, |t| at(right(t), t))]
}

fn apply(sections: &Sections, silhouettes: &[(View, &[Curve])], options: &SilhouetteOptions) -> SilhouetteDeformed {
    let silhouettes: Vec<Silhouette<'_>> =
        silhouettes.iter().map(|(view, strokes)| Silhouette { view: *view, strokes }).collect();
    deform_to_silhouette(sections, &silhouettes, options, &|_| true).unwrap()
}

fn height() -> SilhouetteOptions {
    SilhouetteOptions { matching: StrokeMatching::Height, ..SilhouetteOptions::default() }
}

fn apart(one: &Sections, other: &Sections) -> f64 {
    one.points().iter().zip(other.points()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

#[test]
fn points_in_contact_reference() {
    // A unit circle whose right side goes to (1.3, 0) and whose left side to (-0.9, 0.1): see the closed beam's pins.
    let circle = stack(5, 12, |_| 1.0);
    let right = stroke("right", 4, |t| DVec3::new(1.3, t, 0.0));
    let left = stroke("left", 4, |t| DVec3::new(-0.9, t + 0.1, 0.0));
    let options = SilhouetteOptions { contact: Contact::Point, ..SilhouetteOptions::default() };
    let made = apply(&circle, &[(View::FRONT, &[left, right])], &options);
    let wanted = [
        (1.3, 0.0),
        (1.150086522494, 0.00796944064548),
        (0.7472086211533, 0.0263968),
        (0.2, 0.05),
        (-0.3472086211533, 0.0736),
        (-0.7500865224935, 0.0920305593545),
        (-0.9, 0.1),
    ];
    for (k, section) in made.sections.iter().enumerate() {
        for (j, (x, y)) in wanted.iter().enumerate() {
            let (point, from) = (section[j], circle.section(k)[j]);
            assert!((point.x - x).abs() < 1e-11, "{point}");
            assert!((point.y - from.y - y).abs() < 1e-4 && point.z == from.z, "{point}");
        }
    }
    assert!((made.sections.section(2)[1].y - 0.5 - 0.0079694406455).abs() < 1e-12);
}

#[test]
fn columns_are_on_the_strokes_and_nothing_stands_out() {
    let strokes = pair(View::FRONT, |t| 0.4 + 0.15 * (5.0 * t).sin(), |t| -0.3 + 0.2 * t);
    for options in [height(), SilhouetteOptions::default()] {
        let made = apply(&stack(40, 48, |y| 0.4 - 0.1 * y), &[(View::FRONT, &strokes)], &options);
        assert_eq!((made.views[0].columns, made.sections.rails()), ([24, 0], &[0, 24][..]));
        assert!(made.warnings.is_empty() && made.views[0].overshoot < 1e-12, "{:?}", made.warnings);
        for (k, section) in made.sections.iter().enumerate() {
            for (column, drawn) in [(0, &strokes[0]), (24, &strokes[1])] {
                let p = section[column].with_z(0.8);
                assert!(crate::curve::closest(drawn, p).distance < 1e-12, "section {k}");
            }
        }
        for end in [0, 39] {
            let at = if end == 0 { Curve::start } else { Curve::end };
            assert!(made.sections.section(end)[0].with_z(0.8).distance(at(&strokes[0])) < 1e-12);
        }
    }
}

#[test]
fn a_second_view_leaves_the_first_exact_at_once_or_later() {
    let front = pair(View::FRONT, |t| 0.4 + 0.15 * (5.0 * t).sin(), |t| -0.5 + 0.2 * t);
    let side: Vec<Curve> = pair(View::SIDE, |t| 0.3 + 0.05 * (9.0 * t).cos(), |t| -0.2 - 0.1 * t)
        .iter()
        .map(|c| c.map(|p| p + DVec3::Y * (0.05 * p.z)).unwrap())
        .collect();
    let start = stack(33, 64, |_| 0.4);
    for contact in [Contact::Tangent, Contact::Point] {
        for options in [height(), SilhouetteOptions::default()].map(|o| SilhouetteOptions { contact, ..o }) {
            let first = apply(&start, &[(View::FRONT, &front)], &options).sections;
            let then = apply(&first, &[(View::SIDE, &side)], &options).sections;
            let at_once = apply(&start, &[(View::FRONT, &front), (View::SIDE, &side)], &options).sections;
            assert_eq!(then.rails(), [0, 16, 32, 48]);
            for ((before, after), both) in first.iter().zip(then.iter()).zip(at_once.iter()) {
                for column in [0, 32] {
                    for made in [after, both] {
                        assert!((made[column] - before[column]).truncate().length() < 1e-12);
                    }
                }
                for column in [16, 48] {
                    let on = |p: DVec3| side.iter().map(move |c| crate::curve::closest(c, p.with_x(0.8)).distance);
                    assert!([after, both].iter().all(|s| on(s[column]).fold(1.0, f64::min) < 1e-12));
                }
            }
            assert!(apart(&then, &at_once) < 0.02);
        }
    }
}

#[test]
fn applied_again_it_changes_nothing_and_moving_all_moves_all() {
    let front = pair(View::FRONT, |t| 0.4 + 0.15 * (5.0 * t).sin(), |t| -0.5 + 0.2 * t);
    let side = pair(View::SIDE, |t| 0.3 + 0.05 * (9.0 * t).cos(), |t| -0.2 - 0.1 * t);
    let start = stack(33, 64, |_| 0.4);
    let views: [(View, &[Curve]); 2] = [(View::FRONT, &front), (View::SIDE, &side)];
    let once = apply(&start, &views, &height()).sections;
    assert!(apart(&once, &apply(&once, &views, &height()).sections) < 1e-12);
    let shift = DVec3::new(0.2, -0.1, 0.3);
    let moved = |c: &Curve| c.map(|p| p * 2.0 + shift).unwrap();
    let (front, side) = (front.each_ref().map(moved), side.each_ref().map(moved));
    let rows = start.iter().map(|row| row.iter().map(|p| *p * 2.0 + shift).collect()).collect();
    let start = Sections::new(rows, true, vec![]).unwrap();
    let there = apply(&start, &[(View::FRONT, &front), (View::SIDE, &side)], &height()).sections;
    assert!(there.points().iter().zip(once.points()).all(|(p, q)| p.distance(*q * 2.0 + shift) < 1e-12));
}

#[test]
fn symmetry_in_gives_symmetry_out() {
    let strokes = pair(View::FRONT, |t| 0.4 + 0.15 * (5.0 * t).sin(), |t| -0.4 - 0.15 * (5.0 * t).sin());
    let made = apply(&stack(33, 64, |_| 0.4), &[(View::FRONT, &strokes)], &SilhouetteOptions::default());
    for section in made.sections.iter() {
        for j in 0..64 {
            let mirrored = section[(96 - j) % 64];
            assert!(section[j].distance(mirrored * DVec3::new(-1.0, 1.0, 1.0)) < 1e-12);
        }
    }
}

#[test]
fn a_bent_limb_and_a_stroke_that_folds_back_are_followed() {
    // A quarter of a ring, its inner side with a hook that folds back in height.
    let centre = |a: f64| DVec3::new(a.cos() - 1.0, a.sin(), 0.0);
    let rows = (0..192).map(|k| {
        let a = FRAC_PI_2 * f64::from(k) / 191.0;
        let out = DVec3::new(a.cos(), a.sin(), 0.0);
        (0..32)
            .map(|j| {
                let v = TAU * f64::from(j) / 32.0;
                centre(a) + (out * v.cos() + DVec3::NEG_Z * v.sin()) * 0.2
            })
            .collect()
    });
    let limb = Sections::new(rows.collect(), true, vec![]).unwrap();
    let outer = stroke("outer", 300, |t| {
        let a = FRAC_PI_2 * t;
        DVec3::new(a.cos(), a.sin(), 0.0) * (1.25 + 0.05 * (7.0 * a).sin()) - DVec3::X
    });
    let inner = stroke("inner", 300, |t| {
        let a = FRAC_PI_2 * t + 0.2 * (TAU * 2.0 * t).sin();
        DVec3::new(a.cos(), a.sin(), 0.0) * (0.75 - 0.06 * (PI * t).sin()) - DVec3::X
    });
    let folds = inner.points().windows(2).filter(|w| w[1].y < w[0].y).count();
    assert!(folds > 20, "{folds}");
    let made = apply(&limb, &[(View::FRONT, &[outer.clone(), inner.clone()])], &SilhouetteOptions::default());
    // Where the stroke folds it has more detail than sections this far apart show.
    assert!(made.warnings.iter().all(|w| w.contains("too far apart")), "{:?}", made.warnings);
    for (column, drawn) in made.views[0].columns.iter().zip([&inner, &outer]) {
        let line: Vec<DVec3> = made.sections.iter().map(|section| section[*column].with_z(0.0)).collect();
        assert!(line.iter().all(|p| crate::curve::closest(drawn, *p).distance < 1e-12));
        let line = Curve::new("", line, false).unwrap();
        let off = drawn.points().iter().map(|p| crate::curve::closest(&line, *p).distance).fold(0.0, f64::max);
        assert!(off < 2e-3, "{off}");
    }
}

#[test]
fn tips_meet_in_poles() {
    let dome = |t: f64| (1.0 - t * t).max(0.0).sqrt();
    let front = pair(View::FRONT, |t| 0.5 * dome(t), |t| -0.4 * dome(t));
    let side = pair(View::SIDE, |t| 0.3 * dome(t), |t| -0.3 * dome(t));
    // From a dome, and from a cylinder, which closes.
    for start in [stack(33, 32, |y| 0.4 * dome(y)), stack(33, 32, |_| 0.4)] {
        let made = apply(&start, &[(View::FRONT, &front), (View::SIDE, &side)], &height());
        assert!(made.sections.is_pole(32) && !made.sections.is_pole(31));
        assert!(made.sections.section(32).iter().all(|p| p.distance(DVec3::Y) < 1e-12));
    }
    // One view of a dome keeps its pole; tips at different heights are told.
    let made = apply(&stack(33, 32, |y| 0.4 * dome(y)), &[(View::FRONT, &front)], &height());
    assert!(made.sections.is_pole(32));
    let higher = side.each_ref().map(|c| c.map(|p| p * DVec3::new(1.0, 1.02, 1.0)).unwrap());
    let made = apply(&stack(33, 32, |_| 0.4), &[(View::FRONT, &front), (View::SIDE, &higher)], &height());
    assert!(made.warnings.iter().any(|w| w.contains("tips 0.02000 m apart")), "{:?}", made.warnings);
    assert!((made.sections.section(32)[5].y - 1.01).abs() < 1e-12);
}

#[test]
fn a_closed_outline_along_the_stack_is_its_widest_section() {
    // An ellipsoid seen along its axis, and a star around it.
    let ball = |rows: usize| stack(rows, 120, |y| 0.3 * (1.0 - (2.0 * y - 1.0).powi(2)).max(0.0).sqrt());
    let star = (0..600).map(|k| {
        let a = TAU * f64::from(k) / 600.0;
        DVec3::new(a.cos(), 0.0, a.sin()) * (0.6 + 0.25 * (5.0 * a).cos())
    });
    let star = [Curve::new("star", star.collect(), true).unwrap()];
    for matching in [StrokeMatching::ArcLength, StrokeMatching::Height] {
        let options = SilhouetteOptions { matching, ..SilhouetteOptions::default() };
        let made = apply(&ball(21), &[(View::TOP, &star)], &options);
        assert!(made.warnings.is_empty(), "{:?}", made.warnings);
        let off = |p: &DVec3| crate::curve::closest(&star[0], p.with_y(0.0)).distance;
        assert!(made.sections.section(10).iter().all(|p| off(p) < 1e-12 && (p.y - 0.5).abs() < 1e-12));
        assert!(made.sections.is_pole(0) && made.sections.is_pole(20));
        let middle = |k: usize| made.sections.section(k)[0].with_y(0.0).length();
        assert!((11..20).all(|k| middle(k) < middle(k - 1)));
    }
    let big = [star[0].map(|p| p * 0.3).unwrap()];
    let made = apply(&ball(21), &[(View::TOP, &big)], &height());
    assert!(made.warnings.iter().any(|w| w.contains("beyond the outline")), "{:?}", made.warnings);
}

#[test]
fn shrinking_too_much_is_told() {
    let strokes = pair(View::FRONT, |_| 0.02, |_| -0.02);
    let made = apply(&stack(9, 32, |_| 0.5), &[(View::FRONT, &strokes)], &height());
    assert!(made.views[0].overshoot > 5e-4, "{:?}", made.views);
    assert!(made.warnings[0].contains("shrinks too much"), "{:?}", made.warnings);
}

#[test]
fn a_gap_that_the_tolerance_allows_is_not_warned_of() {
    let wavy = pair(View::FRONT, |t| 0.3 + 0.03 * (20.0 * t).sin(), |_| -0.3);
    let start = stack(3, 32, |_| 0.3);
    let made = |spacing| apply(&start, &[(View::FRONT, &wavy)], &SilhouetteOptions { spacing, ..height() });
    let fine = made(SectionSpacing::ByDetail(1e-4));
    let coarse = made(SectionSpacing::ByDetail(5e-3));
    assert!(coarse.views[0].gap > 1e-3 && coarse.views[0].gap > 4.0 * fine.views[0].gap, "{:?}", coarse.views);
    assert_eq!((fine.warnings, coarse.warnings), (vec![], vec![]));
    assert_eq!(made(SectionSpacing::AsGiven).warnings.len(), 1);
}

#[test]
fn sections_by_detail_stand_at_corners_and_keep_those_given() {
    // A stroke of straight pieces with two corners, one on each side, at heights where no section is given.
    let corner = |at: f64, out: f64| move |t: f64| 0.4 + out * (1.0 - (t - at).abs() / at.max(1.0 - at));
    let (right, left) = (corner(0.41, 0.1), corner(0.77, 0.05));
    let strokes = [
        [(0.0, right(0.0)), (0.41, right(0.41)), (1.0, right(1.0))].map(|(y, x)| DVec3::new(x, y, 0.0)),
        [(0.0, left(0.0)), (0.77, left(0.77)), (1.0, left(1.0))].map(|(y, x)| DVec3::new(-x, y, 0.0)),
    ]
    .map(|points| Curve::new("stroke", points.to_vec(), false).unwrap());
    let start = stack(3, 32, |y| 0.4 - 0.1 * y);
    let options = SilhouetteOptions { spacing: SectionSpacing::ByDetail(1e-3), ..height() };
    let made = apply(&start, &[(View::FRONT, &strokes)], &options);
    // Within what a corner in the plan of the places may be off.
    let heights: Vec<f64> = (0..made.sections.len()).map(|k| made.sections.centre(k).y).collect();
    for wanted in [0.0, 0.41, 0.5, 0.77, 1.0] {
        assert!(heights.iter().any(|y| (y - wanted).abs() < 1e-12), "{wanted} among {heights:?}");
    }
    assert!(made.views[0].gap < 1e-12 && made.warnings.is_empty(), "{:?}", made.views);
    // Closer to one another the closer they are to a corner, where a spline would swing.
    let step = |at: f64| {
        let k = heights.iter().position(|y| (y - at).abs() < 1e-12).unwrap();
        (heights[k + 1] - heights[k]).max(heights[k] - heights[k - 1])
    };
    assert!(step(0.41) < 0.12 && step(0.77) < 0.12 && heights.len() < 40, "{heights:?}");
    // Straight strokes ask for nothing, and what is given stays to the bit.
    let straight = pair(View::FRONT, |t| 0.3 + 0.1 * t, |_| -0.3);
    let made = apply(&start, &[(View::FRONT, &straight)], &options);
    let as_given = apply(&start, &[(View::FRONT, &straight)], &height());
    assert_eq!(made, as_given);
    let silhouettes = [Silhouette { view: View::FRONT, strokes: &strokes }];
    let deformer = SilhouetteDeformer::new(&start, &[View::FRONT], &options).unwrap();
    let more = deformer.by_detail(&silhouettes, 1e-3, &|_| true).unwrap();
    for given in start.iter() {
        assert!(more.iter().any(|section| section == given));
    }
    for wrong in [0.0, f64::NAN, 2.0] {
        let refused = deformer.by_detail(&silhouettes, wrong, &|_| true).unwrap_err();
        assert!(matches!(refused, SilhouetteError::Tolerance { .. }));
    }
    assert_eq!(deformer.by_detail(&silhouettes, 1e-3, &|done| done < 0.5), Err(SilhouetteError::Cancelled));
}

#[test]
fn a_stroke_of_boundless_detail_is_refused() {
    let shaken = |side: f64| {
        let at = |k: u32| DVec3::new(side * (0.4 + 0.01 * f64::from(k % 2)), f64::from(k) / 40_000.0, 0.0);
        Curve::new("shaken", (0..=40_000).map(at).collect(), false).unwrap()
    };
    let options = SilhouetteOptions { spacing: SectionSpacing::ByDetail(1e-5), ..height() };
    let strokes = [shaken(1.0), shaken(-1.0)];
    let silhouettes = [Silhouette { view: View::FRONT, strokes: &strokes }];
    let refused = deform_to_silhouette(&stack(2, 1024, |_| 0.4), &silhouettes, &options, &|_| true).unwrap_err();
    assert!(matches!(refused, SilhouetteError::TooMuchDetail { at_least } if at_least > 9_000), "{refused}");
    assert!(refused.to_string().contains("smooth the strokes, or raise the tolerance"), "{refused}");
}

#[test]
fn errors_say_what_to_do() {
    let start = stack(9, 32, |_| 0.5);
    let strokes = pair(View::FRONT, |_| 0.4, |_| -0.4);
    let error = |sections: &Sections, silhouettes: &[Silhouette<'_>]| {
        deform_to_silhouette(sections, silhouettes, &height(), &|_| true).unwrap_err()
    };
    let front = Silhouette { view: View::FRONT, strokes: &strokes };
    assert_eq!(error(&start, &[]), StrokesError::Views { found: 0 }.into());
    assert_eq!(error(&start, &[front; 3]), StrokesError::Views { found: 3 }.into());
    let twice = error(&start, &[front; 2]);
    assert!(matches!(twice, SilhouetteError::Strokes(StrokesError::NotSquare { degrees, .. }) if degrees == 0.0));
    let aside = Silhouette { view: View::SIDE, ..front };
    assert!(matches!(error(&start, &[aside]), SilhouetteError::Strokes(StrokesError::NoArea { view: "side", .. })));
    let far = strokes.each_ref().map(|c| c.map(|p| p + DVec3::X * 3.0).unwrap());
    let apart = error(&start, &[Silhouette { strokes: &far, ..front }]);
    assert!(matches!(apart, SilhouetteError::Apart { distance, .. } if (distance - 2.1).abs() < 1e-12), "{apart}");
    let top = error(&start, &[Silhouette { view: View::TOP, ..front }]);
    assert_eq!(top, SilhouetteError::OutlineNeeded { view: "top" });
    let sheet = Sections::new(start.iter().map(<[DVec3]>::to_vec).collect(), false, vec![]).unwrap();
    assert_eq!(error(&sheet, &[front]), SilhouetteError::SectionsAreOpen);
    let level = [stroke("level", 2, |t| DVec3::new(0.4, 0.2, t)), strokes[1].clone()];
    let level =
        [level[0].map(|p| DVec3::new(0.3 + 0.1 * p.z, 0.2 + 0.4 * p.z * (1.0 - p.z), 0.0)).unwrap(), level[1].clone()];
    assert!(matches!(error(&start, &[Silhouette { strokes: &level, ..front }]), SilhouetteError::Level { .. }));
    let stopped = deform_to_silhouette(&start, &[front], &height(), &|done| done < 0.5);
    assert_eq!(stopped, Err(SilhouetteError::Cancelled));
    let triangle = stack(4, 3, |_| 0.5);
    assert!(matches!(error(&triangle, &[front]), SilhouetteError::Beam(_)));
}
