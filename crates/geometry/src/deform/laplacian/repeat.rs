//! Repeating the second system until nothing moves.

use glam::DVec3;

use super::anderson::Anderson;
use super::error::DeformError;

/// Passes until the largest move is small, with guesses ahead where an energy judges them.
#[derive(Debug)]
pub(super) struct Repeated {
    tolerance: f64,
    most: usize,
    guesses: bool,
    /// Passes so far; the one before the first counts.
    pub passes: usize,
    /// Largest move of a vertex in the last pass, metres; infinite before the first.
    pub last_move: f64,
}

impl Repeated {
    /// Until nothing moves farther than `tolerance` metres in a pass, or `most` passes are done.
    pub fn new(tolerance: f64, most: usize, guesses: bool) -> Self {
        Self { tolerance, most, guesses, passes: 1, last_move: f64::INFINITY }
    }

    /// Runs passes on the displacements, of which the first `free` change. `pass` gives the energy that it found before it
    /// changed them.
    pub fn run(
        &mut self,
        displacements: &mut [DVec3],
        free: usize,
        pass: &dyn Fn(&mut [DVec3]) -> Result<f64, DeformError>,
        go_on: &dyn Fn(f64) -> Result<(), DeformError>,
    ) -> Result<(), DeformError> {
        let mut anderson = Anderson::default();
        // The last result of a plain pass, and its energy once known.
        let mut plain: Option<Vec<DVec3>> = None;
        let mut least = f64::INFINITY;
        while self.passes < self.most && self.last_move > self.tolerance {
            go_on(self.passes as f64 / self.most as f64)?;
            let before = displacements[..free].to_vec();
            let energy = pass(displacements)?;
            self.passes += 1;
            if let Some(plain) = plain.as_ref().filter(|_| energy > least) {
                // The guess led up: back to where the plain pass had come.
                displacements[..free].copy_from_slice(plain);
                anderson.restart();
                least = f64::INFINITY;
                continue;
            }
            least = energy;
            let farthest = before.iter().zip(displacements.iter()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
            self.last_move = farthest;
            if self.guesses && farthest > self.tolerance && self.passes < self.most {
                let stepped = displacements[..free].to_vec();
                let next = anderson.next(&before, &stepped);
                if next.iter().all(|p| p.is_finite()) {
                    displacements[..free].copy_from_slice(&next);
                }
                plain = Some(stepped);
            } else {
                plain = None;
            }
        }
        Ok(())
    }
}
