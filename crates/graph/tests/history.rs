//! Steps: undone, redone, merged, jumped to, and whether the graph is saved.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::Rig;
use maquette_graph::{Edit, EditError, GraphError, History, Literal, NodeId, file};

struct Desk {
    rig: Rig,
    history: History,
    ids: Vec<NodeId>,
}

impl Desk {
    fn new() -> Self {
        let mut rig = Rig::default();
        let ids = rig.chain(2);
        Self { rig, history: History::new(), ids }
    }

    fn text(&self) -> String {
        file::to_text(&self.rig.graph)
    }

    fn set(&mut self, value: f64) -> Result<(), EditError> {
        let edit = Edit::set(self.ids[0], "a", Literal::Number(value));
        self.history.apply(&mut self.rig.graph, &self.rig.catalogue, &edit)
    }

    fn drag(&mut self, key: &str, value: f64) {
        self.history.begin_merging("drag a", key);
        self.set(value).unwrap();
        self.history.commit();
    }

    fn step(&mut self, name: &str, edits: &[Edit]) -> Result<(), EditError> {
        self.history.step(&mut self.rig.graph, &self.rig.catalogue, name, edits)
    }

    fn undo(&mut self) -> Option<String> {
        self.history.undo(&mut self.rig.graph, &self.rig.catalogue).unwrap().map(str::to_owned)
    }

    fn redo(&mut self) -> Option<String> {
        self.history.redo(&mut self.rig.graph, &self.rig.catalogue).unwrap().map(str::to_owned)
    }

    fn names(&self) -> Vec<&str> {
        self.history.names().collect()
    }

    fn value(&self) -> String {
        let line = self.text().lines().find(|line| line.contains("\"a\":")).unwrap().trim().to_owned();
        line.trim_start_matches("\"a\": ").trim_end_matches(',').to_owned()
    }
}

#[test]
fn steps_are_undone_and_redone() {
    let mut desk = Desk::new();
    let empty = desk.text();
    assert_eq!((desk.undo(), desk.redo()), (None, None));
    desk.history.begin("build");
    for edit in [Edit::add("add", "x"), Edit::add("add", "y"), Edit::RemoveNode(desk.ids[0])] {
        desk.history.apply(&mut desk.rig.graph, &desk.rig.catalogue, &edit).unwrap();
    }
    desk.history.commit();
    let built = desk.text();
    desk.step("note", &[Edit::GraphNotes("done".into())]).unwrap();
    let noted = desk.text();
    assert_eq!(desk.names(), ["build", "note"]);
    assert_eq!((desk.history.undo_name(), desk.history.redo_name()), (Some("note"), None));
    assert_eq!(desk.undo().as_deref(), Some("note"));
    assert_eq!(desk.text(), built);
    assert_eq!((desk.history.undo_name(), desk.history.redo_name()), (Some("build"), Some("note")));
    assert_eq!(desk.undo().as_deref(), Some("build"));
    assert_eq!(desk.text(), empty);
    assert_eq!(desk.undo(), None);
    assert_eq!(desk.redo().as_deref(), Some("build"));
    assert_eq!(desk.text(), built);
    assert_eq!(desk.redo().as_deref(), Some("note"));
    assert_eq!(desk.text(), noted);
    // What was undone is forgotten as soon as something else is done.
    desk.undo();
    desk.history.begin("nothing");
    desk.history.commit();
    assert_eq!(desk.names(), ["build", "note"], "a step without edits leaves no trace");
    desk.history.apply(&mut desk.rig.graph, &desk.rig.catalogue, &Edit::add("add", "z")).unwrap();
    assert_eq!(desk.names(), ["build", "add z"]);
    assert_eq!(desk.redo(), None);
}

