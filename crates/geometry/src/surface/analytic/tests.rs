//! Surfaces as a whole: what they pass through, how they join, how smooth they are.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use proptest::prelude::*;

use super::*;
use crate::surface::{PoleShape, UParameter};
use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};

fn section(segments: Vec<EllipticSegment>) -> EllipticSection {
    let closed = segments[segments.len() - 1].to - segments[0].from > 4.0;
    EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Y), closed, segments).unwrap()
}

fn round(coefficients: Vec<DVec3>) -> EllipticSection {
    let series = Series::new(coefficients).unwrap();
    section(vec![EllipticSegment { from: 0.0, to: TAU, local: false, series }])
}

/// A circle about +Y, counter-clockwise about it, v = 0 at +Z.
fn circle(height: f64, radius: f64) -> EllipticSection {
    round(vec![DVec3::Y * height, DVec3::Z * radius, DVec3::X * radius])
}

fn point(height: f64) -> EllipticSection {
    round(vec![DVec3::Y * height])
}

/// A bent, lobed, tilted section.
fn lobed(i: usize) -> EllipticSection {
    let i = i as f64;
    let tilt = DVec3::Y * (0.08 * i.sin());
    round(vec![
        DVec3::new(0.1 * i.sin(), 0.5 * i, 0.05 * i * i),
        DVec3::Z * (1.0 + 0.1 * i.cos()) + tilt,
        DVec3::X * 0.8,
        DVec3::new(0.05 * i.cos(), 0.0, 0.04),
        DVec3::new(0.03, 0.01, -0.05 * i.sin()),
    ])
}

fn stack(count: usize) -> Vec<EllipticSection> {
    (0..count).map(lobed).collect()
}

fn with(blend: Blend, parameter: UParameter) -> SurfaceOptions {
    SurfaceOptions { blend, parameter, ..SurfaceOptions::default() }
}

const BLENDS: [Blend; 2] = [Blend::Polynomial, Blend::Spline];
const PARAMETERS: [UParameter; 3] = [UParameter::Uniform, UParameter::ChordLength, UParameter::Centripetal];

#[test]
fn sections_are_met_to_the_bit_and_given_back() {
    for blend in BLENDS {
        for parameter in PARAMETERS {
            let sections = stack(7);
            let surface = AnalyticSurface::through(&sections, &with(blend, parameter)).unwrap();
            assert_eq!((surface.blend(), surface.section_parameters().len()), (blend, 7));
            for (section, u) in sections.iter().zip(surface.section_parameters()) {
                for v in [0.0, 0.3, 2.0, 5.5, -1.0] {
                    assert!(surface.evaluate(*u, v).position.distance(section.point(v)) < 1e-14);
                }
                let back = surface.section_at(*u).unwrap();
                assert_eq!(back.segments(), section.segments());
                assert!(back.frame().normal.y > 0.9);
            }
            // Between them too, the section is the surface.
            let between = surface.section_at(0.4321).unwrap();
            for v in [0.1, 3.0, 6.0] {
                assert!(between.point(v).distance(surface.evaluate(0.4321, v).position) < 1e-13);
            }
        }
    }
}

#[test]
fn the_polynomial_is_taken_for_few_and_the_spline_for_many() {
    for (count, blend, constants) in [(2, Blend::Polynomial, 30), (8, Blend::Polynomial, 120), (9, Blend::Spline, 135)]
    {
        let surface = AnalyticSurface::through(&stack(count), &SurfaceOptions::default()).unwrap();
        assert_eq!((surface.blend(), surface.constants()), (blend, constants));
        assert!(surface.bytes() > 8 * constants);
    }
}

