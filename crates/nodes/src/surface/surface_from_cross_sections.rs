//! **Surface from cross-sections**: quads through the sections, smooth across and along.
//! Reference: thesis 4, Figure 6.11.

use std::sync::Arc;

use maquette_geometry::mesh::Mesh;
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::analytic::{AnalyticSurface, Blend, EndCondition, Side, SurfaceError, SurfaceOptions};
use maquette_geometry::surface::tessellate::{Closing, Density, Spacing, Tessellation, TessellationError, tessellate};
use maquette_geometry::surface::{Cap, SkinError, SkinOptions, skin_beside};
use maquette_graph::{AtPort, ChoiceInput, FigureHandle, Input, NodeError, NodeKind, OptionalInput, Ports, Unit};

use crate::edges::Edges;
use crate::surfacing::{BlendChoice, ClosingChoice, EndChoice, JoinChoice, ParameterChoice, PoleChoice, blend_name};
use crate::wire;

/// Columns of quads around sections that are series, where `columns` is 1.
const COLUMNS: usize = 64;

#[derive(Clone, Copy)]
struct Inputs {
    sections: Input<wire::CrossSections>,
    rows: Input<i64>,
    columns: Input<i64>,
    cap_start: ChoiceInput<ClosingChoice>,
    cap_end: ChoiceInput<ClosingChoice>,
    parameter: ChoiceInput<ParameterChoice>,
    pole: ChoiceInput<PoleChoice>,
    blend: ChoiceInput<BlendChoice>,
    neighbours: OptionalInput<wire::Borders>,
    before: OptionalInput<wire::Surface>,
    after: OptionalInput<wire::Surface>,
    continuity: ChoiceInput<JoinChoice>,
    start: ChoiceInput<EndChoice>,
    end: ChoiceInput<EndChoice>,
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "surface-from-cross-sections",
        2,
        "surface",
        "A surface through sections, smooth across and along, and its mesh of quads with normals and UVs.",
    );
    node.reference("thesis chapter 4 (4.1-4.20), Figure 6.11; C2 spline in u");
    let sections = node.input::<wire::CrossSections>(
        "sections",
        "Sections of points, or series as fit-sections makes them; a section that is a point closes the end.",
    );
    let rows = node.integer("rows", 2, 1..=64, "Quads from one section to the next.");
    node.soft_range(rows, 1.0..=8.0);
    let columns = node.integer(
        "columns",
        1,
        1..=64,
        "Quads from one point of a section to the next; 64 times as many around sections that are series.",
    );
    node.soft_range(columns, 1.0..=8.0);
    let inputs = Inputs {
        sections,
        rows,
        columns,
        cap_start: node.choice("cap-start", "What closes the first section."),
        cap_end: node.choice("cap-end", "What closes the last section."),
        parameter: node.choice("parameter", "How the sections are spaced along u."),
        pole: node.choice("pole", "Shape where a section is a point."),
        blend: node.choice("blend", "The functions of u between the sections; those of points have the spline."),
        neighbours: node.optional(
            "neighbours",
            "Borders of surfaces that it continues, those that its sections were made with: it leaves them without a crease. \
             For sections of points.",
        ),
        before: node.optional(
            "before",
            "A surface that this one goes on from: its last section is the first one here. For series.",
        ),
        after: node
            .optional("after", "A surface that this one leads to: its first section is the last one here. For series."),
        continuity: node.choice("continuity", "How it meets the surfaces before and after."),
        start: node.choice("start", "How it begins where nothing is before. For series."),
        end: node.choice("end", "How it ends where nothing comes after. For series."),
    };
    let mesh = node.output::<wire::Mesh>("mesh", "The mesh; sections of points have their points among its vertices.");
    let surface = node.output::<wire::Surface>("surface", "The surface itself; exact everywhere where made of series.");
    let faces = node.figure("faces", Unit::None, "Faces of the mesh.");
    let vertices = node.figure("vertices", Unit::None, "Vertices of the mesh.");
    let figures = [
        node.figure("sections", Unit::None, "Sections that the surface goes through; of series."),
        node.figure("constants", Unit::None, "Numbers that determine the surface; of series."),
    ];
    node.evaluate(move |ports| {
        let made = match ports.read(inputs.sections) {
            wire::CrossSections::Points(points) => {
                let made = inputs.skinned(ports, &points.0)?;
                ports.write(surface, wire::Surface::Points(Arc::new(points.0.clone())));
                made
            }
            wire::CrossSections::Series(series) => {
                let exact = inputs.through(ports, series, figures)?;
                let made = inputs.meshed(ports, &exact)?;
                ports.write(surface, wire::Surface::Series(vec![exact]));
                made
            }
        };
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        {
            ports.figure(faces, made.polygon_count() as f64);
            ports.figure(vertices, made.positions().len() as f64);
        }
        ports.write(mesh, wire::Mesh::new(made));
        Ok(())
    });
    node
}

