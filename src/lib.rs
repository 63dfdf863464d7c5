//! The headless command of Maquette, as a library: pictures and commands.

pub mod picture;
