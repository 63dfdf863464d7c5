//! What an artist may meet: graphs that are broken, models that are huge, screens that are fine. It opens, says so, and works.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, wgpu::WgpuTestRenderer};
use maquette_editor::command::ViewCommand;
use maquette_editor::{App, Direction, Options};
use support::*;

fn written(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("graph.ron");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn a_cycle_in_a_file_is_told_and_the_rest_works() {
    let (_folder, path) = written(
        r#"(version: 1, nodes: {
            "a": (kind: "resample", inputs: {"curves": Link("b.curves")}),
            "b": (kind: "resample", inputs: {"curves": Link("a.curves")}),
            "line": (kind: "sketch", inputs: {"strokes": Strokes([(name: "l", closed: false, points: [(0, 1), (0.2, 1.2)])])}),
        })"#,
    );
    let mut window = opened(&path);
    assert_eq!(names(&window), ["a", "b", "line"]);
    window.get_by_label_contains("cycle");
    window.state_mut().ask(ViewCommand::Find("line".to_owned()));
    settle(&mut window);
    assert!(hash(&window, "line").is_some());
}

#[test]
fn a_mesh_of_a_million_faces_opens_and_is_looked_at() {
    let (_folder, path) = written(
        r#"(version: 1, nodes: {
            "ball": (kind: "primitive-shape", inputs: {"shape": Choice("sphere"), "sections": 1001, "nodes": 1000}),
            "mesh": (kind: "surface-from-cross-sections", inputs: {"sections": Link("ball.sections")}),
            "out": (kind: "mesh-out", inputs: {"mesh": Link("mesh.mesh")}),
        })"#,
    );
    let mut window = opened(&path);
    assert_eq!(failure(&window, "out"), None);
    window.state_mut().ask(ViewCommand::Find("out".to_owned()));
    settle(&mut window);
    window.run_steps(3);
    // A click on it finds it.
    let place = seen(&window, Direction::Front, "Front view", [0.03, 0.02, 0.09]);
    click_at(&mut window, place);
    assert_eq!(window.state().view().active, Some(find(&window, "out")));
}

#[test]
fn a_fine_screen_and_one_without_smooth_edges_both_show_the_model() {
    let options = Options { path: Some(graph("vest.ron")), ..Options::default() };
    let mut window = Harness::builder()
        .with_size(vec2(1000.0, 700.0))
        .with_pixels_per_point(2.0)
        .with_step_dt(1.0 / 60.0)
        .renderer(WgpuTestRenderer::new())
        .build_eframe(move |context| App::new(context, options).unwrap());
    settle(&mut window);
    let belly = seen(&window, Direction::Front, "Front view", [0.09, 1.0, 0.1]);
    for smooth in [true, false] {
        window.state_mut().settings_mut().smooth_edges = smooth;
        window.run_steps(3);
        let picture = window.render().unwrap();
        assert_eq!((picture.width(), picture.height()), (2000, 1400));
        let [r, _, b, _] = picture.get_pixel((belly.x * 2.0) as u32, (belly.y * 2.0) as u32).0;
        assert!(b > r.saturating_add(15), "the vest is blue, smooth or not: {r} {b}");
    }
}

#[test]
fn the_perspective_can_do_without() {
    let mut window = opened(&graph("vest.ron"));
    let near = |window: &Window| {
        let at = |point| seen(window, Direction::Free, "Perspective view", point);
        // The same height, near the eye and far from it.
        (at([0.3, 1.2, 0.4]) - at([0.3, 1.0, 0.4])).length() / (at([-0.3, 1.2, -0.4]) - at([-0.3, 1.0, -0.4])).length()
    };
    assert!(near(&window) > 1.1);
    press(&mut window, Modifiers::NONE, Key::Num5);
    assert!((near(&window) - 1.0).abs() < 1e-3);
}
