//! The formulas one by one, against sums written out.

use glam::{DMat3, DQuat, DVec3};

use super::super::handle::Holds;
use super::super::implicit::Implicit;
use super::super::influence::Influence;
use super::super::patch::{Holder, Patch};
use super::super::polar::nearest_rotation;
use super::super::reconstruct::Reconstruct;
use super::super::stencil::Gradients;
use super::super::{BindOptions, Binding, HandleTransform, Reconstruction};
use super::{bar, both, ring, select, sheet};
use crate::mesh::Mesh;

fn patch(mesh: &Mesh, held: impl Fn(DVec3) -> bool, holds: Holds) -> Patch {
    Patch::new(mesh, &|_| true, &[(select(mesh, held).vertices(), holds)]).unwrap()
}

/// A few numbers that are neither round nor in any order.
fn noise(index: usize) -> DVec3 {
    let i = index as f64;
    DVec3::new((1.3 * i + 0.2).sin(), (2.9 * i + 1.1).cos(), (4.7 * i + 0.5).sin())
}

/// `M_i` as (2.4) and (2.5) have it.
fn gradient(patch: &Patch, before: &[DVec3], after: &[DVec3], vertex: usize) -> DMat3 {
    let ring = patch.adjacency.ring(vertex as u32);
    let mean = |points: &[DVec3]| ring.iter().map(|k| points[*k as usize]).sum::<DVec3>() / ring.len() as f64;
    let (old, new) = (mean(before), mean(after));
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let (mut moment, mut mixed) = (DMat3::ZERO, DMat3::ZERO);
    for k in ring.iter().map(|k| *k as usize).chain([vertex]) {
        moment += outer(before[k] - old, before[k] - old);
        mixed += outer(after[k] - new, before[k] - old);
    }
    mixed * moment.inverse()
}

/// `D(v_i)`, the weights taken from the patch.
fn laplacian(patch: &Patch, weights: &[Vec<f64>], areas: &[f64], points: &[DVec3], vertex: usize) -> DVec3 {
    let ring = patch.adjacency.ring(vertex as u32).iter().zip(&weights[vertex]);
    ring.map(|(k, w)| *w * (points[vertex] - points[*k as usize])).sum::<DVec3>() / areas[vertex]
}

fn square(m: DMat3) -> f64 {
    m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()
}

/// Whether a sum of squares is least at `points`, as far as the first `free` may move.
fn is_least(energy: impl Fn(&[DVec3]) -> f64, points: &[DVec3], free: usize) {
    let least = energy(points);
    for seed in 0..5 {
        let step = 1e-3;
        let moved = |sign: f64| -> Vec<DVec3> {
            let by = |(i, p): (usize, &DVec3)| if i < free { *p + sign * step * noise(i + 1000 * seed) } else { *p };
            points.iter().enumerate().map(by).collect()
        };
        let (ahead, back) = (energy(&moved(1.0)), energy(&moved(-1.0)));
        let (slope, bend) = (ahead - back, ahead + back - 2.0 * least);
        assert!(bend > 0.0 && slope.abs() < 1e-6 * bend, "slope {slope:.1e}, bend {bend:.1e}");
    }
}

#[test]
fn gradients_are_those_of_the_print() {
    for mesh in [ring(20, 10, true), ring(20, 10, false)] {
        let patch = patch(&mesh, |p| p.x < -1.0, Holds::Both);
        let gradients = Gradients::new(&patch).unwrap();
        assert_eq!((gradients.displaced, gradients.widened), (0, 0));
        let after: Vec<DVec3> = patch.points.iter().enumerate().map(|(i, p)| *p + 0.3 * noise(i)).collect();
        for vertex in (0..patch.len()).filter(|v| gradients.wanted[*v]) {
            let found: DMat3 = gradients.rows.row(vertex).fold(DMat3::ZERO, |sum, (k, c)| {
                sum + DMat3::from_cols(after[k] * c.x, after[k] * c.y, after[k] * c.z)
            });
            let wanted = gradient(&patch, &patch.points, &after, vertex);
            assert!(square(found - wanted) < 1e-18 * square(wanted).max(1.0));
        }
    }
}

