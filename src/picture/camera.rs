//! Where a picture is taken from: four fixed views, framed so that everything drawn is inside.

use glam::{DVec2, DVec3};

/// Share of the picture's width and height that stays empty on each side.
const MARGIN: f64 = 0.08;
/// Angle the perspective lens sees across the picture's longer side, degrees.
const FIELD_OF_VIEW_DEGREES: f64 = 30.0;
/// Where the three-quarter view stands, degrees: turned from the front to the model's left, and raised.
const THREE_QUARTER_DEGREES: [f64; 2] = [35.0, 14.0];

/// Where a picture is taken from. World axes are +X to the model's left, +Y up, +Z to the front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum View {
    /// From the front, looking along -Z without perspective: +X to the right, +Y up.
    Front,
    /// The plane of side sketches, looking along +X without perspective: +Z to the right, +Y up.
    Side,
    /// From above, looking along -Y without perspective: +X to the right, +Z down.
    Top,
    /// From the front, turned to the model's left and a little above, through a long lens.
    #[default]
    ThreeQuarter,
}

impl View {
    /// Right, up and towards the viewer: an orthonormal, right-handed frame.
    fn frame(self) -> [DVec3; 3] {
        let (up, back) = match self {
            Self::Front => (DVec3::Y, DVec3::Z),
            Self::Side => (DVec3::Y, DVec3::NEG_X),
            Self::Top => (DVec3::NEG_Z, DVec3::Y),
            Self::ThreeQuarter => {
                let [turn, rise] = THREE_QUARTER_DEGREES.map(f64::to_radians);
                let back = DVec3::new(turn.sin() * rise.cos(), rise.sin(), turn.cos() * rise.cos());
                (back.cross(DVec3::Y.cross(back)).normalize(), back)
            }
        };
        [up.cross(back), up, back]
    }
}

/// A box around points, and the sphere around that box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Lowest coordinates, metres.
    pub low: DVec3,
    /// Middle of the box, metres.
    pub centre: DVec3,
    /// Half the diagonal, metres; never zero, so that it can be divided by.
    pub radius: f64,
}

impl Bounds {
    /// The bounds of `points`, or `None` where there are none.
    pub fn of(points: impl Iterator<Item = DVec3>) -> Option<Self> {
        let (low, high) = points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let centre = low + (high - low) * 0.5;
        // Far from the origin coordinates are coarser than a small subject; a picture of one point needs a size too.
        let least = (low.abs().max(high.abs()).max_element() * 1e-12).max(1e-9);
        Some(Self { low, centre, radius: ((high - low).length() * 0.5).max(least) })
    }
}

/// How view space comes onto the picture.
#[derive(Clone, Copy, Debug)]
enum Lens {
    /// Orthographic.
    Parallel { pixels_per_metre: f64 },
    /// Central: `focal` is the distance, in pixels, at which a pixel is one pixel wide.
    Perspective { focal: f64, near: f64 },
}

/// A point on the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected {
    /// Pixels from the top left corner; pixel centres are at halves.
    pub pixel: DVec2,
    /// Larger is nearer, and it is linear across the picture along any straight line or plane in space: minus the
    /// distance for parallel projection, its reciprocal for perspective.
    pub depth: f64,
}

/// A view, framed.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    /// Unit vector to the right of the picture.
    pub right: DVec3,
    /// Unit vector to the top of the picture.
    pub up: DVec3,
    /// Unit vector towards the viewer.
    pub back: DVec3,
    /// The lens; for parallel projection the point in the middle of the picture.
    eye: DVec3,
    lens: Lens,
    middle: DVec2,
}

