//! The material library beside an OBJ.

use std::collections::BTreeSet;

use crate::file_format::WriteError;
use crate::file_format::output::{checked_colour, checked_factor, mesh_name, unique_names};
use crate::scene::Scene;

/// The material library (`.mtl`) that belongs to [`write`](super::write): one material a mesh output, in its order.
///
/// `Kd` is the colour as it shows, sRGB from 0 to 1, `d` its alpha; `Pr` and `Pm` are roughness and metallic of the
/// physically based extension, for readers that know it. Materials that a mesh names at its polygons look as the output's;
/// of those with one name, the first counts.
///
/// # Errors
/// [`WriteError::Material`] where a colour or factor is not finite.
pub fn material_library_bytes(scene: &Scene) -> Result<Vec<u8>, WriteError> {
    let mut text = format!("# Maquette {}\n", env!("CARGO_PKG_VERSION"));
    let mut known = BTreeSet::new();
    for (item, own) in scene.meshes.iter().zip(material_names(scene)) {
        let output = mesh_name(item);
        let [r, g, b, alpha] = checked_colour(output, item.material.colour)?;
        let roughness = checked_factor(output, "roughness", item.material.roughness)?;
        let metallic = checked_factor(output, "metallic", item.material.metallic)?;
        let of_faces = item.mesh.materials().map_or(&[][..], |names| names.names());
        let of_faces = of_faces.iter().map(|name| one_line(name)).filter(|name| !name.is_empty());
        for name in std::iter::once(own).chain(of_faces).filter(|name| known.insert(name.clone())) {
            text.push_str(&format!(
                "\nnewmtl {name}\nKd {r} {g} {b}\nKs 0 0 0\nd {alpha}\nillum 1\nPr {roughness}\nPm {metallic}\n"
            ));
        }
    }
    Ok(text.into_bytes())
}

/// The name of each mesh output's material, all different.
pub(super) fn material_names(scene: &Scene) -> Vec<String> {
    let names: Vec<String> = scene.meshes.iter().map(|item| one_word(&item.material.name, "material")).collect();
    unique_names(names.iter().map(String::as_str))
}

/// The name as one word, since readers differ on where a name with a space ends; `fallback` where it is empty.
pub(super) fn one_word(name: &str, fallback: &str) -> String {
    let word: String = name.trim().chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if word.is_empty() { fallback.to_owned() } else { word }
}

/// The name of a group or material as it may stand on a line: what polygons are named by goes back as it came.
pub(super) fn one_line(name: &str) -> String {
    name.trim().chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}