#[test]
fn derivatives_are_those_of_the_positions() {
    let h = 1e-5;
    for blend in BLENDS {
        let surface = AnalyticSurface::through(&stack(6), &with(blend, UParameter::Centripetal)).unwrap();
        for (u, v) in [(0.11, 0.4), (0.52, 3.0), (0.93, 5.9)] {
            let at = |u: f64, v: f64| surface.evaluate(u, v);
            let here = at(u, v);
            let du = (at(u + h, v).position - at(u - h, v).position) / (2.0 * h);
            let dv = (at(u, v + h).position - at(u, v - h).position) / (2.0 * h);
            assert!(du.distance(here.tangent_u) < 1e-6 && dv.distance(here.tangent_v) < 1e-6);
            assert!(here.normal.dot(du).abs() < 1e-6 && here.normal.dot(dv).abs() < 1e-6);
            assert!((here.normal.length() - 1.0).abs() < 1e-14);
            // Curvatures by how the normal turns: dn = -II I^-1 of the tangents; the trace and the determinant.
            let nu = (at(u + h, v).normal - at(u - h, v).normal) / (2.0 * h);
            let nv = (at(u, v + h).normal - at(u, v - h).normal) / (2.0 * h);
            let area = du.cross(dv).dot(here.normal);
            let gauss = nu.cross(nv).dot(here.normal) / area;
            let twice_mean = (nu.cross(dv) + du.cross(nv)).dot(here.normal) / area;
            let [k1, k2] = here.curvatures.unwrap();
            assert!(
                k1 >= k2 && (k1 * k2 - gauss).abs() < 1e-4 && (k1 + k2 - twice_mean).abs() < 1e-4,
                "{blend:?} {k1} {k2}"
            );
        }
    }
}

#[test]
fn a_paraboloid_is_exact_with_its_curvatures_and_tip() {
    // Radius u, height u squared: four sections make the polynomial exact, and its tip a point.
    let level = |u: f64| if u == 0.0 { point(0.0) } else { circle(u * u, u) };
    let sections: Vec<EllipticSection> = (0..5).map(|k| level(f64::from(k) / 4.0)).collect();
    let options = SurfaceOptions { pole: PoleShape::Pointed, ..with(Blend::Polynomial, UParameter::Uniform) };
    let surface = AnalyticSurface::through(&sections, &options).unwrap();
    for (u, v) in [(0.1, 0.3), (0.4, 2.0), (0.77, 4.0), (1.0, 6.0)] {
        let found = surface.evaluate(u, v);
        assert!(found.position.distance(DVec3::new(u * v.sin(), u * u, u * v.cos())) < 1e-13);
        // Opening upwards, its outside is below: convex.
        let w = (1.0 + 4.0 * u * u).sqrt();
        let [k1, k2] = found.curvatures.unwrap();
        let (meridian, parallel) = (2.0 / w.powi(3), 2.0 / w);
        assert!((k1 - parallel).abs() < 1e-10 && (k2 - meridian).abs() < 1e-10, "{u}: {k1} {k2}");
        assert!(found.normal.y < 0.0);
    }
    let tip = surface.evaluate(0.0, 1.0);
    assert!(tip.normal.distance(DVec3::NEG_Y) < 1e-12 && tip.tangent_v == DVec3::ZERO && tip.curvatures.is_none());
    assert!(surface.is_pole(0) && !surface.is_pole(1) && !surface.is_pole(99));
}

#[test]
fn round_poles_have_one_tangent_plane_and_pointed_ones_do_not() {
    let angle = |k: i32| PI * f64::from(k) / 12.0;
    let sphere: Vec<EllipticSection> = (0..=12)
        .map(|k| if k % 12 == 0 { point(-angle(k).cos()) } else { circle(-angle(k).cos(), angle(k).sin()) })
        .collect();
    let surface = AnalyticSurface::through(&sphere, &SurfaceOptions::default()).unwrap();
    for (u, normal) in [(0.0, DVec3::NEG_Y), (1.0, DVec3::Y)] {
        for v in [0.0, 1.0, 2.5, 5.0] {
            assert!(surface.evaluate(u, v).normal.distance(normal) < 1e-12, "{u} {v}");
        }
    }
    for i in 0..=100 {
        let found = surface.evaluate(f64::from(i) / 100.0, 0.7);
        assert!((found.position.length() - 1.0).abs() < 3e-4, "{i}: {}", found.position.length());
        assert!(found.normal.angle_between(found.position).to_degrees() < 0.3);
        if (10..=90).contains(&i) {
            assert!(found.curvatures.unwrap().iter().all(|k| (k - 1.0).abs() < 0.06), "{i}: {:?}", found.curvatures);
        }
    }
    let pointed = SurfaceOptions { pole: PoleShape::Pointed, ..SurfaceOptions::default() };
    let few: Vec<EllipticSection> = [0, 3, 6, 9, 12].map(|k: usize| sphere[k].clone()).to_vec();
    let spike = AnalyticSurface::through(&few, &SurfaceOptions { blend: Blend::Spline, ..pointed }).unwrap();
    let normals = [0.0, PI].map(|v| spike.evaluate(1.0, v).normal);
    assert!(normals[0].angle_between(normals[1]).to_degrees() > 10.0);
}

