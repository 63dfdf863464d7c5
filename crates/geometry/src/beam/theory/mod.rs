//! How real beams and rings bend, in closed form or by the elastica: what the curves of this crate are measured against.
//!
//! Small deflections are those of Euler and Bernoulli, as in J. M. Gere and S. P. Timoshenko, *Mechanics of Materials*,
//! appendix G (beams), and S. P. Timoshenko, *Strength of Materials II* (rings); large ones are solutions of the
//! elastica, see [`bend`]. Lengths are metres, loads newtons, bending stiffness `EI` is in N m^2. None of them knows
//! stretching, shear or weight.

mod elastica;

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};

use glam::DVec2;

use elastica::{Elastica, Held};

/// What is loaded, and by which theory it bends. Beams lie along +x from the origin, and their loads and displacements
/// point along +y; rings stand about the origin, and two opposite loads pull them apart along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TheoryCase {
    /// Held fast at the origin, with a load `F` on the free end: `y = d x^2 (3 L - x) / (2 L^3)`, `d = F L^3 / (3 EI)`.
    Cantilever,
    /// Lying on both ends, with a load `F` in the middle: `y = d x (3 L^2 - 4 x^2) / L^3` up to the middle,
    /// `d = F L^3 / (48 EI)`.
    Supported,
    /// A thin ring of radius `R` that keeps its length: at the angle `t` from the load it moves outwards by
    /// `w = K (((pi/2 - t) cos t + sin t) / 4 - 1/pi)` and along itself by `-K (((pi/2 - t) sin t - 2 cos t) / 4 - t/pi +
    /// 1/2)`, `K = F R^3 / EI`. The half axis grows by `d = K (pi/8 - 1/pi)`, the other one by `-K (1/pi - 1/4)`.
    Ring,
    /// The cantilever bent far, its length kept: `EI k' = -F cos(angle)`, no curvature at the tip.
    CantileverElastica,
    /// The ring bent far, its length kept: `EI k' = -(F/2) sin(angle)` on a quarter whose ends keep their directions.
    RingElastica,
}

/// What is known of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Displacement of the loaded point: of the tip, of the middle, or the growth of a ring's half axis, metres.
    Displacement(f64),
    /// The load, newtons; on a ring each of the two.
    Load(f64),
}

/// A beam or ring under its load.
#[derive(Clone, Debug, PartialEq)]
pub struct TheoryShape {
    /// The points at rest, at equal arc length: `intervals + 1` of a beam, `intervals` of a ring, from the end of the
    /// half axis along +x counter-clockwise.
    pub rest: Vec<DVec2>,
    /// The same points under the load.
    pub bent: Vec<DVec2>,
    /// Displacement of the loaded point, metres.
    pub displacement: f64,
    /// The load, newtons.
    pub load: f64,
    /// What moves across the load: the growth of a ring's other half axis, or how far the tip of a cantilever draws
    /// back (0 where deflections are small), metres.
    pub across: f64,
}

/// Why no shape is found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TheoryError {
    /// A size or stiffness that is not above 0, or a load that is not finite.
    #[error("{what} is {value}: it must be a finite number{}", if *.positive { " above 0" } else { "" })]
    Number {
        /// Which one.
        what: &'static str,
        /// What was given.
        value: f64,
        /// Whether it must be above 0.
        positive: bool,
    },
    /// Too few or too many points.
    #[error("{found} intervals asked for, and there can be 4 to {}", super::MOST_NODES)]
    Intervals {
        /// Intervals asked for.
        found: usize,
    },
    /// A shape that an elastica does not reach, or reaches only beyond what is computed.
    #[error(
        "no elastica was found for this {what}: give less (a cantilever reaches 0.85 of its length to each side, the half \
         axis of a ring 0.4 to 1.4 of its radius)"
    )]
    TooFar {
        /// `displacement` or `load`.
        what: &'static str,
    },
}

