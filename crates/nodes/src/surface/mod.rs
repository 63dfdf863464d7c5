//! Nodes that make surfaces, and that look at them.

pub(crate) mod continuity_report;
pub(crate) mod join_surfaces;
pub(crate) mod section_at;
pub(crate) mod surface_from_cross_sections;
pub(crate) mod tessellate;
