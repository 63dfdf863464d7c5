//! The wire types of handles, of what they hold, and of meshes bound to them.

use std::sync::Arc;

use maquette_geometry::deform::laplacian::{
    BindError, BindOptions, Binding, Handle as HeldVertices, HandleTransform, Holds, Reconstruction,
};
use maquette_graph::{ContentHash, ContentHasher, Wire};

use super::{Mesh, Selection, count, hash_points, mesh_bytes};

/// Bytes that a binding takes for each free vertex beside its factors: stencils, pairs, rows. An estimate.
const BYTES_A_VERTEX: usize = 900;

/// The vertices of a handle and what it prescribes there.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldSelection {
    /// Its vertices: those with a weight of 0.5 or more.
    pub selection: Selection,
    /// What is prescribed there.
    pub holds: Holds,
}

/// What handles hold, without how they move: all that binding asks for, so that it is not done again while handles are
/// dragged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Held(pub Vec<HeldSelection>);

/// Vertices that move together, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Handle {
    /// Its vertices.
    pub held: HeldSelection,
    /// How they move.
    pub transform: HandleTransform,
}

/// Handles in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Handles(pub Vec<Handle>);

/// A mesh bound to what handles hold: both systems factored.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The binding.
    pub binding: Arc<Binding>,
    /// Hash of the mesh that is bound.
    pub mesh_hash: ContentHash,
    /// Which of its vertices are free; all of them without.
    pub region: Option<Selection>,
    /// What holds it.
    pub held: Held,
    /// What the second system keeps.
    pub reconstruction: Reconstruction,
}

impl Handles {
    /// What they hold.
    pub fn held(&self) -> Held {
        Held(self.0.iter().map(|handle| handle.held.clone()).collect())
    }

    /// How they move, in order.
    pub fn transforms(&self) -> Vec<HandleTransform> {
        self.0.iter().map(|handle| handle.transform).collect()
    }
}

impl Held {
    /// Whether two hold the same vertices in the same order, whatever mesh they were selected on.
    pub fn is_same_as(&self, other: &Self) -> bool {
        let same =
            |(a, b): (&HeldSelection, &HeldSelection)| a.holds == b.holds && a.selection.weights == b.selection.weights;
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(same)
    }
}

impl Bound {
    /// Binds a mesh with the hash given; see [`Binding::new`].
    ///
    /// # Errors
    /// As [`Binding::new`].
    pub fn new(
        mesh: &Mesh,
        mesh_hash: ContentHash,
        region: Option<Selection>,
        held: Held,
        reconstruction: Reconstruction,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Self, BindError> {
        let handles: Vec<HeldVertices<'_>> =
            held.0.iter().map(|h| HeldVertices { selection: &h.selection.weights, holds: h.holds }).collect();
        let free = region.as_ref().map(|region| &*region.weights);
        let binding = Binding::new(mesh.0.clone(), free, &handles, &BindOptions { reconstruction }, progress)?;
        Ok(Self { binding: Arc::new(binding), mesh_hash, region, held, reconstruction })
    }
}

fn hash_held(hasher: &mut ContentHasher, held: &HeldSelection) {
    held.selection.hash_content(hasher);
    hasher.integer(match held.holds {
        Holds::Both => 0,
        Holds::Position => 1,
        Holds::Gradient => 2,
    });
}

impl Wire for Held {
    const NAME: &'static str = "held";
    const DESCRIPTION: &'static str = "The vertices that handles hold, without how they move: what a mesh is bound to.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.len() as u64);
        self.0.iter().for_each(|held| hash_held(hasher, held));
    }

    fn byte_size(&self) -> usize {
        self.0.iter().map(|held| held.selection.byte_size()).sum()
    }

    fn summary(&self) -> String {
        summary(self.0.iter())
    }
}

impl Wire for Handles {
    const NAME: &'static str = "handles";
    const DESCRIPTION: &'static str = "Handles in order: vertices that move together, and how.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.len() as u64);
        for handle in &self.0 {
            hash_held(hasher, &handle.held);
            let moved = &handle.transform;
            let stretch = moved.stretch();
            let parts = [moved.pivot(), moved.translation_vector(), moved.rotation_vector()];
            hash_points(hasher, &parts);
            hash_points(hasher, &[stretch.x_axis, stretch.y_axis, stretch.z_axis]);
        }
    }

    fn byte_size(&self) -> usize {
        self.0.iter().map(|handle| size_of::<Handle>() + handle.held.selection.byte_size()).sum()
    }

    fn summary(&self) -> String {
        summary(self.0.iter().map(|handle| &handle.held))
    }
}

impl Wire for Bound {
    const NAME: &'static str = "bound";
    const DESCRIPTION: &'static str = "A mesh bound to its handles, ready to be deformed wherever they go.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.hash(self.mesh_hash);
        hasher.integer(u64::from(self.region.is_some()));
        if let Some(region) = &self.region {
            region.hash_content(hasher);
        }
        self.held.hash_content(hasher);
        hasher.integer(match self.reconstruction {
            Reconstruction::Coordinates => 0,
            Reconstruction::Edges => 1,
        });
    }

    fn byte_size(&self) -> usize {
        let report = self.binding.report();
        mesh_bytes(self.binding.mesh()) + report.factor_bytes + report.influence_bytes + BYTES_A_VERTEX * report.free
    }

    fn summary(&self) -> String {
        let free = count(self.binding.report().free, "free vertex", "free vertices");
        format!("{free}, {}", count(self.held.0.len(), "handle", "handles"))
    }
}

fn summary<'a>(held: impl ExactSizeIterator<Item = &'a HeldSelection>) -> String {
    let handles = count(held.len(), "handle", "handles");
    let vertices: usize = held.map(|held| held.selection.weights.vertices().len()).sum();
    format!("{handles}, {}", count(vertices, "vertex", "vertices"))
}
