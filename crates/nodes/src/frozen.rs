//! How the wire types become plain data for golden files.

use glam::{DVec2, DVec3};
use maquette_geometry::border::Border;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::{FaceNames, Mesh, NamedBy};
use maquette_geometry::scene::Material;
use maquette_geometry::sections::Sections;
use maquette_graph::freeze::{Freeze, Frozen, ThawError};
use maquette_graph::{Catalogue, Value};

use crate::wire;

mod analytic;
mod handles;

/// Lets golden files hold values of all wire types of this library.
pub(crate) fn register(catalogue: &mut Catalogue) {
    catalogue.freezable::<wire::Curve>();
    catalogue.freezable::<wire::Curves>();
    catalogue.freezable::<wire::Sections>();
    catalogue.freezable::<wire::EllipticSections>();
    catalogue.freezable::<wire::CrossSections>();
    catalogue.freezable::<wire::Borders>();
    catalogue.freezable::<wire::Selection>();
    catalogue.freezable::<wire::Held>();
    catalogue.freezable::<wire::Handles>();
    catalogue.freezable::<wire::Bound>();
    catalogue.freezable::<wire::Shape>();
    catalogue.freezable::<wire::Surface>();
    catalogue.freezable::<wire::Mesh>();
    catalogue.freezable::<wire::MeshResult>();
    catalogue.freezable::<wire::CurvesResult>();
}

fn no_value(error: impl std::fmt::Display) -> ThawError {
    ThawError(error.to_string())
}

fn points(points: &[DVec3]) -> Frozen {
    Frozen::Points(points.iter().map(DVec3::to_array).collect())
}

fn thawed_points(frozen: &Frozen) -> Result<Vec<DVec3>, ThawError> {
    Ok(frozen.points()?.iter().copied().map(DVec3::from_array).collect())
}

fn indices<'a>(indices: impl IntoIterator<Item = &'a usize>) -> Frozen {
    Frozen::Integers(indices.into_iter().map(|index| i64::try_from(*index).unwrap_or(i64::MAX)).collect())
}

fn thawed_indices<T: TryFrom<i64>>(frozen: &Frozen) -> Result<Vec<T>, ThawError> {
    let index = |integer: &i64| T::try_from(*integer).map_err(|_| no_value(format!("{integer} is no index")));
    frozen.integers()?.iter().map(index).collect()
}

/// Something, or [`Frozen::Nothing`].
fn optional<T>(frozen: &Frozen, thaw: impl Fn(&Frozen) -> Result<T, ThawError>) -> Result<Option<T>, ThawError> {
    if *frozen == Frozen::Nothing { Ok(None) } else { thaw(frozen).map(Some) }
}

fn freeze_curve(curve: &Curve) -> Frozen {
    Frozen::record([
        ("name", Frozen::text(curve.name())),
        ("closed", Frozen::Boolean(curve.is_closed())),
        ("points", points(curve.points())),
        ("pressure", curve.pressure().map_or(Frozen::Nothing, |pressure| Frozen::Numbers(pressure.to_vec()))),
    ])
}

fn thaw_curve(frozen: &Frozen) -> Result<Curve, ThawError> {
    let pressure = optional(frozen.field("pressure")?, |p| p.numbers().map(<[f64]>::to_vec))?;
    let closed = frozen.field("closed")?.boolean()?;
    Curve::with_pressure(frozen.field("name")?.as_text()?, thawed_points(frozen.field("points")?)?, closed, pressure)
        .map_err(no_value)
}

fn freeze_curves(curves: &[Curve]) -> Frozen {
    Frozen::List(curves.iter().map(freeze_curve).collect())
}

fn thaw_curves(frozen: &Frozen) -> Result<Vec<Curve>, ThawError> {
    frozen.list()?.iter().map(thaw_curve).collect()
}

fn freeze_mesh(mesh: &Mesh) -> Frozen {
    let counts: Vec<usize> = mesh.polygons().map(<[u32]>::len).collect();
    let uvs = |uvs: &[DVec2]| Frozen::Numbers(uvs.iter().flat_map(|uv| uv.to_array()).collect());
    let names = |names: &FaceNames| Frozen::List(names.iter().map(Frozen::text).collect());
    let named = [("groups", mesh.groups()), ("materials", mesh.materials())];
    // Left out where there are none, as in golden files from before meshes had names.
    let named = named.into_iter().filter_map(|(field, of)| of.map(|of| (field, names(of))));
    let fields = [
        ("name", Frozen::text(mesh.name())),
        ("positions", points(mesh.positions())),
        ("corners", Frozen::Integers(mesh.corners().iter().map(|vertex| i64::from(*vertex)).collect())),
        ("corners-of-faces", indices(&counts)),
        ("normals", mesh.normals().map_or(Frozen::Nothing, points)),
        ("uvs", mesh.uvs().map_or(Frozen::Nothing, uvs)),
    ];
    Frozen::Record(fields.into_iter().chain(named).map(|(field, value)| (field.to_owned(), value)).collect())
}

