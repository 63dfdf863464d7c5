//! Nodes that work on sections.

pub(crate) mod curves_from_sections;
