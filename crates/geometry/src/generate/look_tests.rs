//! Every case as a mesh: sound and unfolded.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::test_shapes::{across_sphere, closed, cuff, dome, mouth, open, sphere_patch};
use super::*;
use crate::curve::{Curve, SortOptions, sort};
use crate::mesh::{Mesh, check};
use crate::surface::{SkinOptions, skin};

fn shapes() -> Vec<(&'static str, Generated)> {
    let options = GenerateOptions { sections: 33, nodes: 64, ..GenerateOptions::default() };
    let go = |_: f64| true;
    let mut shapes = Vec::new();

    let drawn = mouth(200);
    let sorted = sort(&drawn, &SortOptions::default()).unwrap();
    let lips = to_apex(&sorted.rails, &sorted.closed[0], None, &options, &go).unwrap();
    shapes.push(("mouth", lips));

    let (rails, rim) = dome(4);
    let cap = to_apex(&rails, &rim, None, &options, &go).unwrap();
    shapes.push(("dome", cap));

    let over = open("over", 300, |t| DVec3::new(0.06 * (PI * t).cos(), 0.0, 0.05 * (PI * t).sin() * (0.4 + t)));
    let egg = closed("egg", 1000, |a| DVec3::new(0.06 * a.cos(), (0.04 + 0.01 * a.cos()) * a.sin(), 0.0));
    let outwards: Vec<DVec3> =
        egg.points().iter().map(|p| DVec3::Z * 0.6 - DVec3::new(p.x, 2.0 * p.y, 0.0).normalize()).collect();
    for (name, border) in [
        ("arch, parabola", ArchBorder::Parabola),
        ("arch, round", ArchBorder::Round),
        ("arch, neighbour", ArchBorder::Neighbour(Neighbour::Directions(&outwards))),
    ] {
        shapes.push((name, arch(&over, &egg, border, &options, &go).unwrap()));
    }

    let (rails, arcs) = cuff(200);
    shapes.push(("cuff", sheet(&rails, &arcs, [None, None], &options, &go).unwrap()));

    for (plain, continued, sides) in [("patch", "patch, neighbours", 4), ("corner", "corner, neighbours", 3)] {
        let borders = sphere_patch(sides, 200);
        let given: Vec<Vec<DVec3>> = borders.iter().map(|border| across_sphere(border, DVec3::Z * 0.1)).collect();
        let neighbours: Vec<Option<Neighbour<'_>>> = given.iter().map(|d| Some(Neighbour::Directions(d))).collect();
        shapes.push((plain, network(&borders, &[], &[], &options, &go).unwrap()));
        shapes.push((continued, network(&borders, &[], &neighbours, &options, &go).unwrap()));
    }

    let ring = |name: &str, r: f64, at: DVec3, right: DVec3, forward: DVec3| {
        closed(name, 720, |a| at + right * (r * a.cos()) + forward * (r * a.sin()))
    };
    let blends = [
        ("blend, elbow", DVec3::new(0.15, 0.15, 0.02), -DVec3::Y, DVec3::Z, -DVec3::X),
        ("blend, U", DVec3::new(0.25, 0.0, 0.0), DVec3::X, DVec3::Z, DVec3::Y),
    ];
    for (name, at, right, forward, back) in blends {
        let (one, other) =
            (ring("one", 0.05, DVec3::ZERO, DVec3::X, DVec3::Z), ring("other", 0.04, at, right, forward));
        let (up, back) = (vec![DVec3::Y; 720], vec![back; 720]);
        let border = |curve, d| BlendBorder { curve, neighbour: Neighbour::Directions(d), strength: 1.0 };
        let made = blend(&border(&one, &up), &border(&other, &back), 0.0, &options, &go).unwrap();
        shapes.push((name, made));
    }
    let (limb, hole) = (
        ring("limb", 0.04, DVec3::new(0.03, 0.12, 0.0), DVec3::X, DVec3::Z),
        ring("hole", 0.08, DVec3::ZERO, DVec3::X, DVec3::Z),
    );
    let (down, inwards) = (vec![-DVec3::Y; 720], hole.points().iter().map(|p| -p.normalize()).collect::<Vec<DVec3>>());
    let border = |curve, d| BlendBorder { curve, neighbour: Neighbour::Directions(d), strength: 1.0 };
    let made = blend(&border(&limb, &down), &border(&hole, &inwards), 0.0, &options, &go).unwrap();
    shapes.push(("blend, hole", made));

    let size = |y: f64| 0.05 + 0.02 * (20.0 * y).sin();
    let at = |a: f64, y: f64| DVec3::new(size(y) * a.cos(), y, -size(y) * a.sin());
    let rails: Vec<Curve> = (0..4).map(|k| open("rail", 300, |t| at(FRAC_PI_2 * f64::from(k), 0.4 * t))).collect();
    let profiles: Vec<Curve> = [0.0, 0.12, 0.25, 0.4].iter().map(|y| closed("ring", 720, |a| at(a, *y))).collect();
    let made = through_closed(&rails, &profiles, [None, None], &options, &go).unwrap();
    shapes.push(("tube", made));
    shapes
}

fn skinned(made: &Generated) -> Mesh {
    skin(&made.sections, &SkinOptions { rows: 2, columns: 2, ..SkinOptions::default() }, &|_| true).unwrap()
}

#[test]
fn every_case_is_sound_and_unfolded() {
    for (name, made) in shapes() {
        assert!(made.warnings.is_empty() && made.notes.is_empty(), "{name}: {:?} {:?}", made.warnings, made.notes);
        let found = check(&skinned(&made));
        assert!(found.is_sound(), "{name}: {found}");
        assert!(found.largest_fold_degrees < 35.0, "{name}: folds by {} degrees", found.largest_fold_degrees);
    }
}
