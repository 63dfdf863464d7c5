//! Giving a stack of sections the shape of a drawn cross-section.

use glam::DVec3;

use super::contour_matching::{Culprit, Matching, Ring, centroid};
use super::cross_section_error::CrossSectionError;
use crate::beam::{EndCondition, OpenBeam, OpenValues, Stiffness};
use crate::curve::Curve;
use crate::sections::Sections;

/// How the deformed part meets the rest at both ends of the influence range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Continuity {
    /// In position: zero moment there. The displacement starts with a visible crease, of slope 3 for a contour displaced
    /// by 1 in the middle of a range of length 1.
    Position,
    /// In position and tangent: the displacement starts and ends flat.
    #[default]
    PositionAndTangent,
}

/// How an influence range is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RangeBy {
    /// In metres along the stack, by the mean length of the columns.
    #[default]
    Distance,
    /// In sections: the number from the replaced one to the end of the range, rounded.
    Sections,
}

/// How a contour deforms a stack of sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossSectionOptions {
    /// Stiffness of the displacement.
    pub stiffness: Stiffness,
    /// How `before` and `after` are measured.
    pub range: RangeBy,
    /// Influence range before the replaced section, metres or sections along the stack; clipped to it.
    pub before: f64,
    /// Influence range after the replaced section, metres or sections along the stack; clipped to it.
    pub after: f64,
    /// How the deformed part meets the rest.
    pub continuity: Continuity,
    /// How points find theirs on the contour.
    pub matching: Matching,
}

impl Default for CrossSectionOptions {
    /// The thesis' stiffness, 20 cm before and after, tangents kept, points matched automatically.
    fn default() -> Self {
        Self {
            stiffness: Stiffness::default(),
            range: RangeBy::default(),
            before: 0.2,
            after: 0.2,
            continuity: Continuity::default(),
            matching: Matching::default(),
        }
    }
}

/// What a contour made of a stack of sections.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// The sections, with the rails of the original.
    pub sections: Sections,
    /// Section that the contour replaced, counted from 0.
    pub section: usize,
    /// First section of the influence range; it and all before it are as they were.
    pub first: usize,
    /// Last section of the influence range; it and all after it are as they were.
    pub last: usize,
    /// How far the point moved that moved farthest, metres.
    pub largest_move: f64,
    /// What was decided or adjusted on the way, one sentence each, for the artist.
    pub notes: Vec<String>,
}

/// What several contours made of a stack of sections.
#[derive(Clone, Debug, PartialEq)]
pub struct DeformedByAll {
    /// The sections, with the rails of the original.
    pub sections: Sections,
    /// What each contour replaced, in the order of the contours.
    pub replaced: Vec<Replaced>,
    /// How far the point moved that moved farthest, metres.
    pub largest_move: f64,
    /// What was decided or adjusted on the way, one sentence each, for the artist.
    pub notes: Vec<String>,
}

/// What a contour replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replaced {
    /// Its section, counted from 0.
    pub section: usize,
    /// First section of its influence range.
    pub first: usize,
    /// Last section of its influence range.
    pub last: usize,
}

