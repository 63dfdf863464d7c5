//! The headless command of Maquette. Exit codes: 0 done, 1 a node failed, a --fail-if limit was exceeded, what was
//! compared differs, a graph is of an earlier version or a wedge was stopped, 2 the graph or the arguments are wrong, 3 a
//! result could not be written, or the program broke down.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use maquette::commands::{self, Ended};

/// Evaluates procedural modelling graphs: sketched curves in, models out.
///
/// Exit codes: 0 done, 1 a node failed, a --fail-if limit was exceeded, what was compared differs, a graph is of
/// an earlier version or a wedge was stopped, 2 the graph or the arguments are wrong, 3 a result could not be written, or
/// the program broke down.
#[derive(Parser)]
#[command(version, about, long_about, max_term_width = 110)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(commands::run::Arguments),
    Check(commands::check::Arguments),
    Fmt(commands::fmt::Arguments),
    Migrate(commands::migrate::Arguments),
    Diff(commands::diff::Arguments),
    Verify(commands::verify::Arguments),
    Freeze(commands::freeze::Arguments),
    Nodes(commands::nodes::Arguments),
    Render(commands::render::Arguments),
    Wedge(Box<commands::wedge::Arguments>),
}

fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|_| {
        // A node that breaks down is reported as that node's failure, in one message.
    }));
    let arguments = Arguments::parse();
    let ended = std::panic::catch_unwind(|| match &arguments.command {
        Command::Run(arguments) => commands::run::run(arguments),
        Command::Check(arguments) => commands::check::check(arguments),
        Command::Fmt(arguments) => commands::fmt::fmt(arguments),
        Command::Migrate(arguments) => commands::migrate::migrate(arguments),
        Command::Diff(arguments) => commands::diff::diff(arguments),
        Command::Verify(arguments) => commands::verify::verify(arguments),
        Command::Freeze(arguments) => commands::freeze::freeze(arguments),
        Command::Nodes(arguments) => commands::nodes::nodes(arguments),
        Command::Render(arguments) => commands::render::render(arguments),
        Command::Wedge(arguments) => commands::wedge::wedge(arguments),
    });
    let ended = ended.unwrap_or_else(|_| {
        commands::console::error("maquette broke down; this is a mistake in the program, please report it");
        Ended::NotWritten
    });
    if commands::console::lost() && ended == Ended::Done {
        commands::console::error("not everything could be written to the standard output");
        return ExitCode::from(Ended::NotWritten as u8);
    }
    ExitCode::from(ended as u8)
}
