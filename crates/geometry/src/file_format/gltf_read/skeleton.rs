//! The joints of skins.

use glam::{DMat4, DVec3};
use gltf_json::accessor::{ComponentType, Type};

use super::container::Container;
use super::{FORMAT, malformed, scene_walk};
use crate::curve::{Curve, CurveError};
use crate::file_format::ReadError;

/// A joint of a skin.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The name of its node; `node 7` where that has none.
    pub name: String,
    /// Where it stands in the pose in which [`read`](super::read) gives the meshes (the bind pose), metres.
    pub position: DVec3,
    /// Place in [`Skeleton::joints`] of the nearest joint above it, where there is one.
    pub parent: Option<usize>,
}

/// The joints of all skins of a file; parents come before their children.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    joints: Vec<Joint>,
}

/// Why joints make no bone.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoneError {
    /// No joint named.
    #[error("a bone needs a joint to begin at: name one")]
    NoJoint,
    /// A name that no joint has.
    #[error("there is no joint \"{name}\"; there are {}", known.join(", "))]
    Unknown {
        /// The name.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A name that several joints have.
    #[error("{found} joints are called \"{name}\": give them names of their own")]
    Ambiguous {
        /// The name.
        name: String,
        /// How many have it.
        found: usize,
    },
    /// A joint without a child, and no other end given.
    #[error("joint \"{joint}\" has no child to run to: begin at a joint above it, or name one to run to")]
    NoChild {
        /// The joint.
        joint: String,
    },
    /// A joint with several children, and no other end given.
    #[error("joint \"{joint}\" has several children: say which one of {} the bone runs to", children.join(", "))]
    SeveralChildren {
        /// The joint.
        joint: String,
        /// Its children.
        children: Vec<String>,
    },
    /// Joints that all stand in one place.
    #[error(transparent)]
    Curve(#[from] CurveError),
}

impl Skeleton {
    /// The joints in the order of the node tree, parents first.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The place of a joint in [`Skeleton::joints`].
    ///
    /// # Errors
    /// [`BoneError`] where none or several have the name.
    pub fn find(&self, name: &str) -> Result<usize, BoneError> {
        let named: Vec<usize> = (0..self.joints.len()).filter(|joint| self.joints[*joint].name == name).collect();
        match *named {
            [one] => Ok(one),
            [] => Err(BoneError::Unknown { name: name.to_owned(), known: self.names(0..self.joints.len()) }),
            _ => Err(BoneError::Ambiguous { name: name.to_owned(), found: named.len() }),
        }
    }

    /// The bone through joints in the order given, called by the first and the last of them. A single joint's bone runs
    /// to its only child. Where one of two joints is above the other the bone also passes through all between them, and
    /// otherwise straight from one to the other: some files have all their joints side by side.
    ///
    /// # Errors
    /// [`BoneError`] where no joint is named, a name is not that of one joint, the child is missing or not the only one,
    /// or all joints stand in one place.
    pub fn bone(&self, names: &[&str]) -> Result<Curve, BoneError> {
        let mut wanted = names.iter().map(|name| self.find(name)).collect::<Result<Vec<usize>, _>>()?;
        let Some(&first) = wanted.first() else { return Err(BoneError::NoJoint) };
        if wanted.len() == 1 {
            wanted.push(self.only_child(first)?);
        }
        let mut chain = vec![first];
        for pair in wanted.windows(2) {
            let between = self.chain(pair[1], pair[0]).map(|mut up| {
                up.reverse();
                up
            });
            chain.extend(between.or_else(|| self.chain(pair[0], pair[1])).unwrap_or_else(|| pair.to_vec()));
        }
        Ok(self.curve(&chain)?)
    }

    /// The bones from fork to fork: of each joint that is the first, or that has sisters, the run of joints below it as
    /// long as there is one child each, called as by [`Skeleton::bone`]. A joint that forks at once, or has no child,
    /// is no bone, nor are joints in one place.
    pub fn chains(&self) -> Vec<Curve> {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.joints.len()];
        for (joint, parent) in self.joints.iter().enumerate().filter_map(|(k, joint)| Some((k, joint.parent?))) {
            children[parent].push(joint);
        }
        let only_child = |joint: &usize| match *children[*joint] {
            [child] => Some(child),
            _ => None,
        };
        let begins = |joint: &usize| self.joints[*joint].parent.is_none_or(|parent| children[parent].len() > 1);
        let run = |first: usize| std::iter::successors(Some(first), only_child).collect::<Vec<usize>>();
        (0..self.joints.len()).filter(begins).filter_map(|first| self.curve(&run(first)).ok()).collect()
    }

    /// The curve through joints.
    fn curve(&self, chain: &[usize]) -> Result<Curve, CurveError> {
        let name = |joint: Option<&usize>| joint.map_or("", |joint| self.joints[*joint].name.as_str());
        let name = format!("{} - {}", name(chain.first()), name(chain.last()));
        Curve::new(name, chain.iter().map(|joint| self.joints[*joint].position).collect(), false)
    }

    /// The joints from one up to another that is above it.
    fn chain(&self, low: usize, high: usize) -> Option<Vec<usize>> {
        let up: Vec<usize> = std::iter::successors(Some(low), |joint| self.joints[*joint].parent).collect();
        let end = up.iter().position(|joint| *joint == high)?;
        Some(up[..=end].to_vec())
    }

    fn only_child(&self, joint: usize) -> Result<usize, BoneError> {
        let is_child = |child: &usize| self.joints[*child].parent == Some(joint);
        let children: Vec<usize> = (0..self.joints.len()).filter(is_child).collect();
        let name = || self.joints[joint].name.clone();
        match *children {
            [child] => Ok(child),
            [] => Err(BoneError::NoChild { joint: name() }),
            _ => Err(BoneError::SeveralChildren { joint: name(), children: self.names(children) }),
        }
    }

    fn names(&self, joints: impl IntoIterator<Item = usize>) -> Vec<String> {
        joints.into_iter().map(|joint| format!("\"{}\"", self.joints[joint].name)).collect()
    }
}

