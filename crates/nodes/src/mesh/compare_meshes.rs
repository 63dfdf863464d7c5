//! **Compare meshes**: how far two meshes are apart, and how much one is a deformation of the other.

use maquette_geometry::mesh::{Gap, MeshDistance, compare};
use maquette_graph::{AtPort, Cell, NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "compare-meshes",
        1,
        "mesh",
        "How far two meshes are apart, and how edges, area and volume differ: to look at or to gate a build.",
    );
    let first = node.input::<wire::Mesh>("first", "The mesh that is measured.");
    let second = node.input::<wire::Mesh>("second", "What it is measured against.");
    let passed = node.output::<wire::Mesh>("mesh", "The first mesh, unchanged.");
    let largest =
        node.figure("largest-distance", Unit::Length, "Largest distance of a point of one from the other, both ways.");
    let mean = node.figure("mean-distance", Unit::Length, "The mean of these distances, of both ways.");
    let percent =
        node.figure("largest-percent", Unit::None, "The largest distance in percent of the second's diagonal.");
    let volume = node.figure("volume-ratio", Unit::None, "Volume of the first over that of the second.");
    let area = node.figure("area-ratio", Unit::None, "Area of the first over that of the second.");
    let rms = node.figure(
        "rms-edge-error",
        Unit::None,
        "Root mean square of the relative changes of the edges' lengths, where both have the same faces.",
    );
    let edge = node.figure("largest-edge-error", Unit::None, "The largest of these changes.");
    let moved = node.figure(
        "largest-move",
        Unit::Length,
        "Largest distance of vertices of equal number, where both have the same faces.",
    );
    let table = node.table(
        "distances",
        &[
            ("of", Unit::None),
            ("largest", Unit::Length),
            ("mean", Unit::Length),
            ("rms", Unit::Length),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
        ],
        "Distances of the vertices and face middles of each from the other, and where the largest is.",
    );
    node.evaluate(move |ports| {
        let (measured, against) = (ports.read(first), ports.read(second));
        // Which of both is empty, the comparison does not say.
        MeshDistance::new(&measured.0).at(first)?;
        let found = compare(&measured.0, &against.0, &ports.progress_callback()).at(second)?;
        let Some(found) = found else { return Err(NodeError::Cancelled) };
        let worst = found.there.largest.max(found.back.largest);
        ports.figure(largest, worst);
        ports.figure(mean, 0.5 * (found.there.mean + found.back.mean));
        let size = maquette_geometry::mesh::measure::diagonal(&against.0);
        if size > 0.0 {
            ports.figure(percent, 100.0 * worst / size);
        }
        let edges = found.edges;
        for (figure, value) in [
            (volume, found.volume_ratio),
            (area, found.area_ratio),
            (rms, edges.map(|edges| edges.rms)),
            (edge, edges.map(|edges| edges.largest)),
            (moved, found.largest_move),
        ] {
            if let Some(value) = value {
                ports.figure(figure, value);
            }
        }
        let row = |name: &str, gap: &Gap| -> Vec<Cell> {
            let figures = [gap.largest, gap.mean, gap.rms].map(Cell::from);
            std::iter::once(name.into()).chain(figures).chain(gap.at.to_array().map(Cell::from)).collect()
        };
        ports.table(table, vec![row("first", &found.there), row("second", &found.back)]);
        ports.write(passed, measured.clone());
        Ok(())
    });
    node
}
