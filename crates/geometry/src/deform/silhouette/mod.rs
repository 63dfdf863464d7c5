//! Deforming a stack of sections until its silhouettes are those sketched (thesis 5.1-5.5, paper 4).
//!
//! Each section is a closed beam that is pinned where the silhouettes of the views touch it; what is
//! solved for is the displacement, so that the section keeps its own shape. In a view only the coordinates that are seen
//! there are displaced: the one across the stack by the two pins of that view, and the one along it by the pins of all
//! views. A second view therefore moves the pins of the first only along the first one's direction of sight, whether both
//! are given at once or one after the other, and both silhouettes are exact.

mod columns;
mod deformed;
mod error;
mod outline;
pub(crate) mod pair;
#[cfg(test)]
mod properties;
mod ring;
mod spacing;
#[cfg(test)]
mod tests;
pub(crate) mod track;

use glam::{DVec2, DVec3};

pub use deformed::{SilhouetteDeformed, ViewFit};
pub use error::{SilhouetteError, StrokesError};
pub use pair::Silhouette;
pub use ring::Contact;
pub use spacing::SectionSpacing;
pub use track::StrokeMatching;

use self::columns::Columns;
use self::deformed::{Fits, NOTICED};
use self::error::names;
use self::pair::Pair;
use self::ring::Ring;
use self::track::Track;
use crate::beam::Stiffness;
use crate::sections::Sections;
use crate::view::View;

/// How silhouettes deform a stack of sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SilhouetteOptions {
    /// Stiffness of the displacement.
    pub stiffness: Stiffness,
    /// How points of the strokes find theirs on the stack.
    pub matching: StrokeMatching,
    /// How sections touch the strokes.
    pub contact: Contact,
    /// Whether, with strokes of one view, the rails of the sections keep their place along the stack, so that silhouettes
    /// of an earlier view stay exact. Rails on the pinned sides follow the strokes.
    pub hold_rails: bool,
    /// Where sections stand along the stack. Does nothing where a view looks along it.
    pub spacing: SectionSpacing,
}

impl Default for SilhouetteOptions {
    /// The thesis' stiffness, matching by arc length, tangent contact, rails held.
    fn default() -> Self {
        Self {
            stiffness: Stiffness::default(),
            matching: StrokeMatching::default(),
            contact: Contact::default(),
            hold_rails: true,
            spacing: SectionSpacing::default(),
        }
    }
}

/// Size of what counts as one point, in the diagonal of the sketch.
const ONE_POINT: f64 = 1e-9;

