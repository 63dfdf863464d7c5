//! Transitions between two closed borders.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec3};

use super::blend::generator;
use super::test_shapes::{apart, closed, leaving, out_of_plane, place, placed};
use super::*;
use crate::beam::Stiffness;
use crate::beam::closed_form::ExactHermite;
use crate::curve::Curve;

fn options() -> GenerateOptions {
    GenerateOptions { sections: 33, nodes: 64, ..GenerateOptions::default() }
}

/// The rim of a tube of this radius that ends at `at` and points along `axis`; it begins at the share `start` of a turn.
fn rim(name: &str, radius: f64, at: DVec3, axis: DVec3, start: f64) -> Curve {
    let turn = DQuat::from_rotation_arc(DVec3::Y, axis);
    closed(name, 1440, |a| {
        let a = a + TAU * start;
        at + turn * DVec3::new(radius * a.cos(), 0.0, -radius * a.sin())
    })
}

fn blended(
    one: &Curve,
    into: &[DVec3],
    other: &Curve,
    back: &[DVec3],
    twist: f64,
    options: &GenerateOptions,
) -> Generated {
    let border = |curve, directions| BlendBorder { curve, neighbour: Neighbour::Directions(directions), strength: 1.0 };
    blend(&border(one, into), &border(other, back), twist, options, &|_| true).unwrap()
}

/// Two tubes that point along `axes` into the blend.
fn tubes(rims: [&Curve; 2], axes: [DVec3; 2], options: &GenerateOptions) -> Generated {
    let [into, back] = [0, 1].map(|k| vec![axes[k]; rims[k].points().len()]);
    blended(rims[0], &into, rims[1], &back, 0.0, options)
}

#[test]
fn reference() {
    // Radius and height of two circles about z.
    let hermite = ExactHermite::new(Stiffness::default());
    let at = |r: f64, z: f64| DVec3::new(r, 0.0, z);
    for (u, r, z) in [
        (0.25, 1.213159068066, 0.6807392753147),
        (0.5, 1.523636997917, 1.559092494793),
        (0.75, 1.822798772781, 2.409155326804),
    ] {
        let found = generator([at(1.0, 0.0), at(2.0, 3.0)], [at(0.5, 2.0), at(0.3, 1.5)], hermite.values(u));
        assert!(found.distance(at(r, z)) < 1e-11, "{found}");
    }
}

#[test]
fn one_tube_goes_on_as_a_tube() {
    for start in [0.0, 0.3, 0.77] {
        let low = rim("low", 0.05, DVec3::ZERO, DVec3::Y, 0.0);
        let high = rim("high", 0.05, DVec3::Y * 0.2, DVec3::Y, start);
        for high in [high.clone(), high.reversed()] {
            let made = tubes([&low, &high], [DVec3::Y, -DVec3::Y], &options());
            for section in made.sections.iter() {
                for (p, q) in section.iter().zip(made.sections.section(0)) {
                    assert!((p.x.hypot(p.z) - 0.05).abs() < 1e-6);
                    assert!((p.x - q.x).hypot(p.z - q.z) < 1e-6, "no twist, wherever the rims begin");
                }
            }
        }
    }
}

#[test]
fn both_surfaces_are_continued_smoothly() {
    // A limb into a hole in a plane, and two tubes at an angle.
    let limb = rim("limb", 0.04, DVec3::new(0.02, 0.1, 0.0), DVec3::new(0.3, 1.0, 0.1).normalize(), 0.2);
    let hole = rim("hole", 0.07, DVec3::ZERO, DVec3::Y, 0.6);
    let down = vec![-DVec3::new(0.3, 1.0, 0.1).normalize(); limb.points().len()];
    let inwards: Vec<DVec3> = hole.points().iter().map(|p| -p.normalize()).collect();
    let beside = hole.map(|p| p * 1.0001).unwrap();
    for sections in [33, 65] {
        let options = GenerateOptions { sections, ..options() };
        for neighbour in [Neighbour::Directions(&inwards), Neighbour::Curve(&beside)] {
            let made = blend(
                &BlendBorder { curve: &limb, neighbour: Neighbour::Directions(&down), strength: 1.0 },
                &BlendBorder { curve: &hole, neighbour, strength: 1.3 },
                0.0,
                &options,
                &|_| true,
            )
            .unwrap();
            let last = sections - 1;
            for j in 0..64 {
                let into = |k: usize| made.sections.section(k)[j];
                let along = made.sections.section(0)[(j + 1) % 64] - made.sections.section(0)[(j + 63) % 64];
                assert!(out_of_plane(leaving(into), along.cross(down[0])) < 0.1);
                let back = |k: usize| made.sections.section(last - k)[j];
                assert!(out_of_plane(leaving(back), DVec3::Y) < 0.1, "{}", out_of_plane(leaving(back), DVec3::Y));
                assert!(crate::curve::closest(&limb, into(0)).distance < 1e-12);
                assert!(crate::curve::closest(&hole, back(0)).distance < 1e-12);
            }
        }
    }
}

#[test]
fn bends_neither_twist_nor_collapse() {
    // An elbow and a U: rims that point along `axes`.
    let cases = [(DVec3::new(0.15, 0.15, 0.0), DVec3::X, "elbow"), (DVec3::new(0.3, 0.0, 0.0), -DVec3::Y, "U")];
    for (at, axis, name) in cases {
        let one = rim("one", 0.05, DVec3::ZERO, DVec3::Y, 0.0);
        let other = rim("other", 0.05, at, axis, 0.4);
        let made = tubes([&one, &other], [DVec3::Y, -axis], &options());
        for (row, section) in made.sections.iter().enumerate() {
            let centre = made.sections.centre(row);
            let radii = section.iter().map(|p| p.distance(centre));
            let (low, high) = radii.fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(r), h.max(r)));
            assert!(low > 0.035 && high < 0.075, "{name}, section {row}: {low} to {high}");
            // Mirrored in the plane of the bend.
            for p in section {
                let image = DVec3::new(p.x, p.y, -p.z);
                assert!(section.iter().any(|q| q.distance(image) < 1e-4), "{name}, section {row}");
            }
        }
    }
}

