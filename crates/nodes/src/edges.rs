//! Which borders lie along the edges of sections of points.

use glam::DVec3;
use maquette_geometry::border::{Border, directions_beside};
use maquette_geometry::curve::Curve;
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::Beside;

/// Largest distance of an edge from a border along which it lies, as a share of the sections' size: generators place
/// their points on the curves, not on the points of these.
const ALONG: f64 = 0.005;

/// Directions beside the first and last section and, where sections are open, the sides.
pub(crate) struct Edges {
    directions: [Option<Vec<DVec3>>; 4],
}

impl Edges {
    /// # Errors
    /// A border that lies along no edge, by name.
    pub(crate) fn of(sections: &Sections, borders: &[Border]) -> Result<Self, String> {
        let mut directions = [const { None }; 4];
        if borders.is_empty() {
            return Ok(Self { directions });
        }
        let side = |column: usize| sections.iter().map(|section| section[column]).collect::<Vec<_>>();
        let ends = [0, sections.len() - 1].map(|row| (sections.section(row).to_vec(), sections.is_closed()));
        let sides = [0, sections.nodes() - 1].map(|column| (side(column), false));
        let count = if sections.is_closed() { 2 } else { 4 };
        // An edge that is a point is no curve, and needs no directions.
        let edges: Vec<Option<Curve>> = ends
            .into_iter()
            .chain(sides)
            .take(count)
            .map(|(points, closed)| Curve::new("edge", points, closed).ok())
            .collect();
        let snap = ALONG * sections.diagonal();
        let beside = |border: &Border| edges.iter().flatten().any(|edge| border.directions_at(edge, snap).is_some());
        if let Some(border) = borders.iter().find(|border| !beside(border)) {
            return Err(format!(
                "border \"{}\" lies along no edge of the sections: link the borders with which these were made",
                border.curve().name()
            ));
        }
        for (found, edge) in directions.iter_mut().zip(&edges) {
            *found = edge.as_ref().and_then(|edge| directions_beside(borders, edge, snap));
        }
        Ok(Self { directions })
    }

    pub(crate) fn beside(&self) -> Beside<'_> {
        let [start, end, first, last] = self.directions.each_ref().map(|directions| directions.as_deref());
        Beside { ends: [start, end], sides: [first, last] }
    }
}
