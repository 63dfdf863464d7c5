//! How strongly a beam resists bending and stretching.

/// Bending stiffness `k_b > 0` and stretching stiffness `k_s >= 0` of thesis 5.5, without unit.
///
/// Pins and prescribed tangents feel only their ratio: `lambda = sqrt(k_s / k_b)`, 0 for a cubic spline, large for a
/// taut string. Forces feel both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    k_b: f64,
    k_s: f64,
}

/// Why two numbers do not make a stiffness.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StiffnessError {
    /// A bending stiffness that is not above 0, or not finite.
    #[error("bending stiffness k_b is {k_b}: it must be a finite number above 0 (the thesis uses 0.5)")]
    Bending {
        /// What was given.
        k_b: f64,
    },
    /// A stretching stiffness below 0, or not finite.
    #[error("stretching stiffness k_s is {k_s}: it must be a finite number, 0 or above (the thesis uses 1.4)")]
    Stretching {
        /// What was given.
        k_s: f64,
    },
    /// A ratio that leaves nothing of the bending.
    #[error(
        "k_s / k_b is {ratio:e}, above {:e}: raise the bending stiffness or lower the stretching stiffness",
        Stiffness::LARGEST_RATIO
    )]
    Ratio {
        /// `k_s / k_b`.
        ratio: f64,
    },
}

impl Stiffness {
    /// Largest `k_s / k_b` permitted: beyond it the curve is a string to within one part in a million.
    pub const LARGEST_RATIO: f64 = 1e12;

    /// The thesis' choice, `k_b = 0.5` and `k_s = 1.4`.
    pub const THESIS: Self = Self { k_b: 0.5, k_s: 1.4 };

    /// Makes a stiffness.
    ///
    /// # Errors
    /// [`StiffnessError`] where `k_b <= 0`, `k_s < 0`, one is not finite, or their ratio exceeds
    /// [`Stiffness::LARGEST_RATIO`].
    pub fn new(k_b: f64, k_s: f64) -> Result<Self, StiffnessError> {
        if !(k_b.is_finite() && k_b > 0.0) {
            return Err(StiffnessError::Bending { k_b });
        }
        if !(k_s.is_finite() && k_s >= 0.0) {
            return Err(StiffnessError::Stretching { k_s });
        }
        let ratio = k_s / k_b;
        if ratio > Self::LARGEST_RATIO {
            return Err(StiffnessError::Ratio { ratio });
        }
        Ok(Self { k_b, k_s })
    }

    /// Bending stiffness `k_b`.
    pub fn bending(self) -> f64 {
        self.k_b
    }

    /// Stretching stiffness `k_s`.
    pub fn stretching(self) -> f64 {
        self.k_s
    }

    /// `k_s / k_b`, the square of `lambda`.
    pub fn ratio(self) -> f64 {
        self.k_s / self.k_b
    }
}

impl Default for Stiffness {
    /// [`Stiffness::THESIS`].
    fn default() -> Self {
        Self::THESIS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_stiffness() {
        for k_b in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Stiffness::new(k_b, 1.0), Err(StiffnessError::Bending { .. })));
        }
        for k_s in [-1e-9, f64::NAN, f64::INFINITY] {
            assert!(matches!(Stiffness::new(1.0, k_s), Err(StiffnessError::Stretching { .. })));
        }
        assert_eq!(Stiffness::new(1e-6, 1e7), Err(StiffnessError::Ratio { ratio: 1e7 / 1e-6 }));
        assert!(matches!(Stiffness::new(1e-300, 1e300), Err(StiffnessError::Ratio { .. })));
    }

    #[test]
    fn keeps_what_it_is_given() {
        let stiffness = Stiffness::new(0.5, 1.4).unwrap();
        assert_eq!((stiffness.bending(), stiffness.stretching(), stiffness.ratio()), (0.5, 1.4, 1.4 / 0.5));
        assert_eq!(stiffness, Stiffness::default());
        assert_eq!(Stiffness::new(2.0, 0.0).unwrap().ratio(), 0.0);
    }
}
