//! **Caps**: open ends of a mesh are closed.

use glam::DVec3;
use maquette_geometry::mesh::caps::{CapError, CapOptions, CapShape, cap_while};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
enum Shape {
    Flat,
    Fan,
    Rounded,
}

impl Choices for Shape {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Flat, "flat", "a flat lid with a hard edge, in rings of quads where the end allows it"),
        (Self::Fan, "fan", "a fan of triangles with a hard edge"),
        (Self::Rounded, "rounded", "a dome that goes on smoothly where the surface ends"),
    ];
}

#[derive(Clone, Copy)]
enum Which {
    All,
    Nearest,
}

impl Choices for Which {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] =
        &[(Self::All, "all", "every open loop"), (Self::Nearest, "nearest", "the one nearest to `point`")];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("caps", 1, "mesh", "Closes open ends of a mesh: flat, by a fan, or rounded.");
    let mesh = node.input::<wire::Mesh>("mesh", "Mesh with open ends.");
    let shape = node.choice::<Shape>("shape", "The shape of the caps.");
    let which = node.choice::<Which>("which", "Which ends are closed.");
    let point =
        node.vector("point", [0.0; 3], Unit::Length, "The end nearest to this is closed, where `which` says so.");
    let height = node.number("height", 1.0, 0.05..=4.0, "Height of a rounded cap; 1 is that of a sphere.");
    node.soft_range(height, 0.2..=2.0);
    let rings = node.integer("rings", 8, 2..=64, "Rings of faces from the edge of a rounded cap to its top.");
    node.soft_range(rings, 3.0..=16.0);
    let capped = node.output::<wire::Mesh>("mesh", "The mesh, its caps behind its own faces.");
    let closed = node.figure("closed", Unit::None, "Loops that were closed.");
    let open = node.figure("open", Unit::None, "Loops that stay open.");
    let table = node.table(
        "caps",
        &[
            ("vertices", Unit::None),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
            ("flatness", Unit::Length),
        ],
        "The loops that were closed: vertices, middle, and how far they are from lying in a plane.",
    );
    node.evaluate(move |ports| {
        let options = CapOptions {
            shape: match ports.choice(shape) {
                Shape::Flat => CapShape::Flat,
                Shape::Fan => CapShape::Fan,
                Shape::Rounded => CapShape::Rounded { height: ports.value(height), rings: ports.count(rings) },
            },
            nearest: match ports.choice(which) {
                Which::All => None,
                Which::Nearest => Some(DVec3::from_array(ports.read(point).0)),
            },
        };
        let made = match cap_while(&ports.read(mesh).0, &options, &ports.progress_callback()) {
            Err(CapError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ CapError::NotStarShaped { .. }) => return Err(error).at(shape),
            Err(error @ CapError::Point { .. }) => return Err(error).at(point),
            made => made.at(mesh)?,
        };
        let rows = made.caps.iter().map(|cap| {
            vec![cap.vertices.into(), cap.at.x.into(), cap.at.y.into(), cap.at.z.into(), cap.flatness.into()]
        });
        ports.table(table, rows.collect());
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        {
            ports.figure(closed, made.caps.len() as f64);
            ports.figure(open, made.open as f64);
        }
        ports.write(capped, wire::Mesh::new(made.mesh));
        Ok(())
    });
    node
}
