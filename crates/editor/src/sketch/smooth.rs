//! From what the pen did to what was meant: as smooth as the tolerance allows, with no more points than it needs.

use glam::{DVec2, DVec3};
use maquette_geometry::curve::{Curve, Resampling, farthest, resample, smooth};

/// Most points that a stroke gets.
const MOST_POINTS: usize = 400;
/// How often the wavelength is halved in the search for the longest one.
const HALVINGS: usize = 14;

/// A line that is nowhere farther than `tolerance` metres from the drawn points, has bends as long as that allows, and as few
/// points, evenly spread, as bring it within half the tolerance again. Its ends stay. Where nothing can be smoothed (a dot, two
/// points) the drawn points come back.
///
/// Method: bisection for the longest wavelength of [`maquette_geometry::curve::smooth`].
pub(crate) fn smoothed(drawn: &[DVec2], closed: bool, tolerance: f64) -> Vec<DVec2> {
    let points: Vec<DVec3> = drawn.iter().map(|p| p.extend(0.0)).collect();
    let Ok(raw) = Curve::new("stroke", points.clone(), closed) else { return drawn.to_vec() };
    let (low, high) = raw.bounds();
    let size = (high - low).length();
    let fits = |wave: f64| smooth(&raw, wave).ok().filter(|calm| farthest(&points, calm) <= tolerance);
    let mut calm = None;
    let mut waves = [0.0, 2.0 * size];
    for _ in 0..HALVINGS {
        let wave = 0.5 * (waves[0] + waves[1]);
        match fits(wave) {
            Some(fitting) => {
                calm = Some(fitting);
                waves[0] = wave;
            }
            None => waves[1] = wave,
        }
    }
    let calm = calm.unwrap_or(raw);
    let mut count = if closed { 6 } else { 4 };
    while count < MOST_POINTS {
        if let Ok(few) = resample(&calm, &Resampling::count(count))
            && farthest(calm.points(), &few) <= 0.5 * tolerance
        {
            return few.points().iter().map(|p| p.truncate()).collect();
        }
        count += (count / 4).max(1);
    }
    calm.points().iter().map(|p| p.truncate()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a circle, drawn with a hand that trembles by a millimetre.
    fn trembling() -> Vec<DVec2> {
        (0..=120)
            .map(|k| {
                let angle = k as f64 * 0.75_f64.to_radians();
                let radius = 0.5 + if k % 2 == 0 { 0.001 } else { -0.001 };
                radius * DVec2::new(angle.cos(), angle.sin())
            })
            .collect()
    }

    #[test]
    fn trembling_goes_and_the_form_stays() {
        let line = smoothed(&trembling(), false, 0.003);
        assert!((4..30).contains(&line.len()), "{} points", line.len());
        for point in &line {
            assert!((point.length() - 0.5).abs() < 0.003, "{point}");
        }
        assert!(line[0].distance(trembling()[0]) < 1e-9);
    }

    #[test]
    fn a_smaller_tolerance_keeps_more() {
        let counts = [0.02, 0.003, 0.0002].map(|tolerance| smoothed(&trembling(), false, tolerance).len());
        assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
    }

    #[test]
    fn what_can_not_be_smoothed_stays() {
        assert_eq!(smoothed(&[DVec2::ONE], false, 0.01), [DVec2::ONE]);
        assert_eq!(smoothed(&[], true, 0.01), Vec::<DVec2>::new());
    }
}
