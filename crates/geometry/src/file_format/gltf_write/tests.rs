//! What is written is read back with the `gltf` crate, whose reader shares no code with the writer.

use glam::{DVec2, DVec3};
use gltf::mesh::Mode;

use super::*;
use crate::curve::Curve;
use crate::file_format::sample::{cuboid, cuboid_with_attributes, item, mixed_scene, sphere};
use crate::scene;

fn scene_of(mesh: crate::mesh::Mesh) -> Scene {
    Scene { meshes: vec![item("output", mesh)], curves: vec![] }
}

struct ReadBack {
    gltf: gltf::Gltf,
}

impl ReadBack {
    fn of(scene: &Scene) -> Self {
        Self { gltf: gltf::Gltf::from_slice(&glb(scene).unwrap()).unwrap() }
    }

    fn primitive(&self, mesh: usize, index: usize) -> gltf::Primitive<'_> {
        self.gltf.meshes().nth(mesh).unwrap().primitives().nth(index).unwrap()
    }

    fn positions(&self, primitive: &gltf::Primitive) -> Vec<[f32; 3]> {
        primitive.reader(|_| self.gltf.blob.as_deref()).read_positions().unwrap().collect()
    }

    fn normals(&self, primitive: &gltf::Primitive) -> Option<Vec<[f32; 3]>> {
        primitive.reader(|_| self.gltf.blob.as_deref()).read_normals().map(Iterator::collect)
    }

    fn uvs(&self, primitive: &gltf::Primitive) -> Option<Vec<[f32; 2]>> {
        primitive.reader(|_| self.gltf.blob.as_deref()).read_tex_coords(0).map(|uvs| uvs.into_f32().collect())
    }

    fn indices(&self, primitive: &gltf::Primitive) -> Vec<u32> {
        primitive.reader(|_| self.gltf.blob.as_deref()).read_indices().unwrap().into_u32().collect()
    }
}

#[test]
fn the_container_counts_its_bytes_and_pads_its_chunks() {
    let bytes = glb(&mixed_scene()).unwrap();
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[..4], b"glTF");
    assert_eq!((number(4), number(8)), (2, bytes.len()));
    let json = number(12);
    assert_eq!((json % 4, &bytes[16..20]), (0, &b"JSON"[..]));
    let binary = number(20 + json);
    assert_eq!((binary % 4, &bytes[24 + json..28 + json]), (0, &b"BIN\0"[..]));
    assert_eq!(28 + json + binary, bytes.len());
}

#[test]
fn corners_weld_where_all_attributes_agree_and_only_there() {
    let read = ReadBack::of(&scene_of(cuboid_with_attributes()));
    let primitive = read.primitive(0, 0);
    let positions = read.positions(&primitive);
    assert_eq!(positions.len(), 24, "three normals at each of 8 vertices");
    assert_eq!(read.indices(&primitive).len(), 36);
    let bounds = primitive.bounding_box();
    assert_eq!((bounds.min, bounds.max), ([0.0; 3], [1.0, 2.0, 3.0]));

    let bare = ReadBack::of(&scene_of(cuboid()));
    let primitive = bare.primitive(0, 0);
    assert_eq!(bare.positions(&primitive).len(), 8);
    assert!(bare.normals(&primitive).is_none() && bare.uvs(&primitive).is_none());
}

#[test]
fn triangles_keep_their_outside_and_their_corners_attributes() {
    let mesh = cuboid_with_attributes();
    let read = ReadBack::of(&scene_of(mesh));
    let primitive = read.primitive(0, 0);
    let (positions, indices) = (read.positions(&primitive), read.indices(&primitive));
    let (normals, uvs) = (read.normals(&primitive).unwrap(), read.uvs(&primitive).unwrap());
    let mut volume = 0.0;
    for triangle in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| glam::Vec3::from(positions[triangle[k] as usize]));
        volume += a.cross(b).dot(c) / 6.0;
        let own = (b - a).cross(c - a).normalize();
        for &vertex in triangle {
            assert!(own.dot(normals[vertex as usize].into()) > 0.999_999);
        }
    }
    assert!((volume - 6.0).abs() < 1e-6, "{volume}");
    // v of 0 and 0.75, counted from the top.
    assert!(uvs.iter().all(|uv| [0.0, 1.0].contains(&uv[0]) && [1.0, 0.25].contains(&uv[1])));
}

