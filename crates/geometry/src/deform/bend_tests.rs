use std::f64::consts::TAU;

use glam::DVec3;

use super::{BeamPin, BeamUnits, BendError, Bending, Bent, EndHold, PinGoal, PointLoad, bend};
use crate::beam::theory::{self, Given, TheoryCase};
use crate::beam::{BeamError, Stiffness};
use crate::curve::{ArcLength, Curve};

const THESIS: BeamUnits = BeamUnits::Share(Stiffness::THESIS);

fn ruler(length: f64) -> Curve {
    Curve::new("ruler", vec![DVec3::ZERO, DVec3::X * length], false).unwrap()
}

fn circle(nodes: usize, radius: f64) -> Curve {
    let at = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / nodes as f64).sin_cos();
        DVec3::new(cos, sin, 0.0) * radius
    };
    Curve::new("ring", (0..nodes).map(at).collect(), true).unwrap()
}

fn by(share: f64, displacement: DVec3) -> BeamPin {
    BeamPin { share, goal: PinGoal::By(displacement) }
}

fn bending(intervals: usize, units: BeamUnits, ends: [EndHold; 2], pins: Vec<BeamPin>) -> Bending {
    Bending { intervals, units, ends, pins, loads: vec![], spread: DVec3::ZERO }
}

fn total(bent: &Bent) -> DVec3 {
    bent.supports.iter().map(|support| support.force).sum()
}

#[test]
fn a_loaded_cantilever_is_that_of_beam_theory() {
    // 0.1 N on 30 cm of EI = 0.03 N m^2.
    let units = BeamUnits::Metres { bending: 0.03, tension: 0.0 };
    let mut how = bending(400, units, [EndHold::Clamped, EndHold::Free], vec![]);
    how.loads = vec![PointLoad { share: 1.0, force: DVec3::NEG_Y * 0.1 }];
    let bent = bend(&ruler(0.3), &how).unwrap();
    let wanted = theory::bend(TheoryCase::Cantilever, 0.3, 0.03, Given::Load(-0.1), 400).unwrap();
    let off = bent.curve.points().iter().zip(&wanted.bent).map(|(p, q)| p.truncate().distance(*q)).fold(0.0, f64::max);
    assert!(off < 1e-7, "{off}");
    assert_eq!((bent.supports.len(), bent.displaced_most), (1, 400));
    let clamp = bent.supports[0];
    assert!((clamp.force - DVec3::Y * 0.1).length() < 1e-9, "{clamp:?}");
    // F L bends the clamped end down.
    assert!((clamp.moment.length() - 0.03).abs() < 1e-6, "{clamp:?}");
    assert!((bent.largest_displacement - 0.03).abs() < 1e-7);
}

#[test]
fn a_supported_beam_shares_its_loads_among_its_supports() {
    let units = BeamUnits::Metres { bending: 0.03, tension: 0.0 };
    let mut how = bending(300, units, [EndHold::Pinned; 2], vec![]);
    // 1.2 N at a third lie two to one on the supports, 2 N/m over 30 cm half and half.
    how.loads = vec![PointLoad { share: 1.0 / 3.0, force: DVec3::NEG_Y * 1.2 }];
    how.spread = DVec3::NEG_Y * 2.0;
    let bent = bend(&ruler(0.3), &how).unwrap();
    let found: Vec<f64> = bent.supports.iter().map(|support| support.force.y).collect();
    assert!((found[0] - 1.1).abs() < 1e-8 && (found[1] - 0.7).abs() < 1e-8, "{found:?}");
    assert!(bent.supports.iter().all(|support| support.moment == DVec3::ZERO && support.pin.is_none()));
    // The spread load alone: 5 q L^4 / 384 EI in the middle.
    how.loads.clear();
    let middle = bend(&ruler(0.3), &how).unwrap().curve.points()[150].y;
    assert!((middle / (-5.0 * 2.0 * 0.3_f64.powi(4) / (384.0 * 0.03)) - 1.0).abs() < 1e-4, "{middle}");
    // A load between nodes turns the beam as much as where it is.
    how.spread = DVec3::ZERO;
    how.loads = vec![PointLoad { share: 0.3011, force: DVec3::NEG_Y }];
    let between = bend(&ruler(0.3), &how).unwrap();
    assert!((between.supports[1].force.y - 0.3011).abs() < 1e-8, "{:?}", between.supports);
}

