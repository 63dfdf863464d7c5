//! What a fit came to.

use super::error::FitWarning;
use super::options::{Angles, Joint};
use super::order_search::Errors;
use super::section::EllipticSection;
use glam::DVec3;

/// A fitted section and how well it fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The section.
    pub section: EllipticSection,
    /// How well it fits.
    pub report: FitReport,
}

/// How well a section fits its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct FitReport {
    /// Mean and largest distance between samples and section at the same angle, as shares of the diagonal.
    pub errors: Errors,
    /// Diagonal D of the box around the samples in the section's frame, metres.
    pub diagonal: f64,
    /// Whether the tolerances are met; where J is fixed too.
    pub met: bool,
    /// Harmonics J of each segment.
    pub harmonics: Vec<usize>,
    /// The sample farthest from the section.
    pub worst: WorstPoint,
    /// Number of points that were fitted.
    pub samples: usize,
    /// Whether the curve was reversed to run counter-clockwise about the direction asked for.
    pub reversed: bool,
    /// What is odd about the curve.
    pub warnings: Vec<FitWarning>,
}

/// A sample and its distance from the section at the same angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPoint {
    /// The sample, metres.
    pub point: DVec3,
    /// Its angle, radians; that of the joint on which it lies.
    pub angle: f64,
    /// The distance, metres.
    pub distance: f64,
}

/// A stack of sections fitted with one kind of angles and one set of joints, so that the same angle means the same
/// place in all of them: what a surface can be skinned through.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedStack {
    /// The sections in order. All have the same number of segments over the same ranges, with local angles alike.
    pub sections: Vec<Fitted>,
    /// The kind of angles: polar or arc length.
    pub angles: Angles,
    /// The joints, in ascending order of angle. Their continuity is the least of any section.
    pub joints: Vec<Joint>,
}

impl FittedStack {
    /// Stored constants of all sections: see [`EllipticSection::constants`].
    pub fn constants(&self) -> usize {
        self.sections.iter().map(|fitted| fitted.section.constants()).sum()
    }

    /// Largest distance of any section from its samples, metres.
    pub fn largest_distance(&self) -> f64 {
        self.sections.iter().map(|fitted| fitted.report.worst.distance).fold(0.0, f64::max)
    }

    /// Whether all sections meet the tolerances.
    pub fn met(&self) -> bool {
        self.sections.iter().all(|fitted| fitted.report.met)
    }
}
