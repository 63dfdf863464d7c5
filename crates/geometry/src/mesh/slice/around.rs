//! Which of the loops in a plane is the one around the bone.

use glam::{DVec2, DVec3};

use super::chain::Loop;
use super::plane::Frame;
use super::section::Others;
use crate::polygon::signed_area;

/// What a plane has for a bone that passes through its origin.
#[derive(Debug)]
pub(super) enum Found<'a> {
    /// The loop around the bone. `wider_open`: an open chain around it encloses more.
    Around { contour: &'a Loop, others: Others, wider_open: bool },
    /// None is around the bone; this is the nearest, metres away.
    Beside { contour: &'a Loop, others: Others, distance: f64 },
    /// What is around the bone, or nearest to it, does not close: the ends that should meet.
    Open([DVec3; 2]),
    /// The plane does not meet the mesh.
    Nothing,
}

/// A loop as the bone sees it.
struct Seen<'a> {
    contour: &'a Loop,
    /// How often it runs around the bone, counter-clockwise; an open chain closed by a straight line.
    winding: i32,
    /// Area enclosed, square metres.
    area: f64,
    /// Least distance from the bone, metres; the straight line that closes a chain does not count.
    distance: f64,
}

/// Chooses by the winding number about the plane's origin: of the closed loops around it the one that encloses most;
/// where there is none, the nearest.
pub(super) fn around_bone<'a>(loops: &'a [Loop], frame: &Frame) -> Found<'a> {
    let seen: Vec<Seen> = loops.iter().map(|contour| Seen::new(contour, frame)).collect();
    let largest = |closed: bool| {
        let mut largest: Option<&Seen> = None;
        for one in seen.iter().filter(|one| one.contour.closed == closed && one.winding != 0) {
            if largest.is_none_or(|best| one.area > best.area) {
                largest = Some(one);
            }
        }
        largest
    };
    let others = |taken: &Seen| {
        let rest = || seen.iter().filter(|one| !std::ptr::eq(one.contour, taken.contour));
        let closed = |around: bool| rest().filter(|one| one.contour.closed && (one.winding != 0) == around).count();
        Others { around: closed(true), beside: closed(false), open: rest().filter(|one| !one.contour.closed).count() }
    };
    let open = |one: &Seen| match one.contour.points.as_slice() {
        [first, .., last] => Found::Open([*last, *first]),
        _ => Found::Nothing,
    };
    let widest_open = largest(false);
    if let Some(taken) = largest(true) {
        let wider_open = widest_open.is_some_and(|one| one.area > taken.area);
        return Found::Around { contour: taken.contour, others: others(taken), wider_open };
    }
    if let Some(one) = widest_open {
        return open(one);
    }
    match seen.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) {
        None => Found::Nothing,
        Some(one) if !one.contour.closed => open(one),
        Some(one) => Found::Beside { contour: one.contour, others: others(one), distance: one.distance },
    }
}

impl<'a> Seen<'a> {
    fn new(contour: &'a Loop, frame: &Frame) -> Self {
        let flat: Vec<DVec2> = contour.points.iter().map(|p| frame.flat(*p)).collect();
        let sides = || flat.iter().zip(flat.iter().cycle().skip(1));
        let drawn = sides().take(if contour.closed { flat.len() } else { flat.len().saturating_sub(1) });
        let distance = drawn.map(|(a, b)| distance_to_origin(*a, *b)).fold(f64::INFINITY, f64::min);
        Self { contour, winding: winding(&flat), area: signed_area(&flat).abs(), distance }
    }
}

/// How often a polygon runs around the origin, counter-clockwise.
fn winding(flat: &[DVec2]) -> i32 {
    let sides = flat.iter().zip(flat.iter().cycle().skip(1));
    sides
        .map(|(a, b)| match (a.y < 0.0, b.y < 0.0) {
            (true, false) if a.perp_dot(*b) > 0.0 => 1,
            (false, true) if a.perp_dot(*b) < 0.0 => -1,
            _ => 0,
        })
        .sum()
}

fn distance_to_origin(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    if share.is_nan() { a.length() } else { (a + along * share).length() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::slice::Plane;

    fn frame(x: f64, y: f64) -> Frame {
        Frame::new(Plane::new(DVec3::new(x, y, 5.0), DVec3::Z).unwrap(), DVec3::X)
    }

    fn square(centre: [f64; 2], half: f64, closed: bool) -> Loop {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let points = corners.map(|[x, y]| DVec3::new(centre[0] + half * x, centre[1] + half * y, 5.0));
        Loop { points: points.to_vec(), closed }
    }

    #[test]
    fn the_largest_loop_around_is_taken_and_the_others_are_counted() {
        let loops = [
            square([0.0, 0.0], 1.0, true),
            square([9.0, 0.0], 3.0, true),
            square([0.0, 0.0], 2.0, true),
            square([20.0, 0.0], 1.0, false),
        ];
        let at = frame(0.5, 0.0);
        let Found::Around { contour, others, wider_open } = around_bone(&loops, &at) else { panic!() };
        assert_eq!(contour, &loops[2]);
        assert_eq!((others, wider_open), (Others { around: 1, beside: 1, open: 1 }, false));
        let at = frame(5.0, 0.0);
        let Found::Beside { contour, others, distance } = around_bone(&loops, &at) else { panic!() };
        assert_eq!(contour, &loops[1]);
        assert_eq!((others, distance), (Others { around: 0, beside: 2, open: 1 }, 1.0));
    }

    #[test]
    fn an_open_chain_is_only_taken_notice_of() {
        let (small, wide) = (square([0.0, 0.0], 1.0, true), square([0.0, 0.0], 2.0, false));
        let found = around_bone(std::slice::from_ref(&wide), &frame(0.0, 0.0)).gap();
        assert_eq!(found, Some([DVec3::new(-2.0, 2.0, 5.0), DVec3::new(-2.0, -2.0, 5.0)]));
        let loops = [small, wide];
        assert!(matches!(around_bone(&loops, &frame(0.0, 0.0)), Found::Around { wider_open: true, .. }));
        // Between both squares: around nothing but the open one.
        assert!(around_bone(&loops, &frame(1.5, 0.0)).gap().is_some());
        // Outside, and the open one is nearer.
        assert!(around_bone(&loops, &frame(3.0, 0.0)).gap().is_some());
        // The straight line that would close it is not there to be near.
        assert!(matches!(around_bone(&loops, &frame(-2.2, 0.0)), Found::Beside { distance, .. } if distance > 1.1));
        assert!(matches!(around_bone(&[], &frame(0.0, 0.0)), Found::Nothing));
    }

    impl Found<'_> {
        fn gap(&self) -> Option<[DVec3; 2]> {
            if let Found::Open(gap) = self { Some(*gap) } else { None }
        }
    }

    #[test]
    fn windings_are_signed_and_counted() {
        let square = [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];
        assert_eq!(winding(&square), 1);
        let mut back = square;
        back.reverse();
        assert_eq!(winding(&back), -1);
        assert_eq!(winding(&[square, square].concat()), 2);
        assert_eq!(winding(&square.map(|p| p + DVec2::new(0.0, 1.5))), 0);
    }
}
