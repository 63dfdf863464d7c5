//! Sections along a bone: which loop is kept, how it is laid, and what is said where something is wrong.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a failing unwrap is a failing test")]

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3, EulerRot};
use maquette_geometry::curve::{ArcLength, Curve};
use maquette_geometry::mesh::slice::{
    AlongOptions, Concern, Hit, Method, Others, Plane, Positions, SectionOptions, SliceError, Sliced, along,
    along_while, through,
};
use maquette_geometry::mesh::{Mesh, join};
use proptest::prelude::*;

/// Rings of points, each counter-clockwise about the direction in which they follow one another, with lids on the ends.
fn stacked(rings: &[Vec<DVec3>]) -> Mesh {
    let sides = rings[0].len() as u32;
    let at = |ring: usize, k: u32| ring as u32 * sides + k % sides;
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    for ring in 0..rings.len() - 1 {
        let quads = (0..sides).map(|k| vec![at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)]);
        polygons.extend(quads);
    }
    polygons.push((0..sides).rev().map(|k| at(0, k)).collect());
    polygons.push((0..sides).map(|k| at(rings.len() - 1, k)).collect());
    Mesh::new(rings.concat(), polygons).unwrap()
}

fn ring(centre: DVec3, x: DVec3, y: DVec3, sides: u32) -> Vec<DVec3> {
    let angles = (0..sides).map(|k| f64::from(k) / f64::from(sides) * TAU);
    angles.map(|a| centre + x * a.cos() + y * a.sin()).collect()
}

/// An upright tube of elliptic rings from y = 0 to 1, half axes 0.2 (x) and 0.3 (z).
fn tube(sides: u32, rows: u32) -> Mesh {
    let heights = (0..=rows).map(|row| f64::from(row) / f64::from(rows));
    let rings: Vec<_> = heights.map(|y| ring(DVec3::Y * y, DVec3::Z * 0.3, DVec3::X * 0.2, sides)).collect();
    stacked(&rings)
}

fn sphere() -> Mesh {
    let rows = (1..60).map(|row| f64::from(row) / 60.0 * PI);
    let ring = |a: f64| ring(DVec3::Y * -a.cos(), DVec3::Z * a.sin(), DVec3::X * a.sin(), 120);
    stacked(&rows.map(ring).collect::<Vec<_>>())
}

/// A ring about y of radius 1, 0.25 thick.
fn torus() -> Mesh {
    let (around, across) = (96, 48);
    let at = |i: u32, k: u32| (i % around) * across + k % across;
    let points = (0..around).flat_map(|i| {
        let out = DQuat::from_rotation_y(TAU * f64::from(i) / f64::from(around)) * DVec3::X;
        ring(out, out * 0.25, DVec3::Y * 0.25, across)
    });
    let quads =
        (0..around).flat_map(|i| (0..across).map(move |k| [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)]));
    Mesh::new(points.collect(), quads).unwrap()
}

fn bone(points: &[DVec3]) -> Curve {
    Curve::new("bone", points.to_vec(), false).unwrap()
}

fn upright() -> Curve {
    bone(&[DVec3::Y * 0.1, DVec3::Y * 0.9])
}

fn options(count: usize, points: usize) -> AlongOptions {
    AlongOptions {
        positions: Positions::count(count),
        section: SectionOptions { points, ..SectionOptions::default() },
        ..AlongOptions::default()
    }
}

fn by_rays(count: usize, points: usize, hit: Hit) -> AlongOptions {
    let mut options = options(count, points);
    options.section.method = Method::Rays(hit);
    options
}

/// Sections without a warning.
fn quiet(mesh: &Mesh, bone: &Curve, options: &AlongOptions) -> Sliced {
    let sliced = along(mesh, bone, options).unwrap();
    assert_eq!(sliced.warnings, []);
    sliced
}

