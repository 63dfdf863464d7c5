//! Cross-sections of a mesh along a bone (thesis 4.1: sections of a template character, taken around its bones).
//!
//! [`plane`] cuts a mesh once. [`along`] places planes along a bone, keeps in each the loop around the bone, and gives
//! it the same direction, start and number of points as all others; [`through`] does the same in planes that are given.
//! Instead of keeping a loop, rays can be cast from the bone, as the thesis does.

mod along;
mod around;
mod chain;
mod crossing;
mod cut;
mod error;
mod plane;
mod rays;
mod section;
mod stations;
mod warning;

pub use along::{AlongOptions, MAX_SECTIONS, Positions, along, along_while, through, through_while};
pub use chain::Loop;
pub use cut::plane;
pub use error::SliceError;
pub use plane::{NoPlane, Plane};
pub(crate) use section::{centroid, front_of};
pub(crate) use stations::with_fronts;

pub use section::{Hit, Method, Others, Section, SectionOptions, Sliced};
pub use warning::{Concern, SliceWarning};
