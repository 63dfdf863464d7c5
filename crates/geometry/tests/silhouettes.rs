//! Primitives deformed to the silhouettes of a real body, and measured by the outline of their surface.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3};
use maquette_geometry::curve::{Curve, smooth};
use maquette_geometry::deform::{
    AlignOptions, Silhouette, SilhouetteDeformed, SilhouetteOptions, StrokeMatching, align_primitive,
    deform_to_silhouette,
};
use maquette_geometry::file_format::curves_json;
use maquette_geometry::mesh::{SilhouetteReport, silhouette_of, silhouette_report};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::{SkinOptions, skin};
use maquette_geometry::view::View;

fn contours(part: &str, view: &str) -> Vec<Curve> {
    let path = format!("{}/../../graphs/data/human/contours/{part}_{view}.json", env!("CARGO_MANIFEST_DIR"));
    curves_json::read(&std::fs::read(path).unwrap()).unwrap()
}

/// A stack about +Y of a radius that depends on the height, 0 to 1.
fn primitive(rows: usize, nodes: usize, radius: impl Fn(f64) -> f64, height: impl Fn(f64) -> f64) -> Sections {
    let ring = |k: usize| {
        let t = k as f64 / (rows - 1) as f64;
        (0..nodes)
            .map(|j| {
                DQuat::from_rotation_y(TAU * j as f64 / nodes as f64) * DVec3::X * radius(t) + DVec3::Y * height(t)
            })
            .collect()
    };
    Sections::new((0..rows).map(ring).collect(), true, vec![]).unwrap()
}

fn cylinder(rows: usize, nodes: usize) -> Sections {
    primitive(rows, nodes, |_| 0.5, |t| t)
}

/// A dome on a cylinder, with a pole at its end.
fn capsule(rows: usize, nodes: usize) -> Sections {
    let angle = |t: f64| (2.0 * t - 1.0).max(0.0) * PI / 2.0;
    let radius = |t: f64| if t == 1.0 { 0.0 } else { 0.5 * angle(t).cos() };
    primitive(rows, nodes, radius, |t| if t < 0.5 { t } else { 0.5 + 0.5 * angle(t).sin() })
}

fn measured(sections: &Sections, view: View, strokes: &[Curve]) -> SilhouetteReport {
    let mesh = skin(sections, &SkinOptions::default(), &|_| true).unwrap();
    let outline = silhouette_of(&mesh, view, 0.0, &|_| true).unwrap();
    silhouette_report(&outline.curves, strokes, view, &|_| true).unwrap()
}

#[test]
fn explore() {
    use maquette_geometry::deform::AxisShape;
    for (part, wave) in [("head", 0.0), ("head", 0.015)] {
        let calm = |view: &str| -> Vec<Curve> {
            contours(part, view).iter().map(|c| if wave > 0.0 { smooth(c, wave).unwrap() } else { c.clone() }).collect()
        };
        let (front, side) = (calm("front"), calm("side"));
        let both = [Silhouette { view: View::FRONT, strokes: &front }, Silhouette { view: View::SIDE, strokes: &side }];
        for rows in [64, 160, 320] {
            for axis in [AxisShape::Bent, AxisShape::Straight] {
                for spare in [0, 1] {
                    let matching = StrokeMatching::ArcLength;
                    let start = if spare == 0 {
                        capsule(rows, 64)
                    } else {
                        primitive(rows, 64, |t| if t == 1.0 { 0.0 } else { 0.5 * (1.0 - t.powi(3)).sqrt() }, |t| t)
                    };
                    let aligned = align_primitive(
                        &start,
                        &both,
                        &AlignOptions { matching, axis, ..AlignOptions::default() },
                        &|_| true,
                    )
                    .unwrap();
                    let options = SilhouetteOptions { matching, ..SilhouetteOptions::default() };
                    let made = deform_to_silhouette(&aligned.sections, &both, &options, &|_| true).unwrap();
                    let (f, s) =
                        (measured(&made.sections, View::FRONT, &front), measured(&made.sections, View::SIDE, &side));
                    println!(
                        "{part} {wave} {rows} {axis:?} {spare}: front {:.4}% at {} mean {:.5}%, side {:.4}% at {} mean {:.5}%, over {:.2e} {:.2e} {:?} {:?}",
                        f.largest_percent(),
                        f.at,
                        f.mean_percent(),
                        s.largest_percent(),
                        s.at,
                        s.mean_percent(),
                        made.views[0].overshoot,
                        made.views[1].overshoot,
                        made.warnings,
                        aligned.warnings
                    );
                    if rows == 160 && wave == 0.0 && spare == 0 {
                        let mesh = skin(&made.sections, &SkinOptions::default(), &|_| true).unwrap();
                        let outline = silhouette_of(&mesh, View::SIDE, 0.0, &|_| true).unwrap();
                        for p in outline.curves[0]
                            .points()
                            .iter()
                            .filter(|p| p.distance(DVec3::new(0.0, 1.486, 0.1414)) < 0.008)
                        {
                            println!("  out {:.5} {:.5}", p.z, p.y);
                        }
                        for p in side[0].points().iter().filter(|p| p.distance(DVec3::new(0.0, 1.486, 0.1414)) < 0.012)
                        {
                            println!("  stroke {:.5} {:.5}", p.z, p.y);
                        }
                        let col = made.views[1].columns;
                        for s in made.sections.iter() {
                            for c in col {
                                if s[c].distance(DVec3::new(s[c].x, 1.486, 0.1414)) < 0.008 {
                                    println!(
                                        "  col {c} {:?}",
                                        (-3i32..=3)
                                            .map(|d| {
                                                let p = s[((c as i32 + d + 64) % 64) as usize];
                                                format!("{:.4},{:.4}", p.z, p.y)
                                            })
                                            .collect::<Vec<_>>()
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
