//! Nodes that make primitives.

use maquette_geometry::primitive::PrimitiveError;
use maquette_graph::{AtPort, Input, NodeError};

pub(crate) mod primitive_shape;
pub(crate) mod superellipsoid;

/// Lays an error at the port where the remedy lies: counts at theirs, everything else at `size`.
fn laid<T, S>(
    made: Result<T, PrimitiveError>,
    sections: Input<i64>,
    nodes: Input<i64>,
    size: Input<S>,
) -> Result<T, NodeError> {
    match made {
        Err(error @ PrimitiveError::Count { what: "nodes", .. }) => Err(error).at(nodes),
        Err(error @ (PrimitiveError::Count { .. } | PrimitiveError::TooManyPoints { .. })) => Err(error).at(sections),
        made => made.at(size),
    }
}