#[test]
fn a_sphere_gives_circles() {
    let sliced = quiet(&sphere(), &bone(&[DVec3::NEG_Y * 0.8, DVec3::Y * 0.8]), &options(9, 64));
    assert_eq!(sliced.sections.len(), 9);
    for (k, section) in sliced.sections.iter().enumerate() {
        let radius = (1.0 - (k as f64 * 0.2 - 0.8).powi(2)).sqrt();
        assert_eq!((section.index, section.curve.points().len()), (k, 64));
        assert!(section.curve.is_closed() && section.curve.area_vector().y > 0.0);
        assert!((section.perimeter - TAU * radius).abs() < 0.005 && (section.area - PI * radius * radius).abs() < 0.01);
        assert!(section.offset < 1e-9);
        assert!(section.curve.start().distance(DVec3::new(0.0, k as f64 * 0.2 - 0.8, radius)) < 2e-3);
        assert_eq!(section.others, Some(Others::default()));
    }
}

#[test]
fn of_a_torus_the_loop_around_the_bone_is_kept() {
    let inside = bone(&[DVec3::new(1.0, 0.0, -0.2), DVec3::new(1.0, 0.0, 0.2)]);
    for section in quiet(&torus(), &inside, &options(5, 48)).sections {
        assert_eq!(section.others, Some(Others { around: 0, beside: 1, open: 0 }));
        assert!(section.curve.points().iter().all(|p| (0.7..1.3).contains(&p.x)));
    }
    // Along the axis: two loops around the bone, of which the outer one is kept.
    let axis = bone(&[DVec3::NEG_Y * 0.2, DVec3::Y * 0.2]);
    for section in quiet(&torus(), &axis, &options(5, 48)).sections {
        assert_eq!(section.others, Some(Others { around: 1, beside: 0, open: 0 }));
        assert!(section.curve.points().iter().all(|p| p.length() > 0.99));
    }
}

#[test]
fn points_are_even_and_begin_at_the_front_of_the_centroid() {
    // The bone stands aside of the middle, and the model is drawn from the left.
    let aside = bone(&[DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.1, 0.9, 0.0)]);
    let mut options = options(4, 200);
    for (front, start) in [(DVec3::Z, DVec3::Z * 0.3), (DVec3::X * 7.0, DVec3::X * 0.2)] {
        options.section.front = front;
        for section in quiet(&tube(100, 7), &aside, &options).sections {
            let level = DVec3::Y * section.plane.origin().y;
            assert!(section.curve.start().distance(start + level) < 1e-9);
            assert!((section.offset - 0.1).abs() < 1e-9);
            let arc = ArcLength::of(&section.curve);
            let steps = arc.cumulative().windows(2).map(|pair| pair[1] - pair[0]);
            let (shortest, longest) = steps.fold((f64::MAX, 0.0), |(s, l): (f64, f64), d| (s.min(d), l.max(d)));
            assert!(longest / shortest < 1.01, "{shortest} to {longest}");
        }
    }
}

/// A tube of radius 0.2 bent by a right angle, about a bone with one joint.
fn elbow() -> (Mesh, Curve) {
    let mut rings = Vec::new();
    for k in 0..=80 {
        // Straight, a quarter of a circle of radius 0.25 about (0.25, 0.75), straight.
        let s = f64::from(k) / 40.0;
        let bend = (s - 0.75) / 0.25;
        let (centre, along) = if bend < 0.0 {
            (DVec3::Y * s, DVec3::Y)
        } else if bend < PI / 2.0 {
            (
                DVec3::new(0.25 - 0.25 * bend.cos(), 0.75 + 0.25 * bend.sin(), 0.0),
                DVec3::new(bend.sin(), bend.cos(), 0.0),
            )
        } else {
            (DVec3::new(0.25 + 0.25 * (bend - PI / 2.0), 1.0, 0.0), DVec3::X)
        };
        let side = DVec3::Z;
        rings.push(ring(centre, side * 0.2, along.cross(side) * 0.2, 48));
    }
    (stacked(&rings), bone(&[DVec3::Y * 0.1, DVec3::Y, DVec3::new(0.9, 1.0, 0.0)]))
}

