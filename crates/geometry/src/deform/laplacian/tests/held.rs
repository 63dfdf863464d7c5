//! What must be held, and by whom.

use std::cell::Cell;
use std::sync::Arc;

use glam::DVec3;

use super::super::*;
use super::{apart, bar, bind, both, deform, ring, select};
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, join};

fn at(mesh: &Mesh, points: &[DVec3]) -> Selection {
    let near = |v: usize| points.iter().any(|p| p.distance(mesh.positions()[v]) < 1e-9);
    let found = Selection::by(mesh.positions().len(), near);
    assert_eq!(found.vertices().len(), points.len());
    found
}

#[test]
fn without_a_handle_there_is_no_solution_but_with_a_region() {
    let mesh = bar(4, 16, true);
    let refused = bind(&mesh, &[], Reconstruction::Coordinates).unwrap_err();
    let BindError::Underdetermined { vertex: 0, free, .. } = refused else { panic!("{refused}") };
    assert_eq!(free, mesh.positions().len());
    assert!(refused.to_string().contains("is held by nothing: put a handle on it"), "{refused}");
    // What surrounds a region holds it.
    let region = select(&mesh, |p| p.y > 2.0);
    let options = BindOptions::default();
    let bound = Binding::new(Arc::new(mesh.clone()), Some(&region), &[], &options, &|_| true).unwrap();
    assert!(apart(&mesh, deform(&bound, &[], Passes::Once).mesh.positions()) < 1e-12);
}

#[test]
fn an_empty_region_moves_handles_alone() {
    let mesh = bar(4, 16, true);
    let nothing = select(&mesh, |_| false);
    let high = select(&mesh, |p| p.y > 3.4);
    let options = BindOptions::default();
    let bound = Binding::new(Arc::new(mesh.clone()), Some(&nothing), &both([&high]), &options, &|_| true).unwrap();
    assert_eq!(bound.report(), BindReport::default());
    let shift = HandleTransform::translation(DVec3::Y);
    let made = deform(&bound, &[shift], Passes::Once);
    assert_eq!(bound.drag(&[shift]).unwrap(), made.mesh.positions());
    for (v, (p, q)) in mesh.positions().iter().zip(made.mesh.positions()).enumerate() {
        assert_eq!(*q, if high.contains(v) { *p + DVec3::Y } else { *p });
    }
}

#[test]
fn handles_over_the_whole_mesh_move_it() {
    let mesh = bar(4, 16, true);
    let all = select(&mesh, |_| true);
    let bound = bind(&mesh, &both([&all]), Reconstruction::Edges).unwrap();
    let turn = HandleTransform::rotation(DVec3::ONE, DVec3::X, 1.0);
    let wanted: Vec<DVec3> = mesh.positions().iter().map(|p| turn.apply(*p)).collect();
    assert_eq!(deform(&bound, &[turn], Passes::Once).mesh.positions(), wanted);
}

#[test]
fn each_part_needs_a_handle_of_its_own() {
    let mesh = bar(4, 16, true);
    let second = mesh.with_positions(mesh.positions().iter().map(|p| *p + 5.0 * DVec3::X).collect(), None).unwrap();
    let two = join([&mesh, &second]).unwrap();
    let low = select(&two, |p| p.y < 0.6 && p.x < 2.0);
    let refused = bind(&two, &both([&low]), Reconstruction::Coordinates).unwrap_err();
    let BindError::Underdetermined { vertex, free, .. } = refused else { panic!("{refused}") };
    assert_eq!((vertex as usize, free), (mesh.positions().len(), mesh.positions().len()));
    let each = select(&two, |p| p.y < 0.6);
    bind(&two, &both([&each]), Reconstruction::Coordinates).unwrap();
}

