//! Selections: a weight for each vertex of a mesh, made from where vertices are instead of from their numbers, so that
//! they hold when the mesh changes.

mod lasso;
mod named;
mod near;
mod selection;
mod shape;
mod split;
mod surface;
#[cfg(test)]
mod tests;

pub use lasso::by_lasso;
pub use named::{NameError, by_name};
pub use near::{Picked, by_points, near_mesh};
pub use selection::{Selection, SelectionError};
pub use shape::{Shape, by_shape};
pub use split::{SplitError, split};
pub use surface::{boundary_loop_nearest, by_normal, component_nearest, geodesic};

/// Why nothing can be selected so.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SelectError {
    /// A number that is not one, or infinite.
    #[error("the {what} is not finite")]
    NotFinite {
        /// Which.
        what: &'static str,
    },
    /// A length or an angle below 0.
    #[error("the {what} is {value}: it must be 0 or more")]
    Negative {
        /// Which.
        what: &'static str,
        /// What was given.
        value: f64,
    },
    /// A direction of length 0.
    #[error("the direction has length 0: give one that points somewhere")]
    NoDirection,
    /// No point to measure from.
    #[error("no point is given to measure from")]
    NoPoint,
    /// A mesh without polygons.
    #[error("the mesh has no polygons to select from")]
    NoPolygons,
    /// Another mesh without polygons, to which distances are wanted.
    #[error("the other mesh has no polygons to be near to")]
    NoOther,
    /// A mesh without boundary.
    #[error("the mesh is closed, and has no boundary loop")]
    NoBoundary,
}

/// Asks whether a length or an angle is finite and not negative.
fn not_negative(what: &'static str, value: f64) -> Result<(), SelectError> {
    match value {
        value if !value.is_finite() => Err(SelectError::NotFinite { what }),
        value if value < 0.0 => Err(SelectError::Negative { what, value }),
        _ => Ok(()),
    }
}
