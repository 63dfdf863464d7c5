//! Scenes as glTF 2.0: one node and mesh an output, metres, +Y up.

use base64::Engine as _;
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Index, Material, Mesh, Node, Root, accessor, buffer, extensions, material, mesh};

use super::WriteError;
use super::output::{
    CornerWeld, check, checked_colour, checked_factor, distinct_corners, linear_from_srgb, mesh_name, single,
    unique_names,
};
use crate::mesh::triangulate::polygon_triangles;
use crate::scene::{CurveItem, MeshItem, Scene};

const FORMAT: &str = "glTF";

/// The scene as binary glTF 2.0 (`.glb`).
///
/// Each mesh output is one node, mesh, primitive of triangles and material (base colour in linear light); where a mesh
/// names materials at its polygons, one primitive and material a name, which all look as the output's. Groups have no place
/// in glTF. Corners that
/// agree in vertex, normal and UV are one vertex; normals are of unit length in `f32`, and glTF's v runs downward.
/// Quads are split along the shorter diagonal; triangles of which two corners are one vertex, as at poles, are left
/// out. Each output of curves is one mesh of line strips and, for closed curves, line loops, under an unlit material.
/// Equal scenes give equal bytes.
///
/// # Errors
/// [`WriteError`] where the scene or an output is empty, a number does not fit `f32`, a material is not finite, or the
/// file would pass 4 GiB.
pub fn glb(scene: &Scene) -> Result<Vec<u8>, WriteError> {
    let (root, binary) = Document::of(scene)?.finish(None)?;
    let json = padded(serialised(&root)?, b' ');
    let binary = padded(binary, 0);
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let length = |bytes: usize| u32::try_from(bytes).map_err(|_| too_large());
    let mut file = Vec::with_capacity(total);
    file.extend_from_slice(b"glTF");
    for number in [2, length(total)?, length(json.len())?] {
        file.extend_from_slice(&number.to_le_bytes());
    }
    file.extend_from_slice(b"JSON");
    file.extend_from_slice(&json);
    file.extend_from_slice(&length(binary.len())?.to_le_bytes());
    file.extend_from_slice(b"BIN\0");
    file.extend_from_slice(&binary);
    Ok(file)
}

/// The scene as glTF 2.0 in one JSON file (`.gltf`), its buffer embedded as base64. Otherwise as [`glb`].
///
/// # Errors
/// As [`glb`].
pub fn gltf(scene: &Scene) -> Result<Vec<u8>, WriteError> {
    let document = Document::of(scene)?;
    let data = base64::engine::general_purpose::STANDARD.encode(&document.binary);
    let (root, _) = document.finish(Some(format!("data:application/octet-stream;base64,{data}")))?;
    serialised(&root)
}

fn too_large() -> WriteError {
    WriteError::TooLarge { format: FORMAT, limit: "4 GiB" }
}

/// The document's types serialise without fail; were one to, the document would be beyond what JSON can carry.
fn serialised(root: &Root) -> Result<Vec<u8>, WriteError> {
    root.to_vec().map_err(|_| too_large())
}

fn padded(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}

/// A document being put together, and the bytes its accessors point into.
struct Document {
    root: Root,
    binary: Vec<u8>,
}

impl Document {
    fn of(scene: &Scene) -> Result<Self, WriteError> {
        check(scene)?;
        let asset = gltf_json::Asset {
            generator: Some(format!("Maquette {}", env!("CARGO_PKG_VERSION"))),
            ..gltf_json::Asset::default()
        };
        let mut document = Self { root: Root { asset, ..Root::default() }, binary: Vec::new() };
        let materials = unique_names(
            scene
                .meshes
                .iter()
                .map(|item| item.material.name.as_str())
                .chain(scene.curves.iter().map(|item| item.name.as_str())),
        );
        let mut materials = materials.into_iter();
        for item in &scene.meshes {
            document.add_mesh(item, materials.next())?;
        }
        for item in &scene.curves {
            document.add_curves(item, materials.next())?;
        }
        Ok(document)
    }

    fn finish(mut self, uri: Option<String>) -> Result<(Root, Vec<u8>), WriteError> {
        self.root.push(buffer::Buffer {
            byte_length: USize64::from(self.binary.len()),
            name: None,
            uri,
            extensions: None,
            extras: Default::default(),
        });
        let nodes = (0..self.root.nodes.len()).map(|index| Index::new(index as u32)).collect();
        let scene =
            self.root.push(gltf_json::Scene { extensions: None, extras: Default::default(), name: None, nodes });
        self.root.scene = Some(scene);
        Ok((self.root, self.binary))
    }

