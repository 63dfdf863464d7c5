//! Sorting the drawings an artist makes: tubes, heads, patches, and what goes wrong with them.

use super::*;
use crate::curve::{ArcLength, closest};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

fn on_circle(angle: f64, radius: f64, y: f64) -> DVec3 {
    // Counter-clockwise about +Y, from +X: the seam of an upright figure.
    DVec3::new(radius * angle.cos(), y, -radius * angle.sin())
}

fn ring(name: &str, radius: f64, y: f64) -> Curve {
    Curve::new(name, (0..48).map(|i| on_circle(TAU * (f64::from(i) + 0.5) / 48.0, radius, y)).collect(), true).unwrap()
}

/// A rail from height 0 to 1 at the given angles at its ends.
fn rail(name: &str, from: f64, to: f64) -> Curve {
    let points = (0..=20)
        .map(|i| f64::from(i) / 20.0)
        .map(|t| on_circle(from + (to - from) * t, 0.5 + 0.2 * (PI * t).sin(), t))
        .collect();
    Curve::new(name, points, false).unwrap()
}

fn arch(name: &str, along: DVec3, lift: f64) -> Curve {
    let points = (0..=40)
        .map(|i| PI * f64::from(i) / 40.0)
        .map(|a| along * a.cos() + DVec3::Y * (a.sin() * 1.2 + lift))
        .collect();
    Curve::new(name, points, false).unwrap()
}

fn tube() -> Vec<Curve> {
    vec![
        rail("back", FRAC_PI_2, FRAC_PI_2).reversed(),
        ring("hem", 0.5, 0.0).reversed(),
        rail("front", -FRAC_PI_2, -FRAC_PI_2),
        rail("right", PI, PI).reversed(),
        ring("neck", 0.5, 1.0),
        rail("left", 0.0, 0.0),
    ]
}

fn sorted(curves: &[Curve]) -> Sorted {
    sort(curves, &SortOptions::default()).unwrap()
}

fn names(sorted: &Sorted) -> Vec<&str> {
    sorted.rails.iter().map(Curve::name).collect()
}

fn with_order(names: &[&str]) -> SortOptions {
    SortOptions { order: names.iter().map(ToString::to_string).collect(), ..SortOptions::default() }
}

/// The tangent of the section times the direction of the rails points away from the axis at every rail.
fn assert_outwards(sorted: &Sorted, centre: impl Fn(DVec3) -> DVec3) {
    let count = sorted.rails.len();
    for (i, rail) in sorted.rails.iter().enumerate() {
        let middle = |rail: &Curve| ArcLength::of(rail).point_at_fraction(0.5);
        let section = middle(&sorted.rails[(i + 1) % count]) - middle(&sorted.rails[(i + count - 1) % count]);
        let outwards = section.cross(ArcLength::of(rail).tangent_at(0.5 * ArcLength::of(rail).length()));
        assert!(outwards.dot(middle(rail) - centre(middle(rail))) > 0.0, "rail {i}");
    }
}

#[test]
fn tube_is_sorted_with_every_decision_told() {
    let sorted = sorted(&tube());
    assert_eq!(names(&sorted), ["left", "back", "right", "front"]);
    assert_eq!(sorted.apex, None);
    assert_eq!(sorted.warnings, Vec::<String>::new());
    assert!(sorted.rails.iter().all(|rail| rail.start().y == 0.0 && rail.end().y == 1.0));
    for ring in &sorted.closed {
        assert!(ring.area_vector().y > 0.0);
        assert!(ring.start().distance(DVec3::new(ring.start().x, ring.start().y, 0.0)) < 1e-12);
        assert_eq!(ring.points().len(), 49, "the foot of rail 0 is a new point");
    }
    assert_outwards(&sorted, |p| DVec3::Y * p.y);
    let told: Vec<String> = sorted.decisions.iter().map(ToString::to_string).collect();
    assert_eq!(
        told,
        [
            "the axis points from the starts of the rails to their ends: (0.000, 1.000, 0.000)",
            "rail 0 is curve \"left\", at 0 degrees from the seam",
            "rail 1 is curve \"back\", flipped, at 90 degrees from the seam",
            "rail 2 is curve \"right\", flipped, at 180 degrees from the seam",
            "rail 3 is curve \"front\", at 270 degrees from the seam",
            "closed curve \"hem\": reversed to run counter-clockwise, start moved 0.0327 m to rail 0",
            "closed curve \"neck\": runs counter-clockwise, start moved 0.0327 m to rail 0",
        ]
    );
}