#[test]
fn frames_of_a_drag_are_one_step() {
    let mut desk = Desk::new();
    desk.step("before", &[Edit::set(desk.ids[0], "a", Literal::Number(0.5))]).unwrap();
    for frame in 0..1000 {
        desk.drag("n0.a", f64::from(frame));
    }
    assert_eq!(desk.names(), ["before", "drag a"]);
    assert_eq!(desk.value(), "999.0");
    desk.undo();
    assert_eq!(desk.value(), "0.5");
    desk.redo();
    assert_eq!(desk.value(), "999.0");
    // Undo and redo end a gesture, as does another key, a step without one, saving, or saying so.
    desk.drag("n0.a", 1.0);
    desk.drag("other", 2.0);
    desk.drag("other", 3.0);
    desk.set(4.0).unwrap();
    desk.drag("other", 5.0);
    desk.history.mark_saved();
    desk.drag("other", 6.0);
    desk.history.end_gesture();
    desk.drag("other", 7.0);
    assert_eq!(desk.names(), ["before", "drag a", "drag a", "drag a", "set a", "drag a", "drag a", "drag a"]);
    for value in ["6.0", "5.0", "4.0", "3.0", "1.0", "999.0", "0.5"] {
        desk.undo();
        assert_eq!(desk.value(), value);
    }
}

#[test]
fn merged_steps_of_links_and_places_undo_in_order() {
    let mut desk = Desk::new();
    let before = desk.text();
    let (a, b) = (desk.ids[0], desk.ids[1]);
    let frames = [
        vec![Edit::Move { node: a, position: Some([1.0, 0.0]) }, Edit::Move { node: b, position: Some([2.0, 0.0]) }],
        vec![Edit::Move { node: a, position: Some([3.0, 0.0]) }, Edit::Move { node: b, position: Some([4.0, 0.0]) }],
        // Dragged onto a link: what was a place becomes more.
        vec![Edit::Disconnect { to: b, input: "a".into() }, Edit::set(b, "a", Literal::Number(1.0))],
        vec![Edit::set(b, "a", Literal::Number(2.0)), Edit::connect(a, "sum", b, "b")],
        vec![Edit::set(b, "b", Literal::Number(2.0)), Edit::connect(b, "sum", a, "a")],
    ];
    for frame in &frames {
        desk.history.begin_merging("drag", "drag");
        desk.history.apply_all(&mut desk.rig.graph, &desk.rig.catalogue, frame).unwrap();
        desk.history.commit();
    }
    let after = desk.text();
    assert_eq!(desk.names(), ["drag"]);
    desk.undo();
    assert_eq!(desk.text(), before);
    desk.redo();
    assert_eq!(desk.text(), after);
}

#[test]
fn a_failing_step_is_rolled_back() {
    let mut desk = Desk::new();
    let before = desk.text();
    let error = desk.step("half", &[Edit::add("add", "x"), Edit::add("add", "x")]).unwrap_err();
    assert_eq!(error, EditError::Graph(GraphError::DuplicateName("x".into())));
    assert_eq!((desk.text(), desk.names().len()), (before.clone(), 0));
    // An open step keeps what fitted, and can be cancelled.
    desk.history.begin("by hand");
    desk.set(3.0).unwrap();
    desk.set(f64::NAN).unwrap_err();
    assert_eq!(desk.value(), "3.0");
    assert_eq!(desk.history.undo_name(), Some("by hand"));
    assert!(desk.history.is_changed());
    desk.history.cancel(&mut desk.rig.graph, &desk.rig.catalogue).unwrap();
    assert_eq!((desk.text(), desk.names().len()), (before, 0));
    assert!(!desk.history.is_changed());
}

