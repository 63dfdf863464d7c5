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

    /// Adds what another says.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.notes.append(&mut other.notes);
        self.warnings.append(&mut other.warnings);
        self.figures.append(&mut other.figures);
    }

    /// Takes over what a node within a body said, with the way to that node before it.
    pub(crate) fn absorb(&mut self, inside: &str, other: &Self) {
        self.notes.extend(other.notes.iter().map(|note| format!("{inside}: {note}")));
        self.warnings.extend(other.warnings.iter().map(|warning| format!("{inside}: {warning}")));
        let figures = other.figures.iter();
        self.figures
            .extend(figures.map(|figure| Figure { name: format!("{inside}/{}", figure.name), ..figure.clone() }));
    }
}
