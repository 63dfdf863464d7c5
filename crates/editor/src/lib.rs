//! The editor of Maquette: sketch in four views, wire nodes, see the surface follow.
//!
//! Its state has three parts: the [`document`] (saved and undone), the [`view_state`] (neither) and the [`results`] of the
//! evaluation (derived). Widgets change none of them: they emit [`command`]s, which one place applies. Canvas, views and panels
//! are projections of the document in every frame and know nothing of each other. What kinds of nodes there are, they take from
//! the catalogue: a new kind appears without a line here.

mod app;
mod apply;
mod canvas;
pub mod command;
mod dialog;
mod dock;
pub mod document;
mod drawable;
mod evaluation_worker;
mod naming;
mod panel;
mod recovery;
mod reference_pictures;
pub mod results;
mod shortcuts;
mod signs;
mod sketch;
mod style;
pub mod view_state;
mod viewport;
mod window;

pub use app::{App, Options, StartError, recovery_folder};
pub use canvas::arrange::Alignment;
pub use drawable::Detail;
pub use evaluation_worker::NodeStatus;
pub use panel::tour::Tour;
pub use viewport::camera::Direction;
pub use viewport::picture::Shading;
