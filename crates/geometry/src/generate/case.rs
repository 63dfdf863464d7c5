//! Which generator fits the curves at hand.

use super::GenerateError;

/// The cases of thesis 6 that are told apart by the numbers of open and closed curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// Four open rails, a pair from each of two views: [`super::two_views`].
    TwoViews,
    /// Two or more open rails between two closed curves: [`super::between_closed`].
    BetweenClosed,
}

impl Case {
    /// The case for so many open and closed curves.
    ///
    /// # Errors
    /// [`GenerateError::Unsupported`] where there is none, naming the combinations that exist.
    pub fn of(open_count: usize, closed_count: usize) -> Result<Self, GenerateError> {
        match (open_count, closed_count) {
            (4, 0) => Ok(Self::TwoViews),
            (2.., 2) => Ok(Self::BetweenClosed),
            (open, closed) => Err(GenerateError::Unsupported { open, closed }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_decide() {
        assert_eq!(Case::of(4, 0), Ok(Case::TwoViews));
        for open in [2, 4, 5, 100] {
            assert_eq!(Case::of(open, 2), Ok(Case::BetweenClosed));
        }
        for (open, closed) in [(0, 0), (1, 2), (2, 0), (5, 0), (4, 1), (4, 3), (0, 2)] {
            assert_eq!(Case::of(open, closed), Err(GenerateError::Unsupported { open, closed }));
        }
    }

    #[test]
    fn the_message_says_what_exists() {
        let message = GenerateError::Unsupported { open: 2, closed: 0 }.to_string();
        assert!(message.contains("2 open and 0 closed") && message.contains("give 4 open"), "{message}");
        assert!(message.contains("between 2 closed"), "{message}");
    }
}
