//! Meshes of analytic surfaces: where their vertices lie, how they close, how far they are from the surface.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::*;
use crate::mesh::{MeshDistance, check, measure as sizes};
use crate::surface::analytic::{Continuity, SurfaceOptions, chain};
use crate::surface::level_of_detail::{Level, LevelError, levels};
use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};

fn section(from: f64, to: f64, coefficients: Vec<DVec3>) -> EllipticSection {
    let segment = EllipticSegment { from, to, local: false, series: Series::new(coefficients).unwrap() };
    EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Y), to - from > 4.0, vec![segment]).unwrap()
}

/// An ellipse about +Y, counter-clockwise about it.
fn ellipse(height: f64, z: f64, x: f64) -> EllipticSection {
    section(0.0, TAU, vec![DVec3::Y * height, DVec3::Z * z, DVec3::X * x])
}

fn limb(count: usize) -> Vec<EllipticSection> {
    let radius = |y: f64| 0.06 + 0.02 * (5.0 * y).sin();
    (0..count)
        .map(|k| k as f64 / (count - 1) as f64)
        .map(|y| {
            let lobes = vec![
                DVec3::new(0.02 * (3.0 * y).sin(), y, 0.0),
                DVec3::Z * radius(y),
                DVec3::X * 0.8 * radius(y),
                DVec3::Z * 0.004,
                DVec3::new(0.0, 0.002, 0.003 * y),
            ];
            section(0.0, TAU, lobes)
        })
        .collect()
}

fn surface(sections: &[EllipticSection]) -> AnalyticSurface {
    AnalyticSurface::through(sections, &SurfaceOptions::default()).unwrap()
}

fn grid(rows: usize, columns: usize) -> Tessellation {
    Tessellation { density: Density::Grid { rows, columns }, ..Tessellation::default() }
}

fn closed(density: Density, closing: Closing) -> Tessellation {
    Tessellation { density, start: closing, end: closing, ..Tessellation::default() }
}

#[test]
fn vertices_and_normals_are_those_of_the_surface() {
    let limb = surface(&limb(12));
    for spacing in [Spacing::Even, Spacing::Curvature] {
        // Widths that are no multiple of the columns computed side by side.
        for columns in [7, 8, 30] {
            let options = Tessellation { spacing, ..grid(13, columns) };
            let made = limb.tessellate(&options).unwrap();
            let mesh = &made.mesh;
            assert_eq!((made.rows, made.columns, mesh.positions().len()), (13, columns, 14 * columns));
            assert!(made.deviation.is_none());
            let found = check(mesh);
            assert!(found.is_sound() && found.boundary_loops == 2 && found.normals_outward == Some(true), "{found}");
            let lattice = Demand::new(std::slice::from_ref(&limb), spacing).lattice(13, columns);
            for (i, u) in lattice.rows[0].iter().enumerate() {
                for (k, v) in lattice.columns.iter().enumerate() {
                    let exact = limb.evaluate(*u, *v);
                    assert!(mesh.positions()[i * columns + k].distance(exact.position) < 1e-15);
                }
            }
            for (vertex, normal) in mesh.corners().iter().zip(mesh.normals().unwrap()) {
                let (i, k) = (*vertex as usize / columns, *vertex as usize % columns);
                let exact = limb.evaluate(lattice.rows[0][i], lattice.columns[k]);
                assert!(normal.distance(exact.normal) < 1e-12);
            }
        }
    }
}

