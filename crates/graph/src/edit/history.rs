//! Steps that can be undone and redone.

use std::collections::VecDeque;

use crate::catalogue::Catalogue;
use crate::edit::{Edit, EditError, slot};
use crate::graph::Graph;

/// Edits that are undone at once.
#[derive(Clone, Debug)]
struct Step {
    name: String,
    merge_key: Option<String>,
    /// What takes the graph to the other side of the step, to be applied from the last to the first.
    edits: Vec<Edit>,
}

/// The steps that led to a graph, and those that were undone.
///
/// It belongs to one graph: what changes that graph past it can't be undone, and may make steps around it fail (with
/// the reason; a step is undone and redone as a whole or not at all). A step that was begun and not committed is
/// committed by whatever comes next: beginning another, undoing, redoing, jumping, or marking as saved.
#[derive(Clone, Debug)]
pub struct History {
    steps: VecDeque<Step>,
    /// How many of the steps are done; those behind can be redone.
    done: usize,
    open: Option<Step>,
    /// Number of done steps when the graph was saved; `None` where no number of steps leads there any more.
    saved: Option<usize>,
    /// Whether the last step is over, so that nothing is merged into it.
    sealed: bool,
    limit: usize,
}

impl Default for History {
    fn default() -> Self {
        Self::new()
    }
}

impl History {
    /// A history that keeps every step; the graph counts as saved.
    pub fn new() -> Self {
        Self::with_limit(usize::MAX)
    }

    /// A history that forgets the oldest steps beyond `limit`.
    pub fn with_limit(limit: usize) -> Self {
        Self { steps: VecDeque::new(), done: 0, open: None, saved: Some(0), sealed: true, limit }
    }

    /// Begins a step.
    pub fn begin(&mut self, name: impl Into<String>) {
        self.commit();
        self.open = Some(Step { name: name.into(), merge_key: None, edits: Vec::new() });
    }

    /// Begins a step that is merged into the one before where that has the same key and nothing came between: no undo,
    /// no redo, no saving, no [`History::end_gesture`]. For the frames of one drag.
    pub fn begin_merging(&mut self, name: impl Into<String>, key: impl Into<String>) {
        self.commit();
        self.open = Some(Step { name: name.into(), merge_key: Some(key.into()), edits: Vec::new() });
    }

    /// Ends a gesture: the next step is not merged into the last one.
    pub fn end_gesture(&mut self) {
        self.commit();
        self.sealed = true;
    }

    /// Applies an edit as a part of the step that was begun, or as a step of its own named by [`Edit::label`].
    ///
    /// # Errors
    /// The edit does not fit. The graph is as it was before it; a step that was begun stays open with the edits before.
    pub fn apply(&mut self, graph: &mut Graph, catalogue: &Catalogue, edit: &Edit) -> Result<(), EditError> {
        self.apply_all(graph, catalogue, std::slice::from_ref(edit))
    }

    /// As [`History::apply`] for several edits, all or none.
    ///
    /// # Errors
    /// The first edit that does not fit; those before it are undone.
    pub fn apply_all(&mut self, graph: &mut Graph, catalogue: &Catalogue, edits: &[Edit]) -> Result<(), EditError> {
        let inverses = graph.apply_all(catalogue, edits)?;
        match &mut self.open {
            Some(open) => open.edits.extend(inverses),
            None => {
                let name = edits.first().map(Edit::label).unwrap_or_default();
                self.push(Step { name, merge_key: None, edits: inverses });
            }
        }
        Ok(())
    }

    /// Applies edits as one step, all or none.
    ///
    /// # Errors
    /// The first edit that does not fit; graph and history are then as they were.
    pub fn step(
        &mut self,
        graph: &mut Graph,
        catalogue: &Catalogue,
        name: impl Into<String>,
        edits: &[Edit],
    ) -> Result<(), EditError> {
        self.commit();
        let inverses = graph.apply_all(catalogue, edits)?;
        self.push(Step { name: name.into(), merge_key: None, edits: inverses });
        Ok(())
    }

    /// Ends the step that was begun. One without edits leaves no trace; any other forgets what could be redone.
    pub fn commit(&mut self) {
        if let Some(step) = self.open.take() {
            self.push(step);
        }
    }

    /// Undoes the edits of the step that was begun and drops it.
    ///
    /// # Errors
    /// The graph was changed past the history, so that an edit does not fit; nothing is undone, the step stays open.
    pub fn cancel(&mut self, graph: &mut Graph, catalogue: &Catalogue) -> Result<(), EditError> {
        if let Some(open) = &self.open {
            graph.apply_all(catalogue, open.edits.iter().rev())?;
        }
        self.open = None;
        Ok(())
    }

