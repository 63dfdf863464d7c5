//! Bars bent and twisted, with the marks of the field.

use std::f64::consts::PI;

use glam::DVec3;

use super::super::*;
use super::{apart, bar, bind, both, deform, edge_error, select};
use crate::mesh::{Mesh, measure};

/// A bar of 1 x 1 x 6 whose lower and upper half metre are handles; the upper one goes as if the line in the middle of
/// the bar became an arc of the angle, in degrees, without changing its length.
fn bent(mesh: &Mesh, holds: Holds, reconstruction: Reconstruction, degrees: f64, passes: Passes) -> Deformed {
    let (low, high) = (select(mesh, |p| p.y < 0.5), select(mesh, |p| p.y > 5.5));
    let handles = [&low, &high].map(|selection| Handle { selection, holds });
    let bound = bind(mesh, &handles, reconstruction).unwrap();
    let (free, angle) = (5.0, degrees.to_radians());
    let turn = HandleTransform::rotation(DVec3::new(-free / angle, 0.5, 0.0), DVec3::Z, angle);
    let turn = turn.shifted(turn.linear() * (-free * DVec3::Y));
    deform(&bound, &[HandleTransform::default(), turn], passes)
}

fn volume(before: &Mesh, after: &Mesh) -> f64 {
    measure::signed_volume(after) / measure::signed_volume(before)
}

#[test]
fn a_bent_bar_keeps_volume_and_edges() {
    let mesh = bar(16, 96, true);
    for (degrees, least, most) in [(120.0, 0.90, 0.105), (170.0, 0.78, 0.16)] {
        for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
            let made = bent(&mesh, Holds::Both, reconstruction, degrees, Passes::Once);
            let (volume, error) = (volume(&mesh, &made.mesh), edge_error(&mesh, &made.mesh));
            assert!(!made.wound && made.passes == 1);
            assert!(volume >= least && error <= most, "{degrees} {reconstruction:?}: {volume:.3}, {error:.4}");
        }
    }
}

#[test]
fn taking_the_shear_out_is_what_keeps_the_bar() {
    let mesh = bar(6, 36, true);
    let (low, high) = (select(&mesh, |p| p.y < 0.5), select(&mesh, |p| p.y > 5.5));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let turn = HandleTransform::rotation(DVec3::new(-1.5, 4.0, 0.0), DVec3::Z, 2.0);
    let dragged = bound.drag(&[HandleTransform::default(), turn]).unwrap();
    let dragged = mesh.with_positions(dragged, None).unwrap();
    let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once);
    assert!(volume(&mesh, &made.mesh) > 1.3 * volume(&mesh, &dragged));
}

#[test]
fn without_turning_the_bar_collapses() {
    let mesh = bar(6, 36, true);
    let (low, high) = (select(&mesh, |p| p.y < 0.5), select(&mesh, |p| p.y > 5.5));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let still = bound.without_turning(&[HandleTransform::default(); 2]).unwrap();
    assert!(apart(&mesh, &still) < 1e-12);
    let angle = 120.0_f64.to_radians();
    let turn = HandleTransform::rotation(DVec3::new(-5.0 / angle, 0.5, 0.0), DVec3::Z, angle);
    let turn = turn.shifted(turn.linear() * (-5.0 * DVec3::Y));
    let plain = bound.without_turning(&[HandleTransform::default(), turn]).unwrap();
    let plain = mesh.with_positions(plain, None).unwrap();
    let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once).mesh;
    assert!(volume(&mesh, &plain) < 0.8 * volume(&mesh, &made));
    assert!(edge_error(&mesh, &plain) > 1.25 * edge_error(&mesh, &made));
}

#[test]
fn converged_bars_are_as_good_as_the_reference() {
    // Root mean squares of the edges' errors by libigl 2.6, `arap` with spokes, positions held, from the bar bent to an
    // arc, 2000 iterations; on this very mesh.
    let mesh = bar(10, 60, true);
    for (degrees, reference) in [(120.0, 0.0578), (170.0, 0.0519)] {
        let passes = Passes::Converged { tolerance: 1e-6, most: 2000 };
        let made = bent(&mesh, Holds::Position, Reconstruction::Edges, degrees, passes);
        let error = edge_error(&mesh, &made.mesh);
        assert!(made.last_move <= 1e-6, "{degrees}: {} passes, {:.1e}", made.passes, made.last_move);
        assert!(error <= reference + 1e-4, "{degrees}: {error:.4} after {} passes", made.passes);
    }
}

#[test]
fn a_twist_of_400_degrees_is_not_one_of_40() {
    let mesh = bar(6, 48, false);
    let (low, high) = (select(&mesh, |p| p.y < 0.5), select(&mesh, |p| p.y > 7.5));
    let converged = Passes::Converged { tolerance: 1e-5, most: 300 };
    for (reconstruction, passes, least, most) in [
        (Reconstruction::Coordinates, Passes::Once, 0.58, 0.17),
        (Reconstruction::Coordinates, converged, 0.58, 0.17),
        (Reconstruction::Edges, Passes::Once, 0.6, 0.12),
        (Reconstruction::Edges, converged, 0.6, 0.12),
    ] {
        let bound = bind(&mesh, &both([&low, &high]), reconstruction).unwrap();
        for degrees in [400.0_f64, -400.0, 200.0] {
            let twist = HandleTransform::rotation(DVec3::ZERO, DVec3::Y, degrees.to_radians());
            let made = deform(&bound, &[HandleTransform::default(), twist], passes);
            assert!(made.wound);
            // The angle around the axis, followed from level to level along one edge of the bar.
            let mut angle = 0.0;
            let mut last = DVec3::ZERO;
            for level in 0..=48 {
                let at = DVec3::new(0.5, f64::from(level) / 6.0, 0.5);
                let vertex = mesh.positions().iter().position(|p| p.distance(at) < 1e-9).unwrap();
                let now = made.mesh.positions()[vertex].with_y(0.0);
                angle += if level == 0 { 0.0 } else { last.cross(now).y.atan2(last.dot(now)) };
                last = now;
                if level == 24 {
                    assert!((angle - 0.5 * degrees.to_radians()).abs() < 0.02, "half way: {angle}");
                }
            }
            assert!((angle - degrees.to_radians()).abs() < 1e-9, "{angle}");
            let (volume, error) = (volume(&mesh, &made.mesh), edge_error(&mesh, &made.mesh));
            assert!(volume > least && error < most, "{degrees} {reconstruction:?}: {volume:.3} {error:.3}");
        }
    }
}

#[test]
fn a_bar_bends_beyond_a_half_turn() {
    let mesh = bar(4, 24, true);
    for (degrees, least) in [(179.0, 0.7), (181.0, 0.7), (270.0, 0.45)] {
        let made = bent(&mesh, Holds::Both, Reconstruction::Edges, degrees, Passes::Once);
        let volume = volume(&mesh, &made.mesh);
        assert!(made.wound && volume > least, "{degrees}: {volume:.3}");
    }
    // The same without winding goes the other way round and tears through itself.
    let turn = HandleTransform::rotation(DVec3::ZERO, DVec3::Z, 1.5 * PI);
    assert!(turn.wound(DVec3::Z, -1).rotation_vector().z + 0.5 * PI < 1e-12);
}
