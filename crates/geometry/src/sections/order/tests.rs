use super::*;
use glam::DQuat;
use std::f64::consts::{PI, TAU};

/// A ring about a direction, begun at some angle.
fn ring(name: &str, centre: DVec3, normal: DVec3, radius: f64, begun: f64) -> Curve {
    let turn = DQuat::from_rotation_arc(DVec3::Y, normal);
    // Not quite round, so that its start is to be found again.
    let at = |k: u32| {
        let angle = begun + TAU * f64::from(k) / 40.0;
        turn * DVec3::new(angle.sin(), 0.0, 1.3 * angle.cos()) * radius + centre
    };
    Curve::new(name, (0..40).map(at).collect(), true).unwrap()
}

/// Rings along a limb bent into a U, whose branches are nearer to each other than the rings of a branch.
fn bent(count: u32) -> Vec<Curve> {
    let straight = |k: u32| {
        let t = f64::from(k) / f64::from(count - 1);
        let (angle, up) = match t {
            t if t < 0.4 => (0.0, t - 0.4),
            t if t > 0.6 => (PI, 0.6 - t),
            t => ((t - 0.4) / 0.2 * PI, 0.0),
        };
        let centre = DVec3::new(-0.12 * angle.cos(), 3.0 * up + 0.12 * angle.sin(), 0.0);
        let normal = DVec3::new(angle.sin(), angle.cos(), 0.0);
        ring(&format!("{k}"), centre, normal, 0.1, f64::from(7 * k))
    };
    (0..count).map(straight).collect()
}

/// Mixed, and every other one run the other way.
fn mixed(curves: &[Curve]) -> Vec<Curve> {
    let count = curves.len();
    let at = |k: usize| (21 * k + 5) % count;
    let mixed: Vec<usize> = (0..count).map(at).collect();
    let mut seen = mixed.clone();
    seen.sort_unstable();
    assert_eq!(seen, (0..count).collect::<Vec<_>>(), "a permutation");
    let turned = |(k, at): (usize, usize)| if k % 2 == 0 { curves[at].clone() } else { curves[at].clone().reversed() };
    mixed.into_iter().enumerate().map(turned).collect()
}

fn names(ordered: &OrderedSections) -> Vec<&str> {
    ordered.sections.iter().map(Curve::name).collect()
}

#[test]
fn a_bent_limb_is_followed_around_its_bend() {
    for count in [11_u32, 25, 31, 61] {
        let limb = bent(count);
        let ordered = order(&mixed(&limb), &OrderOptions::default()).unwrap();
        let mut expected: Vec<String> = (0..count).map(|k| k.to_string()).collect();
        if names(&ordered)[0] != "0" {
            expected.reverse();
        }
        assert_eq!(names(&ordered), expected);
        assert_eq!(ordered.warnings, []);
    }
}

#[test]
fn all_run_about_the_way_and_begin_at_the_carried_front() {
    let limb = bent(31);
    let options = OrderOptions { towards: DVec3::X, ..OrderOptions::default() };
    let ordered = order(&mixed(&limb), &options).unwrap();
    assert_eq!(names(&ordered)[0], "0", "it ends farther to +X");
    for (curve, drawn) in ordered.sections.iter().zip(&limb) {
        assert!(curve.area_vector().dot(drawn.area_vector()) > 0.0, "{}", curve.name());
        let centre = Station::of(drawn).centre;
        let arm = (curve.start() - centre).normalize();
        assert!(arm.distance(DVec3::Z) < 1e-3, "{}: {arm}", curve.name());
    }
    let reversed = ordered.placed.iter().filter(|placed| placed.reversed).count();
    assert_eq!(reversed, 15, "every other one was run the other way");
    let back = order(&mixed(&limb), &OrderOptions { towards: DVec3::NEG_X, ..options }).unwrap();
    assert_eq!(names(&back)[0], "30");
    assert!(back.sections[0].area_vector().dot(limb[30].area_vector()) < 0.0);
}

#[test]
fn the_order_in_which_they_come_does_not_matter() {
    let limb = bent(25);
    let one = order(&limb, &OrderOptions::default()).unwrap();
    let other = order(&mixed(&limb), &OrderOptions::default()).unwrap();
    assert_eq!(names(&one), names(&other));
    for (a, b) in one.sections.iter().zip(&other.sections) {
        assert!(a.start().distance(b.start()) < 1e-12 && a.points().len().abs_diff(b.points().len()) <= 1);
    }
}