/// The shape of a beam of length (of a ring of radius) `size` and bending stiffness `bending` under a load.
///
/// Exact for small deflections; an elastica is integrated to 1e-9 of `size` (Runge-Kutta of fourth order, Newton's method
/// on the curvature at the start and the load).
///
/// # Errors
/// [`TheoryError`].
pub fn bend(
    case: TheoryCase,
    size: f64,
    bending: f64,
    given: Given,
    intervals: usize,
) -> Result<TheoryShape, TheoryError> {
    for (what, value) in [("the size", size), ("the bending stiffness", bending)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(TheoryError::Number { what, value, positive: true });
        }
    }
    let (what, value) = match given {
        Given::Displacement(value) => ("displacement", value),
        Given::Load(value) => ("load", value),
    };
    if !value.is_finite() {
        return Err(TheoryError::Number { what, value, positive: false });
    }
    if !(4..=super::MOST_NODES).contains(&intervals) {
        return Err(TheoryError::Intervals { found: intervals });
    }
    let shape = match case {
        TheoryCase::Cantilever => {
            let shape = |x: f64| x * x * (3.0 - x) / 2.0;
            straight(size, intervals, Compliance::of(size, bending, 1.0 / 3.0).both(given), shape)
        }
        TheoryCase::Supported => {
            let half = |x: f64| x * (3.0 - 4.0 * x * x);
            straight(size, intervals, Compliance::of(size, bending, 1.0 / 48.0).both(given), |x| half(x.min(1.0 - x)))
        }
        TheoryCase::Ring => ring(size, intervals, Compliance::of(size, bending, PULLED).both(given)),
        TheoryCase::CantileverElastica => {
            let shape = Elastica::find(Held::Cantilever, scaled(given, size, bending * size.powi(-2)))
                .ok_or(TheoryError::TooFar { what })?;
            let bent: Vec<DVec2> = steps(intervals).map(|s| shape.point(s) * size).collect();
            let tip = bent.last().copied().unwrap_or_default();
            TheoryShape {
                rest: steps(intervals).map(|s| DVec2::X * (s * size)).collect(),
                bent,
                displacement: tip.y,
                load: shape.load * bending * size.powi(-2),
                across: tip.x - size,
            }
        }
        TheoryCase::RingElastica => {
            let quarter = size * FRAC_PI_2;
            // Two halves of the ring share each load.
            let given = match given {
                Given::Displacement(growth) => Given::Displacement(size + growth),
                load @ Given::Load(_) => load,
            };
            let unit = 2.0 * bending * quarter.powi(-2);
            let shape = Elastica::find(Held::Ring, scaled(given, quarter, unit)).ok_or(TheoryError::TooFar { what })?;
            let axes = shape.half_axes() * quarter;
            TheoryShape {
                rest: turns(intervals).map(|t| DVec2::from_angle(t) * size).collect(),
                bent: turns(intervals).map(|t| folded(t, |t| shape.ring_point(t / FRAC_PI_2) * quarter)).collect(),
                displacement: axes.x - size,
                load: shape.load * unit,
                across: axes.y - size,
            }
        }
    };
    let finite = shape.bent.iter().all(|p| p.is_finite()) && shape.load.is_finite() && shape.displacement.is_finite();
    if finite { Ok(shape) } else { Err(TheoryError::TooFar { what }) }
}

/// `d EI / (F R^3)` of a ring, half of the diameter's 0.1488.
const PULLED: f64 = PI / 8.0 - FRAC_2_PI / 2.0;
/// The same of the axis across the load, half of 0.1366.
const DRAWN_IN: f64 = FRAC_2_PI / 2.0 - 0.25;

/// Displacement by load.
struct Compliance(f64);

impl Compliance {
    fn of(size: f64, bending: f64, factor: f64) -> Self {
        Self(factor * size.powi(3) / bending)
    }

    /// Displacement and load.
    fn both(&self, given: Given) -> (f64, f64) {
        match given {
            Given::Displacement(displacement) => (displacement, displacement / self.0),
            Given::Load(load) => (load * self.0, load),
        }
    }
}

fn scaled(given: Given, length: f64, load: f64) -> Given {
    match given {
        Given::Displacement(value) => Given::Displacement(value / length),
        Given::Load(value) => Given::Load(value / load),
    }
}

fn steps(intervals: usize) -> impl Iterator<Item = f64> {
    (0..=intervals).map(move |k| k as f64 / intervals as f64)
}

fn turns(intervals: usize) -> impl Iterator<Item = f64> {
    (0..intervals).map(move |k| TAU * k as f64 / intervals as f64)
}

fn straight(
    length: f64,
    intervals: usize,
    (displacement, load): (f64, f64),
    shape: impl Fn(f64) -> f64,
) -> TheoryShape {
    TheoryShape {
        rest: steps(intervals).map(|x| DVec2::X * (x * length)).collect(),
        bent: steps(intervals).map(|x| DVec2::new(x * length, displacement * shape(x))).collect(),
        displacement,
        load,
        across: 0.0,
    }
}

