//! Polygon meshes and what can be measured on them.

mod polygon;

pub use polygon::{Mesh, MeshError};
