//! Each generator at 33 sections of 64 points, beside the 90 ms a detail that the thesis gives (Python in Houdini on a
//! 3.2 GHz Xeon, section 6.5), and the beam three ways. Run with `cargo bench -p maquette-geometry`.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use maquette_geometry::beam::{
    ClosedBeam, EndCondition, OpenBeam, OpenCardinals, OpenValues, SplineEnd, Stiffness, TensionSpline,
};
use maquette_geometry::curve::Curve;
use maquette_geometry::generate::{
    ArchBorder, BlendBorder, GenerateOptions, Neighbour, arch, between_closed, blend, network, sheet, to_apex,
};

fn open(points: u32, at: impl Fn(f64) -> DVec3) -> Curve {
    let points = (0..=points).map(|i| at(f64::from(i) / f64::from(points))).collect();
    Curve::new("open", points, false).expect("a curve")
}

fn closed(points: u32, at: impl Fn(f64) -> DVec3) -> Curve {
    let points = (0..points).map(|i| at(TAU * f64::from(i) / f64::from(points))).collect();
    Curve::new("closed", points, true).expect("a curve")
}

fn generators(c: &mut Criterion) {
    let options = GenerateOptions { sections: 33, nodes: 64, ..GenerateOptions::default() };
    let go = |_: f64| true;
    let around = |a: f64, y: f64| {
        let r = 0.05 + 0.02 * (12.0 * y).sin();
        DVec3::new(r * a.cos(), y, -r * a.sin())
    };
    let rings = [0.0, 0.2].map(|y| closed(128, |a| around(a, y)));
    let rails: Vec<Curve> = (0..4).map(|k| open(64, |t| around(TAU * f64::from(k) / 4.0, 0.2 * t))).collect();
    c.bench_function("four rails between two closed curves (published: 90 ms)", |b| {
        b.iter(|| black_box(between_closed(&rails, &rings[0], &rings[1], &options, &go)).expect("sections"));
    });

    let dome: Vec<Curve> = (0..4)
        .map(|k| {
            let a = TAU * f64::from(k) / 4.0;
            open(64, |t| {
                let (sin, cos) = (0.5 * PI * t).sin_cos();
                DVec3::new(cos * a.cos(), sin, -cos * a.sin()) * 0.05
            })
        })
        .collect();
    c.bench_function("two open contours over a closed one (published: 90 ms)", |b| {
        b.iter(|| black_box(to_apex(&dome, &rings[0], None, &options, &go)).expect("sections"));
    });

    let over = open(64, |t| DVec3::new((PI * t).cos(), (PI * t).sin(), 0.0) * 0.05);
    let inwards = vec![DVec3::Y; 128];
    for (name, border) in [
        ("one open contour over a closed one", ArchBorder::Parabola),
        ("the same, with a neighbour", ArchBorder::Neighbour(Neighbour::Directions(&inwards))),
    ] {
        c.bench_function(name, |b| {
            b.iter(|| black_box(arch(&over, &rings[0], border, &options, &go)).expect("sections"));
        });
    }

    let strips: Vec<Curve> = [0.0, 1.0, 2.0].iter().map(|a| open(64, |t| around(*a, 0.2 * t))).collect();
    let arcs = [0.0, 0.1, 0.2].map(|y| open(64, |t| around(2.0 * t, y)));
    c.bench_function("a sheet of three rails", |b| {
        let ends = [arcs[0].clone(), arcs[2].clone()];
        b.iter(|| black_box(sheet(&strips, &ends, [None, None], &options, &go)).expect("sections"));
    });
    c.bench_function("the same past three profiles", |b| {
        b.iter(|| black_box(sheet(&strips, &arcs, [None, None], &options, &go)).expect("sections"));
    });

    let corner = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.3), DVec3::Y];
    let side = |k: usize| open(64, |t| corner[k].lerp(corner[(k + 1) % 4], t) + DVec3::Z * 0.2 * (PI * t).sin());
    let borders = [0, 1, 2, 3].map(side);
    c.bench_function("a patch over four borders", |b| {
        b.iter(|| black_box(network(&borders, &[], &[], &options, &go)).expect("sections"));
    });

    let (up, down) = (vec![DVec3::Y; 128], vec![-DVec3::Y; 128]);
    let border = |curve, directions| BlendBorder { curve, neighbour: Neighbour::Directions(directions), strength: 1.0 };
    let (start, end) = (border(&rings[0], &up), border(&rings[1], &down));
    c.bench_function("a blend of two closed borders", |b| {
        b.iter(|| black_box(blend(&start, &end, 0.0, &options, &go)).expect("sections"));
    });
}