impl Inputs {
    /// The mesh through sections of points.
    fn skinned(self, ports: &Ports<'_>, sections: &Sections) -> Result<Mesh, NodeError> {
        const SERIES_ONLY: &str = "needs sections that are series: put a `fit-sections` node before this one, or";
        let cap = |input: ChoiceInput<ClosingChoice>| match ports.choice(input).0 {
            Closing::Open => Ok(Cap::None),
            Closing::Flat => Ok(Cap::Flat),
            Closing::Rounded => Err(format!("a rounded cap {SERIES_ONLY} take a flat cap")).at(input),
        };
        for (input, connected) in [self.before, self.after].map(|input| (input, ports.read_optional(input).is_some())) {
            if connected {
                return Err(format!("a surface beside this one {SERIES_ONLY} disconnect it")).at(input);
            }
        }
        for input in [self.start, self.end] {
            if ports.choice(input) == EndChoice::Natural {
                return Err(format!("a natural end {SERIES_ONLY} set it to free")).at(input);
            }
        }
        if ports.choice(self.blend).0 == Blend::Polynomial {
            return Err(format!("the polynomial {SERIES_ONLY} take the spline")).at(self.blend);
        }
        let options = SkinOptions {
            rows: ports.count(self.rows),
            columns: ports.count(self.columns),
            cap_start: cap(self.cap_start)?,
            cap_end: cap(self.cap_end)?,
            parameter: ports.choice(self.parameter).0,
            pole: ports.choice(self.pole).0,
        };
        let borders = ports.read_optional(self.neighbours).map(|borders| borders.0.as_slice()).unwrap_or_default();
        let found = Edges::of(sections, borders).at(self.neighbours)?;
        use SkinError as E;
        match skin_beside(sections, &options, &found.beside(), &ports.progress_callback()) {
            Err(error @ E::OutOfRange { what: "rows", .. }) => Err(error).at(self.rows),
            Err(error @ E::OutOfRange { .. }) => Err(error).at(self.columns),
            Err(error @ (E::CapOnOpenSection { section: 0 } | E::CapWithoutArea { section: 0 })) => {
                Err(error).at(self.cap_start)
            }
            Err(error @ (E::CapOnOpenSection { .. } | E::CapWithoutArea { .. })) => Err(error).at(self.cap_end),
            Err(error @ E::TooManyVertices { .. }) => Err(error).at(self.rows),
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            skinned => skinned.at(self.sections),
        }
    }

    /// The surface through series.
    fn through(
        self,
        ports: &mut Ports<'_>,
        series: &wire::EllipticSections,
        [sections, constants]: [FigureHandle; 2],
    ) -> Result<AnalyticSurface, NodeError> {
        if ports.read_optional(self.neighbours).is_some() {
            let message = "neighbours are for sections of points: disconnect them, and use `before` and `after`";
            return Err(message).at(self.neighbours);
        }
        let continuity = ports.choice(self.continuity).0;
        let neighbour =
            |input: OptionalInput<wire::Surface>, side, otherwise: EndChoice| -> Result<EndCondition, NodeError> {
                let Some(beside) = ports.read_optional(input) else { return Ok(otherwise.condition()) };
                let parts = beside.series().at(input)?;
                let part = if side == Side::Start { parts.last() } else { parts.first() };
                let part = part.ok_or("the surface has no part").at(input)?;
                Ok(EndCondition::Neighbour { surface: part.clone(), continuity })
            };
        let options = SurfaceOptions {
            blend: ports.choice(self.blend).0,
            parameter: ports.choice(self.parameter).0,
            pole: ports.choice(self.pole).0,
            start: neighbour(self.before, Side::Start, ports.choice(self.start))?,
            end: neighbour(self.after, Side::End, ports.choice(self.end))?,
        };
        use SurfaceError as E;
        let surface = match AnalyticSurface::through(&series.sections(), &options) {
            Err(error @ E::TooManyForPolynomial { .. }) => Err(error).at(self.blend),
            Err(error @ (E::NotShared { side: Side::Start, .. } | E::OtherNeighbour { side: Side::Start })) => {
                Err(error).at(self.before)
            }
            Err(error @ (E::NotShared { .. } | E::OtherNeighbour { .. })) => Err(error).at(self.after),
            surface => surface.at(self.sections),
        };
        let surface = surface?;
        let count = surface.section_parameters().len();
        ports.note(format!("blended by {} through {count} sections", blend_name(surface.blend())));
        surface.warnings().iter().for_each(|warning| ports.warn(warning));
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        {
            ports.figure(sections, count as f64);
            ports.figure(constants, surface.constants() as f64);
        }
        Ok(surface)
    }

    /// The mesh of the surface through series.
    fn meshed(self, ports: &Ports<'_>, surface: &AnalyticSurface) -> Result<Mesh, NodeError> {
        let options = Tessellation {
            density: Density::Sections { rows: ports.count(self.rows), columns: COLUMNS * ports.count(self.columns) },
            spacing: Spacing::Curvature,
            start: ports.choice(self.cap_start).0,
            end: ports.choice(self.cap_end).0,
        };
        use TessellationError as E;
        let made = match tessellate(std::slice::from_ref(surface), &options, &ports.progress_callback()) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ (E::CapOnOpenSurface { side: Side::Start } | E::CapWithoutArea { side: Side::Start })) => {
                Err(error).at(self.cap_start)
            }
            Err(error @ (E::CapOnOpenSurface { .. } | E::CapWithoutArea { .. })) => Err(error).at(self.cap_end),
            Err(error @ E::TooManyVertices { .. }) => Err(error).at(self.rows),
            made => made.at(self.sections),
        };
        Ok(made?.mesh)
    }
}
