//! The functions of u that blend the sections of a surface.

/// How a surface runs along u from section to section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The polynomial up to [`MOST_FOR_POLYNOMIAL`] sections, the spline for more.
    #[default]
    Automatic,
    /// The polynomial of the thesis (4.1): degree K-1 through K sections, one more for each condition at an end.
    ///
    /// Infinitely smooth, but it swings between the sections from about 8 of them on, worst near the ends. Computed in
    /// Chebyshev polynomials of 2u-1, whose system has a condition of 6 at 8 sections where that of the powers of u has
    /// 3e5.
    Polynomial,
    /// The C2 cubic spline. A section out of line is felt 3.7 times less with every section farther on.
    Spline,
}

impl Blend {
    /// Whether so many sections are blended by the polynomial.
    pub(crate) fn is_polynomial(self, sections: usize) -> bool {
        match self {
            Self::Automatic => sections <= MOST_FOR_POLYNOMIAL,
            Self::Polynomial => true,
            Self::Spline => false,
        }
    }
}

/// Sections up to which [`Blend::Automatic`] takes the polynomial.
pub const MOST_FOR_POLYNOMIAL: usize = 8;

/// Sections beyond which a polynomial is refused: its swing there is thousands of times any unevenness of the sections.
pub const MOST_OF_POLYNOMIAL: usize = 20;

/// The basis along u of a solved surface; what its rows of coefficients mean.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Along {
    /// Row n belongs to the Chebyshev polynomial T_n(2u-1).
    Polynomial { rows: usize },
    /// Three rows a knot: value, first and second derivative by u. Between knots they are joined by the polynomial of
    /// degree 5 that has all six, which is the spline's own cubic, or quartic or quintic where an end has a given
    /// second derivative.
    Spline { knots: Vec<f64> },
}

/// Weights of consecutive rows.
pub(crate) struct Weights {
    pub first: usize,
    /// For the value and the derivatives by u of first and second order.
    pub orders: [Vec<f64>; 3],
}

impl Along {
    pub fn weights(&self, u: f64) -> Weights {
        match self {
            Self::Polynomial { rows } => Weights { first: 0, orders: chebyshev(u, *rows) },
            Self::Spline { knots } => {
                let spans = knots.len() - 1;
                let span = knots.partition_point(|knot| *knot <= u).clamp(1, spans) - 1;
                let h = knots[span + 1] - knots[span];
                let t = (u - knots[span]) / h;
                Weights { first: 3 * span, orders: quintic(t, h) }
            }
        }
    }
}

/// Chebyshev polynomials of `2u - 1` and their derivatives by u, by their recurrences.
pub(crate) fn chebyshev(u: f64, count: usize) -> [Vec<f64>; 3] {
    let x = 2.0 * u - 1.0;
    let (mut value, mut first, mut second) = (vec![1.0, x], vec![0.0, 1.0], vec![0.0, 0.0]);
    for n in 1..count.max(2) - 1 {
        value.push(2.0 * x * value[n] - value[n - 1]);
        first.push(2.0 * value[n] + 2.0 * x * first[n] - first[n - 1]);
        second.push(4.0 * first[n] + 2.0 * x * second[n] - second[n - 1]);
    }
    first.iter_mut().for_each(|d| *d *= 2.0);
    second.iter_mut().for_each(|d| *d *= 4.0);
    let mut all = [value, first, second];
    all.iter_mut().for_each(|list| list.truncate(count));
    all
}

/// Weights of value, slope and second derivative at the start, then at the end, of an interval of length `h` at its
/// fraction `t` (quintic Hermite form), and of their derivatives by the parameter.
fn quintic(t: f64, h: f64) -> [Vec<f64>; 3] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    let (t3, s3) = (t2 * t, s2 * s);
    let value = vec![
        s3 * (1.0 + 3.0 * t + 6.0 * t2),
        h * t * s3 * (1.0 + 3.0 * t),
        0.5 * h * h * t2 * s3,
        t3 * (1.0 + 3.0 * s + 6.0 * s2),
        -h * s * t3 * (1.0 + 3.0 * s),
        0.5 * h * h * s2 * t3,
    ];
    let first = vec![
        -30.0 * t2 * s2 / h,
        s2 * (1.0 + 2.0 * t - 15.0 * t2),
        0.5 * h * t * s2 * (2.0 - 5.0 * t),
        30.0 * t2 * s2 / h,
        t2 * (1.0 + 2.0 * s - 15.0 * s2),
        -0.5 * h * s * t2 * (2.0 - 5.0 * s),
    ];
    let second = vec![
        -60.0 * t * s * (s - t) / (h * h),
        -12.0 * t * s * (3.0 - 5.0 * t) / h,
        s * (1.0 - 8.0 * t + 10.0 * t2),
        60.0 * t * s * (s - t) / (h * h),
        12.0 * t * s * (3.0 - 5.0 * s) / h,
        t * (1.0 - 8.0 * s + 10.0 * s2),
    ];
    [value, first, second]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_values() {
        let d = 1e-5;
        let spline = Along::Spline { knots: vec![0.0, 0.3, 0.7, 1.0] };
        for along in [Along::Polynomial { rows: 9 }, Along::Polynomial { rows: 2 }, spline] {
            for u in [0.05, 0.31, 0.5, 0.93] {
                let [before, at, after] = [u - d, u, u + d].map(|u| along.weights(u));
                for order in 0..2 {
                    for i in 0..at.orders[0].len() {
                        let slope = (after.orders[order][i] - before.orders[order][i]) / (2.0 * d);
                        let exact = at.orders[order + 1][i];
                        assert!((slope - exact).abs() < 2e-6 * (1.0 + exact.abs()), "{along:?} {u} {order} {i}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_knot_has_the_weight_of_its_own_rows_alone() {
        let spline = Along::Spline { knots: vec![0.0, 0.3, 0.7, 1.0] };
        for (u, first, place) in [(0.0, 0, 0), (0.3, 3, 0), (0.7, 6, 0), (1.0, 6, 3)] {
            let weights = spline.weights(u);
            assert_eq!(weights.first, first);
            for order in 0..3 {
                for (i, weight) in weights.orders[order].iter().enumerate() {
                    let expected = if i == place + order { 1.0 } else { 0.0 };
                    assert_eq!(*weight, expected, "{u} {order} {i}");
                }
            }
        }
    }

    #[test]
    fn chebyshev_polynomials_are_cosines() {
        for u in [0.0_f64, 0.2, 0.77, 1.0] {
            let angle = (2.0 * u - 1.0).acos();
            for (n, value) in chebyshev(u, 20)[0].iter().enumerate() {
                assert!((value - (n as f64 * angle).cos()).abs() < 1e-13);
            }
        }
        assert_eq!(chebyshev(0.5, 1)[0], [1.0]);
    }
}
