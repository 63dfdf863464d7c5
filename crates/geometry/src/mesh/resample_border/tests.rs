use super::*;
use crate::border::{boundaries, boundary_along};
use crate::curve::Curve;
use crate::mesh::slice::Plane;
use crate::mesh::stroke::{Keep, cut_along};
use crate::mesh::weld::{WeldOptions, weld};
use crate::mesh::{Topology, check, cut::cut_with_plane, measure};
use crate::sections::Sections;
use crate::surface::{SkinOptions, skin};
use std::f64::consts::{PI, TAU};

/// A sphere of radius 1 about the origin, its poles on z.
fn sphere() -> Mesh {
    let ring = |k: u32| {
        let t = PI * f64::from(k) / 48.0 - PI / 2.0;
        let point = |a: f64| DVec3::new(t.cos() * a.cos(), t.cos() * a.sin(), t.sin());
        if k == 0 || k == 48 {
            vec![DVec3::Z * t.sin(); 96]
        } else {
            (0..96).map(|i| point(TAU * f64::from(i) / 96.0)).collect()
        }
    };
    let sections = Sections::new((0..=48).map(ring).collect(), true, vec![]).unwrap();
    skin(&sections, &SkinOptions { rows: 1, columns: 1, ..SkinOptions::default() }, &|_| true).unwrap()
}

/// The sphere with a hole seen from above: an ellipse.
fn holed(a: f64, b: f64) -> Mesh {
    let at = |k: u32| TAU * f64::from(k) / 200.0;
    let points = (0..200).map(at).map(|t| DVec3::new(a * t.cos(), 2.0, b * t.sin())).collect();
    cut_along(&sphere(), &Curve::new("hole", points, true).unwrap(), -DVec3::Y, Keep::Outside, false).unwrap()
}

fn even(mesh: &Mesh, points: usize) -> ResampledBorder {
    let rim = Topology::new(mesh).boundary_loops().remove(0);
    let options = ResampleBorderOptions { points, start: -DVec3::Z, smooth: true };
    resample_border(mesh, &rim, &options, &|_| true).unwrap()
}

#[test]
fn a_hole_gets_even_points_on_the_surface_and_no_fold() {
    let mesh = holed(0.4, 0.3);
    for points in [16, 40, 64, 120, 200] {
        let made = even(&mesh, points);
        let found = check(&made.mesh);
        assert!(found.is_sound(), "{points}: {found}");
        assert_eq!((found.boundary_loops, found.shells), (1, 1));
        assert!(found.largest_fold_degrees < 15.0, "{points}: {found}");
        let place = |k: usize| made.mesh.positions()[made.border[k % points] as usize];
        let sides = (0..points).map(|k| place(k).distance(place(k + 1)));
        let (low, high) = sides.fold((f64::INFINITY, 0.0_f64), |(l, h), s| (l.min(s), h.max(s)));
        assert!(high / low < 1.03, "{points}: {low} to {high}");
        // On the sphere, not on its facets, which are up to 5e-4 off; and on the stroke.
        for k in 0..points {
            let p = place(k);
            assert!((p.length() - 1.0).abs() < 4e-6, "{points}: {}", p.length());
            assert!(((p.x / 0.4).powi(2) + (p.z / 0.3).powi(2) - 1.0).abs() < 3e-3, "{p}");
        }
        assert!(place(0).z < -0.299 && place(0).x.abs() < 1e-3, "{}", place(0));
        let normals = made.mesh.corners().iter().zip(made.mesh.normals().unwrap());
        let off = normals.map(|(vertex, n)| n.angle_between(made.mesh.positions()[*vertex as usize]).to_degrees());
        assert!(off.fold(0.0, f64::max) < 0.12);
        // No more and no less of the sphere than before, but what lies between a polygon of so many sides and the ellipse.
        let lost = measure::area(&mesh) - measure::area(&made.mesh);
        let between = 0.12 * PI * (TAU / points as f64).powi(2) / 6.0;
        assert!(lost.abs() < 1.2 * between + 2e-3, "{points}: {lost}");
    }
}

#[test]
fn directions_are_the_sphere_s_and_the_rest_of_it_stays() {
    let mesh = holed(0.4, 0.3);
    let made = even(&mesh, 64);
    let border = boundary_along(&made.mesh, &made.border, "hole").unwrap();
    for (p, direction) in border.curve().points().iter().zip(border.directions()) {
        let inwards = DVec3::new(-p.x / 0.16, 0.0, -p.z / 0.09);
        assert!(direction.dot(*p).abs() < 1e-3 && direction.dot(inwards) > 0.0, "{p} {direction}");
    }
    assert_eq!(boundaries(&made.mesh).unwrap().len(), 1);
    let before: std::collections::BTreeSet<_> =
        mesh.positions().iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    let new = made.mesh.positions().iter().filter(|p| !before.contains(&p.to_array().map(f64::to_bits))).count();
    assert_eq!(new, 64, "only the border is new");
    // Twice is once: it has its points.
    let again = even(&made.mesh, 64);
    assert_eq!((again.replaced, &again.mesh), ([0, 0], &made.mesh));
}

