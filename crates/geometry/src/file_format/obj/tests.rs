use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::file_format::sample::{cuboid, cuboid_with_attributes, item, mixed_scene, sphere};
use crate::file_format::{ReadError, WriteError};
use crate::mesh::{FaceNames, Mesh};
use crate::scene::Scene;

fn scene_of(mesh: Mesh) -> Scene {
    let name = mesh.name().to_owned();
    Scene { meshes: vec![item(&name, mesh)], curves: vec![] }
}

fn text_of(scene: &Scene, library: Option<&str>) -> String {
    String::from_utf8(write(scene, library).unwrap()).unwrap()
}

fn refusal(text: &str) -> String {
    read(text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn a_quad_with_everything_is_written_as_expected() {
    let mesh =
        Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.1, 0.0), -0.0 * DVec3::X + DVec3::Y], [[0, 1, 2, 3]])
            .unwrap()
            .with_normals(vec![DVec3::Z; 4])
            .unwrap()
            .with_uvs(vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::ZERO])
            .unwrap()
            .named("left sleeve");
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(
        text_of(&scene_of(mesh), Some("hero.mtl")),
        format!(
            "# Maquette {version}, metres, +Y up\nmtllib hero.mtl\no left_sleeve\n\
             v 0 0 0\nv 1 0 0\nv 1 0.1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl clay\n\
             f 1/1/1 2/2/1 3/3/1 4/1/1\n"
        )
    );
}

#[test]
fn meshes_come_back_exactly_with_their_quads() {
    let scene = Scene { meshes: vec![item("box", cuboid_with_attributes()), item("bare", cuboid())], curves: vec![] };
    let meshes = read(&write(&scene, None).unwrap()).unwrap();
    assert_eq!(meshes, [cuboid_with_attributes().named("box"), cuboid().named("bare")]);
}

#[test]
fn poles_become_triangles() {
    let meshes = read(&write(&scene_of(sphere(16, 8)), None).unwrap()).unwrap();
    let counts = |corners| meshes[0].polygons().filter(|polygon| polygon.len() == corners).count();
    assert_eq!((counts(3), counts(4)), (32, 96));
    assert!(crate::mesh::Topology::new(&meshes[0]).is_closed());
}

#[test]
fn another_reader_finds_the_same() {
    let bytes = write(&mixed_scene(), Some("a.mtl")).unwrap();
    let options = tobj::LoadOptions { ignore_lines: true, ..tobj::LoadOptions::default() };
    let library = material_library_bytes(&mixed_scene()).unwrap();
    let (models, materials) =
        tobj::load_obj_buf(&mut &bytes[..], &options, |_| tobj::load_mtl_buf(&mut &library[..])).unwrap();
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    assert_eq!(names[..2], ["ball", "crate,_wooden_\"A\""]);
    let ball = &models[0].mesh;
    assert_eq!((ball.positions.len() / 3, ball.face_arities.len()), (16 * 7 + 2, 128));
    assert_eq!((ball.normals.len() / 3, ball.normal_indices.len()), (16 * 7 + 2, 96 * 4 + 32 * 3));
    assert_eq!(models[1].mesh.face_arities, [4; 6]);
    let materials = materials.unwrap();
    assert_eq!(models.iter().map(|model| model.mesh.material_id).take(2).collect::<Vec<_>>(), [Some(0), Some(1)]);
    assert_eq!((materials[0].name.as_str(), materials[0].diffuse), ("clay", Some([0.8, 0.72, 0.64])));
    assert_eq!((materials[1].name.as_str(), materials[1].dissolve), ("glass", Some(0.25)));
}

#[test]
fn curves_are_lines_and_closed_ones_return() {
    let text = text_of(&Scene { meshes: vec![], curves: mixed_scene().curves }, None);
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with(['v', '#'])).collect();
    assert_eq!(lines, ["o rails", "g open", "l 1 2 3", "g loop", "l 4 5 6 7 4"]);
    assert!(text.contains("\nv 0.1 0.2 0.3\n"));
    assert!(refusal(&text).contains("holds no polygon"));
}

