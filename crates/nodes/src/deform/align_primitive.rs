//! **Align primitive**: puts a primitive in the place of sketched silhouettes.
//! Reference: thesis 5.1, 5.2 (Figures 5.2, 5.3a).

use glam::DVec3;
use maquette_geometry::deform::{AlignError, AlignOptions, AxisShape, align_primitive};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use super::MatchingChoice;
use crate::silhouettes::SilhouetteInputs;
use crate::wire;

#[derive(Clone, Copy)]
struct AxisChoice(AxisShape);

impl Choices for AxisChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(AxisShape::Bent), "bent", "half way between the strokes, bent where they bend"),
        (Self(AxisShape::Straight), "straight", "the straight line through its middle"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "align-primitive",
        1,
        "deform",
        "Puts a primitive along the axis of sketched silhouettes, as wide as they are, ready for deform-to-silhouette.",
    );
    node.reference("thesis 5.1, 5.2 (Figures 5.2, 5.3a)");
    let sections = node.input::<wire::Sections>("sections", "The primitive: closed sections, wherever it stands.");
    let strokes = SilhouetteInputs::declare(&mut node, "two open ones, or one around the shape.");
    let axis = node.choice::<AxisChoice>("axis", "The line along which the primitive is placed.");
    let matching = node.choice::<MatchingChoice>("matching", "How points of both sides find each other.");
    let taper = node.number(
        "taper",
        0.0,
        0.0..=1.0,
        "How much each section follows the local width: 0 keeps the primitive's profile, 1 is as wide as the strokes.",
    );
    let offset = node.vector("offset", [0.0; 3], Unit::Length, "Moves the primitive by hand.");
    let scale = node.vector(
        "scale",
        [1.0; 3],
        Unit::None,
        "Factors by hand: of the width in the view whose strokes are longest, of the length, of the depth there.",
    );
    let twist = node.angle("twist", 0.0, -3600.0..=3600.0, "Turns the primitive about its axis.");
    node.soft_range(twist, -180.0..=180.0);
    let aligned = node.output::<wire::Sections>("sections", "The primitive in its place, sections across the axis.");
    let line = node.output::<wire::Curve>("axis", "The axis that was found, from the first section to the last.");
    let half_width =
        node.figure("half-width", Unit::Length, "Mean half width of the sections, before scaling by hand.");
    let half_depth =
        node.figure("half-depth", Unit::Length, "Mean half depth of the sections, before scaling by hand.");
    node.evaluate(move |ports| {
        let silhouettes = strokes.read(ports)?;
        let vector = |input| DVec3::from_array(ports.read::<maquette_graph::Vector>(input).0);
        let options = AlignOptions {
            axis: ports.choice(axis).0,
            matching: ports.choice(matching).0,
            taper: ports.value(taper),
            offset: vector(offset),
            scale: vector(scale),
            twist: ports.value(twist).to_radians(),
        };
        use AlignError as E;
        let progress = ports.progress_callback();
        let made = match align_primitive(&ports.read(sections).0, &silhouettes, &options, &progress) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ E::Option { what, .. }) => match what {
                "the taper" => Err(error).at(taper),
                "a scale" => Err(error).at(scale),
                "the twist" => Err(error).at(twist),
                _ => Err(error).at(offset),
            },
            Err(error @ (E::NoAxis | E::NoWidth | E::Sections(_))) => Err(error).at(sections),
            Err(error @ E::Level { .. }) => Err(error).at(matching),
            Err(E::Strokes(error)) => {
                let port = strokes.port(error.view(), &silhouettes);
                Err(error).at(port)
            }
            made => Ok(made?),
        }?;
        made.warnings.iter().for_each(|warning| ports.warn(warning));
        ports.figure(half_width, made.half_size.x);
        ports.figure(half_depth, made.half_size.y);
        ports.write(aligned, wire::Sections(made.sections));
        ports.write(line, wire::Curve(made.axis));
        Ok(())
    });
    node
}
