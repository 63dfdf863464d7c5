//! **Tessellate**: the mesh of a surface, at a wanted density or level of detail, with its measured deviation.
//! Reference: thesis 4.3.

use maquette_geometry::surface::analytic::{AnalyticSurface, Side, SurfaceError};
use maquette_geometry::surface::level_of_detail::{Level, LevelError, levels};
use maquette_geometry::surface::tessellate::{Density, Spacing, Tessellation, TessellationError, tessellate};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::surfacing::ClosingChoice;
use crate::wire;

#[derive(Clone, Copy, PartialEq)]
enum By {
    Grid,
    Quads,
    Deviation,
}

impl Choices for By {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Grid, "grid", "rows and columns"),
        (Self::Quads, "quads", "about so many quads, shared between rows and columns for the least deviation"),
        (Self::Deviation, "deviation", "as few quads as stay within a distance of the surface"),
    ];
}

#[derive(Clone, Copy)]
struct SpacingChoice(Spacing);

impl Choices for SpacingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Spacing::Curvature), "curvature", "closer where the surface bends more"),
        (Self(Spacing::Even), "even", "equal steps"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "tessellate",
        1,
        "surface",
        "The mesh of a surface through series, by quads wanted or deviation allowed, without cracks between its parts.",
    );
    node.reference("thesis chapter 4; the deviation is measured at 5 by 5 points of each quad");
    let surface = node.input::<wire::Surface>("surface", "A surface through series, one part or several end to end.");
    let by = node.choice::<By>("by", "What decides how fine the mesh is.");
    let rows = node.integer("rows", 32, 1..=65_536, "Rows of quads along all parts. For the grid.");
    node.soft_range(rows, 4.0..=512.0);
    let columns = node.integer("columns", 64, 1..=65_536, "Columns of quads around. For the grid.");
    node.soft_range(columns, 8.0..=512.0);
    let quads = node.integer("quads", 2048, 1..=50_000_000, "Quads wanted. For quads.");
    node.soft_range(quads, 64.0..=100_000.0);
    let allowed = node.length("deviation", 0.0005, 1e-9..=1e3, "Distance allowed from the surface. For deviation.");
    node.soft_range(allowed, 1e-5..=0.01);
    let spacing = node.choice::<SpacingChoice>("spacing", "How rows and columns are spread.");
    let cap_start = node.choice::<ClosingChoice>("cap-start", "What closes the beginning of the first part.");
    let cap_end = node.choice::<ClosingChoice>("cap-end", "What closes the end of the last part.");
    let harmonics = node.integer(
        "harmonics",
        0,
        0..=100,
        "A coarser surface: harmonics above this are left out of every section; 0 keeps all.",
    );
    node.soft_range(harmonics, 0.0..=15.0);
    let sections = node.integer(
        "sections",
        0,
        0..=4096,
        "A coarser surface: each part goes through so many of its sections only; 0 keeps all.",
    );
    node.soft_range(sections, 0.0..=32.0);
    let measured = node.boolean("measure", true, "Measure how far a grid is from the surface; the others always do.");
    let mesh = node.output::<wire::Mesh>("mesh", "The mesh, with exact normals.");
    let faces = node.figure("faces", Unit::None, "Faces of the mesh.");
    let vertices = node.figure("vertices", Unit::None, "Vertices of the mesh.");
    let deviation =
        node.figure("deviation", Unit::Length, "Largest measured distance from the exact surface to the mesh.");
    let constants = node.figure("constants", Unit::None, "Numbers that determine the surface that was meshed.");
    node.evaluate(move |ports| {
        let parts = ports.read(surface).series().at(surface)?;
        let by_what = ports.choice(by);
        let density = match by_what {
            By::Grid => Density::Grid { rows: ports.count(rows), columns: ports.count(columns) },
            By::Quads => Density::Quads(ports.count(quads)),
            By::Deviation => Density::Deviation(ports.value(allowed)),
        };
        let options = Tessellation {
            density,
            spacing: ports.choice(spacing).0,
            start: ports.choice(cap_start).0,
            end: ports.choice(cap_end).0,
        };
        let wanted = |input| Some(ports.count(input)).filter(|count| *count > 0);
        let level = Level { density, harmonics: wanted(harmonics), sections: wanted(sections) };
        let progress = ports.progress_callback();
        let plain = by_what == By::Grid && !ports.value(measured) && level == Level::of(density);
        let made = if plain {
            tessellate(parts, &options, &progress)
                .map(|made| (made, None, parts.iter().map(AnalyticSurface::constants).sum()))
                .map_err(|error| LevelError::Tessellation { level: 0, error })
        } else {
            levels(parts, &options, &[level], &progress).and_then(|mut made| {
                let made = made.pop().ok_or(LevelError::Tessellation { level: 0, error: TessellationError::NoSurfaces })?;
                Ok((made.tessellated, Some(made.deviation), made.constants))
            })
        };
        use TessellationError as E;
        let density_input = match by_what {
            By::Grid => rows,
            By::Quads => quads,
            By::Deviation => rows,
        };
        let (made, far, numbers) = match made {
            Ok(made) => made,
            Err(LevelError::TooFar { reached, wanted, .. }) => {
                return Err(format!(
                    "with the harmonics or sections left out the mesh is {reached:.2e} m from the surface, and {wanted:.2e} \
                     m is allowed: leave out fewer, or allow more"
                ))
                .at(allowed);
            }
            Err(LevelError::Surface { error: error @ SurfaceError::OutOfRange { what: "sections", .. }, .. }) => {
                return Err(error).at(sections);
            }
            Err(LevelError::Surface { error, .. }) => {
                return if level.harmonics.is_some() { Err(error).at(harmonics) } else { Err(error).at(sections) };
            }
            Err(LevelError::Empty(error)) => return Err(error).at(surface),
            Err(LevelError::Tessellation { error, .. }) => {
                return match error {
                    E::Cancelled => Err(NodeError::Cancelled),
                    E::CapOnOpenSurface { side } | E::CapWithoutArea { side } => {
                        Err(error).at(if side == Side::Start { cap_start } else { cap_end })
                    }
                    E::NoDeviation { .. } | E::NotReached { .. } => Err(error).at(allowed),
                    E::TooManyVertices { .. } if by_what == By::Deviation => Err(error).at(allowed),
                    E::TooManyVertices { .. } | E::NoQuads => Err(error).at(density_input),
                    error => Err(error).at(surface),
                };
            }
        };
        ports.note(format!("{} rows and {} columns", made.rows, made.columns));
        if let Some(far) = far {
            ports.figure(deviation, far.largest);
        }
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^53")]
        {
            ports.figure(faces, made.mesh.polygon_count() as f64);
            ports.figure(vertices, made.mesh.positions().len() as f64);
            let numbers: usize = numbers;
            ports.figure(constants, numbers as f64);
        }
        ports.write(mesh, wire::Mesh::new(made.mesh));
        Ok(())
    });
    node
}
