//! Selections: a weight for each vertex of a mesh, made from where vertices are instead of from their numbers, so that
//! they hold when the mesh changes.

mod selection;

pub use selection::{Selection, SelectionError};
