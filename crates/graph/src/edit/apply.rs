//! Where an edit changes a graph.

use crate::body::{Body, BodyError};
use crate::catalogue::Catalogue;
use crate::edit::{Edit, EditError, NodeRecord};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};
use crate::interface::{GraphOutput, OutputSource};

impl Graph {
    /// Applies an edit and gives the edit that undoes it: after both, the graph has the same text, the same identities
    /// and the same order, and evaluating it runs nothing.
    ///
    /// # Errors
    /// The edit does not fit; the graph is then as it was.
    pub fn apply(&mut self, catalogue: &Catalogue, edit: &Edit) -> Result<Edit, EditError> {
        Ok(match edit {
            Edit::AddNode(record) => Edit::RemoveNode(self.add_record(catalogue, record)?),
            Edit::RemoveNode(id) => Edit::AddNode(Box::new(NodeRecord::of_taken(*id, self.take(*id)?))),
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
            Edit::Mute { node, muted } => Edit::Mute { node: *node, muted: self.replace_muted(*node, *muted)? },
            Edit::UseParameter { node, input, parameter } => {
                let was = self.replace_by_parameter(catalogue, *node, input, parameter)?;
                Edit::restoring(*node, input, was)
            }
            Edit::AddParameter { index, parameter } => self.insert_parameter(*index, parameter)?,
            Edit::RemoveParameter(name) => self.take_parameter(catalogue, name)?,
            Edit::ChangeParameter { name, parameter } => self.change_parameter(catalogue, name, parameter)?,
            Edit::SetParameter { parameter, literal } => {
                let was = self.replace_parameter_value(parameter, literal.clone())?;
                Edit::SetParameter { parameter: parameter.clone(), literal: was }
            }
            Edit::AddOutput { index, output } => self.insert_output(*index, output)?,
            Edit::RemoveOutput(name) => self.take_output(name)?,
            Edit::ChangeOutput { name, output } => self.change_output(name, output)?,
            Edit::SetBody { node, body } => self.replace_body(catalogue, *node, body.clone())?,
            Edit::Within { node, edit } => self.apply_within(catalogue, *node, edit)?,
            Edit::Several(edits) => {
                let mut inverses = self.apply_all(catalogue, edits)?;
                inverses.reverse();
                Edit::Several(inverses)
            }
            Edit::Frames(frames) => Edit::Frames(self.replace_frames(frames)?),
            Edit::References(pictures) => Edit::References(self.replace_references(pictures)?),
            Edit::Collapse { node, collapsed } => {
                Edit::Collapse { node: *node, collapsed: self.replace_collapsed(*node, *collapsed)? }
            }
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

    fn replace_muted(&mut self, id: NodeId, muted: bool) -> Result<bool, GraphError> {
        let was = self.nodes.get_mut(&id).ok_or(GraphError::NoSuchNode)?.set_muted(muted);
        if was != muted {
            self.touch(id);
        }
        Ok(was)
    }

    fn add_record(&mut self, catalogue: &Catalogue, record: &NodeRecord) -> Result<NodeId, EditError> {
        let mut body = record.body.clone();
        let kind = if record.placeholder {
            None
        } else {
            let known = Self::known_kind(catalogue, &record.kind)?;
            if known.has_body() {
                body = body.or_else(|| Body::empty(&record.kind));
            }
            match &body {
                Some(_) if !known.has_body() => return Err(BodyError::NoBody(record.name.clone()).into()),
                Some(body) => Some(body.kind(catalogue, &record.kind)?),
                None => Some(known),
            }
        };
        let next = self.id_after(0);
        let id = record.id.unwrap_or(next);
        if id > next || self.node(id).is_some() {
            return Err(EditError::Outdated(record.name.clone()));
        }
        self.insert(id, &record.name, &record.kind, kind)?;
        if let Some(node) = self.nodes.get_mut(&id) {
            node.body = body;
            node.set_muted(record.muted);
            node.collapsed = record.collapsed;
        }
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
                Source::Parameter(name) => drop(self.replace_by_parameter(catalogue, id, input, name)?),
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
        for (name, output) in &record.promoted {
            let index = self.output_index(name)?;
            let from = OutputSource::Link(Link { node: id, output: output.clone() });
            let linked = GraphOutput { from, ..self.outputs[index].clone() };
            if self.outputs[index].from != OutputSource::Nothing {
                return Err(EditError::Outdated(record.name.clone()));
            }
            self.check_output(&linked, Some(name))?;
            self.outputs[index] = linked;
        }
        self.replace_position(id, record.position)?;
        self.replace_note(id, record.note.clone())?;
        if let Some(node) = self.nodes.get_mut(&id) {
            node.unknown_fields.clone_from(&record.unknown_fields);
        }
        Ok(())
    }
}
