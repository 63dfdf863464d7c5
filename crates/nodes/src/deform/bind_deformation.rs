//! **Bind deformation**: prepares a mesh for its handles, so that moving them only solves.
//! Reference: Fu's thesis 2.3, 2.4.

use maquette_geometry::deform::laplacian::{BindError, Reconstruction};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
struct KeepsChoice(Reconstruction);

impl Choices for KeepsChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Reconstruction::Coordinates), "coordinates", "Laplacian coordinates (2.10, 2.11): round bends"),
        (
            Self(Reconstruction::Edges),
            "edges",
            "edges, as rigid as possible: lengths are kept better, bends are pointier; `converged` ends in one shape",
        ),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "bind-deformation",
        1,
        "deform",
        "Binds a mesh to handles by the implicit Laplacian deformation: its systems are factored once, and `deform` \
         solves them wherever the handles go.",
    );
    node.reference("Fu 2.3, 2.4: (2.5) to (2.11)");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh that is deformed.");
    let handles = node.input::<wire::Held>(
        "handles",
        "The handles. How they move is left out here, so that dragging one does not bind again.",
    );
    let region = node.optional::<wire::Selection>(
        "region",
        "The part that may be deformed; the rest stays and holds it. Without, all of the mesh.",
    );
    let keeps = node.choice::<KeepsChoice>("keeps", "What of the surface is kept while it bends.");
    let bound = node.output::<wire::Bound>("bound", "The bound mesh.");
    let free = node.figure("free", Unit::None, "Vertices that are free to move.");
    let held = node.figure("handles", Unit::None, "Handles bound.");
    let contested = node.figure("contested", Unit::None, "Vertices of more than one handle; the last one has them.");
    let degenerate = node.figure("degenerate", Unit::None, "Vertices displaced while gradients are looked for (2.9).");
    let widened = node.figure("widened", Unit::None, "Vertices whose gradient takes in more than one ring.");
    let bytes = node.figure("factor-bytes", Unit::None, "Bytes of both factors.");
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let (body, holding) = (ports.read(mesh), ports.read(handles));
        let chosen = ports.read_optional(region).cloned();
        let reconstruction = ports.choice(keeps).0;
        let mesh_hash = ports.content_hash(mesh);
        let made = wire::Bound::new(body, mesh_hash, chosen, holding.clone(), reconstruction, &progress);
        let made = match made {
            Err(BindError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ BindError::WrongSelection { .. }) if error.is_of_region() => Err(error).at(region),
            Err(
                error @ (BindError::WrongSelection { .. }
                | BindError::EmptyHandle { .. }
                | BindError::Underdetermined { .. }),
            ) => Err(error).at(handles),
            made => made.at(mesh),
        }?;
        let report = made.binding.report();
        if report.free == 0 {
            ports.warn(
                "no vertex is free to move: nothing lies in the region beside the handles; make the region larger",
            );
        }
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32, and bytes")]
        for (figure, value) in [
            (free, report.free),
            (held, holding.0.len()),
            (contested, report.contested),
            (degenerate, report.degenerate),
            (widened, report.widened),
            (bytes, report.factor_bytes),
        ] {
            ports.figure(figure, value as f64);
        }
        ports.write(bound, made);
        Ok(())
    });
    node
}
