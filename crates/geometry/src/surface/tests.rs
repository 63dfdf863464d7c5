//! Skins as a whole: what they pass through, how they close, how smooth they are.

use std::cell::RefCell;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::{Mesh, check, measure, transform};
use crate::sections::Sections;

fn keep_going(_: f64) -> bool {
    true
}

fn skinned(sections: &Sections, options: SkinOptions) -> Mesh {
    skin(sections, &options, &keep_going).unwrap()
}

/// Rings about +Y, counter-clockwise about it, at heights with radii.
fn rings(profile: impl IntoIterator<Item = (f64, f64)>, nodes: usize) -> Sections {
    let ring = |(height, radius): (f64, f64)| {
        (0..nodes)
            .map(|j| (j as f64 * TAU / nodes as f64).sin_cos())
            .map(|(s, c)| DVec3::new(radius * s, height, radius * c))
            .collect()
    };
    Sections::new(profile.into_iter().map(ring).collect(), true, vec![]).unwrap()
}

fn sphere(sections: usize, nodes: usize) -> Sections {
    let angle = move |i: usize| PI * i as f64 / (sections - 1) as f64;
    rings((0..sections).map(|i| (-angle(i).cos(), angle(i).sin())), nodes)
}

/// Outlines of one shape in planes y = 0, 1, 2, each smaller than the last.
fn prism(outline: &[(f64, f64)]) -> Sections {
    let section = |y: f64| outline.iter().map(|(z, x)| DVec3::new(*x, y, *z) * (1.0 - 0.1 * y)).collect();
    Sections::new([0.0, 1.0, 2.0].map(section).to_vec(), true, vec![]).unwrap()
}

const CAPPED: SkinOptions = SkinOptions {
    rows: 3,
    columns: 2,
    cap_start: Cap::Flat,
    cap_end: Cap::Flat,
    parameter: UParameter::Centripetal,
    pole: PoleShape::Round,
};

fn wiggly(closed: bool) -> Sections {
    let row = |i: usize| {
        let point = |j: usize| {
            let (i, j) = (i as f64, j as f64);
            let angle = j * if closed { TAU } else { 2.0 } / 9.0;
            DVec3::new(angle.sin(), 0.6 * i + 0.1 * i * i, angle.cos()) * (1.0 + 0.1 * (3.0 * i + 2.0 * j).sin())
                - DVec3::splat(0.1)
        };
        (0..9).map(point).collect()
    };
    Sections::new((0..6).map(row).collect(), closed, vec![]).unwrap()
}

#[test]
fn section_points_are_vertices_to_the_bit() {
    for closed in [true, false] {
        let sections = wiggly(closed);
        for (rows, columns) in [(1, 1), (5, 3), (2, 64)] {
            let mesh = skinned(&sections, SkinOptions { rows, columns, ..SkinOptions::default() });
            let width = if closed { 9 * columns } else { 8 * columns + 1 };
            assert_eq!(mesh.positions().len(), (5 * rows + 1) * width);
            for (i, section) in sections.iter().enumerate() {
                for (j, point) in section.iter().enumerate() {
                    let vertex = mesh.positions()[i * rows * width + j * columns];
                    assert_eq!(vertex.to_array().map(f64::to_bits), point.to_array().map(f64::to_bits));
                }
            }
        }
    }
}

#[test]
fn tubes_sheets_and_bodies_are_sound() {
    let tube = check(&skinned(&wiggly(true), SkinOptions::default()));
    assert!(tube.is_sound(), "{tube}");
    assert_eq!((tube.closed, tube.boundary_loops, tube.euler_characteristic, tube.shells), (false, 2, 0, 1));
    assert_eq!(tube.normals_outward, Some(true));

    let sheet = check(&skinned(&wiggly(false), SkinOptions::default()));
    assert!(sheet.is_sound(), "{sheet}");
    assert_eq!((sheet.closed, sheet.boundary_loops, sheet.euler_characteristic), (false, 1, 1));

    let body = check(&skinned(&wiggly(true), CAPPED));
    assert!(body.is_sound() && body.closed, "{body}");
    assert_eq!((body.euler_characteristic, body.normals_outward), (2, Some(true)));
}

