//! Files: saving, questions about unsaved work, recovery, and what the inspector writes.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::Options;
use maquette_editor::command::{FileCommand, GraphCommand, ViewCommand};
use maquette_graph::{Edit, Literal};
use support::*;

/// A copy of the vest in a folder of its own.
fn copy() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("vest.ron");
    std::fs::copy(graph("vest.ron"), &path).unwrap();
    (folder, path)
}

fn set(window: &mut Window, node: &str, input: &str, value: Literal) {
    let edit = Edit::set(find(window, node), input, value);
    window.state_mut().ask(GraphCommand::edit(edit));
    window.run_steps(2);
    settle(window);
}

fn select(window: &mut Window, node: &str) {
    window.state_mut().ask(ViewCommand::Find(node.to_owned()));
    window.run_steps(2);
    settle(window);
}

#[test]
fn dragging_a_slider_is_one_step_and_resetting_it_another() {
    let mut window = opened(&graph("vest.ron"));
    select(&mut window, "side rail");
    let was = literal(&window, "side rail", "offset");
    let before = hash(&window, "vest");
    let slider = rect(&window, "offset slider");
    let begin = slider.center();
    drag(&mut window, &way(begin, begin + vec2(25.0, 0.0), 6));
    settle(&mut window);
    assert_ne!(literal(&window, "side rail", "offset"), was);
    assert_ne!(hash(&window, "vest"), before);
    assert_eq!(window.state().document().history().position(), 1);
    click(&mut window, "reset offset");
    settle(&mut window);
    assert_eq!(literal(&window, "side rail", "offset"), None, "it is at its default");
    undo(&mut window);
    undo(&mut window);
    assert_eq!((literal(&window, "side rail", "offset"), hash(&window, "vest")), (was, before));
}

#[test]
fn what_costs_much_is_measured_of_the_node_whose_data_is_looked_at() {
    let mut window = opened(&graph("vest.ron"));
    select(&mut window, "vest");
    let faults = |window: &Window| window.query_all_by_label_contains("faults 0.0").count();
    assert_eq!(faults(&window), 0);
    click(&mut window, "Data");
    settle(&mut window);
    assert_eq!(faults(&window), 1);
    select(&mut window, "side rail");
    assert_eq!(faults(&window), 0);
}

#[test]
fn saving_and_opening_again_gives_the_same_text() {
    let (_folder, path) = copy();
    let mut window = opened(&path);
    set(&mut window, "side rail", "offset", Literal::Number(0.02));
    assert!(window.state().document().is_changed());
    press(&mut window, Modifiers::COMMAND, Key::S);
    assert!(!window.state().document().is_changed(), "{}", message(&window));
    let saved = std::fs::read_to_string(&path).unwrap();
    assert_eq!(saved, text(&window));
    assert_eq!(text(&opened(&path)), saved);
    undo(&mut window);
    assert!(window.state().document().is_changed(), "undone past the saved state");
}

#[test]
fn unsaved_work_is_asked_for_and_kept_until_it_is_answered() {
    let (folder, path) = copy();
    let mut window = opened(&path);
    let opened_text = text(&window);
    set(&mut window, "side rail", "offset", Literal::Number(0.02));
    press(&mut window, Modifiers::COMMAND, Key::N);
    window.get_by_label("Save vest.ron first?");
    click(&mut window, "Cancel");
    assert!(window.state().document().is_changed());
    press(&mut window, Modifiers::COMMAND, Key::N);
    click(&mut window, "Save");
    window.run_steps(3);
    assert!(names(&window).is_empty(), "{}", message(&window));
    assert!(std::fs::read_to_string(&path).unwrap().contains("\"offset\": 0.02"));
    // A graph without a file is saved where one says.
    let canvas = canvas(&window);
    add(&mut window, "sketch", canvas.center());
    press(&mut window, Modifiers::COMMAND, Key::S);
    let other = folder.path().join("other.ron");
    press(&mut window, Modifiers::COMMAND, Key::A);
    window.get_by_label("path").type_text(&other.display().to_string());
    window.run_steps(2);
    click(&mut window, "Save");
    window.run_steps(2);
    assert!(std::fs::read_to_string(&other).unwrap().contains("kind: \"sketch\""), "{}", message(&window));
    assert_eq!(window.state().document().path(), Some(other.as_path()));
    // And given up where one says so.
    let place = canvas.center() + vec2(40.0, 80.0);
    add(&mut window, "resample", place);
    window.state_mut().ask(FileCommand::Open(graph("vest.ron")));
    window.run_steps(3);
    click(&mut window, "Don't save");
    settle(&mut window);
    assert_eq!(text(&window), opened_text);
}

#[test]
fn a_file_that_another_program_wrote_is_read_again_when_one_says_so() {
    let (_folder, path) = copy();
    let mut window = opened(&path);
    let changed = text(&window).replace("value: 1.4,", "value: 2.5,");
    std::thread::sleep(Duration::from_millis(20));
    std::fs::write(&path, &changed).unwrap();
    window.run_steps(150);
    window.get_by_label("vest.ron changed on disk");
    click(&mut window, "Read it again");
    settle(&mut window);
    assert_eq!(text(&window), changed);
}

