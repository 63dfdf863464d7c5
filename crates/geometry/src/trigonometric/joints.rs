//! Where sections are split: given joints, corners, or where one series needs too many harmonics.

use super::composite::{Layout, ON_JOINT};
use super::error::FitError;
use super::options::{Continuity, Joint};
use super::solve::{Goal, Method, Outcome, Prepared, solve};
use std::f64::consts::{PI, TAU};

/// Corners of different sections this near to one another, radians, share a joint.
const TOGETHER: f64 = 0.15;
/// Share of the corner angle by which a section turns at a joint where it keeps the corner.
const KEPT: f64 = 1.0 / 3.0;
/// Most joints of an automatic split.
const MOST: usize = 8;
/// A worst point nearer than this share of its segment to an end of it is no place for a joint; the middle is.
const OFF_END: f64 = 0.1;

/// Joints common to a stack; how a section meets at them is its own.
#[derive(Clone, Debug, Default)]
pub(super) struct Joints {
    /// Ascending; of closed sections from 0 to below 2 pi.
    pub(super) angles: Vec<f64>,
    /// For each section, for each joint.
    pub(super) continuity: Vec<Vec<Continuity>>,
}

impl Joints {
    pub(super) fn layout(&self, section: usize, closed: bool) -> Layout {
        let Some(continuity) = self.continuity.get(section) else { return Layout::single(closed) };
        let joints: Vec<_> = self.angles.iter().copied().zip(continuity.iter().copied()).collect();
        Layout::split(closed, &joints)
    }

    /// As the joints of the whole stack.
    pub(super) fn common(&self) -> Vec<Joint> {
        let least = |j: usize| self.continuity.iter().map(|section| section[j]).min().unwrap_or(Continuity::C0);
        self.angles.iter().enumerate().map(|(j, angle)| Joint { angle: *angle, continuity: least(j) }).collect()
    }

    /// The joints asked for.
    pub(super) fn given(joints: &[Joint], closed: bool, sections: usize) -> Result<Self, FitError> {
        let mut placed = Vec::with_capacity(joints.len());
        for (joint, Joint { angle, continuity }) in joints.iter().enumerate() {
            let place = if closed { angle.rem_euclid(TAU) } else { *angle };
            let inside = closed || (*angle > ON_JOINT && *angle < PI - ON_JOINT);
            if !angle.is_finite() || !inside {
                return Err(FitError::JointOutside { joint, angle: *angle });
            }
            // A tiny negative angle comes out as a whole turn.
            placed.push((if place >= TAU { 0.0 } else { place }, joint, *continuity));
        }
        placed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let coincide = |a: (f64, usize), b: (f64, usize)| FitError::JointsCoincide {
            first: a.1.min(b.1),
            second: a.1.max(b.1),
            angle: a.0,
        };
        for pair in placed.windows(2) {
            if pair[1].0 - pair[0].0 <= ON_JOINT {
                return Err(coincide((pair[0].0, pair[0].1), (pair[1].0, pair[1].1)));
            }
        }
        if let [first, .., last] = placed[..]
            && closed
            && first.0 + TAU - last.0 <= ON_JOINT
        {
            return Err(coincide((first.0, first.1), (last.0, last.1)));
        }
        let continuity = placed.iter().map(|(_, _, continuity)| *continuity).collect();
        let angles = placed.iter().map(|(angle, ..)| *angle).collect();
        Ok(Self { angles, continuity: vec![continuity; sections] })
    }

    /// Joints at the corners of any section. A single one in a closed stack gets a smooth one opposite.
    pub(super) fn at_corners(stack: &[Prepared], closed: bool, corner: f64, continuity: Continuity) -> Self {
        let mut found: Vec<f64> = Vec::new();
        for section in stack {
            let corners = section.samples.corners(&section.turns, corner);
            let angles = corners.into_iter().map(|i| section.angles[i]);
            found.extend(angles.map(|angle| if closed { angle.rem_euclid(TAU) } else { angle }));
        }
        let corners = clustered(found, closed);
        let joints = Self::smooth_but_at_corners(corners, stack, closed, corner, continuity);
        match joints.angles[..] {
            [only] if closed => joints.with((only + PI).rem_euclid(TAU), continuity),
            _ => joints,
        }
    }