#[test]
fn what_handles_do_adds_up_to_the_first_system() {
    // Far from the origin, where sums of large numbers would show; four handles of all kinds, one of which stays.
    let mesh = ring(24, 12, true);
    let far: Vec<DVec3> = mesh.positions().iter().map(|p| *p + DVec3::new(100.0, -50.0, 30.0)).collect();
    let mesh = mesh.with_positions(far, None).unwrap();
    let part = |from: f64| {
        let is_in = |p: &DVec3| (0.0..0.4).contains(&((p.z - 30.0).atan2(p.x - 100.0) - from));
        (0..mesh.positions().len() as u32).filter(|v| is_in(&mesh.positions()[*v as usize])).collect::<Vec<u32>>()
    };
    let lists = [(-2.0, Holds::Both), (-0.8, Holds::Position), (0.5, Holds::Gradient), (2.0, Holds::Both)]
        .map(|(from, holds)| (part(from), holds));
    let patch = Patch::new(&mesh, &|_| true, &lists).unwrap();
    let (weights, areas) = patch.weights();
    let system = Implicit::new(&patch, Gradients::new(&patch).unwrap(), &weights, &areas, &|_| true).unwrap();
    let turn = |degrees: f64| HandleTransform::rotation(DVec3::new(100.0, -50.0, 30.0), DVec3::Y, degrees.to_radians());
    let moves = [turn(40.0).shifted(DVec3::X), turn(-10.0).scaled(1.3), turn(20.0), HandleTransform::default()];
    let linear: Vec<DMat3> = moves.iter().map(HandleTransform::linear).collect();
    let mut wanted: Vec<DVec3> = (0..patch.len())
        .map(|v| match patch.position[v] {
            Some(Holder::Handle(handle)) => moves[handle].apply(patch.points[v]) - patch.points[v],
            _ => DVec3::ZERO,
        })
        .collect();
    let mut found = wanted.clone();
    let prescribed = |v: usize| match patch.gradient[v] {
        Some(Holder::Handle(handle)) => linear[handle] - DMat3::IDENTITY,
        _ => DMat3::ZERO,
    };
    system.solve(&patch, &mut wanted, &prescribed).unwrap();
    assert!(Influence::bytes(&patch, &system, 4).is_some() && Influence::bytes(&patch, &system, 17).is_none());
    let influence = Influence::new(&patch, &system, 4).unwrap();
    influence.apply(&linear, &|handle, point| moves[handle].apply(point) - point, &mut found);
    let off = wanted.iter().zip(&found).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    assert!(off < 1e-10, "{off:.1e}");
}