fn ring(radius: f64, intervals: usize, (displacement, load): (f64, f64)) -> TheoryShape {
    let k = displacement / PULLED;
    let quarter = |t: f64| {
        let (sin, cos) = t.sin_cos();
        let out = k * (((FRAC_PI_2 - t) * cos + sin) / 4.0 - FRAC_2_PI / 2.0);
        let along = -k * (((FRAC_PI_2 - t) * sin - 2.0 * cos) / 4.0 - t / PI + 0.5);
        DVec2::new(cos, sin) * (radius + out) + DVec2::new(-sin, cos) * along
    };
    TheoryShape {
        rest: turns(intervals).map(|t| DVec2::from_angle(t) * radius).collect(),
        bent: turns(intervals).map(|t| folded(t, quarter)).collect(),
        displacement,
        load,
        across: -k * DRAWN_IN,
    }
}

/// A curve that is mirrored at both axes, from its first quarter.
fn folded(angle: f64, quarter: impl Fn(f64) -> DVec2) -> DVec2 {
    let half = if angle > PI { TAU - angle } else { angle };
    let within = if half > FRAC_PI_2 { PI - half } else { half };
    let point = quarter(within);
    DVec2::new(if half > FRAC_PI_2 { -point.x } else { point.x }, if angle > PI { -point.y } else { point.y })
}

#[cfg(test)]
mod tests {
    use super::*;
    use TheoryCase::{Cantilever, CantileverElastica, Ring, RingElastica, Supported};

    fn shape(case: TheoryCase, size: f64, given: Given) -> TheoryShape {
        bend(case, size, 0.03, given, 200).unwrap()
    }

    fn length(points: &[DVec2], closed: bool) -> f64 {
        let back = if closed { points[0].distance(points[points.len() - 1]) } else { 0.0 };
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>() + back
    }

    #[test]
    fn beams_bend_as_the_tables_say() {
        // 0.1 N on 30 cm: F L^3 / 3 EI = 3 cm; in the middle of both supports a sixteenth of it.
        let tip = shape(Cantilever, 0.3, Given::Load(0.1));
        assert!((tip.displacement - 0.03).abs() < 1e-15 && (tip.bent[200].y - 0.03).abs() < 1e-15);
        assert!((tip.bent[100].y - 0.03 * 5.0 / 16.0).abs() < 1e-15, "half way: 5/16 of the tip");
        let middle = shape(Supported, 0.3, Given::Load(0.1));
        assert!((middle.bent[100].y - 0.03 / 16.0).abs() < 1e-15 && middle.bent[200].y.abs() < 1e-15);
        assert!((middle.bent[50].y - 0.03 / 16.0 * 11.0 / 16.0).abs() < 1e-15, "a quarter in: 11/16 of the middle");
        assert!((middle.bent[30].y - middle.bent[170].y).abs() < 1e-15);
        for case in [Cantilever, Supported, Ring, CantileverElastica, RingElastica] {
            let by_way = shape(case, 0.3, Given::Displacement(0.02));
            let by_load = shape(case, 0.3, Given::Load(by_way.load));
            assert!((by_load.displacement - 0.02).abs() < 1e-9, "{case:?}: {by_load:?}");
        }
    }

    #[test]
    fn a_ring_grows_by_0_1488_and_shrinks_by_0_1366() {
        let pulled = shape(Ring, 1.0, Given::Load(0.03));
        assert!((2.0 * pulled.displacement - 0.1488).abs() < 5e-5 && (2.0 * pulled.across + 0.1366).abs() < 5e-5);
        for (node, wanted) in [(0, pulled.displacement), (50, pulled.across), (100, pulled.displacement)] {
            assert!((pulled.bent[node].length() - 1.0 - wanted).abs() < 1e-12, "{node}");
        }
        // It keeps its length to first order: a hundredth of the load leaves a ten-thousandth of the change.
        let change = |load: f64| length(&shape(Ring, 1.0, Given::Load(load)).bent, true) - length(&pulled.rest, true);
        assert!((change(0.003) / change(0.0003) - 100.0).abs() < 3.0, "{} {}", change(0.003), change(0.0003));
    }

