//! Nodes that work on sections.

pub(crate) mod curves_from_sections;
pub(crate) mod edit_section;
pub(crate) mod ellipse;
pub(crate) mod fit_report;
pub(crate) mod fit_sections;
pub(crate) mod order_sections;
pub(crate) mod pick_sections;
pub(crate) mod sections_from_mesh;