fn thaw_mesh(frozen: &Frozen) -> Result<Mesh, ThawError> {
    let positions = thawed_points(frozen.field("positions")?)?;
    let corners = thawed_indices(frozen.field("corners")?)?;
    let counts: Vec<usize> = thawed_indices(frozen.field("corners-of-faces")?)?;
    let mut mesh = Mesh::from_corners(positions, corners, counts).map_err(no_value)?;
    if let Some(normals) = optional(frozen.field("normals")?, thawed_points)? {
        mesh = mesh.with_normals(normals).map_err(no_value)?;
    }
    if let Some(numbers) = optional(frozen.field("uvs")?, |uvs| uvs.numbers().map(<[f64]>::to_vec))? {
        let (pairs, []) = numbers.as_chunks::<2>() else { return Err(no_value("a UV has two numbers")) };
        mesh = mesh.with_uvs(pairs.iter().copied().map(DVec2::from_array).collect()).map_err(no_value)?;
    }
    for (field, by) in [("groups", NamedBy::Group), ("materials", NamedBy::Material)] {
        if let Ok(names) = frozen.field(field) {
            let names = names.list()?.iter().map(Frozen::as_text).collect::<Result<Vec<_>, _>>()?;
            mesh = mesh.with_names(by, FaceNames::new(names)).map_err(no_value)?;
        }
    }
    Ok(mesh.named(frozen.field("name")?.as_text()?))
}

fn four(frozen: &Frozen) -> Result<[f64; 4], ThawError> {
    frozen.numbers()?.try_into().map_err(|_| no_value("a colour has four numbers"))
}

impl Freeze for wire::Curve {
    fn freeze(&self) -> Frozen {
        freeze_curve(&self.0)
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        thaw_curve(frozen).map(Self)
    }
}

impl Freeze for wire::Curves {
    fn freeze(&self) -> Frozen {
        freeze_curves(&self.0)
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        thaw_curves(frozen).map(Self)
    }
}

impl Freeze for wire::Sections {
    fn freeze(&self) -> Frozen {
        Frozen::record([
            ("closed", Frozen::Boolean(self.0.is_closed())),
            ("rails", indices(self.0.rails())),
            ("sections", Frozen::List(self.0.iter().map(points).collect())),
        ])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let rows = frozen.field("sections")?.list()?.iter().map(thawed_points).collect::<Result<_, _>>()?;
        let rails = thawed_indices(frozen.field("rails")?)?;
        Sections::new(rows, frozen.field("closed")?.boolean()?, rails).map(Self).map_err(no_value)
    }
}

impl Freeze for wire::Mesh {
    fn freeze(&self) -> Frozen {
        freeze_mesh(&self.0)
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        thaw_mesh(frozen).map(Self::new)
    }
}

impl Freeze for wire::MeshResult {
    fn freeze(&self) -> Frozen {
        Frozen::record([
            ("mesh", freeze_mesh(&self.mesh)),
            ("material", Frozen::text(&self.material.name)),
            ("colour", Frozen::Numbers(self.material.colour.to_vec())),
            ("metallic", Frozen::Number(self.material.metallic)),
            ("roughness", Frozen::Number(self.material.roughness)),
            ("double-sided", Frozen::Boolean(self.material.double_sided)),
        ])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let mesh = wire::Mesh::new(thaw_mesh(frozen.field("mesh")?)?);
        let material = Material {
            name: frozen.field("material")?.as_text()?.to_owned(),
            colour: four(frozen.field("colour")?)?,
            metallic: frozen.field("metallic")?.number()?,
            roughness: frozen.field("roughness")?.number()?,
            double_sided: frozen.field("double-sided")?.boolean()?,
        };
        Ok(Self { mesh: mesh.0.clone(), mesh_hash: Value::new(mesh).hash(), material })
    }
}

impl Freeze for wire::CurvesResult {
    fn freeze(&self) -> Frozen {
        Frozen::record([("curves", freeze_curves(&self.curves)), ("colour", Frozen::Numbers(self.colour.to_vec()))])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        Ok(Self { curves: thaw_curves(frozen.field("curves")?)?, colour: four(frozen.field("colour")?)? })
    }
}

impl Freeze for wire::Borders {
    fn freeze(&self) -> Frozen {
        let border = |border: &Border| {
            Frozen::record([("curve", freeze_curve(border.curve())), ("directions", points(border.directions()))])
        };
        Frozen::List(self.0.iter().map(border).collect())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let border = |frozen: &Frozen| {
            let curve = thaw_curve(frozen.field("curve")?)?;
            Border::new(curve, thawed_points(frozen.field("directions")?)?).map_err(no_value)
        };
        frozen.list()?.iter().map(border).collect::<Result<_, ThawError>>().map(Self)
    }
}

impl Freeze for wire::Shape {
    fn freeze(&self) -> Frozen {
        match self {
            Self::Mesh(mesh) => Frozen::record([("mesh", mesh.freeze())]),
            Self::Surface(surface) => Frozen::record([("surface", surface.freeze())]),
            Self::Sections(sections) => Frozen::record([("sections", sections.freeze())]),
        }
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        if let Ok(mesh) = frozen.field("mesh") {
            return wire::Mesh::thaw(mesh).map(Self::Mesh);
        }
        if let Ok(surface) = frozen.field("surface") {
            return wire::Surface::thaw(surface).map(Self::Surface);
        }
        wire::Sections::thaw(frozen.field("sections")?).map(Self::Sections)
    }
}
