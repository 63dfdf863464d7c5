//! Why a mesh is not bound or deformed.

use glam::DVec3;

use super::handle::HandleError;
use crate::linear_solver::LinearSolverError;
use crate::mesh::Mesh;
use crate::mesh::manifold::ManifoldReport;

/// Edges and vertices that a message names; the error has all.
const NAMED: usize = 4;

/// What a selection is called that says what is free.
pub(super) const REGION: &str = "region";

/// Why a mesh cannot be bound to handles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BindError {
    /// A selection made on another mesh.
    #[error("the {what} has {found} weights, and the mesh {vertices} vertices: select on the mesh that is deformed")]
    WrongSelection {
        /// The region, or which handle.
        what: String,
        /// Weights found.
        found: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// A handle without vertices.
    #[error("handle {handle} has no vertex: select at least one with a weight of 0.5 or more")]
    EmptyHandle {
        /// Its index, counted from 0.
        handle: usize,
    },
    /// Edges of more than two polygons, or fans that touch in a point.
    #[error("{message}")]
    NotManifold {
        /// All edges in and around the region with more than two polygons, as vertices.
        edges: Vec<[u32; 2]>,
        /// All vertices there at which fans of polygons touch in this point only.
        vertices: Vec<u32>,
        /// What is written.
        message: String,
    },
    /// A part of the region with too little that is held.
    #[error(
        "the part of the region with vertex {vertex} at ({:.4}, {:.4}, {:.4}), {free} vertices in all, {reason}",
        at.x, at.y, at.z
    )]
    Underdetermined {
        /// A vertex of the part.
        vertex: u32,
        /// Where it is, metres.
        at: DVec3,
        /// Free vertices of the part.
        free: usize,
        /// What is missing.
        reason: &'static str,
    },
    /// A vertex whose surroundings have no extent in two directions.
    #[error(
        "around vertex {vertex} at ({:.6}, {:.6}, {:.6}) the mesh has no area, so that nothing turns with it: merge \
         vertices that lie on each other, or leave it out of the region", at.x, at.y, at.z
    )]
    NoExtent {
        /// The vertex.
        vertex: u32,
        /// Where it is, metres.
        at: DVec3,
    },
    /// The system has no factor.
    #[error("the deformation cannot be prepared: {0}")]
    Solver(#[from] LinearSolverError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Stopped,
}

impl BindError {
    /// Whether the region is at fault, and not a handle or the mesh.
    pub fn is_of_region(&self) -> bool {
        matches!(self, Self::WrongSelection { what, .. } if what == REGION)
    }

    pub(super) fn not_manifold(report: &ManifoldReport, mesh: &Mesh) -> Self {
        let at = |v: u32| {
            let p = mesh.positions()[v as usize];
            format!("{v} at ({:.4}, {:.4}, {:.4})", p.x, p.y, p.z)
        };
        let more = |count: usize| if count > NAMED { format!(" and {} more", count - NAMED) } else { String::new() };
        let mut parts = Vec::new();
        if !report.edges.is_empty() {
            let named: Vec<String> =
                report.edges.iter().take(NAMED).map(|[a, b]| format!("from vertex {} to {}", at(*a), at(*b))).collect();
            let more = more(report.edges.len());
            parts.push(format!("more than two polygons meet at the edge {}{more}", named.join(", ")));
        }
        if !report.vertices.is_empty() {
            let named: Vec<String> = report.vertices.iter().take(NAMED).map(|v| at(*v)).collect();
            let more = more(report.vertices.len());
            parts.push(format!("polygons meet only in the point at vertex {}{more}", named.join(", ")));
        }
        let message = format!(
            "the region is not a 2-manifold: {}; part the polygons there, or leave them out of the region",
            parts.join("; ")
        );
        Self::NotManifold { edges: report.edges.clone(), vertices: report.vertices.clone(), message }
    }
}

/// Why handles do not deform a bound mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeformError {
    /// Another number of transforms than of handles.
    #[error("{found} transforms given for {handles} handles: give one each")]
    WrongCount {
        /// Transforms found.
        found: usize,
        /// Handles bound.
        handles: usize,
    },
    /// A transform that is no motion.
    #[error("handle {handle}: {source}")]
    Handle {
        /// Index of the handle, counted from 0.
        handle: usize,
        /// What is wrong with it.
        source: HandleError,
    },
    /// Numbers beyond what can be computed with.
    #[error("the deformed mesh has a vertex that is not finite: move the handles less far")]
    Overflow,
    /// The system cannot be solved.
    #[error("the deformation cannot be computed: {0}")]
    Solver(#[from] LinearSolverError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Stopped,
}
