//! The grid of a view: lines at round numbers of metres, as fine as can be told apart.

use glam::DVec3;

use crate::drawable::Segment;

use super::camera::{Camera, Direction, ViewSize};

/// Least distance of two lines on the screen, points.
const LEAST_GAP: f64 = 14.0;
/// Least distance of two numbers along an edge, points.
const NUMBER_GAP: f64 = 45.0;
/// Most lines to either side of the middle.
const MOST_LINES: i64 = 200;

/// A grid in the plane of a view; of a free view on the floor.
pub(crate) struct Grid {
    /// Distance of its fine lines, metres: a power of ten.
    pub(crate) step: f64,
    pub(crate) fine: Vec<Segment>,
    /// Every tenth line.
    pub(crate) coarse: Vec<Segment>,
    /// The two axes in the plane, first and second, with the axis of the world each runs along.
    pub(crate) axes: [(usize, Segment); 2],
}

/// The two axes of the world that span the plane of a view.
fn plane(direction: Direction) -> [usize; 2] {
    match direction {
        Direction::Front => [0, 1],
        Direction::Side => [2, 1],
        Direction::Top | Direction::Free => [0, 2],
    }
}

fn segment(from: DVec3, to: DVec3) -> Segment {
    Segment { from: from.as_vec3().to_array(), to: to.as_vec3().to_array() }
}

impl Grid {
    /// The grid around what the camera looks at.
    pub(crate) fn new(camera: &Camera, size: ViewSize) -> Self {
        let metres = camera.metres_per_point(size);
        let mut step = 10_f64.powf((metres * LEAST_GAP).log10().ceil());
        let extent = size.longer() * metres * if camera.is_parallel() { 0.6 } else { 2.0 };
        if extent / step > MOST_LINES as f64 {
            step *= 10.0;
        }
        let [u, v] = plane(camera.direction);
        let focus = camera.focus();
        #[expect(clippy::cast_possible_truncation, reason = "a few hundred lines")]
        let lines = |axis: usize| {
            let first = ((focus[axis] - extent) / step).ceil() as i64;
            let last = ((focus[axis] + extent) / step).floor() as i64;
            first..=last.min(first + 2 * MOST_LINES)
        };
        let along = |axis: usize, other: usize, place: f64| {
            let mut from = DVec3::ZERO;
            from[axis] = place;
            let mut to = from;
            from[other] = focus[other] - extent;
            to[other] = focus[other] + extent;
            segment(from, to)
        };
        let (mut fine, mut coarse) = (Vec::new(), Vec::new());
        for (axis, other) in [(u, v), (v, u)] {
            for k in lines(axis) {
                let line = along(axis, other, k as f64 * step);
                if k % 10 == 0 { coarse.push(line) } else { fine.push(line) }
            }
        }
        Self { step, fine, coarse, axes: [(u, along(v, u, 0.0)), (v, along(u, v, 0.0))] }
    }

    /// Coordinates along the edges of a view, as far apart as they can be read: the axis of the screen (0 rightwards, 1
    /// upwards), metres, and where they are seen, points from the left or the upper edge; of a view that is seen flat.
    pub(crate) fn numbers(&self, camera: &Camera, size: ViewSize) -> Vec<(usize, f64, f32)> {
        let metres = camera.metres_per_point(size);
        let apart = self.apart(metres);
        let reach = 0.5 * size.longer() * metres;
        let mut numbers = Vec::new();
        for (screen, axis) in plane(camera.direction).into_iter().enumerate() {
            if camera.direction == Direction::Free {
                continue;
            }
            let focus = camera.focus();
            #[expect(clippy::cast_possible_truncation, reason = "a few dozen numbers")]
            let [first, last] = [focus[axis] - reach, focus[axis] + reach].map(|at| (at / apart).round() as i64);
            for k in first..=last.min(first + MOST_LINES) {
                let mut place = focus;
                place[axis] = k as f64 * apart;
                if let Some(seen) = camera.project(size, place) {
                    numbers.push((screen, place[axis], if screen == 0 { seen.x } else { seen.y }));
                }
            }
        }
        numbers
    }

