//! Anderson's acceleration of an iteration on points (Peng, Deng, Zhang, Geng, Qin and Liu, Anderson Acceleration for
//! Geometry Optimization and Physics Simulation, 2018).

use glam::DVec3;
use nalgebra::{DMatrix, DVector};

/// Iterations that are looked back on.
const DEPTH: usize = 6;

/// Guesses where an iteration `x -> g(x)` leads from its last steps.
#[derive(Debug, Default)]
pub(super) struct Anderson {
    /// `g(x)` and `g(x) - x` of the last iteration.
    last: Option<(Vec<DVec3>, Vec<DVec3>)>,
    /// Their differences from iteration to iteration, the newest last.
    differences: Vec<(Vec<DVec3>, Vec<DVec3>)>,
}

impl Anderson {
    /// The next point to go on from after `g(x)`: the combination of the last ones with the least `g(x) - x`.
    pub fn next(&mut self, x: &[DVec3], stepped: &[DVec3]) -> Vec<DVec3> {
        let step: Vec<DVec3> = stepped.iter().zip(x).map(|(g, x)| *g - *x).collect();
        if let Some((last_stepped, last_step)) = self.last.take() {
            let less = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| *a - *b).collect::<Vec<_>>();
            self.differences.push((less(stepped, &last_stepped), less(&step, &last_step)));
            if self.differences.len() > DEPTH {
                self.differences.remove(0);
            }
        }
        let mut next = stepped.to_vec();
        for (share, (by, _)) in self.shares(&step).iter().zip(&self.differences) {
            next.iter_mut().zip(by).for_each(|(p, d)| *p -= *share * *d);
        }
        self.last = Some((stepped.to_vec(), step));
        next
    }

    /// Forgets what came before: where a guess was of no use.
    pub fn restart(&mut self) {
        self.last = None;
        self.differences.clear();
    }

    /// Least squares for `step` in the differences of steps, each of length 1, so that the smallness of late ones does
    /// not show.
    fn shares(&self, step: &[DVec3]) -> Vec<f64> {
        let dot = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
        let count = self.differences.len();
        let lengths: Vec<f64> = self.differences.iter().map(|(_, d)| dot(d, d).sqrt()).collect();
        if count == 0 || lengths.contains(&0.0) {
            return Vec::new();
        }
        let scaled =
            |i: usize, j: usize| dot(&self.differences[i].1, &self.differences[j].1) / (lengths[i] * lengths[j]);
        let mut gram = DMatrix::from_fn(count, count, |i, j| if i >= j { scaled(i, j) } else { 0.0 });
        gram.fill_upper_triangle_with_lower_triangle();
        // Steps that nearly repeat each other must not cancel by large shares.
        (0..count).for_each(|i| gram[(i, i)] += 1e-10);
        let sides = DVector::from_fn(count, |i, _| dot(&self.differences[i].1, step) / lengths[i]);
        let Some(factor) = gram.cholesky() else { return Vec::new() };
        factor.solve(&sides).iter().zip(&lengths).map(|(share, length)| share / length).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contraction that plain steps follow slowly: each coordinate by its own factor towards 1.
    fn contraction(x: &[DVec3]) -> Vec<DVec3> {
        let of =
            |(i, p): (usize, &DVec3)| DVec3::ONE + (*p - DVec3::ONE) * DVec3::new(0.999, 0.99, 0.8 - 0.1 * i as f64);
        x.iter().enumerate().map(of).collect()
    }

    #[test]
    fn a_linear_iteration_ends_in_as_many_steps_as_it_has_factors() {
        let mut x = vec![DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.0, 4.0, -1.0)];
        let mut anderson = Anderson::default();
        for _ in 0..8 {
            x = anderson.next(&x, &contraction(&x));
        }
        assert!(x.iter().all(|p| p.distance(DVec3::ONE) < 1e-4), "{x:?}");
    }

    #[test]
    fn a_fixed_point_stays_and_a_restart_takes_the_plain_step() {
        let mut anderson = Anderson::default();
        let x = vec![DVec3::ONE; 2];
        assert_eq!(anderson.next(&x, &x), x);
        assert_eq!(anderson.next(&x, &x), x);
        anderson.restart();
        let y = vec![DVec3::ZERO; 2];
        assert_eq!(anderson.next(&y, &contraction(&y)), contraction(&y));
    }
}
