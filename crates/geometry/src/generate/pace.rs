//! How fast a closed curve is walked from foot to foot.

/// A monotone C1 function through given knots, of one turn or from end to end: it keeps the direction of the surface across a rail the
/// same on both sides, where plain shares of the arc length between two feet would change speed at each foot.
///
/// Piecewise cubic with the weighted harmonic mean of the neighbouring slopes (Fritsch and Butland), periodic up to the
/// length of the turn or with the outermost spans' own slopes at the ends. Linear where all slopes are equal, so that arc length stays arc length there.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Parameter at each knot, and at last that of the first one a turn later; increasing.
    parameters: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Pace {
    /// The pace through `(parameters[k], values[k])`, both strictly increasing; the last entry repeats the first one a
    /// turn later.
    pub(super) fn turn(parameters: Vec<f64>, values: Vec<f64>) -> Self {
        Self::with(parameters, values, |spans, slope| {
            let first = slope(spans - 1, 0);
            (first, first)
        })
    }

    /// The pace from end to end through `(parameters[k], values[k])`, both strictly increasing, two at least.
    pub(super) fn path(parameters: Vec<f64>, values: Vec<f64>) -> Self {
        Self::with(parameters, values, |spans, slope| (slope(0, 0), slope(spans - 1, spans - 1)))
    }

    /// `ends` gives the slopes at both ends from the number of spans and the mean slope of two spans.
    fn with(
        parameters: Vec<f64>,
        values: Vec<f64>,
        ends: impl Fn(usize, &dyn Fn(usize, usize) -> f64) -> (f64, f64),
    ) -> Self {
        let spans = parameters.len() - 1;
        let width = |k: usize| parameters[k + 1] - parameters[k];
        let chord = |k: usize| (values[k + 1] - values[k]) / width(k);
        let mean = |before: usize, k: usize| {
            let (w, v) = (2.0 * width(k) + width(before), width(k) + 2.0 * width(before));
            (w + v) / (w / chord(before) + v / chord(k))
        };
        let (first, last) = ends(spans, &mean);
        let mut slopes = vec![first];
        slopes.extend((1..spans).map(|k| mean(k - 1, k)));
        slopes.push(last);
        Self { parameters, values, slopes }
    }

    /// The value at the share `t` (0 to 1) of the span behind knot `span`.
    pub(super) fn at(&self, span: usize, t: f64) -> f64 {
        let width = self.parameters[span + 1] - self.parameters[span];
        let (from, to) = (self.values[span], self.values[span + 1]);
        let (r, bend) = (1.0 - t, t * (1.0 - t));
        // The cubic Hermite polynomial as the chord plus what its slopes differ from it.
        let chord = to - from;
        let (start, end) = (self.slopes[span] * width - chord, self.slopes[span + 1] * width - chord);
        from + chord * t + bend * (start * r - end * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_slopes_stay_linear() {
        for pace in [Pace::turn, Pace::path].map(|make| make(vec![0.0, 0.1, 0.6, 1.0], vec![2.0, 2.3, 3.8, 5.0])) {
            for (span, t, wanted) in [(0, 0.5, 2.15), (1, 0.2, 2.6), (2, 1.0, 5.0)] {
                assert!((pace.at(span, t) - wanted).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn passes_the_knots_smoothly_and_never_turns_back() {
        let (parameters, values) = (vec![0.0, 0.1, 0.5, 0.9, 1.0], vec![0.0, 0.5, 0.55, 0.6, 1.0]);
        let pace = Pace::turn(parameters.clone(), values.clone());
        let slope = |span: usize, t: f64, h: f64| {
            (pace.at(span, t + h) - pace.at(span, t)) / (h * (parameters[span + 1] - parameters[span]))
        };
        for span in 0..4 {
            assert_eq!((pace.at(span, 0.0), pace.at(span, 1.0)), (values[span], values[span + 1]));
            let next = (span + 1) % 4;
            let (left, right) = (slope(span, 1.0, -1e-7), slope(next, 0.0, 1e-7));
            assert!((left - right).abs() < 1e-4, "knot {next}: {left} {right}");
            let steps: Vec<f64> = (0..=100).map(|i| pace.at(span, f64::from(i) / 100.0)).collect();
            assert!(steps.windows(2).all(|w| w[1] >= w[0]), "span {span}");
        }
    }
}
