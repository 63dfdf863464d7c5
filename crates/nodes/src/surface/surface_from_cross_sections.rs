//! **Surface from cross-sections**: quads through the sections, smooth across and along.
//! Reference: thesis 4, Figure 6.11.

use maquette_geometry::surface::{Cap, PoleShape, SkinError, SkinOptions, UParameter, skin};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
struct CapChoice(Cap);

impl Choices for CapChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] =
        &[(Self(Cap::None), "none", "the end stays open"), (Self(Cap::Flat), "flat", "a flat lid with a hard edge")];
}

#[derive(Clone, Copy)]
struct ParameterChoice(UParameter);

impl Choices for ParameterChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(UParameter::Centripetal), "centripetal", "by the square root of distances: swings least"),
        (Self(UParameter::ChordLength), "chord-length", "by distances"),
        (Self(UParameter::Uniform), "uniform", "equal steps, as the thesis has it (eq. 4.3)"),
    ];
}

#[derive(Clone, Copy)]
struct PoleChoice(PoleShape);

impl Choices for PoleChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(PoleShape::Round), "round", "smooth, like the crown of a head"),
        (Self(PoleShape::Pointed), "pointed", "sharp, like a horn"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "surface-from-cross-sections",
        1,
        "surface",
        "Skins a mesh of quads through sections, smooth across and along, with normals and UVs.",
    );
    node.reference("thesis chapter 4, Figure 6.11; C2 spline in u");
    let sections =
        node.input::<wire::Sections>("sections", "Sections to skin; a section that is a point closes the end.");
    let rows = node.integer("rows", 2, 1..=64, "Quads from one section to the next.");
    node.soft_range(rows, 1.0..=8.0);
    let columns = node.integer("columns", 1, 1..=64, "Quads from one point of a section to the next.");
    node.soft_range(columns, 1.0..=8.0);
    let cap_start = node.choice::<CapChoice>("cap-start", "What closes the first section.");
    let cap_end = node.choice::<CapChoice>("cap-end", "What closes the last section.");
    let parameter = node.choice::<ParameterChoice>("parameter", "How the spline's knots are spaced.");
    let pole = node.choice::<PoleChoice>("pole", "Shape where a section is a point.");
    let mesh = node.output::<wire::Mesh>("mesh", "The surface; vertices of the sections are points of the sections.");
    let faces = node.figure("faces", Unit::None, "Faces of the surface.");
    let vertices = node.figure("vertices", Unit::None, "Vertices of the surface.");
    node.evaluate(move |ports| {
        let options = SkinOptions {
            rows: ports.count(rows),
            columns: ports.count(columns),
            cap_start: ports.choice(cap_start).0,
            cap_end: ports.choice(cap_end).0,
            parameter: ports.choice(parameter).0,
            pole: ports.choice(pole).0,
        };
        let skinned = skin(&ports.read(sections).0, &options, &ports.progress_callback());
        let skinned = match skinned {
            Err(error @ SkinError::OutOfRange { what: "rows", .. }) => Err(error).at(rows),
            Err(error @ SkinError::OutOfRange { .. }) => Err(error).at(columns),
            Err(error @ (SkinError::CapOnOpenSection { section: 0 } | SkinError::CapWithoutArea { section: 0 })) => {
                Err(error).at(cap_start)
            }
            Err(error @ (SkinError::CapOnOpenSection { .. } | SkinError::CapWithoutArea { .. })) => {
                Err(error).at(cap_end)
            }
            Err(error @ SkinError::TooManyVertices { .. }) => Err(error).at(rows),
            Err(SkinError::Cancelled) => Err(NodeError::Cancelled),
            skinned => skinned.at(sections),
        };
        let skinned = skinned?;
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        {
            ports.figure(faces, skinned.polygon_count() as f64);
            ports.figure(vertices, skinned.positions().len() as f64);
        }
        ports.write(mesh, wire::Mesh::new(skinned));
        Ok(())
    });
    node
}
