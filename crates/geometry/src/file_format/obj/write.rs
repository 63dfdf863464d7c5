//! Scenes as OBJ.

use std::collections::HashMap;

use super::FORMAT;
use super::material::{material_names, one_line, one_word};
use crate::file_format::WriteError;
use crate::file_format::output::{check, distinct_corners, mesh_name, unique_names};
use crate::mesh::FaceNames;
use crate::scene::{CurveItem, MeshItem, Scene};

/// The scene as OBJ.
///
/// Each output is one object (`o name`, blanks in names become `_`); polygons keep their corners, but for corners that
/// repeat the vertex before them, as at poles. Normals and UVs stand at the corners (`vn`, `vt`). Each curve is a group
/// (`g name`) and an `l` element; a closed one ends in its first point. Numbers have as many digits as it takes to
/// read the same `f64` again. Groups and materials of polygons are written where they change (`g`, `usemtl`). With
/// `material_library`, the name of the `.mtl` beside the file, materials are named
/// too: write [`material_library_bytes`](super::material_library_bytes) there.
///
/// # Errors
/// [`WriteError`] where the scene or an output is empty, or the library's name is not one line of text.
pub fn write(scene: &Scene, material_library: Option<&str>) -> Result<Vec<u8>, WriteError> {
    check(scene)?;
    let mut text = format!("# Maquette {}, metres, +Y up\n", env!("CARGO_PKG_VERSION"));
    if let Some(library) = material_library {
        if library.trim().is_empty() || library.contains(char::is_control) {
            return Err(WriteError::LibraryName { name: library.to_owned() });
        }
        text.push_str(&format!("mtllib {library}\n"));
    }
    let mut file = File { text, ..File::default() };
    let names: Vec<String> = scene
        .meshes
        .iter()
        .map(|item| one_word(mesh_name(item), "mesh"))
        .chain(scene.curves.iter().map(|item| one_word(&item.name, "curves")))
        .collect();
    let mut names = unique_names(names.iter().map(String::as_str)).into_iter();
    // A name lasts until the next one: where some meshes have names, all say theirs.
    let named = material_library.is_some() || scene.meshes.iter().any(|item| item.mesh.materials().is_some());
    for (item, material) in scene.meshes.iter().zip(material_names(scene)) {
        let name = names.next().unwrap_or_default();
        file.add_mesh(item, &name, named.then_some(material.as_str()));
    }
    for item in &scene.curves {
        let name = names.next().unwrap_or_default();
        file.add_curves(item, &name);
    }
    if file.vertices > i32::MAX as usize {
        return Err(WriteError::TooLarge { format: FORMAT, limit: "2147483647 vertices" });
    }
    Ok(file.text.into_bytes())
}

/// The text so far, and what has been counted in it. OBJ counts from 1 and through the whole file.
#[derive(Default)]
struct File {
    text: String,
    vertices: usize,
    uvs: HashMap<[u64; 2], usize>,
    normals: HashMap<[u64; 3], usize>,
}

impl File {
    fn add_mesh(&mut self, item: &MeshItem, name: &str, material: Option<&str>) {
        let mesh = &item.mesh;
        self.text.push_str(&format!("o {name}\n"));
        for position in mesh.positions() {
            line(&mut self.text, "v", position.to_array());
        }
        let uvs: Option<Vec<usize>> = mesh
            .uvs()
            .map(|uvs| uvs.iter().map(|uv| shared(&mut self.text, &mut self.uvs, "vt", uv.to_array())).collect());
        let normals: Option<Vec<usize>> = mesh.normals().map(|normals| {
            normals.iter().map(|normal| shared(&mut self.text, &mut self.normals, "vn", normal.to_array())).collect()
        });
        if let Some(material) = material.filter(|_| mesh.materials().is_none()) {
            self.text.push_str(&format!("usemtl {material}\n"));
        }
        let mut groups = Changes::of(mesh.groups());
        let mut materials = Changes::of(mesh.materials());
        for polygon in 0..mesh.polygon_count() {
            let Some(corners) = distinct_corners(mesh, polygon) else { continue };
            if let Some(group) = groups.at(polygon) {
                self.text.push_str(format!("g {}", one_line(group)).trim_end());
                self.text.push('\n');
            }
            if let Some(name) = materials.at(polygon) {
                // A polygon without a name has the material of the output.
                let name = if name.is_empty() { material.map(str::to_owned) } else { Some(one_line(name)) };
                name.into_iter().for_each(|name| self.text.push_str(&format!("usemtl {name}\n")));
            }
            self.text.push('f');
            for corner in corners {
                let vertex = self.vertices + 1 + mesh.corners()[corner] as usize;
                self.text.push_str(&match (&uvs, &normals) {
                    (Some(uvs), Some(normals)) => format!(" {vertex}/{}/{}", uvs[corner], normals[corner]),
                    (Some(uvs), None) => format!(" {vertex}/{}", uvs[corner]),
                    (None, Some(normals)) => format!(" {vertex}//{}", normals[corner]),
                    (None, None) => format!(" {vertex}"),
                });
            }
            self.text.push('\n');
        }
        self.vertices += mesh.positions().len();
    }

    fn add_curves(&mut self, item: &CurveItem, name: &str) {
        self.text.push_str(&format!("o {name}\n"));
        for (index, curve) in item.curves.iter().enumerate() {
            for point in curve.points() {
                line(&mut self.text, "v", point.to_array());
            }
            let first = self.vertices + 1;
            self.vertices += curve.points().len();
            self.text.push_str(&format!("g {}\nl", one_word(curve.name(), &format!("curve_{index}"))));
            for vertex in (first..=self.vertices).chain(curve.is_closed().then_some(first)) {
                self.text.push_str(&format!(" {vertex}"));
            }
            self.text.push('\n');
        }
    }
}

/// Where the name of polygons changes.
struct Changes<'a> {
    names: Option<&'a FaceNames>,
    last: Option<&'a str>,
}

impl<'a> Changes<'a> {
    fn of(names: Option<&'a FaceNames>) -> Self {
        Self { names, last: None }
    }

    /// The name of a polygon where it is not that of the one asked for before.
    fn at(&mut self, polygon: usize) -> Option<&'a str> {
        let name = self.names?.name(polygon);
        (self.last.replace(name) != Some(name)).then_some(name)
    }
}

fn line<const N: usize>(text: &mut String, keyword: &str, numbers: [f64; N]) {
    text.push_str(keyword);
    for number in numbers {
        // Adding zero makes the negative zero positive.
        text.push_str(&format!(" {}", number + 0.0));
    }
    text.push('\n');
}

/// The number of an attribute in the file; it is written out where it comes for the first time.
fn shared<const N: usize>(
    text: &mut String,
    known: &mut HashMap<[u64; N], usize>,
    keyword: &str,
    numbers: [f64; N],
) -> usize {
    let next = known.len() + 1;
    *known.entry(numbers.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
        line(text, keyword, numbers);
        next
    })
}