#[test]
fn place_and_twist() {
    let egg = closed("egg", 700, |a| DVec3::new(0.05 * a.cos(), 0.0, -0.03 * a.sin()));
    let pear =
        closed("pear", 900, |a| DVec3::new(0.04 * a.cos(), 0.15 + 0.01 * a.sin(), -(0.05 + 0.01 * a.cos()) * a.sin()));
    let one = tubes([&egg, &pear], [DVec3::Y, -DVec3::Y], &options()).sections;
    let axes = [DVec3::Y, -DVec3::Y].map(|axis| place(axis) - place(DVec3::ZERO));
    let there = tubes([&placed(&egg), &placed(&pear)], axes, &options()).sections;
    assert!(apart(&one, &there, place) < 1e-6);
    let up = vec![DVec3::Y; 700];
    let down = vec![-DVec3::Y; 900];
    let twisted = blended(&egg, &up, &pear, &down, FRAC_PI_2, &options()).sections;
    let last = |sections: &crate::sections::Sections, j: usize| sections.section(32)[j % 64];
    for j in 0..64 {
        assert!(last(&twisted, j).distance(last(&one, j + 16)) < 1e-9);
    }
    // Another strength reaches farther, and keeps the direction.
    let [egg_border, pear_border] = [(&egg, &up), (&pear, &down)].map(|(curve, d)| BlendBorder {
        curve,
        neighbour: Neighbour::Directions(d),
        strength: 2.0,
    });
    let full = blend(&egg_border, &pear_border, 0.0, &options(), &|_| true).unwrap().sections;
    assert!(full.section(4)[0].y > 1.3 * one.section(4)[0].y);
}

#[test]
fn borders_of_as_many_points_keep_them() {
    let uneven = |name: &str, count: usize, at: DVec3, start: f64| {
        let angle = |k: usize| TAU * (k as f64 / count as f64 + start) + 0.3 * (TAU * k as f64 / count as f64).sin();
        let point = |a: f64| at + DVec3::new(0.05 * a.cos(), 0.0, -0.05 * a.sin());
        Curve::new(name, (0..count).map(angle).map(point).collect(), true).unwrap()
    };
    let low = uneven("low", 64, DVec3::ZERO, 0.0);
    for (count, start) in [(64, 0.0), (64, 0.4), (48, 0.1)] {
        let high = uneven("high", count, DVec3::Y * 0.2, start);
        for high in [high.clone(), high.reversed()] {
            for ends in [[&low, &high], [&high, &low]] {
                let axes = if ends[0] == &low { [DVec3::Y, -DVec3::Y] } else { [-DVec3::Y, DVec3::Y] };
                let made = tubes(ends, axes, &options()).sections;
                for (row, curve) in [(0, ends[0]), (32, ends[1])] {
                    let kept = curve.points().iter().all(|p| made.section(row).iter().any(|q| p.distance(*q) < 1e-15));
                    assert_eq!(kept, curve.points().len() == 64, "{count} from {start}, row {row}");
                }
                // No twist: what is over one another belongs together, as near as points allow.
                let apart = |p: &DVec3, q: &DVec3| (p.x - q.x).hypot(p.z - q.z);
                let most = made.section(0).iter().zip(made.section(32)).map(|(p, q)| apart(p, q)).fold(0.0, f64::max);
                assert!(most < 0.035, "{count} from {start}: {most}");
            }
        }
    }
}

#[test]
fn errors() {
    let (low, high) = (rim("low", 0.05, DVec3::ZERO, DVec3::Y, 0.0), rim("high", 0.05, DVec3::Y, DVec3::Y, 0.0));
    let up = vec![DVec3::Y; low.points().len()];
    let border = |curve, strength| BlendBorder { curve, neighbour: Neighbour::Directions(&up), strength };
    let refused = |one: &BlendBorder<'_>, twist: f64, options: &GenerateOptions| {
        blend(one, &border(&high, 1.0), twist, options, &|_| true).unwrap_err()
    };
    for strength in [0.0, -1.0, 11.0, f64::NAN] {
        assert!(matches!(refused(&border(&low, strength), 0.0, &options()), GenerateError::Strength { .. }));
    }
    assert!(matches!(refused(&border(&low, 1.0), f64::INFINITY, &options()), GenerateError::Twist { .. }));
    let few = GenerateOptions { nodes: 7, ..options() };
    assert_eq!(refused(&border(&low, 1.0), 0.0, &few), GenerateError::TooFewNodes { found: 7, needed: 8 });
    let line = Curve::new("line", low.points().to_vec(), false).unwrap();
    assert!(matches!(refused(&border(&line, 1.0), 0.0, &options()), GenerateError::CurveIsOpen { which: "start", .. }));
    let slit = low.map(|p| DVec3::new(p.x, 0.0, p.z * 1e-5)).unwrap();
    assert!(matches!(refused(&border(&slit, 1.0), 0.0, &options()), GenerateError::EnclosesNothing { .. }));
    let touching = BlendBorder { curve: &low, neighbour: Neighbour::Curve(&low), strength: 1.0 };
    assert!(matches!(refused(&touching, 0.0, &options()), GenerateError::NoDirection { .. }));
    let stopped = blend(&border(&low, 1.0), &border(&high, 1.0), 0.0, &options(), &|done| done < 0.5);
    assert_eq!(stopped, Err(GenerateError::Cancelled));
}
