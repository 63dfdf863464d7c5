//! A weight for each vertex.

use crate::mesh::Adjacency;

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
        let held = |weight: f64| if weight.is_nan() { 0.0 } else { weight.clamp(0.0, 1.0) };
        Self((0..vertices).map(|vertex| held(weight(vertex))).collect())
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

    /// What both select: the smaller weight of each vertex.
    ///
    /// # Errors
    /// [`SelectionError::Sizes`] where they belong to different meshes; so for [`Selection::or`] and
    /// [`Selection::minus`].
    pub fn and(&self, other: &Self) -> Result<Self, SelectionError> {
        self.with(other, f64::min)
    }

    /// What one of both selects: the larger weight.
    ///
    /// # Errors
    /// As [`Selection::and`].
    pub fn or(&self, other: &Self) -> Result<Self, SelectionError> {
        self.with(other, f64::max)
    }

    /// What this selects and the other does not: the smaller of this weight and 1 less the other.
    ///
    /// # Errors
    /// As [`Selection::and`].
    pub fn minus(&self, other: &Self) -> Result<Self, SelectionError> {
        self.with(other, |own, other| own.min(1.0 - other))
    }

    /// 1 less each weight.
    #[must_use]
    pub fn inverted(&self) -> Self {
        Self(self.0.iter().map(|weight| 1.0 - weight).collect())
    }

    /// Each weight the largest within some edges.
    ///
    /// # Errors
    /// [`SelectionError::Sizes`] where the neighbours are those of another mesh; so for [`Selection::shrunk`] and
    /// [`Selection::smoothed`].
    pub fn grown(&self, adjacency: &Adjacency, edges: usize) -> Result<Self, SelectionError> {
        self.spread(adjacency, edges, |own, ring| ring.fold(own, f64::max))
    }

    /// Each weight the smallest within some edges.
    ///
    /// # Errors
    /// As [`Selection::grown`].
    pub fn shrunk(&self, adjacency: &Adjacency, edges: usize) -> Result<Self, SelectionError> {
        self.spread(adjacency, edges, |own, ring| ring.fold(own, f64::min))
    }

    /// Each weight the mean of itself and the mean of its neighbours, so often.
    ///
    /// # Errors
    /// As [`Selection::grown`].
    pub fn smoothed(&self, adjacency: &Adjacency, times: usize) -> Result<Self, SelectionError> {
        self.spread(adjacency, times, |own, ring| {
            let (sum, count) = ring.fold((0.0, 0_u32), |(sum, count), weight| (sum + weight, count + 1));
            if count == 0 { own } else { 0.5 * (own + sum / f64::from(count)) }
        })
    }

    fn with(&self, other: &Self, pick: impl Fn(f64, f64) -> f64) -> Result<Self, SelectionError> {
        self.same_size(other.0.len())?;
        Ok(Self(self.0.iter().zip(&other.0).map(|(a, b)| pick(*a, *b)).collect()))
    }

    fn spread(
        &self,
        adjacency: &Adjacency,
        times: usize,
        pick: impl Fn(f64, &mut dyn Iterator<Item = f64>) -> f64,
    ) -> Result<Self, SelectionError> {
        self.same_size(adjacency.vertices())?;
        let mut weights = self.0.clone();
        for _ in 0..times {
            let from = weights;
            let of = |vertex: usize| {
                pick(from[vertex], &mut adjacency.ring(vertex as u32).iter().map(|k| from[*k as usize]))
            };
            weights = (0..from.len()).map(of).collect();
            if weights == from {
                break;
            }
        }
        Ok(Self(weights))
    }

    fn same_size(&self, second: usize) -> Result<(), SelectionError> {
        let first = self.0.len();
        if first == second { Ok(()) } else { Err(SelectionError::Sizes { first, second }) }
    }
}
