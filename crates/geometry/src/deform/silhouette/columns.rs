//! Which points of the sections stand on the sides of the stack.

use glam::{DVec2, DVec3};

use crate::sections::Sections;
use crate::view::View;

/// Share of the stack's length that must be seen in a view for the stack to have two sides there.
const LEAST_SEEN: f64 = 0.3;

/// Whether a view looks along the stack: less than 30 % of the length of the line through its centres is seen.
pub(super) fn end_on(sections: &Sections, view: View) -> bool {
    let centres: Vec<DVec3> = (0..sections.len()).map(|k| sections.centre(k)).collect();
    let steps = centres.windows(2).map(|pair| pair[1] - pair[0]);
    let (seen, whole) =
        steps.fold((0.0, 0.0), |(seen, whole), step| (seen + view.flat(step).length(), whole + step.length()));
    seen.is_nan() || whole == 0.0 || seen < LEAST_SEEN * whole
}

/// Offsets of the points of each column from the centres of their sections, and the line of the centres.
pub(super) struct Columns<'a> {
    sections: &'a Sections,
    centres: Vec<DVec3>,
}

impl<'a> Columns<'a> {
    pub(super) fn of(sections: &'a Sections) -> Self {
        Self { sections, centres: (0..sections.len()).map(|k| sections.centre(k)).collect() }
    }

    /// The columns farthest to the left and to the right of who walks along the stack, as seen in `view`; of several,
    /// as on a flat side, the one in the middle of the depth. None where the stack has no width there.
    pub(super) fn sides(&self, view: View) -> Option<[usize; 2]> {
        let last = self.centres.len() - 1;
        // Left of the way from the centre before to the centre after.
        let lefts: Vec<DVec2> = (0..=last)
            .map(|k| {
                let way = self.centres[(k + 1).min(last)] - self.centres[k.saturating_sub(1)];
                view.flat(way).perp().normalize_or_zero()
            })
            .collect();
        let nodes = self.sections.nodes();
        let (mut reach, mut depth) = (vec![0.0; nodes], vec![0.0; nodes]);
        for ((section, centre), left) in self.sections.iter().zip(&self.centres).zip(&lefts) {
            let left = view.lift(*left);
            for (j, point) in section.iter().enumerate() {
                let offset = *point - *centre;
                reach[j] += offset.dot(left);
                depth[j] += offset.dot(view.depth());
            }
        }
        let width = reach.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        if !(width.is_finite() && width > 0.0) {
            return None;
        }
        let farthest = |sign: f64| {
            let most = reach.iter().fold(f64::NEG_INFINITY, |most, r| most.max(sign * r));
            (0..nodes)
                .filter(|j| sign * reach[*j] >= most - 1e-6 * width)
                .min_by(|a, b| depth[*a].abs().total_cmp(&depth[*b].abs()))
        };
        Some([farthest(1.0)?, farthest(-1.0)?])
    }
}
