//! The window: `maquette-editor [GRAPH]`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use maquette_editor::document::ProjectChoice;
use maquette_editor::{App, Options, recovery_folder};

/// Sketch in four views, wire nodes, see the surface follow.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// The graph to open; without one the editor starts empty.
    graph: Option<PathBuf>,
    /// The project's folder: graphs may read files that lie below it. By default it is the folder of each graph.
    #[arg(long, value_name = "FOLDER", conflicts_with = "allow_outside")]
    project: Option<PathBuf>,
    /// Let graphs read any file; for graphs that you trust.
    #[arg(long)]
    allow_outside: bool,
}

#[expect(clippy::print_stderr, reason = "a window that can't be opened can't say why")]
fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let options = Options {
        path: arguments.graph,
        project: ProjectChoice { root: arguments.project, anywhere: arguments.allow_outside },
        recovery: recovery_folder(),
        welcome: true,
    };
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([1440.0, 900.0]).with_min_inner_size([640.0, 420.0]),
        ..eframe::NativeOptions::default()
    };
    let run = eframe::run_native(
        "maquette",
        native,
        Box::new(|context| match App::new(context, options) {
            Ok(app) => Ok(Box::new(app)),
            Err(error) => Err(error.into()),
        }),
    );
    match run {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("maquette-editor: the window can't be opened: {error}");
            ExitCode::FAILURE
        }
    }
}
