//! **Continuity report**: gaps, angles and jumps of curvature at every joint of a surface.
//! Reference: thesis 4.5 to 4.20.

use maquette_geometry::surface::continuity::{JointContinuity, JointPlace, continuity};
use maquette_graph::{AtPort, Cell, NodeError, NodeKind, Output, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "continuity-report",
        1,
        "surface",
        "How smoothly the parts of a surface meet, and the patches of each part: to look at or to gate a build. Measured on \
         request only: for `--report`, `--fail-if`, and the editor's data panel.",
    );
    node.reference("thesis 4.5-4.20; measured on the exact surfaces");
    let surface = node.input::<wire::Surface>("surface", "A surface through series, one part or several end to end.");
    let next = node.optional::<wire::Surface>("next", "A surface that begins where the first one ends.");
    let passed = node.output::<wire::Surface>("surface", "The first surface, unchanged.");
    let measured =
        node.output::<wire::Surface>("measured", "What is measured: the first surface, and the next behind it.");
    node.evaluate(move |ports| {
        let first = ports.read(surface);
        let mut parts = first.series().at(surface)?.to_vec();
        if let Some(more) = ports.read_optional(next) {
            parts.extend_from_slice(more.series().at(next)?);
        }
        if parts.is_empty() {
            return Err("the surface has no part").at(surface);
        }
        ports.write(measured, wire::Surface::Series(parts));
        ports.write(passed, first.clone());
        Ok(())
    });
    declare_measures(&mut node, measured);
    node
}

/// Measuring the joints costs more than making the surface, so that it is done on request only.
fn declare_measures(node: &mut NodeKind, measured: Output<wire::Surface>) {
    let gap = node.figure("largest-gap", Unit::Length, "Largest distance between the edges at a joint.");
    let angle = node.figure("largest-angle", Unit::Angle, "Largest angle between the surface's normals at a joint.");
    let part_angle = node.figure(
        "largest-part-angle",
        Unit::Angle,
        "The same at joints between parts only: corners of sections left out.",
    );
    let jump = node.figure(
        "largest-curvature-jump",
        Unit::None,
        "Largest difference of the curvatures across a joint, one over metres.",
    );
    let table = node.table(
        "joints",
        &[
            ("joint", Unit::None),
            ("gap", Unit::Length),
            ("angle", Unit::Angle),
            ("curvature-jump", Unit::None),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
        ],
        "Each joint: the largest values found along it, and where the angle is largest.",
    );
    node.examine(move |seen| {
        let parts = seen.read(measured).series().map_err(NodeError::new)?;
        let found = continuity(parts, &seen.progress_callback()).ok_or(NodeError::Cancelled)?;
        if found.is_empty() {
            seen.note("one part of one patch: there is no joint");
        }
        let largest = |value: &dyn Fn(&JointContinuity) -> f64| found.iter().map(value).fold(0.0, f64::max);
        seen.figure(gap, largest(&|joint| joint.gap));
        seen.figure(angle, largest(&|joint| joint.angle.to_degrees()));
        let of_parts = |joint: &JointContinuity| match joint.place {
            JointPlace::Parts { .. } => joint.angle.to_degrees(),
            JointPlace::Segments { .. } => 0.0,
        };
        seen.figure(part_angle, largest(&of_parts));
        seen.figure(jump, largest(&|joint| joint.curvature_jump));
        let row = |joint: &JointContinuity| {
            let numbers =
                [joint.gap, joint.angle.to_degrees(), joint.curvature_jump, joint.at.x, joint.at.y, joint.at.z];
            std::iter::once(joint.place.to_string().into()).chain(numbers.map(Cell::from)).collect()
        };
        seen.table(table, found.iter().map(row).collect());
        Ok(())
    });
}
