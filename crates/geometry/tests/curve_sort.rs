//! Sorting does not depend on how the curves were drawn: on their order, direction or first points, nor on where the
//! model stands.

#![allow(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

use glam::{DQuat, DVec3};
use maquette_geometry::curve::{ArcLength, Curve, SortOptions, Sorted, closest, sort};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// How one curve was drawn: its place among the others, its direction, its first point if closed.
#[derive(Clone, Debug)]
struct Drawn {
    place: u32,
    flipped: bool,
    start: usize,
}

fn drawn() -> impl Strategy<Value = Drawn> {
    (any::<u32>(), any::<bool>(), 0_usize..60).prop_map(|(place, flipped, start)| Drawn { place, flipped, start })
}

/// What the curves are drawn of.
#[derive(Clone, Debug)]
enum Shape {
    /// Two closed curves and rails between them.
    Tube,
    /// One closed curve, and rails to a tip.
    Cone,
    /// Rails to a tip.
    Dome,
    /// Two contours that cross.
    Head,
}

#[derive(Clone, Debug)]
struct Model {
    shape: Shape,
    /// Angles of the rails; gaps between them are 0.25 at least.
    angles: Vec<f64>,
    /// Half axes of the section, height, and how far the upper end is shifted sideways.
    size: [f64; 4],
}

fn model() -> impl Strategy<Value = Model> {
    let shape = prop_oneof![Just(Shape::Tube), Just(Shape::Cone), Just(Shape::Dome), Just(Shape::Head)];
    let gaps = prop::collection::vec(0.25..1.0_f64, 3..8);
    (shape, gaps, 0.0..TAU, [0.2..0.6_f64, 0.2..0.6, 0.8..2.0, -0.3..0.3]).prop_map(|(shape, gaps, first, size)| {
        // The gaps shared out over a whole turn, but for what the last rail leaves to the first.
        let scale = TAU / (gaps.iter().sum::<f64>() + 0.25);
        let mut angle = first;
        let angles = gaps
            .iter()
            .map(|gap| {
                angle += gap * scale.min(1.5);
                angle
            })
            .collect();
        Model { shape, angles, size }
    })
}

impl Model {
    /// A point of the shape, `t` from 0 at the bottom to 1 at the top; counter-clockwise about +Y from +X.
    fn point(&self, angle: f64, t: f64) -> DVec3 {
        let [a, b, height, shift] = self.size;
        let width = match self.shape {
            Shape::Tube => 1.0 - 0.4 * t + 0.2 * (PI * t).sin(),
            _ => (1.0 - t * t).sqrt(),
        };
        DVec3::new(a * width * angle.cos() + shift * t, height * t, -b * width * angle.sin())
    }

    fn curves(&self) -> Vec<Curve> {
        let rail = |(i, angle): (usize, &f64)| {
            let points = (0..=24).map(|k| self.point(*angle, f64::from(k) / 24.0)).collect();
            Curve::new(format!("rail {i}"), points, false).unwrap()
        };
        let ring = |name: &str, t: f64| {
            let points = (0..60).map(|k| self.point(TAU * f64::from(k) / 60.0, t)).collect();
            Curve::new(name, points, true).unwrap()
        };
        let contour = |name: &str, angle: f64| {
            let up = (0..=24).map(|k| self.point(angle, f64::from(k) / 24.0));
            let down = (0..24).rev().map(|k| self.point(angle + PI, f64::from(k) / 24.0));
            Curve::new(name, up.chain(down).collect(), false).unwrap()
        };
        let rails = self.angles.iter().enumerate().map(rail);
        match self.shape {
            Shape::Tube => [ring("bottom", 0.0), ring("top", 1.0)].into_iter().chain(rails).collect(),
            Shape::Cone => [ring("bottom", 0.0)].into_iter().chain(rails).collect(),
            Shape::Dome => rails.collect(),
            Shape::Head => vec![contour("front", self.angles[0]), contour("side", self.angles[0] + 1.4)],
        }
    }
}

/// The same curves as another hand might have drawn them. Closed ones keep their order, which has a meaning.
fn redraw(curves: &[Curve], drawn: &[Drawn]) -> Vec<Curve> {
    let mut ring_places: Vec<u32> =
        curves.iter().zip(drawn).filter(|(curve, _)| curve.is_closed()).map(|(_, drawn)| drawn.place).collect();
    ring_places.sort_unstable();
    let mut ring_places = ring_places.into_iter();
    let mut redrawn: Vec<(u32, Curve)> = curves
        .iter()
        .zip(drawn)
        .map(|(curve, drawn)| {
            let mut points = curve.points().to_vec();
            let mut place = drawn.place;
            if curve.is_closed() {
                points.rotate_left(drawn.start % curve.points().len());
                place = ring_places.next().unwrap();
            }
            let curve = Curve::new(curve.name(), points, curve.is_closed()).unwrap();
            (place, if drawn.flipped { curve.reversed() } else { curve })
        })
        .collect();
    redrawn.sort_by_key(|(place, _)| *place);
    redrawn.into_iter().map(|(_, curve)| curve).collect()
}