/// Lips, lids: a flat ring whose rails rise off the outer curve, and end a little below it at the inner one.
#[test]
fn closed_curves_of_a_swollen_ring_run_as_the_rails_stand() {
    let lip = |k: i32| {
        let angle = TAU * f64::from(k) / 8.0;
        let points = (0..=20).map(|i| f64::from(i) / 20.0);
        let points = points.map(|t| on_circle(angle, 1.0 - 0.4 * t, 0.5 * (PI * t).sin() - 0.1 * t)).collect();
        Curve::new(format!("{k}"), points, false).unwrap()
    };
    let mut curves: Vec<Curve> = [3, 0, 5, 1, 7, 2, 6, 4].map(lip).into();
    curves.extend([ring("mouth", 1.0, 0.0), ring("lip line", 0.6, -0.1).reversed()]);
    let sorted = sorted(&curves);
    assert_eq!(sorted.warnings, Vec::<String>::new());
    // The axis points down, from the outer curve to the inner one.
    assert_eq!(names(&sorted), ["0", "7", "6", "5", "4", "3", "2", "1"]);
    assert!(sorted.closed.iter().all(|ring| ring.area_vector().y < 0.0));
}

#[test]
fn closed_curves_between_the_ends_are_turned_as_the_rails_pass_them() {
    let mut curves = tube();
    curves.insert(2, ring("waist", 0.6, 0.3).reversed());
    curves.insert(4, ring("chest", 0.7, 0.6));
    let sorted = sorted(&curves);
    let closed: Vec<&str> = sorted.closed.iter().map(Curve::name).collect();
    assert_eq!(closed, ["hem", "waist", "chest", "neck"]);
    let left = &sorted.rails[0];
    assert_eq!(left.name(), "left");
    for ring in &sorted.closed {
        assert!(ring.area_vector().y > 0.0, "{}", ring.name());
        // Rail and waist are 6 cm apart.
        assert!(ring.start().z.abs() < 1e-12 && ring.start().x > 0.0, "{}: {}", ring.name(), ring.start());
        assert!(closest(left, ring.start()).distance < 0.06, "{}", ring.name());
    }
    let reversed = sorted.decisions.iter().filter(|d| matches!(d, Decision::Closed { reversed: true, .. })).count();
    assert_eq!(reversed, 2, "hem and waist");
    // The other way along, they come in the opposite order and run about the axis that points down.
    let down = sort(&curves, &SortOptions { reverse_run: true, ..SortOptions::default() }).unwrap();
    let closed: Vec<&str> = down.closed.iter().map(Curve::name).collect();
    assert_eq!(closed, ["neck", "chest", "waist", "hem"]);
    assert!(down.closed.iter().all(|ring| ring.area_vector().y < 0.0));
}