    fn add_mesh(&mut self, item: &MeshItem, material_name: Option<String>) -> Result<(), WriteError> {
        let mut weld = CornerWeld::new(item, item.mesh.normals().is_some(), true);
        let names = item.mesh.materials();
        // One primitive a name, in the order of their first use.
        let mut parts: Vec<Vec<u32>> = vec![Vec::new(); names.map_or(1, |names| names.names().len())];
        for polygon in 0..item.mesh.polygon_count() {
            let part = &mut parts[names.map_or(0, |names| names.places()[polygon] as usize)];
            for corner in sound_triangles(&item.mesh, polygon).into_iter().flatten() {
                part.push(weld.vertex(corner)?);
            }
        }
        if parts.iter().all(Vec::is_empty) {
            return Err(WriteError::EmptyMesh { name: mesh_name(item).to_owned() });
        }

        let mut attributes = std::collections::BTreeMap::new();
        let view = self.vertex_view(&weld.positions);
        let positions = self.position_accessor(view, 0, &weld.positions);
        attributes.insert(Checked::Valid(mesh::Semantic::Positions), positions);
        if !weld.normals.is_empty() {
            let view = self.vertex_view(&weld.normals);
            let accessor = self.accessor(view, 0, weld.normals.len(), float(), accessor::Type::Vec3);
            attributes.insert(Checked::Valid(mesh::Semantic::Normals), accessor);
        }
        if !weld.uvs.is_empty() {
            let view = self.vertex_view(&weld.uvs);
            let accessor = self.accessor(view, 0, weld.uvs.len(), float(), accessor::Type::Vec2);
            attributes.insert(Checked::Valid(mesh::Semantic::TexCoords(0)), accessor);
        }
        let mut primitives = Vec::new();
        for (part, indices) in parts.iter().enumerate().filter(|(_, indices)| !indices.is_empty()) {
            let indices = self.indices(indices, weld.positions.len());
            let own = names.map(|names| names.names()[part].clone()).filter(|name| !name.is_empty());
            let material = self.mesh_material(item, own.or_else(|| material_name.clone()))?;
            primitives.push(primitive(attributes.clone(), Some(indices), material, mesh::Mode::Triangles));
        }
        self.add_node(mesh_name(item), primitives);
        Ok(())
    }

    fn add_curves(&mut self, item: &CurveItem, material_name: Option<String>) -> Result<(), WriteError> {
        let mut points: Vec<[f32; 3]> = Vec::new();
        for curve in &item.curves {
            for (index, point) in curve.points().iter().enumerate() {
                points.push(single(point.to_array()).ok_or_else(|| WriteError::OutOfRange {
                    name: item.name.clone(),
                    what: "point",
                    index,
                })?);
            }
        }
        let material = self.curve_material(item, material_name)?;
        let view = self.vertex_view(&points);
        let mut primitives = Vec::with_capacity(item.curves.len());
        let mut first = 0;
        for curve in &item.curves {
            let end = first + curve.points().len();
            let accessor = self.position_accessor(view, first * 12, &points[first..end]);
            let attributes = [(Checked::Valid(mesh::Semantic::Positions), accessor)].into();
            let mode = if curve.is_closed() { mesh::Mode::LineLoop } else { mesh::Mode::LineStrip };
            primitives.push(primitive(attributes, None, material, mode));
            first = end;
        }
        self.add_node(&item.name, primitives);
        Ok(())
    }

    fn add_node(&mut self, name: &str, primitives: Vec<mesh::Primitive>) {
        let name = (!name.is_empty()).then(|| name.to_owned());
        let mesh = self.root.push(Mesh {
            extensions: None,
            extras: Default::default(),
            name: name.clone(),
            primitives,
            weights: None,
        });
        self.root.push(Node { mesh: Some(mesh), name, ..Node::default() });
    }

    fn mesh_material(&mut self, item: &MeshItem, name: Option<String>) -> Result<Index<Material>, WriteError> {
        let output = mesh_name(item);
        let colour = checked_colour(output, item.material.colour)?;
        let metallic = checked_factor(output, "metallic", item.material.metallic)?;
        let roughness = checked_factor(output, "roughness", item.material.roughness)?;
        let mut written = base_material(name, colour);
        written.pbr_metallic_roughness.metallic_factor = material::StrengthFactor(metallic as f32);
        written.pbr_metallic_roughness.roughness_factor = material::StrengthFactor(roughness as f32);
        written.double_sided = item.material.double_sided;
        Ok(self.root.push(written))
    }