#[test]
fn poles_lose_their_flat_triangles_and_seams_their_welds() {
    let (around, along) = (16, 8);
    let read = ReadBack::of(&scene_of(sphere(around, along)));
    let primitive = read.primitive(0, 0);
    let indices = read.indices(&primitive);
    assert_eq!(indices.len() / 3, 2 * around * (along - 2) + 2 * around);
    assert_eq!(read.positions(&primitive).len(), (along - 1) * (around + 1) + 2 * around);
    for normal in read.normals(&primitive).unwrap() {
        assert!((glam::Vec3::from(normal).length() - 1.0).abs() < 2e-7);
    }
}

#[test]
fn quads_are_split_along_the_shorter_diagonal() {
    let positions = vec![DVec3::ZERO, DVec3::new(2.0, 0.5, 0.0), DVec3::new(3.0, 3.0, 0.0), DVec3::new(0.5, 2.0, 0.0)];
    let mesh = crate::mesh::Mesh::new(positions, [[0, 1, 2, 3]]).unwrap();
    let read = ReadBack::of(&scene_of(mesh));
    let primitive = read.primitive(0, 0);
    let positions = read.positions(&primitive);
    let both = [[2.0, 0.5, 0.0], [0.5, 2.0, 0.0]];
    for triangle in read.indices(&primitive).chunks_exact(3) {
        let ends = triangle.iter().filter(|&&vertex| both.contains(&positions[vertex as usize])).count();
        assert_eq!(ends, 2);
    }
}

#[test]
fn indices_are_narrow_up_to_65535_vertices() {
    for (triangles, kind) in [(21_845_u32, gltf::accessor::DataType::U16), (21_846, gltf::accessor::DataType::U32)] {
        let positions = (0..3 * triangles).map(|i| DVec3::new(f64::from(i), f64::from(i % 3 % 2), 0.0)).collect();
        let mesh = crate::mesh::Mesh::new(positions, (0..triangles).map(|t| [3 * t, 3 * t + 1, 3 * t + 2])).unwrap();
        let read = ReadBack::of(&scene_of(mesh));
        let primitive = read.primitive(0, 0);
        assert_eq!(primitive.indices().unwrap().data_type(), kind);
        assert!(read.indices(&primitive).into_iter().eq(0..3 * triangles));
    }
}

