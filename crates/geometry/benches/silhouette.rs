//! The primitive deformer at 64 sections of 64 points, beside the 170 ms that the thesis gives (Python in Houdini on a
//! 3.2 GHz Xeon), and the outline of its surface. Run with `cargo bench -p maquette-geometry --bench silhouette`.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use maquette_geometry::beam::{ClosedBeam, Stiffness, TensionSpline};
use maquette_geometry::curve::Curve;
use maquette_geometry::deform::{
    AlignOptions, FreeFormOptions, SectionSpacing, Silhouette, SilhouetteDeformer, SilhouetteOptions, align_primitive,
    deform_to_curves, deform_to_silhouette,
};
use maquette_geometry::mesh::{silhouette_of, silhouette_report};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::{SkinOptions, skin};
use maquette_geometry::view::View;
use nalgebra::DMatrix;

fn cylinder(rows: usize, nodes: usize) -> Sections {
    let ring = |k: usize| {
        let at = |j: usize| {
            let a = TAU * j as f64 / nodes as f64;
            DVec3::new(a.cos(), k as f64 / (rows - 1) as f64, -a.sin()) * DVec3::new(0.1, 1.0, 0.1)
        };
        (0..nodes).map(at).collect()
    };
    Sections::new((0..rows).map(ring).collect(), true, vec![]).expect("rings are sections")
}

fn strokes(at: impl Fn(f64, f64) -> DVec3) -> [Curve; 2] {
    [1.0, -1.0].map(|side| {
        let points = (0..=112).map(|i| f64::from(i) / 112.0).map(|t| at(side * (0.1 + 0.02 * (9.0 * t).sin()), t));
        Curve::new("stroke", points.collect(), false).expect("a stroke is a curve")
    })
}

fn silhouettes(c: &mut Criterion) {
    let go = |_: f64| true;
    let primitive = cylinder(64, 64);
    let front = strokes(|x, y| DVec3::new(x, y, 0.0));
    let side = strokes(|z, y| DVec3::new(0.0, y, z));
    let one = [Silhouette { view: View::FRONT, strokes: &front }];
    let two = [one[0], Silhouette { view: View::SIDE, strokes: &side }];
    let options = SilhouetteOptions::default();
    c.bench_function("deform 64 x 64 to strokes of one view (published: 170 ms)", |b| {
        b.iter(|| black_box(deform_to_silhouette(&primitive, &one, &options, &go)).expect("sections"));
    });
    c.bench_function("deform 64 x 64 to strokes of two views (published: 170 ms)", |b| {
        b.iter(|| black_box(deform_to_silhouette(&primitive, &two, &options, &go)).expect("sections"));
    });
    let railed = deform_to_silhouette(&primitive, &two, &options, &go).expect("sections").sections;
    let deformer = SilhouetteDeformer::new(&primitive, &[View::FRONT, View::SIDE], &options).expect("a deformer");
    c.bench_function("the same, while a stroke is dragged", |b| {
        b.iter(|| black_box(deformer.deform(&two, &go)).expect("sections"));
    });
    let options_by_detail = SilhouetteOptions { spacing: SectionSpacing::ByDetail(2e-4), ..options };
    let few = cylinder(12, 64);
    c.bench_function("deform 12 x 64 to strokes of two views, sections by detail", |b| {
        b.iter(|| black_box(deform_to_silhouette(&few, &two, &options_by_detail, &go)).expect("sections"));
    });
    let drawn = Curve::new(
        "drawn",
        (0..=112).map(|i| f64::from(i) / 112.0).map(|t| DVec3::new(0.08, t, 0.08 + 0.02 * (6.0 * t).sin())).collect(),
        false,
    )
    .expect("a curve");
    c.bench_function("deform 64 x 64 to a free-form curve, four rails held", |b| {
        b.iter(|| black_box(deform_to_curves(&railed, std::slice::from_ref(&drawn), &FreeFormOptions::default(), &go)));
    });
    c.bench_function("align 64 x 64 to strokes of two views", |b| {
        b.iter(|| black_box(align_primitive(&primitive, &two, &AlignOptions::default(), &go)).expect("sections"));
    });
    let made = deform_to_silhouette(&primitive, &two, &options, &go).expect("sections");
    let mesh = skin(&made.sections, &SkinOptions::default(), &go).expect("a mesh");
    c.bench_function("outline of a mesh of 32256 quads", |b| {
        b.iter(|| black_box(silhouette_of(&mesh, View::FRONT, 0.0, &go)).expect("an outline"));
    });
    let outline = silhouette_of(&mesh, View::FRONT, 0.0, &go).expect("an outline");
    c.bench_function("outline beside two strokes", |b| {
        b.iter(|| black_box(silhouette_report(&outline.curves, &front, View::FRONT, &go)).expect("a report"));
    });
}

/// What the displacements of 64 sections of 64 points, pinned at four of them in three components, cost in other ways.
fn displacements(c: &mut Criterion) {
    let (nodes, pins, stiffness) = (64, [0, 16, 32, 48], Stiffness::default());
    let values = |k: usize| pins.map(|pin| DVec3::new(0.01 * k as f64, 0.02 * pin as f64, 0.3));
    c.bench_function("64 sections: cardinal functions of one factored beam", |b| {
        b.iter(|| {
            let beam = ClosedBeam::new(nodes, &pins, stiffness).expect("a beam");
            (0..64).map(|k| beam.solve(&values(k)).expect("a displacement")).map(black_box).count()
        });
    });
    c.bench_function("64 sections: closed form, evaluated at each point", |b| {
        let parameters = pins.map(|pin| pin as f64 / nodes as f64);
        b.iter(|| {
            (0..64)
                .map(|k| {
                    let spline = TensionSpline::periodic(&parameters, &values(k), stiffness).expect("a spline");
                    (0..nodes).map(|j| spline.value(j as f64 / nodes as f64)).collect::<Vec<_>>()
                })
                .map(black_box)
                .count()
        });
    });
    c.bench_function("64 sections: a dense system each, solved by LU", |b| {
        let tension = stiffness.ratio() / (nodes * nodes) as f64;
        let weights = [(62, 1.0), (63, -4.0 - tension), (0, 6.0 + 2.0 * tension), (1, -4.0 - tension), (2, 1.0)];
        b.iter(|| {
            (0..64)
                .map(|k| {
                    let values = values(k);
                    let mut matrix = DMatrix::<f64>::zeros(nodes, nodes);
                    let mut right = DMatrix::<f64>::zeros(nodes, 3);
                    for i in 0..nodes {
                        if let Some(place) = pins.iter().position(|pin| *pin == i) {
                            matrix[(i, i)] = 1.0;
                            (0..3).for_each(|axis| right[(i, axis)] = values[place][axis]);
                            continue;
                        }
                        weights.iter().for_each(|(step, weight)| matrix[(i, (i + step) % nodes)] += weight);
                    }
                    matrix.lu().solve(&right).expect("a displacement")
                })
                .map(black_box)
                .count()
        });
    });
}

criterion_group!(benches, silhouettes, displacements);
criterion_main!(benches);
