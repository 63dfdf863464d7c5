//! Where a view is seen from: three fixed directions and one that turns like a turntable.

use glam::dcamera::rh::proj::directx::{orthographic, perspective};
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec2, DVec3, DVec4};
use serde::{Deserialize, Serialize};

/// Angle the perspective lens sees from bottom to top, degrees.
const FIELD_OF_VIEW_DEGREES: f64 = 35.0;
/// Share of the view that stays empty around what is framed.
const MARGIN: f64 = 1.15;
/// Distances to the focus between which one can zoom, metres.
const DISTANCES: [f64; 2] = [1e-3, 1e5];

/// One of the four views. World axes are +X to the model's left, +Y up, +Z to its front.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Direction {
    /// Along -Z: +X to the right, +Y up.
    Front,
    /// The plane of side sketches, along +X: +Z to the right, +Y up.
    Side,
    /// From above, along -Y: +X to the right, +Z down.
    Top,
    /// From anywhere.
    Free,
}

impl Direction {
    /// All four, in the order in which they stand on the screen.
    pub const ALL: [Self; 4] = [Self::Free, Self::Front, Self::Side, Self::Top];

    /// What the view is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Side => "Side",
            Self::Top => "Top",
            Self::Free => "Perspective",
        }
    }

    /// The option of a sketch's plane in which one draws here; `None` where one can't.
    pub fn plane(self) -> Option<&'static str> {
        match self {
            Self::Front => Some("front"),
            Self::Side => Some("side"),
            Self::Top => Some("top"),
            Self::Free => None,
        }
    }
}

/// A camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// What it looks along.
    pub direction: Direction,
    /// The point it looks at and turns around, metres.
    pub focus: [f64; 3],
    /// Distance of the eye from the focus, metres. Also without perspective it says how much is seen.
    pub distance: f64,
    /// Turned from the front to the model's left, radians; of a free camera only.
    pub turn: f64,
    /// Raised, radians; of a free camera only.
    pub rise: f64,
    /// Whether it sees without perspective; the fixed ones always do.
    pub parallel: bool,
}

/// The size of a view in points, never zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSize(DVec2);

impl ViewSize {
    /// A size; what is smaller than a point counts as one.
    pub fn new(size: egui::Vec2) -> Self {
        Self(DVec2::new(f64::from(size.x).max(1.0), f64::from(size.y).max(1.0)))
    }

    /// The longer side, points.
    pub(crate) fn longer(self) -> f64 {
        self.0.max_element()
    }

    /// Points from top to bottom.
    #[expect(clippy::cast_possible_truncation, reason = "points of the screen")]
    pub(crate) fn height(self) -> f32 {
        self.0.y as f32
    }

    fn aspect(self) -> f64 {
        self.0.x / self.0.y
    }
}

impl Camera {
    /// A camera that sees about two metres around the middle of a standing figure.
    pub fn new(direction: Direction) -> Self {
        Self {
            direction,
            focus: [0.0, 1.0, 0.0],
            distance: 3.5,
            turn: 35_f64.to_radians(),
            rise: 14_f64.to_radians(),
            parallel: direction != Direction::Free,
        }
    }

    /// The point it looks at.
    pub fn focus(&self) -> DVec3 {
        DVec3::from_array(self.focus)
    }

    /// Whether it sees without perspective.
    pub fn is_parallel(&self) -> bool {
        self.parallel || self.direction != Direction::Free
    }

    /// Right, up and towards the viewer: an orthonormal, right-handed frame.
    pub fn frame(&self) -> [DVec3; 3] {
        let (up, back) = match self.direction {
            Direction::Front => (DVec3::Y, DVec3::Z),
            Direction::Side => (DVec3::Y, DVec3::NEG_X),
            Direction::Top => (DVec3::NEG_Z, DVec3::Y),
            Direction::Free => {
                let (turn, rise) = (self.turn, self.rise);
                let back = DVec3::new(turn.sin() * rise.cos(), rise.sin(), turn.cos() * rise.cos());
                let right = DVec3::new(turn.cos(), 0.0, -turn.sin());
                (back.cross(right), back)
            }
        };
        [up.cross(back), up, back]
    }

