//! Names of polygons: what files call groups and materials.

use std::collections::BTreeMap;

use super::{Mesh, MeshError};

/// A name for each polygon of a mesh. An empty one stands for none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceNames {
    names: Vec<String>,
    /// The place of each polygon's name.
    of: Vec<u32>,
}

impl FaceNames {
    /// The names of polygons one after the other; those that come back are kept once, in the order of their first use.
    pub fn new<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> Self {
        let mut made = Self::default();
        let mut known: BTreeMap<String, u32> = BTreeMap::new();
        for name in names {
            // Polygons of one name mostly lie one behind the other.
            let last = made.of.last().copied().filter(|last| made.names[*last as usize] == name.as_ref());
            let place = last.unwrap_or_else(|| match known.get(name.as_ref()) {
                Some(place) => *place,
                None => {
                    let place = made.names.len() as u32;
                    made.names.push(name.as_ref().to_owned());
                    known.insert(name.as_ref().to_owned(), place);
                    place
                }
            });
            made.of.push(place);
        }
        made
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.of.len()
    }

    /// Whether it is for a mesh without polygons.
    pub fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// The different names, each once, in the order of their first use.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The place in [`FaceNames::names`] of each polygon's name.
    pub fn places(&self) -> &[u32] {
        &self.of
    }

    /// The name of a polygon, which must be less than [`FaceNames::len`].
    pub fn name(&self, polygon: usize) -> &str {
        &self.names[self.of[polygon] as usize]
    }

    /// The name of each polygon in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        (0..self.len()).map(|polygon| self.name(polygon))
    }

    /// Bytes they take.
    pub fn byte_size(&self) -> usize {
        size_of_val(self.of.as_slice()) + self.names.iter().map(|name| size_of::<String>() + name.len()).sum::<usize>()
    }
}

/// What polygons are named by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedBy {
    /// Groups: `g` in OBJ; parts that were joined.
    Group,
    /// Materials: `usemtl` in OBJ, a primitive's material in glTF.
    Material,
}

impl NamedBy {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Group, Self::Material];
}

/// The names that `mesh` has of this kind.
pub fn names_of(mesh: &Mesh, by: NamedBy) -> Option<&FaceNames> {
    match by {
        NamedBy::Group => mesh.groups(),
        NamedBy::Material => mesh.materials(),
    }
}

/// Gives `made` the groups and materials of `mesh`, each polygon those of the polygon that it comes from. `None` for one
/// that comes from nowhere: its names are empty.
///
/// # Errors
/// [`MeshError`] where there is another number of sources than of polygons.
pub(crate) fn carried(mut made: Mesh, mesh: &Mesh, sources: &[Option<usize>]) -> Result<Mesh, MeshError> {
    for by in NamedBy::ALL {
        if let Some(names) = names_of(mesh, by) {
            let name = |source: &Option<usize>| source.map_or("", |polygon| names.name(polygon));
            made = made.with_names(by, FaceNames::new(sources.iter().map(name)))?;
        }
    }
    Ok(made)
}

/// The polygons for which `keep` answers `true`, with the vertices they use in their order, and all that belongs to them.
///
/// # Errors
/// None for a mesh that exists; the constructor checks all the same.
pub fn polygons_where(mesh: &Mesh, keep: impl Fn(usize) -> bool) -> Result<Mesh, MeshError> {
    let kept: Vec<usize> = (0..mesh.polygon_count()).filter(|polygon| keep(*polygon)).collect();
    let mut used = vec![false; mesh.positions().len()];
    kept.iter().flat_map(|polygon| mesh.polygon(*polygon)).for_each(|vertex| used[*vertex as usize] = true);
    let mut places = vec![0_u32; used.len()];
    let mut positions = Vec::new();
    for (vertex, _) in used.iter().enumerate().filter(|(_, used)| **used) {
        places[vertex] = positions.len() as u32;
        positions.push(mesh.positions()[vertex]);
    }
    let corners = || kept.iter().flat_map(|polygon| mesh.corner_range(*polygon));
    let vertices = corners().map(|corner| places[mesh.corners()[corner] as usize]).collect();
    let counts = kept.iter().map(|polygon| mesh.polygon(*polygon).len());
    let mut part = Mesh::from_corners(positions, vertices, counts)?.named(mesh.name());
    if let Some(normals) = mesh.normals() {
        part = part.with_normals(corners().map(|corner| normals[corner]).collect())?;
    }
    if let Some(uvs) = mesh.uvs() {
        part = part.with_uvs(corners().map(|corner| uvs[corner]).collect())?;
    }
    let sources: Vec<Option<usize>> = kept.into_iter().map(Some).collect();
    carried(part, mesh, &sources)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn names_are_kept_once_in_the_order_of_their_use() {
        let names = FaceNames::new(["b", "b", "", "a", "b"]);
        assert_eq!(names.names(), ["b", "", "a"]);
        assert_eq!(names.places(), [0, 0, 1, 2, 0]);
        assert_eq!(names.iter().collect::<Vec<_>>(), ["b", "b", "", "a", "b"]);
        assert!(FaceNames::new([""; 0]).is_empty());
    }

    #[test]
    fn some_polygons_are_taken_with_what_belongs_to_them() {
        let points = (0..5).map(|i| DVec3::splat(f64::from(i))).collect();
        let mesh = Mesh::new(points, [[0_u32, 1, 2], [4, 2, 1], [1, 2, 3]]).unwrap().named("all");
        let mesh = mesh.with_uvs((0..9).map(|i| DVec2::splat(f64::from(i))).collect()).unwrap();
        let mesh = mesh.with_names(NamedBy::Group, FaceNames::new(["x", "y", "x"])).unwrap();
        let part = polygons_where(&mesh, |polygon| polygon == 1).unwrap();
        assert_eq!(part.positions(), [1.0, 2.0, 4.0].map(DVec3::splat));
        assert_eq!(part.polygon(0), [2, 1, 0]);
        assert_eq!(part.uvs().unwrap()[0], DVec2::splat(3.0));
        assert_eq!(part.groups().unwrap().names(), ["y"]);
        assert_eq!((part.name(), part.materials()), ("all", None));
        assert_eq!(polygons_where(&mesh, |_| false).unwrap().polygon_count(), 0);
    }

    #[test]
    fn another_number_of_names_is_refused() {
        let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], [[0_u32, 1, 2]]).unwrap();
        let refused = mesh.with_names(NamedBy::Material, FaceNames::new(["a", "b"])).unwrap_err();
        assert_eq!(refused, MeshError::NameCount { found: 2, polygons: 1 });
    }
}