#[test]
fn loads_and_supports_balance_whatever_holds_the_curve() {
    let bow: Vec<DVec3> =
        (0..=40).map(|k| f64::from(k) / 40.0).map(|t| DVec3::new(t, t * t, (3.0 * t).sin())).collect();
    let bow = Curve::new("bow", bow, false).unwrap();
    use EndHold::{Clamped, Free, Pinned};
    for units in [THESIS, BeamUnits::Metres { bending: 2.0, tension: 30.0 }] {
        for (rest, ends) in [
            (bow.clone(), [Clamped, Free]),
            (bow.clone(), [Free, Free]),
            (bow.clone(), [Pinned, Clamped]),
            (circle(64, 0.2), [Free, Free]),
        ] {
            let pins = vec![by(0.5, DVec3::new(0.01, -0.02, 0.0)), by(0.25, DVec3::ZERO)];
            let mut how = bending(64, units, ends, pins);
            how.loads =
                vec![PointLoad { share: 0.9, force: DVec3::X }, PointLoad { share: 0.5, force: DVec3::Z * 2.0 }];
            how.spread = DVec3::new(0.3, 0.0, -0.5);
            let bent = bend(&rest, &how).unwrap();
            let length = ArcLength::of(&rest).length();
            let over = if units == THESIS { 1.0 } else { length };
            let applied = DVec3::new(1.0, 0.0, 2.0) + how.spread * over;
            let largest = bent.supports.iter().fold(1.0_f64, |m, s| m.max(s.force.length()));
            assert!((total(&bent) + applied).length() < 1e-8 * largest, "{ends:?}: {:?}", bent.supports);
            assert!(bent.supports.windows(2).all(|pair| pair[0].node < pair[1].node));
        }
    }
}

#[test]
fn the_primitive_deformer_reference() {
    // Twelve nodes of a circle, its silhouette moved: the section of the thesis' deformer.
    let pins = vec![
        BeamPin { share: 0.0, goal: PinGoal::To(DVec3::new(1.3, 0.0, 0.0)) },
        BeamPin { share: 0.5, goal: PinGoal::To(DVec3::new(-0.9, 0.1, 0.0)) },
    ];
    let bent = bend(&circle(12, 1.0), &bending(12, THESIS, [EndHold::Free; 2], pins)).unwrap();
    let wanted = [
        (1.3, 0.0),
        (1.150086522494, 0.5079694406455),
        (0.7472086211533, 0.8924210932078),
        (0.2, 1.05),
        (-0.3472086211533, 0.9396297143611),
        (-0.7500865224935, 0.5920305593545),
        (-0.9, 0.1),
        (-0.7500865224935, -0.4079694406455),
        (-0.3472086211533, -0.7924210932078),
        (0.2, -0.95),
        (0.7472086211533, -0.8396297143611),
        (1.150086522494, -0.4920305593545),
    ];
    for (found, (x, y)) in bent.curve.points().iter().zip(wanted) {
        assert!(found.distance(DVec3::new(x, y, 0.0)) < 1e-11, "{found} {x} {y}");
    }
}

#[test]
fn a_free_tip_under_load_reference() {
    // F = 1.5 on the tip, k_b = 0.5, k_s = 1.4: exact to the second order of the scheme.
    let mut how = bending(800, THESIS, [EndHold::Clamped, EndHold::Free], vec![]);
    how.loads = vec![PointLoad { share: 1.0, force: DVec3::Y * 1.5 }];
    let points = bend(&ruler(1.0), &how).unwrap().curve.points().to_vec();
    assert!((points[800].y - 0.4746748663574).abs() < 1e-6 && (points[400].y - 0.1566110714044).abs() < 1e-6);
}

