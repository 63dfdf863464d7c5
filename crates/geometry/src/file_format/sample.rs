//! Scenes the tests of this folder share.

use glam::{DVec2, DVec3};

use crate::curve::Curve;
use crate::mesh::Mesh;
use crate::scene::{CurveItem, Material, MeshItem, Scene};

/// A box of six quads, 1 x 2 x 3 m, one corner in the origin.
pub(super) fn cuboid() -> Mesh {
    let positions = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), 2.0 * f64::from(i >> 1 & 1), 3.0 * f64::from(i >> 2 & 1)))
        .collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh::new(positions, quads).unwrap().named("cuboid")
}

/// The box with a hard edge along every edge and the unit square of UVs on every side.
pub(super) fn cuboid_with_attributes() -> Mesh {
    let sides = [-DVec3::X, DVec3::X, -DVec3::Y, DVec3::Y, -DVec3::Z, DVec3::Z];
    let square = [DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(1.0, 0.75), DVec2::new(0.0, 0.75)];
    let normals = sides.iter().flat_map(|n| [*n; 4]).collect();
    cuboid().with_normals(normals).unwrap().with_uvs(square.repeat(6)).unwrap()
}

/// A sphere of 1 m with `around` meridians and `along` bands, smooth normals and a UV seam; the bands at the poles are
/// quads with a repeated vertex.
pub(super) fn sphere(around: usize, along: usize) -> Mesh {
    let mut positions = Vec::new();
    for i in 0..=along {
        let latitude = std::f64::consts::PI * (i as f64 / along as f64 - 0.5);
        let count = if i == 0 || i == along { 1 } else { around };
        for k in 0..count {
            let longitude = std::f64::consts::TAU * k as f64 / around as f64;
            let radius = if count == 1 { 0.0 } else { latitude.cos() };
            positions.push(DVec3::new(radius * longitude.cos(), latitude.sin(), -radius * longitude.sin()));
        }
    }
    let index = |i: usize, k: usize| match i {
        0 => 0,
        _ if i == along => (positions.len() - 1) as u32,
        _ => (1 + (i - 1) * around + k % around) as u32,
    };
    let mut quads = Vec::new();
    let mut uvs = Vec::new();
    for i in 0..along {
        for k in 0..around {
            quads.push([index(i, k), index(i, k + 1), index(i + 1, k + 1), index(i + 1, k)]);
            for (di, dk) in [(0, 0), (0, 1), (1, 1), (1, 0)] {
                uvs.push(DVec2::new((k + dk) as f64 / around as f64, (i + di) as f64 / along as f64));
            }
        }
    }
    let normals = quads.iter().flatten().map(|&v| positions[v as usize]).collect();
    Mesh::new(positions, quads).unwrap().with_normals(normals).unwrap().with_uvs(uvs).unwrap().named("sphere")
}

pub(super) fn item(name: &str, mesh: Mesh) -> MeshItem {
    MeshItem { name: name.to_owned(), mesh, material: Material::default() }
}

/// Two meshes, one of them without attributes and half transparent, and an open and a closed curve.
pub(super) fn mixed_scene() -> Scene {
    let glass = Material {
        name: "glass".to_owned(),
        colour: [0.2, 0.5, 1.0, 0.25],
        roughness: 0.0,
        double_sided: true,
        metallic: 0.0,
    };
    Scene {
        meshes: vec![
            item("ball", sphere(16, 8)),
            MeshItem { name: "crate, wooden \"A\"".to_owned(), mesh: cuboid(), material: glass },
        ],
        curves: vec![CurveItem {
            name: "rails".to_owned(),
            curves: vec![
                Curve::new("open", vec![DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3), DVec3::Y], false).unwrap(),
                Curve::new("loop", vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE], true).unwrap(),
            ],
            colour: [1.0, 0.5, 0.0, 1.0],
        }],
    }
}
