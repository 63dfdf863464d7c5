//! Values as what the views draw. Made on the evaluation's thread, once for each content.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::crease::{CREASE_DEGREES, creased_normals};
use maquette_geometry::mesh::measure::points_bounds;
use maquette_geometry::mesh::select::split;
use maquette_geometry::mesh::{Mesh, mean_curvature, silhouette_of, triangles};
use maquette_geometry::scene::Material;
use maquette_geometry::surface::tessellate::{Density, Tessellation, tessellate};
use maquette_geometry::view::View;
use maquette_graph::{Evaluation, NodeId, Value};
use maquette_nodes::wire;
use serde::{Deserialize, Serialize};

/// A corner of a mesh as the graphics card gets it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    /// Mean curvature, 1/m; zero where it was not asked for.
    pub(crate) curvature: f32,
}

/// A piece of a line.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Segment {
    pub(crate) from: [f32; 3],
    pub(crate) to: [f32; 3],
}

/// A mesh, ready to be drawn.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Its edges, each once.
    pub(crate) wire: Vec<Segment>,
    /// Mean length of its edges, metres.
    pub(crate) edge_length: f64,
    /// Size of the curvature that deserves the strongest colour, 1/m.
    pub(crate) curvature_scale: f32,
    /// Its outlines from the front, the side and above, as closed lines in space; empty where they were not asked for.
    pub(crate) outlines: [Vec<Vec<DVec3>>; 3],
}

/// A line, ready to be drawn and picked.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) points: Vec<Vec3>,
    pub(crate) closed: bool,
    pub(crate) role: LineRole,
}

/// What a line is in a stack of sections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineRole {
    /// A curve by itself.
    Curve,
    /// A cross-section.
    Section,
    /// Where corresponding points of the sections lie on a rail.
    Rail,
}

/// What of values is made ready beside their shape, because it costs time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Depiction {
    /// The mean curvature of meshes.
    pub(crate) curvature: bool,
    /// Their outlines from the front, the side and above.
    pub(crate) outlines: bool,
    /// How finely exact surfaces are shown.
    pub(crate) detail: Detail,
}

/// How finely exact surfaces are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Detail {
    /// As a model that is seen from afar: 12 by 24 quads for each part.
    Coarse,
    /// 32 by 64 quads.
    #[default]
    Medium,
    /// 96 by 192 quads.
    Fine,
}

impl Detail {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 3] = [Self::Coarse, Self::Medium, Self::Fine];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coarse => "Coarse",
            Self::Medium => "Medium",
            Self::Fine => "Fine",
        }
    }

    fn density(self) -> Density {
        match self {
            Self::Coarse => Density::Grid { rows: 12, columns: 24 },
            Self::Medium => Density::Grid { rows: 32, columns: 64 },
            Self::Fine => Density::Grid { rows: 96, columns: 192 },
        }
    }
}

/// A value, ready to be drawn.
#[derive(Debug)]
pub(crate) struct Drawable {
    /// Different for every drawable of this process.
    pub(crate) id: u64,
    pub(crate) surface: Option<Surface>,
    pub(crate) lines: Vec<Line>,
    /// Whether it is a selected part of a mesh, to be shown over that.
    pub(crate) is_selection: bool,
    /// sRGB with alpha, as the document says; `None` where it says nothing.
    pub(crate) colour: Option<[f32; 4]>,
    /// Lowest and highest coordinates; `None` where nothing is drawn.
    pub(crate) bounds: Option<[DVec3; 2]>,
}

/// What a node puts into the views.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    /// The nodes that lead to its graph; none for the whole graph.
    pub(crate) path: Vec<NodeId>,
    pub(crate) node: NodeId,
    pub(crate) drawables: Vec<Arc<Drawable>>,
}

/// The drawables of the last evaluation, by content.
#[derive(Default)]
pub(crate) struct Drawables {
    known: BTreeMap<(u128, Depiction), Option<Arc<Drawable>>>,
}

