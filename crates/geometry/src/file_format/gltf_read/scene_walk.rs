//! The node tree, walked without trusting it to be one.

use glam::{DMat4, DQuat, DVec3};
use gltf_json::{Index, Mesh, Node, Root};

use super::malformed;
use crate::file_format::ReadError;

/// A node that shows a mesh.
pub(super) struct Placed {
    /// Index of the node.
    pub(super) node: usize,
    pub(super) mesh: Index<Mesh>,
    /// From the mesh's space to the world.
    pub(super) world: DMat4,
}

/// A node of the scene.
pub(super) struct Visited {
    /// Index of the node.
    pub(super) node: usize,
    /// Index of the node above, where there is one.
    pub(super) parent: Option<usize>,
    /// From the node's space to the world.
    pub(super) world: DMat4,
}

/// The nodes of the scene that show a mesh, parents before children and siblings in order.
pub(super) fn nodes_with_meshes(root: &Root) -> Result<Vec<Placed>, ReadError> {
    let placed = |visited: Visited| {
        let node = root.nodes.get(visited.node)?;
        // A skinned mesh stands where its skeleton is, wherever its node is (glTF 2.0, 3.7.3.3).
        let world = if node.skin.is_some() { DMat4::IDENTITY } else { visited.world };
        Some(Placed { node: visited.node, mesh: node.mesh?, world })
    };
    Ok(nodes(root)?.into_iter().filter_map(placed).collect())
}

/// The nodes of the scene, parents before children and siblings in order.
pub(super) fn nodes(root: &Root) -> Result<Vec<Visited>, ReadError> {
    let mut visited = vec![false; root.nodes.len()];
    let mut pending: Vec<(usize, Option<usize>, DMat4)> =
        roots(root)?.into_iter().rev().map(|node| (node, None, DMat4::IDENTITY)).collect();
    let mut found = Vec::new();
    while let Some((index, parent, above)) = pending.pop() {
        let place = || format!("node {index}");
        let node = root.nodes.get(index).ok_or_else(|| malformed(place(), "it is not there"))?;
        if std::mem::replace(&mut visited[index], true) {
            return Err(malformed(place(), "it has two parents, or is its own ancestor"));
        }
        let world = above * local(node);
        found.push(Visited { node: index, parent, world });
        let children = node.children.as_deref().unwrap_or_default();
        pending.extend(children.iter().rev().map(|child| (child.value(), Some(index), world)));
    }
    Ok(found)
}

fn roots(root: &Root) -> Result<Vec<usize>, ReadError> {
    let scene = root.scene.map_or(0, |scene| scene.value());
    if let Some(scene) = root.scenes.get(scene) {
        return Ok(scene.nodes.iter().map(|node| node.value()).collect());
    }
    if root.scene.is_some() {
        return Err(malformed("JSON", format!("the default scene {scene} is not there")));
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    Ok((0..root.nodes.len()).filter(|&node| !is_child[node]).collect())
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from(v.map(f64::from)));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| {
        let [x, y, z, w] = q.0.map(f64::from);
        let length = (x * x + y * y + z * z + w * w).sqrt();
        if length > 0.0 { DQuat::from_xyzw(x / length, y / length, z / length, w / length) } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        rotation,
        vector(node.translation, DVec3::ZERO),
    )
}