    /// Half the height that is seen at the focus, metres.
    fn half_height(&self) -> f64 {
        self.distance * (0.5 * FIELD_OF_VIEW_DEGREES).to_radians().tan()
    }

    /// Metres a point of the screen measures at the focus.
    pub fn metres_per_point(&self, size: ViewSize) -> f64 {
        2.0 * self.half_height() / size.0.y
    }

    /// Where the eye is; without perspective a point in front of everything near the focus.
    pub fn eye(&self) -> DVec3 {
        self.focus() + self.frame()[2] * self.distance
    }

    /// From the world to clip space, depth 0 to 1.
    pub fn view_projection(&self, size: ViewSize) -> DMat4 {
        let [_, up, _] = self.frame();
        let half = self.half_height();
        let (eye, projection) = if self.is_parallel() {
            let depth = 1000.0 * self.distance;
            let width = half * size.aspect();
            let eye = self.focus() + self.frame()[2] * (0.5 * depth);
            (eye, orthographic(-width, width, -half, half, 0.0, depth))
        } else {
            let near = 0.01 * self.distance;
            let lens = FIELD_OF_VIEW_DEGREES.to_radians();
            (self.eye(), perspective(lens, size.aspect(), near, 1e4 * near.max(0.01)))
        };
        projection * look_at_mat4(eye, eye - self.frame()[2], up)
    }

    /// Where a point of the world is seen, in points from the upper left corner; `None` behind the eye.
    pub fn project(&self, size: ViewSize, point: DVec3) -> Option<egui::Vec2> {
        let clip: DVec4 = self.view_projection(size) * point.extend(1.0);
        if clip.w <= 1e-9 {
            return None;
        }
        let [x, y] = [clip.x / clip.w, clip.y / clip.w];
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen")]
        Some(egui::vec2((0.5 * (x + 1.0) * size.0.x) as f32, (0.5 * (1.0 - y) * size.0.y) as f32))
    }

    /// What lies under a point of the screen: a point on the ray, and its direction away from the viewer.
    pub fn ray(&self, size: ViewSize, at: egui::Vec2) -> (DVec3, DVec3) {
        let [right, up, back] = self.frame();
        let x = 2.0 * f64::from(at.x) / size.0.x - 1.0;
        let y = 1.0 - 2.0 * f64::from(at.y) / size.0.y;
        let half = self.half_height();
        let on_focus = self.focus() + right * (x * half * size.aspect()) + up * (y * half);
        if self.is_parallel() {
            (on_focus + back * (500.0 * self.distance), -back)
        } else {
            (self.eye(), (on_focus - self.eye()).normalize())
        }
    }

    /// Turns around the focus by a drag in points.
    pub fn orbit(&mut self, drag: egui::Vec2) {
        self.turn -= f64::from(drag.x) * 0.008;
        self.rise = (self.rise + f64::from(drag.y) * 0.008).clamp(-1.55, 1.55);
    }

    /// Moves across the view, so that what is at the focus follows the pointer.
    pub fn pan(&mut self, size: ViewSize, drag: egui::Vec2) {
        let [right, up, _] = self.frame();
        let scale = self.metres_per_point(size);
        let moved = self.focus() - right * (f64::from(drag.x) * scale) + up * (f64::from(drag.y) * scale);
        self.focus = moved.to_array();
    }

    /// Comes nearer by a factor above 1, or goes back; what is under the pointer stays there.
    pub fn zoom(&mut self, size: ViewSize, at: egui::Vec2, factor: f64) {
        let before = self.under(size, at);
        self.distance = (self.distance / factor).clamp(DISTANCES[0], DISTANCES[1]);
        let after = self.under(size, at);
        self.focus = (self.focus() + before - after).to_array();
    }

