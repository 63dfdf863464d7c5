//! The wire type of selections.

use std::sync::Arc;

use maquette_geometry::mesh;
use maquette_graph::{ContentHash, ContentHasher, Value, Wire};

use super::{Mesh, count};

/// A weight for each vertex of a mesh, with the mesh on which it was made. It fits any mesh with as many vertices in the
/// same order: the same one deformed, for instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// The weights, one a vertex.
    pub weights: Arc<mesh::Selection>,
    /// What it was made on, to be shown and measured.
    pub mesh: Arc<mesh::Mesh>,
    /// Hash of the mesh as it arrived, which need not be computed again.
    pub mesh_hash: ContentHash,
}

impl Selection {
    /// A selection on a mesh whose hash is not at hand.
    pub fn new(weights: mesh::Selection, mesh: Mesh) -> Self {
        let on = mesh.0.clone();
        Self { weights: Arc::new(weights), mesh: on, mesh_hash: Value::new(mesh).hash() }
    }

    /// Other weights on the same mesh.
    #[must_use]
    pub fn with_weights(&self, weights: mesh::Selection) -> Self {
        Self { weights: Arc::new(weights), ..self.clone() }
    }
}

impl Wire for Selection {
    const NAME: &'static str = "selection";
    const DESCRIPTION: &'static str =
        "A weight between 0 and 1 for each vertex of a mesh; from 0.5 on a vertex counts as selected.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.hash(self.mesh_hash);
        hasher.numbers(self.weights.weights());
    }

    fn byte_size(&self) -> usize {
        // The mesh is shared with its own wire.
        size_of_val(self.weights.weights())
    }

    fn summary(&self) -> String {
        let chosen = self.weights.vertices().len();
        format!("{chosen} of {}", count(self.weights.weights().len(), "vertex", "vertices"))
    }
}
