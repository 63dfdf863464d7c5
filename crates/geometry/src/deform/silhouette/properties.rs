//! What holds for silhouettes of any shape: symmetry, affine maps, directions, starts.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::*;
use crate::curve::Curve;

/// Two sides of a shape about 0.6 m wide and 1 m high: its widths at nine heights, and a lean.
#[derive(Clone, Debug)]
struct Shape {
    widths: [Vec<f64>; 2],
    lean: f64,
}

fn shape() -> impl Strategy<Value = Shape> {
    let side = || prop::collection::vec(0.15..0.45_f64, 9);
    (side(), side(), -0.2..0.2_f64).prop_map(|(left, right, lean)| Shape { widths: [left, right], lean })
}

impl Shape {
    /// Its strokes in a view, with corners at the nine heights.
    fn strokes(&self, view: View) -> [Curve; 2] {
        [0, 1].map(|side| {
            let sign = if side == 0 { -1.0 } else { 1.0 };
            let points = self.widths[side].iter().enumerate().map(|(k, width)| {
                let y = k as f64 / 8.0;
                view.place(glam::DVec2::new(sign * width + self.lean * y, y), 0.3)
            });
            Curve::new(["left", "right"][side], points.collect(), false).unwrap()
        })
    }

    /// Both strokes in one around the shape, closed, from any of its points, run either way. Its ends are tips: where
    /// several points reach equally far, the first of them is the end.
    fn around(&self, view: View, start: usize, turned: bool) -> Curve {
        let [left, right] = self.strokes(view);
        let tip = |y: f64| [view.place(glam::DVec2::new(0.02 + self.lean * y, y), 0.3)];
        let mut points = [left.points(), &tip(1.05), right.reversed().points(), &tip(-0.05)].concat();
        let count = points.len();
        points.rotate_left(start % count);
        let around = Curve::new("around", points, true).unwrap();
        if turned { around.reversed() } else { around }
    }
}

/// A tube about +Y that narrows, of so many points, the first of them anywhere.
fn tube(nodes: usize, start: usize) -> Sections {
    let ring = |k: usize| {
        let y = k as f64 / 16.0;
        let at = |j: usize| DQuat::from_rotation_y(-TAU * (j + start) as f64 / nodes as f64) * DVec3::X;
        (0..nodes).map(|j| at(j) * (0.35 - 0.1 * y) + DVec3::Y * y).collect()
    };
    Sections::new((0..17).map(ring).collect(), true, vec![]).unwrap()
}

fn go(sections: &Sections, silhouettes: &[(View, &[Curve])], matching: StrokeMatching, contact: Contact) -> Sections {
    let silhouettes: Vec<Silhouette<'_>> =
        silhouettes.iter().map(|(view, strokes)| Silhouette { view: *view, strokes }).collect();
    let options = SilhouetteOptions { matching, contact, ..SilhouetteOptions::default() };
    deform_to_silhouette(sections, &silhouettes, &options, &|_| true).unwrap().sections
}

fn apart(one: impl Iterator<Item = DVec3>, other: impl Iterator<Item = DVec3>) -> f64 {
    one.zip(other).map(|(p, q)| p.distance(q)).fold(0.0, f64::max)
}

fn matching() -> impl Strategy<Value = StrokeMatching> {
    prop_oneof![Just(StrokeMatching::ArcLength), Just(StrokeMatching::Height)]
}

fn contact() -> impl Strategy<Value = Contact> {
    prop_oneof![Just(Contact::Tangent), Just(Contact::Point)]
}

/// What it changes, metres, how strokes are drawn: two run the other way and in the other order, one around from another
/// point.
fn by_drawing(front: &Shape, matching: StrokeMatching, contact: Contact, turned: [bool; 3], begin: usize) -> [f64; 2] {
    let start = tube(32, 0);
    let [left, right] = front.strokes(View::FRONT);
    let made = |strokes: &[Curve]| go(&start, &[(View::FRONT, strokes)], matching, contact);
    let wanted = made(&[left.clone(), right.clone()]);
    let run = |c: Curve, turned: bool| if turned { c.reversed() } else { c };
    let mut strokes = [run(left, turned[0]), run(right, turned[1])];
    if turned[2] {
        strokes.swap(0, 1);
    }
    let found = made(&strokes);
    // One stroke around is parted at its ends wherever it begins.
    let once = made(&[front.around(View::FRONT, 0, false)]);
    let again = made(&[front.around(View::FRONT, begin, turned[0])]);
    [(found, wanted), (again, once)]
        .map(|(found, wanted)| apart(found.points().iter().copied(), wanted.points().iter().copied()))
}