    #[test]
    fn large_deflections_are_those_of_the_literature() {
        // F L^2 / EI, tip down, tip back: the integrals of K. E. Bisshopp and D. C. Drucker, Quart. Appl. Math. 3 (1945),
        // by Simpson's rule.
        for (load, down, back) in [
            (0.5, 0.1621435756583, 0.0159189624710),
            (1.0, 0.3017207737998, 0.0564332362835),
            (2.0, 0.4934574803967, 0.1606417208205),
            (10.0, 0.8106090248802, 0.5549955977537),
        ] {
            let found = bend(CantileverElastica, 1.0, 1.0, Given::Load(load), 64).unwrap();
            let off = DVec2::new(found.displacement - down, found.across + back);
            assert!(off.length() < 1e-9, "{load}: {off}");
            let other = bend(CantileverElastica, 1.0, 1.0, Given::Load(-load), 64).unwrap();
            assert!((other.displacement + down).abs() < 1e-9);
        }
    }

    #[test]
    fn an_elastica_keeps_its_length_and_is_the_small_theory_where_it_is_small() {
        for (case, small, closed) in [(CantileverElastica, Cantilever, false), (RingElastica, Ring, true)] {
            for given in [0.06, -0.06] {
                let far = shape(case, 0.15, Given::Displacement(given));
                let fine = bend(case, 0.15, 0.03, Given::Displacement(given), 8000).unwrap();
                let rest = length(&fine.rest, closed);
                assert!((length(&fine.bent, closed) / rest - 1.0).abs() < 1e-6, "{case:?} {given}");
                assert!((far.displacement - given).abs() < 1e-10);
            }
            let off = |given: f64| {
                let (a, b) =
                    (shape(case, 1.0, Given::Displacement(given)), shape(small, 1.0, Given::Displacement(given)));
                a.bent.iter().zip(&b.bent).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
            };
            let (coarse, fine) = (off(1e-2), off(1e-3));
            assert!(fine < 2e-6 && (coarse / fine - 100.0).abs() < 12.0, "{case:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn the_tyre_of_the_paper() {
        // Radius 1.5 cm pulled to a half axis of 1.8 cm: the other one is 1.1577 cm, 1.2245 cm by the small theory.
        let far = shape(RingElastica, 0.015, Given::Displacement(0.003));
        assert!((far.across + 0.015 - 0.011577).abs() < 5e-7, "{}", far.across);
        assert!((far.bent[50] - DVec2::new(0.0, 0.011577)).length() < 5e-7 && (far.bent[0].x - 0.018).abs() < 1e-12);
        assert!((shape(Ring, 0.015, Given::Displacement(0.003)).across + 0.015 - 0.012245).abs() < 5e-7);
    }

    #[test]
    fn an_elastica_is_found_as_far_as_promised() {
        for (case, far) in
            [(CantileverElastica, 0.85), (CantileverElastica, -0.85), (RingElastica, 0.4), (RingElastica, -0.6)]
        {
            let found = shape(case, 1.0, Given::Displacement(far));
            assert!((found.displacement - far).abs() < 1e-9, "{case:?} {far}: {}", found.displacement);
        }
    }

    #[test]
    fn errors() {
        let failed = |case, size, bending, given, intervals| bend(case, size, bending, given, intervals).unwrap_err();
        let way = Given::Displacement(0.1);
        assert!(matches!(failed(Ring, 0.0, 1.0, way, 64), TheoryError::Number { what: "the size", .. }));
        assert!(matches!(failed(Ring, 1.0, f64::NAN, way, 64), TheoryError::Number { .. }));
        assert!(matches!(failed(Ring, 1.0, 1.0, Given::Load(f64::INFINITY), 64), TheoryError::Number { .. }));
        assert_eq!(failed(Ring, 1.0, 1.0, way, 3), TheoryError::Intervals { found: 3 });
        for (case, given) in [
            (CantileverElastica, Given::Displacement(0.95)),
            (CantileverElastica, Given::Load(1e12)),
            (RingElastica, Given::Displacement(0.6)),
            (RingElastica, Given::Displacement(-0.9)),
            (RingElastica, Given::Load(-1e12)),
            (Cantilever, Given::Displacement(1e308 * 10.0_f64.powi(-0))),
        ] {
            if case == Cantilever {
                assert!(bend(case, 1e-9, 1e300, given, 8).is_err());
            } else {
                assert!(matches!(failed(case, 1.0, 1.0, given, 64), TheoryError::TooFar { .. }), "{case:?} {given:?}");
            }
        }
    }
}
