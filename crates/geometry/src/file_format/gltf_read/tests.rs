use base64::Engine as _;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;
use crate::file_format::gltf_write;
use crate::file_format::sample::{cuboid, cuboid_with_attributes, item, mixed_scene, sphere};
use crate::mesh::{measure, topology::Topology};
use crate::scene::Scene;

/// A document with one buffer: the positions of a tetrahedron, then `tail`.
fn document(tail: &[u8]) -> Value {
    let points: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend_from_slice(tail);
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "body", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}")}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": tail.len()}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5121, "count": tail.len(), "type": "SCALAR"}
        ]
    })
}

const FACES: [u8; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

fn tetrahedron() -> Value {
    document(&FACES)
}

fn open(document: &Value) -> Result<Vec<Mesh>, ReadError> {
    read(document.to_string().as_bytes())
}

fn one(document: &Value) -> Mesh {
    let mut meshes = open(document).unwrap();
    assert_eq!(meshes.len(), 1);
    meshes.remove(0)
}

/// The message of the refusal after `path` of the document was set to `value`.
fn refusal(path: &str, value: Value) -> String {
    let mut document = tetrahedron();
    let (parent, key) = path.rsplit_once('/').unwrap();
    document.pointer_mut(parent).unwrap()[key] = value;
    open(&document).unwrap_err().to_string()
}

#[test]
fn what_was_written_comes_back() {
    for file in [gltf_write::glb, gltf_write::gltf] {
        let scene =
            Scene { meshes: vec![item("box", cuboid_with_attributes()), item("ball", sphere(24, 12))], curves: vec![] };
        let meshes = read(&file(&scene).unwrap()).unwrap();
        assert_eq!(meshes.iter().map(Mesh::name).collect::<Vec<_>>(), ["box", "ball"]);

        let cuboid = &meshes[0];
        assert_eq!((cuboid.positions().len(), cuboid.polygon_count()), (8, 12), "welded back, in triangles");
        assert!(Topology::new(cuboid).is_closed());
        assert_eq!(measure::signed_volume(cuboid), 6.0);
        assert!(cuboid.uvs().unwrap().iter().all(|uv| [0.0, 1.0].contains(&uv.x) && [0.0, 0.75].contains(&uv.y)));
        for polygon in 0..12 {
            let own = measure::polygon_normal(cuboid, polygon);
            for corner in cuboid.corner_range(polygon) {
                assert_eq!(cuboid.normals().unwrap()[corner], own);
            }
        }

        let ball = &meshes[1];
        assert_eq!(ball.positions().len(), sphere(24, 12).positions().len(), "the seam and the poles are closed again");
        assert!(Topology::new(ball).is_closed());
        for (corner, normal) in ball.normals().unwrap().iter().enumerate() {
            assert!(normal.distance(ball.positions()[ball.corners()[corner] as usize]) < 2e-7);
        }
    }
}

#[test]
fn curves_beside_meshes_are_no_meshes() {
    let meshes = read(&gltf_write::glb(&mixed_scene()).unwrap()).unwrap();
    assert_eq!(meshes.iter().map(Mesh::name).collect::<Vec<_>>(), ["ball", "crate, wooden \"A\""]);
    let scene = Scene { curves: mixed_scene().curves, meshes: vec![] };
    let message = read(&gltf_write::glb(&scene).unwrap()).unwrap_err().to_string();
    assert!(message.contains("holds no triangle: export meshes"), "{message}");
}

#[test]
fn lists_strips_and_fans_give_their_triangles() {
    let square = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let cases = [
        (4, vec![0, 1, 2, 1, 3, 2], vec![[0, 1, 2], [1, 3, 2]]),
        (5, vec![0, 1, 2, 3], vec![[0, 1, 2], [1, 3, 2]]),
        (6, vec![0, 1, 2, 3], vec![[1, 2, 0], [2, 3, 0]]),
    ];
    for (mode, indices, expected) in cases {
        let mut document = document(&indices);
        document["meshes"][0]["primitives"][0]["mode"] = mode.into();
        let mesh = one(&document);
        let triangles: Vec<Vec<DVec3>> =
            mesh.polygons().map(|p| p.iter().map(|&v| mesh.positions()[v as usize]).collect()).collect();
        let expected: Vec<Vec<DVec3>> =
            expected.iter().map(|t| t.iter().map(|&v: &usize| square[v]).collect()).collect();
        assert_eq!(triangles, expected, "mode {mode}");
    }
}

#[test]
fn positions_without_indices_are_a_list() {
    let mut document = tetrahedron();
    document["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    document["accessors"][0]["count"] = 3.into();
    assert_eq!(one(&document).polygon_count(), 1);
}

#[test]
fn nodes_place_their_meshes_and_mirrors_keep_the_outside() {
    let mut document = tetrahedron();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    document["nodes"] = json!([
        {"children": [1, 2], "translation": [10, 0, 0]},
        {"name": "turned", "mesh": 0, "rotation": [0, 0, half, half], "scale": [2, 1, 1]},
        {"name": "mirrored", "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1]}
    ]);
    let meshes = open(&document).unwrap();
    assert_eq!(meshes.iter().map(Mesh::name).collect::<Vec<_>>(), ["turned", "mirrored"]);
    let (low, high) = measure::bounds(&meshes[0]).unwrap();
    assert!(low.distance(DVec3::new(9.0, 0.0, 0.0)) < 1e-6 && high.distance(DVec3::new(10.0, 2.0, 1.0)) < 1e-6);
    assert!((measure::signed_volume(&meshes[0]) - 1.0 / 3.0).abs() < 1e-6);
    let (low, high) = measure::bounds(&meshes[1]).unwrap();
    assert_eq!((low, high), (DVec3::new(9.0, 5.0, 0.0), DVec3::new(10.0, 6.0, 1.0)));
    assert!((measure::signed_volume(&meshes[1]) - 1.0 / 6.0).abs() < 1e-12);
}

#[test]
fn normals_follow_a_mirror_and_a_stretch() {
    let scene = Scene { meshes: vec![item("ball", sphere(24, 12))], curves: vec![] };
    let text = gltf_write::gltf(&scene).unwrap();
    let mut document: Value = serde_json::from_slice(&text).unwrap();
    document["nodes"][0]["scale"] = json!([-3, 1, 0.5]);
    let mesh = one(&document);
    for (corner, normal) in mesh.normals().unwrap().iter().enumerate() {
        let p = mesh.positions()[mesh.corners()[corner] as usize];
        let exact = DVec3::new(p.x / 9.0, p.y, p.z / 0.25).normalize();
        assert!(normal.distance(exact) < 1e-6, "{normal} {exact}");
    }
    assert!(measure::signed_volume(&mesh) > 0.0);
}

#[test]
fn a_skinned_mesh_ignores_its_node() {
    let mut document = tetrahedron();
    document["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [5, 5, 5]}]);
    document["skins"] = json!([{"joints": [0]}]);
    assert_eq!(measure::bounds(&one(&document)).unwrap().0, DVec3::ZERO);
}

#[test]
fn without_a_scene_all_roots_are_shown_and_names_fall_back() {
    let mut document = tetrahedron();
    document["nodes"] = json!([{"mesh": 0, "name": "child"}, {"children": [0]}, {"mesh": 0}]);
    document.as_object_mut().unwrap().remove("scene");
    document.as_object_mut().unwrap().remove("scenes");
    let names: Vec<String> = open(&document).unwrap().iter().map(|m| m.name().to_owned()).collect();
    assert_eq!(names, ["child", "mesh 0"]);
}

#[test]
fn primitives_join_and_keep_only_shared_attributes() {
    let mut document = tetrahedron();
    document["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1},
        {"attributes": {"POSITION": 0}, "indices": 1},
        {"attributes": {"POSITION": 0}, "mode": 0}
    ]);
    let mesh = one(&document);
    assert_eq!((mesh.positions().len(), mesh.polygon_count()), (4, 8));
    assert!(mesh.normals().is_none());
}

#[test]
fn bytes_stand_for_uvs_where_they_are_normalised() {
    let mut tail = FACES.to_vec();
    tail.extend([0, 0, 255, 0, 0, 255, 51, 102]);
    let mut document = document(&tail);
    document["bufferViews"][1]["byteLength"] = 12.into();
    document["accessors"][1]["count"] = 12.into();
    document["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 0, "byteOffset": 60, "byteLength": 8}));
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"bufferView": 2, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"}));
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2.into();
    let mesh = one(&document);
    let uvs = mesh.uvs().unwrap();
    assert_eq!(uvs[..3], [DVec2::new(0.0, 1.0), DVec2::new(0.0, 0.0), DVec2::new(1.0, 1.0)]);
    assert!(uvs[5].distance(DVec2::new(0.2, 0.6)) < 1e-7);
}

#[test]
fn other_files_compression_and_versions_are_refused_with_a_remedy() {
    let message = refusal("/buffers/0/uri", "body.bin".into());
    assert_eq!(
        message,
        "buffer 0 of the glTF lies in another file, \"body.bin\": export as .glb, which holds everything"
    );
    for (path, value, expected) in [
        (
            "/accessors/0/sparse",
            json!({"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 0}}),
            "sparse",
        ),
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            "KHR_draco_mesh_compression, which is not supported: export without",
        ),
        ("/asset/version", "1.0".into(), "version \"1.0\", which is not supported: export as glTF 2.0"),
    ] {
        let message = refusal(path, value);
        assert!(message.contains(expected), "{message}");
    }
    let mut document = tetrahedron();
    document["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let message = open(&document).unwrap_err().to_string();
    assert!(message.contains("export uncompressed"), "{message}");
    let mut document = tetrahedron();
    document["extensionsRequired"] = json!(["KHR_materials_unlit"]);
    assert!(open(&document).is_ok(), "looks are not needed for geometry");
}

#[test]
fn indices_and_lengths_beyond_the_file_are_refused_with_their_place() {
    for (path, value, expected) in [
        ("/scene", json!(7), "default scene 7 is not there"),
        ("/scenes/0/nodes", json!([9]), "node 9"),
        ("/nodes/0/mesh", json!(3), "mesh 3 is not there"),
        ("/nodes/0/children", json!([0]), "its own ancestor"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(99), "accessor 99"),
        ("/meshes/0/primitives/0/indices", json!(4_294_967_295_u32), "accessor 4294967295"),
        ("/meshes/0/primitives/0/indices", json!(0), "does not suit its use"),
        ("/meshes/0/primitives/0/mode", json!(8), "mode"),
        ("/meshes/0/primitives/0/attributes", json!({}), "no POSITION"),
        ("/accessors/0/bufferView", json!(5), "buffer view 5 is not there"),
        ("/accessors/0/count", json!(2), "triangle 0 uses vertex 2, but there are only 2"),
        ("/accessors/0/count", json!(0), "there are none"),
        ("/accessors/0/count", json!(18_446_744_073_709_551_615_u64), "do not fit"),
        ("/accessors/0/byteOffset", json!(18_446_744_073_709_551_615_u64), "do not fit"),
        ("/accessors/0/componentType", json!(1), "none that glTF knows"),
        ("/accessors/0/type", json!("VEC2"), "does not suit its use"),
        ("/accessors/1/count", json!(11), "whole triangles"),
        ("/bufferViews/0/byteStride", json!(4), "stride of 4"),
        ("/bufferViews/0/byteLength", json!(18_446_744_073_709_551_615_u64), "larger than the buffer"),
        ("/bufferViews/0/buffer", json!(1), "buffer 1 is not there"),
        ("/buffers/0/byteLength", json!(4_000_000_000_u32), "4000000000 bytes announced"),
        ("/buffers/0/uri", json!("data:application/octet-stream;base64,%%%"), "not base64"),
        ("/buffers/0/uri", json!(null), "it has no data"),
    ] {
        let message = refusal(path, value.clone());
        assert!(message.contains(expected), "{path} = {value}: {message}");
    }
}

#[test]
fn a_position_that_is_no_number_is_refused_with_its_index() {
    let mut bytes = gltf_write::glb(&Scene { meshes: vec![item("box", cuboid())], curves: vec![] }).unwrap();
    let json = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let vertex_3 = 28 + json + 3 * 12;
    bytes[vertex_3 + 4..vertex_3 + 8].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        read(&bytes),
        Err(ReadError::NotFinite { format: "glTF", name: "box".to_owned(), what: "vertex", index: 3 })
    );
}

#[test]
fn one_large_mesh_shown_by_many_nodes_is_refused_before_it_is_built() {
    let mut document = document(&[0; 30_000]);
    document["nodes"] = json!(vec![json!({"mesh": 0}); 4_000]);
    document["scenes"][0]["nodes"] = json!((0..4_000).collect::<Vec<_>>());
    // 4000 x 30000 indices; all triangles are flat, so that only the limit can stop it.
    let message = open(&document).unwrap_err().to_string();
    assert!(message.contains("indices and vertices in a file of"), "{message}");
}

#[test]
fn bytes_that_are_no_gltf_are_refused() {
    assert_eq!(read(b""), Err(ReadError::Empty { format: "glTF" }));
    for bytes in [&b"{"[..], b"[]", b"null", b"\xff\xfe\x00", b"glTF", b"glTF\x02\0\0\0\x04\0\0\0", b"{\"asset\":{}}"] {
        assert!(matches!(read(bytes), Err(ReadError::Malformed { .. })), "{bytes:?}");
    }
    assert!(matches!(read(b"glTF\x01\0\0\0\x14\0\0\0"), Err(ReadError::Unsupported { .. })));
    let deep = "[".repeat(100_000);
    assert!(matches!(read(deep.as_bytes()), Err(ReadError::Malformed { .. })));
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    let bytes = gltf_write::glb(&mixed_scene()).unwrap();
    for length in 0..bytes.len() {
        assert!(read(&bytes[..length]).is_err(), "{length} of {}", bytes.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200), binary in any::<bool>()) {
        let bytes = if binary { [&b"glTF\x02\0\0\0"[..], &bytes].concat() } else { bytes };
        prop_assert!(read(&bytes).is_err());
    }

    #[test]
    fn damaged_files_never_panic(places in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut bytes = tetrahedron().to_string().into_bytes();
        for (place, byte) in places {
            let at = place.index(bytes.len());
            // Digits do more harm than letters, which only break the JSON.
            bytes[at] = if bytes[at].is_ascii_digit() { b'0' + byte % 10 } else { bytes[at] };
        }
        if let Ok(meshes) = read(&bytes) {
            prop_assert!(meshes.iter().all(|mesh| mesh.polygon_count() > 0));
        }
    }
}
