//! Vertices by the names of the faces they belong to.

use super::Selection;
use crate::mesh::face_names::names_of;
use crate::mesh::{Mesh, NamedBy};

/// Polygons between two questions whether to go on.
const STEP: usize = 1 << 16;

/// Why nothing can be selected by a name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// A mesh whose polygons have no names of this kind.
    #[error("the mesh has no {}: they come with imported meshes, and new faces have none", plural(.by))]
    NoNames {
        /// Groups or materials.
        by: NamedBy,
    },
    /// A name that no polygon has.
    #[error("the mesh has no {} \"{wanted}\"; it has {}", singular(.by), listed(.known))]
    Unknown {
        /// Group or material.
        by: NamedBy,
        /// The name.
        wanted: String,
        /// The names that are there.
        known: Vec<String>,
    },
}

fn singular(by: &NamedBy) -> &'static str {
    match by {
        NamedBy::Group => "group",
        NamedBy::Material => "material",
    }
}

fn plural(by: &NamedBy) -> &'static str {
    match by {
        NamedBy::Group => "groups",
        NamedBy::Material => "materials",
    }
}

fn listed(names: &[String]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

/// Weight 1 for the vertices of the polygons with a name; a vertex on the border of two has both.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`NameError`] where polygons have no names, or none has this one; it lists those there are.
pub fn by_name(
    mesh: &Mesh,
    by: NamedBy,
    wanted: &str,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, NameError> {
    let is_named = |names: &&String| !names.is_empty();
    let names = names_of(mesh, by).filter(|names| names.names().iter().any(|name| !name.is_empty()));
    let Some(names) = names else { return Err(NameError::NoNames { by }) };
    let Some(place) = names.names().iter().position(|name| name == wanted && !name.is_empty()) else {
        let known = names.names().iter().filter(is_named).cloned().collect();
        return Err(NameError::Unknown { by, wanted: wanted.to_owned(), known });
    };
    let mut chosen = vec![false; mesh.positions().len()];
    for (polygon, name) in names.places().iter().enumerate() {
        if polygon.is_multiple_of(STEP) && !progress(polygon as f64 / names.len() as f64) {
            return Ok(None);
        }
        if *name as usize == place {
            mesh.polygon(polygon).iter().for_each(|vertex| chosen[*vertex as usize] = true);
        }
    }
    Ok(Some(Selection::by(chosen.len(), |vertex| chosen[vertex])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceNames;
    use glam::DVec3;

    fn net() -> Mesh {
        let points = (0..5).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect();
        let mesh = Mesh::new(points, [[0_u32, 1, 2], [1, 2, 3], [2, 3, 4]]).unwrap();
        mesh.with_names(NamedBy::Material, FaceNames::new(["skin", "", "nail"])).unwrap()
    }

    #[test]
    fn the_vertices_of_named_faces_are_selected() {
        let found = by_name(&net(), NamedBy::Material, "nail", &|_| true).unwrap().unwrap();
        assert_eq!(found.weights(), [0.0, 0.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn a_name_that_is_not_there_is_refused_with_those_that_are() {
        let refused = |by, name: &str| by_name(&net(), by, name, &|_| true).unwrap_err().to_string();
        assert_eq!(refused(NamedBy::Material, "hair"), "the mesh has no material \"hair\"; it has \"skin\", \"nail\"");
        assert!(refused(NamedBy::Material, "").contains("no material \"\"; it has"));
        assert!(refused(NamedBy::Group, "hair").starts_with("the mesh has no groups: "));
    }

    #[test]
    fn it_stops_when_told_to() {
        assert_eq!(by_name(&net(), NamedBy::Material, "skin", &|_| false), Ok(None));
    }
}