#[test]
fn a_sphere_from_a_few_circles_is_round_up_to_its_poles() {
    for (sections, off_radius, off_normal) in [(5, 1.3e-3, 0.3), (9, 1e-4, 0.05), (17, 2e-5, 0.02)] {
        let mesh = skinned(&sphere(sections, 24), SkinOptions { rows: 16, columns: 4, ..CAPPED });
        let found = check(&mesh);
        assert!(found.is_sound() && found.closed && found.euler_characteristic == 2, "{found}");
        let worst = mesh.positions().iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < off_radius, "{sections} sections: off by {worst}");
        for (vertex, normal) in mesh.corners().iter().zip(mesh.normals().unwrap()) {
            let radial = mesh.positions()[*vertex as usize];
            let off = normal.angle_between(radial).to_degrees();
            assert!(off < off_normal, "{sections} sections: normal off by {off} degrees");
        }
        assert!((measure::signed_volume(&mesh) / (4.0 / 3.0 * PI) - 1.0).abs() < 6e-3);
        assert!((measure::area(&mesh) / (4.0 * PI) - 1.0).abs() < 6e-3);
    }
}

#[test]
fn a_pole_is_one_vertex_with_a_fan() {
    let dome = rings([(0.0, 1.0), (0.7, 0.7), (1.0, 0.0)], 8);
    let mesh = skinned(&dome, SkinOptions { rows: 2, columns: 1, cap_start: Cap::Flat, ..SkinOptions::default() });
    let found = check(&mesh);
    assert!(found.is_sound() && found.closed, "{found}");
    // Four rows of eight and the tip, a ring of eight and the middle of the cap.
    assert_eq!(mesh.positions().len(), 4 * 8 + 1 + 8 + 1);
    let tip = mesh.positions().iter().position(|p| *p == DVec3::Y).unwrap() as u32;
    let fan: Vec<usize> = (0..mesh.polygon_count()).filter(|p| mesh.polygon(*p).contains(&tip)).collect();
    assert_eq!(fan.len(), 8);
    assert!(fan.iter().all(|p| mesh.polygon(*p).len() == 3));
    for (vertex, normal) in mesh.corners().iter().zip(mesh.normals().unwrap()) {
        assert!(*vertex != tip || normal.distance(DVec3::Y) < 1e-12);
    }
    // Round: the columns arrive level. Pointed: they do not.
    let slant = |pole| {
        let mesh = skinned(&dome, SkinOptions { rows: 64, columns: 1, pole, ..SkinOptions::default() });
        let near = mesh.positions()[127 * 8];
        (1.0 - near.y).atan2(near.z).to_degrees()
    };
    assert!(slant(PoleShape::Round) < 2.0, "{}", slant(PoleShape::Round));
    assert!(slant(PoleShape::Pointed) > 10.0, "{}", slant(PoleShape::Pointed));
    let spike = check(&skinned(&dome, SkinOptions { pole: PoleShape::Pointed, ..SkinOptions::default() }));
    assert!(spike.is_sound(), "{spike}");
}

#[test]
fn a_tilted_tip_off_the_middle_is_sound() {
    let mut rows: Vec<Vec<DVec3>> = sphere(7, 16).iter().map(<[DVec3]>::to_vec).collect();
    for row in &mut rows {
        for p in row.iter_mut() {
            *p = DVec3::new(2.0 * p.x + 0.4 * p.y, p.y + 0.3 * p.x, p.z + 0.5 * p.y * p.y);
        }
    }
    let found = check(&skinned(&Sections::new(rows, true, vec![]).unwrap(), CAPPED));
    assert!(found.is_sound() && found.closed, "{found}");
    assert!(found.largest_fold_degrees < 45.0, "{}", found.largest_fold_degrees);
}

#[test]
fn a_waist_may_be_a_pole() {
    let hourglass = rings([(0.0, 1.0), (0.5, 0.6), (1.0, 0.0), (1.5, 0.6), (2.0, 1.0)], 8);
    let found = check(&skinned(&hourglass, CAPPED));
    assert!(found.closed && found.non_manifold_edges.is_empty(), "{found}");
    // Two bodies that touch in one vertex.
    assert_eq!((found.shells, found.euler_characteristic), (2, 3));
}

