use super::*;

/// A mask whose edges are softened over a pixel: 16 by 16 tests a pixel. The function is asked in pixels, y up.
pub(crate) fn drawn(width: usize, height: usize, inside: impl Fn(f64, f64) -> bool) -> Mask {
    let value = |x: usize, y: usize| {
        let test = |k: usize| {
            let (dx, dy) = ((k % 16) as f64 / 16.0 + 1.0 / 32.0, (k / 16) as f64 / 16.0 + 1.0 / 32.0);
            inside(x as f64 + dx, (height - 1 - y) as f64 + dy)
        };
        let covered = (0..256).filter(|k| test(*k)).count();
        u8::try_from((covered * 255 + 128) / 256).unwrap()
    };
    let values = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| value(x, y)).collect();
    Mask::new(width, height, values).unwrap()
}

fn round(centre: [f64; 2], radius: f64) -> impl Fn(f64, f64) -> bool {
    move |x, y| (x - centre[0]).hypot(y - centre[1]) < radius
}

#[test]
fn a_softened_disc_is_found_within_a_tenth_of_a_pixel() {
    let mask = drawn(80, 60, round([41.3, 28.6], 20.0));
    let found = trace(&mask, &Tracing::default()).unwrap();
    assert_eq!(found.len(), 1);
    let outline = &found[0];
    let radii: Vec<f64> = outline.curve.points().iter().map(|p| (p.x - 41.3).hypot(p.y - 28.6)).collect();
    let (low, high) = radii.iter().fold((f64::MAX, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
    assert!(low > 19.9 && high < 20.1, "{low} {high}");
    assert!((outline.area - std::f64::consts::PI * 400.0).abs() < 4.0, "{}", outline.area);
    assert!(outline.curve.is_closed() && outline.hole_in.is_none() && !outline.cut_off);
    assert!(outline.curve.area_vector().z > 0.0, "counter-clockwise");
    let top = outline.curve.points()[0];
    assert!(outline.curve.points().iter().all(|p| p.y <= top.y), "from the top: {top}");
}

#[test]
fn holes_are_told_from_outlines_and_islands_in_holes_are_outlines() {
    let inside = |x: f64, y: f64| {
        (round([40.0, 40.0], 30.0)(x, y) && !round([30.0, 40.0], 10.0)(x, y) && !round([55.0, 40.0], 6.0)(x, y))
            || round([30.0, 40.0], 4.0)(x, y)
            || round([80.0, 12.0], 8.0)(x, y)
    };
    let mask = drawn(100, 80, inside);
    let all = trace(&mask, &Tracing { keep: Keep::All, ..Tracing::default() }).unwrap();
    let named: Vec<(&str, Option<usize>)> = all.iter().map(|o| (o.curve.name(), o.hole_in)).collect();
    let wanted = [
        ("outline 0", None),
        ("outline 0 hole 0", Some(0)),
        ("outline 0 hole 1", Some(0)),
        ("outline 1", None),
        ("outline 2", None),
    ];
    assert_eq!(named, wanted);
    for (outline, radius) in all.iter().zip([30.0_f64, 10.0, 6.0, 8.0, 4.0]) {
        assert!((outline.area.sqrt() - radius * std::f64::consts::PI.sqrt()).abs() < 0.1, "{radius} {}", outline.area);
        assert_eq!(outline.curve.area_vector().z > 0.0, outline.hole_in.is_none());
    }
    let names = |tracing: Tracing| {
        let found = trace(&mask, &tracing).unwrap();
        found.iter().map(|o| o.curve.name().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(Tracing { holes: false, ..Tracing::default() }), ["outline 0"]);
    assert_eq!(names(Tracing { least_area: 200.0, ..Tracing::default() }), ["outline 0", "outline 0 hole 0"]);
    let large = Tracing { keep: Keep::All, least_area: 60.0, ..Tracing::default() };
    assert_eq!(names(large), ["outline 0", "outline 0 hole 0", "outline 0 hole 1", "outline 1"]);
}

#[test]
fn a_shape_that_touches_the_edge_is_closed_along_it() {
    let mask = drawn(30, 20, |x, _| x > 12.0);
    let found = trace(&mask, &Tracing::default()).unwrap();
    assert!(found[0].cut_off);
    let (low, high) = found[0].curve.bounds();
    assert!((low - DVec3::new(12.0, 0.0, 0.0)).length() < 0.1, "{low}");
    assert!((high - DVec3::new(30.0, 20.0, 0.0)).length() < 0.1, "{high}");
}

#[test]
fn the_threshold_moves_the_outline_within_a_blurred_edge() {
    let values = (0..20_u8).flat_map(|_| (0..20_u8).map(|x| x * 12)).collect();
    let mask = Mask::new(20, 20, values).unwrap();
    for threshold in [0.2, 0.5, 0.7, 120.0 / 255.0] {
        let found = trace(&mask, &Tracing { threshold, ..Tracing::default() }).unwrap();
        // Values rise by 12 a pixel, from 0 at the centre of the first column.
        let wanted = threshold * 255.0 / 12.0 + 0.5;
        let middle: Vec<f64> =
            found[0].curve.points().iter().filter(|p| p.x < 19.0 && (p.y - 10.0).abs() < 5.0).map(|p| p.x).collect();
        assert!(!middle.is_empty() && middle.iter().all(|x| (x - wanted).abs() < 1e-3), "{threshold} {middle:?}");
    }
}

#[test]
fn pictures_without_an_outline_are_refused_with_a_remedy() {
    let said = |mask: &Mask, tracing: Tracing| trace(mask, &tracing).unwrap_err().to_string();
    let white = Mask::new(8, 8, vec![0; 64]).unwrap();
    let full = Mask::new(8, 8, vec![200; 64]).unwrap();
    let speck = drawn(9, 9, round([4.0, 4.0], 1.5));
    for (message, wanted) in [
        (said(&white, Tracing::default()), "no pixel is inside, the values run from 0.00 to 0.00"),
        (said(&full, Tracing::default()), "every pixel is inside"),
        (said(&full, Tracing { threshold: 0.9, ..Tracing::default() }), "choose a threshold between them"),
        (said(&speck, Tracing::default()), "lower the least area"),
        (said(&speck, Tracing { threshold: 1.0, ..Tracing::default() }), "not between 0 and 1"),
        (said(&speck, Tracing { least_area: f64::NAN, ..Tracing::default() }), "the least area NaN"),
    ] {
        assert!(message.contains(wanted), "{message}");
    }
    let checks = (0..1000 * 1000).map(|k| if (k + k / 1000) % 2 == 0 { 255 } else { 0 }).collect();
    let checks = Mask::new(1000, 1000, checks).unwrap();
    let error = trace(&checks, &Tracing::default()).unwrap_err();
    assert!(matches!(error, OutlineError::TooRough { points, .. } if points > 1_900_000), "{error}");
    let disc = drawn(40, 40, round([20.0, 20.0], 12.0));
    assert_eq!(trace_while(&disc, &Tracing::default(), &|_| false), Err(OutlineError::Stopped));
}
