//! No bytes make a reader of meshes or curves panic, hang, or take more memory than 100 MB and a multiple of the file.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

#[path = "../../../tests/fuzz/mod.rs"]
mod fuzz;

use std::fmt::Write as _;
use std::path::Path;

use fuzz::Subject;
use glam::DVec3;
use maquette_geometry::file_format::picture::{self, Channel};
use maquette_geometry::file_format::{ReadError, curves_json, gltf_read, gltf_write, obj, svg};
use maquette_geometry::mesh::Mesh;
use maquette_geometry::outline::{Keep, Tracing, trace};
use maquette_geometry::scene::{Material, MeshItem, Scene};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// A byte of text becomes an entry of a tree: `{},` is a node of glTF, `[],` a list of JSON.
fn memory(length: usize) -> usize {
    100_000_000 + 300 * length
}

fn said<T>(result: Result<T, ReadError>) -> Option<T> {
    result.map_err(|error| assert!(!error.to_string().is_empty())).ok()
}

fn sound(meshes: &[Mesh]) {
    for mesh in meshes {
        let count = mesh.positions().len();
        assert!(mesh.positions().iter().all(|p| p.is_finite()));
        for polygon in 0..mesh.polygon_count() {
            assert!(mesh.polygon(polygon).iter().all(|corner| (*corner as usize) < count));
        }
    }
}

fn read_gltf(input: &[u8]) {
    sound(&said(gltf_read::read(input)).unwrap_or_default());
}

fn read_obj(input: &[u8]) {
    sound(&said(obj::read(input)).unwrap_or_default());
}

fn read_svg(input: &[u8]) {
    for path in said(svg::read(input, 0.1)).unwrap_or_default() {
        assert!(path.points.len() > 1 && path.points.iter().all(|p| p.is_finite()));
    }
}

fn read_curves(input: &[u8]) {
    if let Some(curves) = said(curves_json::read(input)) {
        // What was read is written and read back.
        let again = curves_json::read(&curves_json::write(&curves)).unwrap();
        assert_eq!(again.len(), curves.len());
    }
}

fn read_picture(input: &[u8]) {
    for channel in [Channel::Dark, Channel::Alpha] {
        match picture::read(input, channel) {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(mask) => {
                assert_eq!(mask.values().len(), mask.width() * mask.height());
                for outline in trace(&mask, &Tracing { keep: Keep::All, ..Tracing::default() }).unwrap_or_default() {
                    assert!(outline.curve.is_closed() && outline.area >= 16.0);
                }
            }
        }
    }
}

fn scene() -> Scene {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]].map(DVec3::from);
    let mesh = Mesh::new(corners.to_vec(), [[0_u32, 1, 2], [0, 2, 3]]).unwrap();
    let mesh = mesh.with_normals(vec![DVec3::Z; 6]).unwrap();
    Scene { meshes: vec![MeshItem { name: "two".to_owned(), mesh, material: Material::default() }], curves: Vec::new() }
}

const GLTF_WORDS: [&str; 40] = [
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "null",
    "true",
    "{},",
    "[],",
    "\"nodes\":",
    "\"meshes\":",
    "\"children\":[0]",
    "\"mesh\":0",
    "\"scene\":0",
    "\"scenes\":",
    "\"matrix\":[",
    "\"scale\":[1e38,0,0]",
    "\"accessors\":",
    "\"count\":",
    "\"bufferView\":",
    "\"byteOffset\":",
    "\"byteLength\":",
    "\"byteStride\":",
    "\"componentType\":5121",
    "\"componentType\":5125",
    "\"type\":\"VEC3\"",
    "\"type\":\"SCALAR\"",
    "\"indices\":",
    "\"mode\":5",
    "\"mode\":6",
    "\"sparse\":{",
    "\"uri\":\"data:;base64,\"",
    "\"uri\":\"../x\"",
    "\"extensionsRequired\":[",
    "\"normalized\":true",
    "\u{0}",
    "glTF",
    "BIN\u{0}",
];

const OBJ_WORDS: [&str; 26] = [
    "v ",
    "vt ",
    "vn ",
    "f ",
    "o ",
    "g ",
    "s ",
    "usemtl ",
    "mtllib ",
    "\n",
    "\\\n",
    "\\",
    "#",
    " ",
    "/",
    "//",
    "1/1/1",
    "-1",
    "-1/-1/-1",
    "0",
    "v 0 0 0\n",
    "vn 0 0 0\n",
    "f 1 2 3\n",
    "f 1//1 2//1 3//1\n",
    "\r\n",
    "\u{2028}",
];

