//! One open contour over a closed one.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::test_shapes::{apart, closed, leaving, open, out_of_plane, place, placed};
use super::*;
use crate::beam::Stiffness;
use crate::curve::{ArcLength, Curve, closest};

const NODES: usize = 33;

/// Half a ball that lies on the plane z = 0, its contour from left to right over the top.
fn ball() -> (Curve, Curve) {
    (
        open("over", 800, |t| DVec3::new((PI * t).cos(), 0.0, (PI * t).sin()) * 0.1),
        closed("rim", 4000, |a| DVec3::new(a.cos(), a.sin(), 0.0) * 0.1),
    )
}

/// A nose-like ridge over an egg.
fn ridge() -> (Curve, Curve) {
    (
        open("ridge", 300, |t| {
            DVec3::new(0.06 * (PI * t).cos(), 0.01 * (TAU * t).sin(), 0.05 * (PI * t).sin() * (0.4 + t))
        }),
        closed("egg", 1000, |a| DVec3::new(0.06 * a.cos(), (0.04 + 0.01 * a.cos()) * a.sin(), 0.0)),
    )
}

fn options() -> GenerateOptions {
    GenerateOptions { sections: 41, nodes: NODES, ..GenerateOptions::default() }
}

fn run((open, closed): &(Curve, Curve), border: ArchBorder<'_>, options: &GenerateOptions) -> Generated {
    arch(open, closed, border, options, &|_| true).unwrap()
}

#[test]
fn contours_are_reproduced_and_ends_are_poles() {
    let drawn = ridge();
    let made = run(&drawn, ArchBorder::Parabola, &options());
    let sections = &made.sections;
    assert_eq!((sections.len(), sections.nodes(), sections.is_closed()), (41, NODES, false));
    assert_eq!(sections.rails(), [0, 16, 32]);
    assert!(sections.is_pole(0) && sections.is_pole(40) && made.largest_gap < 1e-12);
    let over = ArcLength::of(&drawn.0);
    for (row, section) in sections.iter().enumerate() {
        assert!(section[16].distance(over.point_at_fraction(row as f64 / 40.0)) < 1e-12);
        for edge in [section[0], section[32]] {
            assert!(closest(&drawn.1, edge).distance < 1e-14);
        }
        if row > 0 && row < 40 {
            // Seen along the surface normal, out of the closed contour, sections run to the left.
            let across = section[17] - section[15];
            let along = sections.section(row + 1)[16] - sections.section(row - 1)[16];
            assert!(across.cross(along).z > 0.0, "row {row}");
        }
    }
}

#[test]
fn without_tension_a_generator_is_the_parabola() {
    let soft = GenerateOptions { stiffness: Stiffness::new(1.0, 0.0).unwrap(), ..options() };
    let made = run(&ridge(), ArchBorder::Parabola, &soft);
    for section in made.sections.iter() {
        let (a, b, c) = (section[0], section[16], section[32]);
        for (i, p) in section.iter().enumerate() {
            let u = i as f64 / 32.0;
            let parabola = a * ((1.0 - u) * (1.0 - 2.0 * u)) + b * (4.0 * u * (1.0 - u)) + c * (u * (2.0 * u - 1.0));
            assert!(p.distance(parabola) < 1e-13);
        }
    }
}

