//! Sections along a bone, and in planes that are given.

use std::f64::consts::PI;

use glam::DVec3;

use super::around::{Found, around_bone};
use super::crossing::crossings;
use super::error::SliceError;
use super::plane::{Frame, Plane};
use super::section::{Method, NoSection, Section, SectionOptions, Sliced, from_loop, from_points};
use super::stations::{along_bone, with_fronts};
use super::warning::{Concern, SliceWarning, warn};
use super::{cut, rays};
use crate::curve::{Curve, MAX_POINTS};
use crate::mesh::{Mesh, MeshRays};

/// Most sections that are made in one go.
pub const MAX_SECTIONS: usize = 4096;

/// How far beyond its ends a bone is followed, in lengths of the bone.
const REACH: f64 = 10.0;

/// Where sections stand along a bone, as shares of its length: 0 is its first point, 1 its last. Beyond its ends a bone
/// goes on straight; -10 to 11 are allowed.
#[derive(Clone, Debug, PartialEq)]
pub enum Positions {
    /// This many, evenly from the first share to the last; a single one in the middle.
    Count {
        /// How many, 1 to [`MAX_SECTIONS`].
        count: usize,
        /// First and last share.
        extent: [f64; 2],
    },
    /// These, in growing order.
    At(Vec<f64>),
}

impl Positions {
    /// `count` sections from end to end.
    pub fn count(count: usize) -> Self {
        Self::Count { count, extent: [0.0, 1.0] }
    }

    /// The shares, one a section.
    ///
    /// # Errors
    /// [`SliceError`] where there are none or too many, or they do not grow or are out of range.
    pub fn fractions(&self) -> Result<Vec<f64>, SliceError> {
        let found = match self {
            Self::Count { count, .. } => *count,
            Self::At(fractions) => fractions.len(),
        };
        if !(1..=MAX_SECTIONS).contains(&found) {
            return Err(SliceError::SectionCount { found });
        }
        if let Self::Count { extent: [from, to], .. } = self
            && (from.is_nan() || to.is_nan() || from > to)
        {
            return Err(SliceError::Extent { from: *from, to: *to });
        }
        let fractions = match self {
            Self::Count { count: 1, extent: [from, to] } => vec![0.5 * (from + to)],
            Self::Count { count, extent: [from, to] } => {
                let last = (count - 1) as f64;
                (0..*count).map(|k| k as f64 / last).map(|t| from * (1.0 - t) + to * t).collect()
            }
            Self::At(fractions) => fractions.clone(),
        };
        if let Some(&fraction) = fractions.iter().find(|f| !(-REACH..=1.0 + REACH).contains(*f)) {
            return Err(SliceError::OutOfReach { fraction });
        }
        match fractions.windows(2).position(|pair| pair[0] >= pair[1]) {
            Some(before) => Err(SliceError::NotGrowing { section: before + 1, fraction: fractions[before + 1] }),
            None => Ok(fractions),
        }
    }
}

/// How sections are taken along a bone.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongOptions {
    /// Where they stand.
    pub positions: Positions,
    /// Stretch around a joint over which the planes turn from one bone's direction to the next, as a share of the whole
    /// length, 0 to 1. At 0 they turn at once. Where the bone bends by an angle a in one joint, sections do not cross
    /// within r of it if the stretch is longer than 2 r tan(a/2) / cos(a/2); other joints on it shorten the reach.
    pub turning: f64,
    /// How they are made.
    pub section: SectionOptions,
}

impl Default for AlongOptions {
    /// 12 sections from end to end that turn over 0.3 of the length.
    fn default() -> Self {
        Self { positions: Positions::count(12), turning: 0.3, section: SectionOptions::default() }
    }
}

/// Offset of the bone in units of the section's radius from which a warning is due. On a human body the bones of the
/// limbs, the spine and the head stay below 0.55; sections that cut both thighs, or arm and chest, are above 0.75.
const OFF_CENTRE: f64 = 0.7;

/// Sections of a mesh along a bone, which is an open polyline in metres inside of the body.
///
/// Planes stand across the bone; at joints they turn smoothly from one bone's direction to the next, as
/// [`AlongOptions::turning`] says (the normal is the mean direction of the bone over that stretch). In each plane the
/// loop around the bone is kept (the outermost of several), run counter-clockwise about the bone's direction, begun at
/// the front and resampled; see [`plane`](super::plane()) for what happens at vertices in the plane and
/// [`Section`] for what is measured. Fronts are carried along the bone by parallel transport, so that equal points of
/// neighbouring sections correspond; a reversed bone gives the same loops, run the other way.
///
/// # Errors
/// [`SliceError`] where an option is out of range, an outline does not close or a ray misses, or no plane meets the mesh.
pub fn along(mesh: &Mesh, bone: &Curve, options: &AlongOptions) -> Result<Sliced, SliceError> {
    along_while(mesh, bone, options, &|_| true)
}

