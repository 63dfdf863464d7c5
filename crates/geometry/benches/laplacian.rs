//! Binding, dragging and deforming by handles, one thread, in processor time, so that what else runs on the machine shows
//! little. Run with `RAYON_NUM_THREADS=1 cargo bench -p maquette-geometry --bench laplacian`. Marks: 8k free vertices bound in 0.12 s; 50k
//! bound in 0.9 s, dragged in 30 ms, released in 60 ms, under 700 MB. The thesis' Table 2.1 beside them, on a Pentium IV:
//! 54,517 free vertices factored in 6.6 s and 1.0 s, solved in 0.30 s and 0.13 s, decomposed in 1.2 s.
#![allow(
    missing_docs,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a benchmark has no users, stops where it is wrong, and says how much memory it took"
)]

use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;

use std::time::Duration;

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use maquette_geometry::deform::laplacian::{
    BindOptions, Binding, DeformOptions, Handle, HandleTransform, Holds, Passes, Reconstruction,
};
use maquette_geometry::mesh::{Mesh, Selection};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Time on the processor, of all threads of this process. Linux only; elsewhere it is 0.
struct ProcessorTime;

impl ProcessorTime {
    fn now() -> Duration {
        let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
        let of = |thread: std::fs::DirEntry| -> Option<u64> {
            let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
            text.split_whitespace().next()?.parse().ok()
        };
        Duration::from_nanos(threads.filter_map(of).sum())
    }
}

impl Measurement for ProcessorTime {
    type Intermediate = Duration;
    type Value = Duration;

    fn start(&self) -> Duration {
        Self::now()
    }

    fn end(&self, start: Duration) -> Duration {
        Self::now().saturating_sub(start)
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

/// A ring with waves on it, in triangles.
fn ring(around: u32, across: u32) -> Mesh {
    let points = (0..around).flat_map(|i| {
        (0..across).map(move |j| {
            let (u, v) = (TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(across));
            let thick = 0.4 + 0.03 * (9.0 * u).sin() * (5.0 * v).cos() + 0.01 * (31.0 * u + 17.0 * v).sin();
            let from_axis = 1.0 + thick * v.cos();
            DVec3::new(from_axis * u.cos(), thick * v.sin(), -from_axis * u.sin())
        })
    });
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    let triangles = (0..around).flat_map(|i| {
        (0..across)
            .flat_map(move |j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
    });
    Mesh::new(points.collect(), triangles).expect("it is a mesh")
}

fn deformation(c: &mut Criterion<ProcessorTime>) {
    for (name, around, across) in [("8k", 142, 64), ("50k", 360, 160), ("50k slender", 800, 70)] {
        let mesh = Arc::new(ring(around, across));
        let side = |sign: f64| Selection::by(mesh.positions().len(), |v| sign * mesh.positions()[v].x > 1.2);
        let (left, right) = (side(1.0), side(-1.0));
        let handles = [&left, &right].map(|selection| Handle { selection, holds: Holds::Both });
        let transforms =
            [HandleTransform::default(), HandleTransform::rotation(DVec3::NEG_X, DVec3::X, 1.0).shifted(DVec3::Y)];
        let options = BindOptions::default();
        let bind = || Binding::new(mesh.clone(), None, &handles, &options, &|_| true).expect("it binds");
        MEMORY.reset_peak_usage();
        let bound = bind();
        eprintln!("{name}: {:?}, at most {:.0} MB", bound.report(), MEMORY.peak_usage_as_mb());
        c.bench_function(&format!("{name} free vertices: bind"), |b| b.iter(|| black_box(bind())));
        c.bench_function(&format!("{name} free vertices: bind and drag for the first time"), |b| {
            b.iter(|| black_box(bind().drag(&transforms).expect("it moves")));
        });
        c.bench_function(&format!("{name} free vertices: drag"), |b| {
            b.iter(|| black_box(bound.drag(&transforms).expect("it moves")));
        });
        c.bench_function(&format!("{name} free vertices: release (rotations and the second system)"), |b| {
            b.iter(|| black_box(bound.deform(&transforms, &DeformOptions::default(), &|_| true).expect("it moves")));
        });
        let edges = BindOptions { reconstruction: Reconstruction::Edges };
        let bound = Binding::new(mesh.clone(), None, &handles, &edges, &|_| true).expect("it binds");
        let passes = Passes::Converged { tolerance: 0.0, most: 10 };
        c.bench_function(&format!("{name} free vertices: deform, edges, ten passes"), |b| {
            let options = DeformOptions { passes, ..DeformOptions::default() };
            b.iter(|| black_box(bound.deform(&transforms, &options, &|_| true).expect("it moves")));
        });
    }
}

/// A region of about 50k vertices in a ring of a million: what it costs beyond the region itself is a walk over the
/// mesh and its copy.
fn region_in_a_large_mesh(c: &mut Criterion<ProcessorTime>) {
    let mesh = Arc::new(ring(2000, 500));
    let near = |reach: f64| {
        Selection::by(mesh.positions().len(), |v| {
            let p = mesh.positions()[v];
            p.x > 0.0 && p.z.atan2(p.x).abs() < reach
        })
    };
    let (region, handle) = (near(0.16), near(0.003));
    let handles = [Handle { selection: &handle, holds: Holds::Both }];
    let options = BindOptions::default();
    let bind = || Binding::new(mesh.clone(), Some(&region), &handles, &options, &|_| true).expect("it binds");
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage_as_mb();
    let bound = bind();
    eprintln!("region of a million: {:?}, {:.0} MB more at most", bound.report(), MEMORY.peak_usage_as_mb() - before);
    let transforms = [HandleTransform::translation(0.1 * DVec3::X)];
    c.bench_function("50k free vertices of a million: bind", |b| b.iter(|| black_box(bind())));
    c.bench_function("50k free vertices of a million: drag", |b| {
        b.iter(|| black_box(bound.drag(&transforms).expect("it moves")));
    });
}

criterion_group! { name = benches; config = Criterion::default().with_measurement(ProcessorTime).sample_size(10); targets = deformation, region_in_a_large_mesh }
criterion_main!(benches);