#[test]
fn planes_that_turn_too_fast_cross_and_are_warned_of() {
    let (mesh, bone) = elbow();
    let sharp = AlongOptions { turning: 0.25, ..options(24, 64) };
    let sliced = along(&mesh, &bone, &sharp).unwrap();
    let [warning] = sliced.warnings[..] else { panic!("{:?}", sliced.warnings) };
    assert_eq!((warning.first, warning.last, warning.what), (9, 14, Concern::Cross));
    let at = warning.at;
    // On the inside of the bend, below and to the right of the joint.
    assert!(at.x > 0.05 && at.y < 0.95 && at.distance(DVec3::Y) < 0.4, "{at}");
    let message = warning.to_string();
    assert!(message.starts_with("sections 9 to 14: they cross each other inside the body, near (0."), "{message}");
    assert!(message.contains("let the planes turn over a longer part of the bone"), "{message}");
    // What it advises helps, as soon as the documented bound is kept: the inside of the bend is 0.304 from the joint.
    let enough = 2.0 * 2.0_f64.sqrt() * 0.304 / 1.8;
    quiet(&mesh, &bone, &AlongOptions { turning: enough, ..options(24, 64) });
    quiet(&mesh, &bone, &AlongOptions { turning: 0.6, ..options(24, 64) });
}

#[test]
fn a_reversed_bone_gives_the_same_loops_the_other_way() {
    let (mesh, bone) = elbow();
    let options = AlongOptions { turning: 0.6, ..options(9, 64) };
    let (forth, back) = (quiet(&mesh, &bone, &options), quiet(&mesh, &bone.clone().reversed(), &options));
    for (a, b) in forth.sections.iter().zip(back.sections.iter().rev()) {
        let turned = b.curve.clone().reversed();
        for (p, q) in a.curve.points().iter().zip(turned.points()) {
            assert!(p.distance(*q) < 1e-9, "section {}: {p} and {q}", a.index);
        }
    }
}

#[test]
fn sections_that_miss_are_left_out_and_named() {
    let long = bone(&[DVec3::Y * -0.45, DVec3::Y * 1.45]);
    let sliced = along(&tube(24, 4), &long, &options(20, 32)).unwrap();
    assert_eq!(sliced.sections.iter().map(|s| s.index).collect::<Vec<_>>(), (5..15).collect::<Vec<_>>());
    assert_eq!(
        sliced.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        [
            "sections 0 to 4: the plane at (0.000, -0.450, 0.000) misses the mesh, and there is no section in it: keep the \
             sections to the part of the bone that is in the mesh",
            "sections 15 to 19: the plane at (0.000, 1.050, 0.000) misses the mesh, and there is no section in it: keep the \
             sections to the part of the bone that is in the mesh"
        ]
    );
    let above = bone(&[DVec3::Y * 2.0, DVec3::Y * 3.0]);
    for options in [options(3, 32), by_rays(3, 32, Hit::First)] {
        assert_eq!(along(&tube(24, 4), &above, &options), Err(SliceError::NothingCut { planes: 3 }));
    }
}

