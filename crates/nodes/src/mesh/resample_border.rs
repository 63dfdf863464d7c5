//! **Resample border**: an open border of a mesh gets even points, so that a blend can be welded to it.
//! Reference: paper 5.2.5.

use glam::DVec3;
use maquette_geometry::border::{Border, boundaries, boundary_along};
use maquette_geometry::curve::{ArcLength, closest};
use maquette_geometry::mesh::resample_border::{
    ResampleBorderError, ResampleBorderOptions, resample_border, resample_border_onto,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, OptionalInput, Ports, Unit};

use crate::wire;

#[derive(Clone, Copy)]
enum Which {
    Longest,
    Nearest,
}

impl Choices for Which {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Longest, "longest", "the one with the longest curve"),
        (Self::Nearest, "nearest", "the one nearest to the point"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "resample-border",
        2,
        "mesh",
        "Gives an open border of a mesh as many points as wanted, at equal distances, and new faces along it: a blend with \
         as many `nodes` can be welded to it.",
    );
    node.reference("paper 5.2.5");
    let mesh = node.input::<wire::Mesh>("mesh", "A mesh with a hole or an open end.");
    let which = node.choice::<Which>("which", "Which border.");
    let near = node.vector("near", [0.0; 3], Unit::Length, "The point, where the nearest border is wanted.");
    let beside = node.optional::<wire::Borders>(
        "beside",
        "The border nearest to this one is taken, whatever `which` says: what a cut gave, or what the blend leads to.",
    );
    let points = node.integer(
        "points",
        64,
        8..=4096,
        "Points of the new border. One that has them already, spread not too unevenly, keeps them.",
    );
    node.soft_range(points, 16.0..=256.0);
    let start = node.vector(
        "start",
        [0.0, 0.0, -1.0],
        Unit::None,
        "Point 0 is where the border reaches farthest in this direction: on the plane of symmetry, symmetric borders get \
         symmetric points.",
    );
    let smooth = node.boolean(
        "smooth",
        true,
        "Lay a smooth curve (C2 spline) through the border first; otherwise keep to its straight sides.",
    );
    let like = node.optional::<wire::Borders>(
        "like",
        "The new border has the points of this one, that of a patch made between its sides, and not `points` even ones.",
    );
    let resampled = node.output::<wire::Mesh>("mesh", "The mesh with the new border.");
    let borders = node.output::<wire::Borders>("borders", "The new border, ready for `blend`.");
    let went =
        node.figure("faces-replaced", Unit::None, "Faces along the border that went; 0 where it stays as it was.");
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let loops = body.boundary_loops();
        let before: Vec<Border> = boundaries(body).at(mesh)?;
        let point = DVec3::from_array(ports.read(near).0);
        let (other, wanted) = (only(ports, beside)?, only(ports, like)?);
        let place = |border: &Border| match (other, ports.choice(which)) {
            (Some(other), _) => border.mean_distance(other.curve()),
            (None, Which::Longest) => -ArcLength::of(border.curve()).length(),
            (None, Which::Nearest) => closest(border.curve(), point).distance,
        };
        let Some(chosen) = before.iter().min_by(|a, b| place(a).total_cmp(&place(b))) else {
            return Err("there is no border: it is closed. Cut it with cut-with-plane or cut-with-curve").at(mesh);
        };
        let at = |vertices: &[u32]| -> Vec<DVec3> { vertices.iter().map(|v| body.positions()[*v as usize]).collect() };
        let Some(rim) = loops.iter().find(|vertices| at(vertices) == chosen.curve().points()) else {
            return Err("its border is no loop: mend the mesh there").at(mesh);
        };
        let options = ResampleBorderOptions {
            points: ports.count(points),
            start: DVec3::from_array(ports.read(start).0),
            smooth: ports.value(smooth),
        };
        let progress = ports.progress_callback();
        let made = match wanted {
            Some(wanted) => resample_border_onto(body, rim, wanted, &progress),
            None => resample_border(body, rim, &options, &progress),
        };
        let made = match made {
            Err(error @ (ResampleBorderError::Open { .. } | ResampleBorderError::Away { .. })) => {
                return Err(error).at(like);
            }
            Err(ResampleBorderError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ ResampleBorderError::Points { .. }) => return Err(error).at(points),
            Err(error @ ResampleBorderError::Start { .. }) => return Err(error).at(start),
            made => made.at(mesh)?,
        };
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        ports.figure(went, made.replaced[0] as f64);
        let border = boundary_along(&made.mesh, &made.border, chosen.curve().name()).at(mesh)?;
        ports.write(borders, wire::Borders(vec![border]));
        ports.write(resampled, wire::Mesh::new(made.mesh));
        Ok(())
    });
    node
}

/// The one border of an optional input.
fn only<'a>(ports: &Ports<'a>, input: OptionalInput<wire::Borders>) -> Result<Option<&'a Border>, NodeError> {
    match ports.read_optional(input).map(|borders| borders.0.as_slice()) {
        None => Ok(None),
        Some([border]) => Ok(Some(border)),
        Some(several) => {
            let message = "borders arrive where one is wanted: choose it with the `which` of a boundary-of node";
            Err(format!("{} {message}", several.len())).at(input)
        }
    }
}
