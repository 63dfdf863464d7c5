//! Nodes that work on meshes.

pub(crate) mod join_meshes;
pub(crate) mod mirror_mesh;
pub(crate) mod transform_mesh;