#[test]
fn grids_are_the_points_one_by_one() {
    let tip = section(0.0, TAU, vec![DVec3::Y * 1.3]);
    let limb = surface(&[limb(9), vec![tip]].concat());
    let us = [-1.0, 0.0, 0.2, 0.77, 1.0, f64::NAN];
    let vs = [5.0, -3.0, 0.0, 0.1, 7.0];
    let grid = limb.evaluate_grid(&us, &vs);
    for (i, u) in us.iter().enumerate() {
        for (k, v) in vs.iter().enumerate() {
            let exact = limb.evaluate(*u, *v);
            assert!(grid.positions[5 * i + k].distance(exact.position) < 1e-14);
            assert!(grid.normals[5 * i + k].distance(exact.normal) < 1e-11, "{u} {v}");
        }
    }
    let mut again = SurfaceGrid { positions: vec![DVec3::ONE; 99], normals: vec![] };
    limb.evaluate_grid_into(&us, &vs, &mut again);
    assert_eq!(again, grid);
    assert_eq!(limb.evaluate_grid(&[], &vs), SurfaceGrid::default());
    assert_eq!(limb.evaluate_grid(&us, &[]), SurfaceGrid::default());
}

#[test]
fn rows_may_stand_at_the_sections() {
    let limb = surface(&limb(5));
    let density = Density::Sections { rows: 3, columns: 16 };
    let made = limb.tessellate(&Tessellation { density, ..Tessellation::default() }).unwrap();
    assert_eq!((made.rows, made.columns, made.deviation), (12, 16, None));
    for (k, u) in limb.section_parameters().iter().enumerate() {
        let vertices = &made.mesh.positions()[3 * k * 16..][..16];
        let nearest = |p: &DVec3| limb.section_at(*u).unwrap().nearest(*p).distance;
        assert!(vertices.iter().all(|p| nearest(p) < 1e-12), "section {k}");
    }
    let domed = limb.tessellate(&closed(Density::Sections { rows: 3, columns: 32 }, Closing::Rounded)).unwrap();
    assert_eq!(domed.rows, 12 + 2 * 4);
    assert!(check(&domed.mesh).is_sound());
    let too_many = closed(Density::Sections { rows: usize::MAX, columns: 9 }, Closing::Open);
    assert!(matches!(limb.tessellate(&too_many), Err(TessellationError::TooManyVertices { .. })));
    let none = closed(Density::Sections { rows: 0, columns: 9 }, Closing::Open);
    assert_eq!(limb.tessellate(&none), Err(TessellationError::NoQuads));
}

#[test]
fn uvs_run_from_seam_to_seam() {
    let made = surface(&limb(5)).tessellate(&grid(6, 9)).unwrap();
    let uvs = made.mesh.uvs().unwrap();
    for polygon in 0..54 {
        let [a, b, c, d] = uvs[made.mesh.corner_range(polygon)] else { panic!("a quad") };
        assert!(a.x < b.x && c.x == b.x && d.x == a.x && a.y < d.y && b.y == a.y);
        assert_eq!((a.x == 0.0, b.x == 1.0), (polygon % 9 == 0, polygon % 9 == 8));
        assert_eq!((a.y == 0.0, d.y == 1.0), (polygon < 9, polygon >= 45));
    }
}

#[test]
fn the_deviation_of_a_cylinder_is_its_sagitta() {
    let cylinder = surface(&[ellipse(0.0, 0.5, 0.5), ellipse(2.0, 0.5, 0.5)]);
    for columns in [8, 40] {
        let lattice = Demand::new(std::slice::from_ref(&cylinder), Spacing::Even).lattice(3, columns);
        let found = measure(std::slice::from_ref(&cylinder), &lattice);
        let sagitta = 0.5 * (1.0 - (PI / columns as f64).cos());
        assert!((found.largest / sagitta - 1.0).abs() < 1e-9, "{found:?} {sagitta}");
        assert!((cylinder.evaluate(found.u, found.v).position.y - 2.0 * found.u).abs() < 1e-12);
    }
    // A wanted deviation takes just enough columns, and one row.
    let made = cylinder.tessellate(&Tessellation { density: Density::Deviation(1e-3), ..grid(1, 1) }).unwrap();
    let least = (PI / (1.0 - 1e-3 / 0.5_f64).acos()).ceil() as usize;
    assert!(made.columns >= least && made.columns <= least + 3, "{} {least}", made.columns);
    assert!(made.deviation.unwrap().largest <= 1e-3);
}

