//! glTF 2.0 into meshes and skeletons.

mod container;
mod primitive;
mod scene_walk;
mod skeleton;

use container::Container;
use gltf_json::mesh;
use primitive::{Attributes, TriangleSoup};
pub use skeleton::{BoneError, Joint, Skeleton, skeleton};

use super::ReadError;
use super::pace::Pace;
use crate::mesh::Mesh;

const FORMAT: &str = "glTF";

/// Most indices and positions that are read, counted again wherever they are used again, from a file of so many bytes: a
/// small file can show one mesh through many nodes, and must not become gigabytes. Without copies, a position takes 12
/// bytes and an index at least one.
fn most_entries(bytes: usize) -> usize {
    bytes.saturating_mul(4).saturating_add(1_000_000)
}

/// Triangles between two questions whether to go on.
const TRIANGLES: usize = 1 << 14;

/// The triangles of a glTF 2.0 file, `.glb` or `.gltf` with embedded data, as one mesh a node, in metres and placed in
/// the world.
///
/// The nodes are those of the default scene (the first where none is set, all where there is none), parents before
/// children. Lists, strips and fans of triangles are read and the primitives of a node joined; points and lines are
/// ignored, and so are textures, poses ([`skeleton`] gives the joints) and morph targets; of materials the triangles keep
/// the names. Corners at equal positions share a vertex, whatever
/// their normals and UVs; triangles of which two corners are one vertex are left out. Normals and UVs (v turned to
/// run upward) are kept where every primitive of the node has them; a zero normal becomes that of its triangle. Nodes
/// that mirror keep their outside outside. A mesh takes its node's name, else its own.
///
/// # Errors
/// [`ReadError`] where the file is empty or damaged, points into other files, uses sparse or compressed data or an
/// extension it cannot be read without, has a position that is not finite, or has no triangle.
pub fn read(bytes: &[u8]) -> Result<Vec<Mesh>, ReadError> {
    read_while(bytes, &|_| true)
}

/// The same, calling `progress` with the share of the file's data that is read; where meshes are shown several times,
/// with 1 from then on.
///
/// # Errors
/// As [`read`], and [`ReadError::Stopped`] where `progress` answers `false`.
pub fn read_while(bytes: &[u8], progress: &dyn Fn(f64) -> bool) -> Result<Vec<Mesh>, ReadError> {
    // A triangle takes about 36 bytes of indices and vertices.
    let whole = bytes.len() / 36 + 1;
    let shares = |done: f64| progress(done.min(1.0));
    let mut pace = Pace::new(&shares, whole, TRIANGLES);
    pace.at(0)?;
    let mut read = 0;
    let container = Container::open(bytes)?;
    let root = &container.root;
    let mut meshes = Vec::new();
    let (mut entries, most) = (0_usize, most_entries(bytes.len()));
    for placed in scene_walk::nodes_with_meshes(root)? {
        let source = root.get(placed.mesh).ok_or_else(|| {
            malformed(format!("node {}", placed.node), format!("mesh {} is not there", placed.mesh.value()))
        })?;
        let node_name = root.nodes.get(placed.node).and_then(|node| node.name.clone());
        let name = node_name
            .or_else(|| source.name.clone())
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("mesh {}", placed.mesh.value()));
        let mut soup = TriangleSoup::new(placed.world);
        for (index, primitive) in source.primitives.iter().enumerate() {
            let place = format!("mesh {}, primitive {index}", placed.mesh.value());
            let Some(attributes) = Attributes::of(root, primitive, &place)? else { continue };
            entries = entries.saturating_add(attributes.entry_count(&container, &place)?);
            if entries > most {
                return Err(ReadError::Unsupported {
                    format: FORMAT,
                    what: format!("more than {most} indices and vertices in a file of {} bytes", bytes.len()),
                    remedy: "simplify the meshes, or export fewer copies of them",
                });
            }
            read = soup.add(&container, &attributes, (&name, &place), read, &mut pace)?;
        }
        meshes.extend(soup.into_mesh(&name)?);
    }
    if meshes.is_empty() {
        return Err(ReadError::Nothing {
            format: FORMAT,
            what: "triangle",
            remedy: "export meshes, not only cameras, lights, lines or points",
        });
    }
    Ok(meshes)
}

fn malformed(place: impl Into<String>, problem: impl Into<String>) -> ReadError {
    ReadError::Malformed { format: FORMAT, place: place.into(), problem: problem.into() }
}

/// How corners follow from the indices of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    List,
    Strip,
    Fan,
}

impl Layout {
    /// The layout of a primitive, or `None` for points and lines.
    fn of(mode: mesh::Mode) -> Option<Self> {
        match mode {
            mesh::Mode::Triangles => Some(Self::List),
            mesh::Mode::TriangleStrip => Some(Self::Strip),
            mesh::Mode::TriangleFan => Some(Self::Fan),
            mesh::Mode::Points | mesh::Mode::Lines | mesh::Mode::LineLoop | mesh::Mode::LineStrip => None,
        }
    }

    /// Triangles that `count` indices make; a rest that makes none is `None`.
    fn triangle_count(self, count: usize) -> Option<usize> {
        match self {
            Self::List => count.is_multiple_of(3).then_some(count / 3),
            Self::Strip | Self::Fan => count.checked_sub(2),
        }
    }

    /// Places of triangle `t` in the list of indices (glTF 2.0, 3.7.2.1).
    fn triangle(self, t: usize) -> [usize; 3] {
        match self {
            Self::List => [3 * t, 3 * t + 1, 3 * t + 2],
            Self::Strip => [t, t + 1 + t % 2, t + 2 - t % 2],
            Self::Fan => [t + 1, t + 2, 0],
        }
    }
}

#[cfg(test)]
mod tests;
