//! The wire type of whatever has an extent.

use maquette_graph::{ContentHasher, Wire};

use super::{Mesh, Sections, Surface};

/// A mesh, a surface or sections, where a node takes any of them.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A mesh.
    Mesh(Mesh),
    /// A surface.
    Surface(Surface),
    /// Sections of points.
    Sections(Sections),
}

impl Wire for Shape {
    const NAME: &'static str = "shape";
    const DESCRIPTION: &'static str = "A mesh, a surface or sections of points: what has borders.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        match self {
            Self::Mesh(mesh) => {
                hasher.integer(0);
                mesh.hash_content(hasher);
            }
            Self::Surface(surface) => {
                hasher.integer(1);
                surface.hash_content(hasher);
            }
            Self::Sections(sections) => {
                hasher.integer(2);
                sections.hash_content(hasher);
            }
        }
    }

    fn byte_size(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.byte_size(),
            Self::Surface(surface) => surface.byte_size(),
            Self::Sections(sections) => sections.byte_size(),
        }
    }

    fn summary(&self) -> String {
        match self {
            Self::Mesh(mesh) => mesh.summary(),
            Self::Surface(surface) => surface.summary(),
            Self::Sections(sections) => sections.summary(),
        }
    }
}
