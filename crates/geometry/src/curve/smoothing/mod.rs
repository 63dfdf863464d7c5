//! Smoothing along a curve: bends shorter than a wavelength go, longer ones stay.

mod cells;
mod smoothing_spline;

pub(crate) use smoothing_spline::{Ends, NotSolvable, smoothed};

use super::{ArcLength, Curve, CurveError};

/// Size below which nothing is left of a smoothed curve, in the size it had.
const VANISHED: f64 = 1e-6;

/// Why a curve cannot be smoothed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// A wavelength that is no length.
    #[error("the wavelength {wave} m is not a length: give a number of metres above 0")]
    Wave {
        /// The wavelength given.
        wave: f64,
    },
    /// Nothing is left of it.
    #[error(
        "smoothing over {wave} m leaves nothing of curve \"{name}\", which is {length:.4} m long: give a shorter \
         wavelength"
    )]
    Vanishes {
        /// Name of the curve.
        name: String,
        /// The wavelength given, metres.
        wave: f64,
        /// Length of the curve, metres.
        length: f64,
    },
    /// Points that cannot be smoothed in double precision.
    #[error("curve \"{name}\" cannot be smoothed in double precision: scale it to metres, or resample it")]
    NotSolvable {
        /// Name of the curve.
        name: String,
    },
    /// Points fall together.
    #[error("the smoothed points make no curve ({0}): give a shorter wavelength")]
    Curve(#[from] CurveError),
}

