//! Patches over three or four borders.

use glam::DVec3;

use super::test_shapes::{across_sphere, apart, leaving, open, out_of_plane, place, placed, sphere_patch};
use super::*;
use crate::curve::{Curve, closest};

fn options() -> GenerateOptions {
    GenerateOptions { sections: 33, nodes: 33, ..GenerateOptions::default() }
}

fn run(borders: &[Curve], neighbours: &[Option<Neighbour<'_>>], options: &GenerateOptions) -> Generated {
    network(borders, &[], neighbours, options, &|_| true).unwrap()
}

/// The four sides of a patch, each as points from its border inwards.
fn sides(made: &Generated) -> Vec<Vec<[DVec3; 5]>> {
    let (rows, columns) = (made.sections.len(), made.sections.nodes());
    let at = |row: usize, column: usize| made.sections.section(row)[column];
    let pick = |f: &dyn Fn(usize, usize) -> DVec3, count: usize| {
        (1..count - 1).map(|i| [f(i, 0), f(i, 1), f(i, 2), f(i, 3), f(i + 1, 0) - f(i - 1, 0)]).collect()
    };
    vec![
        pick(&|i, k| at(k, i), columns),
        pick(&|i, k| at(i, columns - 1 - k), rows),
        pick(&|i, k| at(rows - 1 - k, i), columns),
        pick(&|i, k| at(i, k), rows),
    ]
}

#[test]
fn all_borders_are_reproduced_in_any_order_and_sense() {
    for count in [3, 4] {
        let borders = sphere_patch(count, 200);
        let made = run(&borders, &[], &options());
        assert!(made.warnings.is_empty() && made.largest_gap < 1e-12);
        let on = |border: &Curve, points: &[DVec3]| points.iter().all(|p| closest(border, *p).distance < 1e-12);
        let column = |j: usize| -> Vec<DVec3> { made.sections.iter().map(|section| section[j]).collect() };
        assert!(on(&borders[0], made.sections.section(0)));
        assert!(on(&borders[1], &column(32)) && on(&borders[count - 1], &column(0)));
        if count == 4 {
            assert!(on(&borders[2], made.sections.section(32)));
        } else {
            assert!(made.sections.is_pole(32));
        }
        let mut mixed: Vec<Curve> = vec![borders[0].clone()];
        mixed.extend(borders[1..].iter().rev().cloned().map(Curve::reversed));
        assert!(apart(&made.sections, &run(&mixed, &[], &options()).sections, |p| p) < 1e-12);
        let there: Vec<Curve> = borders.iter().map(placed).collect();
        assert!(apart(&made.sections, &run(&there, &[], &options()).sections, place) < 1e-11);
    }
}

#[test]
fn it_continues_the_sphere_around_it() {
    for count in [4, 3] {
        let borders = sphere_patch(count, 800);
        let given: Vec<Vec<DVec3>> = borders.iter().map(|border| across_sphere(border, DVec3::Z * 0.1)).collect();
        let neighbours: Vec<Option<Neighbour<'_>>> = given.iter().map(|d| Some(Neighbour::Directions(d))).collect();
        let made = run(&borders, &neighbours, &options());
        assert!(made.warnings.is_empty(), "{:?}", made.warnings);
        let plain = run(&borders, &[], &options());
        let height = |made: &Generated| {
            made.sections.points().iter().map(|p| (p.length() / 0.1 - 1.0).abs()).fold(0.0, f64::max)
        };
        assert!(height(&made) < 0.015, "{count} sides: {}", height(&made));
        assert!(count == 3 || height(&made) < 0.25 * height(&plain));
        for (side, points) in sides(&made).iter().enumerate().filter(|(side, _)| count == 4 || *side != 2) {
            let worst = points.iter().map(|p| out_of_plane(leaving(|k| p[k]), p[0])).fold(0.0, f64::max);
            assert!(worst < 0.1, "{count} sides, side {side}: {worst} degrees");
        }
        // Directions belong to the points of their border, whichever way that is drawn.
        let back: Vec<Curve> = borders.iter().cloned().map(Curve::reversed).collect();
        let given: Vec<Vec<DVec3>> = given
            .into_iter()
            .map(|mut d| {
                d.reverse();
                d
            })
            .collect();
        let neighbours: Vec<Option<Neighbour<'_>>> = given.iter().map(|d| Some(Neighbour::Directions(d))).collect();
        let turned = run(&back, &neighbours, &options());
        let nodes = made.sections.nodes();
        for row in 0..33 {
            for j in 0..nodes {
                let image = turned.sections.section(row)[nodes - 1 - j];
                assert!(made.sections.section(row)[j].distance(image) < 1e-12, "{count} sides, row {row}");
            }
        }
    }
}

#[test]
fn rails_inside_shape_it() {
    let borders = sphere_patch(4, 200);
    let from = borders[0].points()[100];
    let to = borders[2].points()[100];
    let ridge = open("ridge", 100, |t| to.lerp(from, t) + DVec3::Z * 0.04 * (std::f64::consts::PI * t).sin());
    let made = network(&borders, std::slice::from_ref(&ridge), &[], &options(), &|_| true).unwrap();
    let column = made.sections.rails()[1];
    assert!(made.sections.iter().all(|section| closest(&ridge, section[column]).distance < 1e-12));
    assert_eq!(made.sections.rails().len(), 3);
}

#[test]
fn errors() {
    let borders = sphere_patch(4, 50);
    let refused = |borders: &[Curve]| network(borders, &[], &[], &options(), &|_| true).unwrap_err();
    assert_eq!(refused(&borders[..2]), GenerateError::BorderCount { found: 2 });
    let five: Vec<Curve> = borders.iter().chain(&borders[..1]).cloned().collect();
    assert!(refused(&five).to_string().contains("draw a curve across"));
    let mut apart = borders.clone();
    apart[2] = apart[2].map(|p| p + DVec3::Y * 0.3).unwrap();
    assert!(matches!(refused(&apart), GenerateError::BordersApart { .. }));
    let mut ring = borders.clone();
    ring[1] = Curve::new("ring", borders[1].points().to_vec(), true).unwrap();
    assert!(matches!(refused(&ring), GenerateError::RailIsClosed { rail: 1, .. }));
}
