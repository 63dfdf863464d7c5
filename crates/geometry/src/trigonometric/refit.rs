//! A section fitted anew in the place of another: angles and joints stay what they are in the rest of the stack.

use super::composite::Layout;
use super::error::FitError;
use super::fit::{check, finished, prepared};
use super::options::{Angles, Continuity, FitOptions, Harmonics, LocalAngles, Sampling, Split, Start};
use super::order_search::Tolerances;
use super::report::Fitted;
use super::section::EllipticSection;
use super::solve::{Goal, Method, solve};
use crate::curve::Curve;
use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::TAU;

/// Angles at which a section is compared with both kinds of angles.
const PROBES: usize = 256;
/// Share of the size of derivatives below which they agree.
const AGREE: f64 = 1e-6;

/// What is asked of a section that takes the place of another.
#[derive(Clone, Debug, PartialEq)]
pub struct RefitOptions {
    /// How many harmonics.
    pub harmonics: Harmonics,
    /// Errors allowed, as in [`FitOptions::tolerances`].
    pub tolerances: Tolerances,
    /// Besides them, the largest distance allowed, metres.
    pub largest_distance: Option<f64>,
    /// How points of closed curves get their angles; [`Angles::Auto`] is as in the section that is replaced.
    pub angles: Angles,
}

impl Default for RefitOptions {
    /// The defaults of [`FitOptions`].
    fn default() -> Self {
        let FitOptions { harmonics, tolerances, largest_distance, .. } = FitOptions::default();
        Self { harmonics, tolerances, largest_distance, angles: Angles::Auto }
    }
}

impl EllipticSection {
    /// The kind of its angles, told from its points: polar where its angles are nearer to the polar angles about its
    /// frame's origin than to equal shares of its length. Open sections go by arc length.
    pub fn kind_of_angles(&self) -> Angles {
        if !self.is_closed() {
            return Angles::ArcLength;
        }
        let points = self.sampled(PROBES);
        let mut lengths = vec![0.0];
        for k in 0..PROBES {
            lengths.push(lengths[k] + points[k].distance(points[(k + 1) % PROBES]));
        }
        let (from, step) = (self.range().0, TAU / PROBES as f64);
        let wrapped = |angle: f64| angle - TAU * (angle / TAU).round();
        let (mut polar, mut by_length) = (0.0, 0.0);
        for (k, point) in points.iter().enumerate() {
            polar += wrapped(self.frame().angle(*point) - from - step * k as f64).powi(2);
            by_length += (TAU * lengths[k] / lengths[PROBES] - step * k as f64).powi(2);
        }
        if by_length < polar { Angles::ArcLength } else { Angles::Polar }
    }

    /// How its segments meet at a joint, by their derivatives to 1e-6 of their size.
    fn continuity_at(&self, before: usize, behind: usize) -> Continuity {
        let (one, other) = (&self.segments()[before], &self.segments()[behind]);
        let a = one.derivatives::<3>(one.to);
        let b = other.derivatives::<3>(other.from);
        let agrees = |order: usize| a[order].distance(b[order]) <= AGREE * (a[order].length() + b[order].length());
        match (agrees(1), agrees(2)) {
            (true, true) => Continuity::C2,
            (true, false) => Continuity::C1,
            (false, _) => Continuity::C0,
        }
    }

    fn layout(&self) -> Layout {
        let count = self.segments().len();
        if count == 1 && !self.segments()[0].local {
            return Layout::single(self.is_closed());
        }
        let skipped = usize::from(!self.is_closed());
        let joints: Vec<(f64, Continuity)> = (skipped..count)
            .map(|k| (self.segments()[k].from, self.continuity_at((k + count - 1) % count, k)))
            .collect();
        Layout::split(self.is_closed(), &joints)
    }
}

/// Fits a curve in the place of a section: angles count in the same way from the same direction of its frame, segments
/// meet at the same angles with the same continuity and count local angles where its own do. What stands beside it in a
/// stack therefore still corresponds.
///
/// The curve is taken as it lies; a closed one is run about the frame's normal. The fit is that of
/// [`fit_sections`](super::fit_sections), in even samples.
///
/// # Errors
/// [`FitError`] as [`fit_sections`](super::fit_sections); also where one of both is open and the other closed.
pub fn refit(section: &EllipticSection, curve: &Curve, options: &RefitOptions) -> Result<Fitted, FitError> {
    if curve.is_closed() != section.is_closed() {
        return Err(FitError::Mixed { curve: curve.name().to_owned(), closed: curve.is_closed() });
    }
    let layout = section.layout();
    let split = layout.joins.iter().any(Option::is_some);
    let fit_options = FitOptions {
        harmonics: options.harmonics,
        tolerances: options.tolerances,
        largest_distance: options.largest_distance,
        angles: match options.angles {
            Angles::Auto => section.kind_of_angles(),
            asked => asked,
        },
        start: Start::Ray,
        sampling: Sampling::Even,
        // Only tells how many samples are taken: the joints are those of the layout.
        split: if split { Split::At(Vec::new()) } else { Split::None },
        about: Some(DVec3::Z),
        ..FitOptions::default()
    };
    check(&fit_options)?;
    // In the coordinates of the section's frame, whose e1 is the x-axis, angles count from e1.
    let frame = section.frame();
    let out = DAffine3::from_mat3_translation(DMat3::from_cols(frame.e1, frame.e2, frame.normal), frame.origin);
    let into = out.inverse();
    let too_far = || FitError::Size { curve: curve.name().to_owned(), size: f64::INFINITY };
    let laid = curve.map(|p| into.transform_point3(p)).map_err(|_| too_far())?;
    let (angles, stack) = prepared(std::slice::from_ref(&laid), &fit_options, &|_| true)?;
    let Some(prepared) = stack.first() else { return Err(FitError::NoCurves) };
    let local: Vec<bool> = section.segments().iter().map(|segment| segment.local).collect();
    let method = Method { solution: fit_options.solution, local_angles: LocalAngles::Auto };
    let goal = match options.harmonics {
        Harmonics::Smallest { most } => Goal::Smallest { most },
        Harmonics::Fixed(harmonics) => Goal::Given(vec![harmonics; layout.count()]),
    };
    let outcome = solve(prepared, &layout, &goal, method, Some(&local))?;
    let mut fitted = finished(prepared, outcome, section.is_closed(), angles, &fit_options, &|| Ok(()))?;
    let not_finite = |source| FitError::NotFinite { curve: curve.name().to_owned(), source };
    fitted.section = fitted.section.transformed(&out).map_err(not_finite)?;
    fitted.report.worst.point = out.transform_point3(fitted.report.worst.point);
    Ok(fitted)
}