#[test]
fn a_curve_that_rails_pass_on_their_way_back_runs_in_their_order() {
    // Rails from a rim inwards and up over a lip, and down within it: over the lip they rise, though they end below.
    let lip = |angle: f64| {
        let points = [(1.0, 0.0), (0.9, 0.15), (0.8, 0.2), (0.7, 0.1), (0.6, -0.3), (0.6, -0.8)];
        Curve::new("", points.map(|(radius, y)| on_circle(angle, radius, y)).to_vec(), false).unwrap()
    };
    let rings = [ring("rim", 1.0, 0.0), ring("border", 0.9, 0.15), ring("crest", 0.8, 0.2), ring("inside", 0.6, -0.8)];
    for count in [3, 8] {
        let rails = (0..count).map(|k| lip(TAU * f64::from(k) / f64::from(count)));
        for against in [false, true] {
            let turn = |ring: &Curve| if against { ring.clone().reversed() } else { ring.clone() };
            let curves: Vec<Curve> = rails.clone().chain(rings.iter().map(turn)).collect();
            let sorted = sorted(&curves);
            // The rails run down as a whole, so all is counter-clockwise seen from below.
            let sides: Vec<bool> = sorted.closed.iter().map(|ring| ring.area_vector().y < 0.0).collect();
            assert_eq!(sides, [true; 4], "{count} rails");
        }
    }
}

#[test]
fn faces_look_inwards_where_asked() {
    let outwards = sorted(&tube());
    let inwards = sort(&tube(), &SortOptions { inwards: true, ..SortOptions::default() }).unwrap();
    assert_eq!(names(&inwards), ["left", "front", "right", "back"]);
    for (ring, outer) in inwards.closed.iter().zip(&outwards.closed) {
        assert_eq!(ring.start(), outer.start(), "{}", ring.name());
        assert!(ring.area_vector().distance(-outer.area_vector()) < 1e-12, "{}", ring.name());
    }
    assert_eq!(inwards.warnings, Vec::<String>::new());
    let told = inwards.decisions.last().unwrap().to_string();
    assert_eq!(told, "faces look inwards, as asked for: behind rail 0 the rails come in the opposite order");
}

#[test]
fn seam_chooses_rail_0() {
    let seam = SortOptions { seam: DVec3::new(0.1, 7.0, 1.0), ..SortOptions::default() };
    let sorted = sort(&tube(), &seam).unwrap();
    assert_eq!(names(&sorted), ["front", "left", "back", "right"]);
    assert!(sorted.closed.iter().all(|ring| ring.start().x.abs() < 1e-12 && ring.start().z > 0.4));
}

#[test]
fn seam_along_the_axis_is_replaced() {
    let along = SortOptions { seam: DVec3::Y, ..SortOptions::default() };
    let upright = sort(&tube(), &along).unwrap();
    assert_eq!(names(&upright)[0], "front");
    let told = upright.decisions[1].to_string();
    assert_eq!(told, "the seam direction (0.000, 1.000, 0.000) lies along the axis, so (0.000, 0.000, 1.000) was used");
    // A limb along +Z with the seam along it: +X.
    let limb: Vec<Curve> = tube().iter().map(|curve| curve.map(|p| DVec3::new(p.x, -p.z, p.y)).unwrap()).collect();
    let limb = sort(&limb, &SortOptions { seam: DVec3::Z, ..SortOptions::default() }).unwrap();
    assert_eq!(names(&limb), ["left", "back", "right", "front"]);
}

#[test]
fn rails_as_near_to_the_seam_on_both_sides_begin_counter_clockwise() {
    // The clockwise one is nearer by no more than rounding may do.
    let turn = FRAC_PI_4 + 1e-8;
    let curves: Vec<Curve> = (0..4).map(|i| turn + FRAC_PI_2 * f64::from(i)).map(|a| rail("", a, a)).collect();
    for shift in 0..4 {
        let mut curves = curves.clone();
        curves.rotate_left(shift);
        let start = sorted(&curves).rails[0].start();
        assert!(start.distance(on_circle(turn, 0.5, 0.0)) < 1e-12);
    }
}

#[test]
fn reversed_run_starts_at_the_second_closed_curve() {
    let options = SortOptions { reverse_run: true, ..SortOptions::default() };
    let sorted = sort(&tube(), &options).unwrap();
    assert_eq!(names(&sorted), ["left", "front", "right", "back"]);
    assert!(sorted.rails.iter().all(|rail| rail.start().y == 1.0 && rail.end().y == 0.0));
    assert_eq!([sorted.closed[0].name(), sorted.closed[1].name()], ["neck", "hem"]);
    assert!(sorted.closed.iter().all(|ring| ring.area_vector().y < 0.0));
    assert_eq!(sorted.warnings, Vec::<String>::new());
    assert_outwards(&sorted, |p| DVec3::Y * p.y);
}

