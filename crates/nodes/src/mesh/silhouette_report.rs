//! **Silhouette report**: how far the outline of a mesh is from a sketch.

use maquette_geometry::mesh::{MeshSilhouetteError, SilhouetteReportError, silhouette_of, silhouette_report};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::silhouettes::SilhouetteInputs;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "silhouette-report",
        1,
        "mesh",
        "Measures how far the outline of a mesh is from sketched strokes, view by view, and passes the mesh on.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let strokes = SilhouetteInputs::declare(&mut node, "what its outline is compared with.");
    let same = node.output::<wire::Mesh>("mesh", "The same mesh.");
    let outlines = node.output::<wire::Curves>("outlines", "Its outline in each view that has strokes.");
    let largest = node.figure("largest", Unit::Length, "Largest distance of any view.");
    let mean = node.figure("mean", Unit::Length, "Largest mean distance of any view.");
    let largest_percent =
        node.figure("largest-percent", Unit::None, "Largest distance of any view, percent of its sketch's diagonal.");
    let mean_percent =
        node.figure("mean-percent", Unit::None, "Largest mean distance of any view, percent of its sketch's diagonal.");
    let table = node.table(
        "views",
        &[
            ("view", Unit::None),
            ("largest", Unit::Length),
            ("mean", Unit::Length),
            ("largest-percent", Unit::None),
            ("mean-percent", Unit::None),
            ("right", Unit::Length),
            ("up", Unit::Length),
            ("undrawn", Unit::Length),
        ],
        "The same for each view, where in the picture the distance is largest, and the length of outline that no stroke \
         stands for.",
    );
    node.evaluate(move |ports| {
        let silhouettes = strokes.read(ports)?;
        let body = ports.read(mesh);
        let progress = ports.progress_callback();
        let count = silhouettes.len() as f64;
        let mut curves = Vec::new();
        let mut rows = Vec::new();
        let mut worst = [0.0_f64; 4];
        for (k, silhouette) in silhouettes.iter().enumerate() {
            let part = |from: f64| {
                let progress = &progress;
                move |done: f64| progress((k as f64 + from + 0.5 * done) / count)
            };
            let view = silhouette.view;
            let outline = match silhouette_of(&body.0, view, 0.0, &part(0.0)) {
                Err(MeshSilhouetteError::Cancelled) => Err(NodeError::Cancelled),
                made => made.at(mesh),
            }?;
            let report = match silhouette_report(&outline.curves, silhouette.strokes, view, &part(0.5)) {
                Err(SilhouetteReportError::Cancelled) => Err(NodeError::Cancelled),
                made => made.at(strokes.port(Some(view.name()), &silhouettes)),
            }?;
            let measured = [report.largest, report.mean, report.largest_percent(), report.mean_percent()];
            for (worst, value) in worst.iter_mut().zip(measured) {
                *worst = worst.max(value);
            }
            let mut row = vec![view.name().into()];
            row.extend(measured.into_iter().chain([report.at.x, report.at.y, report.undrawn]).map(Into::into));
            rows.push(row);
            curves.extend(outline.curves.into_iter().map(|curve| {
                let name = format!("{} {}", view.name(), curve.name());
                curve.renamed(name)
            }));
        }
        for (figure, value) in [largest, mean, largest_percent, mean_percent].into_iter().zip(worst) {
            ports.figure(figure, value);
        }
        ports.table(table, rows);
        ports.write(same, body.clone());
        ports.write(outlines, wire::Curves(curves));
        Ok(())
    });
    node
}