/// Takes bends shorter than `wave` metres off a curve: a bend of that wavelength is halved, one of twice that length
/// keeps 94 %, one of half that length 6 %, however the points are spaced.
///
/// Each coordinate is smoothed over arc length by a cubic smoothing spline (E. T. Whittaker 1923; C. H. Reinsch 1967,
/// "Smoothing by spline functions", Numer. Math. 10), periodic for a closed curve. The number of points, the pressure,
/// and both ends of an open curve stay. Straight lines stay to rounding (1e-12 of their length). Tolerance: points
/// closer than 1/64 of `wave` or of the curve's length are averaged before solving, which alters what is kept of a bend
/// by less than 0.001 of its height.
///
/// # Errors
/// [`SmoothError`] where `wave` is not a positive number, the curve shrinks below a millionth of its size, or its
/// coordinates are beyond the range of a double.
pub fn smooth(curve: &Curve, wave: f64) -> Result<Curve, SmoothError> {
    if !(wave.is_finite() && wave > 0.0) {
        return Err(SmoothError::Wave { wave });
    }
    let name = || curve.name().to_owned();
    let arc = ArcLength::of(curve);
    let length = arc.length();
    let stations = &arc.cumulative()[..curve.points().len()];
    let ends = if curve.is_closed() { Ends::Closed { period: length } } else { Ends::Open { held: [true; 2] } };
    let points = smoothed(curve.points(), stations, ends, wave)
        .map_err(|NotSolvable| SmoothError::NotSolvable { name: name() })?;
    let calm = Curve::with_pressure(curve.name(), points, curve.is_closed(), curve.pressure().map(<[f64]>::to_vec))?;
    let size = |curve: &Curve| {
        let (low, high) = curve.bounds();
        (high - low).length()
    };
    if size(&calm) < VANISHED * size(curve) {
        return Err(SmoothError::Vanishes { name: name(), wave, length });
    }
    Ok(calm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn wavy_circle(points: u32, start: f64) -> Curve {
        let point = |k: u32| {
            let angle = start + std::f64::consts::TAU * f64::from(k) / f64::from(points);
            let radius = 1.0 + 0.05 * (30.0 * angle).sin();
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.3)
        };
        Curve::new("wavy", (0..points).map(point).collect(), true).unwrap()
    }

    #[test]
    fn a_closed_curve_loses_its_waves_wherever_it_starts() {
        for start in [0.0, 1.0] {
            let smooth = smooth(&wavy_circle(400, start), 0.8).unwrap();
            let radii: Vec<f64> = smooth.points().iter().map(|p| p.truncate().length()).collect();
            let (low, high) = radii.iter().fold((f64::MAX, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
            assert!(high - low < 0.004, "waves of 0.1 are gone: {low} {high}");
            // A circle is a wave as long as itself: (0.8 / 2 pi)^4 = 0.0003 of its radius go.
            assert!((low + high - 2.0).abs() < 0.01, "{low} {high}");
        }
    }

    #[test]
    fn an_open_curve_keeps_its_ends_and_a_straight_one_stays() {
        let at = |k: u32| DVec3::new(f64::from(k) * 0.01, if k.is_multiple_of(2) { 0.002 } else { -0.002 }, 1.0);
        let shaky = Curve::new("shaky", (0..=100).map(at).collect(), false).unwrap();
        let calm = smooth(&shaky, 0.1).unwrap();
        assert_eq!((calm.start(), calm.end(), calm.points().len()), (shaky.start(), shaky.end(), 101));
        assert!(calm.points()[20..80].iter().all(|p| p.y.abs() < 1e-4));
        let line = Curve::new("line", (0..9).map(|k| DVec3::X * f64::from(k * k)).collect(), false).unwrap();
        for (was, is) in line.points().iter().zip(smooth(&line, 10.0).unwrap().points()) {
            assert!(was.distance(*is) < 1e-6);
        }
    }

    #[test]
    fn a_wavelength_must_be_a_length() {
        for wave in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(smooth(&wavy_circle(9, 0.0), wave), Err(SmoothError::Wave { .. })));
        }
    }

    #[test]
    fn dense_points_on_a_straight_line_stay() {
        for count in [20_000, 60_000] {
            let at = |k: i32| DVec3::new(0.6, -0.8, 0.0) * (f64::from(k) / f64::from(count - 1)) + DVec3::splat(1.3);
            let line = Curve::new("line", (0..count).map(at).collect(), false).unwrap();
            for wave in [0.5, 2.0, 1000.0] {
                let calm = smooth(&line, wave).unwrap();
                let off = line.points().iter().zip(calm.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                assert!(off < 1e-12, "{count} {wave}: {off}");
            }
        }
    }

    #[test]
    fn dense_points_on_a_circle_shrink_as_they_should() {
        for count in [7_u32, 20_000, 60_000] {
            let at = |k: u32| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                DVec3::new(angle.cos(), angle.sin(), 0.5)
            };
            let circle = Curve::new("circle", (0..count).map(at).collect(), true).unwrap();
            for wave in [0.5, 2.0, std::f64::consts::TAU] {
                let kept = 1.0 / (1.0 + (wave / std::f64::consts::TAU).powi(4));
                for point in smooth(&circle, wave).unwrap().points() {
                    let radius = point.truncate().length();
                    let tolerance = if count == 7 { 0.06 } else { 1e-3 };
                    assert!(
                        (radius - kept).abs() < tolerance && (point.z - 0.5).abs() < 1e-12,
                        "{count} {wave} {radius}"
                    );
                }
            }
            assert!(matches!(smooth(&circle, 1000.0), Err(SmoothError::Vanishes { wave: 1000.0, .. })));
        }
    }

    #[test]
    fn what_cannot_be_smoothed_is_an_error() {
        let far = [DVec3::ZERO, DVec3::X * 1e308, DVec3::new(-1e308, 1e308, 0.0), DVec3::Y];
        let far = Curve::new("far", far.to_vec(), false).unwrap();
        let error = smooth(&far, 0.1).unwrap_err();
        assert_eq!(error, SmoothError::NotSolvable { name: "far".into() });
        assert!(error.to_string().contains("scale it"), "{error}");
        let spike = Curve::new("spike", vec![DVec3::ZERO, DVec3::X, DVec3::ZERO], false).unwrap();
        let error = smooth(&spike, 1e9).unwrap_err();
        assert!(
            !matches!(error, SmoothError::Wave { .. }) && error.to_string().contains("shorter wavelength"),
            "{error}"
        );
    }
}