#[test]
fn pins_are_exact_and_units_do_not_change_what_only_pins_shape() {
    let pins = || vec![by(1.0, DVec3::NEG_Y * 0.072), by(0.5, DVec3::Z * 0.01)];
    let ends = [EndHold::Clamped, EndHold::Free];
    let plain = bend(&ruler(0.3), &bending(100, THESIS, ends, pins())).unwrap();
    assert_eq!(plain.curve.points()[100], DVec3::new(0.3, -0.072, 0.0));
    assert_eq!(plain.curve.points()[50], plain.rest.points()[50] + DVec3::Z * 0.01);
    assert_eq!(
        plain.supports.iter().map(|s| (s.pin, s.node)).collect::<Vec<_>>(),
        [(None, 0), (Some(1), 50), (Some(0), 100)]
    );
    // A tension of k_s / k_b EI / L^2 is the same beam.
    let units = BeamUnits::Metres { bending: 0.03, tension: 2.8 * 0.03 / 0.09 };
    let metres = bend(&ruler(0.3), &bending(100, units, ends, pins())).unwrap();
    for (a, b) in plain.curve.points().iter().zip(metres.curve.points()) {
        assert!(a.distance(*b) < 1e-15, "{a} {b}");
    }
}

#[test]
fn errors() {
    let free = [EndHold::Free; 2];
    let failed = |rest: &Curve, how: &Bending| bend(rest, how).unwrap_err();
    let (line, ring) = (ruler(1.0), circle(16, 1.0));
    assert_eq!(failed(&line, &bending(64, THESIS, free, vec![])), BendError::Beam(BeamError::NotHeld));
    assert_eq!(failed(&ring, &bending(64, THESIS, free, vec![])), BendError::Beam(BeamError::NoPin));
    let few = |rest: &Curve, count| failed(rest, &bending(count, THESIS, [EndHold::Clamped; 2], vec![]));
    assert!(matches!(few(&line, 2), BendError::Beam(BeamError::TooFewNodes { found: 3, needed: 4 })));
    assert!(matches!(few(&line, usize::MAX), BendError::Beam(BeamError::TooManyNodes { .. })));
    assert!(matches!(few(&ring, 4), BendError::Beam(BeamError::TooFewNodes { found: 4, needed: 5 })));
    for share in [-0.1, 1.1, f64::NAN] {
        let wrong = bending(64, THESIS, free, vec![by(share, DVec3::X)]);
        assert!(matches!(failed(&line, &wrong), BendError::Share { what: "pin", index: 0, .. }));
        let load = PointLoad { share, force: DVec3::X };
        let wrong = Bending { loads: vec![load], ..bending(64, THESIS, [EndHold::Clamped; 2], vec![]) };
        assert!(matches!(failed(&line, &wrong), BendError::Share { what: "load", index: 0, .. }));
    }
    // A closed curve ends where it begins.
    let twice = bending(64, THESIS, free, vec![by(0.0, DVec3::X), by(1.0, DVec3::Y)]);
    assert_eq!(failed(&ring, &twice), BendError::SamePlace { first: 0, second: 1, node: 0 });
    assert!(bend(&line, &twice).is_ok());
    let inf = bending(64, THESIS, free, vec![by(0.5, DVec3::INFINITY)]);
    assert!(matches!(failed(&ring, &inf), BendError::NotFinite { .. }));
    let soft = BeamUnits::Metres { bending: 0.0, tension: 0.0 };
    assert!(matches!(failed(&line, &bending(64, soft, [EndHold::Clamped; 2], vec![])), BendError::Stiffness(_)));
    let huge = BeamUnits::Metres { bending: 1.0, tension: 0.0 };
    let far = Curve::new("far", vec![DVec3::ZERO, DVec3::X * 1e120], false).unwrap();
    let heavy = Bending { spread: DVec3::Y, ..bending(64, huge, [EndHold::Clamped; 2], vec![]) };
    assert!(matches!(failed(&far, &heavy), BendError::NotFinite { what: "a load" }));
}