const SVG_WORDS: [&str; 44] = [
    "<svg>",
    "</svg>",
    "<g>",
    "</g>",
    "<g transform=\"",
    "scale(0)",
    "scale(1e30)",
    "rotate(30)",
    "matrix(1 0 0 1 0 0)",
    "<path d=\"",
    "M0 0",
    "L1 1",
    "C 0 0 1 1 2 2",
    "c",
    "Q 1 1 2 0",
    "A 1 1 0 0 1 5 5",
    "a1e9 1e9 0 1 1 1 1",
    "Z",
    "z",
    "h1",
    "v1",
    "\"/>",
    "id=\"a\"",
    "<use href=\"#a\"/>",
    "href=\"#a\"",
    "xlink:href=\"#a\"",
    "<defs>",
    "</defs>",
    "<symbol id=\"a\">",
    "</symbol>",
    "<circle r=\"5\"/>",
    "<rect width=\"3\" height=\"3\"/>",
    "stroke=\"red\"",
    "stroke-dasharray=\"0.001\"",
    "stroke-width=\"1e9\"",
    "clip-path=\"url(#a)\"",
    "<style>",
    "</style>",
    "<!DOCTYPE svg [<!ENTITY a \"b\">]>",
    "&a;",
    "viewBox=\"0 0 0 0\"",
    "width=\"1e30\"",
    "<![CDATA[",
    "]]>",
];

const JSON_WORDS: [&str; 24] = [
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "null",
    "true",
    "\"contours\"",
    "\"sections\"",
    "\"points\"",
    "\"closed\"",
    "\"name\"",
    "\"units\"",
    "\"metre\"",
    "\"pressure\"",
    "[0,0,0]",
    "[1,2,3],",
    "[[0,0,0],[1,0,0]]",
    "{\"points\":[[0,0,0],[1,1,1]]}",
    "\\ud800",
    "\\u0000",
    "é",
];

const PICTURE_WORDS: [&str; 10] =
    ["IHDR", "IDAT", "IEND", "PLTE", "tRNS", "iCCP", "acTL", "JFIF", "Exif\u{0}\u{0}", "\u{0}\u{0}\u{7}\u{0}"];

/// A PNG and a JPEG of a dark disc.
fn picture() -> Subject<'static> {
    let disc = image::RgbaImage::from_fn(48, 40, |x, y| {
        let off = (f64::from(x) - 20.0).hypot(f64::from(y) - 19.0);
        image::Rgba([(off * 8.0) as u8, 30, 40, if off < 16.0 { 255 } else { 0 }])
    });
    let encoded = |picture: image::DynamicImage, format| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    };
    let opaque = image::DynamicImage::ImageRgba8(disc.clone()).into_rgb8();
    let corpus = vec![encoded(disc.into(), image::ImageFormat::Png), encoded(opaque.into(), image::ImageFormat::Jpeg)];
    Subject { name: "picture", corpus, dictionary: &PICTURE_WORDS, memory, read: read_picture, allocator: &ALLOCATOR }
}

fn gltf() -> Subject<'static> {
    let corpus = vec![gltf_write::glb(&scene()).unwrap(), gltf_write::gltf(&scene()).unwrap()];
    Subject { name: "gltf", corpus, dictionary: &GLTF_WORDS, memory, read: read_gltf, allocator: &ALLOCATOR }
}

fn obj() -> Subject<'static> {
    let corpus = vec![
        obj::write(&scene(), Some("a.mtl")).unwrap(),
        b"o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nf -4 \\\n-3 -2\n"
            .to_vec(),
    ];
    Subject { name: "obj", corpus, dictionary: &OBJ_WORDS, memory, read: read_obj, allocator: &ALLOCATOR }
}

fn svg() -> Subject<'static> {
    let drawing = br##"<?xml version="1.0"?>
<!DOCTYPE svg [<!ENTITY ink "stroke:black">]>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="10cm" viewBox="0 0 100 50">
<style>path { fill: none; &ink; }</style>
<defs><g id="arm"><path d="M 1 2 C 3 4 5 6 7 8 S 9 9 1 1 Q 2 2 3 0 T 5 5 A 5 3 20 1 0 9 9 Z"/></g></defs>
<g transform="translate(3 4) rotate(10)"><use xlink:href="#arm" x="2"/><path id="hem" d="m0 0 10 10 h5 v5 z" stroke="red"/></g>
<circle cx="5" cy="5" r="3"/><polyline points="0,0 1,1 2,0" stroke-dasharray="1 2"/><text>no</text>
</svg>"##;
    let corpus = vec![drawing.to_vec()];
    Subject { name: "svg", corpus, dictionary: &SVG_WORDS, memory, read: read_svg, allocator: &ALLOCATOR }
}

