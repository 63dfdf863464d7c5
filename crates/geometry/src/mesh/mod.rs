//! Polygon meshes and what can be measured on them.

pub mod caps;
pub mod check;
pub mod crease;
pub mod cut;
pub mod distance;
pub(crate) mod ear_clipping;
pub mod measure;
mod polygon;
pub mod ray;
mod silhouette;
mod silhouette_report;
pub mod slice;
pub mod stroke;
pub mod topology;
pub mod transform;
mod triangle_tree;
pub mod triangulate;
pub mod weld;

pub use check::{MeshCheck, check, check_while};
pub use distance::{MeshDistance, Nearest};
pub use polygon::{Mesh, MeshError};
pub use ray::{MeshRays, RayHit};
pub use silhouette::{MeshSilhouette, MeshSilhouetteError, silhouette_of};
pub use silhouette_report::{SilhouetteReport, SilhouetteReportError, silhouette_report};
pub use topology::Topology;
pub use transform::{TransformError, flipped, join, join_while, transform, transform_while};
pub use triangulate::triangles;
