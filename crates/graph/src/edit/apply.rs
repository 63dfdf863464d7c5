//! Where an edit changes a graph.

use crate::catalogue::Catalogue;
use crate::edit::{Edit, EditError, NodeRecord};
use crate::graph::{Graph, GraphError, NodeId, Source};

impl Graph {
    /// Applies an edit and gives the edit that undoes it: after both, the graph has the same text, the same identities
    /// and the same order, and evaluating it runs nothing.
    ///
    /// # Errors
    /// The edit does not fit; the graph is then as it was.
    pub fn apply(&mut self, catalogue: &Catalogue, edit: &Edit) -> Result<Edit, EditError> {
        Ok(match edit {
            Edit::AddNode(record) => Edit::RemoveNode(self.add_record(catalogue, record)?),
            Edit::RemoveNode(id) => {
                let (node, outgoing) = self.take(*id)?;
                Edit::AddNode(Box::new(NodeRecord::of_taken(*id, node, outgoing)))
            }
            Edit::Connect { from, output, to, input } => {
                let was = self.replace_by_link(catalogue, *from, output, *to, input)?;
                Edit::restoring(*to, input, was)
            }
            Edit::Disconnect { to, input } => {
                let node = self.node(*to).ok_or(GraphError::NoSuchNode)?;
                if !matches!(node.source(input), Some(Source::Link(_))) {
                    return Err(EditError::NotLinked { node: node.name().to_owned(), input: input.clone() });
                }
                let was = self.replace_by_default(*to, input)?;
                Edit::restoring(*to, input, was)
            }
            Edit::Set { node, input, literal } => {
                let was = self.replace_by_literal(*node, input, literal.clone())?;
                Edit::restoring(*node, input, was)
            }
            Edit::Reset { node, input } => {
                let was = self.replace_by_default(*node, input)?;
                Edit::restoring(*node, input, was)
            }
            Edit::PutBack { node, input, text } => {
                if self.node(*node).is_none() {
                    return Err(GraphError::NoSuchNode.into());
                }
                let was = self.put(*node, input, Some(Source::Unread(text.0.clone())));
                Edit::restoring(*node, input, was)
            }
            Edit::Rename { node, name } => Edit::Rename { node: *node, name: self.replace_name(*node, name)? },
            Edit::Move { node, position } => {
                Edit::Move { node: *node, position: self.replace_position(*node, *position)? }
            }
            Edit::Note { node, note } => Edit::Note { node: *node, note: self.replace_note(*node, note.clone())? },
            Edit::GraphNotes(notes) => Edit::GraphNotes(std::mem::replace(&mut self.notes, notes.clone())),
        })
    }

    /// Applies edits in their order, all or none. Gives their inverses in the same order: to undo, apply them from the
    /// last to the first.
    ///
    /// # Errors
    /// The first edit that does not fit; those before it are undone.
    pub fn apply_all<'a>(
        &mut self,
        catalogue: &Catalogue,
        edits: impl IntoIterator<Item = &'a Edit>,
    ) -> Result<Vec<Edit>, EditError> {
        let mut inverses = Vec::new();
        for edit in edits {
            match self.apply(catalogue, edit) {
                Ok(inverse) => inverses.push(inverse),
                Err(error) => {
                    self.take_back(catalogue, &inverses);
                    return Err(error);
                }
            }
        }
        Ok(inverses)
    }

    /// Applies inverses from the last to the first, right after the edits that they undo: there they always fit.
    pub(super) fn take_back(&mut self, catalogue: &Catalogue, inverses: &[Edit]) {
        for inverse in inverses.iter().rev() {
            let undone = self.apply(catalogue, inverse);
            debug_assert!(undone.is_ok(), "{inverse:?} does not undo: {undone:?}");
        }
    }

    fn add_record(&mut self, catalogue: &Catalogue, record: &NodeRecord) -> Result<NodeId, EditError> {
        let kind = if record.placeholder { None } else { Some(Self::known_kind(catalogue, &record.kind)?) };
        let next = self.id_after(0);
        let id = record.id.unwrap_or(next);
        if id > next || self.node(id).is_some() {
            return Err(EditError::Outdated(record.name.clone()));
        }
        self.insert(id, &record.name, &record.kind, kind)?;
        if let Err(error) = self.fill(catalogue, id, record) {
            // What it was linked to held nothing before, so that taking it out leaves the graph as it was.
            drop(self.take(id));
            self.give_back_ids(next);
            return Err(error);
        }
        Ok(id)
    }

    fn fill(&mut self, catalogue: &Catalogue, id: NodeId, record: &NodeRecord) -> Result<(), EditError> {
        for (input, source) in &record.inputs {
            match source {
                Source::Literal { literal, .. } => drop(self.replace_by_literal(id, input, literal.clone())?),
                Source::Link(link) => drop(self.replace_by_link(catalogue, link.node, &link.output, id, input)?),
                Source::Unread(_) => drop(self.put(id, input, Some(source.clone()))),
            }
        }
        for link in &record.outgoing {
            let dependent = self.node(link.to).ok_or(GraphError::NoSuchNode)?;
            if dependent.source(&link.input).is_some() {
                return Err(EditError::InputTaken {
                    from: record.name.clone(),
                    to: dependent.name().to_owned(),
                    input: link.input.clone(),
                });
            }
            self.replace_by_link(catalogue, id, &link.output, link.to, &link.input)?;
        }
        self.replace_position(id, record.position)?;
        self.replace_note(id, record.note.clone())?;
        if let Some(node) = self.nodes.get_mut(&id) {
            node.unknown_fields.clone_from(&record.unknown_fields);
        }
        Ok(())
    }
}