fn curves() -> Subject<'static> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs/data/human/contours");
    let mut corpus: Vec<_> =
        ["neck_front.json", "neck_side.json"].map(|name| std::fs::read(folder.join(name)).unwrap()).into();
    corpus.push(
        br#"{"units": "metre", "contours": [{"name": "a", "closed": true, "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]],
        "pressure": [0.1, 0.5, 1]}], "sections": [{"points": [[0, 0, 0], [1e-3, 2E5, -0.0]]}]}"#
            .to_vec(),
    );
    Subject { name: "curves", corpus, dictionary: &JSON_WORDS, memory, read: read_curves, allocator: &ALLOCATOR }
}

#[test]
fn fuzz_gltf() {
    gltf().fuzz();
}

#[test]
fn fuzz_obj() {
    obj().fuzz();
}

#[test]
fn fuzz_svg() {
    svg().fuzz();
}

#[test]
fn fuzz_pictures() {
    picture().fuzz();
}

#[test]
fn fuzz_curves() {
    curves().fuzz();
}

#[test]
fn what_fuzzing_found_stays_mended() {
    for subject in [gltf(), obj(), svg(), curves(), picture()] {
        subject.hold_cases(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(subject.name));
    }
}

#[test]
fn a_small_gltf_does_not_become_a_large_one() {
    let subject = gltf();
    // Ten thousand nodes that show one mesh of as many triangles: 400 KB that ask for a hundred million triangles.
    let json = |nodes: usize, count: usize| {
        let scene: Vec<String> = (0..nodes).map(|node| node.to_string()).collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count}}}],
            "bufferViews":[{{"buffer":0,"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}}"#,
            scene.join(","),
            vec!["{\"mesh\":0}"; nodes].join(","),
            12 * count,
            12 * count
        )
    };
    let with_bytes = |json: String, bytes: &[u8]| {
        let json = format!("{json}{}", " ".repeat((4 - json.len() % 4) % 4));
        let length = |number: usize| u32::try_from(number).unwrap().to_le_bytes();
        let total = 12 + 8 + json.len() + 8 + bytes.len();
        [
            b"glTF".as_slice(),
            &2_u32.to_le_bytes(),
            &length(total),
            &length(json.len()),
            b"JSON",
            json.as_bytes(),
            &length(bytes.len()),
            b"BIN\0",
            bytes,
        ]
        .concat()
    };
    let points: Vec<u8> =
        (0..30_000_u32).flat_map(|i| [i as f32, (i * i % 997) as f32, 0.5]).flat_map(f32::to_le_bytes).collect();
    subject.hold("ten thousand copies", &with_bytes(json(10_000, 30_000), &points));
    subject.hold("copies that are read", &with_bytes(json(20, 30_000), &points));
    subject.hold("a count beyond everything", &with_bytes(json(1, usize::MAX / 12), &points));
    let nodes = "{},".repeat(300_000);
    subject.hold("many nodes", format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{}{{}}]}}"#, nodes).as_bytes());
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let deep =
            format!(r#"{{"asset":{{"version":"2.0","extras":{}1{}}}}}"#, open.repeat(200_000), close.repeat(200_000));
        subject.hold("deep JSON", deep.as_bytes());
    }
}