impl Drawables {
    /// What nodes put into the views: those of an evaluation of the whole graph, and of one within nodes. What was made before
    /// is not made again.
    pub(crate) fn of(&mut self, evaluated: &[Evaluated<'_>], depiction: Depiction) -> Vec<Shown> {
        let mut used = BTreeMap::new();
        let mut shown = Vec::new();
        for Evaluated { path, evaluation, nodes } in evaluated {
            for &node in *nodes {
                let mut drawables = Vec::new();
                for value in evaluation.values(node).unwrap_or_default() {
                    let key = (value.hash().0, depiction);
                    let known = used.get(&key).or_else(|| self.known.get(&key)).cloned();
                    let drawable = known.unwrap_or_else(|| drawable(value, depiction).map(Arc::new));
                    used.insert(key, drawable.clone());
                    drawables.extend(drawable);
                }
                if !drawables.is_empty() {
                    shown.push(Shown { path: path.to_vec(), node, drawables });
                }
            }
        }
        self.known = used;
        shown
    }
}

/// An evaluation of a graph, and the nodes of it that are looked at.
pub(crate) struct Evaluated<'a> {
    /// The nodes that lead to the graph; none for the whole graph.
    pub(crate) path: &'a [NodeId],
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) nodes: &'a [NodeId],
}

fn fresh_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// A value as what the views draw; `None` where it is nothing to see.
fn drawable(value: &Value, depiction: Depiction) -> Option<Drawable> {
    if let Some(mesh) = value.get::<wire::Mesh>() {
        Some(of_mesh(&mesh.0, None, depiction))
    } else if let Some(result) = value.get::<wire::MeshResult>() {
        Some(of_mesh(&result.mesh, Some(&result.material), depiction))
    } else if let Some(curve) = value.get::<wire::Curve>() {
        Some(of_curves(std::slice::from_ref(&curve.0), None))
    } else if let Some(curves) = value.get::<wire::Curves>() {
        Some(of_curves(&curves.0, None))
    } else if let Some(result) = value.get::<wire::CurvesResult>() {
        Some(of_curves(&result.curves, Some(result.colour)))
    } else if let Some(sections) = value.get::<wire::Sections>() {
        Some(of_sections(&sections.0))
    } else if let Some(sections) = value.get::<wire::EllipticSections>() {
        Some(of_series(sections))
    } else if let Some(sections) = value.get::<wire::CrossSections>() {
        Some(match sections {
            wire::CrossSections::Points(sections) => of_sections(&sections.0),
            wire::CrossSections::Series(sections) => of_series(sections),
        })
    } else if let Some(surface) = value.get::<wire::Surface>() {
        of_surface(surface, depiction)
    } else if let Some(selection) = value.get::<wire::Selection>() {
        selected_part(selection, depiction)
    } else {
        let borders = value.get::<wire::Borders>()?;
        let curves: Vec<Curve> = borders.0.iter().map(|border| border.curve().clone()).collect();
        Some(of_curves(&curves, None))
    }
}

/// What is selected of the mesh, cut where weights pass 0.5.
fn selected_part(selection: &wire::Selection, depiction: Depiction) -> Option<Drawable> {
    let [selected, _] = split(&selection.mesh, &selection.weights).ok()?;
    let part = || Drawable { is_selection: true, ..of_mesh(&selected, None, depiction) };
    (selected.polygon_count() > 0).then(part)
}

/// Sections that are series, as lines through this many of their points.
const SERIES_POINTS: usize = 96;

fn of_series(sections: &wire::EllipticSections) -> Drawable {
    let sampled: Vec<(Vec<DVec3>, bool)> =
        sections.0.iter().map(|named| (named.section.sampled(SERIES_POINTS), named.section.is_closed())).collect();
    let line = |(points, closed): &(Vec<DVec3>, bool)| Line {
        points: points.iter().map(|p| p.as_vec3()).collect(),
        closed: *closed,
        role: LineRole::Section,
    };
    Drawable {
        id: fresh_id(),
        is_selection: false,
        surface: None,
        lines: sampled.iter().map(line).collect(),
        colour: None,
        bounds: bounds(sampled.iter().flat_map(|(points, _)| points).copied()),
    }
}

/// A surface as a mesh of moderate density. One that is known at its sections only is shown by these.
fn of_surface(surface: &wire::Surface, depiction: Depiction) -> Option<Drawable> {
    match surface {
        wire::Surface::Points(sections) => Some(of_sections(sections)),
        wire::Surface::Series(parts) => {
            let tessellation = Tessellation { density: depiction.detail.density(), ..Tessellation::default() };
            let made = tessellate(parts, &tessellation, &|_| true).ok()?;
            Some(of_mesh(&made.mesh, None, depiction))
        }
    }
}

fn bounds(points: impl Iterator<Item = DVec3>) -> Option<[DVec3; 2]> {
    points_bounds(points).map(Into::into)
}

