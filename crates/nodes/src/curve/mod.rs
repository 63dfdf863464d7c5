//! Nodes that work on curves.

pub(crate) mod beam_reference;
pub(crate) mod boundary_of;
pub(crate) mod clean_strokes;
pub(crate) mod compare_curves;
pub(crate) mod draw_on_surface;
pub(crate) mod join;
pub(crate) mod join_borders;
pub(crate) mod mirror;
pub(crate) mod pick;
pub(crate) mod resample;
pub(crate) mod simplify;
pub(crate) mod smooth;
pub(crate) mod sort;
pub(crate) mod split_border;
pub(crate) mod transform;
