//! Nodes that work on meshes.

use maquette_geometry::mesh::TransformError;
use maquette_graph::NodeError;

pub(crate) mod caps;
pub(crate) mod compare_meshes;
pub(crate) mod cut_with_curve;
pub(crate) mod cut_with_plane;
pub(crate) mod join_meshes;
pub(crate) mod join_parts;
pub(crate) mod measure_mesh;
pub(crate) mod mesh_smooth;
pub(crate) mod mirror_mesh;
pub(crate) mod resample_border;
pub(crate) mod silhouette_of;
pub(crate) mod silhouette_report;
pub(crate) mod transform_mesh;

/// Being stopped is no failure of a port.
pub(crate) fn stoppable<T>(made: Result<T, TransformError>) -> Result<Result<T, TransformError>, NodeError> {
    match made {
        Err(TransformError::Stopped) => Err(NodeError::Cancelled),
        made => Ok(made),
    }
}