#[test]
fn a_bone_outside_takes_the_nearest_loop_and_says_so() {
    let moved = |by: f64| tube(48, 4).positions().iter().map(|p| *p + DVec3::X * by).collect();
    let polygons = || tube(48, 4).polygons().map(<[u32]>::to_vec).collect::<Vec<_>>();
    let legs = [0.0, 1.0, 2.0].map(|by| Mesh::new(moved(by), polygons()).unwrap());
    let mesh = join(&legs).unwrap();
    let outside = bone(&[DVec3::new(0.6, 0.1, 0.0), DVec3::new(0.6, 0.9, 0.0)]);
    let sliced = along(&mesh, &outside, &options(2, 32)).unwrap();
    assert!(sliced.sections.iter().all(|section| section.curve.points().iter().all(|p| (0.7..1.3).contains(&p.x))));
    assert_eq!(sliced.sections[0].others, Some(Others { around: 0, beside: 2, open: 0 }));
    assert_eq!(
        sliced.warnings[0].to_string(),
        "sections 0 to 1: the bone's point (0.600, 0.100, 0.000) is in no loop, and the nearest one, 0.200 m away, was taken: \
         move the bone into the body"
    );
    // Rays to all sides do not find a body that is on one side.
    let error = along(&mesh, &outside, &by_rays(2, 32, Hit::First)).unwrap_err();
    let SliceError::RaysMissed { section: 0, rays: 32, missed, .. } = &error else { panic!("{error}") };
    assert!(missed.contains(&0) && missed.contains(&16) && !missed.contains(&8) && !missed.contains(&24));
}

#[test]
fn a_bone_far_from_the_middle_is_warned_of() {
    let aside = bone(&[DVec3::new(0.18, 0.1, 0.0), DVec3::new(0.18, 0.9, 0.0)]);
    for options in [options(2, 32), by_rays(2, 32, Hit::First)] {
        let sliced = along(&tube(48, 4), &aside, &options).unwrap();
        assert_eq!(sliced.warnings.len(), 1);
        let message = sliced.warnings[0].to_string();
        assert!(message.starts_with("sections 0 to 1: the middle is 0.18"), "{message}");
    }
}

/// The tube without the quads in front between y = 0.5 and 0.75.
fn with_hole() -> Mesh {
    let whole = tube(24, 4);
    let keep = |k: &usize| !(2 * 24..2 * 24 + 3).contains(k);
    let polygons: Vec<Vec<u32>> = (0..whole.polygon_count()).filter(keep).map(|k| whole.polygon(k).to_vec()).collect();
    Mesh::new(whole.positions().to_vec(), polygons).unwrap()
}

