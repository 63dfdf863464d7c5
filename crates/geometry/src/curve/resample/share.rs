//! Sharing intervals out among the stretches of a curve.

use std::collections::BinaryHeap;

/// A stretch waiting for one more interval: the longest spacing first, then the first along the curve.
#[derive(PartialEq)]
struct Waiting {
    spacing: f64,
    stretch: usize,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.spacing.total_cmp(&other.spacing).then(other.stretch.cmp(&self.stretch))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Shares `total` intervals out among stretches, at least one each, such that the longest spacing is as short as it
/// can be (the divisor method of Adams). None where there are more stretches than intervals.
pub(super) fn by_count(lengths: &[f64], total: usize) -> Option<Vec<usize>> {
    let spare = total.checked_sub(lengths.len())?;
    let mut intervals = vec![1; lengths.len()];
    let mut waiting: BinaryHeap<Waiting> =
        lengths.iter().enumerate().map(|(stretch, length)| Waiting { spacing: *length, stretch }).collect();
    for _ in 0..spare {
        let Waiting { stretch, .. } = waiting.pop()?;
        intervals[stretch] += 1;
        waiting.push(Waiting { spacing: lengths[stretch] / intervals[stretch] as f64, stretch });
    }
    Some(intervals)
}

/// The nearest number of intervals of length `spacing` for each stretch, at least one each and `least` altogether.
/// None where they are more than `most`.
pub(super) fn by_spacing(lengths: &[f64], spacing: f64, most: usize, least: usize) -> Option<Vec<usize>> {
    let wanted: Vec<f64> = lengths.iter().map(|length| (length / spacing).round().max(1.0)).collect();
    let total: f64 = wanted.iter().sum();
    if total > most as f64 {
        None
    } else if total < least as f64 {
        by_count(lengths, least)
    } else {
        Some(wanted.into_iter().map(|count| count as usize).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_follow_length_and_minimise_the_longest_spacing() {
        assert_eq!(by_count(&[2.0, 1.0, 2.0, 1.0], 12), Some(vec![4, 2, 4, 2]));
        assert_eq!(by_count(&[10.0, 1e-9], 5), Some(vec![4, 1]));
        assert_eq!(by_count(&[1.0, 1.0], 3), Some(vec![2, 1]));
        assert_eq!(by_count(&[1.0, 1.0], 1), None);
    }

    #[test]
    fn spacing_rounds_to_the_nearest_count() {
        assert_eq!(by_spacing(&[1.4, 1.6, 0.1], 1.0, 100, 1), Some(vec![1, 2, 1]));
        assert_eq!(by_spacing(&[1.0], 10.0, 100, 3), Some(vec![3]));
        assert_eq!(by_spacing(&[1.0], 0.01, 100, 3), Some(vec![100]));
        assert_eq!(by_spacing(&[1.02], 0.01, 100, 3), None);
        assert_eq!(by_spacing(&[1.0], 1e-320, 100, 3), None);
    }
}
