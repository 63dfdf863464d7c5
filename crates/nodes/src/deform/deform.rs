//! **Deform**: a bound mesh where its handles have gone.
//! Reference: Fu's thesis 2.4.

use maquette_geometry::deform::laplacian::{DeformError, DeformOptions, Features, Passes};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
enum Quality {
    Full,
    Quick,
    Converged,
    Unturned,
}

impl Choices for Quality {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Full, "full", "both systems, each once: what the thesis does on release"),
        (
            Self::Quick,
            "quick",
            "the first system alone, as while dragging: large turns shear, and normals are left out",
        ),
        (Self::Converged, "converged", "the second system again and again, until nothing moves"),
        (
            Self::Unturned,
            "unturned",
            "the second system with detail as it was: plain Laplacian editing, to compare with; bends collapse",
        ),
    ];
}

#[derive(Clone, Copy)]
struct FeaturesChoice(Features);

impl Choices for FeaturesChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Features::Automatic), "automatic", "kept where all handles are rigid, scaled where one scales"),
        (Self(Features::Keep), "keep", "detail keeps its size (2.10)"),
        (Self(Features::Scale), "scale", "detail is scaled with what is around it (2.11)"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "deform",
        1,
        "deform",
        "Deforms a bound mesh by where its handles went; detail turns along and is not sheared.",
    );
    node.reference("Fu 2.4: (2.8), (2.10), (2.11)");
    let bound = node.input::<wire::Bound>("bound", "The bound mesh.");
    let handles = node.input::<wire::Handles>("handles", "The same handles as it was bound to, where they went.");
    let quality = node.choice::<Quality>("quality", "How much is done.");
    let features = node.choice::<FeaturesChoice>("features", "Whether detail keeps its size.");
    let tolerance = node.number(
        "tolerance",
        1e-4,
        0.0..=1.0,
        "Where `converged`: nothing moves by more than this share of the region's diagonal in a pass.",
    );
    node.soft_range(tolerance, 1e-6..=1e-2);
    let most = node.integer("passes", 100, 1..=10_000, "Where `converged`: the largest number of passes.");
    node.soft_range(most, 1.0..=500.0);
    let deformed = node.output::<wire::Mesh>("mesh", "The deformed mesh; polygons, UVs and order are as they were.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the vertex moves that moves farthest.");
    let passes = node.figure("passes", Unit::None, "How often the second system was solved.");
    let last = node.figure("last-move", Unit::None, "Largest move in the last pass, as a share of the diagonal.");
    node.evaluate(move |ports| {
        let (prepared, holding) = (ports.read(bound), ports.read(handles));
        if !prepared.held.is_same_as(&holding.held()) {
            let (wanted, found) = (prepared.held.0.len(), holding.0.len());
            let message = format!(
                "these are not the handles that the mesh is bound to ({found} here, {wanted} there): link the same \
                 handles to both nodes"
            );
            return Err(message).at(handles);
        }
        let progress = ports.progress_callback();
        let (binding, transforms) = (&prepared.binding, holding.transforms());
        let limit = match ports.choice(quality) {
            quality @ (Quality::Quick | Quality::Unturned) => {
                ports.progress(0.0)?;
                let points = match quality {
                    Quality::Unturned => binding.without_turning(&transforms),
                    _ => binding.drag(&transforms),
                };
                let points = points.at(handles)?;
                let mesh = binding.mesh().with_positions(points, None).at(handles)?;
                ports.figure(farthest, largest_move(binding.mesh(), &mesh));
                ports.write(deformed, wire::Mesh::new(mesh));
                return Ok(());
            }
            Quality::Full => Passes::Once,
            Quality::Converged => Passes::Converged { tolerance: ports.value(tolerance), most: ports.count(most) },
        };
        let options = DeformOptions { features: ports.choice(features).0, passes: limit };
        let made = match binding.deform(&transforms, &options, &progress) {
            Err(DeformError::Stopped) => return Err(NodeError::Cancelled),
            made => made.at(handles)?,
        };
        if made.wound {
            ports
                .note("handles turn by about 180 degrees or more against each other: rotations between them are wound");
        }
        #[expect(clippy::cast_precision_loss, reason = "at most 10,000")]
        ports.figure(passes, made.passes as f64);
        if made.last_move.is_finite() {
            ports.figure(last, made.last_move);
        }
        if let Passes::Converged { tolerance, most } = options.passes
            && made.passes >= most
            && made.last_move > tolerance
        {
            ports.note(format!(
                "after {most} passes vertices still move by {:.1e} of the region's diagonal: allow more passes, or a \
                 larger tolerance",
                made.last_move
            ));
        }
        ports.figure(farthest, largest_move(binding.mesh(), &made.mesh));
        ports.write(deformed, wire::Mesh::new(made.mesh));
        Ok(())
    });
    node
}

fn largest_move(before: &maquette_geometry::mesh::Mesh, after: &maquette_geometry::mesh::Mesh) -> f64 {
    let squares = before.positions().iter().zip(after.positions()).map(|(p, q)| p.distance_squared(*q));
    squares.fold(0.0, f64::max).sqrt()
}