#[test]
fn a_hole_is_an_error_that_says_where() {
    let mesh = with_hole();
    let at = |fractions: &[f64], method: Method| {
        let mut options = options(1, 48);
        options.positions = Positions::At(fractions.to_vec());
        options.section.method = method;
        along(&mesh, &bone(&[DVec3::ZERO, DVec3::Y]), &options)
    };
    assert!(at(&[0.2, 0.4, 0.8], Method::Loop).unwrap().warnings.is_empty());
    let error = at(&[0.2, 0.4, 0.6, 0.8], Method::Loop).unwrap_err();
    assert!(matches!(error, SliceError::NotClosed { section: 2, .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "section 2: the outline around (0.000, 0.600, 0.000) does not close, for the mesh is open there: it ends at \
         (0.000, 0.600, 0.300) and at (0.141, 0.600, 0.212), 0.166 m apart; close the hole, move the section, or use rays"
    );
    let error = at(&[0.6], Method::Rays(Hit::First)).unwrap_err();
    assert!(matches!(error, SliceError::RaysMissed { section: 0, .. }), "{error}");
    assert!(error.to_string().contains("rays from (0.000, 0.600, 0.000) hit nothing, the first one "), "{error}");
}

#[test]
fn of_several_shells_the_outer_one_is_kept_unless_it_is_open() {
    let scaled = |mesh: &Mesh, by: f64| {
        let points = mesh.positions().iter().map(|p| DVec3::new(p.x * by, p.y, p.z * by)).collect();
        Mesh::new(points, mesh.polygons().map(<[u32]>::to_vec)).unwrap()
    };
    let clothed = join(&[scaled(&tube(24, 4), 0.5), tube(24, 4)]).unwrap();
    for section in quiet(&clothed, &upright(), &options(6, 48)).sections {
        assert_eq!(section.others, Some(Others { around: 1, beside: 0, open: 0 }));
        assert!((section.curve.start().z - 0.3).abs() < 1e-9);
    }
    let torn = join(&[scaled(&tube(24, 4), 0.5), with_hole()]).unwrap();
    let sliced = along(&torn, &upright(), &options(5, 48)).unwrap();
    let kept: Vec<i64> = sliced.sections.iter().map(|s| (s.curve.start().z * 100.0).round() as i64).collect();
    // The plane at 0.5 runs along the lower rim of the hole, and so counts as below it.
    assert_eq!(kept, [30, 30, 30, 15, 30]);
    let warned: Vec<String> = sliced.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warned.len(), 1);
    assert!(warned[0].starts_with("section 3: a wider outline around (0.000, 0.700, 0.000) does not close"));
    // Rays tell the shells apart by which hit is wanted.
    for (hit, z) in [(Hit::First, 0.15), (Hit::Last, 0.3)] {
        for section in quiet(&clothed, &upright(), &by_rays(6, 48, hit)).sections {
            assert!((section.curve.start().z - z).abs() < 1e-9 && section.others.is_none());
        }
    }
}

#[test]
fn rays_agree_with_loops_and_go_round_by_equal_angles() {
    let mesh = tube(96, 9);
    let loops = quiet(&mesh, &upright(), &options(6, 96));
    let rays = quiet(&mesh, &upright(), &by_rays(6, 96, Hit::First));
    for (a, b) in loops.sections.iter().zip(&rays.sections) {
        assert!((a.perimeter - b.perimeter).abs() < 1e-3 && (a.area - b.area).abs() < 1e-3);
        assert!(a.curve.start().distance(b.curve.start()) < 1e-9);
        for (k, p) in b.curve.points().iter().enumerate() {
            let arm = *p - b.plane.origin();
            let angle = (k as f64 / 96.0 * TAU - arm.x.atan2(arm.z)).rem_euclid(TAU);
            assert!(arm.y.abs() < 1e-12 && angle.min(TAU - angle) < 1e-9, "ray {k}");
        }
    }
    // The bone on the surface: half of the rays hit where they begin.
    let skin = bone(&[DVec3::new(0.0, 0.1, 0.3), DVec3::new(0.0, 0.9, 0.3)]);
    assert!(along(&mesh, &skin, &by_rays(2, 16, Hit::First)).is_err());
}

#[test]
fn planes_that_are_given_are_taken_as_they_are() {
    let planes: Vec<Plane> =
        [0.2, 0.5, 0.8].map(|y| Plane::new(DVec3::Y * y, DVec3::new(0.2 * y, 1.0, 0.1)).unwrap()).to_vec();
    let sliced = through(&tube(48, 4), &planes, &SectionOptions::default()).unwrap();
    for (section, plane) in sliced.sections.iter().zip(&planes) {
        assert_eq!(&section.plane, plane);
        assert!(section.curve.points().iter().all(|p| plane.height(*p).abs() < 1e-12));
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let refusal = |change: &dyn Fn(&mut AlongOptions)| {
        let mut options = options(3, 32);
        change(&mut options);
        along(&tube(8, 2), &upright(), &options).unwrap_err().to_string()
    };
    assert_eq!(refusal(&|o| o.positions = Positions::count(0)), "0 sections asked for: ask for 1 to 4096");
    assert!(refusal(&|o| o.positions = Positions::At(vec![])).starts_with("0 sections"));
    assert!(
        refusal(&|o| o.positions = Positions::At(vec![0.1, 0.5, 0.5])).starts_with("section 2, at 0.5 of the bone")
    );
    assert!(refusal(&|o| o.positions = Positions::At(vec![f64::NAN])).contains("numbers from -10 to 11"));
    let backwards = Positions::Count { count: 1, extent: [1.0, 0.0] };
    assert_eq!(
        refusal(&|o| o.positions = backwards.clone()),
        "sections from 1 to 0 of the bone run backwards: give the smaller share first"
    );
    assert!(refusal(&|o| o.turning = -0.1).starts_with("a turning of -0.1"));
    assert!(refusal(&|o| o.section.points = 2).starts_with("2 points a section"));
    assert!(refusal(&|o| o.section.front = DVec3::ZERO).contains("is no direction"));
    let closed = Curve::new("ring", vec![DVec3::ZERO, DVec3::X, DVec3::Y], true).unwrap();
    let error = along(&tube(8, 2), &closed, &options(3, 32)).unwrap_err();
    assert_eq!(error.to_string(), "the bone \"ring\" is a closed curve: draw it open, from one joint to the next");
    assert_eq!(along(&Mesh::default(), &upright(), &options(3, 32)), Err(SliceError::NoPolygons));
    let none = through(&tube(8, 2), &[], &SectionOptions::default());
    assert_eq!(none, Err(SliceError::SectionCount { found: 0 }));
}

#[test]
fn it_tells_how_far_it_is_and_stops_when_told_to() {
    let told = std::cell::RefCell::new(Vec::new());
    let tell = |share: f64| {
        told.borrow_mut().push(share);
        told.borrow().len() < 6
    };
    // Four sections, and one look at crossings for each.
    let stopped = along_while(&tube(8, 2), &upright(), &options(4, 16), &tell);
    assert_eq!(stopped, Err(SliceError::Stopped));
    assert_eq!(*told.borrow(), [0.0, 0.25, 0.5, 0.75, 1.0, 1.0]);
    let stopped = along_while(&tube(8, 2), &upright(), &by_rays(4, 16, Hit::First), &|share| share < 0.5);
    assert_eq!(stopped, Err(SliceError::Stopped));
}

#[test]
fn huge_and_tiny_bones_do_not_panic() {
    for size in [1e-310, 1e-200, 1e200, 1e308] {
        let bone = bone(&[DVec3::ZERO, DVec3::Y * size]);
        let mesh =
            Mesh::new(tube(8, 2).positions().iter().map(|p| *p * size).collect(), tube(8, 2).polygons()).unwrap();
        for method in [Method::Loop, Method::Rays(Hit::Last)] {
            let mut options = options(3, 8);
            options.section.method = method;
            if let Ok(sliced) = along(&mesh, &bone, &options) {
                assert!(sliced.sections.iter().flat_map(|s| s.curve.points()).all(|p| p.is_finite()));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Sections do not depend on where the model stands, how it is turned and how large it is.
    #[test]
    fn sections_move_with_the_model(
        turn in [-PI..PI, -PI..PI, -PI..PI],
        shift in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0],
        scale in 0.01..100.0_f64,
        rays in any::<bool>(),
    ) {
        let turn = DQuat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]);
        let place = |p: DVec3| turn * p * scale + DVec3::from(shift);
        let (mesh, bone) = elbow();
        let moved = Mesh::new(mesh.positions().iter().map(|p| place(*p)).collect(), mesh.polygons()).unwrap();
        // The hint is well off all normals, so that none of the directions that may replace it is used.
        let mut options = AlongOptions { turning: 0.6, ..if rays { by_rays(7, 40, Hit::First) } else { options(7, 40) } };
        options.section.front = DVec3::new(0.2, -0.1, 1.0);
        let here = quiet(&mesh, &bone, &options);
        options.section.front = turn * options.section.front * 3.0;
        let there = quiet(&moved, &bone.map(place).unwrap(), &options);
        prop_assert_eq!(here.sections.len(), there.sections.len());
        for (a, b) in here.sections.iter().zip(&there.sections) {
            prop_assert!((b.perimeter - a.perimeter * scale).abs() < 1e-9 * scale.max(1.0));
            prop_assert_eq!(a.others, b.others);
            for (p, q) in a.curve.points().iter().zip(b.curve.points()) {
                prop_assert!(place(*p).distance(*q) < 1e-8 * scale.max(1.0), "{} {}", place(*p), q);
            }
        }
    }
}
