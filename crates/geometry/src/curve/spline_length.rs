//! Arc length along a cubic spline.

use std::convert::Infallible;

use super::spline::CubicSpline;
use glam::DVec3;

/// Difference between one Gauss rule and two on its halves, as a share of the mean length of a piece, at which a cell is
/// fine enough; the rules converge with the tenth power of the width, so the finer one is far closer.
const ENOUGH: f64 = 1e-10;
/// Most halvings of a piece: at a cusp, where the speed has a kink, each lowers the error only four times.
const HALVINGS: u32 = 20;

/// Abscissae and weights of the five-point Gauss-Legendre rule on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The arc length of a spline, tabulated once.
///
/// Method: five-point Gauss quadrature of the speed on cells that are halved until it agrees with itself, then
/// safeguarded Newton iteration inside a cell. Tolerance: 1e-9 of the length, also through cusps (measured on a circle
/// through 8 points: 6e-14).
#[derive(Clone, Debug)]
pub struct SplineLength {
    spline: CubicSpline,
    cells: Vec<Cell>,
    /// Index of the first cell of each piece.
    pieces: Vec<usize>,
    length: f64,
}

/// A part of one piece on which one Gauss rule is enough.
#[derive(Clone, Copy, Debug)]
struct Cell {
    span: usize,
    /// Parameters at which it begins and ends.
    from: f64,
    to: f64,
    /// Arc length from the start of the spline, metres.
    before: f64,
    /// Its own arc length, metres.
    length: f64,
}

impl SplineLength {
    /// Tabulates the arc length of a spline.
    pub fn of(spline: CubicSpline) -> Self {
        match Self::of_while::<Infallible>(spline, &|| Ok(())) {
            Ok(measured) => measured,
        }
    }

    /// The same, or the error with which `go_on`, asked every 1024 pieces, says stop.
    pub(crate) fn of_while<Stop>(spline: CubicSpline, go_on: &dyn Fn() -> Result<(), Stop>) -> Result<Self, Stop> {
        let chords: f64 = (0..spline.spans()).map(|span| chord(&spline, span)).sum();
        let enough = ENOUGH * chords / spline.spans() as f64;
        let mut cells = Vec::with_capacity(4 * spline.spans());
        let mut pieces = Vec::with_capacity(spline.spans());
        let mut before = 0.0;
        for span in 0..spline.spans() {
            if span.is_multiple_of(1024) {
                go_on()?;
            }
            pieces.push(cells.len());
            let (from, to) = (spline.parameters()[span], spline.parameters()[span + 1]);
            // Parts still to be measured, the first one on top, with the length found for each and its halvings.
            let mut parts = vec![(from, to, integrate(&spline, span, from, to), 0)];
            while let Some((from, to, length, halvings)) = parts.pop() {
                let middle = 0.5 * (from + to);
                let halves = [integrate(&spline, span, from, middle), integrate(&spline, span, middle, to)];
                // Sums are no better than rounding, however small the share of a long piece among many short ones is.
                if halvings < HALVINGS && (halves[0] + halves[1] - length).abs() > enough.max(1e-14 * length) {
                    parts.push((middle, to, halves[1], halvings + 1));
                    parts.push((from, middle, halves[0], halvings + 1));
                    continue;
                }
                for (from, to, length) in [(from, middle, halves[0]), (middle, to, halves[1])] {
                    cells.push(Cell { span, from, to, before, length });
                    before += length;
                }
            }
        }
        Ok(Self { spline, cells, pieces, length: before })
    }

    /// The spline that was measured.
    pub fn spline(&self) -> &CubicSpline {
        &self.spline
    }

    /// The whole length, metres.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Length from the start to the spline's point `index`, metres; the whole length for an index out of range.
    pub fn length_at_point(&self, index: usize) -> f64 {
        self.pieces.get(index).map_or(self.length, |cell| self.cells[*cell].before)
    }

    /// The parameter at arc length `s` from the start; `s` is clamped to the length.
    pub fn parameter_at(&self, s: f64) -> f64 {
        self.locate(s).1
    }

    /// The point at arc length `s` from the start; `s` is clamped to the length.
    pub fn point_at(&self, s: f64) -> DVec3 {
        let (span, t) = self.locate(s);
        self.spline.position_in(span, t)
    }

    /// Piece and parameter at arc length `s`.
    pub(super) fn locate(&self, s: f64) -> (usize, f64) {
        let s = if s > 0.0 { s } else { 0.0 };
        let cell = self.cells.partition_point(|cell| cell.before <= s).saturating_sub(1);
        let Cell { span, from: start, to: end, before, length: whole } = self.cells[cell];
        let wanted = (s - before).min(whole);
        if whole <= 0.0 {
            return (span, start);
        }
        let (mut low, mut high) = (start, end);
        let mut t = start + (end - start) * (wanted / whole).clamp(0.0, 1.0);
        for _ in 0..40 {
            let excess = integrate(&self.spline, span, start, t) - wanted;
            if excess.abs() <= 1e-15 * self.length() {
                break;
            }
            if excess > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - excess / self.spline.derivative_in(span, t).length();
            t = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        }
        (span, t)
    }
}