#[test]
fn materials_and_objects_of_one_name_are_told_apart() {
    let mut scene = Scene { meshes: vec![item("box", cuboid()), item("box", cuboid())], curves: vec![] };
    let text = text_of(&scene, Some("a.mtl"));
    for line in ["o box", "o box-2", "usemtl clay", "usemtl clay-2"] {
        assert_eq!(text.lines().filter(|l| *l == line).count(), 1, "{line}");
    }
    let library = String::from_utf8(material_library_bytes(&scene).unwrap()).unwrap();
    assert!(library.contains("newmtl clay\nKd 0.8 0.72 0.64\n") && library.contains("newmtl clay-2\n"), "{library}");
    scene.meshes[1].material.roughness = f64::NAN;
    assert_eq!(material_library_bytes(&scene), Err(WriteError::Material { name: "box".to_owned(), what: "roughness" }));
}

#[test]
fn what_cannot_be_written_is_refused() {
    assert_eq!(write(&Scene::default(), None), Err(WriteError::NothingToWrite));
    assert_eq!(write(&scene_of(Mesh::default()), None), Err(WriteError::EmptyMesh { name: String::new() }));
    for name in ["", "a\nb.mtl"] {
        assert_eq!(write(&scene_of(cuboid()), Some(name)), Err(WriteError::LibraryName { name: name.to_owned() }));
    }
}

#[test]
fn the_many_ways_to_write_a_face_are_read() {
    let text = "# Exported by \u{fc}\n\
        v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nvt 0.5\nvt 0 1 0\nvn 0 0 2\nvn 0 0 0\ns off\n\
        f 1 2 3 4\nf -4 -3 -2\nf 1/1 2/2 3/1\nf 1//1 2//1 3//2\nf 1/1/1 \\\n 2/2/1 \\\n3/1/1\nl 1 2\np 1\n";
    let mesh = &read(text.as_bytes()).unwrap()[0];
    assert_eq!(mesh.name(), "object");
    let polygons: Vec<&[u32]> = mesh.polygons().collect();
    assert_eq!(polygons, [&[0, 1, 2, 3][..], &[0, 1, 2], &[0, 1, 2], &[0, 1, 2], &[0, 1, 2]]);
    assert!(mesh.normals().is_none() && mesh.uvs().is_none(), "not every corner has them");

    let all = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5\nvn 0 0 -2\nvn 0 0 0\nf 1/1/1 2/1/1 3/1/2\n";
    let mesh = &read(all.as_bytes()).unwrap()[0];
    assert_eq!(mesh.normals().unwrap(), [-DVec3::Z, -DVec3::Z, DVec3::Z], "unit length; the polygon's where zero");
    assert_eq!(mesh.uvs().unwrap(), [DVec2::new(0.5, 0.0); 3]);
}

