//! Wavefront OBJ: polygons of any size, curves as lines, every digit kept.

mod material;
mod read;
mod write;

pub use material::material_library_bytes;
pub use read::{read, read_while};
pub use write::write;

const FORMAT: &str = "OBJ";

#[cfg(test)]
mod tests;