    /// Distance of two numbers, metres: so many fine lines that one can read them.
    fn apart(&self, metres: f64) -> f64 {
        let fits = |times: &f64| times * self.step / metres >= NUMBER_GAP;
        self.step * [1.0, 2.0, 5.0, 10.0].into_iter().find(fits).unwrap_or(10.0)
    }

    /// A coordinate in words, with as many digits as numbers differ in.
    pub(crate) fn number(&self, metres: f64) -> String {
        let digits = match self.step {
            step if step >= 0.95 => 0,
            step if step >= 0.095 => 1,
            step if step >= 0.0095 => 2,
            step if step >= 0.000_95 => 3,
            _ => 5,
        };
        let text = format!("{metres:.digits$}");
        if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') { "0".to_owned() } else { text }
    }

    /// The distance of the lines in words.
    pub(crate) fn label(&self) -> String {
        match self.step {
            step if step >= 1.0 => format!("{step:.0} m"),
            step if step >= 0.0095 => format!("{:.0} cm", step * 100.0),
            step if step >= 0.00095 => format!("{:.0} mm", step * 1000.0),
            step => format!("{:.3} mm", step * 1000.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_a_round_number_that_fits_the_zoom() {
        let size = ViewSize::new(egui::vec2(400.0, 400.0));
        for (distance, label) in [(0.1, "1 cm"), (3.5, "10 cm"), (40.0, "1 m"), (400.0, "10 m")] {
            let mut camera = Camera::new(Direction::Front);
            camera.distance = distance;
            let grid = Grid::new(&camera, size);
            assert_eq!(grid.label(), label, "from {distance} m");
            let gap = grid.step / camera.metres_per_point(size);
            assert!((14.0..141.0).contains(&gap), "{gap} points");
            assert!(grid.fine.len() + grid.coarse.len() < 1000);
        }
    }

    #[test]
    fn numbers_stand_where_their_lines_do_and_can_be_read() {
        let size = ViewSize::new(egui::vec2(400.0, 400.0));
        let camera = Camera::new(Direction::Side);
        let grid = Grid::new(&camera, size);
        let numbers = grid.numbers(&camera, size);
        // About two metres around a height of one: from the left edge to the right, and from the top down.
        let words = |axis| {
            let of = numbers.iter().filter(|(screen, ..)| *screen == axis);
            of.map(|(_, at, _)| grid.number(*at)).collect::<Vec<_>>().join(" ")
        };
        assert_eq!((words(0).as_str(), words(1).as_str()), ("-1.0 -0.5 0 0.5 1.0", "0 0.5 1.0 1.5 2.0"));
        let seen = |axis, at: f64| numbers.iter().find(|(s, a, _)| *s == axis && (a - at).abs() < 1e-6).unwrap().2;
        assert!((seen(0, 0.0) - 200.0).abs() < 0.5 && (seen(1, 1.0) - 200.0).abs() < 0.5);
        assert!(seen(1, 2.0) < seen(1, 1.0) && (seen(0, 0.5) - seen(0, 0.0)).abs() >= 45.0);
        assert!(Grid::new(&Camera::new(Direction::Free), size).numbers(&Camera::new(Direction::Free), size).is_empty());
    }

    #[test]
    fn a_side_grid_lies_in_the_plane_of_side_sketches() {
        let grid = Grid::new(&Camera::new(Direction::Side), ViewSize::new(egui::vec2(300.0, 300.0)));
        assert!(grid.fine.iter().chain(&grid.coarse).all(|line| line.from[0] == 0.0 && line.to[0] == 0.0));
        assert_eq!(grid.axes.map(|(axis, _)| axis), [2, 1]);
    }
}
