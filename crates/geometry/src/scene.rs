//! What leaves the house: named meshes and curves with materials, ready to be written or drawn.

use crate::{curve::Curve, mesh::Mesh};

/// A physically based material, glTF's metallic-roughness model.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name; in a file each output has its own material.
    pub name: String,
    /// Base colour, sRGB with alpha, each 0 to 1. File writers convert to the space their format wants.
    pub colour: [f64; 4],
    /// 0 for cloth, skin, plaster; 1 for bare metal.
    pub metallic: f64,
    /// 0 for a mirror, 1 for chalk.
    pub roughness: f64,
    /// Whether back faces are drawn too: wanted for open surfaces.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: "clay".to_owned(),
            colour: [0.80, 0.72, 0.64, 1.0],
            metallic: 0.0,
            roughness: 0.7,
            double_sided: false,
        }
    }
}

/// Meshes of one output, under one name and material.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshItem {
    /// Name of the output.
    pub name: String,
    /// The mesh.
    pub mesh: Mesh,
    /// How it looks.
    pub material: Material,
}

/// Curves of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveItem {
    /// Name of the output.
    pub name: String,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Colour, sRGB with alpha, each 0 to 1.
    pub colour: [f64; 4],
}

/// Everything one evaluation puts out, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Meshes.
    pub meshes: Vec<MeshItem>,
    /// Curves.
    pub curves: Vec<CurveItem>,
}
