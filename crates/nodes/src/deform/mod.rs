//! Nodes that deform.

pub(crate) mod beam;
pub(crate) mod deform_by_cross_section;