#[test]
fn three_handles_in_a_line_hold_with_gradients_and_not_with_positions() {
    let mesh = bar(4, 16, true);
    let line = [0.5, 2.0, 3.5].map(|y| at(&mesh, &[DVec3::new(0.5, y, 0.5)]));
    let handles = both([&line[0], &line[1], &line[2]]);
    for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
        let bound = bind(&mesh, &handles, reconstruction).unwrap();
        let still = HandleTransform::default();
        let turn = HandleTransform::rotation(DVec3::new(0.5, 3.5, 0.5), DVec3::Z, 0.5);
        let made = deform(&bound, &[still, still, turn], Passes::Once);
        for (handle, transform) in line.iter().zip([still, still, turn]) {
            let vertex = handle.vertices()[0] as usize;
            assert_eq!(made.mesh.positions()[vertex], transform.apply(mesh.positions()[vertex]));
        }
        let positions = handles.map(|h| Handle { holds: Holds::Position, ..h });
        let refused = bind(&mesh, &positions, reconstruction).unwrap_err();
        assert!(refused.to_string().contains("at least 4 positions that are not in one plane"), "{refused}");
    }
}

#[test]
fn four_positions_that_span_space_carry_an_affine_map() {
    let mesh = ring(24, 12, true);
    let corners = [0, 70, 147, 225].map(|v: usize| mesh.positions()[v]);
    let held = corners.map(|p| at(&mesh, &[p]));
    let handles = [0, 1, 2, 3].map(|i| Handle { selection: &held[i], holds: Holds::Position });
    let bound = bind(&mesh, &handles, Reconstruction::Coordinates).unwrap();
    let turn = HandleTransform::rotation(DVec3::ONE, DVec3::new(1.0, 2.0, 0.0), 1.1).scaled(1.5);
    // Where only positions are held, nobody says how the handles turn.
    let shifts = corners.map(|p| HandleTransform::translation(turn.apply(p) - p));
    let wanted = mesh.with_positions(mesh.positions().iter().map(|p| turn.apply(*p)).collect(), None).unwrap();
    assert!(apart(&wanted, &bound.drag(&shifts).unwrap()) < 1e-6);
    let options = DeformOptions { features: Features::Scale, passes: Passes::Once };
    let made = bound.deform(&shifts, &options, &|_| true).unwrap();
    assert!(apart(&wanted, made.mesh.positions()) < 1e-8, "{:.1e}", apart(&wanted, made.mesh.positions()));
}

#[test]
fn a_gradient_alone_turns_what_is_held_elsewhere() {
    let mesh = bar(4, 16, true);
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 3.6));
    let handles = [Handle { selection: &low, holds: Holds::Both }, Handle { selection: &high, holds: Holds::Gradient }];
    let turn = HandleTransform::rotation(DVec3::ZERO, DVec3::Z, 0.6);
    for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
        let bound = bind(&mesh, &handles, reconstruction).unwrap();
        let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once).mesh;
        // The top is turned as asked, and where the bend has brought it.
        let [a, b] = [DVec3::new(-0.5, 4.0, -0.5), DVec3::new(0.5, 4.0, -0.5)]
            .map(|p| made.positions()[at(&mesh, &[p]).vertices()[0] as usize]);
        assert!((b - a).normalize().distance(turn.linear() * DVec3::X) < 0.1, "{}", b - a);
        assert!(a.x < -1.0 && a.y > 3.0, "{a}");
    }
    let only = [Handle { selection: &high, holds: Holds::Gradient }];
    let refused = bind(&mesh, &only, Reconstruction::Coordinates).unwrap_err();
    assert!(refused.to_string().contains("has no position held"), "{refused}");
}

#[test]
fn features_keep_their_size_or_take_that_of_the_handles() {
    let mesh = bar(4, 24, true);
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 5.4));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    // Handles pushed together: the detail between becomes smaller, or bulges.
    let push = [HandleTransform::default(), HandleTransform::translation(-2.0 * DVec3::Y)];
    let width = |features: Features| {
        let options = DeformOptions { features, passes: Passes::Once };
        let made = bound.deform(&push, &options, &|_| true).unwrap().mesh;
        let middle = mesh.positions().iter().zip(made.positions()).filter(|(p, _)| (p.y - 3.0).abs() < 0.01);
        middle.map(|(_, q)| q.x.abs()).fold(0.0, f64::max)
    };
    assert!(width(Features::Keep) > width(Features::Scale) + 0.01);
    assert_eq!(width(Features::Automatic), width(Features::Keep));
}

