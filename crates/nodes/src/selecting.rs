//! What every node that selects gives and measures.

use glam::DVec3;
use maquette_geometry::mesh::{self, measure};
use maquette_graph::{FigureHandle, NodeKind, Output, Ports, TableHandle, Unit};

use crate::wire;

/// Handles of a selection's output, figures and table.
#[derive(Clone, Copy)]
pub(crate) struct SelectionOutput {
    selection: Output<wire::Selection>,
    selected: FigureHandle,
    sum: FigureHandle,
    bounds: TableHandle,
}

impl SelectionOutput {
    pub(crate) fn declare(node: &mut NodeKind) -> Self {
        Self {
            selection: node.output::<wire::Selection>("selection", "The selection: a weight a vertex."),
            selected: node.figure("selected", Unit::None, "Vertices with a weight of 0.5 or more."),
            sum: node.figure("weight", Unit::None, "Sum of all weights."),
            bounds: node.table(
                "bounds",
                &[("axis", Unit::None), ("low", Unit::Length), ("high", Unit::Length), ("mean", Unit::Length)],
                "Between which coordinates the selected vertices lie, and their mean: a row an axis.",
            ),
        }
    }

    /// Writes a selection and measures it. One that selects nothing is warned of: `remedy` says what to do.
    pub(crate) fn write(self, ports: &mut Ports<'_>, selection: wire::Selection, remedy: &str) {
        let points = selection.mesh.positions();
        let chosen = selection.weights.vertices();
        let places: Vec<DVec3> = chosen.iter().filter_map(|v| points.get(*v as usize)).copied().collect();
        match measured(&places) {
            Some((low, high, mean)) => {
                let row = |(axis, name): (usize, &&str)| {
                    vec![(*name).into(), low[axis].into(), high[axis].into(), mean[axis].into()]
                };
                ports.table(self.bounds, ["x", "y", "z"].iter().enumerate().map(row).collect());
            }
            None => ports.warn(format!("nothing is selected of {}: {remedy}", extent(&selection.mesh))),
        }
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        ports.figure(self.selected, chosen.len() as f64);
        ports.figure(self.sum, selection.weights.weights().iter().sum());
        ports.write(self.selection, selection);
    }
}

/// Lowest and highest coordinates of points and their mean.
fn measured(points: &[DVec3]) -> Option<(DVec3, DVec3, DVec3)> {
    let first = *points.first()?;
    let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
    #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
    let mean = first + points.iter().map(|p| *p - first).sum::<DVec3>() / points.len() as f64;
    Some((low, high, mean))
}

/// A mesh and where it is, for messages.
fn extent(mesh: &mesh::Mesh) -> String {
    let place = |p: DVec3| format!("({:.4}, {:.4}, {:.4})", p.x, p.y, p.z);
    match measure::bounds(mesh) {
        Some((low, high)) => {
            format!(
                "the mesh, whose {} vertices lie between {} and {}",
                mesh.positions().len(),
                place(low),
                place(high)
            )
        }
        None => "the mesh, which has no vertices".to_owned(),
    }
}