#[test]
fn what_repeats_another_is_dropped_and_told() {
    let mut limb = bent(11);
    limb.push(ring("again", Station::of(&limb[3]).centre, Station::of(&limb[3]).normal, 0.101, 0.4));
    let ordered = order(&limb, &OrderOptions::default()).unwrap();
    assert_eq!(ordered.sections.len(), 12, "1 mm is more than 0.1 % of the size");
    let ordered = order(&limb, &OrderOptions { double: 0.01, ..OrderOptions::default() }).unwrap();
    assert_eq!(ordered.sections.len(), 11);
    let message = ordered.warnings[0].to_string();
    assert!(message.starts_with("curve 11 (\"again\") repeats curve 3 (\"3\") at ("), "{message}");
    assert!(message.ends_with("and was dropped: delete one of them"), "{message}");
}

#[test]
fn rings_in_one_plane_go_from_the_widest_to_the_narrowest() {
    let radii = [0.3, 0.1, 0.5, 0.2, 0.4];
    let rings: Vec<Curve> = radii.iter().map(|r| ring(&format!("{r}"), DVec3::ZERO, DVec3::NEG_Y, *r, 1.0)).collect();
    let ordered = order(&rings, &OrderOptions::default()).unwrap();
    let mut found = names(&ordered);
    if found[0] != "0.1" {
        found.reverse();
    }
    assert_eq!(found, ["0.1", "0.2", "0.3", "0.4", "0.5"]);
    assert!(ordered.sections.iter().all(|curve| curve.area_vector().y > 0.0), "about the direction asked for");
}

#[test]
fn an_axis_orders_what_nothing_else_could() {
    // Two rings of a hat's brim, drawn lower than the ring within.
    let rings = [("brim", -0.02, 0.3), ("crown", 0.3, 0.1), ("band", 0.0, 0.12), ("top", 0.32, 0.02)];
    let curves: Vec<Curve> = rings.iter().map(|(name, y, r)| ring(name, DVec3::Y * *y, DVec3::Y, *r, 0.0)).collect();
    let axis = Curve::new("axis", vec![DVec3::Y * 0.2, DVec3::ZERO], false).unwrap();
    let ordered = order(&curves, &OrderOptions { axis: Some(axis), ..OrderOptions::default() }).unwrap();
    assert_eq!(names(&ordered), ["top", "crown", "band", "brim"], "also beyond its ends");
    assert!(ordered.sections.iter().all(|curve| curve.area_vector().y < 0.0));
}

#[test]
fn starts_are_kept_or_follow_the_one_before() {
    let limb: Vec<Curve> =
        (0..6).map(|k| ring("", DVec3::Y * (0.1 * f64::from(k)), DVec3::Y, 0.1, f64::from(k))).collect();
    let kept = order(&limb, &OrderOptions { start: SectionStart::Kept, ..OrderOptions::default() }).unwrap();
    assert_eq!(kept.sections, limb);
    let options = OrderOptions { start: SectionStart::Nearest, front: DVec3::X, ..OrderOptions::default() };
    for curve in order(&limb, &options).unwrap().sections {
        assert!(curve.start().with_y(0.0).distance(DVec3::X * 0.1) < 2e-3, "{}", curve.start());
    }
}

#[test]
fn a_gap_is_told() {
    let height = |k: u32| if k < 5 { 0.05 * f64::from(k) } else { 1.0 + 0.05 * f64::from(k) };
    let limb: Vec<Curve> = (0..10).map(|k| ring("", DVec3::Y * height(k), DVec3::Y, 0.1, 0.0)).collect();
    let ordered = order(&limb, &OrderOptions::default()).unwrap();
    let message = ordered.warnings[0].to_string();
    assert!(message.starts_with("from section 4 to section 5 of the order it is 1.05 m"), "{message}");
    assert_eq!(ordered.warnings.len(), 1);
}

#[test]
fn what_can_not_be_ordered_is_refused() {
    let refusal = |curves: &[Curve], options: &OrderOptions| order(curves, options).unwrap_err().to_string();
    let defaults = OrderOptions::default();
    assert_eq!(refusal(&[], &defaults), "0 curves arrive: give 1 to 2048 sections");
    let open = Curve::new("stroke", vec![DVec3::ZERO, DVec3::X], false).unwrap();
    assert!(refusal(&[open], &defaults).starts_with("curve 0 (\"stroke\") is open, and a section is closed"));
    let rings = bent(11);
    let flat = OrderOptions { towards: DVec3::ZERO, ..OrderOptions::default() };
    assert!(refusal(&rings, &flat).contains("is no direction"));
    assert!(refusal(&rings, &OrderOptions { double: 2.0, ..OrderOptions::default() }).contains("from 0 to 0.5"));
    let stopped = order_while(&rings, &defaults, &|done| done < 0.2);
    assert_eq!(stopped, Err(OrderError::Stopped));
}

#[test]
fn one_section_is_in_order() {
    let one = [ring("only", DVec3::ONE, DVec3::NEG_Z, 0.1, 2.0)];
    let ordered = order(&one, &OrderOptions::default()).unwrap();
    assert_eq!(ordered.sections.len(), 1);
}
