//! Whole strokes are moved, cut and joined with the pointer and by keys; reference pictures stand behind them.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use std::path::Path;

use egui::{Event, Key, Modifiers, Pos2, TouchDeviceId, TouchId, TouchPhase, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::command::{FileCommand, StrokeDeed, ViewCommand};
use maquette_editor::view_state::Tool;
use maquette_editor::{Direction, Options};
use maquette_graph::{Stroke, file};
use support::*;

/// A graph with one sketch in the front view: a bar along x at a height of 1 m, and one at 1.2 m.
const BARS: &str = r#"(
    version: 1,
    nodes: {
        "bars": (
            kind: "sketch",
            inputs: {
                "strokes": Strokes([
                    (name: "low", closed: false, points: [(-0.2, 1.0), (0.0, 1.0), (0.2, 1.0)]),
                    (name: "high", closed: false, points: [(-0.2, 1.2), (0.0, 1.2), (0.2, 1.2)]),
                ]),
            },
        ),
    },
)
"#;

fn bars() -> (tempfile::TempDir, Window) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bars.ron");
    std::fs::write(&path, BARS).unwrap();
    let mut window = opened(&path);
    window.state_mut().ask(ViewCommand::Find("bars".to_owned()));
    window.run_steps(3);
    (folder, window)
}

fn front(window: &Window, x: f64, y: f64) -> Pos2 {
    seen(window, Direction::Front, "Front view", [x, y, 0.0])
}

fn xy(stroke: &Stroke) -> Vec<[f64; 2]> {
    stroke.points.iter().map(|p| [p.x, p.y]).collect()
}

/// Whether points lie within a screen's grain, 4 mm, of where they should.
#[track_caller]
fn assert_near(stroke: &Stroke, wanted: &[[f64; 2]]) {
    let found = xy(stroke);
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(wanted) {
        let off = (found[0] - wanted[0]).hypot(found[1] - wanted[1]);
        assert!(off < 4e-3, "{found:?} for {wanted:?}");
    }
}

#[test]
fn a_stroke_is_moved_by_itself_and_all_by_their_box() {
    let (_folder, mut window) = bars();
    press(&mut window, Modifiers::NONE, Key::T);
    let before = text(&window);
    // On one it takes that one.
    let (from, to) = (front(&window, 0.1, 1.0), front(&window, 0.15, 0.9));
    drag(&mut window, &way(from, to, 6));
    let moved = strokes(&window, "bars");
    assert_near(&moved[0], &[[-0.15, 0.9], [0.05, 0.9], [0.25, 0.9]]);
    assert_eq!(xy(&moved[1])[0], [-0.2, 1.2]);
    assert_eq!(window.state().view().picked_strokes.iter().copied().collect::<Vec<_>>(), [0]);
    assert_eq!(window.state().document().history().position(), 1, "a drag is one step");
    undo(&mut window);
    assert_eq!(text(&window), before);
    // A click beside them picks none, which stands for all; a corner of the box scales towards the opposite one.
    let aside = front(&window, 0.05, 1.1);
    click_at(&mut window, aside);
    assert!(window.state().view().picked_strokes.is_empty());
    window.state_mut().ask(ViewCommand::Find("bars".to_owned()));
    window.run_steps(2);
    let (from, to) = (front(&window, 0.2, 1.2), front(&window, 0.4, 1.3));
    drag(&mut window, &way(from, to, 6));
    let scaled = strokes(&window, "bars");
    assert_near(&scaled[0], &[[-0.2, 1.0], [0.1, 1.0], [0.4, 1.0]]);
    assert_near(&scaled[1], &[[-0.2, 1.3], [0.1, 1.3], [0.4, 1.3]]);
    assert_eq!(window.state().document().history().undo_name(), Some("scale strokes"));
}

#[test]
fn the_handle_above_the_box_turns_and_shift_keeps_to_steps() {
    let (_folder, mut window) = bars();
    press(&mut window, Modifiers::NONE, Key::T);
    let middle = rect(&window, "Front view").center();
    window.hover_at(middle);
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, -200.0),
        modifiers: Modifiers::NONE,
        phase: TouchPhase::Move,
    });
    window.run_steps(30);
    let top = front(&window, 0.0, 1.2) - vec2(0.0, 24.0);
    let side = front(&window, 0.3, 1.1);
    drag_with(&mut window, egui::PointerButton::Primary, &way(top, side, 8), Modifiers::SHIFT);
    let turned = strokes(&window, "bars");
    // A quarter turn clockwise about the middle of the box.
    assert_near(&turned[0], &[[-0.1, 1.3], [-0.1, 1.1], [-0.1, 0.9]]);
    assert_eq!(window.state().document().history().undo_name(), Some("turn strokes"));
}

