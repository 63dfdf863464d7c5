//! A stack of cross-sections with corresponding points: what generators make and surfaces are skinned through.

pub mod order;

use glam::DVec3;

/// Sections in order, each with the same number of points; point `j` of one section corresponds to point `j` of the
/// next. A section whose points all coincide is a pole (the tip of a head, say).
///
/// Invariants, kept by the constructor: at least two sections of at least two points (three where closed), every
/// coordinate finite, rail columns in range.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    points: Vec<DVec3>,
    nodes: usize,
    closed: bool,
    rails: Vec<usize>,
}

/// Why points do not make sections.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SectionsError {
    /// Fewer than two sections.
    #[error("{found} section(s) given, and a surface needs at least 2")]
    TooFewSections {
        /// Sections found.
        found: usize,
    },
    /// Fewer points in a section than it needs.
    #[error("sections of {found} point(s) given, and they need at least {needed}")]
    TooFewNodes {
        /// Points a section.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// A section with another number of points than the first.
    #[error("section {section} has {found} points, section 0 has {expected}: resample them to one count")]
    UnequalNodes {
        /// Index of the section, counted from 0.
        section: usize,
        /// Its points.
        found: usize,
        /// Points of the first section.
        expected: usize,
    },
    /// A coordinate that is not a number or is infinite.
    #[error("section {section}, point {node}: a coordinate is not a finite number")]
    NotFinite {
        /// Index of the section, counted from 0.
        section: usize,
        /// Index of the point in its section.
        node: usize,
    },
}

impl Sections {
    /// Makes sections from rows of points.
    ///
    /// `closed` says whether each section is a loop (its first point is not repeated). `rails` are the point indices
    /// at which drawn curves run along the stack; indices out of range are dropped.
    ///
    /// # Errors
    /// [`SectionsError`] where the rows do not fit together.
    pub fn new(rows: Vec<Vec<DVec3>>, closed: bool, mut rails: Vec<usize>) -> Result<Self, SectionsError> {
        if rows.len() < 2 {
            return Err(SectionsError::TooFewSections { found: rows.len() });
        }
        let nodes = rows[0].len();
        let needed = if closed { 3 } else { 2 };
        if nodes < needed {
            return Err(SectionsError::TooFewNodes { found: nodes, needed });
        }
        for (section, row) in rows.iter().enumerate() {
            if row.len() != nodes {
                return Err(SectionsError::UnequalNodes { section, found: row.len(), expected: nodes });
            }
            if let Some(node) = row.iter().position(|p| !p.is_finite()) {
                return Err(SectionsError::NotFinite { section, node });
            }
        }
        rails.retain(|rail| *rail < nodes);
        Ok(Self { points: rows.concat(), nodes, closed, rails })
    }

    /// Number of sections.
    pub fn len(&self) -> usize {
        self.points.len() / self.nodes
    }

    /// Never true: there are at least two sections.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Points of each section.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Whether each section is a loop.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Point indices at which drawn curves run along the stack.
    pub fn rails(&self) -> &[usize] {
        &self.rails
    }

    /// The points of section `index`.
    pub fn section(&self, index: usize) -> &[DVec3] {
        &self.points[index * self.nodes..(index + 1) * self.nodes]
    }

    /// The sections in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[DVec3]> {
        self.points.chunks_exact(self.nodes)
    }

    /// All points, section after section.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Mean of a section's points.
    pub fn centre(&self, index: usize) -> DVec3 {
        let section = self.section(index);
        section.iter().copied().sum::<DVec3>() / section.len() as f64
    }

    /// Diagonal of the box around all points.
    pub fn diagonal(&self) -> f64 {
        let (low, high) =
            self.points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        (high - low).length()
    }

    /// Whether all points of a section coincide to within 1e-9 of the diagonal of all sections.
    pub fn is_pole(&self, index: usize) -> bool {
        let section = self.section(index);
        let tolerance = 1e-9 * self.diagonal();
        section.iter().all(|p| p.distance(section[0]) <= tolerance)
    }
}
