//! Silhouettes of two views.

use glam::DVec3;

use super::apex::Apex;
use super::centring::centred;
use super::local_detail::take_off;
use super::order::check_order;
use super::view_plane::view_normal;
use super::{GenerateError, GenerateOptions, Generated, ViewPlacement, check_size, report};
use crate::beam::ClosedBeam;
use crate::curve::{ArcLength, Curve};
use crate::sections::Sections;

/// A limb or a head from the outlines of two views (thesis 6.1, Figures 6.1-6.3).
///
/// `rails[0]` and `rails[2]` are the pair of one view (+x and -x of the front, say), `rails[1]` and `rails[3]` that of the
/// other; in this order they stand counter-clockwise about the direction in which all of them run. Each section passes
/// through the points of the four rails at one share of their arc lengths, and is the closed beam curve pinned there at
/// a quarter of its nodes each. `options.nodes` is rounded up to a multiple of 4, 8 at least.
///
/// Where all rails start or end within the snap of each other, and within 5 % of the shortest rail's length, they meet in
/// one apex, the mean of these ends: the section there is a pole, exactly, and sections stand closer together towards
/// it, half as far apart as in the mean. Ends farther apart that are still within the snap stay apart, with a warning.
///
/// [`ViewPlacement::Centred`] shifts each pair along its own viewing direction so that the middles of both pairs agree,
/// seen along both directions, but for detail finer than about a third of the rails' length; each silhouette stays as
/// drawn in its own view. A pair that is not flat to within 1 % of its size, and two views less than 25 degrees apart,
/// stay as drawn, with a warning.
///
/// # Errors
/// [`GenerateError`] for fewer than 2 sections, a closed rail, rails in another order or direction, and where
/// `progress` asked to stop.
pub fn two_views(
    rails: &[Curve; 4],
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    options.check(2)?;
    check_size(rails)?;
    if let Some((rail, curve)) = rails.iter().enumerate().find(|(_, curve)| curve.is_closed()) {
        return Err(GenerateError::RailIsClosed { rail, name: curve.name().to_owned() });
    }
    let nodes = options.nodes.max(5).next_multiple_of(4);
    let quarter = nodes / 4;
    let columns = [0, quarter, 2 * quarter, 3 * quarter];
    let beam = ClosedBeam::new(nodes, &columns, options.stiffness)?;

    let mut warnings = Vec::new();
    let arcs = rails.each_ref().map(ArcLength::of);
    let ordered = check_order(rails, &arcs)?;
    let lengths = arcs.each_ref().map(ArcLength::length);
    let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
    let base = Apex::find(rails.each_ref().map(Curve::start), "start", options.snap, shortest, &mut warnings);
    let tip = Apex::find(rails.each_ref().map(Curve::end), "end", options.snap, shortest, &mut warnings);
    let normals = match options.placement {
        ViewPlacement::Centred => view_normals(rails, &mut warnings),
        ViewPlacement::AsDrawn => [None, None],
    };
    // Pairs that cannot be shifted have their own warnings.
    if !ordered && (options.placement == ViewPlacement::AsDrawn || normals != [None, None]) {
        warnings.push(
            "No order can be seen around the rails, and the sections may turn inside out: draw two outlines in each of \
             two views, and pass them through `sort`."
                .into(),
        );
    }
    let stations = stations(options.sections, base.is_some(), tip.is_some());
    let apex_at = |t: f64| [(&base, 0.0), (&tip, 1.0)].into_iter().find_map(|(a, at)| a.as_ref().filter(|_| t == at));
    let mut pins: Vec<[DVec3; 4]> = stations
        .iter()
        .map(|t| {
            let mut pins = arcs.each_ref().map(|arc| arc.point_at_fraction(*t));
            for (apex, nearness) in [(&base, 1.0 - t), (&tip, *t)] {
                if let Some(apex) = apex {
                    // Full at the apex and fading quadratically, so that a small gap is no kink.
                    let pull = nearness * nearness;
                    for (pin, gap) in pins.iter_mut().zip(apex.gaps) {
                        *pin += gap * pull;
                    }
                }
            }
            apex_at(*t).map_or(pins, |apex| [apex.point; 4])
        })
        .collect();
    let held = [base.is_some(), tip.is_some()];
    centred(&mut pins, normals, &stations, held)?;
    let detail = match options.detail {
        Some(detail) if detail.wave > 0.0 && detail.reach < 1.0 => {
            Some(take_off(&mut pins, detail, lengths, &stations, held, quarter, options.stiffness)?)
        }
        _ => None,
    };
    let mut rows = Vec::with_capacity(options.sections);
    for (done, (t, pins)) in stations.iter().zip(pins).enumerate() {
        report(progress, done, options.sections)?;
        // Four equal pins give that point, but for round-off; a pole is exact.
        rows.push(match apex_at(*t) {
            Some(apex) => vec![apex.point; nodes],
            None => {
                let mut section = beam.solve(&pins)?;
                if let Some(detail) = &detail {
                    detail.put_back(done, quarter, &mut section);
                }
                section
            }
        });
    }
    report(progress, 1, 1)?;
    let gap = |apex: &Option<Apex>, rail: usize| apex.as_ref().map_or(0.0, |apex| apex.gaps[rail].length());
    let gaps: Vec<[f64; 2]> = (0..4).map(|rail| [gap(&base, rail), gap(&tip, rail)]).collect();
    let largest_gap = gaps.iter().flatten().copied().fold(0.0, f64::max);
    let sections = Sections::new(rows, true, columns.to_vec())?;
    Ok(Generated { sections, notes: Vec::new(), warnings, largest_gap, gaps })
}