#[test]
fn measured_deviations_hold_for_every_point() {
    let limb = surface(&limb(12));
    for wanted in [2e-3, 2e-4, 2e-5] {
        let made = limb.tessellate(&Tessellation { density: Density::Deviation(wanted), ..grid(1, 1) }).unwrap();
        let distance = MeshDistance::new(&made.mesh).unwrap();
        let largest = made.deviation.unwrap().largest;
        assert!(largest <= wanted && largest > 0.5 * wanted, "{wanted}: {largest}");
        let mut worst = 0.0_f64;
        for i in 0..200 {
            for k in 0..20 {
                let (u, v) = (f64::from(i) * 0.618 % 1.0, f64::from(k) * 0.311);
                worst = worst.max(distance.nearest(limb.evaluate(u, v).position).distance);
            }
        }
        assert!(worst <= largest * (1.0 + 1e-9) && worst > 0.3 * largest, "{worst} {largest}");
    }
}

#[test]
fn curvature_spends_quads_better_than_even_steps() {
    let flat: Vec<EllipticSection> =
        (0..=8).map(|k| f64::from(k) / 8.0).map(|y| ellipse(y, 0.05 + 0.2 * y.powi(6), 0.3)).collect();
    let flat = surface(&flat);
    let deviation = |spacing| {
        let options = Tessellation { density: Density::Quads(2000), spacing, ..Tessellation::default() };
        let made = flat.tessellate(&options).unwrap();
        assert!((made.rows * made.columns).abs_diff(2000) < 60, "{} x {}", made.rows, made.columns);
        made.deviation.unwrap().largest
    };
    let (even, curved) = (deviation(Spacing::Even), deviation(Spacing::Curvature));
    assert!(curved < 0.6 * even, "{curved} {even}");
}

#[test]
fn caps_close_a_limb_and_rounded_ones_without_an_edge() {
    let limb = surface(&limb(9));
    let flat = limb.tessellate(&closed(Density::Grid { rows: 20, columns: 24 }, Closing::Flat)).unwrap();
    let found = check(&flat.mesh);
    assert!(found.is_sound() && found.closed && found.euler_characteristic == 2, "{found}");
    assert!(found.largest_fold_degrees > 60.0);
    let made = limb.tessellate(&closed(Density::Grid { rows: 120, columns: 96 }, Closing::Rounded)).unwrap();
    let found = check(&made.mesh);
    assert!(found.is_sound() && found.closed && found.euler_characteristic == 2, "{found}");
    assert!(found.largest_fold_degrees < 15.0, "{found}: {}", found.largest_fold_degrees);
    assert_eq!(made.rows, 120);
    // Sections that run the other way have their normals inside, and their caps outside all the same.
    let reversed: Vec<EllipticSection> =
        [0.0, 1.0, 2.0].map(|y| section(0.0, TAU, vec![DVec3::Y * y, DVec3::Z, DVec3::NEG_X])).to_vec();
    let made = surface(&reversed).tessellate(&closed(Density::Quads(500), Closing::Rounded)).unwrap();
    let (low, high) = sizes::bounds(&made.mesh).unwrap();
    assert!(low.y < -0.9 && high.y > 2.9, "{low} {high}");
    // Half a sphere is met by the cap of its equator.
    let half: Vec<EllipticSection> =
        (0..=6).map(|k| -1.3 + 1.3 * f64::from(k) / 6.0).map(|a| ellipse(a.sin(), a.cos(), a.cos())).collect();
    let options = Tessellation { end: Closing::Rounded, ..grid(60, 40) };
    let dome = surface(&half).tessellate(&options).unwrap();
    for p in dome.mesh.positions().iter().filter(|p| p.y > 0.0) {
        assert!((p.length() - 1.0).abs() < 0.02, "{p}: {}", p.length());
    }
}

