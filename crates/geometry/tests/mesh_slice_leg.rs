//! Sections of a real leg, against sections that were cut from a finer mesh of the same body.

#![allow(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

use glam::DVec3;
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::file_format::{curves_json, gltf_read};
use maquette_geometry::mesh::Mesh;
use maquette_geometry::mesh::slice::{
    AlongOptions, Hit, Method, Plane, Positions, SectionOptions, Sliced, along, through,
};
use serde_json::Value;

const SECTIONS: &[u8] = include_bytes!("../../../graphs/data/human/sections/left_leg.json");

/// A tube from hip to ankle, open at both ends.
fn leg() -> Mesh {
    gltf_read::read(include_bytes!("../../../graphs/data/human/parts/left_leg.glb")).unwrap().remove(0)
}

fn document() -> Value {
    serde_json::from_slice(SECTIONS).unwrap()
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_slice(&value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>())
}

/// Planes and sections but the first and the last, which lie in the rims of the tube.
fn expected() -> Vec<(Plane, Curve)> {
    let document = document();
    let planes = document["sections"].as_array().unwrap().iter().map(|section| {
        let plane = &section["plane"];
        Plane::new(vector(&plane["origin"]), vector(&plane["normal"])).unwrap()
    });
    let all: Vec<(Plane, Curve)> = planes.zip(curves_json::read(SECTIONS).unwrap()).collect();
    all[1..all.len() - 1].to_vec()
}

/// Hip, knee, ankle.
fn bone() -> Curve {
    let bones = document()["bones"].clone();
    let joints = [&bones[0]["head"], &bones[0]["tail"], &bones[1]["tail"]].map(vector);
    Curve::new("leg", joints.to_vec(), false).unwrap()
}

/// Largest distance of the points of one curve from another.
fn farthest(points: &Curve, from: &Curve) -> f64 {
    points.points().iter().map(|p| closest(from, *p).distance).fold(0.0, f64::max)
}

fn assert_near(sliced: &Sliced, tolerance: f64) {
    assert_eq!(sliced.warnings, []);
    let expected = expected();
    assert_eq!(sliced.sections.len(), expected.len());
    for (section, (plane, truth)) in sliced.sections.iter().zip(&expected) {
        let apart = farthest(&section.curve, truth).max(farthest(truth, &section.curve));
        assert!(apart < tolerance, "section {}: {apart} m apart", section.index);
        assert!(section.curve.area_vector().dot(plane.normal()) > 0.0);
        // The true ones begin at the front as seen from their centroid; rays begin at the front of the bone.
        let start = section.curve.start().distance(truth.start());
        assert!(section.others.is_none() || start < 1e-3, "section {}: starts {start} m apart", section.index);
    }
}

#[test]
fn in_the_true_planes_the_true_sections_are_found() {
    let planes: Vec<Plane> = expected().into_iter().map(|(plane, _)| plane).collect();
    for method in [Method::Loop, Method::Rays(Hit::First), Method::Rays(Hit::Last)] {
        let options = SectionOptions { points: 128, method, ..SectionOptions::default() };
        assert_near(&through(&leg(), &planes, &options).unwrap(), 1e-3);
    }
}

#[test]
fn along_the_bone_planes_turn_at_the_knee_as_the_true_ones_do() {
    let bone = bone();
    let expected = expected();
    let fractions = expected.iter().map(|(plane, _)| closest(&bone, plane.origin()).fraction).collect();
    let options = AlongOptions { positions: Positions::At(fractions), ..AlongOptions::default() };
    let sliced = along(&leg(), &bone, &options).unwrap();
    assert_eq!(sliced.warnings, []);
    for (section, (plane, truth)) in sliced.sections.iter().zip(&expected) {
        assert!(section.plane.origin().distance(plane.origin()) < 1e-3);
        assert!(section.plane.normal().angle_between(plane.normal()).to_degrees() < 1.0, "section {}", section.index);
        assert!((section.perimeter - truth_length(truth)).abs() < 0.005 * section.perimeter);
        assert!(section.offset < 0.03, "the bone is within 3 cm of the middle of the leg: {}", section.offset);
    }
}

fn truth_length(curve: &Curve) -> f64 {
    (0..curve.segment_count()).map(|k| curve.segment(k)).map(|(a, b)| a.distance(b)).sum()
}
