use super::super::trace::tests::drawn;
use super::super::{Keep, Mask, Tracing, trace};
use super::*;

const CALMING: Calming = Calming { wave: 6.0, corner_angle: 0.8, tolerance: 0.5 };

fn hard(mask: &Mask) -> Mask {
    let values = mask.values().iter().map(|value| if *value >= 128 { 255 } else { 0 }).collect();
    Mask::new(mask.width(), mask.height(), values).unwrap()
}

fn outline(mask: &Mask) -> Curve {
    trace(mask, &Tracing::default()).unwrap().remove(0).curve
}

#[test]
fn a_turned_square_becomes_its_four_corners() {
    // Its edges run at 1 in 5, which are steps of pixels in a hard mask.
    let (along, across) = (DVec3::new(5.0, 1.0, 0.0).normalize(), DVec3::new(-1.0, 5.0, 0.0).normalize());
    let centre = DVec3::new(50.0, 50.0, 0.0);
    let soft = drawn(100, 100, |x, y| {
        let off = DVec3::new(x, y, 0.0) - centre;
        off.dot(along).abs() < 30.0 && off.dot(across).abs() < 20.0
    });
    for (mask, exact) in [(&soft, 0.25), (&hard(&soft), 0.8)] {
        let calm = calmed(&outline(mask), &CALMING).unwrap();
        assert_eq!(calm.points().len(), 4, "{:?}", calm.points());
        for point in calm.points() {
            let off = *point - centre;
            let off = DVec3::new(off.dot(along).abs() - 30.0, off.dot(across).abs() - 20.0, 0.0);
            assert!(off.length() < exact, "{off}");
        }
    }
}

#[test]
fn the_steps_of_a_hard_disc_go_and_its_size_stays() {
    let mask = hard(&drawn(120, 120, |x, y| (x - 60.2).hypot(y - 59.7) < 45.0));
    let off = |curve: &Curve| {
        curve.points().iter().map(|p| ((p.x - 60.2).hypot(p.y - 59.7) - 45.0).abs()).fold(0.0, f64::max)
    };
    let rough = outline(&mask);
    let calm = calmed(&rough, &Calming { wave: 16.0, tolerance: 0.0, ..CALMING }).unwrap();
    assert!(off(&rough) > 0.3 && off(&calm) < 0.3, "{} {}", off(&rough), off(&calm));
    assert_eq!(calm.points().len(), rough.points().len());
    let few = calmed(&rough, &CALMING).unwrap();
    assert!(few.points().len() < rough.points().len() / 8 && off(&few) < 0.8, "{} {}", few.points().len(), off(&few));
}

#[test]
fn the_first_point_stays_first_and_specks_keep_their_size() {
    let mask =
        drawn(80, 60, |x, y| (x - 30.0).abs() < 20.0 && (y - 30.0).abs() < 20.0 || (x - 70.0).hypot(y - 30.0) < 3.0);
    let found = trace(&mask, &Tracing { keep: Keep::All, ..Tracing::default() }).unwrap();
    let calm = calmed(&found[0].curve, &Calming { tolerance: 0.0, ..CALMING }).unwrap();
    assert!(calm.start().distance(found[0].curve.start()) < 1.0, "{} {}", calm.start(), found[0].curve.start());
    let speck = calmed(&found[1].curve, &Calming { wave: 500.0, tolerance: 0.0, corner_angle: 3.0 }).unwrap();
    let area = speck.area_vector().length();
    assert!((area - found[1].area).abs() < 0.05 * area, "{area} {}", found[1].area);
    let open = Curve::new("open", vec![DVec3::ZERO, DVec3::X], false).unwrap();
    assert!(matches!(calmed(&open, &CALMING), Err(OutlineError::Open { .. })));
    let wrong = calmed(&calm, &Calming { tolerance: -1.0, ..CALMING });
    assert!(matches!(wrong, Err(OutlineError::Amount { what: "tolerance", .. })));
}