#[test]
fn objects_are_meshes_and_groups_and_materials_are_names_of_faces() {
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\n";
    let names = |text: &str| {
        let meshes = read(format!("{points}{text}").as_bytes()).unwrap();
        let listed = |names: Option<&FaceNames>| names.map(|n| n.iter().collect::<Vec<_>>().join("|"));
        let of = |m: &Mesh| {
            let counts = format!("{}:{}:{}", m.name(), m.positions().len(), m.polygon_count());
            format!("{counts} {:?} {:?}", listed(m.groups()), listed(m.materials()))
        };
        meshes.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(
        names("o left arm\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\no empty\no right\ng hand\nf 2 3 4\n"),
        [r#"left arm:4:2 None Some("a|b")"#, r#"right:3:1 Some("hand") Some("b")"#]
    );
    let one = names("g one\nf 1 2 3\ng\nf 1 2 4\ng two of it\nf 1 3 4\ng one\nf 2 3 4\n");
    assert_eq!(one, [r#"object:4:4 Some("one||two of it|one") None"#]);
    assert_eq!(names("f 1 2 3\nusemtl\nf 1 3 4\n"), ["object:4:2 None None"]);
}

#[test]
fn groups_and_materials_go_back_where_they_came_from() {
    let text = "o hand\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng palm side\nusemtl skin\nf 1 2 3\ng\nf 1 3 4\n\
        usemtl nail polish\nf 2 3 4\ng palm side\nf 1 2 4\n";
    let mesh = read(text.as_bytes()).unwrap().remove(0);
    let scene = scene_of(mesh.clone());
    let written = String::from_utf8(write(&scene, None).unwrap()).unwrap();
    assert_eq!(read(written.as_bytes()).unwrap(), [mesh]);
    let behind = |text: &str| text[text.find("v 0 1 0\n").unwrap()..].to_owned();
    assert_eq!(behind(&written), behind(text), "line by line");
    // The library has a material for each name.
    let library = String::from_utf8(material_library_bytes(&scene).unwrap()).unwrap();
    let named: Vec<&str> = library.lines().filter_map(|line| line.strip_prefix("newmtl ")).collect();
    assert_eq!(named[1..], ["skin", "nail polish"]);
}

#[test]
fn wrong_lines_are_refused_by_number() {
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (text, expected) in [
        ("v 0 0", "line 1: 2 number(s) where 3 are expected"),
        ("\nv 0 zero 0", "line 2: \"zero\" stands where a number is expected"),
        ("vn 1", "line 1: 1 number(s) where 3 are expected"),
        ("vt", "line 1: 0 number(s) where 1 are expected"),
        ("v 0 0 nan", "\"\", line 1: a coordinate is not a finite number"),
        ("o body\nv 0 1e999 0", "\"body\", line 2: a coordinate is not a finite number"),
        ("f 1 2", "line 4: a polygon of 2 corner(s)"),
        ("f", "line 4: a polygon of 0 corner(s)"),
        ("f 1 2 x", "line 4: \"x\" is no corner: expected whole numbers"),
        ("f 1 2 3/1/1/1", "line 4: \"3/1/1/1\" is no corner"),
        ("f 1 2 /3", "line 4: \"/3\" is no corner"),
        ("f 1 2 0", "line 4: \"0\" has index 0: OBJ counts from 1"),
        ("f 1 2 4", "line 4: vertex 4 is used, but the file has only 3"),
        ("f 1 2 -4", "line 4: \"-4\" counts back beyond the first entry"),
        ("f 1/1 2/1 3/1", "line 4: UV 1 is used, but the file has only 0"),
        ("f 1/-5 2 3", "line 4: \"1/-5\" counts back"),
        ("f 1//9223372036854775807 2 3", "line 4: normal 9223372036854775807 is used, but the file has only 0"),
        ("f 1 2 -9223372036854775808", "counts back beyond"),
        ("f 1 2 99999999999999999999", "is no corner: expected whole numbers"),
    ] {
        let text = if text.starts_with('f') { format!("{points}{text}") } else { text.to_owned() };
        let message = refusal(&text);
        assert!(message.contains(expected), "{text:?}: {message}");
    }
}

#[test]
fn what_is_no_obj_is_refused() {
    assert_eq!(read(b""), Err(ReadError::Empty { format: "OBJ" }));
    for bytes in [&b"\0\xff\xfe"[..], b"solid body\nfacet normal", b"# nothing\nv 0 0 0", b"\\"] {
        assert!(matches!(read(bytes), Err(ReadError::Nothing { .. })), "{bytes:?}");
    }
}

prop_compose! {
    fn any_mesh()(
        points in proptest::collection::vec(proptest::array::uniform3(-1e6..1e6_f64), 4..30),
        quads in proptest::collection::vec(proptest::collection::vec(any::<prop::sample::Index>(), 3..7), 1..20),
    ) -> Mesh {
        let count = points.len();
        // A step through all vertices, so that no polygon repeats one and all are used.
        let mut polygons: Vec<Vec<u32>> = quads
            .iter()
            .map(|polygon| {
                let mut corners: Vec<u32> = polygon.iter().map(|index| index.index(count) as u32).collect();
                corners.sort_unstable();
                corners.dedup();
                if corners.len() < 3 { vec![0, 1, 2] } else { corners }
            })
            .collect();
        polygons.push((0..count as u32).collect());
        Mesh::new(points.into_iter().map(DVec3::from).collect(), polygons).unwrap().named("any")
    }
}

proptest! {
    #[test]
    fn any_mesh_comes_back_exactly(mesh in any_mesh()) {
        prop_assert_eq!(read(&write(&scene_of(mesh.clone()), None).unwrap()).unwrap(), vec![mesh]);
    }

    #[test]
    fn random_text_never_panics(text in "([vf][tn]? ?|[-0-9/. ]{1,6}|\n|o x|\\\\|nan){0,60}", bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
        for bytes in [text.as_bytes(), &bytes] {
            if let Ok(meshes) = read(bytes) {
                prop_assert!(!meshes.is_empty());
            }
        }
    }
}
