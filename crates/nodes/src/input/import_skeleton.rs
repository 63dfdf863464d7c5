//! **Import skeleton**: the bones of a rigged model as curves, from the joints of a glTF skin.

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::gltf_read::{self, Skeleton};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "import-skeleton",
        1,
        "input",
        "Bones as curves, from the joints of a glTF skin as they stand in the bind pose: one curve a chain of joints.",
    );
    let file = node.file("file", &["glb", "gltf"], "The rigged model: .glb, or .gltf with embedded data.");
    let chains = node.text(
        "chains",
        "",
        "Names of joints separated by commas, chains by semicolons: \"hip, ankle; shoulder, wrist\". Joints between two \
         that are above each other are taken too; a single joint runs to its only child. Empty takes every run of \
         joints up to where it forks.",
    );
    let scale = node.length("scale", 1.0, 1e-9..=1e9, "Length of one unit of the file; glTF's is a metre.");
    node.soft_range(scale, 0.001..=1.0);
    let curves =
        node.output::<wire::Curves>("curves", "One open curve a chain, named \"first - last\" after its joints.");
    let found = node.figure("bones", Unit::None, "Chains of joints that were made curves.");
    let table = node.table(
        "joints",
        &[("joint", Unit::None), ("parent", Unit::None), ("x", Unit::Length), ("y", Unit::Length), ("z", Unit::Length)],
        "The joints of the file, parents first, where they are bound.",
    );
    node.reads_file(file);
    node.evaluate(move |ports| {
        let bytes = ports.file(file)?;
        ports.progress(0.1)?;
        let skeleton = gltf_read::skeleton(&bytes).at(file)?;
        ports.progress(0.8)?;
        let size = ports.value(scale);
        let rows = skeleton.joints().iter().map(|joint| {
            let parent = joint.parent.map_or("", |parent| skeleton.joints()[parent].name.as_str());
            let DVec3 { x, y, z } = joint.position * size;
            vec![joint.name.as_str().into(), parent.into(), x.into(), y.into(), z.into()]
        });
        ports.table(table, rows.collect());
        let wanted = chains_named(ports.read(chains).as_str());
        let bones = match wanted.is_empty() {
            true => all_chains(&skeleton).at(file)?,
            false => wanted.iter().map(|names| skeleton.bone(names)).collect::<Result<Vec<Curve>, _>>().at(chains)?,
        };
        let bones = bones.iter().map(|bone| bone.map(|p| p * size)).collect::<Result<Vec<Curve>, _>>().at(scale)?;
        #[expect(clippy::cast_precision_loss, reason = "at most the nodes of a file in memory")]
        ports.figure(found, bones.len() as f64);
        ports.write(curves, wire::Curves(bones));
        Ok::<(), NodeError>(())
    });
    node
}

fn chains_named(text: &str) -> Vec<Vec<&str>> {
    let chains = text.split([';', '\n']).filter(|chain| !chain.trim().is_empty());
    chains.map(|chain| chain.split(',').map(str::trim).collect()).collect()
}

fn all_chains(skeleton: &Skeleton) -> Result<Vec<Curve>, String> {
    let bones = skeleton.chains();
    match bones.is_empty() {
        true => Err("no joint of the file has a single child, so that there is no chain: name the joints to join, as \
                     \"hip, ankle\""
            .to_owned()),
        false => Ok(bones),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_are_split_at_semicolons_and_joints_at_commas() {
        assert_eq!(chains_named("hip, left ankle ;\n shoulder"), [vec!["hip", "left ankle"], vec!["shoulder"]]);
        assert_eq!(chains_named(" ; \n"), Vec::<Vec<&str>>::new());
    }
}