/// Shares of the arc length at which sections stand, from 0 to 1: evenly, but twice as dense at an apex as evenly.
fn stations(count: usize, base: bool, tip: bool) -> Vec<f64> {
    use std::f64::consts::PI;
    let last = count - 1;
    (0..count)
        .map(|k| {
            let x = k as f64 / last as f64;
            match (base, tip) {
                _ if k == 0 || k == last => x,
                (false, false) => x,
                (false, true) => x + 0.5 * (PI * x).sin() / PI,
                (true, false) => x - 0.5 * (PI * x).sin() / PI,
                (true, true) => x - 0.5 * (2.0 * PI * x).sin() / (2.0 * PI),
            }
        })
        .collect()
}

/// Normals of the views whose silhouettes may be shifted.
fn view_normals(rails: &[Curve; 4], warnings: &mut Vec<String>) -> [Option<DVec3>; 2] {
    let mut normals = [None, None];
    for (pair, normal) in normals.iter_mut().enumerate() {
        let (one, other) = (&rails[pair], &rails[pair + 2]);
        *normal = view_normal(one, other);
        if normal.is_none() {
            warnings.push(format!(
                "Rails {pair} (\"{}\") and {} (\"{}\") do not lie in one plane: they stay where they were drawn. Draw both in \
                 one view, or pass all four through `sort`.",
                one.name(),
                pair + 2,
                other.name()
            ));
        }
    }
    if let [Some(a), Some(b)] = normals
        && a.dot(b).abs() > 0.9
    {
        warnings.push("Both pairs of rails were drawn in nearly the same view: they stay where they were drawn. Draw one pair in another \
             view."
                .into());
        return [None, None];
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::LocalDetail;
    use std::f64::consts::FRAC_PI_2;

    fn rail(name: &str, count: usize, at: impl Fn(f64) -> DVec3) -> Curve {
        Curve::new(name, (0..=count).map(|i| at(i as f64 / count as f64)).collect(), false).unwrap()
    }

    fn run(rails: &[Curve; 4], options: &GenerateOptions) -> Generated {
        two_views(rails, options, &|_| true).unwrap()
    }

    /// A slanting leg of elliptical sections, its front outline drawn at z = 0.025 and its side outline at x = 0.1445.
    fn leg() -> [Curve; 4] {
        let (cx, cz) = (|t: f64| 0.25 - 0.2 * t, |t: f64| -0.06 + 0.1 * t);
        let (a, b) = (|t: f64| 0.04 + 0.05 * t, |t: f64| 0.05 + 0.03 * t);
        [
            rail("left", 20, |t| DVec3::new(cx(t) + a(t), t, 0.025)),
            rail("back", 20, |t| DVec3::new(0.1445, t, cz(t) - b(t))),
            rail("right", 20, |t| DVec3::new(cx(t) - a(t), t, 0.025)),
            rail("front", 20, |t| DVec3::new(0.1445, t, cz(t) + b(t))),
        ]
    }

    #[test]
    fn a_slanting_leg_stands_where_its_silhouettes_cross() {
        let made = run(&leg(), &GenerateOptions::default());
        assert_eq!((made.sections.len(), made.sections.nodes()), (24, 64));
        assert_eq!((made.sections.rails(), made.warnings.len(), made.largest_gap), (&[0, 16, 32, 48][..], 0, 0.0));
        for (k, section) in made.sections.iter().enumerate() {
            let t = k as f64 / 23.0;
            let centre = DVec3::new(0.25 - 0.2 * t, t, -0.06 + 0.1 * t);
            let (a, b) = (0.04 + 0.05 * t, 0.05 + 0.03 * t);
            let pins = [DVec3::X * a, DVec3::Z * -b, DVec3::X * -a, DVec3::Z * b].map(|p| centre + p);
            for (pin, column) in pins.iter().zip(made.sections.rails()) {
                assert!(section[*column].distance(*pin) < 1e-12, "section {k}");
            }
            for point in section {
                let p = *point - centre;
                let radius = (p.x / a).hypot(p.z / b);
                assert!((0.965..1.0 + 1e-12).contains(&radius) && p.y.abs() < 1e-12, "section {k}: {radius}");
            }
        }
    }

    #[test]
    fn fine_detail_stays_near_its_rail_and_the_silhouette_exact() {
        let lips = |t: f64| if (0.4..0.6).contains(&t) { 0.01 * (62.8 * t).sin() } else { 0.0 };
        let mut rails = leg();
        rails[3] = rail("front", 400, |t| DVec3::new(0.1445, t, 0.1 * t + 0.03 * t + lips(t)));
        let options = GenerateOptions { sections: 96, ..GenerateOptions::default() };
        let local = GenerateOptions { detail: Some(LocalDetail { wave: 0.3, reach: 0.4 }), ..options };
        let (everywhere, near) = (run(&rails, &options).sections, run(&rails, &local).sections);
        // Ripple of a column: how much neighbouring sections differ in bend.
        let ripple = |sections: &Sections, node: usize| -> f64 {
            let z: Vec<f64> = sections.iter().map(|s| s[node].z).collect();
            z.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f64::max)
        };
        for (section, other) in everywhere.iter().zip(near.iter()) {
            for rail in [0, 16, 32, 48] {
                assert!(section[rail].distance(other[rail]) < 1e-12);
            }
        }
        assert!(ripple(&near, 48) > 1e-3, "the detail is there");
        assert!(ripple(&everywhere, 40) > 3e-4, "as printed it reaches half way around");
        assert!(
            ripple(&near, 40) < ripple(&everywhere, 40) / 10.0,
            "{} {}",
            ripple(&near, 40),
            ripple(&everywhere, 40)
        );
    }

    #[test]
    fn silhouettes_stay_exact_in_their_own_view() {
        let bulge = |t: f64| 0.02 * (7.0 * t).sin();
        let mut rails = leg();
        rails[0] = rail("left", 50, |t| DVec3::new(0.29 - 0.15 * t + bulge(t), t, 0.025));
        rails[3] = rail("front", 50, |t| DVec3::new(0.1445, 1.1 * t, 0.13 * t + bulge(1.0 - t)));
        let (made, drawn) = (run(&rails, &GenerateOptions::default()), rails.each_ref().map(ArcLength::of));
        let as_drawn =
            run(&rails, &GenerateOptions { placement: ViewPlacement::AsDrawn, ..GenerateOptions::default() });
        for (k, (section, flat)) in made.sections.iter().zip(as_drawn.sections.iter()).enumerate() {
            for (pair, column) in made.sections.rails().iter().enumerate() {
                let wanted = drawn[pair].point_at_fraction(k as f64 / 23.0);
                let off = section[*column] - wanted;
                let seen = if pair % 2 == 0 { off.truncate().length() } else { off.with_x(0.0).length() };
                assert!(seen < 1e-12, "section {k}, pair {pair}: {off}");
                assert_eq!(flat[*column], wanted);
            }
        }
    }

    #[test]
    fn views_need_not_be_square_to_each_other() {
        let turn = glam::DQuat::from_rotation_y(0.6);
        let mut rails = leg();
        for k in [1, 3] {
            rails[k] = rails[k].map(|p| turn * p).unwrap();
        }
        let made = run(&rails, &GenerateOptions::default());
        assert!(made.warnings.is_empty());
        for section in made.sections.iter() {
            let pins: Vec<DVec3> = made.sections.rails().iter().map(|column| section[*column]).collect();
            let apart = (pins[0] + pins[2] - pins[1] - pins[3]) * 0.5;
            assert!(apart.z.abs() < 1e-12 && apart.dot(turn * DVec3::X).abs() < 1e-12, "{apart}");
        }
    }

    /// A head-like dome on a cylinder; the outlines meet on top, the front one drawn behind the side one's middle.
    fn dome() -> [Curve; 4] {
        let profile = |t: f64| {
            let a = (2.0 * t - 1.0).max(0.0) * FRAC_PI_2;
            (0.08 * a.cos(), if t < 0.5 { 0.2 * t } else { 0.1 + 0.1 * a.sin() })
        };
        let tip = DVec3::new(0.0, 0.2, 0.03);
        let outline = |name, out: DVec3| {
            rail(
                name,
                200,
                move |t| if t == 1.0 { tip } else { out * profile(t).0 + DVec3::new(0.0, profile(t).1, 0.03) },
            )
        };
        [
            outline("left", DVec3::X),
            outline("back", DVec3::NEG_Z),
            outline("right", DVec3::NEG_X),
            outline("front", DVec3::Z),
        ]
    }

    #[test]
    fn an_apex_is_a_round_cap_that_ends_in_a_pole() {
        let made = run(&dome(), &GenerateOptions::default());
        let tip = DVec3::new(0.0, 0.2, 0.03);
        assert!(made.sections.section(23).iter().all(|p| *p == tip));
        assert!(made.sections.is_pole(23) && !made.sections.is_pole(22));
        for pair in [0, 1] {
            let columns = [made.sections.rails()[pair], made.sections.rails()[pair + 2]];
            let up = made.sections.iter().map(|section| section[columns[0]]);
            let down: Vec<DVec3> = made.sections.iter().map(|section| section[columns[1]]).collect();
            let outline: Vec<DVec3> = up.chain(down.into_iter().rev().skip(1)).collect();
            let turns: Vec<f64> =
                outline.windows(3).map(|w| (w[1] - w[0]).angle_between(w[2] - w[1]).to_degrees()).collect();
            let largest = turns.iter().copied().fold(0.0, f64::max);
            assert!(largest < 12.0, "{turns:?}");
            assert!(turns[22] < 8.0, "over the pole: {}", turns[22]);
        }
        // The profile of each cap is that of the outline, and its rings shrink evenly to the pole.
        let sizes: Vec<f64> = made.sections.iter().map(|s| s[0].distance(s[32])).collect();
        assert!(sizes.windows(2).skip(12).all(|w| w[1] < w[0]), "{sizes:?}");
    }

    #[test]
    fn an_apex_may_be_at_the_start_or_loose() {
        let [left, back, right, front] = dome().map(Curve::reversed);
        let made = run(&[left, front, right, back], &GenerateOptions::default());
        assert!(made.sections.is_pole(0) && !made.sections.is_pole(23));

        let mut loose = dome();
        let gap = 0.01;
        loose[0] = loose[0].map(|p| p + DVec3::new(0.0, gap, 0.0)).unwrap();
        let made = run(&loose, &GenerateOptions::default());
        assert!(made.sections.is_pole(23));
        assert!((made.largest_gap - 0.75 * gap).abs() < 1e-12, "{}", made.largest_gap);
        let open = run(&loose, &GenerateOptions { snap: 0.008, ..GenerateOptions::default() });
        assert!(!open.sections.is_pole(23));
        assert_eq!(open.largest_gap, 0.0);
    }

    #[test]
    fn stations_rise_from_end_to_end() {
        for (base, tip) in [(false, false), (false, true), (true, false), (true, true)] {
            for count in [2, 3, 24] {
                let t = stations(count, base, tip);
                assert_eq!((t.len(), t[0], t[count - 1]), (count, 0.0, 1.0));
                assert!(t.windows(2).all(|w| w[1] > w[0]), "{t:?}");
            }
            let t = stations(1001, base, tip);
            let (first, last) = (1000.0 * (t[1] - t[0]), 1000.0 * (t[1000] - t[999]));
            assert!(!base || (first - 0.5).abs() < 1e-3, "{first}");
            assert!(!tip || (last - 0.5).abs() < 1e-3, "{last}");
        }
    }

    #[test]
    fn pairs_that_cannot_be_shifted_are_warned_of() {
        let mut rails = leg();
        rails[1] = rail("back", 20, |t| DVec3::new(0.1445 + 0.1 * (3.0 * t).sin(), t, -0.1));
        let made = run(&rails, &GenerateOptions::default());
        assert!(
            made.warnings.len() == 1 && made.warnings[0].contains("Rails 1 (\"back\") and 3"),
            "{:?}",
            made.warnings
        );
        let drawn = ArcLength::of(&rails[1]);
        for (k, section) in made.sections.iter().enumerate() {
            assert_eq!(section[16], drawn.point_at_fraction(k as f64 / 23.0));
            assert!(((section[0] + section[32] - section[16] - section[48]).z).abs() < 1e-12);
        }

        let [left, _, right, _] = leg();
        let same = [left.clone(), left.map(|p| p * 1.1).unwrap(), right.clone(), right.map(|p| p * 1.1).unwrap()];
        let made = run(&same, &GenerateOptions::default());
        assert!(made.warnings[0].contains("nearly the same view"), "{:?}", made.warnings);
        assert_eq!(made.sections.section(0)[0], same[0].start());
    }

    #[test]
    fn nodes_are_rounded_up_to_quarters() {
        for (asked, made) in [(0, 8), (8, 8), (30, 32), (8190, 8192)] {
            let options = GenerateOptions { nodes: asked, sections: 2, ..GenerateOptions::default() };
            let sections = run(&leg(), &options).sections;
            assert_eq!((sections.nodes(), sections.rails()), (made, &[0, made / 4, made / 2, 3 * made / 4][..]));
        }
    }

    #[test]
    fn errors() {
        let rails = leg();
        let with = |change: fn(&mut GenerateOptions)| {
            let mut options = GenerateOptions::default();
            change(&mut options);
            two_views(&rails, &options, &|_| true)
        };
        let few = with(|o| o.sections = 1);
        assert_eq!(few, Err(GenerateError::TooFewSections { found: 1, needed: 2 }));
        for huge in [
            with(|o| o.nodes = usize::MAX),
            with(|o| o.sections = 9000),
            with(|o| (o.sections, o.nodes) = (8192, 8192)),
        ] {
            assert!(matches!(huge, Err(GenerateError::TooLarge { .. })));
        }
        for snap in [with(|o| o.snap = -1.0), with(|o| o.snap = f64::INFINITY)] {
            assert!(matches!(snap, Err(GenerateError::Snap { .. })));
        }
        let stopped = two_views(&rails, &GenerateOptions::default(), &|done| done < 0.3);
        assert_eq!(stopped, Err(GenerateError::Cancelled));
        let mut closed = leg();
        closed[2] = Curve::new("ring", closed[2].points().to_vec(), true).unwrap();
        let refused = two_views(&closed, &GenerateOptions::default(), &|_| true);
        assert_eq!(refused, Err(GenerateError::RailIsClosed { rail: 2, name: "ring".into() }));
        let mut huge = leg();
        huge[1] = huge[1].map(|p| p * 1e102).unwrap();
        let refused = two_views(&huge, &GenerateOptions::default(), &|_| true);
        assert_eq!(refused, Err(GenerateError::TooFarOut { name: "back".into() }));
    }

    #[test]
    fn a_snap_larger_than_the_shape_closes_nothing() {
        let options = GenerateOptions { snap: 10.0, ..GenerateOptions::default() };
        let (made, open) = (run(&leg(), &options), run(&leg(), &GenerateOptions { snap: 0.0, ..options }));
        assert_eq!(made.sections, open.sections);
        assert!(!made.sections.is_pole(0) && !made.sections.is_pole(23) && made.largest_gap == 0.0);
        assert!(made.warnings.len() == 2 && made.warnings[1].contains("the end stays open"), "{:?}", made.warnings);
        assert!(open.warnings.is_empty());
    }

    #[test]
    fn unsorted_rails_are_refused() {
        let [left, back, right, front] = leg();
        for placement in [ViewPlacement::Centred, ViewPlacement::AsDrawn] {
            let options = GenerateOptions { placement, ..GenerateOptions::default() };
            let unsorted = [left.clone(), right.clone(), front.clone(), back.clone()];
            let refused = two_views(&unsorted, &options, &|_| true);
            let names = ["left", "right", "front", "back"].map(str::to_owned);
            assert_eq!(refused, Err(GenerateError::RailsUnsorted { names }));
            let one_back = [left.clone(), back.clone().reversed(), right.clone(), front.clone()];
            let refused = two_views(&one_back, &options, &|_| true);
            assert_eq!(refused, Err(GenerateError::RailRunsBack { rail: 1, name: "back".into() }));
        }
    }
}