#[test]
fn poles_are_one_vertex_and_a_waist_may_be_one() {
    let angle = |k: i32| PI * f64::from(k) / 10.0;
    let sphere: Vec<EllipticSection> = (0..=10)
        .map(|k| {
            if k % 10 == 0 {
                section(0.0, TAU, vec![DVec3::Y * -angle(k).cos()])
            } else {
                ellipse(-angle(k).cos(), angle(k).sin(), angle(k).sin())
            }
        })
        .collect();
    let made = surface(&sphere).tessellate(&closed(Density::Quads(3000), Closing::Rounded)).unwrap();
    let found = check(&made.mesh);
    assert!(found.is_sound() && found.closed && found.euler_characteristic == 2, "{found}");
    assert_eq!(made.mesh.positions().len(), (made.rows - 1) * made.columns + 2);
    assert!((sizes::area(&made.mesh) / (4.0 * PI) - 1.0).abs() < 5e-3);
    for (vertex, normal) in made.mesh.corners().iter().zip(made.mesh.normals().unwrap()) {
        assert!(normal.angle_between(made.mesh.positions()[*vertex as usize]).to_degrees() < 1.0);
    }
    let hourglass = [
        ellipse(0.0, 1.0, 1.0),
        ellipse(0.5, 0.6, 0.6),
        section(0.0, TAU, vec![DVec3::Y]),
        ellipse(1.5, 0.6, 0.6),
        ellipse(2.0, 1.0, 1.0),
    ];
    let made = surface(&hourglass).tessellate(&closed(Density::Grid { rows: 9, columns: 12 }, Closing::Flat)).unwrap();
    let found = check(&made.mesh);
    assert!(found.closed && found.non_manifold_edges.is_empty() && found.shells == 2, "{found}");
}

#[test]
fn open_sections_make_a_sheet() {
    let arc = |i: usize| {
        let i = i as f64;
        section(0.0, PI, vec![DVec3::Y * i, DVec3::X * (1.0 + 0.1 * i), DVec3::NEG_Z, DVec3::Z * 0.1, DVec3::X * 0.05])
    };
    let sheet = surface(&[arc(0), arc(1), arc(2), arc(3)]);
    let made = sheet.tessellate(&Tessellation { density: Density::Quads(400), ..Tessellation::default() }).unwrap();
    let found = check(&made.mesh);
    assert!(found.is_sound() && found.boundary_loops == 1, "{found}");
    assert_eq!(made.mesh.positions().len(), (made.rows + 1) * (made.columns + 1));
    let error = sheet.tessellate(&closed(Density::Quads(400), Closing::Flat)).unwrap_err();
    assert_eq!(error, TessellationError::CapOnOpenSurface { side: Side::Start });
}

#[test]
fn parts_of_a_chain_fit_without_a_crack() {
    let all = limb(16);
    // The middle part has fewer harmonics of its own.
    let parts: Vec<Vec<EllipticSection>> = vec![all[..5].to_vec(), all[4..9].to_vec(), all[8..].to_vec()];
    let chained = chain(&parts, &SurfaceOptions::default(), Continuity::Tangent).unwrap();
    let options = closed(Density::Deviation(3e-4), Closing::Rounded);
    let whole = tessellate(&chained, &options, &|_| true).unwrap();
    let found = check(&whole.mesh);
    assert!(found.is_sound() && found.closed && found.shells == 1, "{found}");

    let parts = tessellate_parts(&chained, &options, &|_| true).unwrap();
    assert_eq!(parts.iter().map(|part| part.rows).sum::<usize>(), whole.rows);
    assert!(parts.iter().all(|part| part.columns == whole.columns));
    for pair in parts.windows(2) {
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        let (a, b) = (pair[0].mesh.positions(), pair[1].mesh.positions());
        // The first part begins with the single vertex of its cap, the last one ends so.
        let rim: Vec<_> = a[a.len() - whole.columns..].iter().map(bits).collect();
        assert_eq!(rim, b[..whole.columns].iter().map(bits).collect::<Vec<_>>());
        let normals = |mesh: &Mesh, from: usize| -> Vec<DVec3> {
            let mut at = vec![DVec3::ZERO; whole.columns];
            for (vertex, normal) in mesh.corners().iter().zip(mesh.normals().unwrap()) {
                if let Some(place) = (*vertex as usize).checked_sub(from).and_then(|k| at.get_mut(k)) {
                    *place = *normal;
                }
            }
            at
        };
        for (m, n) in normals(&pair[0].mesh, a.len() - whole.columns).iter().zip(normals(&pair[1].mesh, 0)) {
            assert!(m.angle_between(n).to_degrees() < 1e-5);
        }
    }
    let worst = |found: &Tessellated| found.deviation.unwrap().largest;
    assert!((parts.iter().map(worst).fold(0.0, f64::max) - worst(&whole)).abs() < 1e-15);
}