    fn smooth_but_at_corners(
        angles: Vec<f64>,
        stack: &[Prepared],
        closed: bool,
        corner: f64,
        continuity: Continuity,
    ) -> Self {
        let at = |section: &Prepared, joint: f64| {
            let turn = section
                .angles
                .iter()
                .zip(&section.turns)
                .filter(|(angle, _)| distance(**angle, joint, closed) <= TOGETHER)
                .map(|(_, turn)| *turn)
                .fold(0.0, f64::max);
            if turn > KEPT * corner { Continuity::C0 } else { continuity }
        };
        let continuity = stack.iter().map(|section| angles.iter().map(|joint| at(section, *joint)).collect()).collect();
        Self { angles, continuity }
    }

    fn with(&self, angle: f64, continuity: Continuity) -> Self {
        let place = self.angles.partition_point(|a| *a < angle);
        let mut more = self.clone();
        more.angles.insert(place, angle);
        more.continuity.iter_mut().for_each(|section| section.insert(place, continuity));
        more
    }
}

/// What an automatic split is made with.
#[derive(Clone, Copy)]
pub(super) struct Automatic {
    pub(super) most: usize,
    pub(super) corner: f64,
    pub(super) continuity: Continuity,
    pub(super) method: Method,
}

/// Joints for a stack of which some section does not meet its tolerances in one series: at corners, then one more at
/// the worst point of all until every section meets them, or no more joints find room.
///
/// `go_on` is asked before each section is solved; its error ends the search.
pub(super) fn automatic(
    stack: &[Prepared],
    closed: bool,
    with: Automatic,
    go_on: &dyn Fn() -> Result<(), FitError>,
) -> Result<Joints, FitError> {
    let goal = Goal::Smallest { most: with.most };
    let solve_all = |joints: &Joints| -> Result<Vec<Outcome>, FitError> {
        let solved = |(i, prepared)| {
            go_on()?;
            solve(prepared, &joints.layout(i, closed), &goal, with.method, None)
        };
        stack.iter().enumerate().map(solved).collect()
    };
    let mut joints = Joints { angles: Vec::new(), continuity: vec![Vec::new(); stack.len()] };
    let mut outcomes = solve_all(&joints)?;
    if outcomes.iter().all(|outcome| outcome.met) {
        return Ok(Joints::default());
    }
    let corners = Joints::at_corners(stack, closed, with.corner, with.continuity);
    if !corners.angles.is_empty() {
        match solve_all(&corners) {
            Ok(solved) => (joints, outcomes) = (corners, solved),
            Err(FitError::Stopped) => return Err(FitError::Stopped),
            // Corners too close to one another are no place to begin.
            Err(_) => {}
        }
    }
    while joints.angles.len() < MOST && !outcomes.iter().all(|outcome| outcome.met) {
        let angle = place(stack, &outcomes, closed);
        let mut next = joints.with(angle, with.continuity);
        if closed && joints.angles.is_empty() {
            next = next.with((angle + PI).rem_euclid(TAU), with.continuity);
        }
        // No room for another joint: what there is is the answer.
        let solved = match solve_all(&next) {
            Ok(solved) => solved,
            Err(FitError::Stopped) => return Err(FitError::Stopped),
            Err(_) => break,
        };
        (joints, outcomes) = (next, solved);
    }
    Ok(if joints.angles.is_empty() { Joints::default() } else { joints })
}

