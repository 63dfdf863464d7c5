//! Nodes that deform.

pub(crate) mod deform_by_cross_section;
