//! Nodes that make surfaces.

pub(crate) mod surface_from_cross_sections;