#[test]
fn arrow_keys_nudge_in_the_directions_of_the_view() {
    let (_folder, mut window) = bars();
    press(&mut window, Modifiers::NONE, Key::T);
    let middle = rect(&window, "Front view").center();
    window.hover_at(middle);
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::ArrowRight);
    press(&mut window, Modifiers::NONE, Key::ArrowRight);
    press(&mut window, Modifiers::SHIFT, Key::ArrowUp);
    let nudged = strokes(&window, "bars");
    assert_eq!(xy(&nudged[0]), [[-0.198, 1.01], [0.002, 1.01], [0.202, 1.01]]);
    assert_eq!(window.state().document().history().position(), 1, "nudging goes on in one step");
    // From above the second coordinate runs down the screen, and arrows follow the screen.
    window.state_mut().ask(ViewCommand::PickStrokes([1].into()));
    let view = rect(&window, "Perspective view").center();
    window.hover_at(view);
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::ArrowUp);
    assert!((strokes(&window, "bars")[1].points[0].y - 1.211).abs() < 2e-4, "up is up in the perspective too");
    assert_eq!(xy(&strokes(&window, "bars")[0])[0], [-0.198, 1.01], "only the picked one");
}

#[test]
fn strokes_are_cut_joined_and_deleted() {
    let (_folder, mut window) = bars();
    press(&mut window, Modifiers::NONE, Key::K);
    let (from, to) = (front(&window, 0.1, 1.1), front(&window, 0.1, 0.9));
    drag(&mut window, &way(from, to, 6));
    let cut = strokes(&window, "bars");
    assert_eq!(cut.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["low", "low 2", "high"]);
    assert_near(&cut[0], &[[-0.2, 1.0], [0.0, 1.0], [0.1, 1.0]]);
    assert_near(&cut[1], &[[0.1, 1.0], [0.2, 1.0]]);
    press(&mut window, Modifiers::NONE, Key::T);
    window.state_mut().ask(ViewCommand::PickStrokes([0, 1].into()));
    window.run_steps(2);
    click(&mut window, "Join");
    assert_near(&strokes(&window, "bars")[0], &[[-0.2, 1.0], [0.0, 1.0], [0.1, 1.0], [0.2, 1.0]]);
    // The picked one goes, its node stays.
    press(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(strokes(&window, "bars").iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["high"]);
    click(&mut window, "Mirror");
    assert_eq!(xy(&strokes(&window, "bars")[1])[0], [0.2, 1.2]);
    window.state_mut().ask(maquette_editor::command::GraphCommand::Strokes(StrokeDeed::Join));
    window.state_mut().ask(ViewCommand::PickStrokes([0].into()));
    window.run_steps(2);
    window.state_mut().ask(maquette_editor::command::GraphCommand::Strokes(StrokeDeed::Join));
    window.run_steps(2);
    assert!(message(&window).contains("pick two open strokes"), "{}", message(&window));
}

#[test]
fn an_end_is_caught_by_a_curve_that_crosses_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ring.ron");
    // A ring at a height of 1 m, drawn from above: it crosses the front plane at x = 0.3.
    let ring: Vec<String> = (0..32)
        .map(|k| (f64::from(k) * 11.25 + 5.0).to_radians().sin_cos())
        .map(|(s, c)| format!("({:.5}, {:.5})", 0.3 * c, 0.3 * s))
        .collect();
    let ring = ring.join(", ");
    let text = format!(
        "(version: 1, nodes: {{\"ring\": (kind: \"sketch\", inputs: {{\"plane\": Choice(\"top\"), \"offset\": 1.0, \
         \"strokes\": Strokes([(name: \"ring\", closed: true, points: [{ring}])])}})}})"
    );
    std::fs::write(&path, text).unwrap();
    let mut window = opened(&path);
    press(&mut window, Modifiers::NONE, Key::S);
    // It begins a few points of the screen beside the ring.
    let begin = front(&window, 0.3, 1.0) + vec2(4.0, -3.0);
    let end = front(&window, 0.15, 1.3);
    drag(&mut window, &way(begin, end, 20));
    settle(&mut window);
    let drawn = strokes(&window, "front sketch");
    let first = drawn[0].points[0];
    // The ring is a polygon of 32 corners, a millimetre within its circle.
    assert!((first.x - 0.3).abs() < 2e-3 && (first.y - 1.0).abs() < 1e-6, "{first:?}");
    // Without catching it is where the pen was.
    undo(&mut window);
    window.state_mut().settings_mut().snap = false;
    drag(&mut window, &way(begin, end, 20));
    let first = strokes(&window, "front sketch")[0].points[0];
    assert!((first.y - 1.0).abs() > 1e-3, "{first:?}");
}

#[test]
fn a_pen_that_presses_leaves_its_pressure_in_the_stroke() {
    let mut window = window(Options::default());
    press(&mut window, Modifiers::NONE, Key::S);
    let line = way(front(&window, -0.3, 0.8), front(&window, 0.3, 1.2), 30);
    let touch = |phase, pos: Pos2, force: f32| Event::Touch {
        device_id: TouchDeviceId(1),
        id: TouchId(1),
        phase,
        pos,
        force: Some(force),
    };
    let button = |pressed, pos| Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.event(Event::PointerMoved(line[0]));
    window.run_steps(2);
    window.event(touch(TouchPhase::Start, line[0], 0.2));
    window.event(button(true, line[0]));
    window.run_steps(1);
    for (k, place) in line.iter().enumerate().skip(1) {
        window.event(touch(TouchPhase::Move, *place, 0.2 + 0.02 * k as f32));
        window.event(Event::PointerMoved(*place));
        window.run_steps(1);
    }
    let last = line[line.len() - 1];
    window.event(touch(TouchPhase::End, last, 0.0));
    window.event(button(false, last));
    window.run_steps(3);
    let drawn = strokes(&window, "front sketch");
    let pressures: Vec<f64> = drawn[0].points.iter().map(|p| p.pressure.unwrap()).collect();
    assert!(pressures.windows(2).all(|pair| pair[0] <= pair[1]), "{pressures:?}");
    assert!(pressures[0] < 0.3 && pressures[pressures.len() - 1] > 0.7, "{pressures:?}");
}

