//! **Deform to curves**: the primitive deformer applied again, to curves drawn anywhere on the sections.
//! Reference: thesis 5.5 (Figure 5.6b).

use maquette_geometry::deform::{CurvesError, FreeFormOptions, deform_to_curves};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::stiffness::StiffnessInputs;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "deform-to-curves",
        1,
        "deform",
        "Deforms sections until they pass through free-form curves that run along them anywhere on the surface, such as \
         after deform-to-silhouette; the rest keeps its shape.",
    );
    node.reference("thesis 5.5 (Figure 5.6b)");
    let sections = node.input::<wire::Sections>("sections", "Closed sections.");
    let curves = node.input::<wire::Curves>(
        "curves",
        "Curves in space that run along the sections on the surface or close to it, such as strokes on a plane with an \
         offset: each section goes where they pass through its plane.",
    );
    let hold = node.boolean(
        "hold-rails",
        true,
        "The rails of the sections stay in place, so that outlines met before stay exact. Those beside a curve give way.",
    );
    let fade = node.length(
        "fade",
        0.05,
        0.0..=1e3,
        "Beyond the ends of a curve sections follow it less and less over this length; 0 ends at once.",
    );
    node.soft_range(fade, 0.0..=0.5);
    let stiffness = StiffnessInputs::declare(&mut node);
    let deformed = node.output::<wire::Sections>("sections", "The deformed sections, with the rails they had.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the point moves that moves farthest.");
    let table = node.table(
        "curves",
        &[("curve", Unit::None), ("first", Unit::None), ("last", Unit::None), ("largest-move", Unit::Length)],
        "Each curve: the first and the last section that pass through it, and how far it was from them at most.",
    );
    node.evaluate(move |ports| {
        let options = FreeFormOptions {
            stiffness: stiffness.read(ports)?,
            hold_rails: ports.value(hold),
            fade: ports.value(fade),
        };
        let drawn = &ports.read(curves).0;
        use CurvesError as E;
        let made = match deform_to_curves(&ports.read(sections).0, drawn, &options, &ports.progress_callback()) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ E::Fade { .. }) => Err(error).at(fade),
            Err(error @ (E::NoCurves | E::Beside { .. } | E::TooLarge { .. })) => Err(error).at(curves),
            made => made.at(sections),
        }?;
        made.warnings.iter().for_each(|warning| ports.warn(warning));
        ports.figure(farthest, made.largest_move);
        let rows = drawn.iter().zip(&made.curves).map(|(curve, found)| {
            vec![curve.name().into(), found.first.into(), found.last.into(), found.largest_move.into()]
        });
        ports.table(table, rows.collect());
        ports.write(deformed, wire::Sections(made.sections));
        Ok(())
    });
    node
}
