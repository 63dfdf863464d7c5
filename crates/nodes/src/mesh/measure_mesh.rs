//! **Measure mesh**: counts and sizes of a mesh.

use maquette_geometry::mesh::figures;
use maquette_graph::{NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "measure-mesh",
        1,
        "mesh",
        "Counts and measures a mesh: area, volume, edges, parts, genus, bounds: to look at or to gate a build.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let passed = node.output::<wire::Mesh>("mesh", "The mesh, unchanged.");
    let mut count = |name: &str, description: &str| node.figure(name, Unit::None, description);
    let vertices = count("vertices", "Vertices, also those of no face.");
    let faces = count("faces", "Faces.");
    let edges = count("edges", "Edges, each counted once.");
    let components = count("components", "Parts that do not hang together by edges.");
    let loops = count("boundary-loops", "Loops of edges at which the surface ends.");
    let genus = count("genus", "Handles and tunnels of all parts, open ends closed; not given where faces oppose.");
    let area = count("area", "Area in square metres.");
    let volume = count("volume", "Enclosed volume in cubic metres, open ends closed; below 0 where inside out.");
    let mut length = |name: &str, description: &str| node.figure(name, Unit::Length, description);
    let shortest = length("shortest-edge", "Length of the shortest edge.");
    let mean = length("mean-edge", "Mean length of the edges.");
    let longest = length("longest-edge", "Length of the longest edge.");
    let diagonal = length("diagonal", "Diagonal of the box around the mesh.");
    let bounds = node.table(
        "bounds",
        &[("axis", Unit::None), ("low", Unit::Length), ("high", Unit::Length), ("size", Unit::Length)],
        "The box around the mesh: a row an axis.",
    );
    node.evaluate(move |ports| {
        let body = ports.read(mesh);
        let Some(found) = figures(&body.0, &ports.progress_callback()) else { return Err(NodeError::Cancelled) };
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        for (figure, value) in [
            (vertices, found.vertices),
            (faces, found.polygons),
            (edges, found.edges),
            (components, found.components),
            (loops, found.boundary_loops),
        ] {
            ports.figure(figure, value as f64);
        }
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        if let Some(handles) = found.genus {
            ports.figure(genus, handles as f64);
        }
        let size = found.bounds.map_or(0.0, |(low, high)| low.distance(high));
        for (figure, value) in [
            (area, found.area),
            (volume, found.volume),
            (shortest, found.shortest_edge),
            (mean, found.mean_edge),
            (longest, found.longest_edge),
            (diagonal, size),
        ] {
            ports.figure(figure, value);
        }
        if let Some((low, high)) = found.bounds {
            let row = |(axis, name): (usize, &&str)| {
                vec![(*name).into(), low[axis].into(), high[axis].into(), (high[axis] - low[axis]).into()]
            };
            ports.table(bounds, ["x", "y", "z"].iter().enumerate().map(row).collect());
        }
        ports.write(passed, body.clone());
        Ok(())
    });
    node
}
