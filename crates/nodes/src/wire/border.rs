//! The wire type of borders.

use maquette_geometry::border::Border;
use maquette_graph::{ContentHasher, Wire};

use super::{count, curve_bytes, hash_curve, hash_points};

/// Borders of surfaces and meshes, which detail generators and blends can continue smoothly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Borders(pub Vec<Border>);

impl Wire for Borders {
    const NAME: &'static str = "borders";
    const DESCRIPTION: &'static str = "Curves at which a surface or mesh ends, with the directions in which it would go on: what a generator continues.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.len() as u64);
        for border in &self.0 {
            hash_curve(hasher, border.curve());
            hash_points(hasher, border.directions());
        }
    }

    fn byte_size(&self) -> usize {
        self.0.iter().map(|border| curve_bytes(border.curve()) + size_of_val(border.directions())).sum()
    }

    fn summary(&self) -> String {
        let points: usize = self.0.iter().map(|border| border.directions().len()).sum();
        format!("{}, {}", count(self.0.len(), "border", "borders"), count(points, "point", "points"))
    }
}
