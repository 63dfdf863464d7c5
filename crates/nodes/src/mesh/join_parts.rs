//! **Join parts**: the parts of a body become one mesh, welded where they meet.

use maquette_geometry::mesh::weld::{WeldError, WeldOptions, weld_while};
use maquette_graph::{AtPort, NodeError, NodeKind, OptionalInput, Unit};

use crate::wire;

const NAMES: [&str; 16] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p"];

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "join-parts",
        1,
        "mesh",
        "Welds the parts of a body into one mesh along equal boundaries, and checks the seams.",
    );
    let tolerance = node.length("tolerance", 1e-4, 0.0..=1000.0, "Largest distance of vertices that become one.");
    node.soft_range(tolerance, 0.0..=0.01);
    let smooth = node.angle(
        "smooth",
        30.0,
        0.0..=180.0,
        "Largest angle between two parts at which their normals are averaged; a sharper seam stays an edge.",
    );
    let parts: Vec<OptionalInput<wire::Mesh>> =
        NAMES.iter().map(|name| node.optional(name, "A part; may be left unconnected.")).collect();
    let joined = node.output::<wire::Mesh>("mesh", "The parts as one mesh, in the order of the inputs.");
    let seams = node.figure("seams", Unit::None, "Pairs of open loops that were welded.");
    let gap = node.figure("largest-gap", Unit::Length, "Largest distance of vertices that became one.");
    let angle = node.figure("largest-angle", Unit::Angle, "Largest angle between two parts at a seam.");
    let open = node.figure("open-loops", Unit::None, "Open loops that are left.");
    let junctions = node.figure("t-junctions", Unit::None, "Vertices within open edges of another part, not welded.");
    let table = node.table(
        "welds",
        &[
            ("part", Unit::None),
            ("other", Unit::None),
            ("vertices", Unit::None),
            ("whole", Unit::None),
            ("gap", Unit::Length),
            ("angle", Unit::Angle),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
        ],
        "The seams: their parts by input, welded vertices, whether both loops are welded whole, largest gap and angle, \
         and where that angle is.",
    );
    node.evaluate(move |ports| {
        let connected: Vec<(&str, &wire::Mesh)> = NAMES
            .iter()
            .zip(&parts)
            .filter_map(|(name, part)| ports.read_optional(*part).map(|mesh| (*name, mesh)))
            .collect();
        if connected.is_empty() {
            return Err(NodeError::new("nothing is connected: link at least one part"));
        }
        let meshes: Vec<_> = connected.iter().map(|(_, mesh)| &*mesh.0).collect();
        let options = WeldOptions { tolerance: ports.value(tolerance), smooth_degrees: ports.value(smooth) };
        let welded = match weld_while(&meshes, &options, &ports.progress_callback()) {
            Err(WeldError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ WeldError::Smooth { .. }) => return Err(error).at(smooth),
            welded => welded.at(tolerance)?,
        };
        let known: Vec<String> = connected
            .iter()
            .enumerate()
            .map(|(number, (input, mesh))| match mesh.0.name() {
                "" => format!("part {number} is `{input}`"),
                name => format!("part {number} is `{input}` (\"{name}\")"),
            })
            .collect();
        if !welded.warnings.is_empty() {
            ports.note(known.join(", "));
        }
        welded.warnings.iter().for_each(|warning| ports.warn(warning));
        let input = |part: usize| connected.get(part).map_or("", |(name, _)| *name);
        let rows = welded.seams.iter().map(|seam| {
            vec![
                input(seam.parts[0]).into(),
                input(seam.parts[1]).into(),
                seam.vertices.into(),
                seam.whole.into(),
                seam.largest_gap.into(),
                seam.largest_angle_degrees.into(),
                seam.at.x.into(),
                seam.at.y.into(),
                seam.at.z.into(),
            ]
        });
        ports.table(table, rows.collect());
        ports.figure(gap, welded.seams.iter().map(|seam| seam.largest_gap).fold(0.0, f64::max));
        ports.figure(angle, welded.seams.iter().map(|seam| seam.largest_angle_degrees).fold(0.0, f64::max));
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        {
            ports.figure(seams, welded.seams.len() as f64);
            ports.figure(open, welded.open_loops as f64);
            ports.figure(junctions, welded.t_junctions.len() as f64);
        }
        ports.write(joined, wire::Mesh::new(welded.mesh));
        Ok(())
    });
    node
}