impl Camera {
    /// The camera of `view` that holds all `points` with [`MARGIN`] to spare on a picture of `size` pixels.
    pub fn framing(view: View, points: impl Iterator<Item = DVec3>, bounds: &Bounds, size: DVec2) -> Self {
        let [right, up, back] = view.frame();
        let middle = size * 0.5;
        let usable = size * (0.5 - MARGIN);
        let in_frame = |p: DVec3| {
            let p = p - bounds.centre;
            DVec3::new(p.dot(right), p.dot(up), p.dot(back))
        };
        let world = |p: DVec3| bounds.centre + right * p.x + up * p.y + back * p.z;
        match view {
            View::Front | View::Side | View::Top => {
                let mut low = DVec2::INFINITY;
                let mut high = DVec2::NEG_INFINITY;
                for p in points.map(in_frame) {
                    low = low.min(p.truncate());
                    high = high.max(p.truncate());
                }
                let half = ((high - low) * 0.5).max(DVec2::splat(bounds.radius * 0.05));
                let eye = world(((low + high) * 0.5).extend(0.0));
                let pixels_per_metre = (usable / half).min_element();
                Self { right, up, back, eye, lens: Lens::Parallel { pixels_per_metre }, middle }
            }
            View::ThreeQuarter => {
                let focal = 0.5 * size.max_element() / (0.5 * FIELD_OF_VIEW_DEGREES).to_radians().tan();
                let slope = usable / focal;
                // Each side of the frustum is a plane through the eye: the farthest point on it fixes one linear
                // inequality for the eye, and opposite sides together give its place and its least distance.
                let mut over = DVec2::NEG_INFINITY;
                let mut under = DVec2::NEG_INFINITY;
                let mut nearest = f64::NEG_INFINITY;
                for p in points.map(in_frame) {
                    over = over.max(p.truncate() + slope * p.z);
                    under = under.max(slope * p.z - p.truncate());
                    nearest = nearest.max(p.z);
                }
                let distance = ((over + under) / (2.0 * slope)).max_element().max(nearest + bounds.radius * 0.5);
                let eye = world(((over - under) * 0.5).extend(distance));
                let near = bounds.radius * 1e-3;
                Self { right, up, back, eye, lens: Lens::Perspective { focal, near }, middle }
            }
        }
    }

    /// A point in the camera's frame: right, up, and distance in front of the eye, metres.
    pub fn to_view(&self, point: DVec3) -> DVec3 {
        let p = point - self.eye;
        DVec3::new(p.dot(self.right), p.dot(self.up), -p.dot(self.back))
    }

    /// How far a point in the camera's frame lies behind the near plane; what is negative cannot be projected.
    pub fn clearance(&self, view: DVec3) -> f64 {
        match self.lens {
            Lens::Parallel { .. } => f64::INFINITY,
            Lens::Perspective { near, .. } => view.z - near,
        }
    }

    /// Where a point in the camera's frame comes to lie on the picture. Its clearance must not be negative.
    pub fn project(&self, view: DVec3) -> Projected {
        let (scale, depth) = match self.lens {
            Lens::Parallel { pixels_per_metre } => (pixels_per_metre, -view.z),
            Lens::Perspective { focal, .. } => (focal / view.z, 1.0 / view.z),
        };
        Projected { pixel: self.middle + DVec2::new(view.x, -view.y) * scale, depth }
    }

    /// By how much depth grows at `depth` where a point comes nearer by `metres`, to first order.
    pub fn depth_step(&self, depth: f64, metres: f64) -> f64 {
        match self.lens {
            Lens::Parallel { .. } => metres,
            Lens::Perspective { .. } => metres * depth * depth,
        }
    }

    /// Weights that interpolate over a triangle in space, from weights on the picture and the corners' depths.
    pub fn in_space(&self, weights: [f64; 3], depths: [f64; 3]) -> [f64; 3] {
        match self.lens {
            Lens::Parallel { .. } => weights,
            Lens::Perspective { .. } => {
                let scaled = [weights[0] * depths[0], weights[1] * depths[1], weights[2] * depths[2]];
                let sum = scaled[0] + scaled[1] + scaled[2];
                if sum > 0.0 { scaled.map(|w| w / sum) } else { weights }
            }
        }
    }

    /// Start and direction of the ray through a pixel; the direction's length is not 1.
    pub fn ray(&self, pixel: DVec2) -> (DVec3, DVec3) {
        let offset = pixel - self.middle;
        match self.lens {
            Lens::Parallel { pixels_per_metre } => {
                (self.eye + (self.right * offset.x - self.up * offset.y) / pixels_per_metre, -self.back)
            }
            Lens::Perspective { focal, .. } => {
                (self.eye, (self.right * offset.x - self.up * offset.y) / focal - self.back)
            }
        }
    }

    /// Pixels that one metre across the line of sight takes at `point`.
    pub fn pixels_per_metre(&self, point: DVec3) -> f64 {
        match self.lens {
            Lens::Parallel { pixels_per_metre } => pixels_per_metre,
            Lens::Perspective { focal, near } => focal / self.to_view(point).z.max(near),
        }
    }

    /// Whether sight lines are parallel.
    pub fn is_parallel(&self) -> bool {
        matches!(self.lens, Lens::Parallel { .. })
    }

    /// The same camera moved by `step` metres.
    #[cfg(test)]
    pub fn moved(mut self, step: DVec3) -> Self {
        self.eye += step;
        self
    }