#[test]
fn head_contours_are_cut_at_the_crown() {
    let curves = [arch("front", DVec3::X, 0.0), arch("side", DVec3::Z, 0.02)];
    let sorted = sorted(&curves);
    let apex = sorted.apex.unwrap();
    assert!(apex.distance(DVec3::Y * 1.21) < 1e-9);
    assert_eq!(names(&sorted), ["front 1", "side 1", "front 2", "side 2"]);
    assert!(sorted.rails.iter().all(|rail| rail.end() == apex));
    assert_eq!(sorted.rails[0].start(), DVec3::X);
    assert!(sorted.rails[1].start().distance(DVec3::new(0.0, 0.02, -1.0)) < 1e-12);
    assert_eq!(sorted.warnings, Vec::<String>::new());
    assert_outwards(&sorted, |p| DVec3::Y * p.y);
    let told = sorted.decisions[0].to_string();
    assert_eq!(
        told,
        "curve \"front\" and curve \"side\" were cut where they meet, at (0.000, 1.210, 0.000), and joined over a gap \
         of 0.0200 m"
    );
    let pinned = sort(&curves, &with_order(&["side 1", "1", "3", "front 1"])).unwrap();
    assert_eq!(names(&pinned), ["side 1", "front 2", "side 2", "front 1"]);
}

#[test]
fn head_contours_from_a_neck_are_cut_too() {
    let neck = ring("neck", 1.0, 0.0).reversed();
    let curves = [arch("front", DVec3::X, 0.0), neck, arch("side", DVec3::Z, 0.0)];
    let sorted = sorted(&curves);
    assert_eq!(sorted.rails.len(), 4);
    assert!(sorted.apex.unwrap().distance(DVec3::Y * 1.2) < 1e-9);
    assert!(sorted.closed[0].start().distance(DVec3::X) < 0.01 && sorted.closed[0].area_vector().y > 0.0);
    assert_eq!(sorted.warnings, Vec::<String>::new());
    let backwards = sort(&curves, &SortOptions { reverse_run: true, ..SortOptions::default() }).unwrap();
    assert!(backwards.rails.iter().all(|rail| rail.start() == backwards.apex.unwrap()));
    assert!(backwards.closed[0].area_vector().y < 0.0);
    assert_eq!(backwards.warnings, Vec::<String>::new());
}

#[test]
fn curves_that_meet_twice_are_cut_in_the_middle_with_a_warning() {
    let wave = |name: &str, side: f64| {
        let points = (0..=60).map(|i| f64::from(i) / 10.0 - 3.0);
        Curve::new(name, points.map(|x| DVec3::new(x, side * (x * x - 1.0) * 0.1, 0.0)).collect(), false).unwrap()
    };
    let sorted = sorted(&[wave("a", 1.0), wave("b", -1.0)]);
    assert_eq!(sorted.rails.len(), 4);
    assert!(sorted.warnings[0].contains("also meet at"), "{:?}", sorted.warnings);
}