fn same_points(a: &Curve, b: &Curve, tolerance: f64) -> bool {
    // The start inserted into a closed curve may lie within rounding of one of its points, and be left out in one of
    // the two: every point of either lies on the other, and starts and directions agree.
    let covered = |a: &Curve, b: &Curve| a.points().iter().all(|p| closest(b, *p).distance <= tolerance);
    let third = |c: &Curve| ArcLength::of(c).point_at_fraction(0.3);
    covered(a, b)
        && covered(b, a)
        && a.start().distance(b.start()) <= tolerance
        && third(a).distance(third(b)) <= tolerance
        && a.name() == b.name()
        && a.is_closed() == b.is_closed()
}

fn same(a: &Sorted, b: &Sorted, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.rails.len(), b.rails.len());
    prop_assert_eq!(a.closed.len(), b.closed.len());
    for (a, b) in a.rails.iter().chain(&a.closed).zip(b.rails.iter().chain(&b.closed)) {
        prop_assert!(same_points(a, b, tolerance), "{:?}\nis not\n{:?}", a, b);
    }
    prop_assert_eq!(a.apex.is_some(), b.apex.is_some());
    if let (Some(a), Some(b)) = (a.apex, b.apex) {
        prop_assert!(a.distance(b) <= tolerance);
    }
    prop_assert_eq!(a.warnings.len(), b.warnings.len());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn order_direction_and_first_points_do_not_matter(model in model(), drawn in prop::collection::vec(drawn(), 10)) {
        let curves = model.curves();
        let reference = sort(&curves, &SortOptions::default()).unwrap();
        let redrawn = sort(&redraw(&curves, &drawn), &SortOptions::default()).unwrap();
        same(&reference, &redrawn, 1e-9)?;
    }

    #[test]
    fn the_model_may_stand_anywhere(
        model in model(),
        turn in 0.0..TAU,
        tilt in (-1.0..1.0_f64, -1.0..1.0_f64, -3.0..3.0_f64),
        shift in [-9.0..9.0_f64, -9.0..9.0, -9.0..9.0],
    ) {
        let curves = model.curves();
        let rotation = DQuat::from_rotation_y(turn) * DQuat::from_euler(glam::EulerRot::XYZ, tilt.0, tilt.1, tilt.2);
        let place = |p: DVec3| rotation * p + DVec3::from(shift);
        let placed: Vec<Curve> = curves.iter().map(|curve| curve.map(place).unwrap()).collect();
        let seam = DVec3::new(1.0, 0.0, 0.2);
        let reference = sort(&curves, &SortOptions { seam, ..SortOptions::default() }).unwrap();
        let sorted = sort(&placed, &SortOptions { seam: rotation * seam, ..SortOptions::default() }).unwrap();
        let back = |curve: &Curve| curve.map(|p| rotation.inverse() * (p - DVec3::from(shift))).unwrap();
        let sorted = Sorted {
            rails: sorted.rails.iter().map(back).collect(),
            closed: sorted.closed.iter().map(back).collect(),
            apex: sorted.apex.map(|p| rotation.inverse() * (p - DVec3::from(shift))),
            ..sorted
        };
        same(&reference, &sorted, 1e-9)?;
    }

    #[test]
    fn rails_run_up_and_counter_clockwise_with_nothing_to_warn_of(model in model()) {
        let sorted = sort(&model.curves(), &SortOptions::default()).unwrap();
        prop_assert_eq!(&sorted.warnings, &Vec::<String>::new());
        prop_assert!(sorted.rails.iter().all(|rail| rail.start().y < 1e-9 && rail.end().y > 0.5));
        if let Some(apex) = sorted.apex {
            prop_assert!(sorted.rails.iter().all(|rail| rail.end() == apex));
        }
        for ring in &sorted.closed {
            prop_assert!(ring.area_vector().y > 0.0);
        }
        let angles: Vec<f64> = sorted.rails.iter().map(|rail| {
            let start = rail.start();
            (-start.z / model.size[1]).atan2(start.x / model.size[0])
        }).collect();
        let turns = angles.iter().map(|angle| (angle - angles[0] + 1e-9).rem_euclid(TAU)).collect::<Vec<_>>();
        prop_assert!(turns.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", angles);
    }

    #[test]
    fn anything_drawn_gives_curves_or_an_error_and_no_panic(
        strokes in prop::collection::vec(
            (prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 2..6), any::<bool>()),
            0..6
        ),
        seam in prop::array::uniform3(-1.0..1.0_f64),
        reverse_run in any::<bool>(),
        flat in any::<bool>(),
    ) {
        let curves: Vec<Curve> = strokes.into_iter().filter_map(|(points, closed)| {
            let squash = |p: [f64; 3]| if flat { DVec3::new(p[0].round(), p[1].round(), 0.0) } else { p.into() };
            Curve::new("", points.into_iter().map(squash).collect(), closed).ok()
        }).collect();
        let options = SortOptions { seam: seam.into(), reverse_run, ..SortOptions::default() };
        if let Ok(sorted) = sort(&curves, &options) {
            prop_assert!(sorted.rails.len() >= 2);
            prop_assert_eq!(sorted.closed.len(), curves.iter().filter(|curve| curve.is_closed()).count());
            for told in &sorted.decisions {
                prop_assert!(!told.to_string().contains("NaN"), "{}", told);
            }
        }
    }
}