#[test]
fn a_small_svg_does_not_become_a_large_one() {
    let subject = svg();
    let svg = |inside: &str| {
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">{inside}</svg>")
    };
    // Each group shows the one before it ten times.
    let mut copies = String::from("<defs><path id=\"a0\" d=\"M0 0L1 1\" stroke=\"red\"/>");
    for level in 1..12 {
        let shown = format!("<use xlink:href=\"#a{}\"/>", level - 1).repeat(10);
        let _ = write!(copies, "<g id=\"a{level}\">{shown}</g>");
    }
    copies.push_str("</defs><use xlink:href=\"#a11\"/>");
    let mut entities = String::from("<!DOCTYPE svg [<!ENTITY a0 \"lol\">");
    for level in 1..12 {
        let _ = write!(entities, "<!ENTITY a{level} \"{}\">", format!("&a{};", level - 1).repeat(10));
    }
    entities.push_str("]>");
    for (what, text) in [
        ("copies of copies", svg(&copies)),
        ("entities of entities", entities + &svg("<text>&a11;</text><path d=\"M0 0L1 1\" stroke=\"red\"/>")),
        ("a group that shows itself", svg("<g id=\"a\"><use xlink:href=\"#a\"/></g>")),
        (
            "groups that show each other",
            svg("<g id=\"a\"><use xlink:href=\"#b\"/></g><g id=\"b\"><use xlink:href=\"#a\"/></g>"),
        ),
        ("deep groups", svg(&format!("{}{}", "<g>".repeat(100_000), "</g>".repeat(100_000)))),
        (
            "copies of deep groups",
            svg(&{
                let mut deep = String::from("<defs><path id=\"b0\" d=\"M0 0L1 1\" stroke=\"red\"/>");
                for level in 1..40 {
                    let _ = write!(
                        deep,
                        "{}<use xlink:href=\"#b{}\"/>{}",
                        format!("<g id=\"b{level}\">") + &"<g opacity=\"0.9\">".repeat(200),
                        level - 1,
                        "</g>".repeat(201)
                    );
                }
                deep + "</defs><use xlink:href=\"#b39\"/>"
            }),
        ),
        (
            "a chain of copies",
            svg(&{
                let mut chain = String::from("<path id=\"c0\" d=\"M0 0L1 1\" stroke=\"red\"/>");
                for level in 1..3_000 {
                    let _ = write!(chain, "<use id=\"c{level}\" xlink:href=\"#c{}\"/>", level - 1);
                }
                chain
            }),
        ),
        ("many paths", svg(&"<path d=\"M0 0L1 1\" stroke=\"red\"/>".repeat(20_000))),
        ("a path of many points", svg(&format!("<path stroke=\"red\" d=\"M0 0{}\"/>", "h1".repeat(200_000)))),
        (
            "arcs as large as the earth",
            svg(&format!("<path stroke=\"red\" d=\"M0 0{}\"/>", "A1e30 1e30 0 1 1 1e30 1".repeat(1_000))),
        ),
        ("a dash of nothing along a mile", svg("<path stroke=\"red\" stroke-dasharray=\"1e-6\" d=\"M0 0H1e6\"/>")),
        (
            "rules for everything",
            svg(&format!(
                "<style>{}</style>{}",
                "* g path { fill: none }".repeat(300),
                "<path d=\"M0 0L1 1\"/>".repeat(300)
            )),
        ),
    ] {
        subject.hold(what, text.as_bytes());
    }
}

#[test]
fn a_small_obj_or_json_does_not_become_a_large_one() {
    let subject = obj();
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\n";
    for (what, text) in [
        ("a polygon of many corners without normals", format!("{vertices}f {}", "1//1 2//1 3//1 ".repeat(60_000))),
        ("a polygon of many corners", format!("{vertices}f {}", "1 2 3 ".repeat(60_000))),
        ("many objects", format!("{vertices}{}", "o\n".repeat(200_000))),
        (
            "many objects that use everything",
            format!("{}{}", "v 0 0 1\n".repeat(5_000), "o a\nf 1 2500 5000\n".repeat(5_000)),
        ),
        ("lines that go on", "\\\n".repeat(300_000)),
        ("a line without end", "v ".repeat(300_000)),
        ("a number of a million digits", format!("v {} 0 0\n{vertices}f 1 2 3\n", "9".repeat(1_000_000))),
        ("an index beyond everything", format!("{vertices}f 1 2 99999999999999999999\n")),
        ("an index before everything", format!("{vertices}f -9223372036854775808 -1 -2\n")),
    ] {
        subject.hold(what, text.as_bytes());
    }
    let subject = curves();
    for (what, text) in [
        ("lists", format!("{{\"contours\":[{}[]]}}", "[],".repeat(300_000))),
        ("objects", format!("{{\"contours\":[{}{{}}]}}", "{\"\":0},".repeat(100_000))),
        ("deep lists", format!("{{\"contours\":{}", "[".repeat(300_000))),
        ("points", format!("{{\"contours\":[{{\"points\":[{}[0,0,1]]}}]}}", "[0,0,0],[1,0,0],".repeat(50_000))),
        ("a long name", format!("{{\"contours\":[{{\"name\":\"{}\",\"points\":[[0,0,0]]}}]}}", "n".repeat(1_000_000))),
        (
            "a number of a million digits",
            format!("{{\"contours\":[{{\"points\":[[{},0,0],[1,1,1]]}}]}}", "1".repeat(1_000_000)),
        ),
    ] {
        subject.hold(what, text.as_bytes());
    }
}