#[test]
fn a_straight_shape_drawn_the_other_way_is_the_same() {
    // Nothing leans or bulges, so that many points reach equally far.
    let straight = Shape { widths: [vec![0.15; 9], vec![0.15; 9]], lean: 0.0 };
    for begin in 0..20 {
        let off = by_drawing(&straight, StrokeMatching::ArcLength, Contact::Tangent, [true, false, false], begin);
        assert!(off.into_iter().all(|off| off < 1e-12), "{begin}: {off:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn a_mirrored_sketch_gives_the_mirrored_shape(
        front in shape(), side in shape(), matching in matching(), contact in contact(),
    ) {
        let start = tube(32, 0);
        let mirror = |p: DVec3| p * DVec3::new(-1.0, 1.0, 1.0);
        let (drawn, depth) = (front.strokes(View::FRONT), side.strokes(View::SIDE));
        let mirrored = drawn.each_ref().map(|c| c.map(mirror).unwrap());
        let made = go(&start, &[(View::FRONT, &drawn), (View::SIDE, &depth)], matching, contact);
        let other = go(&start, &[(View::FRONT, &mirrored), (View::SIDE, &depth)], matching, contact);
        for (section, other) in made.iter().zip(other.iter()) {
            let off = apart((0..32).map(|j| section[j]), (0..32).map(|j| mirror(other[(48 - j) % 32])));
            prop_assert!(off < 1e-12, "{off}");
        }
    }

    /// Lengths in the three directions may be scaled each by itself: heights match as before, and every component of the
    /// displacement is linear in what it is given.
    #[test]
    fn affine_maps_commute_with_it(
        front in shape(), side in shape(), contact in contact(),
        scale in (0.2..5.0_f64, 0.2..5.0_f64, 0.2..5.0_f64), shift in (-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64),
    ) {
        let map = |p: DVec3| p * DVec3::from(scale) + DVec3::from(shift);
        let start = tube(32, 0);
        let rows = start.iter().map(|row| row.iter().map(|p| map(*p)).collect()).collect();
        let there = Sections::new(rows, true, vec![]).unwrap();
        let drawn = [front.strokes(View::FRONT), side.strokes(View::SIDE)];
        let mapped = drawn.each_ref().map(|pair| pair.each_ref().map(|c| c.map(map).unwrap()));
        let both = |pairs: &[[Curve; 2]; 2], from: &Sections| {
            let silhouettes: [(View, &[Curve]); 2] = [(View::FRONT, &pairs[0]), (View::SIDE, &pairs[1])];
            go(from, &silhouettes, StrokeMatching::Height, contact)
        };
        let (made, found) = (both(&drawn, &start), both(&mapped, &there));
        let off = apart(found.points().iter().copied(), made.points().iter().map(|p| map(*p)));
        prop_assert!(off < 1e-11, "{off}");
    }

    #[test]
    fn how_strokes_were_drawn_does_not_matter(
        front in shape(), matching in matching(), contact in contact(), turned in any::<[bool; 3]>(),
        begin in 0..20_usize,
    ) {
        let off = by_drawing(&front, matching, contact, turned, begin);
        prop_assert!(off.into_iter().all(|off| off < 1e-12), "{off:?}");
    }

    #[test]
    fn where_sections_begin_does_not_matter(front in shape(), side in shape(), contact in contact(), begin in 0..32_usize) {
        let (drawn, depth) = (front.strokes(View::FRONT), side.strokes(View::SIDE));
        let silhouettes: [(View, &[Curve]); 2] = [(View::FRONT, &drawn), (View::SIDE, &depth)];
        let wanted = go(&tube(32, 0), &silhouettes, StrokeMatching::Height, contact);
        let found = go(&tube(32, begin), &silhouettes, StrokeMatching::Height, contact);
        for (section, wanted) in found.iter().zip(wanted.iter()) {
            let off = apart((0..32).map(|j| section[j]), (0..32).map(|j| wanted[(j + begin) % 32]));
            prop_assert!(off < 1e-12, "{off}");
        }
    }
}