#[test]
fn half_a_ball_is_round_with_round_borders() {
    let off = |border| {
        let made = run(&ball(), border, &options());
        made.sections.points().iter().map(|p| (p.length() / 0.1 - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(off(ArchBorder::Round) < 0.02, "{}", off(ArchBorder::Round));
    assert!(off(ArchBorder::Parabola) > 0.05);
}

#[test]
fn it_continues_a_neighbour_all_along_the_joint() {
    let drawn = ridge();
    // A cone that widens downwards, as directions and as a curve beside the contour.
    let outward = |p: DVec3| DVec3::new(p.x, 2.0 * p.y, 0.0).normalize();
    let slope = |p: DVec3| DVec3::Z - outward(p) * 0.8;
    let directions: Vec<DVec3> = drawn.1.points().iter().map(|p| slope(*p)).collect();
    let beside = drawn.1.map(|p| p - slope(p) * 1e-4).unwrap();
    for nodes in [9, NODES, 129] {
        for neighbour in [Neighbour::Directions(&directions), Neighbour::Curve(&beside)] {
            let options = GenerateOptions { nodes, ..options() };
            let made = run(&drawn, ArchBorder::Neighbour(neighbour), &options);
            let rows = &made.sections;
            for row in 1..40 {
                let section = rows.section(row);
                for end in [false, true] {
                    let at = |j: usize| section[if end { nodes - 1 - j } else { j }];
                    let border = [row + 1, row - 1].map(|r| rows.section(r)[if end { nodes - 1 } else { 0 }]);
                    let normal = (border[0] - border[1]).cross(slope(at(0)));
                    let angle = out_of_plane(leaving(at), normal);
                    // The border's own direction is a difference of sections here, and blunt at its ends.
                    let tolerance = if (4..37).contains(&row) { 0.1 } else { 1.0 };
                    assert!(angle < tolerance || nodes == 9 && angle < 2.0, "{nodes} nodes, row {row}: {angle}");
                }
            }
        }
    }
}

#[test]
fn what_is_drawn_alike_comes_out_alike() {
    let (over, rim) = ridge();
    let made = |over: &Curve, rim: &Curve| run(&(over.clone(), rim.clone()), ArchBorder::Round, &options()).sections;
    let one = made(&over, &rim);
    // Neither where nor which way the closed contour begins matters.
    let mut later = rim.points().to_vec();
    later.rotate_left(137);
    let later = Curve::new("rim", later, true).unwrap();
    assert!(apart(&one, &made(&over, &later), |p| p) < 1e-12);
    assert!(apart(&one, &made(&over, &rim.clone().reversed()), |p| p) < 1e-12);
    // The open one backwards: the same surface from the other end.
    let back = made(&over.clone().reversed(), &rim);
    for row in 0..41 {
        for j in 0..NODES {
            assert!(one.section(row)[j].distance(back.section(40 - row)[NODES - 1 - j]) < 1e-12);
        }
    }
    assert!(apart(&one, &made(&placed(&over), &placed(&rim)), place) < 1e-11);
    let mirror = |p: DVec3| DVec3::new(p.x, -p.y, p.z);
    let mirrored = made(&over.map(mirror).unwrap(), &rim.map(mirror).unwrap());
    for row in 0..41 {
        for j in 0..NODES {
            assert!(mirror(one.section(row)[j]).distance(mirrored.section(row)[NODES - 1 - j]) < 1e-12);
        }
    }
}

#[test]
fn a_gap_is_bent_shut() {
    let (over, rim) = ball();
    let short = over.map(|p| p + DVec3::Z * 0.01).unwrap();
    let made = run(&(short, rim), ArchBorder::Parabola, &options());
    assert!((made.largest_gap - 0.01).abs() < 1e-12 && made.warnings.len() == 1, "{:?}", made.warnings);
    assert!(made.sections.section(0).iter().all(|p| p.distance(DVec3::X * 0.1) < 1e-12));
}

#[test]
fn errors() {
    let (over, rim) = ball();
    let refused = |open: &Curve, closed: &Curve, border, options: &GenerateOptions| {
        arch(open, closed, border, options, &|done| done < 0.5).unwrap_err()
    };
    let plain = |open: &Curve, closed: &Curve| refused(open, closed, ArchBorder::Parabola, &options());
    assert_eq!(plain(&over, &rim), GenerateError::Cancelled);
    assert!(matches!(plain(&rim, &rim), GenerateError::RailIsClosed { .. }));
    assert!(matches!(plain(&over, &over), GenerateError::CurveIsOpen { which: "closed", .. }));
    let far = plain(&over.map(|p| p + DVec3::Z).unwrap(), &rim);
    assert!(far.to_string().contains("raise the snap"), "{far}");
    let back = open("back", 9, |t| DVec3::new(0.1, 0.0, (PI * t).sin()));
    assert!(matches!(plain(&back, &rim), GenerateError::BothEndsAtOnePoint { .. }));
    let none = refused(&over, &rim, ArchBorder::Neighbour(Neighbour::Curve(&rim)), &options());
    assert!(matches!(none, GenerateError::NoDirection { .. }));
    let few = GenerateOptions { sections: 3, ..options() };
    assert_eq!(refused(&over, &rim, ArchBorder::Round, &few), GenerateError::TooFewSections { found: 3, needed: 4 });
    let huge = rim.map(|p| p * 1e300).unwrap();
    assert!(matches!(plain(&over, &huge), GenerateError::TooFarOut { .. }));
}