#[test]
fn points_are_typed_in_the_inspector() {
    let (_folder, mut window) = bars();
    click(&mut window, "show the points of stroke 1");
    window.get_by_label("second coordinate of point 1 of stroke 1").click();
    window.run_steps(2);
    window.get_by_label("second coordinate of point 1 of stroke 1").type_text("1.25");
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.run_steps(3);
    assert_eq!(xy(&strokes(&window, "bars")[1]), [[-0.2, 1.2], [0.0, 1.25], [0.2, 1.2]]);
}

/// A picture of 40 by 20 pixels.
fn picture(folder: &Path, name: &str) {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixels = image::RgbaImage::from_pixel(40, 20, image::Rgba([200, 30, 30, 255]));
    pixels.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    std::fs::write(folder.join(name), bytes.into_inner()).unwrap();
}

fn read_pictures(window: &mut Window) {
    for _ in 0..500 {
        window.run_steps(2);
        if !window.state().reads_pictures() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the picture is never read");
}

#[test]
fn a_reference_picture_is_placed_moved_scaled_locked_and_saved() {
    let (folder, mut window) = bars();
    picture(folder.path(), "front.png");
    window.state_mut().ask(FileCommand::AddReference { view: Direction::Front, path: folder.path().join("front.png") });
    window.run_steps(2);
    read_pictures(&mut window);
    assert_eq!(window.state().view().tool, Tool::Picture);
    let reference = |window: &Window| window.state().document().graph().references()[0].clone();
    let placed = reference(&window);
    assert_eq!((placed.file.as_str(), placed.view.as_str()), ("front.png", "front"));
    let [x, y] = placed.centre;
    // Dragging moves it, in one step.
    let (from, to) = (front(&window, x, y), front(&window, x + 0.1, y - 0.05));
    drag(&mut window, &way(from, to, 6));
    let moved = reference(&window);
    assert!((moved.centre[0] - x - 0.1).abs() < 4e-3 && (moved.centre[1] - y + 0.05).abs() < 4e-3, "{moved:?}");
    assert_eq!(window.state().document().history().undo_name(), Some("move a picture"));
    // What is drawn along with Shift becomes the known length.
    window.state_mut().settings_mut().known_length = 0.5;
    let [x, y] = moved.centre;
    let (from, to) = (front(&window, x, y), front(&window, x + 0.1, y));
    drag_with(&mut window, egui::PointerButton::Primary, &way(from, to, 6), Modifiers::SHIFT);
    let scaled = reference(&window);
    assert!((scaled.width / moved.width - 5.0).abs() < 0.2, "{} of {}", scaled.width, moved.width);
    assert!((scaled.centre[0] - x).abs() < 4e-3, "it stays where one began");
    // Locked, it stays.
    window.state_mut().ask(ViewCommand::Select(Vec::new()));
    window.run_steps(2);
    click(&mut window, "lock picture 0");
    let from = front(&window, x, y);
    drag(&mut window, &way(from, from + vec2(40.0, 0.0), 4));
    assert_eq!(reference(&window).centre, scaled.centre);
    assert!(message(&window).contains("unlock it"), "{}", message(&window));
    window.state_mut().ask(FileCommand::Save);
    window.run_steps(3);
    let saved = std::fs::read_to_string(folder.path().join("bars.ron")).unwrap();
    assert!(saved.contains("file: \"front.png\"") && saved.contains("locked: true"), "{saved}");
    assert_eq!(saved, file::to_text(window.state().document().graph()));
    // All of it is undone.
    for _ in 0..4 {
        undo(&mut window);
    }
    assert!(window.state().document().graph().references().is_empty());
}

#[test]
fn a_picture_that_is_missing_says_so_and_nothing_else_is_hurt() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lost.ron");
    let text = "(version: 1, nodes: {}, references: [(view: \"side\", file: \"lost.png\", centre: (0, 1), width: 1)])";
    std::fs::write(&path, text).unwrap();
    let mut window = opened(&path);
    read_pictures(&mut window);
    window.run_steps(3);
    let shown = window.query_all_by_label_contains("there is no file").count();
    assert_eq!(shown, 1, "the inspector says why");
    // It comes back when the file does.
    picture(folder.path(), "lost.png");
    for _ in 0..200 {
        window.run_steps(2);
        if window.query_all_by_label_contains("there is no file").count() == 0 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(window.query_all_by_label_contains("there is no file").count(), 0);
}