/// A section of segments that differ, C1 at joints: one series, and in each segment a bump that vanishes with its
/// first derivative at both joints.
fn composite(joints: &[f64], i: usize) -> EllipticSection {
    let base = lobed(i);
    let ends: Vec<f64> = joints.iter().copied().chain([joints[0] + TAU]).collect();
    let segment = |(k, pair): (usize, &[f64])| {
        // (1 - cos(v - a)) (1 - cos(v - b)) as a series of two harmonics.
        let (a, b) = (pair[0], pair[1]);
        let height = DVec3::new(0.05, 0.0, 0.08) * (1.0 + k as f64 + 0.2 * i as f64);
        let own = [
            1.0 + 0.5 * (a - b).cos(),
            -(a.cos() + b.cos()),
            -(a.sin() + b.sin()),
            0.5 * (a + b).cos(),
            0.5 * (a + b).sin(),
        ];
        let coefficients = base.segments()[0].series.coefficients();
        let series = Series::new(coefficients.iter().zip(own).map(|(c, o)| *c + height * o).collect()).unwrap();
        EllipticSegment { from: a, to: b, local: false, series }
    };
    section(ends.windows(2).enumerate().map(segment).collect())
}

/// Largest angle between the tangents along v on both sides of joints, degrees, at u between and at sections.
fn kink(surface: &AnalyticSurface) -> f64 {
    let mut worst = 0.0_f64;
    for joint in surface.joints() {
        for i in 0..=50 {
            let u = f64::from(i) / 50.0;
            let [before, after] = [joint - 1e-9, joint].map(|v| surface.evaluate(u, v));
            assert!(before.position.distance(after.position) < 1e-8);
            worst = worst.max(before.tangent_v.angle_between(after.tangent_v).to_degrees());
            worst = worst.max(before.normal.angle_between(after.normal).to_degrees());
        }
    }
    worst
}

#[test]
fn patches_are_smooth_across_common_joints() {
    for blend in BLENDS {
        let sections: Vec<EllipticSection> = (0..5).map(|i| composite(&[0.4, 2.1, 4.0], i)).collect();
        let surface = AnalyticSurface::through(&sections, &with(blend, UParameter::Centripetal)).unwrap();
        assert_eq!(surface.joints(), [0.4, 2.1, 4.0]);
        assert!(kink(&surface) < 1e-5, "{}", kink(&surface));
    }
}

#[test]
fn different_joints_are_brought_to_all_sections() {
    // A round section, one with two joints and one with three: the thesis's correspondence by index would tear here.
    let sections =
        [lobed(0), composite(&[1.036, 3.0], 1), composite(&[1.321, 3.0, 5.0], 2), composite(&[1.036, 4.0], 3)];
    let surface = AnalyticSurface::through(&sections, &SurfaceOptions::default()).unwrap();
    assert_eq!(surface.joints(), [1.036, 1.321, 3.0, 4.0, 5.0]);
    assert!(kink(&surface) < 1e-5, "{}", kink(&surface));
    for (section, u) in sections.iter().zip(surface.section_parameters()) {
        for k in 0..40 {
            let v = f64::from(k) * 0.16;
            assert!(surface.evaluate(*u, v).position.distance(section.point(v)) < 1e-13);
        }
    }
}

