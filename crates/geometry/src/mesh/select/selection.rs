//! A weight for each vertex.

/// Weight from which on a vertex counts as selected.
const THRESHOLD: f64 = 0.5;

/// A weight between 0 and 1 for each vertex of a mesh; from 0.5 on a vertex counts as selected.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection(Vec<f64>);

/// Why weights make no selection, or selections do not go together.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SelectionError {
    /// A weight that is no number between 0 and 1.
    #[error("the weight of vertex {vertex} is {weight}: weights are between 0 and 1")]
    Weight {
        /// Index of the vertex.
        vertex: usize,
        /// What was given.
        weight: f64,
    },
    /// Selections of different meshes.
    #[error("one selection has {first} weights and the other {second}: combine selections of the same mesh")]
    Sizes {
        /// Weights of the first one.
        first: usize,
        /// Weights of the second one.
        second: usize,
    },
}

impl Selection {
    /// Takes weights, one a vertex.
    ///
    /// # Errors
    /// [`SelectionError::Weight`] where one is not between 0 and 1.
    pub fn new(weights: Vec<f64>) -> Result<Self, SelectionError> {
        match weights.iter().position(|w| !(0.0..=1.0).contains(w)) {
            Some(vertex) => Err(SelectionError::Weight { vertex, weight: weights[vertex] }),
            None => Ok(Self(weights)),
        }
    }

    /// Weight 1 for the vertices for which `is_in` holds, 0 for the others.
    pub fn by(vertices: usize, is_in: impl Fn(usize) -> bool) -> Self {
        Self((0..vertices).map(|vertex| f64::from(u8::from(is_in(vertex)))).collect())
    }

    /// Weights as a function gives them, held between 0 and 1; one that is not a number counts as 0.
    pub fn weighted(vertices: usize, weight: impl Fn(usize) -> f64) -> Self {
        Self((0..vertices).map(|vertex| weight(vertex).max(0.0).min(1.0)).collect())
    }

    /// The weights, one a vertex.
    pub fn weights(&self) -> &[f64] {
        &self.0
    }

    /// Whether a vertex is selected; one that is not there is not.
    pub fn contains(&self, vertex: usize) -> bool {
        self.0.get(vertex).is_some_and(|weight| *weight >= THRESHOLD)
    }

    /// The selected vertices, ascending.
    pub fn vertices(&self) -> Vec<u32> {
        (0..self.0.len()).filter(|v| self.contains(*v)).map(|v| v as u32).collect()
    }
}