#[test]
fn rails_from_one_closed_curve_meet_in_an_apex() {
    let tip = |angle: f64, off: f64| {
        let points = (0..=10).map(|i| f64::from(i) / 10.0);
        let points = points.map(|t| on_circle(angle, 0.5 * (1.0 - t) + off * t, 2.0 * t)).collect();
        Curve::new("", points, false).unwrap()
    };
    let curves = [tip(0.0, 0.01), ring("hem", 0.5, 0.0), tip(2.0, 0.01).reversed(), tip(4.0, 0.01)];
    let pointed = sorted(&curves);
    let apex = pointed.apex.unwrap();
    assert!(apex.distance(DVec3::Y * 2.0) < 0.005);
    assert!(pointed.rails.iter().all(|rail| rail.end() == apex && rail.start().y == 0.0));
    let moved = pointed.decisions.iter().find(|d| matches!(d, Decision::Apex { .. })).unwrap().to_string();
    assert!(moved.contains("their ends were moved there by up to 0.01"), "{moved}");
    // A long thin limb with a narrow end has none: its ends are near to each other for its size, not for its width.
    let long = |curve: Curve| curve.map(|p| p * DVec3::new(1.0, 10.0, 1.0)).unwrap();
    let limb = [tip(0.0, 0.1), ring("hem", 0.5, 0.0), tip(2.0, 0.1), tip(4.0, 0.1)].map(long);
    assert_eq!(sorted(&limb).apex, None);
}

#[test]
fn open_curves_alone_run_to_where_they_meet() {
    let meridian = |angle: f64| {
        let points = (0..=16).map(|i| FRAC_PI_2 * f64::from(i) / 16.0);
        Curve::new(format!("{angle}"), points.map(|a| on_circle(angle, a.cos(), a.sin())).collect(), false).unwrap()
    };
    let curves = [meridian(3.0), meridian(0.1).reversed(), meridian(4.5), meridian(1.5).reversed()];
    let dome = sorted(&curves);
    assert_eq!(names(&dome), ["0.1", "1.5", "3", "4.5"]);
    assert!(dome.apex.unwrap().distance(DVec3::Y) < 1e-12);
    assert!(dome.rails.iter().all(|rail| rail.start().y == 0.0));
    // Two curves that share an end are enough.
    let fin = sorted(&curves[..2]);
    assert!(fin.apex.unwrap().distance(DVec3::Y) < 1e-12);
}

#[test]
fn lemon_runs_as_its_first_curve() {
    let meridian = |angle: f64| {
        let points = (0..=16).map(|i| PI * (f64::from(i) / 16.0 - 0.5));
        let points = points.map(|a| on_circle(angle, a.cos(), a.sin()));
        Curve::new("m", points.collect(), false).unwrap()
    };
    let up = sorted(&[meridian(0.0), meridian(2.0).reversed(), meridian(4.0)]);
    assert!(up.apex.unwrap().distance(DVec3::Y) < 1e-9);
    assert_eq!(up.warnings, Vec::<String>::new());
    let down = sorted(&[meridian(0.0).reversed(), meridian(2.0).reversed(), meridian(4.0)]);
    assert!(down.apex.unwrap().distance(-DVec3::Y) < 1e-9);
    assert!(down.decisions.contains(&Decision::RunAsDrawn { curve: "curve \"m\"".into() }));
}

#[test]
fn open_curves_that_do_not_meet_run_as_the_first() {
    let open: Vec<Curve> = tube().into_iter().filter(|curve| !curve.is_closed()).collect();
    // The first of them was drawn downwards.
    let sorted = sorted(&open);
    assert_eq!(names(&sorted), ["left", "front", "right", "back"]);
    assert!(sorted.rails.iter().all(|rail| rail.start().y == 1.0 && rail.end().y == 0.0));
    assert_outwards(&sorted, |p| DVec3::Y * p.y);
}

