//! Sections and parts of a body, for tests.
#![allow(dead_code, reason = "not every test needs all of it")]

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::Mesh;
use maquette_geometry::trigonometric::{EllipticSection, FitOptions, Harmonics, fit_sections};

fn read(path: &str) -> Vec<u8> {
    std::fs::read(format!("{}/tests/data/human/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// The loops of a part.
pub fn loops(part: &str) -> Vec<Curve> {
    let json: serde_json::Value = serde_json::from_slice(&read(&format!("sections/{part}.json"))).unwrap();
    let coordinate = |value: &serde_json::Value| value.as_f64().unwrap();
    let point = |p: &serde_json::Value| DVec3::new(coordinate(&p[0]), coordinate(&p[1]), coordinate(&p[2]));
    let section = |s: &serde_json::Value| s["points"].as_array().unwrap().iter().map(point).collect();
    let sections = json["sections"].as_array().unwrap().iter();
    sections.map(|s| Curve::new(part, section(s), true).unwrap()).collect()
}

/// The loops as single series of so many harmonics.
pub fn sections(part: &str, harmonics: usize) -> Vec<EllipticSection> {
    fitted(part, &FitOptions { harmonics: Harmonics::Fixed(harmonics), ..FitOptions::default() })
}

/// The loops fitted.
pub fn fitted(part: &str, options: &FitOptions) -> Vec<EllipticSection> {
    fit_sections(&loops(part), options).unwrap().sections.into_iter().map(|fitted| fitted.section).collect()
}

/// The true surface of a part, an open tube.
pub fn part(part: &str) -> Mesh {
    let meshes = maquette_geometry::file_format::gltf_read::read(&read(&format!("parts/{part}.glb"))).unwrap();
    meshes.into_iter().next().unwrap()
}
