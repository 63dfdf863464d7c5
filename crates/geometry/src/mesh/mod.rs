//! Polygon meshes and what can be measured on them.

pub mod adjacency;
pub mod caps;
pub mod check;
pub mod crease;
pub mod cut;
pub mod distance;
pub(crate) mod ear_clipping;
pub mod geodesic;
pub mod manifold;
pub mod measure;
mod polygon;
pub mod ray;
pub mod select;
mod silhouette;
mod silhouette_report;
pub mod slice;
pub mod stroke;
pub mod topology;
pub mod transform;
mod triangle_tree;
pub mod triangulate;
pub mod weights;
pub mod weld;

pub use adjacency::Adjacency;
pub use check::{MeshCheck, check, check_while};
pub use distance::{MeshDistance, Nearest};
pub use manifold::ManifoldReport;
pub use polygon::{Mesh, MeshError};
pub use ray::{MeshRays, RayHit};
pub use select::Selection;
pub use silhouette::{MeshSilhouette, MeshSilhouetteError, silhouette_of};
pub use silhouette_report::{SilhouetteReport, SilhouetteReportError, silhouette_report};
pub use topology::Topology;
pub use transform::{TransformError, flipped, join, join_while, transform, transform_while};
pub use triangulate::triangles;
