//! What is said about seams, and why there are none.

use std::fmt;

use glam::DVec3;

use super::junction::TJunction;
use crate::curve::{metres, place};
use crate::mesh::topology::Topology;
use crate::mesh::{Mesh, MeshError};

/// Something about the seams that should be looked at. Parts are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WeldWarning {
    /// Two equal loops are near each other, but not near enough.
    Apart {
        /// The parts.
        parts: [usize; 2],
        /// Largest distance of their vertices, metres.
        gap: f64,
        /// The tolerance, metres.
        tolerance: f64,
        /// Where they are.
        at: DVec3,
    },
    /// Two equal loops run the same way, so that one part faces in where the other faces out.
    FacesOtherWay {
        /// The parts.
        parts: [usize; 2],
        /// Where they meet.
        at: DVec3,
    },
    /// Vertices that lie within open edges of another part.
    TJunctions {
        /// How many.
        count: usize,
        /// The first of them.
        first: TJunction,
    },
    /// Edges with more than two faces.
    TooManyFaces {
        /// How many.
        edges: usize,
        /// The middle of the first of them.
        at: DVec3,
    },
    /// Edges at which one face looks in where the other looks out.
    Inconsistent {
        /// How many.
        edges: usize,
        /// The middle of the first of them.
        at: DVec3,
    },
}

impl fmt::Display for WeldWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Apart { parts: [a, b], gap, tolerance, at } => write!(
                f,
                "equal loops of parts {a} and {b} at {} are up to {} apart and were not welded: raise the tolerance of \
                 {} if they are to meet",
                place(*at),
                metres(*gap),
                metres(*tolerance)
            ),
            Self::FacesOtherWay { parts: [a, b], at } => write!(
                f,
                "parts {a} and {b} meet at {}, but one of them is inside out, and they were not welded: turn it around",
                place(*at)
            ),
            Self::TJunctions { count, first } => write!(
                f,
                "{count} {} of other parts without being welded, the first one, of part {} in part {}, at {}: give both \
                 boundaries the same number of points",
                if *count == 1 { "vertex lies within an open edge" } else { "vertices lie within open edges" },
                first.part,
                first.of,
                place(first.at)
            ),
            Self::TooManyFaces { edges, at } => write!(
                f,
                "{edges} {} more than two faces, the first one at {}: three parts meet there, or one of them twice",
                if *edges == 1 { "edge has" } else { "edges have" },
                place(*at)
            ),
            Self::Inconsistent { edges, at } => write!(
                f,
                "at {edges} {} one face looks in where the other looks out, first at {}: turn a part around",
                if *edges == 1 { "edge" } else { "edges" },
                place(*at)
            ),
        }
    }
}

pub(super) fn of_junctions(found: &[TJunction]) -> Option<WeldWarning> {
    found.first().map(|first| WeldWarning::TJunctions { count: found.len(), first: *first })
}

/// Warnings about edges that do not make a surface.
pub(super) fn of_faults(mesh: &Mesh, topology: &Topology) -> Vec<WeldWarning> {
    let middle = |[a, b]: [u32; 2]| 0.5 * (mesh.positions()[a as usize] + mesh.positions()[b as usize]);
    let (crowded, turned) = (topology.non_manifold_edges(), topology.inconsistent_edges());
    let crowded = crowded.first().map(|edge| WeldWarning::TooManyFaces { edges: crowded.len(), at: middle(*edge) });
    let turned = turned.first().map(|edge| WeldWarning::Inconsistent { edges: turned.len(), at: middle(*edge) });
    crowded.into_iter().chain(turned).collect()
}

/// Why parts are not welded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WeldError {
    /// Told to stop.
    #[error("stopped")]
    Stopped,
    /// No part at all.
    #[error("there is nothing to weld: give at least one mesh")]
    Nothing,
    /// A tolerance that is out of range.
    #[error("a tolerance of {found} m: give a length from 0 to 1000 m")]
    Tolerance {
        /// The tolerance.
        found: f64,
    },
    /// An angle that is out of range.
    #[error("seams smooth up to {found} degrees: give an angle from 0 to 180")]
    Smooth {
        /// The angle, degrees.
        found: f64,
    },
    /// The mesh can't be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