#[test]
fn uvs_go_on_across_the_seam_of_the_chart() {
    let mesh = holed(0.4, 0.3);
    let made = even(&mesh, 64);
    let uvs = made.mesh.uvs().unwrap();
    for polygon in 0..made.mesh.polygon_count() {
        let range = made.mesh.corner_range(polygon);
        let (low, high) =
            uvs[range].iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), uv| (l.min(*uv), h.max(*uv)));
        assert!((high - low).max_element() < 0.06, "{polygon}: {low} {high}");
    }
}

#[test]
fn a_border_takes_the_points_of_another_and_both_are_welded() {
    let mesh = holed(0.4, 0.3);
    // A lid: one polygon a little beside the hole, run as a face in it.
    let at = |k: u32| TAU * f64::from(k) / 72.0;
    let on = |t: f64| DVec3::new(0.405 * t.cos(), 0.0, -0.305 * t.sin());
    let points: Vec<DVec3> = (0..72).map(at).map(on).map(|p| p.with_y((1.0 - p.length_squared()).sqrt())).collect();
    let lid = Mesh::new(points.clone(), [(0..72).collect::<Vec<u32>>()]).unwrap();
    let rim = Topology::new(&mesh).boundary_loops().remove(0);
    let border = |points: Vec<DVec3>| {
        let outwards = points.iter().map(|p| DVec3::new(p.x, -0.1, p.z)).collect();
        Border::new(Curve::new("lid", points, true).unwrap(), outwards).unwrap()
    };
    for ring in [border(points.clone()), border(points.iter().rev().copied().collect())] {
        let made = resample_border_onto(&mesh, &rim, &ring, &|_| true).unwrap();
        let welded = weld(&[&made.mesh, &lid], &WeldOptions { tolerance: 0.0, smooth_degrees: 30.0 }).unwrap();
        let found = check(&welded.mesh);
        assert!(found.is_sound() && found.closed && found.shells == 1, "{found}");
        assert!(welded.seams[0].whole && welded.seams[0].largest_gap == 0.0);
    }
    let far = border(points.iter().map(|p| *p * 1.3).collect());
    let refused = resample_border_onto(&mesh, &rim, &far, &|_| true).unwrap_err();
    assert!(matches!(refused, ResampleBorderError::Away { .. }), "{refused}");
}

#[test]
fn straight_sides_stay_where_asked_for() {
    let plane = Plane::new(DVec3::Y * 0.2, -DVec3::Y).unwrap();
    let part = cut_with_plane(&sphere(), &plane).unwrap();
    let rim = Topology::new(&part).boundary_loops().remove(0);
    let options = ResampleBorderOptions { points: 50, start: DVec3::X, smooth: false };
    let made = resample_border(&part, &rim, &options, &|_| true).unwrap();
    assert!(made.border.iter().all(|v| (made.mesh.positions()[*v as usize].y - 0.2).abs() < 1e-12));
    assert!((made.mesh.positions()[made.border[0] as usize].x - 0.96_f64.sqrt()).abs() < 1e-4);
}

#[test]
fn what_can_not_be_done_is_refused() {
    let mesh = holed(0.4, 0.3);
    let rim = Topology::new(&mesh).boundary_loops().remove(0);
    let refused = |points, start| {
        resample_border(&mesh, &rim, &ResampleBorderOptions { points, start, smooth: true }, &|_| true).unwrap_err()
    };
    assert_eq!(refused(2, DVec3::Z), ResampleBorderError::Points { found: 2 });
    assert_eq!(refused(64, DVec3::ZERO), ResampleBorderError::Start { found: DVec3::ZERO });
    let options = ResampleBorderOptions { points: 64, start: DVec3::Z, smooth: true };
    assert_eq!(resample_border(&mesh, &[0, 1], &options, &|_| true), Err(ResampleBorderError::NoBorder));
    assert_eq!(resample_border(&mesh, &rim, &options, &|done| done < 0.1), Err(ResampleBorderError::Stopped));
    // A ring of one row of faces: nothing would remain between its borders.
    let row = |z: f64| (0..24).map(|k| TAU * f64::from(k) / 24.0).map(|a| DVec3::new(a.cos(), a.sin(), z)).collect();
    let ring = Sections::new(vec![row(0.0), row(0.1)], true, vec![]).unwrap();
    let ring = skin(&ring, &SkinOptions { rows: 1, ..SkinOptions::default() }, &|_| true).unwrap();
    let rim = Topology::new(&ring).boundary_loops().remove(0);
    let error = resample_border(&ring, &rim, &options, &|_| true).unwrap_err();
    assert!(matches!(error, ResampleBorderError::NearAnother { .. }), "{error}");
}
