//! Draws the pictures of the editor in `docs/pictures`, without a window:
//! `cargo run -p maquette-editor --example screenshots -- docs/pictures`.

#![allow(clippy::expect_used, reason = "the harness takes no error")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, vec2};
use egui_kittest::{Harness, wgpu::WgpuTestRenderer};
use maquette_editor::command::ViewCommand;
use maquette_editor::view_state::Tool;
use maquette_editor::{App, Options, Shading};

type Window = Harness<'static, App>;

/// Lets the window go on until everything is evaluated, and no more.
fn settle(window: &mut Window) -> Result<(), Box<dyn Error>> {
    let begun = Instant::now();
    loop {
        window.run_steps(3);
        let results = window.state().results();
        if results.is_current() && results.progress().is_none() {
            window.run_steps(3);
            return Ok(());
        }
        if begun.elapsed() > Duration::from_secs(60) {
            return Err("the evaluation does not end".into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn write(window: &mut Window, path: &Path) -> Result<(), Box<dyn Error>> {
    let picture = window.render()?;
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png)?;
    maquette_graph::file::write_whole(path, bytes.get_ref())?;
    Ok(())
}

fn find(window: &mut Window, node: &str) -> Result<(), Box<dyn Error>> {
    window.state_mut().ask(ViewCommand::Find(node.to_owned()));
    settle(window)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("say the folder for the pictures")?);
    sketching(&folder)?;
    let mut window = opened("leg-deformed.ron")?;
    window.state_mut().settings_mut().shading = Shading::Silhouette;
    settle(&mut window)?;
    write(&mut window, &folder.join("editor-silhouette.png"))?;
    let mut window = opened("hand.ron")?;
    find(&mut window, "index")?;
    write(&mut window, &folder.join("editor-handle.png"))?;
    Ok(())
}

/// A window with a graph of the repository.
fn opened(graph: &str) -> Result<Window, Box<dyn Error>> {
    let graph = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs").join(graph);
    let options = Options { path: Some(graph), ..Options::default() };
    let mut window = Harness::builder()
        .with_size(vec2(1440.0, 900.0))
        .with_step_dt(1.0 / 60.0)
        .renderer(WgpuTestRenderer::new())
        .build_eframe(move |context| App::new(context, options).expect("the editor starts"));
    settle(&mut window)?;
    Ok(window)
}

/// The vest: shown, pulled, with zebra stripes, and its graph.
fn sketching(folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut window = opened("vest.ron")?;
    find(&mut window, "sorted")?;
    write(&mut window, &folder.join("editor.png"))?;

    find(&mut window, "side rail")?;
    window.state_mut().ask(ViewCommand::Take(Tool::Pull));
    let front = window.state().view_on_screen(maquette_editor::Direction::Front).ok_or("there is no front view")?;
    window.hover_at(front.center());
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::NONE, Key::Space);
    settle(&mut window)?;
    write(&mut window, &folder.join("editor-sketch.png"))?;
    window.key_press_modifiers(Modifiers::NONE, Key::Space);
    settle(&mut window)?;

    window.state_mut().ask(ViewCommand::Take(Tool::Select));
    window.state_mut().settings_mut().shading = Shading::Zebra;
    find(&mut window, "vest")?;
    write(&mut window, &folder.join("editor-zebra.png"))?;

    window.state_mut().settings_mut().shading = Shading::Matcap;
    window.ctx.set_theme(egui::Theme::Light);
    let canvas = window.state().canvas_on_screen().ok_or("there is no canvas")?;
    window.hover_at(canvas.center());
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::NONE, Key::Space);
    settle(&mut window)?;
    window.key_press_modifiers(Modifiers::NONE, Key::Home);
    settle(&mut window)?;
    write(&mut window, &folder.join("editor-graph.png"))?;
    Ok(())
}
