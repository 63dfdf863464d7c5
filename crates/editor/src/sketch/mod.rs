//! Strokes as one draws and corrects them on paper, in the two coordinates of their plane. Nothing here knows of windows.

pub(crate) mod correct;
pub(crate) mod smooth;
pub(crate) mod target;
