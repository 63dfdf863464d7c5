//! `maquette render`: a shaded picture of what a graph makes.

use std::path::PathBuf;

use super::evaluation::{EvaluationArguments, evaluate};
use maquette_nodes::results;

use super::{Ended, console, write};
use crate::picture::{PictureOptions, View, draw};

/// Evaluate a graph and draw a shaded picture of its results; needs neither GPU nor display.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    evaluation: EvaluationArguments,
    /// The picture, a .png file.
    #[arg(short = 'o', long = "write", value_name = "FILE")]
    file: PathBuf,
    /// From where it is seen.
    #[arg(long, value_enum, default_value_t = ViewName::ThreeQuarter)]
    view: ViewName,
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x960", value_name = "WxH", value_parser = size)]
    size: (u32, u32),
    /// Draw the edges of the faces.
    #[arg(long)]
    wireframe: bool,
    /// Draw the graph's curves-out results too; they are drawn anyway where there is no mesh.
    #[arg(long)]
    curves: bool,
}

/// The views of a picture, as they are named on the command line.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(super) enum ViewName {
    Front,
    Side,
    Top,
    ThreeQuarter,
}

impl ViewName {
    pub(super) fn view(self) -> View {
        match self {
            Self::Front => View::Front,
            Self::Side => View::Side,
            Self::Top => View::Top,
            Self::ThreeQuarter => View::ThreeQuarter,
        }
    }
}

/// Reads `WIDTHxHEIGHT`, pixels.
pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let (width, height) = text.split_once('x').ok_or("write it as WIDTHxHEIGHT, such as 1280x960")?;
    match (width.parse(), height.parse()) {
        (Ok(width), Ok(height)) => Ok((width, height)),
        _ => Err("write it as WIDTHxHEIGHT, such as 1280x960".to_owned()),
    }
}

/// Carries out the command.
pub fn render(arguments: &Arguments) -> Ended {
    if arguments.file.extension().is_none_or(|e| !e.eq_ignore_ascii_case("png")) {
        console::error(format!("{}: pictures are written as .png", arguments.file.display()));
        return Ended::Wrong;
    }
    let evaluated = maquette_nodes::catalogue()
        .map_err(|error| vec![format!("error: {error}")])
        .and_then(|catalogue| evaluate(&catalogue, &arguments.evaluation, |_| Ok(())));
    let evaluated = match evaluated {
        Ok(evaluated) => evaluated,
        Err(messages) => {
            messages.iter().for_each(console::remark);
            return Ended::Wrong;
        }
    };
    evaluated.failures.iter().for_each(console::remark);
    let failed = !evaluated.failures.is_empty();
    if failed && !arguments.evaluation.keep_going {
        console::remark("nothing was drawn, because a node failed; --keep-going draws what succeeded");
        return Ended::Failed;
    }
    let (width, height) = arguments.size;
    let view = arguments.view.view();
    let scene = results::scene(&evaluated.evaluation, &evaluated.targets);
    // Where there are only curves, a picture without them would be empty.
    let curves = arguments.curves || scene.meshes.is_empty();
    let options = PictureOptions { view, width, height, wireframe: arguments.wireframe, curves };
    let picture = match draw(&scene, &options) {
        Ok(picture) => picture,
        Err(error) => {
            console::error(error.to_string());
            return if failed { Ended::Failed } else { Ended::Wrong };
        }
    };
    let written = picture
        .to_png()
        .map_err(|error| format!("{}: {error}", arguments.file.display()))
        .and_then(|bytes| write::whole(&arguments.file, &bytes));
    match written {
        Err(error) => {
            console::error(error);
            Ended::NotWritten
        }
        Ok(()) => {
            if !arguments.evaluation.quiet {
                console::say(format!("wrote {} ({width}x{height})", arguments.file.display()));
            }
            if failed { Ended::Failed } else { Ended::Done }
        }
    }
}
