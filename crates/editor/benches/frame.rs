//! What a frame of the window costs without drawing it, and how long a surface takes to follow a dragged rail.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs, reason = "a benchmark that panics fails")]

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use eframe::App as _;
use egui::{Event, Modifiers, MouseWheelUnit, vec2};
use maquette_editor::command::{GraphCommand, ViewCommand};
use maquette_editor::{App, Options};
use maquette_graph::{Edit, Graph, Literal, Source, file};

/// The application without a window, and without what reads it to those who do not see it.
struct Window {
    context: egui::Context,
    frame: eframe::Frame,
    app: App,
    time: f64,
}

impl Window {
    fn step(&mut self, events: Vec<Event>) {
        self.time += 1.0 / 60.0;
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, vec2(1440.0, 900.0))),
            time: Some(self.time),
            events,
            ..egui::RawInput::default()
        };
        let mut output = self.context.run_ui(input, |ui| self.app.ui(ui, &mut self.frame));
        output.textures_delta.clear();
        black_box(self.context.tessellate(output.shapes, output.pixels_per_point));
    }
}

fn window(path: &Path) -> Window {
    let options = Options { path: Some(path.to_owned()), ..Options::default() };
    let context = egui::Context::default();
    let app = App::new(&eframe::CreationContext::_new_kittest(context.clone()), options).unwrap();
    let mut window = Window { context, frame: eframe::Frame::_new_kittest(), app, time: 0.0 };
    for _ in 0..5 {
        follow(&mut window);
    }
    window
}

/// Frames until what is shown is that of the graph as it is; how many.
fn follow(window: &mut Window) -> usize {
    for frames in 1.. {
        window.step(Vec::new());
        if window.app.results().is_current() {
            return frames;
        }
        std::thread::yield_now();
    }
    0
}

fn vest() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs/vest.ron")
}

fn idle(c: &mut Criterion) {
    let mut window = window(&vest());
    c.bench_function("a frame with the vest", |b| b.iter(|| window.step(Vec::new())));
}

fn large(c: &mut Criterion) {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let mut graph = Graph::new();
    for index in 0..500_usize {
        let id = graph.add(&catalogue, "resample", &format!("node {index}")).unwrap();
        let place = [(index % 25) as f64 * 240.0, (index / 25) as f64 * 130.0];
        graph.set_position(id, Some(place)).unwrap();
        if let Some(before) = index.checked_sub(25).and_then(|before| graph.find(&format!("node {before}"))) {
            graph.connect(&catalogue, before, "curves", id, "curves").unwrap();
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ron");
    file::save(&graph, &path).unwrap();
    let mut window = window(&path);
    let middle = window.app.canvas_on_screen().unwrap().center();
    window.step(vec![Event::PointerMoved(middle)]);
    let mut turn = 1.0_f32;
    c.bench_function("a frame of 500 nodes while panning and zooming", |b| {
        b.iter(|| {
            turn = -turn;
            let wheel = |delta, modifiers| {
                let phase = egui::TouchPhase::Move;
                Event::MouseWheel { unit: MouseWheelUnit::Point, delta, modifiers, phase }
            };
            window.step(vec![
                wheel(vec2(40.0 * turn, 0.0), Modifiers::NONE),
                wheel(vec2(0.0, 2.0 * turn), Modifiers::COMMAND),
            ]);
        });
    });
}

fn drag(c: &mut Criterion) {
    let mut window = window(&vest());
    let rail = window.app.document().graph().find("side rail").unwrap();
    window.app.ask(ViewCommand::Select(vec![rail]));
    follow(&mut window);
    let strokes = match window.app.document().graph().node(rail).unwrap().source("strokes") {
        Some(Source::Literal { literal: Literal::Strokes(strokes), .. }) => strokes.clone(),
        other => panic!("{other:?}"),
    };
    let mut round = 0_u32;
    c.bench_function("a dragged rail of the vest, until its surface is there", |b| {
        b.iter(|| {
            round += 1;
            let mut moved = strokes.clone();
            // Never twice the same, so that nothing is remembered.
            moved[0].points[4].x += f64::from(round) * 1e-7;
            let edits = vec![Edit::set(rail, "strokes", Literal::Strokes(moved))];
            let gesture = Some("drag".to_owned());
            window.app.ask(GraphCommand::Edit { name: "drag".to_owned(), edits, gesture });
            black_box(follow(&mut window))
        });
    });
}

/// The window as a picture, with all four views drawn anew: what the machine's renderer takes, apart from our own work.
fn renderer(c: &mut Criterion) {
    let mut window = egui_kittest::Harness::builder()
        .with_size(vec2(1440.0, 900.0))
        .renderer(egui_kittest::wgpu::WgpuTestRenderer::new())
        .build_eframe(|context| App::new(context, Options { path: Some(vest()), ..Options::default() }).unwrap());
    while !window.state().results().is_current() {
        window.run_steps(1);
    }
    let mut grid = false;
    c.bench_function("a picture of the vest by the machine's renderer", |b| {
        b.iter(|| {
            // A picture that looks as before would not be drawn again.
            grid = !grid;
            window.state_mut().settings_mut().grid = grid;
            window.run_steps(1);
            black_box(window.render().unwrap())
        });
    });
}

criterion_group!(benches, idle, large, drag, renderer);
criterion_main!(benches);
