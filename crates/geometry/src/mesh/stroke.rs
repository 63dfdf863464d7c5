//! Strokes drawn over a mesh in a view: projected onto it, or cut into it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::cut::{Line, cut};
use super::distance::NoPolygons;
use super::{Mesh, MeshError, MeshRays, measure};
use crate::curve::{ArcLength, Curve, CurveError};
use crate::polygon::Inside;

/// Which of the sides of a mesh that lie behind one another in a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// The one that is seen.
    #[default]
    Seen,
    /// The farthest one: the back of the body.
    Back,
}

/// What remains of a mesh that is cut along a closed stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// What lies outside of the stroke: a hole is cut.
    #[default]
    Outside,
    /// What lies inside of it: a piece is cut out.
    Inside,
}

/// Why a stroke can't be drawn on a mesh or cut into it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StrokeError {
    /// A mesh without polygons.
    #[error(transparent)]
    Empty(#[from] NoPolygons),
    /// A view direction of no length, or one that is no number.
    #[error("the direction of view {direction} is none: give one that is not zero")]
    NoDirection {
        /// The direction as given.
        direction: DVec3,
    },
    /// A point of a stroke behind which there is no mesh.
    #[error(
        "stroke \"{stroke}\" leaves the mesh {share:.0} % along, at {at}: draw inside of the mesh's outline, or look from \
         another side"
    )]
    OffTheMesh {
        /// Name of the stroke.
        stroke: String,
        /// How far along, percent of its length.
        share: f64,
        /// The point drawn, metres.
        at: DVec3,
    },
    /// An open stroke where a loop is needed.
    #[error("stroke \"{stroke}\" is open: close it, so that it has an inside to cut")]
    Open {
        /// Name of the stroke.
        stroke: String,
    },
    /// No vertex inside the stroke.
    #[error(
        "no vertex of the mesh lies inside of stroke \"{stroke}\": draw it over the mesh, or larger, or make the mesh finer"
    )]
    NothingInside {
        /// Name of the stroke.
        stroke: String,
    },
    /// All vertices inside the stroke, so that a hole would leave nothing.
    #[error("all of the mesh lies inside of stroke \"{stroke}\": draw it smaller")]
    NothingOutside {
        /// Name of the stroke.
        stroke: String,
    },
    /// A projected stroke that is no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// A cut mesh that is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Lays a stroke onto a mesh along the direction of view, exact at each point: on its own points, and between them so
