//! Detail generators: surfaces swept by a beam curve along drawn rails (thesis 6).
//!
//! | case | curves | source |
//! |---|---|---|
//! | [`two_views`] | four open rails, a pair from each of two views | thesis 6.1, Figures 6.1-6.3 |
//! | [`arch`] | one open contour over a closed one | thesis 6.2, Figures 6.4, 6.5 |
//! | [`to_apex`] | two open contours and a closed one, cut where they cross; any number of rails to a point | thesis 6.3, Figures 6.6, 6.7 |
//! | [`between_closed`] | two or more open rails between two closed curves | thesis 6.3, Figures 6.8, 6.9 |
//! | [`through_closed`] | the same past several closed curves | |
//! | [`sheet`] | two or more open rails between two or more open curves | thesis 6.3, Figure 6.10 |
//! | [`network`] | three or four borders, with rails across | paper 5.2.4 |
//! | [`blend`] | two closed borders of two surfaces | paper 5.2.5 |
//!
//! [`Detail`] offers all of them at one door. Where a [`Neighbour`] is given, the surface continues it smoothly.
//!
//! Every generator takes `progress`, called with the fraction done; where it answers `false` the generator stops with
//! [`GenerateError::Cancelled`].

mod alignment;
mod apex;
mod arch;
#[cfg(test)]
mod arch_tests;
mod between_closed;
mod blend;
#[cfg(test)]
mod blend_tests;
mod centring;
mod detail;
mod error;
mod feet;
mod local_detail;
#[cfg(test)]
mod look_tests;
mod neighbour;
mod network;
#[cfg(test)]
mod network_tests;
mod order;
mod pace;
mod patch;
mod places;
mod sheet;
#[cfg(test)]
mod sheet_tests;
mod side;
mod sweep;
#[cfg(test)]
mod test_shapes;
mod to_apex;
#[cfg(test)]
mod to_apex_tests;
mod turning;
#[cfg(test)]
mod turning_tests;
mod two_views;
mod view_plane;
mod walk;
mod winding;

pub use arch::{ArchBorder, arch};
pub use between_closed::{between_closed, through_closed};
pub use blend::{BlendBorder, blend};
pub use detail::{Detail, Method};
pub use error::GenerateError;
pub use local_detail::LocalDetail;
pub use neighbour::Neighbour;
pub use network::network;
pub use patch::blend_generators;
pub use sheet::sheet;
pub use to_apex::to_apex;
pub use two_views::two_views;

use crate::beam::{MOST_NODES, Stiffness};
use crate::curve::Curve;
use crate::sections::Sections;

/// How a generator between two rails goes over from the one to the other (thesis 6.2, 6.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weights {
    /// `s^2 (3 - 2 s)`: neighbouring patches meet without a crease.
    #[default]
    Smooth,
    /// `s`, as printed in the thesis: the surface creases along every rail.
    Linear,
}

impl Weights {
    /// The weight of the second rail at the share `s` (0 to 1) of the way to it.
    pub fn at(self, s: f64) -> f64 {
        match self {
            Self::Smooth => s * s * (3.0 - 2.0 * s),
            Self::Linear => s,
        }
    }
}

/// In which frame a generator between two closed curves blends what its two rails add to the loft between the curves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// One that turns about the running axis as the closed curves do: what is drawn round by its rails is round between
    /// them, too.
    #[default]
    Turning,
    /// One that stands still, as printed in the thesis (equations 6.2 and 6.3): between two rails a quarter of a turn
    /// apart a swelling shrinks to 0.71 of itself.
    Fixed,
}

/// Where the silhouettes of two views stand in depth, of which a silhouette itself tells nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewPlacement {
    /// Each pair is shifted along its own viewing direction to the middle of the other pair, section by section. Seen
    /// in its own view it stays as drawn.
    #[default]
    Centred,
    /// Each pair stays in the plane it was drawn in.
    AsDrawn,
}

/// What the generators let the artist choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenerateOptions {
    /// Stiffness of the generator curve.
    pub stiffness: Stiffness,
    /// Number of cross-sections.
    pub sections: usize,
    /// Number of points of each cross-section.
    pub nodes: usize,
    /// Weights between two rails.
    pub weights: Weights,
    /// Frame in which the rails between two closed curves are blended.
    pub frame: Frame,
    /// Depth of silhouettes.
    pub placement: ViewPlacement,
    /// Keeps fine detail of the silhouettes of two views near their rails; none lets it reach the next rail, as in the
    /// thesis.
    pub detail: Option<LocalDetail>,
    /// How far a rail's end may be from where it should be, its closed curve or the common apex, metres. An apex takes
    /// no more than 5 % of the shortest rail's length of it.
    pub snap: f64,
}

impl Default for GenerateOptions {
    /// The thesis' stiffness, 24 sections of 64 points, smooth weights, turning frames, centred views, 2 cm of snap.
    fn default() -> Self {
        Self {
            stiffness: Stiffness::default(),
            sections: 24,
            nodes: 64,
            weights: Weights::default(),
            frame: Frame::default(),
            placement: ViewPlacement::default(),
            detail: None,
            snap: 0.02,
        }
    }
}

impl GenerateOptions {
    /// Most points of one generated surface.
    pub const MOST_POINTS: usize = 1 << 24;

    fn check(&self, least_sections: usize) -> Result<(), GenerateError> {
        if self.sections < least_sections {
            return Err(GenerateError::TooFewSections { found: self.sections, needed: least_sections });
        }
        let points = self.sections.saturating_mul(self.nodes);
        if self.sections > MOST_NODES || self.nodes > MOST_NODES || points > Self::MOST_POINTS {
            return Err(GenerateError::TooLarge { sections: self.sections, nodes: self.nodes });
        }
        if !(self.snap.is_finite() && self.snap >= 0.0) {
            return Err(GenerateError::Snap { snap: self.snap });
        }
        Ok(())
    }
}

/// What a generator makes.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// The cross-sections, closed, with the columns of the rails.
    pub sections: Sections,
    /// What was decided or adjusted on the way, one sentence each, for the artist.
    pub notes: Vec<String>,
    /// What will probably disappoint the artist, and what to do about it, one sentence each.
    pub warnings: Vec<String>,
    /// Largest distance bridged between a rail's end and where it should be, metres; at most the snap.
    pub largest_gap: f64,
    /// The distances bridged at the start and at the end of each rail, metres; none for a blend, which has no rails.
    pub gaps: Vec<[f64; 2]>,
}

/// Checks that lengths and areas of the curves stay within the range of a double.
fn check_size<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Result<(), GenerateError> {
    let far = |curve: &&Curve| curve.points().iter().any(|p| p.abs().max_element() > 1e100);
    match curves.into_iter().find(far) {
        Some(curve) => Err(GenerateError::TooFarOut { name: curve.name().to_owned() }),
        None => Ok(()),
    }
}

/// Reports progress.
fn report(progress: &dyn Fn(f64) -> bool, done: usize, of: usize) -> Result<(), GenerateError> {
    if progress(done as f64 / of.max(1) as f64) { Ok(()) } else { Err(GenerateError::Cancelled) }
}