/// The same, telling `progress` before each section what share is done, 0 to 1.
///
/// # Errors
/// As [`along`], and [`SliceError::Stopped`] where `progress` answers `false`.
pub fn along_while(
    mesh: &Mesh,
    bone: &Curve,
    options: &AlongOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Sliced, SliceError> {
    let name = || bone.name().to_owned();
    if bone.is_closed() {
        return Err(SliceError::ClosedBone { bone: name() });
    }
    if !(0.0..=1.0).contains(&options.turning) {
        return Err(SliceError::Turning { turning: options.turning });
    }
    check(mesh, &options.section)?;
    let fractions = options.positions.fractions()?;
    let frames = along_bone(bone, &fractions, options.turning, options.section.front)
        .ok_or_else(|| SliceError::Unmeasurable { bone: name() })?;
    in_frames(mesh, &frames, &options.section, progress)
}

/// Sections of a mesh in planes that are given, in order along the body; the bone passes through their origins in the
/// direction of their normals. Otherwise as [`along`].
///
/// # Errors
/// As [`along`].
pub fn through(mesh: &Mesh, planes: &[Plane], options: &SectionOptions) -> Result<Sliced, SliceError> {
    through_while(mesh, planes, options, &|_| true)
}

/// The same, telling `progress` before each section what share is done, 0 to 1.
///
/// # Errors
/// As [`through`], and [`SliceError::Stopped`] where `progress` answers `false`.
pub fn through_while(
    mesh: &Mesh,
    planes: &[Plane],
    options: &SectionOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Sliced, SliceError> {
    check(mesh, options)?;
    if !(1..=MAX_SECTIONS).contains(&planes.len()) {
        return Err(SliceError::SectionCount { found: planes.len() });
    }
    in_frames(mesh, &with_fronts(planes, options.front, |_, _| Vec::new()), options, progress)
}

fn check(mesh: &Mesh, options: &SectionOptions) -> Result<(), SliceError> {
    if !options.front.is_finite() || options.front == DVec3::ZERO {
        return Err(SliceError::Front { front: options.front });
    }
    if !(3..=MAX_POINTS).contains(&options.points) {
        return Err(SliceError::PointCount { points: options.points });
    }
    if mesh.polygon_count() == 0 { Err(SliceError::NoPolygons) } else { Ok(()) }
}

fn in_frames(
    mesh: &Mesh,
    frames: &[Frame],
    options: &SectionOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Sliced, SliceError> {
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(SliceError::Stopped) };
    let begun = |index: usize| told(index as f64 / frames.len() as f64);
    let mut warnings = Vec::new();
    let mut sections = Vec::with_capacity(frames.len());
    match options.method {
        Method::Loop => {
            for (index, frame) in frames.iter().enumerate() {
                begun(index)?;
                sections.extend(by_loop(mesh, index, frame, options.points, &mut warnings)?);
            }
        }
        Method::Rays(hit) => {
            let tree = MeshRays::new(mesh).map_err(|_| SliceError::NoPolygons)?;
            for (index, frame) in frames.iter().enumerate() {
                begun(index)?;
                let hits = rays::cast(&tree, frame, options.points, hit);
                sections.extend(by_rays(index, frame, &hits, &mut warnings)?);
            }
        }
    }
    if sections.is_empty() {
        return Err(SliceError::NothingCut { planes: frames.len() });
    }
    warnings.extend(crossings(&sections, &|| told(1.0))?);
    Ok(Sliced { sections, warnings })
}

fn by_loop(
    mesh: &Mesh,
    section: usize,
    frame: &Frame,
    points: usize,
    warnings: &mut Vec<SliceWarning>,
) -> Result<Option<Section>, SliceError> {
    let at = frame.plane.origin();
    let loops = cut::plane(mesh, &frame.plane);
    let (contour, others, around) = match around_bone(&loops, frame) {
        Found::Around { contour, others, wider_open } => {
            if wider_open {
                warn(warnings, section, at, Concern::WithinOpen);
            }
            (contour, others, true)
        }
        Found::Beside { contour, others, distance } => {
            warn(warnings, section, at, Concern::Beside { distance });
            (contour, others, false)
        }
        Found::Open(ends) => return Err(SliceError::NotClosed { section, at, ends }),
        Found::Nothing => {
            warn(warnings, section, at, Concern::Missed);
            return Ok(None);
        }
    };
    match from_loop(section, frame, contour, points, others) {
        Ok(made) => {
            if around {
                warn_off_centre(&made, warnings);
            }
            Ok(Some(made))
        }
        Err(NoSection::Curve(source)) => Err(SliceError::Curve { section, source }),
        Err(NoSection::Resample(source)) => Err(SliceError::Resample { section, source }),
    }
}

fn by_rays(
    section: usize,
    frame: &Frame,
    hits: &[Option<DVec3>],
    warnings: &mut Vec<SliceWarning>,
) -> Result<Option<Section>, SliceError> {
    let at = frame.plane.origin();
    let missed: Vec<usize> = (0..hits.len()).filter(|ray| hits[*ray].is_none()).collect();
    if missed.len() == hits.len() {
        warn(warnings, section, at, Concern::Missed);
        return Ok(None);
    }
    if !missed.is_empty() {
        return Err(SliceError::RaysMissed { section, at, rays: hits.len(), missed });
    }
    let points = hits.iter().copied().flatten().collect();
    let made = from_points(section, frame, points).map_err(|source| SliceError::Curve { section, source })?;
    if made.curve.points().len() < hits.len() {
        return Err(SliceError::RaysMeet { section, at });
    }
    warn_off_centre(&made, warnings);
    Ok(Some(made))
}

fn warn_off_centre(section: &Section, warnings: &mut Vec<SliceWarning>) {
    if section.offset > OFF_CENTRE * (section.area / PI).sqrt() {
        let what = Concern::OffCentre { offset: section.offset };
        warn(warnings, section.index, section.plane.origin(), what);
    }
}