#[test]
fn the_first_system_is_the_least_of_both_sums() {
    let mesh = ring(20, 10, true);
    for holds in [Holds::Both, Holds::Position] {
        let patch = patch(&mesh, |p| p.x < -0.8, holds);
        let (weights, areas) = patch.weights();
        let gradients = Gradients::new(&patch).unwrap();
        let system = Implicit::new(&patch, gradients, &weights, &areas, &|_| true).unwrap();
        // The handle is bent in itself, so that nothing fits.
        let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::Z, 0.8));
        let held = |v: usize| turn * patch.points[v] + 0.1 * noise(v) - patch.points[v];
        let mut displacements: Vec<DVec3> =
            (0..patch.len()).map(|v| if v < patch.free { DVec3::ZERO } else { held(v) }).collect();
        system.solve(&patch, &mut displacements, &|_| turn - DMat3::IDENTITY).unwrap();

        let delta: Vec<DVec3> =
            (0..patch.free).map(|v| laplacian(&patch, &weights, &areas, &patch.points, v)).collect();
        let energy = |points: &[DVec3]| {
            let of = |v: usize| match patch.gradient[v] {
                Some(_) => turn,
                None => gradient(&patch, &patch.points, points, v),
            };
            let reach = (0..patch.len()).map(|v| if patch.ring[v] <= 2 { of(v) } else { turn }).collect::<Vec<_>>();
            let mut sum = 0.0;
            for v in 0..patch.free {
                let off = laplacian(&patch, &weights, &areas, points, v) - reach[v] * delta[v];
                sum += areas[v] * off.length_squared();
            }
            for v in 0..patch.len() as u32 {
                for k in patch.adjacency.within(v, 2).into_iter().filter(|k| *k > v) {
                    // Unordered, at least one end free.
                    if (v as usize) < patch.free || (k as usize) < patch.free {
                        sum += square(reach[v as usize] - reach[k as usize]);
                    }
                }
            }
            sum
        };
        let points: Vec<DVec3> = patch.points.iter().zip(&displacements).map(|(p, u)| *p + *u).collect();
        is_least(energy, &points, patch.free);
    }
}

#[test]
fn the_second_system_is_the_least_of_the_turned_coordinates() {
    let mesh = ring(20, 10, false);
    let patch = patch(&mesh, |p| p.x < -0.8, Holds::Both);
    let (weights, areas) = patch.weights();
    let turned: Vec<DMat3> = (0..patch.len())
        .map(|v| DMat3::from_quat(DQuat::from_scaled_axis(noise(v))) * (1.0 + 0.1 * noise(v).x))
        .collect();
    let solved = |kind| {
        let system = Reconstruct::new(&patch, kind, &weights, &areas, &|_| true).unwrap();
        let mut displacements = vec![DVec3::ZERO; patch.len()];
        system.solve(&patch, &turned, &mut displacements).unwrap();
        patch.points.iter().zip(&displacements).map(|(p, u)| *p + *u).collect::<Vec<_>>()
    };
    // (2.11) with rows for the free vertices and those of the handle beside them.
    let rows: Vec<usize> = (0..patch.len()).filter(|v| patch.ring[*v] <= 1).collect();
    assert!(rows.len() > patch.free);
    let coordinates = |points: &[DVec3]| -> f64 {
        let off = |v: &usize| {
            let of = |points: &[DVec3]| laplacian(&patch, &weights, &areas, points, *v);
            areas[*v] * (of(points) - turned[*v] * of(&patch.points)).length_squared()
        };
        rows.iter().map(off).sum()
    };
    is_least(coordinates, &solved(Reconstruction::Coordinates), patch.free);
    let edges = |points: &[DVec3]| -> f64 {
        let mut sum = 0.0;
        for v in &rows {
            for (k, w) in patch.adjacency.ring(*v as u32).iter().map(|k| *k as usize).zip(&weights[*v]) {
                if *v < patch.free || k < patch.free {
                    let turned = turned[*v] * (patch.points[*v] - patch.points[k]);
                    sum += w * (points[*v] - points[k] - turned).length_squared();
                }
            }
        }
        sum
    };
    is_least(edges, &solved(Reconstruction::Edges), patch.free);
}