#[test]
fn caps_close_any_outline() {
    let square: Vec<(f64, f64)> = (0..32)
        .map(|i| (i / 8, f64::from(i % 8) / 4.0 - 1.0))
        .map(|(side, t)| [(1.0, t), (-t, 1.0), (-1.0, -t), (t, -1.0)][side as usize])
        .collect();
    // A horseshoe, which is not star-shaped, with points on its straight ends.
    let mut horseshoe: Vec<(f64, f64)> =
        (0..=20).map(|i| (0.5 + f64::from(i) * 0.25).sin_cos()).map(|(s, c)| (c, s)).collect();
    horseshoe.push(horseshoe[20]);
    horseshoe[21] = (0.8 * horseshoe[20].0, 0.8 * horseshoe[20].1);
    horseshoe.extend((0..=20).rev().map(|i| (0.5 + f64::from(i) * 0.25).sin_cos()).map(|(s, c)| (0.6 * c, 0.6 * s)));
    for (outline, area) in [(&square, 4.0), (&horseshoe, 5.0 / 2.0 * (1.0 - 0.36))] {
        let mesh = skinned(&prism(outline), SkinOptions { columns: 1, ..CAPPED });
        let found = check(&mesh);
        assert!(found.is_sound() && found.closed, "{found}");
        assert_eq!((found.euler_characteristic, found.normals_outward), (2, Some(true)));
        let at = |y: f64, normal: DVec3| -> f64 {
            (0..mesh.polygon_count())
                .filter(|p| mesh.polygon(*p).iter().all(|v| mesh.positions()[*v as usize].y == y))
                .inspect(|p| {
                    let normals = &mesh.normals().unwrap()[mesh.corner_range(*p)];
                    assert!(normals.iter().all(|n| n.distance(normal) < 1e-12), "{normals:?}");
                })
                .map(|p| measure::polygon_area(&mesh, p))
                .sum()
        };
        assert!((at(0.0, DVec3::NEG_Y) / area - 1.0).abs() < 0.02);
        assert!((at(1.6, DVec3::Y) / area / 0.64 - 1.0).abs() < 0.02);
    }
}

#[test]
fn uvs_run_from_seam_to_seam() {
    let sections = wiggly(true);
    let mesh = skinned(&sections, SkinOptions { rows: 2, columns: 3, ..CAPPED });
    let sides = 5 * 2 * 27;
    let uvs = mesh.uvs().unwrap();
    for polygon in 0..sides {
        let [a, b, c, d] = uvs[mesh.corner_range(polygon)] else { panic!("a side is a quad") };
        assert!(a.x < b.x && c.x == b.x && d.x == a.x && a.y < d.y && b.y == a.y, "{a} {b} {c} {d}");
        assert_eq!(a.x == 0.0, polygon % 27 == 0);
        assert_eq!(b.x == 1.0, polygon % 27 == 26);
    }
    assert_eq!(uvs[0], DVec2::ZERO);
    assert_eq!(uvs[mesh.corner_range(sides - 1)][2], DVec2::ONE);
    assert!(uvs.iter().all(|uv| uv.cmpge(DVec2::splat(-1e-12)).all() && uv.cmple(DVec2::splat(1.0 + 1e-12)).all()));
    // A cap is not mirrored: its UVs turn as its corners do.
    for polygon in sides..mesh.polygon_count() {
        let uvs = &uvs[mesh.corner_range(polygon)];
        assert!((uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]) > 0.0);
    }
}

#[test]
fn normals_are_those_of_the_surface_and_the_seam_is_smooth() {
    let sections = wiggly(true);
    let coarse = skinned(&sections, SkinOptions { rows: 1, columns: 1, ..SkinOptions::default() });
    let fine = skinned(&sections, SkinOptions { rows: 64, columns: 64, ..SkinOptions::default() });
    let mut at = vec![None; coarse.positions().len()];
    for (vertex, normal) in coarse.corners().iter().zip(coarse.normals().unwrap()) {
        assert!((normal.length() - 1.0).abs() < 1e-12);
        let seen = at[*vertex as usize].get_or_insert(*normal);
        assert_eq!(seen, normal, "corners of one vertex share their normal");
    }
    let width = 9 * 64;
    for i in 1..5 {
        for j in 0..9 {
            let point = |row: usize, column: usize| fine.positions()[row * width + (column + width) % width];
            let (row, column) = (64 * i, 64 * j);
            let across = point(row, column + 1) - point(row, column + width - 1);
            let along = point(row + 1, column) - point(row - 1, column);
            let normal = at[i * 9 + j].unwrap();
            let off = normal.angle_between(across.cross(along)).to_degrees();
            assert!(off < 0.2, "section {i}, point {j}: {off} degrees");
        }
    }
}

