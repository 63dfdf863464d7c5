//! What is asked of a fit.

use super::order_search::Tolerances;
use glam::DVec3;

/// How sections are fitted. The default is the thesis's: one closed or open series, the smallest J that meets 1 % and
/// 2.5 %, at most 30 harmonics.
#[derive(Clone, Debug, PartialEq)]
pub struct FitOptions {
    /// How many harmonics.
    pub harmonics: Harmonics,
    /// Errors allowed while the number of harmonics is searched for, as shares of the diagonal of each section's box.
    pub tolerances: Tolerances,
    /// Besides them, the largest distance allowed, metres; none is no limit.
    pub largest_distance: Option<f64>,
    /// How angles are given to points of closed sections. Open ones always go by arc length, from 0 to pi.
    pub angles: Angles,
    /// Where the angle of arc-length sections starts.
    pub start: Start,
    /// Which points of the curves are fitted.
    pub sampling: Sampling,
    /// Where a section is split into segments.
    pub split: Split,
    /// How segments meet where nothing else is said.
    pub continuity: Continuity,
    /// Whether the segments of a section are fitted together or one after the other.
    pub solution: Solution,
    /// Whether segments over a part of the turn count an angle of their own.
    pub local_angles: LocalAngles,
    /// Whether the sections of a stack share one number of harmonics a segment, the largest any of them needs.
    pub common_harmonics: bool,
    /// The direction about which closed sections are to run counter-clockwise; those that run the other way are
    /// reversed. None keeps the direction of a single curve, and takes the direction of the stack where there are
    /// several.
    pub about: Option<DVec3>,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            harmonics: Harmonics::default(),
            tolerances: Tolerances::default(),
            largest_distance: None,
            angles: Angles::Auto,
            start: Start::Ray,
            sampling: Sampling::Even,
            split: Split::None,
            continuity: Continuity::C1,
            solution: Solution::Together,
            local_angles: LocalAngles::Auto,
            common_harmonics: false,
            about: None,
        }
    }
}

/// How many harmonics J a segment gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harmonics {
    /// As few as meet the tolerances, up to `most`, to a quarter of the samples, and in segments to where the condition
    /// number of the basis is estimated at 1e8 (J = 10 over half a turn, or in a local angle).
    Smallest {
        /// Most harmonics, 1 to 100.
        most: usize,
    },
    /// This many, 1 to 100.
    Fixed(usize),
}

impl Default for Harmonics {
    /// As few as meet the tolerances, up to 30.
    fn default() -> Self {
        Self::Smallest { most: 30 }
    }
}

/// How points of a closed section get their angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// Polar where all sections are clearly star-shaped about their centres, else by arc length; one for all sections
    /// of a stack. Clearly means that the polar angle nowhere grows slower than a quarter of its mean pace along the
    /// curve: where it nearly stands still, polar angles crowd and many harmonics are needed.
    Auto,
    /// The polar angle about the mean of the samples (thesis 3.6).
    Polar,
    /// In proportion to arc length.
    ArcLength,
}

/// Where arc-length angles start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Angle 0 at the outermost crossing of the curve with the ray from the centre along the frame's `e1`, so that
    /// angles mean the same in all sections of a stack, and do not depend on where a curve was begun.
    Ray,
    /// The first point of each curve at one angle: its polar angle in the first section. For curves whose first points
    /// correspond.
    FirstPoint,
}

/// Which points are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Points even in arc length: those of the curve where they are (to a quarter) and are enough, else new ones along
    /// its straight segments. At least 64 (128 where the section is split), `4J+1` where J is fixed, at most 512.
    Even,
    /// The points of the curve. Uneven ones draw the centre and the fit to where they are dense.
    AsGiven,
}

/// How segments meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Continuity {
    /// In position.
    C0,
    /// In position and first derivative with respect to the angle.
    C1,
    /// In position, first and second derivative.
    C2,
}

impl Continuity {
    /// The highest derivative that agrees.
    pub fn order(self) -> usize {
        match self {
            Self::C0 => 0,
            Self::C1 => 1,
            Self::C2 => 2,
        }
    }
}

/// Where two segments meet, common to all sections of a stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Angle, radians: taken modulo 2 pi in a closed section, inside 0 to pi in an open one.
    pub angle: f64,
    /// How the segments meet there.
    pub continuity: Continuity,
}

/// Where a section is split.
#[derive(Clone, Debug, PartialEq)]
pub enum Split {
    /// Nowhere: one series.
    None,
    /// At these joints. A closed section with one joint becomes one segment that begins and ends there.
    At(Vec<Joint>),
    /// At corners. Sections that turn there by more than a third of `angle` keep the corner (C0), others are smooth
    /// ([`FitOptions::continuity`]). A closed section with a single corner gets a smooth joint opposite.
    Corners {
        /// The turn that makes a corner, radians.
        angle: f64,
    },
    /// Only where a section does not meet the tolerances with `most` harmonics: at corners first, then again and again
    /// in the segment that is worst, at its worst point, up to 8 joints.
    Automatic {
        /// Harmonics beyond which a segment is split.
        most: usize,
        /// The turn that makes a corner, radians.
        corner_angle: f64,
    },
}

/// In what order segments are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solution {
    /// All in one least-squares problem with the joints as constraints. Never worse in the sum of squares.
    Together,
    /// The first freely, each next one tied to the end of the last, the last of a closed section at both ends (thesis
    /// 3.2). Samples at tied ends do not count. Much worse where the free end of the first happens to be; with C2
    /// seldom of use.
    InTurn,
}

/// Whether segments count an angle of their own: see [`super::EllipticSegment::local`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalAngles {
    /// Where the functions of the section's angle would be too nearly dependent: where the condition number of J
    /// harmonics over the range, estimated as `cot(range/8)^(2J)` (right within a factor of 3), is above 1e6, and the
    /// range is less than pi. A closed section that is one segment with a joint always.
    Auto,
    /// Never, as in the thesis; but a closed section that is one segment with a joint still does.
    Never,
    /// In every section that is split.
    Always,
}
