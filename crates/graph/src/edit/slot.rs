//! What an edit overwrites, so that a later one of the same gesture can take its place.

use std::collections::BTreeSet;

use crate::edit::Edit;
use crate::graph::NodeId;

/// A place of a graph that is written as a whole, without regard to any other place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Slot {
    Input(NodeId, String),
    Position(NodeId),
    Note(NodeId),
    GraphNotes,
    Frames,
    References,
    Collapsed(NodeId),
    Muted(NodeId),
    Parameter(String),
    Within(NodeId, Box<Slot>),
}

/// The place that an edit writes. None for links and names, which depend on others, and for whole nodes.
fn slot(edit: &Edit) -> Option<Slot> {
    match edit {
        Edit::Set { node, input, .. } | Edit::Reset { node, input } => Some(Slot::Input(*node, input.clone())),
        Edit::Move { node, .. } => Some(Slot::Position(*node)),
        Edit::Note { node, .. } => Some(Slot::Note(*node)),
        Edit::GraphNotes(_) => Some(Slot::GraphNotes),
        Edit::Frames(_) => Some(Slot::Frames),
        Edit::References(_) => Some(Slot::References),
        Edit::Collapse { node, .. } => Some(Slot::Collapsed(*node)),
        Edit::Mute { node, .. } => Some(Slot::Muted(*node)),
        Edit::SetParameter { parameter, .. } => Some(Slot::Parameter(parameter.clone())),
        Edit::Within { node, edit } => Some(Slot::Within(*node, Box::new(slot(edit)?))),
        _ => None,
    }
}

/// Appends inverses to those of earlier edits. Where all write places of their own, the earliest of each place is
/// enough: a slider dragged over a thousand values undoes with one edit.
pub(super) fn append(inverses: &mut Vec<Edit>, later: Vec<Edit>) {
    let written: Option<BTreeSet<Slot>> = inverses.iter().map(slot).collect();
    let Some(mut written) = written.filter(|_| later.iter().all(|edit| slot(edit).is_some())) else {
        inverses.extend(later);
        return;
    };
    // The earliest of a place is the one that is applied last when they are undone.
    inverses.extend(later.into_iter().filter(|edit| slot(edit).is_some_and(|slot| written.insert(slot))));
}
