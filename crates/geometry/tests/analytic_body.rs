//! Surfaces through true sections of a body, against the body.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a failing unwrap is a failing test; data is read from files"
)]

mod human;

use maquette_geometry::mesh::{MeshDistance, check};
use maquette_geometry::surface::analytic::{AnalyticSurface, Blend, Continuity, SurfaceOptions, chain};
use maquette_geometry::surface::tessellate::{Closing, Density, Tessellation};
use maquette_geometry::trigonometric::FitOptions;

/// Mean and 95th percentile of the distances from the vertices of the true part, metres, with the mesh within 0.05 mm of
/// the exact surface.
fn errors(surface: &AnalyticSurface, part: &str) -> (f64, f64) {
    let options = Tessellation { density: Density::Deviation(5e-5), ..Tessellation::default() };
    let made = surface.tessellate(&options).unwrap();
    assert!(check(&made.mesh).is_sound(), "{}", check(&made.mesh));
    let distance = MeshDistance::new(&made.mesh).unwrap();
    let truth = human::part(part);
    let mut found: Vec<f64> = truth.positions().iter().map(|p| distance.nearest(*p).distance).collect();
    found.sort_by(f64::total_cmp);
    (found.iter().sum::<f64>() / found.len() as f64, found[found.len() * 95 / 100])
}

#[test]
fn limbs_are_nearer_than_straight_lines_between_the_sections() {
    // Straight lines between the sections' points: 0.67 and 2.0 mm at the leg, 0.27 and 0.74 mm at the forearm.
    for (part, blend, mean, most) in
        [("left_leg", Blend::Spline, 0.5e-3, 1.4e-3), ("left_forearm", Blend::Polynomial, 0.25e-3, 0.70e-3)]
    {
        let surface = AnalyticSurface::through(&human::sections(part, 8), &SurfaceOptions::default()).unwrap();
        assert_eq!(surface.blend(), blend);
        assert!(surface.warnings().is_empty(), "{:?}", surface.warnings());
        let found = errors(&surface, part);
        assert!(found.0 < mean && found.1 < most, "{part}: mean {:.3e}, 95 % {:.3e}", found.0, found.1);
    }
}

#[test]
fn a_spline_serves_the_forearm_as_well() {
    let options = SurfaceOptions { blend: Blend::Spline, ..SurfaceOptions::default() };
    let surface = AnalyticSurface::through(&human::sections("left_forearm", 8), &options).unwrap();
    let found = errors(&surface, "left_forearm");
    assert!(found.1 < 0.75e-3, "{found:?}");
}

#[test]
fn the_leg_in_two_parts_is_smooth_at_the_knee() {
    let leg = human::fitted("left_leg", &FitOptions::default());
    let parts = [leg[..7].to_vec(), leg[6..].to_vec()];
    let chained = chain(&parts, &SurfaceOptions::default(), Continuity::Tangent).unwrap();
    for k in 0..64 {
        let v = f64::from(k) * 0.1;
        let (a, b) = (chained[0].evaluate(1.0, v), chained[1].evaluate(0.0, v));
        assert!(a.position.distance(b.position) < 1e-15);
        assert!(a.normal.angle_between(b.normal).to_degrees() < 1e-4);
    }
}

#[test]
fn torso_and_leg_close_to_sound_bodies() {
    for part in ["torso", "left_leg"] {
        let surface = AnalyticSurface::through(&human::sections(part, 10), &SurfaceOptions::default()).unwrap();
        for closing in [Closing::Flat, Closing::Rounded] {
            let options = Tessellation {
                density: Density::Deviation(5e-4),
                start: closing,
                end: closing,
                ..Tessellation::default()
            };
            let made = surface.tessellate(&options).unwrap();
            let found = check(&made.mesh);
            assert!(found.is_sound() && found.closed && found.shells == 1, "{part}, {closing:?}: {found}");
            assert!(made.deviation.unwrap().largest <= 5e-4);
        }
    }
}