/// Where the next joint goes: the sample that misses its tolerance by the largest share, or the middle of its segment
/// where that is near a joint.
fn place(stack: &[Prepared], outcomes: &[Outcome], closed: bool) -> f64 {
    let mut worst = (0.0, 0.0, 0);
    for (section, (prepared, outcome)) in stack.iter().zip(outcomes).enumerate() {
        for (angle, distance) in prepared.angles.iter().zip(&outcome.solved.distances) {
            let share = distance / prepared.tolerances.maximum;
            if !outcome.met && share > worst.0 {
                worst = (share, *angle, section);
            }
        }
    }
    let (_, angle, section) = worst;
    let segments = &outcomes[section].solved.segments;
    let first = segments[0].from;
    let angle = if closed { first + (angle - first).rem_euclid(TAU) } else { angle };
    let in_it = segments.iter().find(|s| s.from <= angle && angle <= s.to);
    let split = segments.len() > 1 || !closed;
    let moved = in_it.filter(|_| split).map(|segment| {
        let margin = OFF_END * (segment.to - segment.from);
        if angle - segment.from < margin || segment.to - angle < margin {
            0.5 * (segment.from + segment.to)
        } else {
            angle
        }
    });
    let angle = moved.unwrap_or(angle);
    if closed { angle.rem_euclid(TAU) } else { angle }
}

fn distance(a: f64, b: f64, closed: bool) -> f64 {
    let gap = a - b;
    if closed { (gap - TAU * (gap / TAU).round()).abs() } else { gap.abs() }
}

/// Means of groups of angles that lie near one another, ascending.
fn clustered(mut angles: Vec<f64>, closed: bool) -> Vec<f64> {
    angles.sort_by(f64::total_cmp);
    let mut groups: Vec<Vec<f64>> = Vec::new();
    for angle in angles {
        match groups.last_mut() {
            Some(group) if group.last().is_some_and(|last| angle - last <= TOGETHER) => group.push(angle),
            _ => groups.push(vec![angle]),
        }
    }
    if closed
        && groups.len() > 1
        && let (Some(first), Some(last)) = (groups.first(), groups.last())
        && let (Some(low), Some(high)) = (first.first(), last.last())
        && low + TAU - high <= TOGETHER
    {
        let wrapped = groups.remove(0).into_iter().map(|angle| angle + TAU);
        if let Some(last) = groups.last_mut() {
            last.extend(wrapped);
        }
    }
    let mean = |group: Vec<f64>| {
        let mean = group.iter().sum::<f64>() / group.len() as f64;
        if closed { mean.rem_euclid(TAU) } else { mean }
    };
    let mut means: Vec<f64> = groups.into_iter().map(mean).collect();
    means.sort_by(f64::total_cmp);
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_angles_share_a_joint_around_the_turn_too() {
        let found = clustered(vec![3.0, 0.04, TAU - 0.06, 3.1, 5.0], true);
        assert_eq!(found.len(), 3);
        assert!((found[0] - 3.05).abs() < 1e-12 && found[1] == 5.0);
        assert!((found[2] - TAU + 0.01).abs() < 1e-12, "{found:?}");
        assert_eq!(clustered(vec![], true), Vec::<f64>::new());
    }

    #[test]
    fn given_joints_are_ordered_and_checked() {
        let joint = |angle| Joint { angle, continuity: Continuity::C1 };
        let placed = Joints::given(&[joint(4.0), joint(-1.0), joint(1.0 + 4.0 * TAU)], true, 2).unwrap();
        assert!((placed.angles[0] - 1.0).abs() < 1e-12 && placed.angles[1] == 4.0);
        assert_eq!((placed.continuity.len(), placed.common().len()), (2, 3));
        assert_eq!(
            Joints::given(&[joint(1.0), joint(3.0), joint(1.0)], true, 1).unwrap_err(),
            FitError::JointsCoincide { first: 0, second: 2, angle: 1.0 }
        );
        assert!(Joints::given(&[joint(0.0), joint(1.0), joint(TAU - 1e-12)], true, 1).is_err());
        assert!(Joints::given(&[joint(-1e-30), joint(1.0)], true, 1).is_ok());
        for angle in [0.0, PI, 4.0, f64::NAN] {
            assert!(matches!(Joints::given(&[joint(angle)], false, 1), Err(FitError::JointOutside { joint: 0, .. })));
        }
        assert!(Joints::given(&[joint(f64::INFINITY)], true, 1).is_err());
    }
}