#[test]
fn coordinates_point_along_the_normal_and_measure_curvature() {
    // On a tube of radius 0.4 around a large ring the mean curvature is about that of the tube; without the half in the
    // weights the coordinates are four times as long as it, at the outer and the inner line 1 / 1.4 more or 1 / 0.6 less.
    let (around, across) = (120, 60);
    let turn = |i: u32, count: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
    let torus = ring(around, across, true);
    let round = (0..around).flat_map(|i| {
        (0..across).map(move |j| {
            let (u, v) = (turn(i, around), turn(j, across));
            DVec3::new((1.0 + 0.4 * v.cos()) * u.cos(), 0.4 * v.sin(), -(1.0 + 0.4 * v.cos()) * u.sin())
        })
    });
    let torus = torus.with_positions(round.collect(), None).unwrap();
    let patch = patch(&torus, |p| p.x < -1.3, Holds::Both);
    let (weights, areas) = patch.weights();
    for (from_axis, curvature) in [(1.4, 1.0 / 0.4 + 1.0 / 1.4), (0.6, 1.0 / 0.4 - 1.0 / 0.6)] {
        let at = from_axis * DVec3::X;
        let vertex = patch.points.iter().position(|p| p.distance(at) < 1e-9).unwrap();
        let delta = laplacian(&patch, &weights, &areas, &patch.points, vertex);
        let outward = if from_axis > 1.0 { DVec3::X } else { DVec3::NEG_X };
        assert!(delta.distance(2.0 * curvature * outward) < 0.02 * 2.0 * curvature, "{delta}");
    }
    let whole: f64 = areas[..patch.free].iter().sum();
    let all = 4.0 * std::f64::consts::PI.powi(2) * 0.4;
    assert!(whole < all && whole > 0.8 * all);
}

#[test]
fn degenerate_vertices_are_displaced_one_after_the_other() {
    let sheet = sheet(10, 10);
    let patch = patch(&sheet, |p| p.x < 0.05, Holds::Both);
    let gradients = Gradients::new(&patch).unwrap();
    let moved: Vec<usize> = (0..patch.len()).filter(|v| gradients.points[*v] != patch.points[*v]).collect();
    assert_eq!(moved.len(), gradients.displaced);
    // A quarter or so: the neighbours of a displaced one are degenerate no more.
    let share = moved.len() as f64 / patch.free as f64;
    assert!((0.05..0.4).contains(&share), "{share}");
    for vertex in &moved {
        let ring = patch.adjacency.ring(*vertex as u32);
        let mean = ring.iter().map(|k| patch.points[*vertex].distance(patch.points[*k as usize])).sum::<f64>()
            / ring.len() as f64;
        let by = gradients.points[*vertex] - patch.points[*vertex];
        // (2.9); all neighbours were where they are when it was its turn, or were displaced before.
        assert!(by.x.abs() + by.z.abs() < 1e-12 && by.y > 0.0);
        assert!((by.y - 0.2 * mean).abs() < 0.01 * mean, "{} of {mean}", by.y);
    }
    // About as many as the thesis counts on its bar, 23.9 % in Table 2.1.
    let bar = bar(6, 36, true);
    let (low, high) = (select(&bar, |p| p.y < 0.5), select(&bar, |p| p.y > 5.5));
    let options = BindOptions::default();
    let bound = Binding::new(std::sync::Arc::new(bar), None, &both([&low, &high]), &options, &|_| true).unwrap();
    let share = bound.report().degenerate as f64 / bound.report().free as f64;
    assert!((0.22..0.28).contains(&share), "{share}");
}

#[test]
fn the_fitted_rotation_of_a_turned_star_is_its_turn() {
    let mesh = ring(20, 10, true);
    let patch = patch(&mesh, |p| p.x < -0.8, Holds::Position);
    let (weights, areas) = patch.weights();
    let system = Reconstruct::new(&patch, Reconstruction::Edges, &weights, &areas, &|_| true).unwrap();
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, 1.0, 0.2).normalize(), 2.9));
    let displacements: Vec<DVec3> = patch.points.iter().map(|p| turn * *p - *p).collect();
    let found = system.rotations(&patch, &displacements, &|_| DMat3::IDENTITY);
    let near = |v: usize| square(found[v] - turn) < 1e-20;
    assert!((0..patch.len()).filter(|v| patch.ring[*v] <= 1).all(near));
    assert!(system.energy(&patch, &found, &displacements).abs() < 1e-12);
    assert!(square(nearest_rotation(found[0] * 3.0) - turn) < 1e-20);
}
