//! What silhouettes made of a stack of sections, and how well.

use glam::{DVec2, DVec3};

use crate::sections::Sections;
use crate::view::View;

/// Share of the sketch's diagonal by which sections may stand out without a warning.
pub(super) const NOTICED: f64 = 0.0005;

/// What silhouettes made of a stack of sections.
#[derive(Clone, Debug, PartialEq)]
pub struct SilhouetteDeformed {
    /// The sections; their rails are the columns that follow the strokes, and earlier ones.
    pub sections: Sections,
    /// How each view is met, in the order of the views.
    pub views: Vec<ViewFit>,
    /// How far the point moved that moved farthest, metres.
    pub largest_move: f64,
    /// What was decided on the way, one sentence each, for the artist.
    pub notes: Vec<String>,
    /// What will probably disappoint the artist, and what to do about it, one sentence each.
    pub warnings: Vec<String>,
}

/// How the silhouette of a view is met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFit {
    /// The view.
    pub view: View,
    /// The columns that follow the strokes, on the left and on the right of the stack's axis.
    pub columns: [usize; 2],
    /// Largest distance by which a point of a section stands out beyond the two that are pinned, as seen, metres.
    pub overshoot: f64,
    /// The section that stands out most.
    pub section: usize,
    /// Largest distance of the strokes from the straight lines between the pins of neighbouring sections, metres: the
    /// detail that falls between sections.
    pub gap: f64,
    /// The first of the two sections between which it is.
    pub gap_after: usize,
}

/// Gathers how well sections meet their targets.
pub(super) struct Fits {
    views: Vec<ViewFit>,
    largest_move: f64,
    diagonal: f64,
    /// Share of the diagonal above which a gap is warned of.
    pub(super) gap_allowed: f64,
    /// Largest distance along the stack between where two views put a pole, metres.
    pub(super) tip_gap: f64,
}

impl Fits {
    pub(super) fn new(views: Vec<(View, [usize; 2])>, diagonal: f64) -> Self {
        let views = views.into_iter().map(|(view, columns)| ViewFit {
            view,
            columns,
            overshoot: 0.0,
            section: 0,
            gap: 0.0,
            gap_after: 0,
        });
        Self { views: views.collect(), largest_move: 0.0, diagonal, gap_allowed: NOTICED, tip_gap: 0.0 }
    }

    pub(super) fn section(&mut self, index: usize, from: &[DVec3], to: &[DVec3], targets: &[[DVec2; 2]]) {
        let moved = from.iter().zip(to).map(|(p, q)| p.distance_squared(*q)).fold(0.0, f64::max);
        self.largest_move = self.largest_move.max(moved.sqrt());
        for (fit, [left, right]) in self.views.iter_mut().zip(targets) {
            let Some(across) = (*left - *right).try_normalize() else { continue };
            let out = fit.view.lift(across);
            let (low, high) = (right.dot(across), left.dot(across));
            let (least, most) =
                to.iter().map(|p| p.dot(out)).fold((low, high), |(least, most), r| (least.min(r), most.max(r)));
            let overshoot = (most - high).max(low - least);
            if overshoot > fit.overshoot {
                (fit.overshoot, fit.section) = (overshoot, index);
            }
        }
    }

    /// What falls between sections in each view, and after which.
    pub(super) fn gaps(&mut self, gaps: &[(f64, usize)]) {
        for (fit, gap) in self.views.iter_mut().zip(gaps) {
            (fit.gap, fit.gap_after) = *gap;
        }
    }

    pub(super) fn finish(self, sections: Sections) -> SilhouetteDeformed {
        let mut warnings = Vec::new();
        for fit in &self.views {
            if fit.overshoot > NOTICED * self.diagonal {
                warnings.push(format!(
                    "Section {} stands out by {:.5} m beyond the strokes of the {} view, as it shrinks too much or is not \
                     round: start from a primitive closer to the strokes, or align one to them with more taper.",
                    fit.section,
                    fit.overshoot,
                    fit.view.name()
                ));
            }
            if fit.gap > self.gap_allowed * self.diagonal {
                warnings.push(format!(
                    "Sections {} and {} are too far apart for the detail of the {} view's strokes, which run {:.5} m \
                     beside the line between them: space sections by detail, or give the primitive more.",
                    fit.gap_after,
                    fit.gap_after + 1,
                    fit.view.name(),
                    fit.gap
                ));
            }
        }
        if self.tip_gap > ONE_MICROMETRE {
            warnings.push(format!(
                "The strokes of both views meet in tips {:.5} m apart along the stack, and the surface ends half way \
                 between: let them end at the same height.",
                self.tip_gap
            ));
        }
        let notes = self
            .views
            .iter()
            .map(|fit| {
                format!(
                    "In the {} view columns {} and {} follow the strokes.",
                    fit.view.name(),
                    fit.columns[0],
                    fit.columns[1]
                )
            })
            .collect();
        SilhouetteDeformed { sections, views: self.views, largest_move: self.largest_move, notes, warnings }
    }
}

/// Distance of tips that nobody sees.
const ONE_MICROMETRE: f64 = 1e-6;