#[expect(clippy::cast_possible_truncation, reason = "the graphics card takes single precision")]
fn of_mesh(mesh: &Mesh, material: Option<&Material>, depiction: Depiction) -> Drawable {
    let creased;
    let normals = match mesh.normals() {
        Some(normals) => normals,
        None => {
            creased = creased_normals(mesh, CREASE_DEGREES);
            &creased
        }
    };
    let place = |corner: usize| mesh.positions()[mesh.corners()[corner] as usize];
    let bent = if depiction.curvature { mean_curvature(mesh) } else { Vec::new() };
    let vertices = (0..mesh.corners().len()).map(|corner| Vertex {
        position: place(corner).as_vec3().to_array(),
        normal: normals[corner].as_vec3().to_array(),
        curvature: bent.get(mesh.corners()[corner] as usize).map_or(0.0, |bent| *bent as f32),
    });
    // More corners than 32-bit indices reach would not fit into memory.
    let triangles = triangles(mesh).map(|corners| corners.map(|corner| corner as u32)).collect();
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(mesh.corners().len());
    for polygon in mesh.polygons() {
        let Some(&last) = polygon.last() else { continue };
        let mut before = last;
        for &vertex in polygon {
            edges.push([before.min(vertex), before.max(vertex)]);
            before = vertex;
        }
    }
    edges.sort_unstable();
    edges.dedup();
    let at = |vertex: u32| mesh.positions()[vertex as usize].as_vec3().to_array();
    let wire = edges.iter().map(|[a, b]| Segment { from: at(*a), to: at(*b) }).collect();
    let length = |[a, b]: &[u32; 2]| mesh.positions()[*a as usize].distance(mesh.positions()[*b as usize]);
    let edge_length = edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64;
    let mut sizes: Vec<f64> = bent.iter().map(|bent| bent.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    // One wild vertex must not take the colour from all others.
    let scale = sizes.get(sizes.len() * 95 / 100).copied().unwrap_or(1.0).max(1e-6);
    let outlines = if depiction.outlines { outlines(mesh) } else { Default::default() };
    let surface =
        Surface { vertices: vertices.collect(), triangles, wire, edge_length, curvature_scale: scale as f32, outlines };
    Drawable {
        id: fresh_id(),
        is_selection: false,
        bounds: bounds((0..mesh.corners().len()).map(place)),
        surface: Some(surface),
        lines: Vec::new(),
        colour: material.map(|material| material.colour.map(|component| component as f32)),
    }
}

/// The outlines of a mesh in the three views; none where it is seen from its edge.
fn outlines(mesh: &Mesh) -> [Vec<Vec<DVec3>>; 3] {
    [View::FRONT, View::SIDE, View::TOP].map(|view| {
        let seen = silhouette_of(mesh, view, 0.0, &|_| true);
        seen.map(|seen| seen.curves.iter().map(|curve| curve.points().to_vec()).collect()).unwrap_or_default()
    })
}

#[expect(clippy::cast_possible_truncation, reason = "the graphics card takes single precision")]
fn of_curves(curves: &[Curve], colour: Option<[f64; 4]>) -> Drawable {
    let line = |curve: &Curve| Line {
        points: curve.points().iter().map(|p| p.as_vec3()).collect(),
        closed: curve.is_closed(),
        role: LineRole::Curve,
    };
    Drawable {
        id: fresh_id(),
        is_selection: false,
        surface: None,
        lines: curves.iter().map(line).collect(),
        colour: colour.map(|colour| colour.map(|component| component as f32)),
        bounds: bounds(curves.iter().flat_map(|curve| curve.points()).copied()),
    }
}

fn of_sections(sections: &maquette_geometry::sections::Sections) -> Drawable {
    let single = |points: &[DVec3]| points.iter().map(|p| p.as_vec3()).collect::<Vec<_>>();
    let rows =
        sections.iter().map(|row| Line { points: single(row), closed: sections.is_closed(), role: LineRole::Section });
    let rails = sections.rails().iter().map(|rail| Line {
        points: sections.iter().filter_map(|row| row.get(*rail)).map(|p| p.as_vec3()).collect(),
        closed: false,
        role: LineRole::Rail,
    });
    Drawable {
        id: fresh_id(),
        is_selection: false,
        surface: None,
        lines: rows.chain(rails).collect(),
        colour: None,
        bounds: bounds(sections.points().iter().copied()),
    }
}

impl Line {
    /// The pieces it is drawn with.
    pub(crate) fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let count = self.points.len();
        let pieces = if self.closed { count } else { count.saturating_sub(1) };
        (0..pieces)
            .map(move |i| Segment { from: self.points[i].to_array(), to: self.points[(i + 1) % count].to_array() })
    }
}