    /// Unit vector from `point` to the viewer.
    pub fn towards_eye(&self, point: DVec3) -> DVec3 {
        match self.lens {
            Lens::Parallel { .. } => self.back,
            Lens::Perspective { .. } => (self.eye - point).normalize_or(self.back),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: DVec2 = DVec2::new(640.0, 480.0);

    fn cube() -> Vec<DVec3> {
        (0..8)
            .map(|i| {
                DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1) * 1.8, f64::from(i >> 2) * 0.4) + DVec3::splat(3.0)
            })
            .collect()
    }

    fn camera(view: View) -> Camera {
        let bounds = Bounds::of(cube().into_iter()).unwrap();
        Camera::framing(view, cube().into_iter(), &bounds, SIZE)
    }

    #[test]
    fn axes_lie_on_the_documented_sides() {
        let step = |view: View, axis: DVec3| {
            let camera = camera(view);
            let at = |p| camera.project(camera.to_view(p)).pixel;
            (at(DVec3::splat(3.5) + axis * 0.1) - at(DVec3::splat(3.5))).normalize_or_zero()
        };
        let (right, up) = (DVec2::X, DVec2::NEG_Y);
        for (view, axis, expected) in [
            (View::Front, DVec3::X, right),
            (View::Front, DVec3::Y, up),
            (View::Front, DVec3::Z, DVec2::ZERO),
            (View::Side, DVec3::Z, right),
            (View::Side, DVec3::Y, up),
            (View::Side, DVec3::X, DVec2::ZERO),
            (View::Top, DVec3::X, right),
            (View::Top, DVec3::Z, -up),
            (View::Top, DVec3::Y, DVec2::ZERO),
        ] {
            assert!(step(view, axis).distance(expected) < 1e-9, "{view:?} {axis}: {}", step(view, axis));
        }
        assert!(step(View::ThreeQuarter, DVec3::X).x > 0.5);
        assert!(step(View::ThreeQuarter, DVec3::Y).y < -0.9);
        // From the model's left: what is in front lies to the left of the picture.
        assert!(step(View::ThreeQuarter, DVec3::Z).x < -0.5);
    }

    #[test]
    fn nearer_is_larger_depth() {
        for (view, towards) in [
            (View::Front, DVec3::Z),
            (View::Side, DVec3::NEG_X),
            (View::Top, DVec3::Y),
            (View::ThreeQuarter, DVec3::ONE),
        ] {
            let camera = camera(view);
            let at = |p| camera.project(camera.to_view(p)).depth;
            assert!(at(DVec3::splat(3.5) + towards * 0.01) > at(DVec3::splat(3.5)), "{view:?}");
        }
    }

    #[test]
    fn frames_with_eight_percent_to_spare() {
        for view in [View::Front, View::Side, View::Top, View::ThreeQuarter] {
            let camera = camera(view);
            let pixels: Vec<DVec2> = cube().into_iter().map(|p| camera.project(camera.to_view(p)).pixel).collect();
            let low = pixels.iter().copied().reduce(DVec2::min).unwrap() / SIZE;
            let high = pixels.iter().copied().reduce(DVec2::max).unwrap() / SIZE;
            let gaps = [low.x, low.y, 1.0 - high.x, 1.0 - high.y];
            let tightest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((tightest - 0.08).abs() < 1e-9, "{view:?}: {gaps:?}");
            // In the middle, exactly so where the fit is tight; across the other side what is nearer is larger.
            assert!((gaps[0] - gaps[2]).abs() < 0.02 && (gaps[1] - gaps[3]).abs() < 1e-9, "{view:?}: {gaps:?}");
        }
    }

    #[test]
    fn rays_run_through_what_projects_there() {
        let point = DVec3::new(3.2, 4.0, 3.3);
        for view in [View::Front, View::Side, View::Top, View::ThreeQuarter] {
            let camera = camera(view);
            let (start, direction) = camera.ray(camera.project(camera.to_view(point)).pixel);
            assert!((point - start).cross(direction).length() < 1e-9 * direction.length(), "{view:?}");
        }
    }

    #[test]
    fn depth_step_is_the_derivative() {
        let camera = camera(View::ThreeQuarter);
        let at = |p| camera.project(camera.to_view(p)).depth;
        let point = DVec3::splat(3.5);
        let step = 1e-6;
        let measured = at(point + camera.back * step) - at(point);
        assert!((measured / camera.depth_step(at(point), step) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn one_point_still_has_a_picture() {
        let point = DVec3::new(1e6, 0.0, 0.0);
        let bounds = Bounds::of([point].into_iter()).unwrap();
        for view in [View::Front, View::ThreeQuarter] {
            let camera = Camera::framing(view, [point].into_iter(), &bounds, SIZE);
            let at = camera.project(camera.to_view(point)).pixel;
            assert!(at.distance(SIZE * 0.5) < 1.0, "{view:?}: {at}");
        }
    }
}