#[test]
fn flat_opening_is_sorted_about_its_normal() {
    let spoke =
        |angle: f64| Curve::new("", vec![on_circle(angle, 2.0, 0.0), on_circle(angle, 1.0, 0.0)], false).unwrap();
    let spokes = [spoke(0.2), spoke(1.7), spoke(3.4), spoke(5.0)];
    let mut curves = vec![ring("outer", 2.0, 0.0), ring("inner", 1.0, 0.0).reversed()];
    curves.extend(spokes.clone());
    for turned in [curves.clone(), curves.iter().map(|c| c.clone().reversed()).collect()] {
        let flat = sorted(&turned);
        assert!(flat.decisions.iter().any(|d| matches!(d, Decision::Axis { source: AxisSource::ClosedCurve, .. })));
        let starts: Vec<DVec3> = spokes.iter().map(Curve::start).collect();
        assert_eq!(flat.rails.iter().map(Curve::start).collect::<Vec<_>>(), starts);
        assert!(flat.closed.iter().all(|ring| ring.area_vector().y > 0.0));
        assert_eq!(flat.warnings, Vec::<String>::new());
    }
    // A flat cross without closed curves.
    let line = |along: DVec3| Curve::new("", vec![-along, along * 1.02], false).unwrap();
    let cross = sorted(&[line(DVec3::X), line(DVec3::Y)]);
    assert!(cross.decisions.contains(&Decision::Axis { axis: DVec3::Z, source: AxisSource::Plane }));
    assert_eq!(cross.rails.len(), 4);
}

/// Three quarters of a torus, bent about Z: its closed curves' normals turn away from the line between them. The rails
/// turn around it by `twist` from start to end.
fn bent_limb(twist: f64) -> [Curve; 6] {
    const BEND: f64 = 1.5 * PI;
    let surface = |s: f64, angle: f64| {
        let around = DVec3::new(s.cos(), s.sin(), 0.0);
        around * (2.0 + 0.4 * angle.cos()) + DVec3::Z * (0.4 * angle.sin())
    };
    let loop_at = |name: &str, s: f64| {
        Curve::new(name, (0..40).map(|i| surface(s, TAU * f64::from(i) / 40.0)).collect(), true).unwrap()
    };
    let along = |angle: f64| {
        let points = (0..=50).map(|i| f64::from(i) / 50.0).map(|t| surface(BEND * t, angle + twist * t));
        Curve::new(format!("{angle}"), points.collect(), false).unwrap()
    };
    [loop_at("a", 0.0), loop_at("b", BEND).reversed(), along(0.0), along(1.5).reversed(), along(3.0), along(4.5)]
}

#[test]
fn bent_limb_keeps_its_order_and_its_closed_curves_run_alike() {
    let sorted = sorted(&bent_limb(0.0));
    assert_eq!(sorted.warnings, Vec::<String>::new());
    for (ring, run) in sorted.closed.iter().zip([DVec3::Y, DVec3::X]) {
        assert!(ring.area_vector().dot(run) > 0.0, "closed curves run counter-clockwise about the limb");
    }
    let angles: Vec<f64> = sorted.rails.iter().map(|rail| rail.name().parse().unwrap()).collect();
    let first = angles.iter().position(|a| *a == 0.0).unwrap();
    // Counter-clockwise about the run of the limb is clockwise in `angle`.
    let cyclic: Vec<f64> = (0..4).map(|i| angles[(first + i) % 4]).collect();
    assert_eq!(cyclic, [0.0, 4.5, 3.0, 1.5]);
}