    /// Lines have no normals to be lit by: readers that know the unlit extension show the colour as it is, the others
    /// are told of a rough non-metal.
    fn curve_material(&mut self, item: &CurveItem, name: Option<String>) -> Result<Index<Material>, WriteError> {
        const UNLIT: &str = "KHR_materials_unlit";
        let mut written = base_material(name, checked_colour(&item.name, item.colour)?);
        written.pbr_metallic_roughness.metallic_factor = material::StrengthFactor(0.0);
        written.extensions.get_or_insert_default().unlit = Some(extensions::material::Unlit {});
        if self.root.extensions_used.is_empty() {
            self.root.extensions_used.push(UNLIT.to_owned());
        }
        Ok(self.root.push(written))
    }

    /// Puts vertex data into the buffer under a view of its own. Its items are multiples of 4 bytes long, so that the
    /// stride is aligned too.
    fn vertex_view<const N: usize>(&mut self, items: &[[f32; N]]) -> Index<buffer::View> {
        let bytes: Vec<u8> = items.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        self.view(&bytes, Some(buffer::Stride(4 * N)), buffer::Target::ArrayBuffer)
    }

    fn indices(&mut self, indices: &[u32], vertices: usize) -> Index<Accessor> {
        // 65535 itself restarts a primitive and is not a vertex.
        let (bytes, kind): (Vec<u8>, _) = if vertices <= usize::from(u16::MAX) {
            (indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(), accessor::ComponentType::U16)
        } else {
            (indices.iter().flat_map(|i| i.to_le_bytes()).collect(), accessor::ComponentType::U32)
        };
        let view = self.view(&bytes, None, buffer::Target::ElementArrayBuffer);
        self.accessor(view, 0, indices.len(), kind, accessor::Type::Scalar)
    }

    fn view(&mut self, bytes: &[u8], stride: Option<buffer::Stride>, target: buffer::Target) -> Index<buffer::View> {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.root.push(buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: stride,
            name: None,
            target: Some(Checked::Valid(target)),
            extensions: None,
            extras: Default::default(),
        })
    }

    fn position_accessor(
        &mut self,
        view: Index<buffer::View>,
        offset: usize,
        positions: &[[f32; 3]],
    ) -> Index<Accessor> {
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for position in positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
        let index = self.accessor(view, offset, positions.len(), float(), accessor::Type::Vec3);
        if let Some(accessor) = self.root.accessors.get_mut(index.value()) {
            accessor.min = Some(low.to_vec().into());
            accessor.max = Some(high.to_vec().into());
        }
        index
    }

    fn accessor(
        &mut self,
        view: Index<buffer::View>,
        offset: usize,
        count: usize,
        kind: accessor::ComponentType,
        type_: accessor::Type,
    ) -> Index<Accessor> {
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: Some(USize64::from(offset)),
            count: USize64::from(count),
            component_type: Checked::Valid(accessor::GenericComponentType(kind)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(type_),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }
}

/// Corners of the triangles of a polygon, without those of which two corners are one vertex.
fn sound_triangles(mesh: &crate::mesh::Mesh, polygon: usize) -> Vec<[usize; 3]> {
    // At a pole the split of the quad is a draw; the corner kept is the same one in every quad around it.
    if let Some(corners) = distinct_corners(mesh, polygon)
        && let [a, b, c] = corners[..]
    {
        return vec![[a, b, c]];
    }
    let mut triangles = polygon_triangles(mesh, polygon);
    triangles.retain(|triangle| {
        let [a, b, c] = triangle.map(|corner| mesh.corners()[corner]);
        a != b && b != c && c != a
    });
    triangles
}

fn float() -> accessor::ComponentType {
    accessor::ComponentType::F32
}

fn primitive(
    attributes: std::collections::BTreeMap<Checked<mesh::Semantic>, Index<Accessor>>,
    indices: Option<Index<Accessor>>,
    material: Index<Material>,
    mode: mesh::Mode,
) -> mesh::Primitive {
    mesh::Primitive {
        attributes,
        extensions: None,
        extras: Default::default(),
        indices,
        material: Some(material),
        mode: Checked::Valid(mode),
        targets: None,
    }
}

/// A material with a base colour; the colour is sRGB and checked.
fn base_material(name: Option<String>, [r, g, b, alpha]: [f64; 4]) -> Material {
    let linear = [linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), alpha].map(|c| c as f32);
    Material {
        name: name.filter(|name| !name.is_empty()),
        alpha_mode: Checked::Valid(if alpha < 1.0 { material::AlphaMode::Blend } else { material::AlphaMode::Opaque }),
        pbr_metallic_roughness: material::PbrMetallicRoughness {
            base_color_factor: material::PbrBaseColorFactor(linear),
            ..material::PbrMetallicRoughness::default()
        },
        ..Material::default()
    }
}

#[cfg(test)]
mod tests;