/// The joints of all skins of a glTF 2.0 file, `.glb` or `.gltf` with embedded data, where they stand in the bind pose:
/// by their inverse bind matrices, or where their nodes stand where a skin has none. Of a joint of several skins the
/// first counts.
///
/// # Errors
/// [`ReadError`] as [`read`](super::read), and where there is no skin, a joint is not in the scene, or a matrix can't be
/// inverted.
pub fn skeleton(bytes: &[u8]) -> Result<Skeleton, ReadError> {
    let container = Container::open(bytes)?;
    let root = &container.root;
    // One entry a node: whether it is a joint, and where.
    let mut positions: Vec<Option<Place>> = vec![None; root.nodes.len()];
    for (index, skin) in root.skins.iter().enumerate() {
        let place = format!("skin {index}");
        let binds = match skin.inverse_bind_matrices {
            Some(accessor) => Some(container.items(accessor, Type::Mat4, &[ComponentType::F32], &place)?),
            None => None,
        };
        if let Some(binds) = binds.as_ref().filter(|binds| binds.count < skin.joints.len()) {
            return Err(malformed(place, format!("{} matrices for {} joints", binds.count, skin.joints.len())));
        }
        for (k, joint) in skin.joints.iter().enumerate() {
            let Some(entry) = positions.get_mut(joint.value()) else {
                return Err(malformed(place, format!("node {} is not there", joint.value())));
            };
            if entry.is_none() {
                *entry =
                    Some(match &binds {
                        Some(binds) => Place::Bound(bound(binds.numbers(k)).ok_or_else(|| {
                            malformed(&place, format!("the bind matrix of joint {k} can't be inverted"))
                        })?),
                        None => Place::AsItsNode,
                    });
            }
        }
    }
    if positions.iter().all(Option::is_none) {
        return Err(ReadError::Nothing {
            format: FORMAT,
            what: "skin with joints",
            remedy: "export the mesh with its armature and skinning",
        });
    }
    let mut joints: Vec<Joint> = Vec::new();
    // The joint that each node is, or else the nearest one above it.
    let mut nearest: Vec<Option<usize>> = vec![None; root.nodes.len()];
    for visited in scene_walk::nodes(root)? {
        let parent = visited.parent.and_then(|parent| nearest[parent]);
        nearest[visited.node] = parent;
        let Some(place) = positions[visited.node].take() else { continue };
        let position = match place {
            Place::Bound(position) => position,
            Place::AsItsNode => visited.world.w_axis.truncate(),
        };
        let name = root.nodes[visited.node].name.clone().filter(|name| !name.is_empty());
        let name = name.unwrap_or_else(|| format!("node {}", visited.node));
        if !position.is_finite() {
            return Err(ReadError::NotFinite { format: FORMAT, name, what: "joint", index: joints.len() });
        }
        nearest[visited.node] = Some(joints.len());
        joints.push(Joint { name, position, parent });
    }
    match positions.iter().position(Option::is_some) {
        Some(node) => Err(malformed(format!("node {node}"), "it is a joint, but not in the scene")),
        None => Ok(Skeleton { joints }),
    }
}

