//! Parameter intervals of the splines of a skin, shared by all its columns and all its sections.

use glam::DVec3;

use crate::sections::Sections;

/// How far apart in parameter neighbouring sections lie (u of the thesis, along the stack), and likewise neighbouring
/// points of the sections.
///
/// All columns share one interval a pair of sections, the mean over the columns, and all sections one interval a pair
/// of points: only so is the surface C2 across every line of the net, and not only along it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UParameter {
    /// Equal intervals, as the thesis has it (eq. 4.3). Swings where distances differ much.
    Uniform,
    /// Intervals proportional to the distance.
    ChordLength,
    /// Intervals proportional to the square root of the distance: the least swinging where distances differ much.
    #[default]
    Centripetal,
}

impl UParameter {
    pub(super) fn interval(self, distance: f64) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::ChordLength => distance,
            Self::Centripetal => distance.sqrt(),
        }
    }
}

/// Intervals between neighbouring sections.
pub(crate) fn along(sections: &Sections, parameter: UParameter) -> Vec<f64> {
    let rows: Vec<&[DVec3]> = sections.iter().collect();
    let mean = |pair: &[&[DVec3]]| {
        let sum: f64 = pair[0].iter().zip(pair[1]).map(|(a, b)| parameter.interval(a.distance(*b))).sum();
        sum / sections.nodes() as f64
    };
    lifted(rows.windows(2).map(mean).collect())
}

/// Intervals between neighbouring points of the sections, from the last to the first too where they are closed.
pub(crate) fn across(sections: &Sections, parameter: UParameter, poles: &[bool]) -> Vec<f64> {
    let nodes = sections.nodes();
    let spans = if sections.is_closed() { nodes } else { nodes - 1 };
    let mut mean = vec![0.0; spans];
    let mut own = vec![0.0; spans];
    for (row, _) in sections.iter().zip(poles).filter(|(_, pole)| !**pole) {
        for (j, own) in own.iter_mut().enumerate() {
            *own = parameter.interval(row[j].distance(row[if j + 1 == nodes { 0 } else { j + 1 }]));
        }
        // Small sections have the same say as large ones.
        let total: f64 = own.iter().sum();
        for (mean, own) in mean.iter_mut().zip(&own) {
            *mean += own / total;
        }
    }
    lifted(mean)
}

/// Points that coincide in all rows get a small interval instead of none, which no spline can have.
pub(super) fn lifted(mut intervals: Vec<f64>) -> Vec<f64> {
    let largest = intervals.iter().copied().fold(0.0, f64::max);
    for interval in &mut intervals {
        *interval = interval.max(1e-9 * largest);
    }
    intervals
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sections() -> Sections {
        let square = |y: f64, size: f64| {
            [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0)].map(|(x, z)| DVec3::new(size * x, y, size * z)).to_vec()
        };
        Sections::new(vec![square(0.0, 0.0), square(4.0, 1.0), square(5.0, 1.0)], true, vec![]).unwrap()
    }

    #[test]
    fn intervals_follow_the_rule() {
        let poles = [true, false, false];
        assert_eq!(along(&sections(), UParameter::Uniform), [1.0, 1.0]);
        assert_eq!(along(&sections(), UParameter::ChordLength)[1], 1.0);
        assert_eq!(across(&sections(), UParameter::ChordLength, &poles), [0.8, 0.2, 0.8, 0.2]);
        let third = across(&sections(), UParameter::Centripetal, &poles);
        assert!((third[0] / third[1] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn columns_that_coincide_keep_an_interval() {
        let row = |y: f64| vec![DVec3::new(0.0, y, 0.0), DVec3::new(1.0, y, 0.0), DVec3::new(1.0, y, 0.0)];
        let sections = Sections::new(vec![row(0.0), row(1.0)], false, vec![]).unwrap();
        let intervals = across(&sections, UParameter::Centripetal, &[false, false]);
        assert!(intervals[1] > 0.0 && intervals[1] <= 1e-9 * intervals[0]);
    }
}