#[test]
fn the_surface_is_the_same_from_any_start_and_either_end() {
    let sections = wiggly(true);
    let turned = sections.iter().map(|row| [&row[4..], &row[..4]].concat()).collect();
    let reversed = (0..6).rev().map(|i| sections.section(i).iter().rev().copied().collect()).collect();
    let options = SkinOptions { rows: 3, columns: 2, ..SkinOptions::default() };
    let expected = skinned(&sections, options);
    for rows in [turned, reversed] {
        let other = skinned(&Sections::new(rows, true, vec![]).unwrap(), options);
        for p in other.positions() {
            let nearest = expected.positions().iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12);
        }
    }
}

#[test]
fn uniform_skins_move_with_their_sections() {
    let affine = glam::DAffine3::from_cols_array(&[1.0, 0.3, 0.0, -0.2, 2.0, 0.1, 0.5, 0.0, 0.7, 3.0, -4.0, 5.0]);
    let options = SkinOptions { parameter: UParameter::Uniform, ..SkinOptions::default() };
    let sections = wiggly(true);
    let moved = sections.iter().map(|row| row.iter().map(|p| affine.transform_point3(*p)).collect()).collect();
    let of_moved = skinned(&Sections::new(moved, true, vec![]).unwrap(), options);
    let moved = transform(&skinned(&sections, options), &affine).unwrap();
    for (a, b) in of_moved.positions().iter().zip(moved.positions()) {
        assert!(a.distance(*b) < 1e-12);
    }
    for (a, b) in of_moved.normals().unwrap().iter().zip(moved.normals().unwrap()) {
        assert!(a.distance(*b) < 1e-9);
    }
}

#[test]
fn many_sections_do_not_swing() {
    // Runge's profile, against the polynomial of the thesis through the same radii.
    let radius = |y: f64| 0.2 + 1.0 / (1.0 + 25.0 * (2.0 * y - 1.0).powi(2));
    for (sections, most) in [(12, 0.085), (16, 0.04), (21, 0.0066), (31, 0.0012)] {
        let heights: Vec<f64> = (0..sections).map(|i| f64::from(i) / f64::from(sections - 1)).collect();
        let limb = rings(heights.iter().map(|y| (*y, radius(*y))), 16);
        let options = SkinOptions { rows: 16, columns: 1, parameter: UParameter::Uniform, ..SkinOptions::default() };
        let mesh = skinned(&limb, options);
        let off = |p: &DVec3| (p.x.hypot(p.z) - radius(p.y)).abs();
        let worst = mesh.positions().iter().map(off).fold(0.0, f64::max);
        assert!(worst < most, "{sections} sections: {worst}");

        let lagrange = |y: f64| -> f64 {
            let basis = |i: &f64| heights.iter().filter(|k| *k != i).map(|k| (y - k) / (i - k)).product::<f64>();
            heights.iter().map(|i| radius(*i) * basis(i)).sum()
        };
        let of_polynomial = mesh.positions().iter().map(|p| (lagrange(p.y) - radius(p.y)).abs()).fold(0.0, f64::max);
        assert!(of_polynomial > 5.0 * worst, "{sections} sections: {of_polynomial} and {worst}");
    }
}

#[test]
fn one_section_too_large_is_damped() {
    let stack = |odd: f64| rings((0..12).map(|i| (f64::from(i), if i == 4 { odd } else { 1.0 })), 16);
    let options = SkinOptions { rows: 8, columns: 1, parameter: UParameter::Uniform, ..SkinOptions::default() };
    let mesh = skinned(&stack(1.05), options);
    let worst = |gap: usize| {
        let rows = &mesh.positions()[gap * 8 * 16..(gap + 1) * 8 * 16];
        rows.iter().map(|p| (p.x.hypot(p.z) - 1.0).abs()).fold(0.0, f64::max)
    };
    for gap in 5..8 {
        let damping = worst(gap) / worst(gap + 1);
        assert!((damping - 3.73).abs() < 0.1, "gap {gap}: {damping}");
    }
}

#[test]
fn smooth_sections_give_columns_without_ripples() {
    let limb = rings((0..9).map(|i| (f64::from(i) * 0.1, 0.3 + 0.1 * (f64::from(i) * 0.5).cos())), 12);
    let mesh = skinned(&limb, SkinOptions { rows: 8, columns: 2, ..SkinOptions::default() });
    let dense = mesh.positions().chunks(24).map(<[DVec3]>::to_vec).collect();
    let measured = ripple(&Sections::new(dense, true, vec![]).unwrap());
    assert!(measured.sign_changes <= 1, "{measured:?}");
    assert!(measured.max_turn_degrees < 3.0, "{measured:?}");
}

