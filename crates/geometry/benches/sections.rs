//! Fitting the sections of a human body; and the last of three segments with the optimiser the thesis takes for it
//! (3.35, SLSQP). Run with `cargo bench -p maquette-geometry --bench sections`.
#![allow(
    missing_docs,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a benchmark has no users, stops where it is wrong, and says how near the optimiser came"
)]

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::curves_json;
use maquette_geometry::trigonometric::{
    Angles, Continuity, EllipticSection, FitOptions, Harmonics, Joint, LocalAngles, Solution, Split, basis, fit,
    fit_sections,
};
use slsqp::{Func, StopTols, minimize};

fn part(name: &str) -> Vec<Curve> {
    let path = format!("{}/tests/data/human/sections/{name}.json", env!("CARGO_MANIFEST_DIR"));
    curves_json::read(&std::fs::read(path).expect("the sections are there")).expect("the sections are readable")
}

fn body(c: &mut Criterion) {
    let names = ["left_leg", "left_upper_arm", "left_forearm", "hip", "torso", "neck", "head"];
    let parts = names.map(part);
    c.bench_function("65 sections of a body, one series each (mark: under 20 ms)", |b| {
        b.iter(|| {
            for part in &parts {
                black_box(fit_sections(part, &FitOptions::default()).expect("they fit"));
            }
        });
    });
    let split = Split::Automatic { most: 8, corner_angle: PI / 3.0 };
    let options = FitOptions { largest_distance: Some(0.004), split, ..FitOptions::default() };
    for (name, sections) in [("hip", &parts[3]), ("torso", &parts[4])] {
        c.bench_function(&format!("{name} split automatically, within 4 mm"), |b| {
            b.iter(|| black_box(fit_sections(sections, &options).expect("they fit")));
        });
    }
}

/// Joints of three segments, as in Figure 3.12.
const JOINTS: [f64; 3] = [0.3, 2.2, 4.2];

fn three_segments(harmonics: usize, solution: Solution) -> FitOptions {
    let joints = JOINTS.map(|angle| Joint { angle, continuity: Continuity::C1 }).into();
    FitOptions {
        harmonics: Harmonics::Fixed(harmonics),
        angles: Angles::Polar,
        split: Split::At(joints),
        local_angles: LocalAngles::Never,
        solution,
        ..FitOptions::default()
    }
}

/// One coordinate of the last segment: rows over its coefficients, and what they should come to.
struct LastSegment {
    samples: Vec<(Vec<f64>, f64)>,
    ties: Vec<(Vec<f64>, f64)>,
}

fn row(angle: f64, order: usize, harmonics: usize) -> Vec<f64> {
    let mut row = vec![0.0; 2 * harmonics + 1];
    basis(angle, order, &mut row);
    row
}

fn dot(row: &[f64], x: &[f64]) -> f64 {
    row.iter().zip(x).map(|(a, b)| a * b).sum()
}

impl LastSegment {
    /// In units of the section's diagonal about its centre.
    fn of(curve: &Curve, section: &EllipticSection, harmonics: usize, axis: DVec3) -> Self {
        let frame = section.frame();
        let size = frame.diagonal(curve.points());
        let local = |point: DVec3| (point - frame.origin).dot(axis) / size;
        let (from, to) = (JOINTS[2], JOINTS[0] + TAU);
        let samples = curve.points().iter().map(|p| (JOINTS[0] + (frame.angle(*p) - JOINTS[0]).rem_euclid(TAU), *p));
        let inside = samples.filter(|(angle, _)| *angle > from && *angle < to);
        let ends = [(from, &section.segments()[1], from), (to, &section.segments()[0], JOINTS[0])];
        let ties = ends.into_iter().flat_map(|(here, other, there)| {
            let [point, speed] = other.derivatives::<2>(there);
            [(row(here, 0, harmonics), local(point)), (row(here, 1, harmonics), speed.dot(axis) / size)]
        });
        Self { samples: inside.map(|(angle, p)| (row(angle, 0, harmonics), local(p))).collect(), ties: ties.collect() }
    }

    fn objective(&self, x: &[f64]) -> f64 {
        self.samples.iter().map(|(row, f)| (dot(row, x) - f).powi(2)).sum()
    }

    /// By SLSQP from zero. This one (a translation of NLopt's) knows inequalities only: an equality is two of them. The
    /// tolerance is the one SciPy takes by default, the thesis's program.
    fn optimised(&self) -> Vec<f64> {
        let objective = |x: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
            if let Some(gradient) = gradient {
                gradient.fill(0.0);
                for (row, f) in &self.samples {
                    let twice = 2.0 * (dot(row, x) - f);
                    gradient.iter_mut().zip(row).for_each(|(g, a)| *g += twice * a);
                }
            }
            self.objective(x)
        };
        let tie = |sign: f64, row: &[f64], value: f64| {
            let row: Vec<f64> = row.iter().map(|r| sign * r).collect();
            move |x: &[f64], gradient: Option<&mut [f64]>, (): &mut ()| {
                if let Some(gradient) = gradient {
                    gradient.copy_from_slice(&row);
                }
                dot(&row, x) - sign * value
            }
        };
        let closures: Vec<_> =
            self.ties.iter().flat_map(|(row, value)| [tie(1.0, row, *value), tie(-1.0, row, *value)]).collect();
        let constraints: Vec<&dyn Func<()>> = closures.iter().map(|closure| closure as &dyn Func<()>).collect();
        let stop = StopTols { ftol_abs: 1e-6, ..StopTols::default() };
        let count = self.ties[0].0.len();
        let bounds = vec![(-1e9, 1e9); count];
        match minimize(objective, &vec![0.0; count], &bounds, &constraints, (), 1000, Some(stop)) {
            Ok((_, x, _)) | Err((_, x, _)) => x,
        }
    }
}

fn last_of_three(c: &mut Criterion) {
    let curve = &part("torso")[5];
    for harmonics in [3, 5, 8] {
        for (how, solution) in [("in turn", Solution::InTurn), ("together", Solution::Together)] {
            let options = three_segments(harmonics, solution);
            c.bench_function(&format!("three segments {how}, J = {harmonics}, all three in x, y and z"), |b| {
                b.iter(|| black_box(fit(curve, &options).expect("it fits")));
            });
        }
        let section = fit(curve, &three_segments(harmonics, Solution::InTurn)).expect("it fits").section;
        let frame = section.frame();
        let problems = [frame.e1, frame.e2].map(|axis| (axis, LastSegment::of(curve, &section, harmonics, axis)));
        let size = frame.diagonal(curve.points());
        for (axis, problem) in &problems {
            let mut exact: Vec<f64> =
                section.segments()[2].series.coefficients().iter().map(|c| c.dot(*axis) / size).collect();
            exact[0] -= frame.origin.dot(*axis) / size;
            let found = problem.optimised();
            let off = problem.ties.iter().map(|(row, value)| (dot(row, &found) - value).abs()).fold(0.0, f64::max);
            let (optimised, exact) = (problem.objective(&found), problem.objective(&exact));
            eprintln!(
                "J = {harmonics}: SLSQP's sum of squares is {:.3} of the least, ties off by {off:.1e}",
                optimised / exact
            );
        }
        c.bench_function(&format!("last of three segments alone by SLSQP, J = {harmonics}, two coordinates"), |b| {
            b.iter(|| {
                for (_, problem) in &problems {
                    black_box(problem.optimised());
                }
            });
        });
    }
}

criterion_group!(benches, body, last_of_three);
criterion_main!(benches);