#[derive(Clone, Copy)]
enum Place {
    Bound(DVec3),
    AsItsNode,
}

/// Where the inverse of a bind matrix puts the origin.
fn bound(matrix: [f32; 16]) -> Option<DVec3> {
    let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
    let position = matrix.inverse().w_axis;
    (matrix.determinant() != 0.0 && position.is_finite()).then(|| position.truncate() / position.w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine as _;
    use serde_json::{Value, json};

    /// Hip, knee and ankle with a twist joint above the knee that is no joint of the skin, and two toes; the skin was
    /// bound one metre higher than its nodes stand now.
    fn leg() -> Value {
        let bound = [[0.1, 2.0, 0.0], [0.1, 1.5, 0.1], [0.1, 1.1, 0.0], [0.0, 1.0, 0.2], [0.2, 1.0, 0.2]];
        let mut bytes: Vec<u8> = Vec::new();
        for [x, y, z] in bound {
            // Joints may be turned: a quarter turn about z, inverted.
            let matrix = DMat4::from_translation(DVec3::new(x, y, z)) * DMat4::from_rotation_z(0.5);
            bytes.extend(matrix.inverse().to_cols_array().iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
        json!({
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [
                {"name": "armature", "children": [1], "translation": [0, 1, 0]},
                {"name": "hip", "children": [2], "translation": [0.1, 0, 0]},
                {"name": "twist", "children": [3], "translation": [0, -0.2, 0]},
                {"name": "knee", "children": [4], "translation": [0, -0.3, 0.1]},
                {"children": [5, 6], "translation": [0, -0.4, -0.1]},
                {"name": "toe", "translation": [-0.1, -0.1, 0.2]},
                {"name": "toe", "translation": [0.1, -0.1, 0.2]}
            ],
            "skins": [{"joints": [1, 3, 4, 5, 6], "inverseBindMatrices": 0}],
            "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}")}],
            "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "MAT4"}]
        })
    }

    fn open(document: &Value) -> Result<Skeleton, ReadError> {
        skeleton(document.to_string().as_bytes())
    }

    #[test]
    fn joints_stand_where_they_were_bound_below_their_nearest_joint() {
        let found = open(&leg()).unwrap();
        let names: Vec<&str> = found.joints().iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(names, ["hip", "knee", "node 4", "toe", "toe"]);
        let parents: Vec<Option<usize>> = found.joints().iter().map(|joint| joint.parent).collect();
        assert_eq!(parents, [None, Some(0), Some(1), Some(2), Some(2)]);
        assert!(found.joints()[1].position.distance(DVec3::new(0.1, 1.5, 0.1)) < 1e-6);
    }

    #[test]
    fn without_bind_matrices_joints_stand_where_their_nodes_do() {
        let mut document = leg();
        document["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
        let found = open(&document).unwrap();
        assert!(found.joints()[1].position.distance(DVec3::new(0.1, 0.5, 0.1)) < 1e-6);
    }

    #[test]
    fn bones_run_through_all_joints_between() {
        let skeleton = open(&leg()).unwrap();
        let leg = skeleton.bone(&["hip", "node 4"]).unwrap();
        assert_eq!((leg.name(), leg.points().len()), ("hip - node 4", 3));
        assert!(leg.end().distance(DVec3::new(0.1, 1.1, 0.0)) < 1e-6);
        assert_eq!(skeleton.bone(&["hip", "knee", "node 4"]).unwrap(), leg);
        assert_eq!(skeleton.bone(&["hip"]).unwrap().points(), &leg.points()[..2]);
        let up = skeleton.bone(&["node 4", "hip"]).unwrap();
        assert_eq!(up.points(), leg.reversed().points());
    }

    #[test]
    fn chains_run_from_fork_to_fork() {
        let names = |document: &Value| -> Vec<(String, usize)> {
            let chains = open(document).unwrap().chains();
            chains.iter().map(|chain| (chain.name().to_owned(), chain.points().len())).collect()
        };
        assert_eq!(names(&leg()), [("hip - node 4".to_owned(), 3)], "toes end at once");
        let mut document = leg();
        document["nodes"][5]["children"] = json!([7]);
        document["nodes"].as_array_mut().unwrap().push(json!({"name": "tip", "translation": [0, 0, 0.1]}));
        document["skins"][0]["joints"] = json!([1, 3, 4, 5, 6, 7]);
        document["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
        assert_eq!(names(&document), [("hip - node 4".to_owned(), 3), ("toe - tip".to_owned(), 2)]);
    }

    #[test]
    fn joints_side_by_side_are_joined_straight() {
        let mut document = leg();
        document["nodes"][5]["name"] = "inner toe".into();
        let across = open(&document).unwrap().bone(&["toe", "inner toe"]).unwrap();
        assert_eq!(across.points().len(), 2);
        assert!((across.start().distance(across.end()) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn what_makes_no_bone_is_said() {
        let skeleton = open(&leg()).unwrap();
        let refusal = |names: &[&str]| skeleton.bone(names).unwrap_err().to_string();
        assert_eq!(
            refusal(&["hips"]),
            "there is no joint \"hips\"; there are \"hip\", \"knee\", \"node 4\", \"toe\", \"toe\""
        );
        assert_eq!(refusal(&["hip", "toe"]), "2 joints are called \"toe\": give them names of their own");
        assert_eq!(
            refusal(&["node 4"]),
            "joint \"node 4\" has several children: say which one of \"toe\", \"toe\" the bone runs to"
        );
        assert_eq!(refusal(&[]), "a bone needs a joint to begin at: name one");
        assert!(refusal(&["hip", "hip"]).contains("1 distinct point"));
        let mut document = leg();
        document["nodes"][5]["name"] = "inner toe".into();
        let message = open(&document).unwrap().bone(&["toe"]).unwrap_err().to_string();
        assert_eq!(message, "joint \"toe\" has no child to run to: begin at a joint above it, or name one to run to");
    }

    #[test]
    fn damaged_skins_are_refused() {
        let refusal = |path: &str, value: Value| {
            let mut document = leg();
            let (parent, key) = path.rsplit_once('/').unwrap();
            document.pointer_mut(parent).unwrap()[key] = value;
            open(&document).unwrap_err().to_string()
        };
        assert!(refusal("/skins", json!([])).contains("holds no skin with joints: export the mesh with its armature"));
        assert!(refusal("/skins/0/joints", json!([1, 77])).contains("skin 0: node 77 is not there"));
        assert!(refusal("/accessors/0/count", 4.into()).contains("skin 0: 4 matrices for 5 joints"));
        assert!(refusal("/nodes/3/children", json!([])).contains("node 4: it is a joint, but not in the scene"));
        assert!(refusal("/nodes/6/children", json!([1])).contains("it has two parents, or is its own ancestor"));
        let zeros = format!("data:application/octet-stream;base64,{}", "A".repeat(428));
        assert!(refusal("/buffers/0/uri", zeros.into()).contains("the bind matrix of joint 0 can't be inverted"));
    }
}
