//! Nodes that select vertices of a mesh, by where they are and by names.

pub(crate) mod change_selection;
pub(crate) mod combine_selections;
pub(crate) mod select_by_distance;
pub(crate) mod select_by_mesh;
pub(crate) mod select_by_name;
pub(crate) mod select_by_normal;
pub(crate) mod select_by_shape;
pub(crate) mod select_by_stroke;
pub(crate) mod select_nearest;
pub(crate) mod select_points;
pub(crate) mod split_by_selection;