#[test]
fn the_last_of_overlapping_handles_has_the_vertices() {
    let mesh = bar(4, 16, true);
    let (low, high) = (select(&mesh, |p| p.y < 2.1), select(&mesh, |p| p.y > 1.9));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let contested = select(&mesh, |p| p.y > 1.9 && p.y < 2.1).vertices();
    assert_eq!(bound.report().contested, contested.len());
    let shift = HandleTransform::translation(DVec3::X);
    let made = deform(&bound, &[HandleTransform::default(), shift], Passes::Once);
    let moved = |v: u32| made.mesh.positions()[v as usize] - mesh.positions()[v as usize];
    assert!(contested.iter().all(|v| moved(*v).distance(DVec3::X) < 1e-12));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let mesh = bar(4, 16, true);
    let other = Selection::by(3, |_| true);
    let wrong = bind(&mesh, &both([&other]), Reconstruction::Coordinates).unwrap_err();
    assert!(wrong.to_string().contains("selection of handle 0 has 3 weights"), "{wrong}");
    let nothing = select(&mesh, |_| false);
    let empty = bind(&mesh, &both([&nothing]), Reconstruction::Coordinates).unwrap_err();
    assert_eq!(empty, BindError::EmptyHandle { handle: 0 });
    let low = select(&mesh, |p| p.y < 0.6);
    let bound = bind(&mesh, &both([&low]), Reconstruction::Coordinates).unwrap();
    assert_eq!(bound.drag(&[]), Err(DeformError::WrongCount { found: 0, handles: 1 }));
    let infinite = [HandleTransform::translation(DVec3::INFINITY)];
    let refused = DeformError::Handle { handle: 0, source: HandleError::NotFinite };
    assert_eq!(bound.drag(&infinite), Err(refused.clone()));
    assert_eq!(bound.deform(&infinite, &DeformOptions::default(), &|_| true), Err(refused));
    let flat = [HandleTransform::scale(DVec3::ZERO, 0.0)];
    assert_eq!(bound.drag(&flat), Err(DeformError::Handle { handle: 0, source: HandleError::NotOriented }));
    let far = [HandleTransform::scale(DVec3::splat(1e308), 10.0)];
    assert_eq!(bound.drag(&far).map(|_| ()), Err(DeformError::Overflow));
}

#[test]
fn both_halves_stop_when_asked_and_say_how_far_they_are() {
    let mesh = bar(6, 36, true);
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 5.4));
    let bind = |progress: &dyn Fn(f64) -> bool| {
        let handles = both([&low, &high]);
        Binding::new(Arc::new(mesh.clone()), None, &handles, &BindOptions::default(), progress)
    };
    let asked = Cell::new(0);
    let last = Cell::new(0.0);
    let count = |fraction: f64| {
        assert!((last.get()..=1.0).contains(&fraction), "{fraction} after {}", last.get());
        last.set(fraction);
        asked.set(asked.get() + 1);
        true
    };
    let bound = bind(&count).unwrap();
    let binding = asked.take();
    last.set(0.0);
    let transforms = [HandleTransform::default(), HandleTransform::rotation(DVec3::Y, DVec3::Z, 1.0)];
    let options = DeformOptions { passes: Passes::Converged { tolerance: 0.0, most: 5 }, ..Default::default() };
    bound.deform(&transforms, &options, &count).unwrap();
    let deforming = asked.take();
    assert!(binding >= 8 && deforming >= 6, "{binding}, {deforming}");
    for stop in 0..binding {
        let left = Cell::new(stop);
        let until = |_: f64| left.replace(left.get() - 1) > 0;
        assert_eq!(bind(&until).unwrap_err(), BindError::Stopped);
    }
    for stop in 0..deforming {
        let left = Cell::new(stop);
        let until = |_: f64| left.replace(left.get() - 1) > 0;
        assert_eq!(bound.deform(&transforms, &options, &until).unwrap_err(), DeformError::Stopped);
    }
}
