//! The mathematics of Maquette: curves, the beam ODE, detail generators, surfaces and meshes.
//!
//! This crate knows nothing of graphs, files on disk or windows; [`file_format`] turns bytes into geometry and back.
//! Lengths are metres, axes are +X to the model's left, +Y up, +Z to the front; angles are radians unless a name
//! ends in `_degrees`. All mathematics is `f64`.

pub mod beam;
pub mod border;
pub mod curve;
pub mod deform;
pub mod file_format;
pub mod generate;
pub mod linear_solver;
pub mod mesh;
pub mod outline;
mod polygon;
pub mod primitive;
pub mod scene;
pub mod sections;
pub mod surface;
pub mod trigonometric;
pub mod view;