#[test]
fn twist_is_measured_around_a_bent_limb() {
    for seam in [DVec3::X, DVec3::Z, DVec3::new(-1.0, 2.0, 0.5)] {
        let options = SortOptions { seam, ..SortOptions::default() };
        let warnings = sort(&bent_limb(2.0 * PI / 3.0), &options).unwrap().warnings;
        assert_eq!(warnings.len(), 4, "{warnings:?}");
        // The uneven rails tilt the axis a little out of the plane of the bend, and that turns the seam by 3 degrees.
        let turned = |w: &String| w.split(" turns ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
        assert!(warnings.iter().map(turned).all(|degrees| (degrees - 120.0).abs() < 5.0), "{warnings:?}");
    }
}

#[test]
fn many_rails_on_one_side_do_not_shift_the_centre() {
    let crowd = (0..30).map(|i| 1.0 + 0.04 * f64::from(i)).map(|a| rail("crowd", a, a));
    let curves: Vec<Curve> = [0.0, PI, 1.5 * PI].map(|a| rail("alone", a, a)).into_iter().chain(crowd).collect();
    let alone: Vec<f64> = sorted(&curves)
        .decisions
        .iter()
        .filter_map(|decision| match decision {
            Decision::Rail { curve, angle, .. } if curve == "curve \"alone\"" => Some(angle.to_degrees()),
            _ => None,
        })
        .collect();
    let expected = [0.0, 180.0, 270.0];
    assert!(alone.iter().zip(expected).all(|(a, e)| (a - e + 180.0).rem_euclid(360.0) - 180.0 < 8.0), "{alone:?}");
}

#[test]
fn pinned_order_goes_by_name_or_number() {
    let sorted = sort(&tube(), &with_order(&["right", "1", "left", "back"])).unwrap();
    assert_eq!(names(&sorted), ["right", "front", "left", "back"]);
    assert!(sorted.closed.iter().all(|ring| ring.start().x < -0.49), "they start at the pinned rail 0");
    assert_eq!(sorted.warnings, Vec::<String>::new());
    let told = sorted.decisions[1].to_string();
    assert_eq!(told, "rail 0 is curve \"right\", pinned, flipped, at 180 degrees from the seam");
    let crossed = sort(&tube(), &with_order(&["left", "right", "back", "front"])).unwrap();
    assert!(crossed.warnings.iter().any(|w| w.contains("pinned order")), "{:?}", crossed.warnings);
    assert!(crossed.warnings.iter().any(|w| w.contains("\"hem\" the rails start in the order")));
}

#[test]
fn pinned_orders_that_do_not_fit_are_refused() {
    let refused = |order: &[&str]| sort(&tube(), &with_order(order)).unwrap_err().to_string();
    let there = "there are 0 \"back\", 1 \"front\", 2 \"right\" and 3 \"left\"";
    assert_eq!(refused(&["left", "tail"]), format!("pinned order, place 1: there is no rail \"tail\"; {there}"));
    assert!(refused(&["left", "4"]).starts_with("pinned order, place 1: there is no rail \"4\""));
    assert!(refused(&[""]).starts_with("pinned order, place 0: there is no rail \"\""));
    let twice = format!("pinned order, place 2: \"3\" is rail 0 already: name each rail once; {there}");
    assert_eq!(refused(&["left", "back", "3"]), twice);
    let missing = format!("pinned order: 1 \"front\" and 2 \"right\" left out: name every rail once; {there}");
    assert_eq!(refused(&["left", "back"]), missing);
    let mut curves = tube();
    curves[5] = curves[5].clone().renamed("front");
    let error = sort(&curves, &with_order(&["front"])).unwrap_err().to_string();
    assert_eq!(error, "pinned order, place 0: 1 and 3 are all called \"front\": pin them by number, or rename");
}

#[test]
fn twisted_rails_are_warned_of() {
    let mut curves = tube();
    // Two rails swap places on their way up.
    curves[0] = rail("back", FRAC_PI_2, PI);
    curves[3] = rail("right", PI, FRAC_PI_2);
    let crossed = sorted(&curves).warnings;
    assert!(crossed.iter().any(|w| w.contains("around closed curve")), "{crossed:?}");
    // All rails turn by 120 degrees: still in order.
    let turned: Vec<Curve> = (0..4).map(|i| FRAC_PI_2 * f64::from(i)).map(|a| rail("t", a, a + TAU / 3.0)).collect();
    let turned = sorted(&turned).warnings;
    assert_eq!(turned.len(), 4);
    assert!(turned[0].starts_with("rail 0 (curve \"t\") turns 120 degrees around the axis"), "{turned:?}");
    let slightly: Vec<Curve> = (0..4).map(|i| FRAC_PI_2 * f64::from(i)).map(|a| rail("t", a, a + 1.5)).collect();
    assert_eq!(sorted(&slightly).warnings, Vec::<String>::new());
}

#[test]
fn rails_that_stop_short_are_told_with_their_distance() {
    let mut curves = tube();
    curves[5] = rail("left", 0.0, 0.0).map(|p| p * DVec3::new(1.0, 0.9, 1.0)).unwrap();
    let warnings = sorted(&curves).warnings;
    assert_eq!(
        warnings,
        ["rail 0 (curve \"left\") ends 0.100 m away from closed curve \"neck\": draw it up to the closed curve"]
    );
}

#[test]
fn rails_in_one_place_are_told() {
    let mut curves = tube();
    curves.push(rail("again", 0.0002, 0.0));
    let warnings = sorted(&curves).warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("which is one place"), "{warnings:?}");
}

