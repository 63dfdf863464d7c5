//! Changes of whole strokes of the active sketch.

use std::collections::BTreeSet;

use glam::{DAffine2, DVec2};
use maquette_graph::{Edit, Literal, Stroke};

use crate::app::App;
use crate::command::StrokeDeed;
use crate::sketch::correct::{joined, mirrored, reversed, transformed};
use crate::sketch::target::SketchTarget;

/// How far a copy lies beside what it was copied from, metres.
const BESIDE: f64 = 0.02;

impl App {
    pub(super) fn apply_strokes(&mut self, deed: StrokeDeed) {
        let Some(target) = self.view.active.and_then(|id| SketchTarget::of(self.canvas_graph(), id)) else {
            self.complain("no strokes to change: select a sketch first");
            return;
        };
        let there: BTreeSet<usize> =
            self.view.picked_strokes.iter().copied().filter(|index| *index < target.strokes.len()).collect();
        let chosen = if there.is_empty() { (0..target.strokes.len()).collect() } else { there };
        match changed(&target.strokes, &chosen, deed) {
            Err(problem) => self.complain(problem),
            Ok((strokes, picked)) => {
                let name = format!("{} strokes", deed.name().to_lowercase());
                self.make(&name, vec![Edit::set(target.node, target.input, Literal::Strokes(strokes))], None);
                self.view.picked_strokes = picked;
            }
        }
    }
}

/// The strokes after a deed, and those of them to pick.
fn changed(
    strokes: &[Stroke],
    chosen: &BTreeSet<usize>,
    deed: StrokeDeed,
) -> Result<(Vec<Stroke>, BTreeSet<usize>), &'static str> {
    let each = |change: &dyn Fn(&Stroke) -> Stroke| {
        let strokes = strokes.iter().enumerate();
        strokes.map(|(k, stroke)| if chosen.contains(&k) { change(stroke) } else { stroke.clone() }).collect::<Vec<_>>()
    };
    let beside = |change: &dyn Fn(&Stroke) -> Stroke| {
        let fresh = chosen.iter().filter_map(|index| strokes.get(*index)).map(change);
        let all: Vec<Stroke> = strokes.iter().cloned().chain(fresh).collect();
        let picked = (strokes.len()..all.len()).collect();
        (all, picked)
    };
    Ok(match deed {
        StrokeDeed::Duplicate => beside(&|stroke| Stroke {
            name: format!("{} copy", stroke.name),
            ..transformed(stroke, DAffine2::from_translation(DVec2::splat(BESIDE)))
        }),
        StrokeDeed::Mirror => beside(&mirrored),
        StrokeDeed::Reverse => (each(&reversed), chosen.clone()),
        StrokeDeed::Close => {
            let close = chosen.iter().filter_map(|index| strokes.get(*index)).any(|stroke| !stroke.closed);
            (each(&|stroke| Stroke { closed: close, ..stroke.clone() }), chosen.clone())
        }
        StrokeDeed::Join => {
            let picked: Vec<usize> = chosen.iter().copied().collect();
            let [first, second] = picked[..] else { return Err("pick two open strokes to join (Shift+click)") };
            let one =
                joined(&strokes[first], &strokes[second]).ok_or("a closed stroke has no end to join: cut it first")?;
            let mut strokes = strokes.to_vec();
            strokes[first] = one;
            strokes.remove(second);
            (strokes, BTreeSet::from([first]))
        }
        StrokeDeed::Delete => {
            let kept =
                strokes.iter().enumerate().filter(|(k, _)| !chosen.contains(k)).map(|(_, stroke)| stroke.clone());
            (kept.collect(), BTreeSet::new())
        }
    })
}