    /// The point under the pointer in the plane of the focus.
    fn under(&self, size: ViewSize, at: egui::Vec2) -> DVec3 {
        let [right, up, _] = self.frame();
        let scale = self.metres_per_point(size);
        let offset = DVec2::new(f64::from(at.x), f64::from(at.y)) - 0.5 * size.0;
        self.focus() + right * (offset.x * scale) - up * (offset.y * scale)
    }

    /// Looks at a box so that it fills the view.
    pub fn frame_box(&mut self, size: ViewSize, [low, high]: [DVec3; 2]) {
        let [right, up, back] = self.frame();
        let extent = high - low;
        let along = |axis: DVec3| 0.5 * extent.dot(axis.abs());
        let half = (along(up)).max(along(right) / size.aspect()).max(1e-3) * MARGIN;
        let lens = (0.5 * FIELD_OF_VIEW_DEGREES).to_radians().tan();
        let depth = if self.is_parallel() { 0.0 } else { along(back) };
        self.focus = ((low + high) * 0.5).to_array();
        self.distance = (half / lens + depth).clamp(DISTANCES[0], DISTANCES[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size() -> ViewSize {
        ViewSize::new(egui::vec2(400.0, 300.0))
    }

    #[test]
    fn the_fixed_views_show_the_axes_as_sketches_take_them() {
        let at = |direction, point| {
            let mut camera = Camera::new(direction);
            camera.focus = [0.0; 3];
            let seen = camera.project(size(), point).unwrap() - egui::vec2(200.0, 150.0);
            [
                seen.x.signum() * f32::from(u8::from(seen.x.abs() > 1.0)),
                seen.y.signum() * f32::from(u8::from(seen.y.abs() > 1.0)),
            ]
        };
        assert_eq!(at(Direction::Front, DVec3::X), [1.0, 0.0]);
        assert_eq!(at(Direction::Front, DVec3::Y), [0.0, -1.0]);
        assert_eq!(at(Direction::Side, DVec3::Z), [1.0, 0.0]);
        assert_eq!(at(Direction::Side, DVec3::Y), [0.0, -1.0]);
        assert_eq!(at(Direction::Top, DVec3::X), [1.0, 0.0]);
        assert_eq!(at(Direction::Top, DVec3::Z), [0.0, 1.0]);
    }

    #[test]
    fn a_ray_leads_to_what_is_seen_there() {
        for direction in Direction::ALL {
            let camera = Camera::new(direction);
            let point = DVec3::new(0.2, 1.1, -0.3);
            let seen = camera.project(size(), point).unwrap();
            let (origin, along) = camera.ray(size(), seen);
            let beside = (point - origin).cross(along).length();
            assert!(beside < 1e-5, "{direction:?}: {beside}");
            assert!((point - origin).dot(along) > 0.0);
        }
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let mut camera = Camera::new(Direction::Front);
        let pointer = egui::vec2(90.0, 40.0);
        let (origin, _) = camera.ray(size(), pointer);
        camera.zoom(size(), pointer, 3.0);
        assert!((camera.project(size(), origin).unwrap() - pointer).length() < 1e-3);
        assert!((camera.distance - 3.5 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn framing_fills_the_view_and_leaves_nothing_out() {
        let [low, high] = [DVec3::new(-0.3, 0.9, -0.1), DVec3::new(0.3, 1.5, 0.2)];
        for direction in Direction::ALL {
            let mut camera = Camera::new(direction);
            camera.frame_box(size(), [low, high]);
            let mut farthest = 0.0_f32;
            for corner in 0..8 {
                let pick = |k: usize| if corner >> k & 1 == 0 { low[k] } else { high[k] };
                let seen = camera.project(size(), DVec3::new(pick(0), pick(1), pick(2))).unwrap();
                let off = (seen - egui::vec2(200.0, 150.0)) / egui::vec2(200.0, 150.0);
                farthest = farthest.max(off.abs().max_elem());
            }
            assert!((0.6..=1.0).contains(&farthest), "{direction:?}: {farthest}");
        }
    }
}
