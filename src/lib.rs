//! The headless command of Maquette, as a library: commands, pictures and what they share.

pub mod commands;
pub mod picture;
