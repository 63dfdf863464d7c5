//! One generator between two rails.

use glam::DVec3;

use crate::beam::OpenCardinals;

/// The generator with the weight `s` of the rail `c6` against the rail `c5` through the points `through`, one at each
/// node at which `functions` hold a position; one point a node (thesis 6.1-6.3 and appendix D).
///
/// The beam with the blended sculpting forces and end tangents of both rails that passes these points is exactly, also in
/// differences, `(1-s) c5 + s c6` plus, for each point, what it is off the blended rails times its cardinal function;
/// between two ends that is `(a - lerp_0) H00 + (b - lerp_1) H01`. No force and no tangent has to be computed. Rails and
/// functions are read up to the shortest of them.
pub fn blend_generators(
    c5: &[DVec3],
    c6: &[DVec3],
    s: f64,
    through: &[DVec3],
    functions: &OpenCardinals,
) -> Vec<DVec3> {
    let mut generator: Vec<DVec3> = c5.iter().zip(c6).map(|(p, q)| *p * (1.0 - s) + *q * s).collect();
    let held = || functions.held().iter().zip(through);
    let offsets: Vec<DVec3> =
        held().map(|(node, point)| generator.get(*node).map_or(DVec3::ZERO, |blended| *point - *blended)).collect();
    for (function, offset) in functions.positions().iter().zip(offsets) {
        for (point, weight) in generator.iter_mut().zip(function) {
            *point += offset * *weight;
        }
    }
    for (node, wanted) in held() {
        if let Some(point) = generator.get_mut(*node) {
            *point = *wanted;
        }
    }
    generator
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::{EndCondition, OpenBeam, OpenValues, Stiffness, sculpting_forces};

    fn points<const N: usize>(flat: [(f64, f64); N]) -> [DVec3; N] {
        flat.map(|(x, y)| DVec3::new(x, y, 0.0))
    }

    const C5: [(f64, f64); 6] = [(2.0, 0.0), (1.8, 0.5), (1.4, 0.9), (0.9, 1.1), (0.4, 1.1), (0.0, 1.0)];
    const C6: [(f64, f64); 6] = [(-1.0, 0.0), (-1.0, 0.4), (-0.8, 0.7), (-0.6, 0.9), (-0.3, 1.0), (0.0, 1.0)];

    #[test]
    fn generator_reference() {
        let wanted = points([
            (1.6, 0.2),
            (1.409814532772, 0.6520368758695),
            (1.07474573254, 0.9784261328797),
            (0.6502542674605, 1.12157386712),
            (0.2651854672284, 1.097963124131),
            (0.0, 1.0),
        ]);
        let basis = OpenCardinals::differences(6, &[], Stiffness::default()).unwrap();
        let ends = [DVec3::new(1.6, 0.2, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        let found = blend_generators(&points(C5), &points(C6), 0.25, &ends, &basis);
        assert!(found.iter().zip(wanted).all(|(f, w)| f.distance(w) < 1e-12), "{found:?}");
    }

    #[test]
    fn equals_the_beam_with_blended_forces() {
        let (c5, c6, s, stiffness) = (points(C5), points(C6), 0.6, Stiffness::default());
        let t = points([(-0.5, 3.0), (-1.5, -0.8), (0.2, 2.2), (1.4, 0.3)]);
        let (a, b) = (DVec3::new(1.0, 0.3, 0.2), DVec3::new(0.1, 0.9, -0.3));
        let f5 = sculpting_forces(&c5, t[0], t[1], stiffness).unwrap();
        let f6 = sculpting_forces(&c6, t[2], t[3], stiffness).unwrap();
        let forces: Vec<DVec3> = f5.iter().zip(&f6).map(|(f, g)| *f * (1.0 - s) + *g * s).collect();
        let beam = OpenBeam::new(6, &[], EndCondition::Clamped, EndCondition::Clamped, stiffness).unwrap();
        let values = OpenValues {
            left_tangent: t[0] * (1.0 - s) + t[2] * s,
            right_tangent: t[1] * (1.0 - s) + t[3] * s,
            forces: &forces,
            ..OpenValues::ends(a, b)
        };
        let solved = beam.solve(&values).unwrap();
        let blended = blend_generators(&c5, &c6, s, &[a, b], &OpenCardinals::differences(6, &[], stiffness).unwrap());
        assert!(solved.iter().zip(&blended).all(|(f, w)| f.distance(*w) < 1e-12), "{solved:?} {blended:?}");
    }

    #[test]
    fn reproduces_the_rails_and_survives_empty_ones() {
        let (c5, c6) = (points(C5), points(C6));
        let basis = OpenCardinals::differences(6, &[], Stiffness::default()).unwrap();
        assert_eq!(blend_generators(&c5, &c6, 0.0, &[c5[0], c5[5]], &basis), c5);
        assert_eq!(blend_generators(&c5, &c6, 1.0, &[c6[0], c6[5]], &basis), c6);
        assert!(blend_generators(&[], &c6, 1.0, &[c6[0], c6[5]], &basis).is_empty());
    }
}