#[cfg(test)]
mod tests {
    use super::super::{Joint, fit, fit_sections};
    use super::*;
    use glam::DQuat;
    use std::f64::consts::PI;

    fn blob(turn: DQuat, lobe: f64, star: bool) -> Curve {
        let at = |k: i32| {
            let t = TAU * f64::from(k) / 200.0;
            // A bean, which is not star-shaped about its centre, or an egg.
            let bend = if star { 0.0 } else { 1.6 };
            turn * DVec3::new(2.0 * t.cos() + lobe * (2.0 * t).cos(), t.sin() - bend * t.cos().powi(2), 0.0)
                + DVec3::new(3.0, 1.0, -2.0)
        };
        Curve::new("blob", (0..200).map(at).collect(), true).unwrap()
    }

    #[test]
    fn the_same_curve_gives_the_same_section() {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.3).normalize(), 1.1);
        for star in [true, false] {
            let curve = blob(turn, 0.2, star);
            let joints = [0.4, 2.0, 4.4].map(|angle| Joint { angle, continuity: Continuity::C1 }).to_vec();
            for split in [Split::None, Split::At(joints)] {
                let options = FitOptions { split, harmonics: Harmonics::Fixed(5), ..FitOptions::default() };
                let old = fit(&curve, &options).unwrap();
                assert_eq!(old.section.kind_of_angles(), if star { Angles::Polar } else { Angles::ArcLength });
                let refit_options = RefitOptions { harmonics: Harmonics::Fixed(5), ..RefitOptions::default() };
                let new = refit(&old.section, &curve, &refit_options).unwrap();
                assert_eq!(new.section.joints(), old.section.joints());
                let local = |fitted: &Fitted| fitted.section.segments().iter().map(|s| s.local).collect::<Vec<_>>();
                assert_eq!(local(&new), local(&old));
                let (from, to) = old.section.range();
                for k in 0..100 {
                    let v = from + (to - from) * f64::from(k) / 100.0;
                    let apart = new.section.point(v).distance(old.section.point(v));
                    // The length of an angle's arc is taken from samples that begin elsewhere.
                    assert!(apart < 2e-3, "{star} {k}: {apart}");
                }
                assert!((new.report.worst.distance - old.report.worst.distance).abs() < 2e-3);
                assert!(new.report.worst.point.distance(DVec3::new(3.0, 1.0, -2.0)) < 4.0);
            }
        }
    }

    #[test]
    fn another_curve_takes_the_angles_of_the_stack() {
        // A stack that turns, so that angles are not counted from the x-axis in the last section.
        let ring = |k: i32| {
            let turn = DQuat::from_rotation_z(0.3 * f64::from(k)) * DQuat::from_rotation_x(-PI / 2.0);
            blob(turn, 0.1, true).map(|p| p + DVec3::Y * (2.0 * f64::from(k))).unwrap()
        };
        let curves: Vec<Curve> = (0..5).map(ring).collect();
        let stack = fit_sections(&curves, &FitOptions::default()).unwrap();
        let old = &stack.sections[4].section;
        let wider = curves[4].map(|p| old.frame().origin + (p - old.frame().origin) * 1.1).unwrap();
        let new = refit(old, &wider.clone().reversed(), &RefitOptions::default()).unwrap();
        assert!(new.report.reversed && new.report.met);
        for k in 0..60 {
            let v = f64::from(k) * 0.1;
            let (before, after) = (old.point(v) - old.frame().origin, new.section.point(v) - old.frame().origin);
            assert!(before.angle_between(after) < 0.05, "{k}");
        }
        let open = Curve::new("open", wider.points().to_vec(), false).unwrap();
        assert!(matches!(refit(old, &open, &RefitOptions::default()), Err(FitError::Mixed { closed: false, .. })));
    }

    #[test]
    fn joints_keep_their_continuity() {
        let curve = blob(DQuat::IDENTITY, 0.3, true);
        let kinds = [Continuity::C0, Continuity::C1, Continuity::C2];
        let joints = [0.5, 2.5, 4.5].into_iter().zip(kinds);
        let joints = joints.map(|(angle, continuity)| Joint { angle, continuity }).collect();
        let options = FitOptions { split: Split::At(joints), harmonics: Harmonics::Fixed(4), ..FitOptions::default() };
        let section = fit(&curve, &options).unwrap().section;
        let found = section.layout().joins;
        assert_eq!(found, kinds.map(Some));
    }
}