/// Distance between the two ends of a piece, metres.
fn chord(spline: &CubicSpline, span: usize) -> f64 {
    let (from, to) = (spline.parameters()[span], spline.parameters()[span + 1]);
    spline.position_in(span, from).distance(spline.position_in(span, to))
}

fn integrate(spline: &CubicSpline, span: usize, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    GAUSS.iter().map(|(x, weight)| weight * spline.derivative_in(span, middle + half * x).length()).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::super::spline::{chord_parameters, uniform_parameters};
    use super::*;
    use std::f64::consts::TAU;

    /// Reference by brute force: chords of a very fine subdivision, extrapolated by Richardson.
    fn fine_length(spline: &CubicSpline, to: f64) -> f64 {
        let (low, _) = spline.domain();
        let chords = |count: u32| {
            let at = |i: u32| spline.position(low + (to - low) * f64::from(i) / f64::from(count));
            (0..count).map(|i| at(i).distance(at(i + 1))).sum::<f64>()
        };
        let (coarse, fine) = (chords(20_000), chords(40_000));
        fine + (fine - coarse) / 3.0
    }

    #[test]
    fn length_and_its_inverse_agree_with_a_fine_subdivision() {
        let points: Vec<DVec3> =
            (0..8).map(|i| TAU * f64::from(i) / 8.0).map(|a| DVec3::new(a.cos(), 1.5 * a.sin(), 0.2 * a)).collect();
        let spline = CubicSpline::natural(chord_parameters(&points, false), points).unwrap();
        let table = SplineLength::of(spline.clone());
        let whole = fine_length(&spline, spline.domain().1);
        assert!((table.length() - whole).abs() < 1e-9 * whole, "{} {whole}", table.length());
        for i in 1..10 {
            let s = whole * f64::from(i) / 10.0;
            let reached = fine_length(&spline, table.parameter_at(s));
            assert!((reached - s).abs() < 1e-9 * whole, "{s} {reached}");
        }
    }

    #[test]
    fn straight_spline_is_as_long_as_its_chord() {
        let spline = CubicSpline::natural(uniform_parameters(2), vec![DVec3::ZERO, DVec3::new(3.0, 4.0, 0.0)]).unwrap();
        let table = SplineLength::of(spline.clone());
        assert!((table.length() - 5.0).abs() < 1e-14);
        assert!((table.point_at(1.25) - DVec3::new(0.75, 1.0, 0.0)).length() < 1e-13);
        assert!((table.length_at_point(1) - 5.0).abs() < 1e-14);
        assert_eq!(table.parameter_at(-1.0), 0.0);
        assert!((table.parameter_at(9.0) - 1.0).abs() < 1e-14);
        assert_eq!(table.parameter_at(f64::NAN), 0.0);
    }

    #[test]
    fn length_holds_where_the_speed_vanishes() {
        // A cusp at the middle: (t^2, t^3) is a cubic, and its length from the cusp has a closed form.
        let cubic = |t: f64| DVec3::new(t * t, t * t * t, 0.0);
        let slope = |t: f64| DVec3::new(2.0 * t, 3.0 * t * t, 0.0);
        let spline =
            CubicSpline::clamped(vec![-1.0, 1.0], vec![cubic(-1.0), cubic(1.0)], slope(-1.0), slope(1.0)).unwrap();
        let table = SplineLength::of(spline.clone());
        let exact = 2.0 * (13.0_f64.powf(1.5) - 8.0) / 27.0;
        assert!((table.length() - exact).abs() < 1e-9 * exact, "{} {exact}", table.length());
        assert!(table.point_at(exact / 2.0).length() < 1e-4);
        // A tenth of the way before the cusp and behind it.
        for s in [0.4 * exact, 0.6 * exact] {
            let to_cusp = |x: f64| ((9.0 * x + 4.0).powf(1.5) - 8.0) / 27.0;
            let reached = to_cusp(table.point_at(s).x);
            assert!((reached - 0.1 * exact).abs() < 1e-8 * exact, "{s} {reached}");
        }
    }

    #[test]
    fn one_long_piece_among_many_short_ones_stays_cheap() {
        let short = (0..2000).map(|i| f64::from(i) * 1e-9).map(|x| DVec3::new(x, 1e-9 * (x * 1e9).sin(), 0.0));
        let points: Vec<DVec3> = short.chain([DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, 0.0, 0.0)]).collect();
        let spline = CubicSpline::natural(chord_parameters(&points, false), points).unwrap();
        let table = SplineLength::of(spline);
        assert!(table.cells.len() < 20 * 2000, "{}", table.cells.len());
    }
}
