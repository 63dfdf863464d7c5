//! Nodes at which a graph begins: sketches and files.

pub(crate) mod import_curves;
pub(crate) mod import_mesh;
pub(crate) mod import_skeleton;
pub(crate) mod sketch;
pub(crate) mod trace_image;
