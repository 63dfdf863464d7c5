//! Scenes as binary PLY.

use super::WriteError;
use super::output::{CornerWeld, check, distinct_corners};
use crate::scene::Scene;

const FORMAT: &str = "PLY";

/// The meshes of the scene, joined into one, as PLY (`binary_little_endian 1.0`); curves are left out.
///
/// Vertices have `float` properties `x y z`, `nx ny nz` where a mesh has normals (a mesh without lends its polygons'
/// own) and `s t` where a mesh has UVs (0 for a mesh without); corners that agree in all of these are one vertex.
/// Polygons keep their corners as `property list uchar int vertex_indices` (`uint` counts where one has more than 255),
/// but for corners that repeat the vertex before them.
///
/// # Errors
/// [`WriteError`] where there is no mesh, one is empty, a number does not fit `f32` or there are more than 2^31 - 1
/// vertices.
pub fn write(scene: &Scene) -> Result<Vec<u8>, WriteError> {
    if scene.meshes.is_empty() && !scene.curves.is_empty() {
        return Err(WriteError::NoMesh { format: FORMAT });
    }
    check(scene)?;
    let with_normals = scene.meshes.iter().any(|item| item.mesh.normals().is_some());
    let with_uvs = scene.meshes.iter().any(|item| item.mesh.uvs().is_some());
    let mut vertices = Vec::new();
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    let mut first = 0_u64;
    for item in &scene.meshes {
        let mut weld = CornerWeld::new(item, with_normals, false);
        for corners in (0..item.mesh.polygon_count()).filter_map(|polygon| distinct_corners(&item.mesh, polygon)) {
            let mut polygon = Vec::with_capacity(corners.len());
            for corner in corners {
                let vertex = i32::try_from(first + u64::from(weld.vertex(corner)?))
                    .map_err(|_| WriteError::TooLarge { format: FORMAT, limit: "2147483647 vertices" })?;
                polygon.push(vertex as u32);
            }
            polygons.push(polygon);
        }
        for (vertex, position) in weld.positions.iter().enumerate() {
            let uv = weld.uvs.get(vertex).copied().unwrap_or_default();
            let normal = weld.normals.get(vertex).into_iter().flatten();
            let numbers = position.iter().chain(normal).chain(uv.iter().take(if with_uvs { 2 } else { 0 }));
            vertices.extend(numbers.flat_map(|x| x.to_le_bytes()));
        }
        first += weld.positions.len() as u64;
    }

    let wide = polygons.iter().any(|polygon| polygon.len() > usize::from(u8::MAX));
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Maquette {}, metres, +Y up\nelement vertex {first}\n",
        env!("CARGO_PKG_VERSION")
    );
    let properties = ["x y z", if with_normals { "nx ny nz" } else { "" }, if with_uvs { "s t" } else { "" }];
    for property in properties.iter().flat_map(|names| names.split_whitespace()) {
        file.push_str(&format!("property float {property}\n"));
    }
    let count_type = if wide { "uint" } else { "uchar" };
    file.push_str(&format!(
        "element face {}\nproperty list {count_type} int vertex_indices\nend_header\n",
        polygons.len()
    ));
    let mut file = file.into_bytes();
    file.append(&mut vertices);
    for polygon in &polygons {
        let count = polygon.len() as u32;
        if wide {
            file.extend_from_slice(&count.to_le_bytes());
        } else {
            file.push(count as u8);
        }
        file.extend(polygon.iter().flat_map(|vertex| vertex.to_le_bytes()));
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::file_format::sample::{cuboid, cuboid_with_attributes, item, mixed_scene, sphere};
    use crate::mesh::Mesh;

    struct ReadBack {
        header: String,
        vertices: Vec<Vec<f32>>,
        polygons: Vec<Vec<u32>>,
    }

    /// Reads by the header alone, as any reader of the format does.
    fn read_back(bytes: &[u8]) -> ReadBack {
        let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let count = |element: &str| {
            let line = header.lines().find_map(|line| line.strip_prefix(&format!("element {element} "))).unwrap();
            line.parse::<usize>().unwrap()
        };
        let properties = header.lines().filter(|line| line.starts_with("property float ")).count();
        let mut rest = &bytes[end..];
        let mut take = |count: usize| {
            let (taken, left) = rest.split_at(count);
            rest = left;
            taken.to_vec()
        };
        let vertices = (0..count("vertex"))
            .map(|_| take(4 * properties).chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect())
            .collect();
        let wide = header.contains("property list uint int");
        let polygons = (0..count("face"))
            .map(|_| {
                let corners =
                    if wide { u32::from_le_bytes(take(4).try_into().unwrap()) } else { u32::from(take(1)[0]) };
                take(4 * corners as usize).chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
            })
            .collect();
        assert!(rest.is_empty(), "{} bytes too many", rest.len());
        ReadBack { header, vertices, polygons }
    }

    fn written(meshes: Vec<Mesh>) -> ReadBack {
        let meshes = meshes.into_iter().map(|mesh| item("output", mesh)).collect();
        read_back(&write(&Scene { meshes, curves: vec![] }).unwrap())
    }

    #[test]
    fn a_bare_mesh_keeps_its_vertices_and_quads() {
        let ply = written(vec![cuboid()]);
        assert!(ply.header.starts_with("ply\nformat binary_little_endian 1.0\ncomment Maquette "));
        assert!(ply.header.contains("property float z\nelement face 6\nproperty list uchar int vertex_indices\n"));
        assert_eq!((ply.vertices.len(), ply.polygons.len()), (8, 6));
        for (polygon, source) in ply.polygons.iter().zip(cuboid().polygons()) {
            let points: Vec<Vec<f32>> = polygon.iter().map(|&v| ply.vertices[v as usize].clone()).collect();
            let expected: Vec<Vec<f32>> =
                source.iter().map(|&v| cuboid().positions()[v as usize].as_vec3().to_array().to_vec()).collect();
            assert_eq!(points, expected);
        }
    }

    #[test]
    fn vertices_part_where_normals_or_uvs_do() {
        let ply = written(vec![cuboid_with_attributes()]);
        assert!(ply.header.contains("property float nz\nproperty float s\nproperty float t\n"));
        assert_eq!((ply.vertices.len(), ply.vertices[0].len()), (24, 8));
        assert_eq!(ply.vertices[0], [0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0], "v runs upward");
    }

    #[test]
    fn joined_meshes_fill_in_for_each_other() {
        let ply = written(vec![cuboid(), cuboid_with_attributes()]);
        assert_eq!((ply.vertices.len(), ply.polygons.len()), (48, 12));
        assert_eq!(ply.polygons[6].iter().min(), Some(&24));
        for (first, second) in ply.vertices[..24].iter().zip(&ply.vertices[24..]) {
            assert_eq!((&first[..6], &first[6..]), (&second[..6], &[0.0, 0.0][..]), "the polygons' own normals");
        }
    }

    #[test]
    fn poles_become_triangles() {
        let ply = written(vec![sphere(16, 8)]);
        assert_eq!(ply.polygons.iter().filter(|p| p.len() == 3).count(), 32);
        assert_eq!(ply.polygons.len(), 128);
    }

    #[test]
    fn a_polygon_of_many_corners_widens_the_count() {
        let ring = |count: u32| {
            let point = |k: u32| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            };
            Mesh::new((0..count).map(point).collect(), [(0..count).collect::<Vec<u32>>()]).unwrap()
        };
        let (narrow, wide) = (written(vec![ring(255)]), written(vec![ring(256)]));
        assert!(narrow.header.contains("list uchar int") && wide.header.contains("list uint int"));
        assert_eq!((narrow.polygons[0].len(), wide.polygons[0].len()), (255, 256));
    }

    #[test]
    fn bytes_repeat_and_curves_are_left_out() {
        let scene = mixed_scene();
        assert_eq!(write(&scene).unwrap(), write(&scene).unwrap());
        assert_eq!(read_back(&write(&scene).unwrap()).polygons.len(), 128 + 6);
    }

    #[test]
    fn scenes_without_meshes_are_refused() {
        let curves = Scene { meshes: vec![], curves: mixed_scene().curves };
        assert_eq!(write(&curves), Err(WriteError::NoMesh { format: "PLY" }));
        assert_eq!(write(&Scene::default()), Err(WriteError::NothingToWrite));
        let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, 1e200 * DVec3::Y], [[0, 1, 2]]).unwrap();
        let scene = Scene { meshes: vec![item("huge", mesh)], curves: vec![] };
        assert_eq!(write(&scene), Err(WriteError::OutOfRange { name: "huge".to_owned(), what: "vertex", index: 2 }));
    }
}
