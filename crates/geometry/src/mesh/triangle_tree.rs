//! The triangles of a mesh in a hierarchy of boxes.

use glam::DVec3;

use super::Mesh;
use super::measure::corner_points;
use super::triangulate::triangles;

/// The [`triangles`] of a mesh in boxes that are halved at the median of the triangles' centres along the longest side,
/// down to 4 triangles. Making it takes O(n log n). Never empty.
#[derive(Clone, Debug)]
pub(super) struct TriangleTree {
    /// The root is first, and each left child follows its parent.
    pub(super) nodes: Vec<Node>,
    pub(super) triangles: Vec<Triangle>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) points: [DVec3; 3],
    pub(super) polygon: usize,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) content: Content,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Content {
    /// Places in the list of triangles.
    Leaf { from: usize, to: usize },
    /// The left child follows its parent.
    Inner { right: usize },
}

const LEAF: usize = 4;

impl TriangleTree {
    /// Sorts the triangles of a mesh; `None` where it has none.
    pub(super) fn new(mesh: &Mesh) -> Option<Self> {
        Self::among(mesh, &|_| true)
    }

    /// The same for those of its triangles that are `wanted`.
    pub(super) fn among(mesh: &Mesh, wanted: &dyn Fn(&Triangle) -> bool) -> Option<Self> {
        let mut polygon = 0;
        let mut list: Vec<Triangle> = triangles(mesh)
            .map(|corners| {
                while mesh.corner_range(polygon).end <= corners[0] {
                    polygon += 1;
                }
                Triangle { points: corner_points(mesh, corners), polygon }
            })
            .filter(wanted)
            .collect();
        if list.is_empty() {
            return None;
        }
        let count = list.len();
        let mut nodes = Vec::with_capacity(count);
        build(&mut nodes, &mut list, 0, count);
        Some(Self { nodes, triangles: list })
    }
}

/// Adds the node of `triangles[from..to]` and all below it.
fn build(nodes: &mut Vec<Node>, triangles: &mut [Triangle], from: usize, to: usize) {
    let own = &mut triangles[from..to];
    let corners = own.iter().flat_map(|t| t.points);
    let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let place = nodes.len();
    nodes.push(Node { low, high, content: Content::Leaf { from, to } });
    if own.len() <= LEAF {
        return;
    }
    let centre = |t: &Triangle| t.points[0] + t.points[1] + t.points[2];
    let (first, last) =
        own.iter().map(centre).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let axis = (last - first).max_position();
    let middle = own.len() / 2;
    own.select_nth_unstable_by(middle, |a, b| {
        centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.polygon.cmp(&b.polygon))
    });
    build(nodes, triangles, from, from + middle);
    let right = nodes.len();
    build(nodes, triangles, from + middle, to);
    nodes[place].content = Content::Inner { right };
}