#[test]
fn curves_that_cannot_be_rails_are_refused() {
    let refused = |curves: &[Curve]| sort(curves, &SortOptions::default()).unwrap_err();
    assert_eq!(refused(&[]), SortError::NoCurves);
    assert_eq!(refused(&[ring("a", 1.0, 0.0), rail("r", 0.0, 0.0)]), SortError::TooFewRails { found: 1 });
    assert_eq!(refused(&[ring("a", 1.0, 0.0)]), SortError::TooFewRails { found: 0 });
    let error = refused(&[rail("a", 0.0, 0.0), rail("b", PI, PI)]).to_string();
    assert!(error.starts_with("curve \"a\" and curve \"b\" stay 1.00 m apart (up to 0.03"), "{error}");
    let line = |from: DVec3, to: DVec3| Curve::new("l", vec![from, to], false).unwrap();
    for leg in [DVec3::Y, DVec3::new(1.0, 0.2, 0.0)] {
        let tee = [line(DVec3::X, -DVec3::X), line(DVec3::ZERO, leg)];
        assert!(matches!(refused(&tee), SortError::MeetNearEnd { .. }), "leg {leg}");
    }
    let seam = SortOptions { seam: DVec3::ZERO, ..SortOptions::default() };
    assert_eq!(sort(&tube(), &seam), Err(SortError::Seam { seam: DVec3::ZERO }));
    let seam = SortOptions { seam: DVec3::NAN, ..SortOptions::default() };
    assert!(matches!(sort(&tube(), &seam), Err(SortError::Seam { .. })));
    for size in [1e70, 1e-70] {
        let curves: Vec<Curve> = tube().iter().map(|curve| curve.map(|p| p * size).unwrap()).collect();
        assert!(matches!(refused(&curves), SortError::Size { .. }));
    }
    // Two strokes from the middle of a line outwards, one each way.
    let line = [line(DVec3::ZERO, DVec3::X), line(DVec3::ZERO, -DVec3::X)];
    assert_eq!(refused(&line), SortError::NoAxis);
}

#[test]
fn rail_that_lies_at_the_apex_is_refused() {
    let tip = |up: f64| DVec3::Y * (2.0 + up / 256.0);
    let side = |angle: f64, up: f64| Curve::new("", vec![on_circle(angle, 0.5, 0.0), tip(up)], false).unwrap();
    // The mean of the ends is where the last one starts.
    let speck = Curve::new("speck", vec![tip(2.0), tip(4.0)], false).unwrap();
    let curves = [side(0.0, 4.0), side(2.0, 0.0), side(4.0, 0.0), speck];
    let error = SortError::RailVanishes { curve: "curve \"speck\"".into() };
    assert_eq!(sort(&curves, &SortOptions::default()), Err(error));
}

#[test]
fn pressure_and_names_go_with_their_curves() {
    let mut curves = tube();
    let points = curves[5].points().to_vec();
    let pressure: Vec<f64> = (0..points.len()).map(|i| i as f64).collect();
    curves[5] = Curve::with_pressure("left", points, false, Some(pressure.clone())).unwrap().reversed();
    let sorted = sorted(&curves);
    assert_eq!(sorted.rails[0].pressure(), Some(&pressure[..]));
    assert!(closest(&sorted.closed[0], sorted.rails[0].start()).distance < 1e-2);
}
