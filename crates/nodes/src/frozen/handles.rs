//! Selections, handles and bound meshes as plain data.

use glam::{DMat3, DVec3};
use maquette_geometry::deform::laplacian::{HandleTransform, Holds, Reconstruction};
use maquette_geometry::mesh::Selection;
use maquette_graph::Value;
use maquette_graph::freeze::{Freeze, Frozen, ThawError};

use super::{no_value, optional, points, thawed_points};
use crate::wire;

impl Freeze for wire::Selection {
    fn freeze(&self) -> Frozen {
        Frozen::record([
            ("weights", Frozen::Numbers(self.weights.weights().to_vec())),
            ("mesh", wire::Mesh(self.mesh.clone()).freeze()),
        ])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let weights = Selection::new(frozen.field("weights")?.numbers()?.to_vec()).map_err(no_value)?;
        Ok(Self::new(weights, wire::Mesh::thaw(frozen.field("mesh")?)?))
    }
}

fn freeze_held(held: &wire::HeldSelection) -> [(&'static str, Frozen); 2] {
    let holds = match held.holds {
        Holds::Both => "both",
        Holds::Position => "position",
        Holds::Gradient => "gradient",
    };
    [("selection", held.selection.freeze()), ("holds", Frozen::text(holds))]
}

fn thaw_held(frozen: &Frozen) -> Result<wire::HeldSelection, ThawError> {
    let holds = match frozen.field("holds")?.as_text()? {
        "both" => Holds::Both,
        "position" => Holds::Position,
        "gradient" => Holds::Gradient,
        other => return Err(no_value(format!("a handle holds \"{other}\", which is nothing"))),
    };
    Ok(wire::HeldSelection { selection: wire::Selection::thaw(frozen.field("selection")?)?, holds })
}

impl Freeze for wire::Held {
    fn freeze(&self) -> Frozen {
        Frozen::List(self.0.iter().map(|held| Frozen::record(freeze_held(held))).collect())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        frozen.list()?.iter().map(thaw_held).collect::<Result<_, _>>().map(Self)
    }
}

impl Freeze for wire::Handles {
    fn freeze(&self) -> Frozen {
        let handle = |handle: &wire::Handle| {
            let [selection, holds] = freeze_held(&handle.held);
            let moved = &handle.transform;
            let stretch = moved.stretch();
            Frozen::record([
                selection,
                holds,
                ("pivot", points(&[moved.pivot()])),
                ("translation", points(&[moved.translation_vector()])),
                ("rotation", points(&[moved.rotation_vector()])),
                ("stretch", points(&[stretch.x_axis, stretch.y_axis, stretch.z_axis])),
            ])
        };
        Frozen::List(self.0.iter().map(handle).collect())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let vectors = |frozen: &Frozen, name: &str| thawed_points(frozen.field(name)?);
        let one = |frozen: &Frozen, name: &str| match vectors(frozen, name)?.as_slice() {
            [only] => Ok(*only),
            several => Err(no_value(format!("\"{name}\" has {} vectors in place of one", several.len()))),
        };
        let handle = |frozen: &Frozen| {
            let [x, y, z]: [DVec3; 3] =
                vectors(frozen, "stretch")?.try_into().map_err(|_| no_value("a stretch has three columns"))?;
            let (pivot, translation) = (one(frozen, "pivot")?, one(frozen, "translation")?);
            let stretch = DMat3::from_cols(x, y, z);
            let transform =
                HandleTransform::from_parts(pivot, translation, one(frozen, "rotation")?, stretch).map_err(no_value)?;
            Ok(wire::Handle { held: thaw_held(frozen)?, transform })
        };
        frozen.list()?.iter().map(handle).collect::<Result<_, ThawError>>().map(Self)
    }
}

impl Freeze for wire::Bound {
    /// What it was bound from: thawing binds again.
    fn freeze(&self) -> Frozen {
        Frozen::record([
            ("mesh", wire::Mesh(self.binding.mesh().clone()).freeze()),
            ("region", self.region.as_ref().map_or(Frozen::Nothing, Freeze::freeze)),
            ("held", self.held.freeze()),
            ("edges", Frozen::Boolean(self.reconstruction == Reconstruction::Edges)),
        ])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let mesh = wire::Mesh::thaw(frozen.field("mesh")?)?;
        let mesh_hash = Value::new(mesh.clone()).hash();
        let region = optional(frozen.field("region")?, wire::Selection::thaw)?;
        let held = wire::Held::thaw(frozen.field("held")?)?;
        let reconstruction = match frozen.field("edges")?.boolean()? {
            true => Reconstruction::Edges,
            false => Reconstruction::Coordinates,
        };
        Self::new(&mesh, mesh_hash, region, held, reconstruction, &|_| true).map_err(no_value)
    }
}
