//! Nodes whose values leave the graph.

pub(crate) mod curves_out;
pub(crate) mod mesh_out;
