//! Rails from a closed curve to a point.

use glam::DVec3;

use super::test_shapes::{apart, crease, dome, leaving, mouth, open, out_of_plane, place, placed};
use super::*;
use crate::border::BorderError;
use crate::curve::{ArcLength, Curve, SortOptions, closest, sort};

fn options() -> GenerateOptions {
    GenerateOptions { sections: 33, nodes: 64, ..GenerateOptions::default() }
}

fn sorted(curves: &[Curve]) -> (Vec<Curve>, Curve) {
    let sorted = sort(curves, &SortOptions::default()).unwrap();
    (sorted.rails, sorted.closed[0].clone())
}

fn run((rails, start): &(Vec<Curve>, Curve), options: &GenerateOptions) -> Generated {
    to_apex(rails, start, None, options, &|_| true).unwrap()
}

#[test]
fn lips_pass_their_curves_and_end_in_a_pole() {
    let drawn = sorted(&mouth(100));
    let made = run(&drawn, &options());
    let sections = &made.sections;
    assert_eq!((sections.len(), sections.nodes(), sections.rails().len()), (33, 64, 4));
    assert!(made.notes.is_empty() && made.warnings.is_empty(), "{:?} {:?}", made.notes, made.warnings);
    assert!(sections.section(32).iter().all(|p| *p == drawn.0[0].end()));
    assert!(sections.section(0).iter().all(|p| closest(&drawn.1, *p).distance < 1e-13));
    for (rail, column) in drawn.0.iter().zip(sections.rails()) {
        let arc = ArcLength::of(rail);
        for (row, section) in sections.iter().enumerate().skip(1) {
            assert!(section[*column].distance(arc.point_at_fraction(row as f64 / 32.0)) < 1e-13);
        }
    }
}

#[test]
fn fields_meet_without_a_crease() {
    // Finely drawn, so that the facets of the outline do not count.
    let drawn = sorted(&mouth(3000));
    for frame in [Frame::Turning, Frame::Fixed] {
        let worst = |weights| {
            let options = GenerateOptions { sections: 17, nodes: 400, frame, weights, ..options() };
            let sections = run(&drawn, &options).sections;
            sections.rails().iter().map(|column| crease(&sections, *column)).fold(0.0, f64::max)
        };
        let (smooth, linear) = (worst(Weights::Smooth), worst(Weights::Linear));
        assert!(smooth < 0.01, "{frame:?}: {smooth} degrees");
        assert!(linear > 2.0, "{frame:?}: {linear} degrees");
    }
}

#[test]
fn the_pole_is_smooth() {
    let drawn = sorted(&mouth(400));
    let made = run(&drawn, &GenerateOptions { sections: 65, ..options() }).sections;
    let spoke = |column: usize| leaving(|k| made.section(64 - k)[column]).normalize();
    let columns = made.rails();
    let normal = spoke(columns[0]).cross(spoke(columns[1])).normalize();
    for column in 0..made.nodes() {
        let off = out_of_plane(spoke(column), normal);
        assert!(off < 0.2, "column {column}: {off} degrees");
    }
}

#[test]
fn a_half_sphere_is_round_from_any_rails() {
    for count in [3, 4, 5, 8] {
        let made = run(&dome(count), &options());
        let off = made.sections.points().iter().map(|p| (p.length() / 0.1 - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 2e-5, "{count} rails: {off}");
    }
    let fixed = run(&dome(4), &GenerateOptions { frame: Frame::Fixed, ..options() });
    let off = fixed.sections.points().iter().map(|p| (p.length() / 0.1 - 1.0).abs()).fold(0.0, f64::max);
    assert!(off > 0.02, "as printed it has four flats: {off}");
}

#[test]
fn a_neighbour_is_continued_and_a_rail_bent_with_a_warning() {
    let (rails, rim) = dome(4);
    for (tilt, warned) in [(0.0, 0), (0.4, 4)] {
        let into = |p: DVec3| DVec3::Y - p.normalize() * tilt;
        let directions: Vec<DVec3> = rim.points().iter().map(|p| into(*p)).collect();
        for sections in [16, 33] {
            let options = GenerateOptions { sections, ..options() };
            let neighbour = Some(Neighbour::Directions(&directions));
            let made = to_apex(&rails, &rim, neighbour, &options, &|_| true).unwrap();
            assert_eq!(made.warnings.len(), warned, "{:?}", made.warnings);
            for column in 0..64 {
                let at = |k: usize| made.sections.section(k)[column];
                let normal = into(at(0)).cross(at(0).cross(DVec3::Y));
                let off = out_of_plane(leaving(at), normal);
                assert!(off < 0.1, "tilt {tilt}, {sections} sections, column {column}: {off}");
            }
        }
    }
}

#[test]
fn neither_start_nor_sense_nor_place_matters() {
    let [lips, parting, profile] = mouth(100);
    let one = run(&sorted(&[lips.clone(), parting.clone(), profile.clone()]), &options()).sections;
    let turned = [profile.clone().reversed(), lips.clone().reversed(), parting.clone().reversed()];
    assert!(apart(&one, &run(&sorted(&turned), &options()).sections, |p| p) < 1e-9);
    let (rails, start) = sorted(&[lips, parting, profile]);
    let there = (rails.iter().map(placed).collect(), placed(&start));
    assert!(apart(&one, &run(&there, &options()).sections, place) < 1e-11);
    // Symmetric lips, symmetric surface.
    for section in one.iter() {
        for p in section {
            let image = DVec3::new(-p.x, p.y, p.z);
            assert!(section.iter().any(|q| q.distance(image) < 1e-4), "{p}");
        }
    }
}

#[test]
fn errors() {
    let (rails, rim) = dome(4);
    let refused = |rails: &[Curve], start: &Curve| to_apex(rails, start, None, &options(), &|_| true).unwrap_err();
    let mut short = rails.clone();
    short[2] = open("short", 40, |t| rails[2].start().lerp(DVec3::Y * 0.03, t));
    let message = refused(&short, &rim).to_string();
    assert!(message.contains("where the rails meet") && message.contains("sort"), "{message}");
    assert_eq!(refused(&rails[..1], &rim), GenerateError::TooFewRails { found: 1 });
    assert!(matches!(refused(&rails, &rails[0]), GenerateError::CurveIsOpen { which: "start", .. }));
    let mut back = rails.clone();
    back[1] = back[1].clone().reversed();
    assert!(matches!(refused(&back, &rim), GenerateError::RailIsReversed { rail: 1, .. }));
    let mixed = [0, 2, 1, 3].map(|k| rails[k].clone());
    assert!(matches!(refused(&mixed, &rim), GenerateError::Crossing { .. }));
    let few = to_apex(&rails, &rim, Some(Neighbour::Directions(&[DVec3::Y])), &options(), &|_| true);
    assert!(matches!(few, Err(GenerateError::Border(BorderError::Count { .. }))));
    assert_eq!(to_apex(&rails, &rim, None, &options(), &|_| false), Err(GenerateError::Cancelled));
}
