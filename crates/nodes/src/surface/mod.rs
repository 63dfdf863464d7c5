//! Nodes that make surfaces.

pub(crate) mod join_surfaces;
pub(crate) mod surface_from_cross_sections;
pub(crate) mod tessellate;