/// Replaces the section closest to a closed contour by the contour, and lets the sections around it follow (thesis 5.5,
/// Figure 5.7).
///
/// The section whose centre is closest to that of the contour (both as centres of mass of their lines; neither border
/// section and no pole) is pinned to it. Each of its points goes to a point of the contour's polyline ([`Matching`]); it
/// does not matter where the contour starts, nor which way it runs. The displacement of each column solves the beam
/// equation over the sections of the range, `u` uniform from one to the next; as displacements are solved and not
/// positions, the sections keep their detail. The range ends at the last section within `before` and `after`
/// ([`RangeBy`]).
///
/// # Errors
/// [`CrossSectionError`] for an open contour or open sections, a range without a free section on each side of the
/// replaced one, a contour farther from every section than that section is large or turned by more than 60 degrees
/// against it, one that is not star-shaped where matching by angle was asked for, and where `progress`, called with
/// the fraction done, asked to stop.
pub fn deform_by_cross_section(
    sections: &Sections,
    contour: &Curve,
    options: &CrossSectionOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Deformed, CrossSectionError> {
    let made = deform_by_cross_sections(sections, std::slice::from_ref(contour), options, progress)?;
    let Replaced { section, first, last } = made.replaced[0];
    let DeformedByAll { sections, largest_move, notes, .. } = made;
    Ok(Deformed { sections, section, first, last, largest_move, notes })
}

/// Replaces several sections by closed contours at once, as [`deform_by_cross_section`] does by one.
///
/// Each contour finds its section in the stack as it was. Where influence ranges overlap, the sections between follow all
/// contours in them: one beam runs from the first to the last section of their ranges and is pinned at each. The order of
/// the contours does not matter.
///
/// # Errors
/// As [`deform_by_cross_section`], and for no contour, and for two contours closest to one section.
pub fn deform_by_cross_sections(
    sections: &Sections,
    contours: &[Curve],
    options: &CrossSectionOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<DeformedByAll, CrossSectionError> {
    if contours.is_empty() {
        return Err(CrossSectionError::NoContour);
    }
    let go_on = |done: usize, of: usize| match progress(done as f64 / of as f64) {
        true => Ok(()),
        false => Err(CrossSectionError::Cancelled),
    };
    let mut notes = Vec::new();
    go_on(0, 1)?;
    let mut replaced = Vec::with_capacity(contours.len());
    let mut targets = Vec::with_capacity(contours.len());
    for contour in contours {
        check(sections, contour, options)?;
        let section = find_section(sections, contour, &mut notes)?;
        go_on(0, 1)?;
        let (first, last) = range(sections, contour, section, options, &mut notes)?;
        go_on(0, 1)?;
        targets.push(matched(sections, contour, section, options.matching, &mut notes)?);
        replaced.push(Replaced { section, first, last });
    }
    let mut order: Vec<usize> = (0..contours.len()).collect();
    order.sort_by_key(|contour| replaced[*contour].section);
    if let Some(pair) = order.windows(2).find(|pair| replaced[pair[0]].section == replaced[pair[1]].section) {
        let (one, other) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        let name = |contour: usize| contours[contour].name().to_owned();
        let section = replaced[one].section;
        return Err(CrossSectionError::SameSection { one: name(one), other: name(other), section });
    }
    // Contours whose ranges overlap share a beam.
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut reach = 0;
    for contour in order {
        match groups.last_mut() {
            Some(group) if replaced[contour].first < reach => group.push(contour),
            _ => groups.push(vec![contour]),
        }
        reach = reach.max(replaced[contour].last);
    }
    let end = match options.continuity {
        Continuity::Position => EndCondition::Natural,
        Continuity::PositionAndTangent => EndCondition::Clamped,
    };
    let mut rows: Vec<Vec<DVec3>> = sections.iter().map(<[DVec3]>::to_vec).collect();
    let mut largest = 0.0_f64;
    let span = |group: &[usize]| {
        let first = group.iter().map(|contour| replaced[*contour].first).min().unwrap_or(0);
        (first, group.iter().map(|contour| replaced[*contour].last).max().unwrap_or(first))
    };
    let steps: usize = groups.iter().map(|group| (span(group).1 - span(group).0 + 1) * group.len()).sum();
    let mut done = 0;
    for group in groups {
        let (first, last) = span(&group);
        let pins: Vec<usize> = group.iter().map(|contour| replaced[*contour].section - first).collect();
        let beam = OpenBeam::new(last - first + 1, &pins, end, end, options.stiffness)?;
        for (place, contour) in group.iter().enumerate() {
            // All columns share one solution, that for a displacement of 1.
            let mut unit = vec![0.0; pins.len()];
            unit[place] = 1.0;
            let shares = beam.solve(&OpenValues { pins: &unit, ..OpenValues::ends(0.0, 0.0) })?;
            let from = sections.section(replaced[*contour].section);
            for (row, share) in rows[first..=last].iter_mut().zip(&shares) {
                go_on(done, steps)?;
                done += 1;
                for ((point, target), from) in row.iter_mut().zip(&targets[*contour]).zip(from) {
                    *point += (*target - *from) * *share;
                }
            }
        }
        for fixed in [first, last] {
            rows[fixed].copy_from_slice(sections.section(fixed));
        }
        for contour in &group {
            rows[replaced[*contour].section].clone_from(&targets[*contour]);
        }
    }
    for (row, section) in rows.iter().zip(sections.iter()) {
        let moves = row.iter().zip(section).map(|(to, from)| to.distance(*from));
        largest = largest.max(moves.fold(0.0, f64::max));
    }
    let deformed = Sections::new(rows, true, sections.rails().to_vec())?;
    Ok(DeformedByAll { sections: deformed, replaced, largest_move: largest, notes })
}

fn check(sections: &Sections, contour: &Curve, options: &CrossSectionOptions) -> Result<(), CrossSectionError> {
    if !contour.is_closed() {
        return Err(CrossSectionError::ContourIsOpen { contour: contour.name().to_owned() });
    }
    if !sections.is_closed() {
        return Err(CrossSectionError::SectionsAreOpen);
    }
    if sections.len() < 5 {
        return Err(CrossSectionError::TooFewSections { found: sections.len() });
    }
    for (which, reach) in [("before", options.before), ("after", options.after)] {
        if !(reach.is_finite() && reach >= 0.0) {
            return Err(CrossSectionError::Reach { which, reach });
        }
    }
    Ok(())
}

/// The section as a curve, or none for a pole.
fn ring_of(sections: &Sections, section: usize) -> Option<Curve> {
    if sections.is_pole(section) {
        return None;
    }
    Curve::new("", sections.section(section).to_vec(), true).ok()
}

fn find_section(sections: &Sections, contour: &Curve, notes: &mut Vec<String>) -> Result<usize, CrossSectionError> {
    let centre = centroid(contour.points());
    let distance = |section: usize| centroid(sections.section(section)).distance(centre);
    let last = sections.len() - 1;
    let mut nearest: Vec<(usize, f64)> = (1..last).map(|section| (section, distance(section))).collect();
    nearest.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Poles are looked for in the order of distances: each time all points are measured.
    let found = nearest.into_iter().find(|(section, apart)| apart.is_finite() && !sections.is_pole(*section));
    let (section, apart) = found.unwrap_or((1, f64::INFINITY));
    let name = || contour.name().to_owned();
    let Some(ring) = ring_of(sections, section) else {
        return Err(CrossSectionError::SectionIsFlat { section, contour: name() });
    };
    let (low, high) = ring.bounds();
    let size = (high - low).length();
    if apart.is_nan() || apart > size {
        return Err(CrossSectionError::TooFar { contour: name(), distance: apart, section, size });
    }
    for border in [0, last] {
        if distance(border) < apart {
            notes.push(format!(
                "Contour \"{}\" is closest to border section {border}, which stays as it is: section {section} is \
                 replaced instead.",
                contour.name()
            ));
        }
    }
    Ok(section)
}

/// First and last section of the influence range.
fn range(
    sections: &Sections,
    contour: &Curve,
    section: usize,
    options: &CrossSectionOptions,
    notes: &mut Vec<String>,
) -> Result<(usize, usize), CrossSectionError> {
    let end = sections.len() - 1;
    for (border, room) in [("first", section), ("last", end - section)] {
        if room < 2 {
            return Err(CrossSectionError::NoRoom { contour: contour.name().to_owned(), section, border });
        }
    }
    let mut heights = vec![0.0];
    if options.range == RangeBy::Sections {
        heights = (0..=end).map(|k| k as f64).collect();
    }
    for k in heights.len()..=end {
        let steps = sections.section(k).iter().zip(sections.section(k - 1));
        let step = steps.map(|(p, q)| p.distance(*q)).sum::<f64>() / sections.nodes() as f64;
        heights.push(heights[k - 1] + step);
    }
    let apart = |k: usize| (heights[k] - heights[section]).abs();
    // A reach given as the exact distance of a section includes it in spite of rounding.
    let within = |k: usize, reach: f64| match options.range {
        RangeBy::Distance => apart(k) <= reach * (1.0 + 1e-9),
        RangeBy::Sections => apart(k) <= reach.round(),
    };
    let first = (0..section).find(|k| within(*k, options.before)).unwrap_or(section);
    let last = (section + 1..=end).rfind(|k| within(*k, options.after)).unwrap_or(section);
    for (which, room, second) in [("before", section - first, section - 2), ("after", last - section, section + 2)] {
        if room < 2 {
            let needed = apart(second);
            return Err(match options.range {
                RangeBy::Distance => CrossSectionError::RangeTooSmall { which, section, needed },
                RangeBy::Sections => CrossSectionError::TooFewInRange { which, section },
            });
        }
    }
    let unit = match options.range {
        RangeBy::Distance => "m",
        RangeBy::Sections => "sections",
    };
    for (which, border, reach) in [("before", 0, options.before), ("after", end, options.after)] {
        if apart(border) < reach * (1.0 - 1e-9) {
            notes.push(format!(
                "The influence range {which} section {section} is {reach} {unit}, but the stack ends after {} {unit}: it is \
                 cut off there.",
                (apart(border) * 1e4).round() / 1e4
            ));
        }
    }
    Ok((first, last))
}

/// The point of the contour for each point of the section.
fn matched(
    sections: &Sections,
    contour: &Curve,
    section: usize,
    matching: Matching,
    notes: &mut Vec<String>,
) -> Result<Vec<DVec3>, CrossSectionError> {
    let name = || contour.name().to_owned();
    let flat = || CrossSectionError::SectionIsFlat { section, contour: name() };
    let ring = ring_of(sections, section).ok_or_else(flat)?;
    let normal = unit_normal(&ring).ok_or_else(flat)?;
    let own = unit_normal(contour).ok_or_else(|| CrossSectionError::ContourIsFlat { contour: name() })?;
    let degrees = own.dot(normal).abs().min(1.0).acos().to_degrees();
    if degrees > 60.0 {
        return Err(CrossSectionError::Turned { contour: name(), degrees, section });
    }
    let turned = (own.dot(normal) < 0.0).then(|| contour.clone().reversed());
    let about = if turned.is_some() { -own } else { own };
    let about = Ring::new(turned.as_ref().unwrap_or(contour), about);
    let points = sections.section(section);
    let culprit = match matching {
        Matching::ArcLength => return Ok(about.by_arc_length(points)),
        Matching::Auto | Matching::Angle => match about.by_angle(points) {
            Ok(targets) => return Ok(targets),
            Err(Culprit::Contour) => format!("contour \"{}\"", contour.name()),
            Err(Culprit::Section) => format!("section {section}"),
        },
    };
    if matching == Matching::Angle {
        return Err(CrossSectionError::NotStarShaped { what: culprit });
    }
    notes.push(format!(
        "Points are matched by arc length, as {culprit} is not star-shaped about the centre of the contour."
    ));
    Ok(about.by_arc_length(points))
}

/// Direction about which a closed curve runs counter-clockwise, or none where it encloses no area.
fn unit_normal(curve: &Curve) -> Option<DVec3> {
    let (low, high) = curve.bounds();
    let area = curve.area_vector();
    (area.length() > 1e-9 * (high - low).length_squared()).then(|| area.normalize())
}
