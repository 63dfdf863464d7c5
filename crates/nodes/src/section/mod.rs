//! Nodes that work on sections.

pub(crate) mod curves_from_sections;
pub(crate) mod fit_sections;