#[test]
fn local_angles_need_the_same_joints() {
    let local = |joint: f64, i: usize| {
        let segments = composite(&[joint, 3.0], i).segments().to_vec();
        section(segments.into_iter().map(|segment| EllipticSegment { local: true, ..segment }).collect())
    };
    let surface = AnalyticSurface::through(&[local(1.0, 0), local(1.0, 1)], &SurfaceOptions::default()).unwrap();
    for v in [0.2, 1.0, 2.9, 5.0] {
        assert!(surface.evaluate(1.0, v).position.distance(local(1.0, 1).point(v)) < 1e-13);
        let [at, near] = [v, v + 1e-6].map(|v| surface.evaluate(0.3, v));
        let slope = (near.position - at.position) / 1e-6;
        assert!(slope.distance(at.tangent_v) < 1e-4, "{v}: {slope} {}", at.tangent_v);
    }
    // A pole has any joints.
    let tip = AnalyticSurface::through(&[local(1.0, 0), local(1.0, 1), point(3.0)], &SurfaceOptions::default());
    assert!(tip.unwrap().is_pole(2));
    for other in [local(1.2, 1), lobed(1), composite(&[1.0, 3.0], 1)] {
        let error = AnalyticSurface::through(&[local(1.0, 0), other], &SurfaceOptions::default()).unwrap_err();
        assert!(matches!(error, SurfaceError::LocalAngles { section: 0 | 1, .. }), "{error}");
    }
}