#[test]
fn names_materials_and_modes_come_through() {
    let mut scene = mixed_scene();
    scene.meshes.push(item("", sphere(6, 4)));
    let read = ReadBack::of(&scene);
    let names: Vec<_> = read.gltf.nodes().map(|node| node.name().unwrap().to_owned()).collect();
    assert_eq!(names, ["ball", "crate, wooden \"A\"", "sphere", "rails"]);
    assert!(read.gltf.nodes().all(|node| node.name() == node.mesh().unwrap().name()));
    let materials: Vec<_> = read.gltf.materials().map(|m| m.name().unwrap().to_owned()).collect();
    assert_eq!(materials, ["clay", "glass", "clay-2", "rails"]);

    let clay = read.primitive(0, 0).material();
    let [r, g, b, a] = clay.pbr_metallic_roughness().base_color_factor();
    // 0.80, 0.72, 0.64 by the formula of IEC 61966-2-1.
    for (found, expected) in [(r, 0.603_827), (g, 0.477), (b, 0.367_246), (a, 1.0)] {
        assert!((found - expected).abs() < 2e-6, "{found} {expected}");
    }
    assert!((clay.pbr_metallic_roughness().roughness_factor() - 0.7).abs() < 1e-7);
    assert!(clay.pbr_metallic_roughness().metallic_factor() == 0.0 && !clay.double_sided());
    let glass = read.primitive(1, 0).material();
    assert_eq!(glass.alpha_mode(), gltf::material::AlphaMode::Blend);
    assert!(glass.double_sided() && glass.pbr_metallic_roughness().base_color_factor()[3] == 0.25);

    let curves = read.gltf.meshes().nth(3).unwrap();
    let modes: Vec<Mode> = curves.primitives().map(|p| p.mode()).collect();
    assert_eq!(modes, [Mode::LineStrip, Mode::LineLoop]);
    assert_eq!(read.positions(&read.primitive(3, 0)), [[0.0; 3], [0.1, 0.2, 0.3], [0.0, 1.0, 0.0]]);
    assert_eq!(read.positions(&read.primitive(3, 1)).len(), 4);
    let json = read.gltf.document.as_json();
    assert_eq!(json.extensions_used, ["KHR_materials_unlit"]);
    assert!(json.materials[3].extensions.as_ref().unwrap().unlit.is_some());
    assert_eq!(json.asset.generator.as_deref(), Some(concat!("Maquette ", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn views_are_aligned_and_have_targets() {
    let read = ReadBack::of(&mixed_scene());
    for view in read.gltf.views() {
        assert_eq!(view.offset() % 4, 0);
        assert!(view.target().is_some());
        assert!(view.stride().is_none_or(|stride| stride % 4 == 0));
    }
}

#[test]
fn one_file_holds_the_same_document_and_bytes_repeat() {
    let scene = mixed_scene();
    let text = gltf(&scene).unwrap();
    let embedded = gltf::Gltf::from_slice(&text).unwrap();
    let gltf::buffer::Source::Uri(uri) = embedded.buffers().next().unwrap().source() else { panic!("no uri") };
    let data = uri.strip_prefix("data:application/octet-stream;base64,").unwrap();
    let data = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let binary = ReadBack::of(&scene).gltf.blob.unwrap();
    assert_eq!(data, binary[..data.len()]);
    assert_eq!(data.len(), embedded.buffers().next().unwrap().length());
    for _ in 0..3 {
        assert_eq!(gltf(&scene).unwrap(), text);
    }
    assert_eq!(glb(&scene).unwrap(), glb(&scene.clone()).unwrap());
}

#[test]
fn a_zero_normal_becomes_that_of_the_polygon() {
    let mesh = cuboid().with_normals(vec![DVec3::ZERO; 24]).unwrap();
    let read = ReadBack::of(&scene_of(mesh));
    let normals = read.normals(&read.primitive(0, 0)).unwrap();
    assert_eq!(normals.len(), 24);
    assert!(normals.iter().all(|n| (glam::Vec3::from(*n).length() - 1.0).abs() < 2e-7));
}

#[test]
fn empty_scenes_and_outputs_are_refused_by_name() {
    assert_eq!(glb(&Scene::default()), Err(WriteError::NothingToWrite));
    let empty = scene_of(crate::mesh::Mesh::default());
    assert_eq!(glb(&empty), Err(WriteError::EmptyMesh { name: "output".to_owned() }));
    let flat = crate::mesh::Mesh::new(vec![DVec3::ZERO, DVec3::X], [[0, 1, 1], [0, 0, 1]]).unwrap();
    assert_eq!(gltf(&scene_of(flat)), Err(WriteError::EmptyMesh { name: "output".to_owned() }));
    let curves = scene::CurveItem { name: "rails".to_owned(), curves: vec![], colour: [0.0; 4] };
    let scene = Scene { meshes: vec![], curves: vec![curves] };
    assert_eq!(glb(&scene), Err(WriteError::NoCurves { name: "rails".to_owned() }));
}

#[test]
fn numbers_that_do_not_fit_are_refused_with_their_place() {
    let mesh = crate::mesh::Mesh::new(vec![DVec3::ZERO, DVec3::X, 1e39 * DVec3::Y], [[0, 1, 2]]).unwrap();
    let out_of_range = |what, index| Err(WriteError::OutOfRange { name: "output".to_owned(), what, index });
    assert_eq!(glb(&scene_of(mesh)), out_of_range("vertex", 2));
    let mesh = cuboid().with_uvs((0..24).map(|i| DVec2::new(if i == 5 { 1e300 } else { 0.0 }, 0.0)).collect()).unwrap();
    assert_eq!(glb(&scene_of(mesh)), out_of_range("UV of corner", 5));
    let curve = Curve::new("", vec![DVec3::ZERO, 1e200 * DVec3::X], false).unwrap();
    let output = scene::CurveItem { name: "output".to_owned(), curves: vec![curve], colour: [0.0; 4] };
    assert_eq!(glb(&Scene { meshes: vec![], curves: vec![output] }), out_of_range("point", 1));
}

#[test]
fn materials_are_brought_into_range_or_refused() {
    let mut scene = scene_of(cuboid());
    scene.meshes[0].material.colour = [2.0, -1.0, 0.0, 1.0];
    scene.meshes[0].material.roughness = 7.0;
    let read = ReadBack::of(&scene);
    let material = read.primitive(0, 0).material();
    assert_eq!(material.pbr_metallic_roughness().base_color_factor(), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(material.pbr_metallic_roughness().roughness_factor(), 1.0);

    scene.meshes[0].material.metallic = f64::NAN;
    assert_eq!(glb(&scene), Err(WriteError::Material { name: "output".to_owned(), what: "metallic" }));
    scene.meshes[0].material.colour[1] = f64::INFINITY;
    assert_eq!(glb(&scene), Err(WriteError::Material { name: "output".to_owned(), what: "colour" }));
}
