//! The results of a graph as a scene, ready to be written or drawn.

use maquette_geometry::mesh::Mesh;
use maquette_geometry::scene::{CurveItem, Material, MeshItem, Scene};
use maquette_graph::{Evaluation, NodeId};

use crate::wire;

/// Collects the results of these nodes, each under the name of its node: meshes and curves that `mesh-out`, `curves-out` and the
/// like give. What an evaluation was not asked for, or what failed, is left out.
pub fn scene(evaluation: &Evaluation, targets: &[NodeId]) -> Scene {
    let mut scene = Scene::default();
    for target in targets {
        let Some((outcome, values)) = evaluation.outcome(*target).zip(evaluation.values(*target)) else { continue };
        let name = outcome.name.clone();
        for value in values {
            if let Some(result) = value.get::<wire::MeshResult>() {
                let material = Material { name: name.clone(), ..result.material.clone() };
                let mesh: Mesh = (*result.mesh).clone().named(name.clone());
                scene.meshes.push(MeshItem { name: name.clone(), mesh, material });
            } else if let Some(result) = value.get::<wire::CurvesResult>() {
                scene.curves.push(CurveItem {
                    name: name.clone(),
                    curves: result.curves.clone(),
                    colour: result.colour,
                });
            }
        }
    }
    scene
}