    fn push(&mut self, step: Step) {
        if step.edits.is_empty() {
            return;
        }
        let was_undone = self.done < self.steps.len();
        if was_undone {
            self.steps.truncate(self.done);
            self.saved = self.saved.filter(|saved| *saved <= self.done);
        }
        let mergeable = !self.sealed && !was_undone && self.saved != Some(self.done) && step.merge_key.is_some();
        self.sealed = false;
        match self.steps.back_mut().filter(|last| mergeable && last.merge_key == step.merge_key) {
            Some(last) => slot::append(&mut last.edits, step.edits),
            None => {
                self.steps.push_back(step);
                self.done += 1;
            }
        }
        while self.steps.len() > self.limit {
            self.steps.pop_front();
            self.done -= 1;
            self.saved = self.saved.and_then(|saved| saved.checked_sub(1));
        }
    }

    /// Undoes the last step, and says its name; `None` where nothing is left to undo.
    ///
    /// # Errors
    /// The graph was changed past the history, so that an edit does not fit; nothing is undone.
    pub fn undo(&mut self, graph: &mut Graph, catalogue: &Catalogue) -> Result<Option<&str>, EditError> {
        self.end_gesture();
        let Some(index) = self.done.checked_sub(1) else { return Ok(None) };
        self.cross(index, graph, catalogue)?;
        self.done = index;
        Ok(self.steps.get(index).map(|step| step.name.as_str()))
    }

    /// Redoes the step that was undone last, and says its name; `None` where there is none.
    ///
    /// # Errors
    /// The graph was changed past the history, so that an edit does not fit; nothing is redone.
    pub fn redo(&mut self, graph: &mut Graph, catalogue: &Catalogue) -> Result<Option<&str>, EditError> {
        self.end_gesture();
        let index = self.done;
        if index == self.steps.len() {
            return Ok(None);
        }
        self.cross(index, graph, catalogue)?;
        self.done = index + 1;
        Ok(self.steps.get(index).map(|step| step.name.as_str()))
    }

    /// Takes the graph to the other side of a step. The inverses of what is applied lead back.
    fn cross(&mut self, index: usize, graph: &mut Graph, catalogue: &Catalogue) -> Result<(), EditError> {
        if let Some(step) = self.steps.get_mut(index) {
            step.edits = graph.apply_all(catalogue, step.edits.iter().rev())?;
        }
        Ok(())
    }

    /// Undoes or redoes until `position` steps are done; a position beyond the end means the end.
    ///
    /// # Errors
    /// As [`History::undo`]; the steps on the way to the one that fails stay undone or redone.
    pub fn jump(&mut self, graph: &mut Graph, catalogue: &Catalogue, position: usize) -> Result<(), EditError> {
        self.end_gesture();
        let position = position.min(self.steps.len());
        while self.done > position {
            self.undo(graph, catalogue)?;
        }
        while self.done < position {
            self.redo(graph, catalogue)?;
        }
        Ok(())
    }

    /// Names of all steps from the oldest on, without one that is not committed; the first [`History::position`] of
    /// them are done.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.steps.iter().map(|step| step.name.as_str())
    }

    /// How many of the steps are done.
    pub fn position(&self) -> usize {
        self.done
    }

    /// The step that [`History::undo`] would undo.
    pub fn undo_name(&self) -> Option<&str> {
        let open = self.open.as_ref().filter(|step| !step.edits.is_empty());
        let last = || self.done.checked_sub(1).and_then(|index| self.steps.get(index));
        open.or_else(last).map(|step| step.name.as_str())
    }

    /// The step that [`History::redo`] would redo.
    pub fn redo_name(&self) -> Option<&str> {
        let is_open = self.open.as_ref().is_some_and(|step| !step.edits.is_empty());
        self.steps.get(self.done).filter(|_| !is_open).map(|step| step.name.as_str())
    }

    /// Marks the present state as the saved one.
    pub fn mark_saved(&mut self) {
        self.end_gesture();
        self.saved = Some(self.done);
    }

    /// Whether the graph differs from the saved one, as far as steps tell.
    pub fn is_changed(&self) -> bool {
        self.saved != Some(self.done) || self.open.as_ref().is_some_and(|step| !step.edits.is_empty())
    }
}
