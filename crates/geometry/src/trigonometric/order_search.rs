//! How many harmonics a curve needs.

/// Allowed errors of a fit, as shares of the diagonal D of the curve's box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest mean distance E_a (thesis 3.10).
    pub mean: f64,
    /// Largest distance E_m (thesis 3.12).
    pub maximum: f64,
}

impl Default for Tolerances {
    /// 1 % and 2.5 % (thesis 3.13).
    fn default() -> Self {
        Self { mean: 0.01, maximum: 0.025 }
    }
}

impl Tolerances {
    /// Whether errors are within.
    pub fn met_by(&self, errors: Errors) -> bool {
        errors.mean <= self.mean && errors.maximum <= self.maximum
    }
}

/// Errors of a fit at its samples, as shares of the diagonal D of the curve's box.
///
/// Distances are between points of the same angle, which is never less than to the nearest point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Mean distance E_a (thesis 3.10).
    pub mean: f64,
    /// Largest distance E_m (thesis 3.12).
    pub maximum: f64,
}

/// What the search found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// The number of harmonics J.
    pub harmonics: usize,
    /// Whether it meets the tolerances; where not, it is the most allowed.
    pub met: bool,
}

/// The two numbers of harmonics from which the search goes out (thesis 3.1).
const PROBES: (usize, usize) = (3, 10);

/// The J from which fewer harmonics no longer meet the tolerances, by the flow chart of the thesis (Figure 3.3, its
/// text corrected): J1 by linear inter- or extrapolation of the errors at 3 and 10 harmonics, then one step at a time
/// down while J-1 passes, or up until both errors pass, from 1 up to `most`.
///
/// The error that is interpolated is the one that is not met; the mean where neither is; where both are, the one that
/// is the larger share of its tolerance. Errors need not fall with every harmonic, so a still smaller J than the one
/// found may pass too. `errors` is asked at most once for each J.
pub fn smallest_harmonics(tolerances: Tolerances, most: usize, errors: impl FnMut(usize) -> Errors) -> Found {
    let most = most.max(1);
    let mut known = Known { errors, found: vec![None; most + 1] };
    let passes = |errors: Errors| tolerances.met_by(errors);
    let (low, high) = (PROBES.0.min(most), PROBES.1.min(most));
    let (at_low, at_high) = (known.at(low), known.at(high));
    let mut harmonics = estimate(tolerances, (low, at_low), (high, at_high), most);
    if passes(known.at(harmonics)) {
        while harmonics > 1 && passes(known.at(harmonics - 1)) {
            harmonics -= 1;
        }
        return Found { harmonics, met: true };
    }
    while harmonics < most {
        harmonics += 1;
        if passes(known.at(harmonics)) {
            return Found { harmonics, met: true };
        }
    }
    // An estimate at the cap leaves what lies below it untried.
    match (1..most).find(|j| known.found[*j].is_some_and(passes)) {
        Some(harmonics) => Found { harmonics, met: true },
        None => Found { harmonics: most, met: false },
    }
}

struct Known<E> {
    errors: E,
    found: Vec<Option<Errors>>,
}

impl<E: FnMut(usize) -> Errors> Known<E> {
    fn at(&mut self, harmonics: usize) -> Errors {
        if let Some(known) = self.found[harmonics] {
            return known;
        }
        let new = (self.errors)(harmonics);
        self.found[harmonics] = Some(new);
        new
    }
}

/// J1, clamped to 1 .. `most`.
fn estimate(tolerances: Tolerances, low: (usize, Errors), high: (usize, Errors), most: usize) -> usize {
    if tolerances.met_by(low.1) && low.0 == 1 {
        return 1;
    }
    // The decision falls on the errors at the probe that is nearer to the wanted J.
    let deciding = if tolerances.met_by(high.1) { low.1 } else { high.1 };
    let shares = (deciding.mean / tolerances.mean, deciding.maximum / tolerances.maximum);
    let by_mean = match (shares.0 > 1.0, shares.1 > 1.0) {
        (true, _) => true,
        (false, true) => false,
        (false, false) => shares.0 >= shares.1,
    };
    let (wanted, from, to) = if by_mean {
        (tolerances.mean, low.1.mean, high.1.mean)
    } else {
        (tolerances.maximum, low.1.maximum, high.1.maximum)
    };
    if to >= from {
        // More harmonics do not help, and the slope says nothing.
        return if tolerances.met_by(low.1) { low.0 } else { most };
    }
    let j = low.0 as f64 + (high.0 - low.0) as f64 * (from - wanted) / (from - to);
    j.round().clamp(1.0, most as f64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(most: usize, error: impl Fn(f64) -> (f64, f64)) -> (Found, Vec<usize>) {
        let mut asked = Vec::new();
        let found = smallest_harmonics(Tolerances::default(), most, |j| {
            asked.push(j);
            let (mean, maximum) = error(j as f64);
            Errors { mean, maximum }
        });
        (found, asked)
    }

    /// The errors of reference value V04.
    #[test]
    fn the_estimate_of_the_reference() {
        let errors = |mean, maximum| Errors { mean, maximum };
        let low = (3, errors(0.01440035468362, 0.01854573027637));
        let high = (10, errors(0.0003588375123884, 0.0004728984414577));
        assert_eq!(estimate(Tolerances::default(), low, high, 19), 5);
    }

    #[test]
    fn steps_go_down_while_it_passes_and_up_until_it_does() {
        let (found, asked) = search(20, |j| (0.05 / j, 0.1 / j));
        assert_eq!((found, asked), (Found { harmonics: 5, met: true }, vec![3, 10, 7, 6, 5, 4]));
        let (found, asked) = search(20, |j| (0.5 * (-j / 2.0).exp(), 0.0));
        assert_eq!((found, asked), (Found { harmonics: 8, met: true }, vec![3, 10, 9, 8, 7]));
        let (found, asked) = search(30, |j| (0.14 / j, 0.0));
        assert_eq!((found, asked), (Found { harmonics: 14, met: true }, vec![3, 10, 11, 12, 13, 14]));
    }

    #[test]
    fn a_curve_that_passes_at_once_goes_down_to_one() {
        let (found, asked) = search(20, |j| (1e-17 * j, 0.0));
        assert_eq!((found, asked), (Found { harmonics: 1, met: true }, vec![3, 10, 2, 1]));
        assert_eq!(search(1, |_| (0.0, 0.0)).1, vec![1]);
    }

    #[test]
    fn hopeless_curves_end_at_the_cap() {
        assert_eq!(search(12, |_| (0.2, 0.2)).0, Found { harmonics: 12, met: false });
        assert_eq!(search(2, |_| (0.2, 0.2)).0, Found { harmonics: 2, met: false });
        assert_eq!(search(20, |j| (0.2 * j, f64::NAN)).0, Found { harmonics: 20, met: false });
        // What passed on the way is not forgotten.
        let (found, _) = search(20, |j| (0.02 + (j - 10.0).abs().min(1.0) - 0.02, 0.3 * f64::from(j != 10.0)));
        assert_eq!(found, Found { harmonics: 10, met: true });
    }
}