#[test]
fn an_undo_that_fails_halfway_changes_nothing() {
    let mut desk = Desk::new();
    let (a, b) = (desk.ids[0], desk.ids[1]);
    desk.step("two", &[Edit::Rename { node: a, name: "x".into() }, Edit::Note { node: b, note: "y".into() }]).unwrap();
    // Past the history, the old name is taken.
    desk.rig.add("add", "n0");
    let before = desk.text();
    let error = desk.history.undo(&mut desk.rig.graph, &desk.rig.catalogue).unwrap_err();
    assert_eq!(error.to_string(), "a node named \"n0\" is already there: choose another name");
    assert_eq!(desk.text(), before, "the note is as it was too");
    assert_eq!(desk.history.position(), 1);
    desk.history.jump(&mut desk.rig.graph, &desk.rig.catalogue, 0).unwrap_err();
    assert_eq!((desk.text(), desk.history.position()), (before, 1));
    desk.rig.graph.remove(desk.rig.id("n0")).unwrap();
    assert_eq!(desk.undo().as_deref(), Some("two"));
    desk.rig.graph.remove(b).unwrap();
    let before = desk.text();
    desk.history.redo(&mut desk.rig.graph, &desk.rig.catalogue).unwrap_err();
    assert_eq!((desk.text(), desk.history.position()), (before, 0));
}

#[test]
fn jumping_and_saving() {
    let mut desk = Desk::new();
    let mut texts = vec![desk.text()];
    assert!(!desk.history.is_changed());
    for value in 0..5 {
        desk.set(f64::from(value)).unwrap();
        texts.push(desk.text());
    }
    assert!(desk.history.is_changed());
    for position in [2, 5, 0, 3, 3, 99, 1] {
        desk.history.jump(&mut desk.rig.graph, &desk.rig.catalogue, position).unwrap();
        assert_eq!(desk.history.position(), position.min(5));
        assert_eq!(desk.text(), texts[position.min(5)]);
    }
    desk.history.jump(&mut desk.rig.graph, &desk.rig.catalogue, 3).unwrap();
    desk.history.mark_saved();
    assert!(!desk.history.is_changed());
    desk.undo();
    assert!(desk.history.is_changed());
    desk.redo();
    assert!(!desk.history.is_changed());
    desk.redo();
    assert!(desk.history.is_changed());
    // The saved state can't be reached any more.
    desk.history.jump(&mut desk.rig.graph, &desk.rig.catalogue, 1).unwrap();
    for value in 0..4 {
        desk.set(f64::from(10 + value)).unwrap();
        assert!(desk.history.is_changed());
    }
}

#[test]
fn old_steps_are_forgotten() {
    let mut desk = Desk::new();
    desk.history = History::with_limit(3);
    for value in 0..5 {
        desk.set(f64::from(value)).unwrap();
    }
    assert_eq!(desk.history.position(), 3);
    desk.history.jump(&mut desk.rig.graph, &desk.rig.catalogue, 0).unwrap();
    assert_eq!(desk.value(), "1.0");
    assert!(desk.history.is_changed(), "the saved state is forgotten");
    desk.history = History::with_limit(0);
    desk.set(9.0).unwrap();
    assert_eq!((desk.undo(), desk.value().as_str()), (None, "9.0"));
    assert!(desk.history.is_changed());
}

#[test]
fn undo_during_a_drag_ends_it() {
    let mut desk = Desk::new();
    desk.set(1.0).unwrap();
    desk.history.begin("drag");
    desk.set(2.0).unwrap();
    desk.history.begin("another");
    desk.set(3.0).unwrap();
    assert_eq!(desk.undo().as_deref(), Some("another"));
    assert_eq!(desk.undo().as_deref(), Some("drag"));
    assert_eq!(desk.value(), "1.0");
}

#[test]
fn an_undone_step_runs_nothing() {
    let mut desk = Desk::new();
    desk.rig.evaluate(&["n1"]);
    let (a, b) = (desk.ids[0], desk.ids[1]);
    desk.step("much", &[Edit::RemoveNode(a), Edit::set(b, "a", Literal::Number(7.0))]).unwrap();
    assert_eq!(desk.rig.ran(&["n1"]), ["n1"]);
    desk.undo();
    desk.rig.evaluate(&["n1"]);
    assert_eq!(desk.rig.log, ["hit n0", "hit n1", "planned 0"]);
    desk.redo();
    desk.rig.evaluate(&["n1"]);
    assert_eq!(desk.rig.log, ["hit n1", "planned 0"]);
}
