//! Where all four rails meet in a point.

use glam::DVec3;

/// Largest distance of the ends that is closed to an apex, in the shortest rail's length. Our own choice: for contours
/// 40 cm long it is 2 cm, the default snap, and the rims of a short neck, which must stay open, are twice as far apart
/// as the neck is long. Anything from a few per cent to a half tells these apart.
const LARGEST: f64 = 0.05;

/// A point in which all four rails meet.
pub(super) struct Apex {
    pub(super) point: DVec3,
    /// From each rail's end to the point.
    pub(super) gaps: [DVec3; 4],
}

impl Apex {
    /// The apex of the ends at `which` side (`start` or `end`), where they lie within the snap and within [`LARGEST`] of
    /// the `shortest` rail's length; within the snap only, there is a warning.
    pub(super) fn find(
        ends: [DVec3; 4],
        which: &str,
        snap: f64,
        shortest: f64,
        warnings: &mut Vec<String>,
    ) -> Option<Self> {
        let apart = ends.iter().flat_map(|p| ends.iter().map(|q| p.distance(*q))).fold(0.0, f64::max);
        if apart.is_nan() || apart > snap {
            return None;
        }
        if apart > LARGEST * shortest {
            warnings.push(format!(
                "The rails {which} {apart:.4} m apart, within the snap of {snap} m but more than 5 % of the shortest \
                 one's length of {shortest:.4} m: the {which} stays open. Lower the snap to say so, or draw the rails \
                 to one point."
            ));
            return None;
        }
        let point = if apart == 0.0 { ends[0] } else { ends.iter().copied().sum::<DVec3>() / 4.0 };
        Some(Self { point, gaps: ends.map(|end| point - end) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_ends_that_are_near_for_their_length_meet() {
        let ends = |apart: f64| [DVec3::ZERO, DVec3::X * apart, DVec3::ZERO, DVec3::X * 0.5 * apart];
        let mut warnings = Vec::new();
        for (apart, snap, meets, warned) in [
            (0.0, 0.0, true, 0),
            (0.049, 0.05, true, 0),
            (0.049, 0.04, false, 0),
            (0.051, 10.0, false, 1),
            (2.0, 10.0, false, 1),
            (20.0, 10.0, false, 0),
        ] {
            warnings.clear();
            let found = Apex::find(ends(apart), "end", snap, 1.0, &mut warnings);
            assert_eq!((found.is_some(), warnings.len()), (meets, warned), "{apart} {snap}");
        }
        Apex::find(ends(0.1), "end", 0.2, 1.0, &mut warnings);
        assert!(warnings[0].contains("the end stays open"), "{warnings:?}");
    }
}