/// that no two are farther apart than `spacing` metres (0 for its own points only). Where the mesh is stepped in depth,
/// so is the curve.
///
/// # Errors
/// [`StrokeError`] where there is no mesh behind a point, naming the first.
pub fn draw_on(
    mesh: &Mesh,
    stroke: &Curve,
    direction: DVec3,
    facing: Facing,
    spacing: f64,
) -> Result<Curve, StrokeError> {
    let direction = unit(direction)?;
    let under = Under::new(stroke, direction);
    let rays = under.rays(mesh)?;
    let arc = ArcLength::of(stroke);
    let mut stations: Vec<f64> = Vec::new();
    for segment in 0..stroke.segment_count() {
        let (a, b) = stroke.segment(segment);
        let parts = if spacing > 0.0 { (a.distance(b) / spacing).ceil().clamp(1.0, 4096.0) } else { 1.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 4096")]
        let parts = parts as usize;
        let start = arc.cumulative()[segment];
        stations.extend((0..parts).map(|k| start + a.distance(b) * k as f64 / parts as f64));
    }
    if !stroke.is_closed() {
        stations.push(arc.length());
    }
    let reach = behind(mesh, stroke);
    let mut points = Vec::with_capacity(stations.len());
    for s in stations {
        let at = arc.point_at(s);
        let from = at - reach * direction;
        let hit = rays.as_ref().and_then(|rays| match facing {
            Facing::Seen => rays.first(from, direction),
            Facing::Back => rays.last(from, direction),
        });
        let share = 100.0 * s / arc.length().max(f64::MIN_POSITIVE);
        let hit = hit.ok_or_else(|| StrokeError::OffTheMesh { stroke: stroke.name().to_owned(), share, at })?;
        points.push(hit.point);
    }
    Ok(Curve::new(stroke.name(), points, stroke.is_closed())?)
}

/// Cuts a mesh along a closed stroke drawn in a view. The border runs through the stroke wherever that crosses a side of
/// a polygon, bent as the mesh's normals tell, and straight between: a finer mesh follows it more closely.
///
/// With `through`, all sides that lie behind one another are cut; otherwise, of the pieces that the stroke encloses,
/// the one most of whose vertices are seen.
///
/// # Errors
/// [`StrokeError`] where the stroke is open, or nothing lies inside it, or all.
pub fn cut_along(
    mesh: &Mesh,
    stroke: &Curve,
    direction: DVec3,
    keep: Keep,
    through: bool,
) -> Result<Mesh, StrokeError> {
    let direction = unit(direction)?;
    let under = Under::new(stroke, direction);
    if mesh.polygon_count() == 0 {
        return Err(NoPolygons.into());
    }
    let name = || stroke.name().to_owned();
    if !stroke.is_closed() {
        return Err(StrokeError::Open { stroke: name() });
    }
    let mut inside: Vec<bool> = mesh.positions().iter().map(|p| under.encloses(*p)).collect();
    if !inside.contains(&true) {
        return Err(StrokeError::NothingInside { stroke: name() });
    }
    if !through {
        seen_only(mesh, &under, direction, behind(mesh, stroke), &mut inside)?;
    }
    if keep == Keep::Outside && !inside.contains(&false) {
        return Err(StrokeError::NothingOutside { stroke: name() });
    }
    let kept = |within: bool| within == (keep == Keep::Inside);
    // The sign alone counts; where along a side the cut is, the outline tells.
    let size = measure::diagonal(mesh).max(f64::MIN_POSITIVE);
    let heights: Vec<f64> = inside.iter().map(|within| if kept(*within) { size } else { -size }).collect();
    Ok(cut(mesh, &heights, Line::Within(&|p| kept(under.encloses(p))))?)
}

/// A stroke as it is seen along a direction, and what lies under it.
pub(super) struct Under {
    outline: Inside,
    axes: [DVec3; 2],
}

impl Under {
    pub(super) fn new(stroke: &Curve, direction: DVec3) -> Self {
        let axes: [DVec3; 2] = direction.any_orthonormal_pair().into();
        let outline: Vec<DVec2> = stroke.points().iter().map(|p| flat(axes, *p)).collect();
        Self { outline: Inside::new(&outline), axes }
    }

    /// Even-odd rule.
    pub(super) fn encloses(&self, point: DVec3) -> bool {
        self.outline.encloses(flat(self.axes, point))
    }

    /// The part of a mesh that rays through the stroke and what it encloses can meet; `None` where there is none.
    pub(super) fn rays(&self, mesh: &Mesh) -> Result<Option<MeshRays>, NoPolygons> {
        if mesh.polygon_count() == 0 {
            return Err(NoPolygons);
        }
        // What only touches the box may be met too, by rounding.
        let (low, high) = self.outline.bounds();
        let margin = DVec2::splat(1e-9 * (measure::diagonal(mesh) + low.distance(high)));
        let (low, high) = (low - margin, high + margin);
        Ok(MeshRays::among(mesh, |points| {
            let [a, b, c] = points.map(|p| flat(self.axes, p));
            a.max(b).max(c).cmpge(low).all() && a.min(b).min(c).cmple(high).all()
        }))
    }
}

fn flat([e1, e2]: [DVec3; 2], p: DVec3) -> DVec2 {
    DVec2::new(p.dot(e1), p.dot(e2))
}

fn unit(direction: DVec3) -> Result<DVec3, StrokeError> {
    direction.try_normalize().ok_or(StrokeError::NoDirection { direction })
}

/// How far before a stroke's points rays have to begin to be before the mesh.
pub(super) fn behind(mesh: &Mesh, stroke: &Curve) -> f64 {
    let Some((low, high)) = measure::bounds(mesh) else { return 0.0 };
    let (from, to) = stroke.bounds();
    2.0 * (low.min(from).distance(high.max(to)) + f64::MIN_POSITIVE)
}

/// Whether no polygon lies between a point of a mesh and the eye, `reach` before it.
pub(super) fn is_seen(rays: &MeshRays, point: DVec3, direction: DVec3, reach: f64) -> bool {
    // What hides it lies farther before it than rounding puts its own polygons.
    let tolerance = 1e-6 * reach;
    !rays.any_within(point - reach * direction, direction, reach - tolerance)
}

/// Of the pieces inside, leaves the one of which most vertices are seen.
fn seen_only(mesh: &Mesh, under: &Under, direction: DVec3, reach: f64, inside: &mut [bool]) -> Result<(), NoPolygons> {
    // Pieces by union of the vertices of each polygon that are inside.
    let mut parent: Vec<u32> = (0..).take(inside.len()).collect();
    fn root(parent: &mut [u32], mut at: u32) -> u32 {
        while parent[at as usize] != at {
            parent[at as usize] = parent[parent[at as usize] as usize];
            at = parent[at as usize];
        }
        at
    }
    for corners in mesh.polygons() {
        let mut within = corners.iter().filter(|vertex| inside[**vertex as usize]);
        let Some(first) = within.next() else { continue };
        for other in within {
            let (a, b) = (root(&mut parent, *first), root(&mut parent, *other));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut pieces: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for vertex in (0..).take(inside.len()).filter(|vertex| inside[*vertex as usize]) {
        pieces.entry(root(&mut parent, vertex)).or_default().push(vertex);
    }
    if pieces.len() < 2 {
        return Ok(());
    }
    let Some(rays) = under.rays(mesh)? else { return Ok(()) };
    let seen = |vertex: &&u32| is_seen(&rays, mesh.positions()[**vertex as usize], direction, reach);
    let most =
        |(piece, vertices): &(&u32, &Vec<u32>)| (vertices.iter().filter(seen).count(), std::cmp::Reverse(**piece));
    let best = pieces.iter().max_by_key(most).map(|(piece, _)| *piece);
    for (_, vertices) in pieces.iter().filter(|(piece, _)| Some(**piece) != best) {
        vertices.iter().for_each(|vertex| inside[*vertex as usize] = false);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::check;
    use crate::sections::Sections;
    use crate::surface::{SkinOptions, skin};
    use std::f64::consts::{PI, TAU};

    /// A sphere of radius 1 about the origin, its poles on z.
    fn sphere() -> Mesh {
        let ring = |k: u32| {
            let t = PI * f64::from(k) / 48.0 - PI / 2.0;
            let point = |i: u32| {
                let a = TAU * f64::from(i) / 96.0;
                DVec3::new(t.cos() * a.cos(), t.cos() * a.sin(), t.sin())
            };
            if k == 0 || k == 48 { vec![DVec3::Z * t.sin(); 96] } else { (0..96).map(point).collect() }
        };
        let sections = Sections::new((0..=48).map(ring).collect(), true, vec![]).unwrap();
        skin(&sections, &SkinOptions { rows: 1, ..SkinOptions::default() }, &|_| true).unwrap()
    }

    fn circle(radius: f64, y: f64) -> Curve {
        let point = |k: u32| TAU * f64::from(k) / 60.0;
        let points = (0..60).map(point).map(|a| DVec3::new(radius * a.cos(), y, radius * a.sin())).collect();
        Curve::new("circle", points, true).unwrap()
    }

    #[test]
    fn a_stroke_lies_on_the_side_that_is_seen_or_on_the_back() {
        let stroke = Curve::new("line", vec![DVec3::new(-0.5, 3.0, 0.1), DVec3::new(0.5, 3.0, 0.1)], false).unwrap();
        for (facing, sign) in [(Facing::Seen, 1.0), (Facing::Back, -1.0)] {
            let drawn = draw_on(&sphere(), &stroke, -DVec3::Y, facing, 0.01).unwrap();
            assert!(drawn.points().len() > 100 && drawn.points().len() < 103);
            for point in drawn.points() {
                assert!((point.length() - 1.0).abs() < 2e-3 && point.y * sign > 0.0, "{point}");
                assert!((point.z - 0.1).abs() < 1e-12);
            }
        }
        let past = Curve::new("past", vec![DVec3::ZERO, DVec3::X * 2.0], false).unwrap();
        let error = draw_on(&sphere(), &past, DVec3::Y, Facing::Seen, 0.05).unwrap_err();
        assert!(matches!(&error, StrokeError::OffTheMesh { share, .. } if *share > 45.0 && *share < 60.0), "{error}");
    }

    #[test]
    fn a_hole_is_cut_in_front_only_or_through() {
        for (through, loops) in [(false, 1), (true, 2)] {
            let open = cut_along(&sphere(), &circle(0.4, 9.0), -DVec3::Y, Keep::Outside, through).unwrap();
            let found = check(&open);
            assert_eq!((found.boundary_loops, found.shells, found.degenerate_polygons.len()), (loops, 1, 0));
            let topology = crate::mesh::Topology::new(&open);
            for vertex in topology.boundary_loops().into_iter().flatten() {
                let p = open.positions()[vertex as usize];
                assert!((DVec2::new(p.x, p.z).length() - 0.4).abs() < 2e-3, "{p}");
            }
        }
        let piece = cut_along(&sphere(), &circle(0.4, 9.0), -DVec3::Y, Keep::Inside, false).unwrap();
        let found = check(&piece);
        assert_eq!((found.boundary_loops, found.shells), (1, 1));
        assert!(piece.positions().iter().all(|p| p.y > 0.8));
    }

    #[test]
    fn strokes_that_cut_nothing_are_refused() {
        let cut = |stroke: &Curve, keep| cut_along(&sphere(), stroke, DVec3::Y, keep, true);
        let between = circle(1e-3, 0.0).map(|p| p + DVec3::new(0.03, 0.0, 0.03)).unwrap();
        assert!(matches!(cut(&between, Keep::Outside), Err(StrokeError::NothingInside { .. })));
        assert!(matches!(cut(&circle(5.0, 0.0), Keep::Outside), Err(StrokeError::NothingOutside { .. })));
        let open = Curve::new("open", vec![DVec3::X, DVec3::Z], false).unwrap();
        assert!(matches!(cut(&open, Keep::Inside), Err(StrokeError::Open { .. })));
        let none = cut_along(&sphere(), &circle(0.4, 0.0), DVec3::ZERO, Keep::Inside, true);
        assert!(matches!(none, Err(StrokeError::NoDirection { .. })));
        assert!(matches!(
            cut_along(&Mesh::default(), &circle(0.4, 0.0), DVec3::Y, Keep::Inside, true),
            Err(StrokeError::Empty(_))
        ));
    }
}
