//! The strokes of up to three views, as every node that takes silhouettes declares them.

use maquette_geometry::deform::Silhouette;
use maquette_geometry::view::View;
use maquette_graph::{NodeError, NodeKind, OptionalInput, Ports};

use crate::view_plane::ViewPlane;
use crate::wire;

/// Handles of the strokes of each view.
#[derive(Clone, Copy)]
pub(crate) struct SilhouetteInputs {
    views: [(View, OptionalInput<wire::Curves>); 3],
}

impl SilhouetteInputs {
    /// Declares `front`, `side` and `top`, each optional.
    pub(crate) fn declare(node: &mut NodeKind, what: &str) -> Self {
        Self {
            views: ViewPlane::ALL.map(|plane| {
                let (view, name) = (plane.view(), plane.view().name());
                (view, node.optional(name, &format!("Strokes of the {name} view: {what} May be left unconnected.")))
            }),
        }
    }

    /// The connected ones.
    ///
    /// # Errors
    /// Nothing is connected.
    pub(crate) fn read<'a>(self, ports: &Ports<'a>) -> Result<Vec<Silhouette<'a>>, NodeError> {
        let connected = self.views.into_iter().filter_map(|(view, input)| {
            ports.read_optional(input).map(|curves| Silhouette { view, strokes: &curves.0 })
        });
        let silhouettes: Vec<_> = connected.collect();
        match silhouettes.is_empty() {
            true => Err(NodeError::new("no strokes are connected: link those of the front, the side or the top view")),
            false => Ok(silhouettes),
        }
    }

    /// The input of a view by its name; that of the first connected view where no view is at fault.
    pub(crate) fn port(self, view: Option<&str>, silhouettes: &[Silhouette<'_>]) -> OptionalInput<wire::Curves> {
        let first = silhouettes.first().map_or("front", |silhouette| silhouette.view.name());
        let wanted = view.unwrap_or(first);
        self.views.iter().find(|(own, _)| own.name() == wanted).unwrap_or(&self.views[0]).1
    }
}