/// Deforms a closed stack of sections until its silhouettes in one view, or in two views at right angles, pass through
/// the strokes (thesis 5.5).
///
/// - **Columns.** The points of the sections farthest out on the left and on the right of the stack's axis, as seen in
///   the view, over the whole stack, are those that follow the strokes; they are the rails of the result.
/// - **Matching.** Point `k` of a column goes to the point of its stroke at the same share of the way
///   ([`StrokeMatching`]), to 1e-12 of the sketch. Where the stack is placed along the strokes this holds for bent limbs
///   and for strokes that fold back as well.
/// - **Displacement.** Each section is a closed beam; what is solved for is the displacement, so that it keeps its own
///   shape. Across the stack the pins of a view move it, along the stack those of all views, and along the line of sight
///   nothing does: a second view leaves the first exact, at once or later. A section all of whose targets coincide becomes
///   a pole.
/// - **A view along the stack.** One closed outline in a view that looks along the stack is what the largest section
///   becomes; the others follow by the beam along the stack, as with [`super::deform_by_cross_section`].
///
/// Sections that shrink below a fifth of their width may stand out beyond their pins by some 0.2 % of their former width;
/// [`ViewFit::overshoot`] says by how much. What strokes do between neighbouring sections is lost, and
/// [`ViewFit::gap`] says how much; [`SectionSpacing::ByDetail`] adds the sections that it takes. There are warnings from
/// 0.05 % of the sketch's diagonal on.
///
/// # Errors
/// [`SilhouetteError`] for views that are not at right angles, strokes that are no pair or do not fit the view, a stack
/// that is elsewhere or is open, and where `progress`, called with the fraction done, asked to stop.
pub fn deform_to_silhouette(
    sections: &Sections,
    silhouettes: &[Silhouette<'_>],
    options: &SilhouetteOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<SilhouetteDeformed, SilhouetteError> {
    let views: Vec<View> = silhouettes.iter().map(|silhouette| silhouette.view).collect();
    if !sections.is_closed() {
        return Err(SilhouetteError::SectionsAreOpen);
    }
    if let Some(end_on) = views.iter().find(|view| columns::end_on(sections, **view)) {
        let [only] = silhouettes else {
            return Err(SilhouetteError::OutlineNeeded { view: end_on.name() });
        };
        return outline::deform(sections, only, options, progress);
    }
    let deformer = SilhouetteDeformer::new(sections, &views, options)?;
    let SectionSpacing::ByDetail(tolerance) = options.spacing else { return deformer.deform(silhouettes, progress) };
    let stack = deformer.by_detail(silhouettes, tolerance, &|done| progress(0.3 * done))?;
    // What the tolerance allows is not warned of.
    let spaced = SilhouetteDeformer { gap_allowed: tolerance.max(NOTICED), ..deformer.on(&stack)? };
    spaced.deform(silhouettes, &|done| progress(0.3 + 0.7 * done))
}

/// A stack of sections made ready for silhouettes of given views: beams are factored and columns found once, so that
/// dragging a stroke costs one small matrix product a section.
#[derive(Clone, Debug)]
pub struct SilhouetteDeformer<'a> {
    sections: &'a Sections,
    views: Vec<Prepared>,
    components: Vec<Component>,
    matching: StrokeMatching,
    along: DVec3,
    gap_allowed: f64,
}

/// A view of the stack.
#[derive(Clone, Debug)]
struct Prepared {
    view: View,
    /// The columns on the left and on the right.
    columns: [usize; 2],
    /// Share of the way of each section, on both columns.
    shares: [Vec<f64>; 2],
    /// Lowest and highest corner of the stack as seen.
    bounds: [DVec2; 2],
}

/// The strokes of all views, checked.
struct Drawn {
    /// In each view that on the left and that on the right.
    tracks: Vec<[Track; 2]>,
    /// Diagonal of the box around the strokes of a view, the larger of both, metres.
    diagonal: f64,
}

/// A pinned column, and the view and side of the stroke that moves it, or none where it is held.
type Pin = (usize, Option<(usize, usize)>);

/// A direction in which points are displaced.
#[derive(Clone, Debug)]
struct Component {
    axis: DVec3,
    ring: Ring,
    columns: Vec<usize>,
    /// What moves each pin: a side of a view, or nothing.
    pins: Vec<Option<(usize, usize)>>,
}

impl<'a> SilhouetteDeformer<'a> {
    /// Prepares a closed stack for silhouettes of these views, in this order.
    ///
    /// # Errors
    /// [`SilhouetteError`] as [`deform_to_silhouette`], as far as it does not need the strokes.
    pub fn new(sections: &'a Sections, views: &[View], options: &SilhouetteOptions) -> Result<Self, SilhouetteError> {
        if !sections.is_closed() {
            return Err(SilhouetteError::SectionsAreOpen);
        }
        let along = along(sections, views)?;
        let columns = Columns::of(sections);
        let mut prepared = Vec::with_capacity(views.len());
        for view in views {
            if columns::end_on(sections, *view) {
                return Err(SilhouetteError::EndOn { view: view.name() });
            }
            let sides = columns.sides(*view).ok_or(SilhouetteError::EndOn { view: view.name() })?;
            let shares = shares(sections, *view, sides, options.matching, along)?;
            let bounds = sections
                .points()
                .iter()
                .map(|p| view.flat(*p))
                .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
            prepared.push(Prepared { view: *view, columns: sides, shares, bounds });
        }
        let nodes = sections.nodes();
        let pinned: Vec<Pin> = prepared
            .iter()
            .enumerate()
            .flat_map(|(view, p)| [0, 1].map(|side| (p.columns[side], Some((view, side)))))
            .collect();
        let different = |pins: &[Pin]| {
            let mut columns: Vec<usize> = pins.iter().map(|pin| pin.0).collect();
            columns.sort_unstable();
            columns.windows(2).all(|pair| pair[0] < pair[1])
        };
        if !different(&pinned) {
            return Err(SilhouetteError::NoSides { nodes });
        }
        let component = |axis: DVec3, pins: &[Pin]| {
            let columns: Vec<usize> = pins.iter().map(|pin| pin.0).collect();
            let ring = Ring::new(nodes, &columns, options.contact, options.stiffness)?;
            Ok::<_, SilhouetteError>(Component { axis, ring, columns, pins: pins.iter().map(|pin| pin.1).collect() })
        };
        let mut components = Vec::with_capacity(3);
        for (view, pair) in views.iter().zip(pinned.chunks_exact(2)) {
            components.push(component(view.depth().cross(along), pair)?);
        }
        let mut all = pinned.clone();
        if views.len() == 1 && options.hold_rails {
            let mut held = sections.rails().to_vec();
            held.sort_unstable();
            held.dedup();
            held.retain(|rail| pinned.iter().all(|pin| pin.0 != *rail));
            all.extend(held.into_iter().map(|rail| (rail, None)));
        }
        if options.contact == Contact::Tangent {
            all = level_beside(&all, nodes);
        }
        components.push(component(along, &all)?);
        Ok(Self { sections, views: prepared, components, matching: options.matching, along, gap_allowed: NOTICED })
    }

    /// The same for another stack of as many points a section that stands where this one does.
    fn on<'b>(&self, sections: &'b Sections) -> Result<SilhouetteDeformer<'b>, SilhouetteError> {
        let mut views = self.views.clone();
        for prepared in &mut views {
            prepared.shares = shares(sections, prepared.view, prepared.columns, self.matching, self.along)?;
        }
        let components = self.components.clone();
        let Self { matching, along, gap_allowed, .. } = *self;
        Ok(SilhouetteDeformer { sections, views, components, matching, along, gap_allowed })
    }

    /// The sections with these silhouettes, one of each view prepared for, in that order. They are as many as given,
    /// whatever [`SilhouetteOptions::spacing`] says.
    ///
    /// # Errors
    /// [`SilhouetteError`] as [`deform_to_silhouette`].
    pub fn deform(
        &self,
        silhouettes: &[Silhouette<'_>],
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<SilhouetteDeformed, SilhouetteError> {
        let go_on = |done: usize, of: usize| match progress(done as f64 / of as f64) {
            true => Ok(()),
            false => Err(SilhouetteError::Cancelled),
        };
        go_on(0, 1)?;
        let drawn = self.drawn(silhouettes)?;
        let Drawn { tracks, diagonal } = &drawn;
        let stack = self.sections;
        let mut fits = Fits::new(self.views.iter().map(|view| (view.view, view.columns)).collect(), *diagonal);
        fits.gap_allowed = self.gap_allowed;
        fits.gaps(&self.off_chords(&drawn));
        let mut rows = Vec::with_capacity(stack.len());
        for (k, section) in stack.iter().enumerate() {
            go_on(k, stack.len())?;
            let targets: Vec<[DVec2; 2]> = self
                .views
                .iter()
                .zip(tracks)
                .map(|(view, tracks)| [0, 1].map(|side| tracks[side].at(view.shares[side][k])))
                .collect();
            let row = self.section(k, section, &targets, *diagonal, &mut fits)?;
            fits.section(k, section, &row, &targets);
            rows.push(row);
        }
        let mut rails: Vec<usize> = self.views.iter().flat_map(|view| view.columns).collect();
        if self.views.len() == 1 {
            rails.extend(stack.rails());
        }
        rails.sort_unstable();
        rails.dedup();
        go_on(1, 1)?;
        let sections = Sections::new(rows, true, rails)?;
        Ok(fits.finish(sections))
    }

    /// Both strokes of each view, checked, and the larger diagonal.
    fn drawn(&self, silhouettes: &[Silhouette<'_>]) -> Result<Drawn, SilhouetteError> {
        if silhouettes.len() != self.views.len()
            || silhouettes.iter().zip(&self.views).any(|(silhouette, view)| silhouette.view != view.view)
        {
            return Err(StrokesError::Views { found: silhouettes.len() }.into());
        }
        let stack = self.sections;
        let (from, to) = (stack.centre(0), stack.centre(stack.len() - 1));
        let mut tracks = Vec::with_capacity(self.views.len());
        let mut diagonal = 0.0_f64;
        for (silhouette, prepared) in silhouettes.iter().zip(&self.views) {
            let pair = Pair::new(silhouette, from, to)?;
            prepared.check_overlap(&pair, silhouette)?;
            let [left, right] = pair.sides.each_ref().map(|side| {
                Track::new(side, self.matching, prepared.view.flat(self.along)).ok_or_else(|| SilhouetteError::Level {
                    view: prepared.view.name(),
                    strokes: names(silhouette.strokes),
                })
            });
            tracks.push([left?, right?]);
            diagonal = diagonal.max(pair.diagonal);
        }
        Ok(Drawn { tracks, diagonal })
    }

    /// One section moved to its targets, a pair in each view.
    fn section(
        &self,
        index: usize,
        section: &[DVec3],
        targets: &[[DVec2; 2]],
        diagonal: f64,
        fits: &mut Fits,
    ) -> Result<Vec<DVec3>, SilhouetteError> {
        let one_point = targets.iter().all(|pair| pair[0].distance(pair[1]) <= ONE_POINT * diagonal);
        if one_point && (self.views.len() == 2 || self.sections.is_pole(index)) {
            return Ok(vec![self.tip(section[0], targets, fits); section.len()]);
        }
        let wanted = |column: usize, view: usize, side: usize| {
            let view_of = self.views[view].view;
            view_of.lift(targets[view][side] - view_of.flat(section[column]))
        };
        let mut row = section.to_vec();
        for component in &self.components {
            let pins = || component.columns.iter().zip(&component.pins);
            let values: Vec<f64> = pins()
                .map(|(column, pin)| pin.map_or(0.0, |(view, side)| wanted(*column, view, side).dot(component.axis)))
                .collect();
            // What the section still runs to the side of the direction of sight at the pins; held ones stay as they are.
            let slope = |column: usize| {
                let next = section[(column + 1) % section.len()];
                let before = section[(column + section.len() - 1) % section.len()];
                (before - next).dot(component.axis) / 2.0
            };
            let slopes: Vec<f64> = pins().map(|(column, pin)| pin.map_or(0.0, |_| slope(*column))).collect();
            for (point, moved) in row.iter_mut().zip(component.ring.solve(&values, &slopes)?) {
                *point += component.axis * moved;
            }
        }
        Ok(row)
    }

    /// The point that a section becomes whose targets coincide in each view: seen where they are, and half way between
    /// where two views put it along the stack.
    fn tip(&self, from: DVec3, targets: &[[DVec2; 2]], fits: &mut Fits) -> DVec3 {
        let mut tip = from;
        let mut heights = Vec::with_capacity(2);
        for (prepared, pair) in self.views.iter().zip(targets) {
            let moved = prepared.view.lift(pair[0] - prepared.view.flat(from));
            let height = moved.dot(self.along);
            heights.push(height);
            tip += moved - self.along * height;
        }
        if let [one, other] = heights[..] {
            fits.tip_gap = fits.tip_gap.max((one - other).abs());
        }
        tip + self.along * (heights.iter().sum::<f64>() / heights.len() as f64)
    }
}

impl Prepared {
    fn check_overlap(&self, pair: &Pair, silhouette: &Silhouette<'_>) -> Result<(), SilhouetteError> {
        let [low, high] = self.bounds;
        let points = pair.sides.iter().flatten();
        let (from, to) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        let distance = (from - high).max(low - to).max(DVec2::ZERO).length();
        if distance > 0.0 {
            let strokes = names(silhouette.strokes);
            return Err(SilhouetteError::Apart { view: self.view.name(), strokes, distance });
        }
        Ok(())
    }
}

/// Share of the way of each section on both columns.
fn shares(
    sections: &Sections,
    view: View,
    columns: [usize; 2],
    matching: StrokeMatching,
    along: DVec3,
) -> Result<[Vec<f64>; 2], SilhouetteError> {
    let [left, right] = columns.map(|column| {
        let line: Vec<DVec2> = sections.iter().map(|section| view.flat(section[column])).collect();
        let track = Track::new(&line, matching, view.flat(along)).ok_or(SilhouetteError::EndOn { view: view.name() });
        track.map(|track| track.given().collect())
    });
    Ok([left?, right?])
}

/// Share of the way around a section on each side of a pin on which a section that touches a stroke stays level, so that
/// it does not fill the notches of a stroke, such as those between lips, where the other pins are higher or lower.
const LEVEL: f64 = 1.0 / 20.0;

/// Pins along the stack with the points beside each, which do as it does. There are fewer where pins are close.
fn level_beside(pins: &[Pin], nodes: usize) -> Vec<Pin> {
    let mut columns: Vec<usize> = pins.iter().map(|pin| pin.0).collect();
    columns.sort_unstable();
    let next = columns.iter().cycle().skip(1);
    let gaps = columns.iter().zip(next).map(|(one, other)| (other + nodes - one - 1) % nodes + 1);
    let reach = ((LEVEL * nodes as f64) as usize).min(gaps.min().unwrap_or(nodes).saturating_sub(1) / 4);
    let beside = |column: usize| (0..=2 * reach).map(move |d| (column + nodes + d - reach) % nodes);
    pins.iter().flat_map(|(column, pin)| beside(*column).map(|column| (column, *pin))).collect()
}

/// The axis along the stack that is seen in all views: across both directions of sight, or, of one view, the axis of the
/// picture that is closest to the stack's.
fn along(sections: &Sections, views: &[View]) -> Result<DVec3, StrokesError> {
    if let [view] = views {
        let chord = sections.centre(sections.len() - 1) - sections.centre(0);
        return Ok(nearest_axis(*view, view.flat(chord)));
    }
    common_axis(views)
}

/// The axis of the picture, right or up, that is closest to a direction in it.
pub(crate) fn nearest_axis(view: View, direction: DVec2) -> DVec3 {
    if direction.x.abs() > direction.y.abs() { view.right() } else { view.up() }
}

/// The axis that is seen in full in both of two views.
pub(crate) fn common_axis(views: &[View]) -> Result<DVec3, StrokesError> {
    let [one, other] = views else { return Err(StrokesError::Views { found: views.len() }) };
    let cosine = one.depth().dot(other.depth());
    if cosine.abs() > 1e-6 {
        return Err(StrokesError::NotSquare {
            one: one.name(),
            other: other.name(),
            degrees: cosine.abs().min(1.0).acos().to_degrees(),
        });
    }
    Ok(one.depth().cross(other.depth()).normalize_or_zero())
}
