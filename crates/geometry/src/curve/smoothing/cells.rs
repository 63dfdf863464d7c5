//! Stations gathered into cells, so that points drawn too densely do not spoil the precision of smoothing.

use super::smoothing_spline::Ends;

/// Share of the span below which two stations count as one.
const SAME: f64 = 1e-12;

/// Neighbouring stations gathered to cells. Parameters are shares of the span, counted from the first station.
pub(super) struct Cells {
    /// Where each cell stands: the mean of its stations, weighted; a held one at the end that is held.
    pub(super) times: Vec<f64>,
    /// How much of the span each cell stands for; they add up to 1. None for held ones, which do not give way.
    pub(super) weights: Vec<Option<f64>>,
    /// Of each station its cell, its parameter (below that of the first station where it belongs to the first cell of
    /// a closed curve), and its share in the mean of its cell.
    pub(super) members: Vec<(usize, f64, f64)>,
}

impl Cells {
    /// Gathers stations that lie less than `size` (a share of the span) behind the first one of their cell. `times`
    /// are the stations as shares of the span, not decreasing, from 0.
    pub(super) fn gather(times: &[f64], ends: Ends, size: f64) -> Self {
        let size = size.max(SAME);
        let count = times.len();
        let mut members: Vec<(usize, f64, f64)> = Vec::with_capacity(count);
        let mut starts: Vec<f64> = Vec::new();
        let held = match ends {
            Ends::Open { held } => held,
            Ends::Closed { .. } => [false; 2],
        };
        let mut last_begun = false;
        for (k, time) in times.iter().enumerate() {
            let in_last = held[1] && *time >= 1.0 - SAME;
            let leaves_first = held[0] && starts.len() == 1 && *time > SAME;
            let full = starts.last().is_none_or(|start| time - start >= size);
            if full || leaves_first || (in_last && !last_begun) {
                starts.push(*time);
            }
            last_begun |= in_last;
            members.push((starts.len() - 1, *time, trapezoid(times, k, ends)));
        }
        let mut cells = starts.len();
        if matches!(ends, Ends::Closed { .. }) && cells > 2 && starts.last().is_some_and(|start| 1.0 - start < size) {
            // The last cell reaches over the seam: its stations belong to the first one.
            cells -= 1;
            for member in members.iter_mut().filter(|member| member.0 == cells) {
                (member.0, member.1) = (0, member.1 - 1.0);
            }
        }
        let mut sums = vec![0.0; cells];
        members.iter().for_each(|(cell, _, weight)| sums[*cell] += weight);
        members.iter_mut().for_each(|(cell, _, weight)| *weight /= sums[*cell]);
        let mut means = vec![0.0; cells];
        members.iter().for_each(|(cell, time, share)| means[*cell] += share * time);
        let mut weights: Vec<Option<f64>> = sums.into_iter().map(Some).collect();
        for (held, station) in held.into_iter().zip([0, count - 1]) {
            if held {
                let cell = members[station].0;
                members.iter_mut().filter(|member| member.0 == cell).for_each(|member| member.2 = 0.0);
                members[station].2 = 1.0;
                (means[cell], weights[cell]) = (members[station].1, None);
            }
        }
        Self { times: means, weights, members }
    }
}

/// The share of the span that station `k` stands for: half the way to each of its neighbours.
fn trapezoid(times: &[f64], k: usize, ends: Ends) -> f64 {
    let last = times.len() - 1;
    let closed = matches!(ends, Ends::Closed { .. });
    let before = match k {
        0 if closed => times[last] - 1.0,
        _ => times[k.saturating_sub(1)],
    };
    let after = if k == last && closed { times[0] + 1.0 } else { times[(k + 1).min(last)] };
    0.5 * (after - before)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: Ends = Ends::Open { held: [false; 2] };

    #[test]
    fn weights_are_those_of_the_trapezoid_rule() {
        let cells = Cells::gather(&[0.0, 0.1, 0.4, 1.0], FREE, 0.01);
        assert_eq!(cells.times, [0.0, 0.1, 0.4, 1.0]);
        for (found, wanted) in cells.weights.iter().zip([0.05, 0.2, 0.45, 0.3]) {
            assert!((found.unwrap() - wanted).abs() < 1e-15);
        }
        let around = Cells::gather(&[0.0, 0.1, 0.4, 0.8], Ends::Closed { period: 1.0 }, 0.01);
        for (found, wanted) in around.weights.iter().zip([0.15, 0.2, 0.35, 0.3]) {
            assert!((found.unwrap() - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn dense_stations_share_a_cell_and_held_ones_stand_alone() {
        let times = [0.0, 0.001, 0.002, 0.5, 0.501, 0.9, 0.9999, 1.0];
        let cells = Cells::gather(&times, Ends::Open { held: [true, true] }, 0.01);
        let of: Vec<usize> = cells.members.iter().map(|m| m.0).collect();
        assert_eq!(of, [0, 1, 1, 2, 2, 3, 4, 5]);
        assert_eq!((cells.weights[0], cells.weights[5], cells.times[5]), (None, None, 1.0));
        let mean: f64 = cells.members.iter().filter(|m| m.0 == 2).map(|m| m.1 * m.2).sum();
        assert_eq!(mean, cells.times[2]);
        let twins = Cells::gather(&[0.0, 0.0, 0.5, 1.0, 1.0], Ends::Open { held: [true, true] }, 0.01);
        assert_eq!(
            twins.members.iter().map(|m| (m.0, m.2)).collect::<Vec<_>>(),
            [(0, 1.0), (0, 0.0), (1, 1.0), (2, 0.0), (2, 1.0)]
        );
    }

    #[test]
    fn a_cell_reaches_over_the_seam_of_a_closed_curve() {
        let cells = Cells::gather(&[0.0, 0.3, 0.6, 0.9, 0.999], Ends::Closed { period: 2.0 }, 0.01);
        assert_eq!((cells.times.len(), cells.members[4].0), (4, 0));
        assert!(cells.times[0] < 0.0 && cells.times[0] > -1e-3, "{}", cells.times[0]);
        assert!((cells.weights.iter().flatten().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
