//! What a node says beside its values: cached with them and shown to the artist.

/// A named number with its unit, such as a largest gap in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name, `kebab-case`.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Unit, such as `m`; may be empty.
    pub unit: &'static str,
}

/// Notes, warnings and figures of one run of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// What the node decided, in plain words.
    pub notes: Vec<String>,
    /// What will probably disappoint the artist, and what to do about it.
    pub warnings: Vec<String>,
    /// Measured numbers.
    pub figures: Vec<Figure>,
}

impl Report {
    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.notes.is_empty() && self.warnings.is_empty() && self.figures.is_empty()
    }
}