#[test]
fn any_number_of_threads_gives_the_same_mesh() {
    let limb = surface(&limb(20));
    let options = closed(Density::Deviation(1e-4), Closing::Rounded);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| limb.tessellate(&options).unwrap())
    };
    let one = with(1);
    for threads in [2, 5] {
        assert_eq!(with(threads), one);
    }
}

#[test]
fn levels_report_how_far_they_are() {
    let chained =
        chain(&[limb(14)[..8].to_vec(), limb(14)[7..].to_vec()], &SurfaceOptions::default(), Continuity::Tangent);
    let chained = chained.unwrap();
    let options = closed(Density::Quads(1), Closing::Rounded);
    let wanted = [
        Level::of(Density::Grid { rows: 96, columns: 64 }),
        Level::of(Density::Deviation(1e-3)),
        Level { harmonics: Some(1), ..Level::of(Density::Quads(2000)) },
        Level { sections: Some(4), ..Level::of(Density::Deviation(5e-3)) },
    ];
    let made = levels(&chained, &options, &wanted, &|_| true).unwrap();
    let constants: usize = chained.iter().map(AnalyticSurface::constants).sum();
    for level in &made {
        assert!(check(&level.tessellated.mesh).is_sound());
        let distance = MeshDistance::new(&level.tessellated.mesh).unwrap();
        for surface in &chained {
            for i in 0..40 {
                let p = surface.evaluate(f64::from(i) / 39.0, f64::from(i) * 0.7).position;
                assert!(distance.nearest(p).distance <= level.deviation.largest * 1.05);
            }
        }
    }
    let deviation = |k: usize| made[k].deviation.largest;
    assert!(deviation(0) < 3e-4 && deviation(1) <= 1e-3 && deviation(3) <= 5e-3);
    // The second harmonic is 4 mm and 3.6 mm high.
    assert!(deviation(2) > 3e-3 && deviation(2) < 8e-3, "{}", deviation(2));
    assert_eq!((made[0].constants, made[1].constants), (constants, constants));
    assert!(made[2].constants < constants * 2 / 3 && made[3].constants < constants * 2 / 3);
    let hopeless = [Level { harmonics: Some(1), ..Level::of(Density::Deviation(1e-4)) }];
    let error = levels(&chained, &options, &hopeless, &|_| true).unwrap_err();
    assert!(matches!(error, LevelError::TooFar { level: 0, reached, .. } if reached > 3e-3), "{error}");
}

#[test]
fn progress_rises_and_may_stop_the_work() {
    let limb = [surface(&limb(12))];
    for density in [Density::Grid { rows: 9, columns: 9 }, Density::Deviation(1e-3)] {
        let heard = std::cell::RefCell::new(Vec::new());
        let hear = |share: f64| {
            heard.borrow_mut().push(share);
            true
        };
        tessellate(&limb, &closed(density, Closing::Flat), &hear).unwrap();
        let heard = heard.into_inner();
        assert!(heard.len() > 8 && heard.windows(2).all(|pair| pair[0] <= pair[1]), "{heard:?}");
        assert_eq!((heard[0], heard[heard.len() - 1]), (0.0, 1.0));
        for stop in [0.0, 0.4, 0.9, 1.0] {
            let stopped = tessellate(&limb, &closed(density, Closing::Flat), &|share| share < stop);
            assert_eq!(stopped, Err(TessellationError::Cancelled));
        }
    }
    let level = [Level::of(Density::Quads(100))];
    let stopped = levels(&limb, &grid(1, 1), &level, &|share| share < 0.5).unwrap_err();
    assert!(matches!(stopped, LevelError::Tessellation { level: 0, error: TessellationError::Cancelled }));
}