/// Solves a dense system by elimination with pivots, as a linear algebra package would.
fn dense(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs())).unwrap_or(k);
        rows.swap(k, pivot);
        right.swap(k, pivot);
        let (above, below) = rows.split_at_mut(k + 1);
        let pivot_row = &above[k];
        for (i, row) in below.iter_mut().enumerate() {
            let factor = row[k] / pivot_row[k];
            for (entry, of_pivot) in row[k..].iter_mut().zip(&pivot_row[k..]) {
                *entry -= factor * of_pivot;
            }
            right[k + 1 + i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| rows[k][j] * right[j]).sum();
        right[k] = (right[k] - sum) / rows[k][k];
    }
    right
}

/// A clamped beam of 129 nodes with a pin: every way that gives its curve.
fn beam(c: &mut Criterion) {
    let stiffness = Stiffness::default();
    let (n, pin) = (129, 64);
    let values = OpenValues { left_tangent: 1.0, right_tangent: -2.0, pins: &[0.7], ..OpenValues::ends(0.1, -0.3) };
    c.bench_function("beam, factored and solved", |b| {
        b.iter(|| {
            let beam = OpenBeam::new(n, &[pin], EndCondition::Clamped, EndCondition::Clamped, stiffness);
            black_box(beam.expect("a beam").solve(&values)).expect("a curve")
        });
    });
    let beam = OpenBeam::new(n, &[pin], EndCondition::Clamped, EndCondition::Clamped, stiffness).expect("a beam");
    c.bench_function("beam, solved again", |b| b.iter(|| black_box(beam.solve(&values)).expect("a curve")));
    let cardinals = OpenCardinals::differences(n, &[pin], stiffness).expect("a beam");
    c.bench_function("beam, by its cardinal functions", |b| {
        b.iter(|| black_box(cardinals.curve(&[0.1, 0.7, -0.3], [1.0, -2.0])).expect("a curve"));
    });
    c.bench_function("beam, by the closed form", |b| {
        b.iter(|| {
            let ends = [SplineEnd::Clamped(1.0), SplineEnd::Clamped(-2.0)];
            let spline = TensionSpline::open(&[0.0, 0.5, 1.0], &[0.1, 0.7, -0.3], ends, stiffness).expect("a spline");
            black_box((0..n).map(|i| spline.value(i as f64 / (n - 1) as f64)).collect::<Vec<f64>>())
        });
    });
    c.bench_function("beam, dense", |b| {
        let tension = stiffness.ratio() / ((n - 1) as f64).powi(2);
        b.iter(|| {
            let mut rows = vec![vec![0.0; n]; n];
            let mut right = vec![0.0; n];
            for (i, row) in rows.iter_mut().enumerate() {
                if i == 0 || i == pin || i + 1 == n {
                    row[i] = 1.0;
                    right[i] = [0.1, 0.7, -0.3][i * 2 / (n - 1)];
                    continue;
                }
                let h = 1.0 / (n - 1) as f64;
                for (step, weight) in
                    [(-2, 1.0), (-1, -4.0 - tension), (0, 6.0 + 2.0 * tension), (1, -4.0 - tension), (2, 1.0)]
                {
                    // The ghost beyond a clamped end mirrors the node beside it.
                    match i as isize + step {
                        -1 => (row[1] += weight, right[i] += 2.0 * h).1,
                        k if k == n as isize => (row[n - 2] += weight, right[i] += 4.0 * h).1,
                        k => row[k as usize] += weight,
                    }
                }
            }
            black_box(dense(rows, right))
        });
    });
    let closed = ClosedBeam::new(64, &[0, 16, 32, 48], stiffness).expect("a beam");
    let pins = [DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z];
    c.bench_function("closed beam of 64 nodes and 4 pins", |b| {
        b.iter(|| black_box(closed.solve(&pins)).expect("a curve"));
    });
}

criterion_group!(benches, generators, beam);
criterion_main!(benches);