#[test]
fn progress_rises_to_one_and_may_stop_the_skin() {
    let heard = RefCell::new(Vec::new());
    let hear = |share: f64| {
        heard.borrow_mut().push(share);
        true
    };
    skin(&wiggly(true), &SkinOptions::default(), &hear).unwrap();
    let heard = heard.into_inner();
    assert!(heard.len() > 5 && heard.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!((heard[0], heard[heard.len() - 1]), (0.0, 1.0));
    for stop in [0.0, 0.5, 1.0] {
        let result = skin(&wiggly(true), &SkinOptions::default(), &|share| share < stop);
        assert_eq!(result, Err(SkinError::Cancelled));
    }
}

#[test]
fn what_makes_no_surface_is_refused_with_its_place() {
    let refuse = |sections: &Sections, options: SkinOptions| skin(sections, &options, &keep_going).unwrap_err();
    let plain = SkinOptions::default();
    let tube = rings([(0.0, 1.0), (1.0, 1.0)], 8);
    for (rows, columns, what, value) in [(0, 1, "rows", 0), (1, 65, "columns", 65)] {
        let error = refuse(&tube, SkinOptions { rows, columns, ..plain });
        assert_eq!(error, SkinError::OutOfRange { what, value });
    }
    let twice = rings([(0.0, 1.0), (1.0, 1.0), (1.0, 1.0), (2.0, 1.0)], 8);
    let error = refuse(&twice, plain);
    assert_eq!(error, SkinError::IdenticalSections { first: 1, second: 2 });
    assert_eq!(
        error.to_string(),
        "sections 1 and 2 are identical, and no surface lies between them: move or remove one"
    );
    let point = Sections::new(vec![vec![DVec3::ONE; 3]; 2], true, vec![]).unwrap();
    assert_eq!(refuse(&point, plain), SkinError::CoincidentPoints);
    let tips = rings([(0.0, 1.0), (1.0, 0.0), (2.0, 0.0)], 8);
    assert_eq!(refuse(&tips, plain), SkinError::NeighbouringPoles { first: 1, second: 2 });
    let sheet = wiggly(false);
    let capped = SkinOptions { cap_end: Cap::Flat, ..plain };
    assert_eq!(refuse(&sheet, capped), SkinError::CapOnOpenSection { section: 5 });
    let crushed = prism(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0)]);
    assert_eq!(refuse(&crushed, CAPPED), SkinError::CapWithoutArea { section: 0 });
    let far = rings([(0.0, 1.0), (1e150, 1.0)], 8);
    assert_eq!(refuse(&far, plain), SkinError::TooLarge { coordinate: 1e150 });
    let many = rings((0..200).map(|i| (f64::from(i), 1.0)), 100);
    let error = refuse(&many, SkinOptions { rows: 64, columns: 64, ..plain });
    assert_eq!(error, SkinError::TooManyVertices { vertices: (199 * 64 + 1) * 6400 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the points: a mesh through all of them with a closed, evenly oriented topology, or an error.
    #[test]
    fn random_sections_are_closed_or_refused(
        count in 2_usize..5,
        nodes in 3_usize..8,
        rows in 1_usize..4,
        columns in 1_usize..4,
        coordinates in prop::collection::vec((-3_i32..4, -3_i32..4, -3_i32..4), 40),
        uneven in 0_u8..3,
    ) {
        let point = |k: usize| {
            let (x, y, z) = coordinates[k % 40];
            DVec3::new(x.into(), y.into(), z.into())
        };
        let sections = (0..count).map(|i| (0..nodes).map(|j| point(i * nodes + j)).collect()).collect();
        let sections = Sections::new(sections, true, vec![]).unwrap();
        let parameter = [UParameter::Uniform, UParameter::ChordLength, UParameter::Centripetal][usize::from(uneven)];
        if let Ok(mesh) = skin(&sections, &SkinOptions { rows, columns, parameter, ..CAPPED }, &keep_going) {
            let found = check(&mesh);
            prop_assert!(found.closed);
            prop_assert!(found.inconsistent_edges.is_empty() && found.unused_vertices.is_empty());
            prop_assert!(mesh.normals().unwrap().iter().all(|n| (n.length() - 1.0).abs() < 1e-9));
            for p in sections.points() {
                let nearest = mesh.positions().iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= 1e-8);
            }
        }
    }
}
