//! How generators walk along the curves they pass.

use glam::DVec3;

use super::Weights;
use super::feet::Feet;
use super::pace::Pace;
use crate::curve::{ArcLength, Curve};

/// A curve, or the apex in its place, walked from foot to foot.
#[derive(Clone, Debug)]
pub(super) struct Walk<'a> {
    /// None for an apex.
    arc: Option<ArcLength<'a>>,
    pub(super) feet: Feet,
    /// None for plain shares of the arc length.
    pace: Option<Pace>,
}

impl<'a> Walk<'a> {
    /// The walks along all curves that the same rails meet, each a closed one or each an open one. Smooth weights walk
    /// at a speed that does not jump at the feet.
    pub(super) fn all(curves: &[Option<&'a Curve>], feet: Vec<Feet>, closed: bool, weights: Weights) -> Vec<Self> {
        let pace = (weights == Weights::Smooth && feet[0].offsets.len() > 1).then(|| {
            let parameters = mean_offsets(&feet);
            move |feet: &Feet| {
                let (parameters, offsets) = (parameters.clone(), feet.offsets.clone());
                if closed { Pace::turn(parameters, offsets) } else { Pace::path(parameters, offsets) }
            }
        });
        let walk = |(curve, feet): (&Option<&'a Curve>, Feet)| Walk {
            arc: curve.map(ArcLength::of),
            pace: pace.as_ref().map(|pace| pace(&feet)),
            feet,
        };
        curves.iter().zip(feet).map(walk).collect()
    }

    /// The point at the share `t` of the way from foot `patch` to the next one.
    pub(super) fn point(&self, patch: usize, t: f64) -> DVec3 {
        match &self.arc {
            Some(arc) if t != 0.0 => arc.point_at(self.feet.origin + self.offset(patch, t)),
            _ => self.feet.points[patch],
        }
    }

    /// What lies there behind the first foot: arc length in metres, at an apex an angle.
    pub(super) fn offset(&self, patch: usize, t: f64) -> f64 {
        match &self.pace {
            _ if t == 0.0 => self.feet.offsets[patch],
            Some(pace) => pace.at(patch, t),
            None => self.feet.offsets[patch] * (1.0 - t) + self.feet.offsets[patch + 1] * t,
        }
    }
}

/// Offsets of the feet as shares of the whole, in the mean of all curves.
fn mean_offsets(feet: &[Feet]) -> Vec<f64> {
    let whole = |feet: &Feet| feet.offsets[feet.offsets.len() - 1];
    let mean = |k: usize| feet.iter().map(|feet| feet.offsets[k] / whole(feet)).sum::<f64>() / feet.len() as f64;
    (0..feet[0].offsets.len()).map(mean).collect()
}

/// `count` intervals shared out among the patches by the mean length of their pieces, at least two each. `offsets` are
/// those of the feet on each curve, metres.
pub(super) fn share_out(count: usize, offsets: &[&[f64]], notes: &mut Vec<String>) -> Vec<usize> {
    let mean = |k: usize| offsets.iter().map(|of| of[k + 1] - of[k]).sum::<f64>() / offsets.len() as f64;
    let lengths: Vec<f64> = (0..offsets[0].len() - 1).map(mean).collect();
    let whole: f64 = lengths.iter().sum();
    let mut intervals = vec![2; lengths.len()];
    let least = 2 * intervals.len();
    if count < least {
        notes.push(format!(
            "{count} intervals a section are too few for {} fields between rails: {least} are used, two from rail to \
             rail.",
            intervals.len()
        ));
    }
    for _ in least..count {
        // The patch that lacks most of its share; the first one where several do, so that the result is the same on
        // every run.
        let mut most = (0, f64::NEG_INFINITY);
        for (patch, (length, given)) in lengths.iter().zip(&intervals).enumerate() {
            let lacks = count as f64 * length / whole - *given as f64;
            if lacks > most.1 {
                most = (patch, lacks);
            }
        }
        intervals[most.0] += 1;
    }
    intervals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_shared_out_by_length_two_at_least() {
        let offsets = [0.0, 1.0, 1.1, 4.0];
        let mut notes = Vec::new();
        assert_eq!(share_out(40, &[&offsets, &offsets], &mut notes), [10, 2, 28]);
        assert!(notes.is_empty());
        assert_eq!(share_out(3, &[&offsets], &mut notes), [2, 2, 2]);
        assert!(notes[0].starts_with("3 intervals") && notes[0].contains("6 are used"), "{notes:?}");
    }

    #[test]
    fn open_and_closed_curves_are_walked_evenly_between_even_feet() {
        let line = Curve::new("line", vec![DVec3::ZERO, DVec3::X * 4.0], false).unwrap();
        let at = [0.0, 1.0, 3.0];
        let feet =
            || Feet { points: at.map(|x| DVec3::X * x).to_vec(), offsets: at.to_vec(), origin: 0.0, gaps: vec![] };
        for weights in [Weights::Smooth, Weights::Linear] {
            let walks = Walk::all(&[Some(&line), None], vec![feet(), feet()], false, weights);
            assert!(walks[0].point(1, 0.5).distance(DVec3::X * 2.0) < 1e-15);
            assert_eq!(walks[0].point(2, 0.0), DVec3::X * 3.0);
            assert_eq!(walks[1].point(0, 0.7), DVec3::ZERO);
            assert!((walks[1].offset(0, 0.7) - 0.7).abs() < 1e-15);
        }
    }
}
