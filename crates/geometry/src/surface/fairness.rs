//! How evenly a stack of sections runs: a measure of ripples.

use glam::DVec3;

use crate::sections::Sections;

/// Bends below this share of the diagonal of all sections are not counted by [`ripple`].
pub const RIPPLE_TOLERANCE: f64 = 1e-4;

/// What [`ripple`] measures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ripple {
    /// Changes of the side to which a column bends, in the column with the most.
    pub sign_changes: usize,
    /// The first such column.
    pub column: usize,
    /// Changes in all columns together.
    pub total_sign_changes: usize,
    /// Largest turn between neighbouring segments of a column, degrees.
    pub max_turn_degrees: f64,
}

/// Counts how often the columns of a stack (point `j` of one section to point `j` of the next) change the side to which
/// they bend.
///
/// The bend at a point is its offset from the chord between its neighbours, at the share of the chord that its
/// distances to them give: the second difference where they are equally far. Two bends that follow each other, each
/// longer than [`RIPPLE_TOLERANCE`] times the diagonal, count as a change where they point to opposite sides. An S has
/// one change; ripples have one a section.
pub fn ripple(sections: &Sections) -> Ripple {
    let threshold = RIPPLE_TOLERANCE * sections.diagonal();
    let mut ripple = Ripple::default();
    for column in 0..sections.nodes() {
        let points: Vec<DVec3> = sections.iter().map(|row| row[column]).collect();
        let mut changes = 0;
        let mut last = DVec3::ZERO;
        for trio in points.windows(3) {
            let (before, after) = (trio[1] - trio[0], trio[2] - trio[1]);
            let (a, b) = (before.length(), after.length());
            if a == 0.0 || b == 0.0 {
                continue;
            }
            ripple.max_turn_degrees = ripple.max_turn_degrees.max(before.angle_between(after).to_degrees());
            let bend = trio[0].lerp(trio[2], a / (a + b)) - trio[1];
            if bend.length() > threshold {
                changes += usize::from(bend.dot(last) < 0.0);
                last = bend;
            }
        }
        ripple.total_sign_changes += changes;
        if changes > ripple.sign_changes {
            (ripple.sign_changes, ripple.column) = (changes, column);
        }
    }
    ripple
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stack(radius: impl Fn(f64) -> f64) -> Sections {
        let rows = (0..=20).map(|i| {
            let y = i as f64 / 20.0;
            (0..8).map(|j| DVec3::new(0.0, 0.0, radius(y)).rotate_y(j as f64 * 0.785) + DVec3::Y * y).collect()
        });
        Sections::new(rows.collect(), true, vec![]).unwrap()
    }

    #[test]
    fn a_barrel_bends_one_way() {
        let barrel = ripple(&stack(|y| 0.3 + 0.2 * (y * 3.0).sin()));
        assert_eq!((barrel.sign_changes, barrel.total_sign_changes), (0, 0));
        assert!(barrel.max_turn_degrees > 1.0 && barrel.max_turn_degrees < 10.0);
    }

    #[test]
    fn an_s_bends_two_ways() {
        let s = ripple(&stack(|y| 0.5 + 0.2 * (y * std::f64::consts::TAU).sin()));
        assert_eq!((s.sign_changes, s.total_sign_changes), (1, 8));
    }

    #[test]
    fn a_zigzag_ripples_at_each_section() {
        let zigzag = ripple(&stack(|y| 0.5 + 0.01 * ((y * 20.0).round() * std::f64::consts::PI).cos()));
        assert_eq!(zigzag.sign_changes, 18);
        assert!(zigzag.max_turn_degrees > 30.0);
        let slight = ripple(&stack(|y| 0.5 + 1e-6 * ((y * 20.0).round() * std::f64::consts::PI).cos()));
        assert_eq!(slight.sign_changes, 0);
    }
}
