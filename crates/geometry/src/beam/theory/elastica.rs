//! The plane elastica: a thin strip that bends and keeps its length, however far.
//!
//! Over the share `s` of its length, with the angle `t` of its tangent: `t'' = -k cos t` under a load across the start of
//! a cantilever, `t'' = -k sin t` under a pull along x on a quarter of a ring; `k` is the load in units of `EI` over the
//! length squared.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;

use super::Given;

/// How the strip is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Held {
    /// Straight at rest; its start keeps place and direction, its end is free of moment.
    Cantilever,
    /// A quarter of a circle at rest; both ends keep their directions.
    Ring,
}

/// A solved strip of length 1.
#[derive(Clone, Debug)]
pub(super) struct Elastica {
    /// Places at equal steps, the first at the origin.
    points: Vec<DVec2>,
    /// Unit tangents there.
    tangents: Vec<DVec2>,
    /// The load, in units of `EI` over the length squared.
    pub(super) load: f64,
}

/// Steps of the integration while the solution is looked for, and for the result.
const SEARCHED: usize = 128;
const REFINED: usize = 1024;
/// Steps from rest to the wanted load: each begins where the one before ended.
const STAGES: usize = 32;

/// Angle, curvature, x and y; then their derivatives by the curvature at the start, and by the load.
type State = [f64; 12];

impl Elastica {
    /// The strip with the load, or the displacement in units of its length: of the tip across, or half the axis of the
    /// ring. None where Newton's method finds none, or it lies beyond what [`super::TheoryError::TooFar`] says.
    pub(super) fn find(held: Held, given: Given) -> Option<Self> {
        let at_rest = match (held, given) {
            (Held::Ring, Given::Displacement(_)) => 1.0 / FRAC_PI_2,
            _ => 0.0,
        };
        let (Given::Displacement(wanted) | Given::Load(wanted)) = given;
        let mut found = (held.rest_curvature(), 0.0);
        for stage in 1..=STAGES {
            let goal = at_rest + (wanted - at_rest) * (stage as f64 / STAGES as f64);
            found = held.solve(found, given, goal, SEARCHED)?;
        }
        let (curvature, load) = held.solve(found, given, wanted, REFINED)?;
        let mut state = held.start(curvature);
        let mut shape = Self { points: vec![DVec2::ZERO], tangents: vec![DVec2::from_angle(state[0])], load };
        for _ in 0..REFINED {
            state = held.step(&state, load, 1.0 / REFINED as f64);
            shape.points.push(DVec2::new(state[2], state[3]));
            shape.tangents.push(DVec2::from_angle(state[0]));
        }
        let reached = match held {
            Held::Cantilever => state[3].abs() <= 0.85 + 1e-9,
            Held::Ring => (0.4 - 1e-9..=1.4 + 1e-9).contains(&(-state[2] * FRAC_PI_2)),
        };
        reached.then_some(shape)
    }

    /// The point at the share `s` of the length: cubic between the steps, with their tangents.
    pub(super) fn point(&self, s: f64) -> DVec2 {
        let place = (s * REFINED as f64).clamp(0.0, REFINED as f64);
        let k = (place.floor() as usize).min(REFINED - 1);
        let (t, step) = (place - k as f64, 1.0 / REFINED as f64);
        let along = |from: f64, to: f64| (t - 1.0) * (t - 1.0) * t * from + t * t * (t - 1.0) * to;
        let across = t * t * (3.0 - 2.0 * t);
        let (a, b) = (self.tangents[k] * step, self.tangents[k + 1] * step);
        self.points[k].lerp(self.points[k + 1], across) + DVec2::new(along(a.x, b.x), along(a.y, b.y))
    }

    /// Half axes of the ring of which this is a quarter: along the load and across it.
    pub(super) fn half_axes(&self) -> DVec2 {
        let end = self.points[REFINED];
        DVec2::new(-end.x, end.y)
    }

    /// The point of a quarter of the ring about its middle, from the loaded axis on.
    pub(super) fn ring_point(&self, s: f64) -> DVec2 {
        self.point(s) + DVec2::X * self.half_axes().x
    }
}

impl Held {
    fn rest_curvature(self) -> f64 {
        match self {
            Self::Cantilever => 0.0,
            Self::Ring => FRAC_PI_2,
        }
    }

    fn start(self, curvature: f64) -> State {
        let mut state = [0.0; 12];
        state[0] = match self {
            Self::Cantilever => 0.0,
            Self::Ring => FRAC_PI_2,
        };
        state[1] = curvature;
        state[5] = 1.0;
        state
    }

    /// Newton's method for the curvature at the start and the load, from a guess.
    fn solve(self, (mut curvature, mut load): (f64, f64), given: Given, goal: f64, steps: usize) -> Option<(f64, f64)> {
        for _ in 0..30 {
            let mut state = self.start(curvature);
            for _ in 0..steps {
                state = self.step(&state, load, 1.0 / steps as f64);
            }
            // The end's condition, and what is given; each with its derivatives by curvature and load.
            let (end, by) = match self {
                Self::Cantilever => ([state[1], state[5], state[9]], [state[3], state[7], state[11]]),
                Self::Ring => ([state[0] - PI, state[4], state[8]], [-state[2], -state[6], -state[10]]),
            };
            let by = match given {
                Given::Displacement(_) => [by[0] - goal, by[1], by[2]],
                Given::Load(_) => [load - goal, 0.0, 1.0],
            };
            let determinant = end[1] * by[2] - end[2] * by[1];
            let d_curvature = (end[0] * by[2] - end[2] * by[0]) / determinant;
            let d_load = (end[1] * by[0] - end[0] * by[1]) / determinant;
            curvature -= d_curvature;
            load -= d_load;
            if !(curvature.is_finite() && load.is_finite()) {
                return None;
            }
            if d_curvature.abs() <= 1e-12 * (1.0 + curvature.abs()) && d_load.abs() <= 1e-12 * (1.0 + load.abs()) {
                return Some((curvature, load));
            }
        }
        None
    }

    /// One step of the classical Runge-Kutta method.
    fn step(self, state: &State, load: f64, h: f64) -> State {
        let moved = |by: &State, h: f64| -> State { std::array::from_fn(|i| state[i] + h * by[i]) };
        let a = self.slope(state, load);
        let b = self.slope(&moved(&a, h / 2.0), load);
        let c = self.slope(&moved(&b, h / 2.0), load);
        let d = self.slope(&moved(&c, h), load);
        std::array::from_fn(|i| state[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]))
    }

    fn slope(self, state: &State, load: f64) -> State {
        let (sin, cos) = state[0].sin_cos();
        let (pull, pull_by_angle) = match self {
            Self::Cantilever => (cos, -sin),
            Self::Ring => (sin, cos),
        };
        let mut slope = [state[1], -load * pull, cos, sin, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for first in [4, 8] {
            let angle = state[first];
            slope[first] = state[first + 1];
            slope[first + 1] = -load * pull_by_angle * angle;
            slope[first + 2] = -sin * angle;
            slope[first + 3] = cos * angle;
        }
        slope[9] -= pull;
        slope
    }
}