#[test]
fn a_neighbour_of_another_length_is_continued_without_a_fold() {
    // Ten long, then one long: with the slope as printed (4.5) the new surface would run back first.
    let long: Vec<EllipticSection> = (0..3).map(|k| circle(5.0 * f64::from(k), 1.0)).collect();
    let short: Vec<EllipticSection> = (0..3).map(|k| circle(10.0 + 0.5 * f64::from(k), 1.0)).collect();
    for blend in BLENDS {
        for continuity in [Continuity::Tangent, Continuity::Curvature] {
            let plain = with(blend, UParameter::Uniform);
            let first = AnalyticSurface::through(&long, &plain).unwrap();
            let start = EndCondition::Neighbour { surface: first, continuity };
            let second = AnalyticSurface::through(&short, &SurfaceOptions { start, ..plain }).unwrap();
            for i in 0..=20 {
                let u = f64::from(i) / 20.0;
                assert!((second.evaluate(u, 1.0).position.y - 10.0 - u).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn neighbours_share_tangents_and_where_asked_curvatures() {
    let (below, between, above) = (stack(4), &stack(8)[3..6], &stack(12)[5..9]);
    for blend in BLENDS {
        let plain = with(blend, UParameter::Centripetal);
        let [low, high] = [&below[..], above].map(|sections| AnalyticSurface::through(sections, &plain).unwrap());
        for continuity in [Continuity::Tangent, Continuity::Curvature] {
            let neighbour =
                |surface: &AnalyticSurface| EndCondition::Neighbour { surface: surface.clone(), continuity };
            let options = SurfaceOptions { start: neighbour(&low), end: neighbour(&high), ..plain.clone() };
            let middle = AnalyticSurface::through(between, &options).unwrap();
            let rows = if continuity == Continuity::Tangent { 2 } else { 4 };
            assert_eq!(middle.constants(), 3 * 5 * (3 + rows));
            for k in 0..20 {
                let v = 0.31 * f64::from(k);
                for (a, b) in
                    [(low.evaluate(1.0, v), middle.evaluate(0.0, v)), (middle.evaluate(1.0, v), high.evaluate(0.0, v))]
                {
                    assert!(a.position.distance(b.position) < 1e-12);
                    assert!(a.tangent_u.angle_between(b.tangent_u).to_degrees() < 1e-5);
                    assert!(a.normal.angle_between(b.normal).to_degrees() < 1e-5);
                    let jump = (0..2).map(|i| (a.curvatures.unwrap()[i] - b.curvatures.unwrap()[i]).abs());
                    let jump = jump.fold(0.0, f64::max);
                    assert!(continuity == Continuity::Tangent || jump < 1e-9, "{blend:?}: {jump}");
                }
            }
        }
    }
}

#[test]
fn chains_are_smooth_and_damp_a_section_out_of_line() {
    let parts = |stack: &[EllipticSection]| [&stack[..4], &stack[3..5], &stack[4..12], &stack[11..]].map(<[_]>::to_vec);
    for (blend, continuity) in [
        (Blend::Automatic, Continuity::Tangent),
        (Blend::Polynomial, Continuity::Curvature),
        (Blend::Spline, Continuity::Tangent),
    ] {
        let chained = chain(&parts(&stack(16)), &with(blend, UParameter::Centripetal), continuity).unwrap();
        for pair in chained.windows(2) {
            for k in 0..20 {
                let v = 0.31 * f64::from(k);
                let (a, b) = (pair[0].evaluate(1.0, v), pair[1].evaluate(0.0, v));
                assert_eq!(a.position, b.position);
                assert!(a.tangent_u.angle_between(b.tangent_u).to_degrees() < 1e-5);
                if blend != Blend::Automatic {
                    let [ka, kb] = [a, b].map(|point| point.curvatures.unwrap());
                    assert!((ka[0] - kb[0]).abs() < 1e-8 && (ka[1] - kb[1]).abs() < 1e-8, "{blend:?} {ka:?} {kb:?}");
                }
            }
        }
    }
    // Four sections to a part, all of one radius but the fourth: one after the other, the ripple would stay at 3.3 %.
    let tube: Vec<EllipticSection> = (0..22).map(|k| circle(f64::from(k), if k == 3 { 1.05 } else { 1.0 })).collect();
    let quads: Vec<Vec<EllipticSection>> = (0..7).map(|p| tube[3 * p..3 * p + 4].to_vec()).collect();
    let chained = chain(&quads, &with(Blend::Automatic, UParameter::Uniform), Continuity::Tangent).unwrap();
    let ripple = |surface: &AnalyticSurface| {
        let off = |i: i32| {
            let p = surface.evaluate(f64::from(i) / 60.0, 1.0).position;
            (p.x.hypot(p.z) - 1.0).abs()
        };
        (0..=60).map(off).fold(0.0, f64::max)
    };
    let ripples: Vec<f64> = chained.iter().map(ripple).collect();
    for part in 2..6 {
        assert!(ripples[part] < ripples[part - 1] / 30.0, "{ripples:?}");
    }
    let mut one_by_one = SurfaceOptions::default();
    let mut last = 0.0;
    for sections in &quads {
        let surface = AnalyticSurface::through(sections, &one_by_one).unwrap();
        last = ripple(&surface);
        one_by_one.start = EndCondition::Neighbour { surface, continuity: Continuity::Tangent };
    }
    assert!(last > 0.01, "the chain one by one ripples on: {last}");
}

#[test]
fn more_sections_mean_less_error_and_no_ripple() {
    // Radius of a limb: swelling, waist, swelling.
    let radius = |y: f64| 0.06 + 0.02 * (5.0 * y).sin() + 0.01 * (11.0 * y + 1.0).cos();
    let mut before = f64::INFINITY;
    for count in [6, 9, 12, 20, 50, 100, 200] {
        let sections: Vec<EllipticSection> =
            (0..count).map(|k| f64::from(k) / f64::from(count - 1)).map(|y| circle(y, radius(y))).collect();
        let surface = AnalyticSurface::through(&sections, &with(Blend::Automatic, UParameter::Centripetal)).unwrap();
        let (mut worst, mut turns, mut side) = (0.0_f64, 0, 0.0);
        for i in 0..=4000 {
            let [a, b, c] =
                [-1e-3, 0.0, 1e-3].map(|d| surface.evaluate(f64::from(i) / 4000.0 * 0.998 + 1e-3 + d, 0.4).position);
            let size = |p: DVec3| p.x.hypot(p.z);
            worst = worst.max((size(b) - radius(b.y)).abs());
            // The side to which the profile bends, where it clearly does.
            let bend = size(a) - 2.0 * size(b) + size(c);
            if bend.abs() > 2e-8 {
                turns += usize::from(bend * side < 0.0);
                side = bend;
            }
        }
        assert!(worst < before || worst < 1e-7, "{count} sections: {worst}, before {before}");
        assert!(turns <= 4, "{count} sections bend {turns} times to the other side");
        before = worst;
    }
    assert!(before < 1e-7);
}

#[test]
fn half_the_numbers_are_nearly_the_same_surface() {
    let surface = AnalyticSurface::through(&stack(12), &SurfaceOptions::default()).unwrap();
    let fewer = surface.with_harmonics(1).unwrap();
    assert_eq!((fewer.harmonics(), fewer.constants()), (1, 3 * 3 * 12));
    for (k, u) in surface.section_parameters().iter().enumerate() {
        let exact = round(lobed(k).segments()[0].series.coefficients()[..3].to_vec());
        assert!(fewer.evaluate(*u, 1.0).position.distance(exact.point(1.0)) < 1e-14);
    }
    let sparse = surface.with_sections(7).unwrap();
    assert_eq!(sparse.section_parameters().len(), 7);
    assert!(sparse.section_parameters().iter().all(|u| surface.section_parameters().contains(u)));
    let apart = (0..=60)
        .map(|i| f64::from(i) / 60.0)
        .map(|u| surface.evaluate(u, 2.0).position.distance(sparse.evaluate(u, 2.0).position));
    let apart = apart.fold(0.0, f64::max);
    assert!(apart > 1e-4 && apart < 0.05, "{apart}");
    let again = AnalyticSurface::through(&stack(12), &SurfaceOptions::default()).unwrap();
    assert_eq!(surface.numbers(), again.numbers());
    let natural = SurfaceOptions { start: EndCondition::Natural, ..SurfaceOptions::default() };
    let natural = AnalyticSurface::through(&stack(12), &natural).unwrap();
    assert!(surface.numbers() != natural.numbers() && surface.numbers() != fewer.numbers());
    assert_eq!(surface.with_harmonics(2).unwrap(), surface);
    assert_eq!(surface.with_sections(12).unwrap(), surface);
    assert_eq!(surface.with_sections(1).unwrap_err().to_string(), "1 sections asked for, and there can be 2 to 12");
    assert!(matches!(surface.with_harmonics(0), Err(SurfaceError::OutOfRange { .. })));
    let patches: Vec<EllipticSection> = (0..4).map(|i| composite(&[0.4, 2.1], i)).collect();
    let patches = AnalyticSurface::through(&patches, &SurfaceOptions::default()).unwrap();
    assert_eq!(patches.with_harmonics(1), Err(SurfaceError::SeveralPieces));
}

#[test]
fn the_order_of_a_chain_is_found() {
    let all = stack(12);
    let parts = [all[7..].to_vec(), all[..4].to_vec(), all[3..8].to_vec()];
    assert_eq!(chain_order(&parts), Ok(vec![1, 2, 0]));
    assert!(
        chain(&[parts[1].clone(), parts[2].clone(), parts[0].clone()], &SurfaceOptions::default(), Continuity::Tangent)
            .is_ok()
    );
    assert_eq!(chain_order(&parts[..1]), Ok(vec![0]));
    assert_eq!(chain_order(&[]), Err(ChainOrderError::NoParts));
    let backwards: Vec<EllipticSection> = parts[0].iter().rev().cloned().collect();
    let opposed = ChainOrderError::Opposed { first: 0, second: 1, side: Side::End };
    assert_eq!(chain_order(&[parts[2].clone(), backwards.clone()]), Err(opposed.clone()));
    assert!(opposed.to_string().starts_with("parts 0 and 1 both end in the same section"), "{opposed}");
    let opposed = ChainOrderError::Opposed { first: 0, second: 1, side: Side::Start };
    assert_eq!(chain_order(&[parts[0].clone(), all[7..9].to_vec()]), Err(opposed));
    let forked = ChainOrderError::Forked { part: 0, first: 1, second: 2 };
    assert_eq!(chain_order(&[parts[2].clone(), parts[0].clone(), all[7..9].to_vec()]), Err(forked));
    assert_eq!(chain_order(&parts[..2]), Err(ChainOrderError::Apart { first: 0, second: 1 }));
    assert_eq!(
        chain_order(&[all[..2].to_vec(), all[..1].to_vec()]),
        Err(ChainOrderError::TooFewSections { part: 1, found: 1 })
    );
    let ring = [all[..4].to_vec(), [&all[3..6], &all[..1]].concat()];
    assert_eq!(chain_order(&ring), Err(ChainOrderError::Ring));
    // Two that end in one section, before a third.
    let merging = [parts[1].clone(), all[2..4].to_vec(), parts[2].clone()];
    assert_eq!(chain_order(&merging), Err(ChainOrderError::Opposed { first: 0, second: 1, side: Side::End }));
}

#[test]
fn any_u_and_v_have_a_point() {
    let open = |i: usize| {
        let series = lobed(i).segments()[0].series.clone();
        section(vec![EllipticSegment { from: 0.0, to: PI, local: false, series }])
    };
    let sheet = AnalyticSurface::through(&[open(0), open(1), open(2)], &SurfaceOptions::default()).unwrap();
    assert!(!sheet.is_closed() && sheet.joints().is_empty());
    assert_eq!(sheet.evaluate(2.0, 9.0).position, sheet.evaluate(1.0, PI).position);
    let tube = AnalyticSurface::through(&stack(3), &SurfaceOptions::default()).unwrap();
    for surface in [sheet, tube] {
        for wild in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e-300] {
            assert!(surface.evaluate(wild, 1.0).position.is_finite());
            assert!(surface.evaluate(0.5, wild).position.is_finite());
        }
    }
}

#[test]
fn what_makes_no_surface_is_refused_with_its_place() {
    let refuse = |sections: &[EllipticSection]| {
        AnalyticSurface::through(sections, &SurfaceOptions::default()).unwrap_err().to_string()
    };
    assert_eq!(refuse(&[]), "0 section(s) given, and a surface needs at least 2");
    let twice = [circle(0.0, 1.0), circle(1.0, 1.0), circle(1.0, 1.0)];
    assert_eq!(refuse(&twice), "sections 1 and 2 are identical, and no surface lies between them: move or remove one");
    let tips = [circle(0.0, 1.0), point(1.0), point(2.0)];
    assert!(refuse(&tips).starts_with("sections 1 and 2 are each a single point"));
    let open = section(vec![EllipticSegment {
        from: 0.0,
        to: PI,
        local: false,
        series: lobed(0).segments()[0].series.clone(),
    }]);
    assert_eq!(
        refuse(&[lobed(1), open.clone()]),
        "section 1 is open, and section 0 is not: close all sections or none"
    );
    assert!(refuse(&[circle(0.0, 1.0), circle(1e150, 1.0)]).starts_with("a coefficient of section 1 is 1e150 m"));
    let options = with(Blend::Polynomial, UParameter::Uniform);
    let error = AnalyticSurface::through(&stack(21), &options).unwrap_err();
    assert_eq!(error, SurfaceError::TooManyForPolynomial { sections: 21 });

    let surface = AnalyticSurface::through(&stack(3), &SurfaceOptions::default()).unwrap();
    let start = EndCondition::Neighbour { surface, continuity: Continuity::Tangent };
    let options = SurfaceOptions { start, ..SurfaceOptions::default() };
    let error = AnalyticSurface::through(&stack(3)[1..], &options).unwrap_err();
    assert!(matches!(error, SurfaceError::NotShared { side: Side::Start, distance } if distance > 0.1), "{error}");
    let error = AnalyticSurface::through(&[open.clone(), open], &options).unwrap_err();
    assert_eq!(error, SurfaceError::OtherNeighbour { side: Side::Start });

    let error = chain(&[stack(3), stack(3)], &SurfaceOptions::default(), Continuity::Tangent).unwrap_err();
    assert!(matches!(error, SurfaceError::BrokenChain { part: 0, .. }), "{error}");
    let twice = [stack(3), vec![lobed(2), lobed(3), lobed(3)]];
    let error = chain(&twice, &SurfaceOptions::default(), Continuity::Tangent).unwrap_err();
    assert_eq!(
        error.to_string(),
        "part 1 of the chain: sections 1 and 2 are identical, and no surface lies between them: move or remove one"
    );
    assert!(chain(&[], &SurfaceOptions::default(), Continuity::Tangent).is_err());
    let short = chain(&[stack(3), vec![lobed(2)]], &SurfaceOptions::default(), Continuity::Tangent).unwrap_err();
    assert!(matches!(short, SurfaceError::Part { part: 1, .. }), "{short}");
}

fn series() -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 5)
        .prop_map(|list| list.into_iter().map(DVec3::from).collect())
}

fn stacks() -> impl Strategy<Value = (Vec<EllipticSection>, SurfaceOptions)> {
    let sections = prop::collection::vec(series(), 2..12).prop_map(|stack| {
        let lifted = stack.into_iter().enumerate().map(|(i, mut c)| {
            c[0] += DVec3::Y * 2.0 * i as f64;
            c[1] += DVec3::Z * 3.0;
            c[2] += DVec3::X * 3.0;
            round(c)
        });
        lifted.collect::<Vec<_>>()
    });
    (sections, 0..2_usize, 0..3_usize).prop_map(|(sections, b, p)| (sections, with(BLENDS[b], PARAMETERS[p])))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// A surface with even u moves with its sections under any affine map; under those that keep angles, always.
    #[test]
    fn surfaces_move_with_their_sections((sections, options) in stacks(), entries in prop::array::uniform12(-2.0..2.0_f64)) {
        let mut map = DAffine3::from_cols_array(&entries);
        if options.parameter != UParameter::Uniform {
            let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, entries[0], entries[1], entries[2]);
            map = DAffine3::from_scale_rotation_translation(DVec3::splat(0.3 + entries[3].abs()), turn, map.translation);
        }
        let moved: Vec<EllipticSection> = sections.iter().map(|s| s.transformed(&map).unwrap()).collect();
        let surface = AnalyticSurface::through(&sections, &options).unwrap();
        // A map that flattens all sections into one leaves no surface.
        prop_assume!(map.matrix3.determinant().abs() > 1e-2);
        let of_moved = AnalyticSurface::through(&moved, &options).unwrap();
        for (u, v) in [(0.0, 0.1), (0.17, 1.0), (0.5, 3.0), (0.81, 6.0)] {
            let expected = map.transform_point3(surface.evaluate(u, v).position);
            prop_assert!(of_moved.evaluate(u, v).position.distance(expected) < 1e-9 * (1.0 + expected.length()));
        }
    }

    /// Neither the end from which sections are counted, nor the direction of v, nor where v begins changes the surface.
    #[test]
    fn surfaces_are_the_same_from_either_end_and_any_start((sections, options) in stacks(), start in 0.0..TAU) {
        let surface = AnalyticSurface::through(&sections, &options).unwrap();
        let series = |section: &EllipticSection| section.segments()[0].series.clone();
        let turned: Vec<EllipticSection> =
            sections.iter().map(|s| round(series(s).started_at(start).coefficients().to_vec())).collect();
        let reversed: Vec<EllipticSection> =
            sections.iter().rev().map(|s| round(series(s).reversed().coefficients().to_vec())).collect();
        let (turned, reversed) =
            (AnalyticSurface::through(&turned, &options).unwrap(), AnalyticSurface::through(&reversed, &options).unwrap());
        let scale = sections.len() as f64;
        for (u, v) in [(0.0, 0.1), (0.17, 1.0), (0.5, 3.0), (0.81, 6.0)] {
            let expected = surface.evaluate(u, v);
            let a = turned.evaluate(u, v - start);
            let b = reversed.evaluate(1.0 - u, -v);
            prop_assert!(a.position.distance(expected.position) < 1e-9 * scale);
            prop_assert!(b.position.distance(expected.position) < 1e-9 * scale);
            prop_assert!(a.normal.distance(expected.normal) < 1e-6 && b.normal.distance(expected.normal) < 1e-6);
        }
    }
}