#[test]
fn what_makes_no_mesh_is_refused() {
    let limb = surface(&limb(4));
    let refuse = |options: &Tessellation| limb.tessellate(options).unwrap_err();
    for (rows, columns) in [(0, 5), (5, 0)] {
        assert_eq!(refuse(&grid(rows, columns)), TessellationError::NoQuads);
    }
    assert_eq!(refuse(&closed(Density::Quads(0), Closing::Open)), TessellationError::NoQuads);
    for wanted in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refuse(&closed(Density::Deviation(wanted), Closing::Open));
        assert!(matches!(error, TessellationError::NoDeviation { .. }));
    }
    for density in
        [Density::Deviation(1e-14), Density::Quads(usize::MAX), Density::Grid { rows: 1 << 40, columns: 1 << 40 }]
    {
        assert!(matches!(refuse(&closed(density, Closing::Open)), TessellationError::TooManyVertices { .. }));
    }
    assert_eq!(tessellate(&[], &grid(1, 3), &|_| true), Err(TessellationError::NoSurfaces));
    let away = surface(&[ellipse(9.0, 1.0, 1.0), ellipse(10.0, 1.0, 1.0)]);
    let error = tessellate(&[limb, away], &grid(1, 3), &|_| true).unwrap_err();
    assert!(matches!(error, TessellationError::Apart { first: 0, .. }), "{error}");
    let line = |y: f64| section(0.0, TAU, vec![DVec3::Y * y, DVec3::X, DVec3::ZERO]);
    for closing in [Closing::Flat, Closing::Rounded] {
        let flat = surface(&[line(0.0), ellipse(1.0, 1.0, 1.0)]);
        let error = flat.tessellate(&Tessellation { start: closing, ..grid(3, 8) }).unwrap_err();
        assert_eq!(error, TessellationError::CapWithoutArea { side: Side::Start });
    }
}

#[test]
fn a_corner_of_sections_is_a_sharp_edge() {
    // Half a circle and its chord: a half-pipe with a flat side, corners of 90 degrees where they meet.
    let section = |k: u32| {
        let height = DVec3::Z * f64::from(k);
        let arc = Series::new(vec![height, DVec3::X, DVec3::Y]).unwrap();
        // The chord back from -X to X, as -cos over half a turn of its own.
        let chord = Series::new(vec![height, -DVec3::X, DVec3::ZERO]).unwrap();
        let segments = vec![
            EllipticSegment { from: 0.0, to: PI, local: false, series: arc },
            EllipticSegment { from: PI, to: TAU, local: true, series: chord },
        ];
        EllipticSection::new(PlaneFrame::new(height, DVec3::Z), true, segments).unwrap()
    };
    let sections: Vec<EllipticSection> = (0..4).map(section).collect();
    let made = surface(&sections).tessellate(&grid(4, 24)).unwrap();
    assert!(check(&made.mesh).corner_normals_agree);
    let mesh = &made.mesh;
    let normals = mesh.normals().unwrap();
    let mut sides = [0, 0];
    for polygon in 0..mesh.polygon_count() {
        for corner in mesh.corner_range(polygon) {
            let p = mesh.positions()[mesh.corners()[corner] as usize];
            let flat = mesh.corner_range(polygon).all(|c| mesh.positions()[mesh.corners()[c] as usize].y.abs() < 1e-9);
            let wanted = if flat { -DVec3::Y } else { DVec3::new(p.x, p.y, 0.0) };
            assert!(normals[corner].distance(wanted) < 1e-9, "{p} {flat}: {}", normals[corner]);
            sides[usize::from(flat)] += 1;
        }
    }
    assert!(sides[0] >= 16 && sides[1] >= 16, "{sides:?}");
}