#[test]
fn what_can_not_be_opened_says_why_and_leaves_the_window_usable() {
    let folder = tempfile::tempdir().unwrap();
    let window = opened(&folder.path().join("nothing.ron"));
    assert!(message(&window).contains("there is no such file; check the path"), "{}", message(&window));
    let broken = folder.path().join("broken.ron");
    std::fs::write(&broken, "(version: 1, nodes: {").unwrap();
    let mut window = opened(&broken);
    assert!(message(&window).contains("broken.ron:1:"), "{}", message(&window));
    let canvas = canvas(&window);
    add(&mut window, "sketch", canvas.center());
    assert_eq!(names(&window), ["sketch"]);
}

/// Says to the process that is killed where to put its work aside.
const FOLDER: &str = "MAQUETTE_TEST_RECOVERY_FOLDER";
const GRAPH: &str = "MAQUETTE_TEST_RECOVERY_GRAPH";

/// Not a test of its own: the process that [`work_is_recovered_after_a_kill`] starts and kills.
#[test]
fn works_until_it_is_killed() {
    let (Some(folder), Some(path)) = (std::env::var_os(FOLDER), std::env::var_os(GRAPH)) else { return };
    let options = Options { path: Some(path.into()), recovery: Some(folder.into()), ..Options::default() };
    let mut window = window(options);
    set(&mut window, "side rail", "offset", Literal::Number(0.0375));
    // It is put aside by itself, as in a window that stays open.
    loop {
        window.run_steps(1);
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn put_aside(folder: &Path) -> bool {
    std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .any(|entry| entry.path().extension().is_some_and(|extension| extension == "aside"))
}

#[test]
fn work_is_recovered_after_a_kill() {
    let (_graph, path) = copy();
    let folder = tempfile::tempdir().unwrap();
    let mut worker = Command::new(std::env::current_exe().unwrap());
    worker.args(["--exact", "works_until_it_is_killed"]).env(FOLDER, folder.path()).env(GRAPH, &path);
    let mut worker = worker.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !put_aside(folder.path()) {
        assert!(begun.elapsed() < Duration::from_secs(60), "nothing was put aside");
        std::thread::sleep(Duration::from_millis(50));
    }
    let options = || Options { recovery: Some(folder.path().to_owned()), ..Options::default() };
    let beside = window(options());
    assert!(beside.query_by_label("Recover vest.ron").is_none(), "it is still alive");
    drop(beside);
    worker.kill().unwrap();
    worker.wait().unwrap();
    let mut window = window(options());
    click(&mut window, "Recover vest.ron");
    settle(&mut window);
    assert_eq!(literal(&window, "side rail", "offset"), Some(Literal::Number(0.0375)));
    assert!(window.state().document().is_changed(), "it is not saved yet");
    assert_eq!(window.state().document().path(), Some(path.as_path()));
    assert!(window.query_by_label("Recover vest.ron").is_none());
    press(&mut window, Modifiers::COMMAND, Key::S);
    assert!(std::fs::read_to_string(&path).unwrap().contains("0.0375"));
    assert!(!put_aside(folder.path()), "what is saved need not be put aside");
}

#[test]
fn results_are_exported_in_the_formats_of_the_command() {
    let (folder, path) = copy();
    let mut window = opened(&path);
    for name in ["vest.glb", "vest.obj"] {
        let file = folder.path().join(name);
        window.state_mut().ask(FileCommand::ExportTo(file.clone()));
        window.run_steps(2);
        assert!(std::fs::metadata(&file).unwrap().len() > 10_000, "{}", message(&window));
    }
    assert!(folder.path().join("vest.mtl").is_file());
    window.state_mut().ask(FileCommand::ExportTo(folder.path().join("vest.svg")));
    window.run_steps(2);
    assert!(message(&window).contains("SVG is read, not written"), "{}", message(&window));
    let rail = find(&window, "side rail");
    window.state_mut().ask(ViewCommand::Display(rail));
    window.run_steps(2);
    settle(&mut window);
    window.state_mut().ask(FileCommand::ExportTo(folder.path().join("nothing.glb")));
    window.run_steps(2);
    assert!(message(&window).contains("the result \"vest\" is not there"), "{}", message(&window));
}

#[test]
fn an_idle_window_is_not_drawn_again() {
    let mut window = opened(&graph("vest.ron"));
    window.run_steps(30);
    let output = &window.output().viewport_output[&egui::ViewportId::ROOT];
    assert!(output.repaint_delay > Duration::from_secs(3600), "again in {:?}", output.repaint_delay);
}

#[test]
fn closing_the_window_asks_for_unsaved_work() {
    let (_folder, path) = copy();
    let mut window = opened(&path);
    let close = |window: &mut Window| {
        let viewport = window.input_mut().viewports.entry(egui::ViewportId::ROOT).or_default();
        viewport.events.push(egui::ViewportEvent::Close);
        window.step();
        let commands = &window.output().viewport_output[&egui::ViewportId::ROOT].commands;
        commands.contains(&egui::ViewportCommand::CancelClose)
    };
    assert!(!close(&mut window), "nothing is unsaved");
    let mut window = opened(&path);
    set(&mut window, "side rail", "offset", Literal::Number(0.02));
    assert!(close(&mut window), "it stays open");
    window.run_steps(2);
    window.get_by_label("Save vest.ron first?");
    click(&mut window, "Cancel");
    assert!(window.state().document().is_changed());
}
