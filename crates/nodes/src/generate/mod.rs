//! Nodes that generate shapes from curves.

pub(crate) mod detail_generator;
