//! Nodes that generate shapes from curves.

pub(crate) mod blend;
pub(crate) mod detail_generator;
