//! gwatt on the command line.

mod cli;
mod command;

use std::io::{self, Write};
use std::panic;
use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser};
use gwatt::report::Verdict;

use cli::{Cli, Command};
use command::{Shown, Terminal};

const REFUSED: u8 = 2;
const INTERNAL_ERROR: u8 = 3;

fn main() -> ExitCode {
    panic::set_hook(Box::new(|panic| {
        let _ = writeln!(
            io::stderr(),
            "gwatt: internal error: {panic}\nThis is a defect of gwatt. Please report it with the program and the machine file."
        );
    }));
    let code = panic::catch_unwind(run).unwrap_or(INTERNAL_ERROR);
    ExitCode::from(code)
}

/// Arguments to exit code.
fn run() -> u8 {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        // Help and version come this way too.
        Err(error) => {
            let code = u8::try_from(error.exit_code()).unwrap_or(REFUSED);
            return match error.print() {
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => REFUSED,
                _ => code,
            };
        }
    };
    let terminal = Terminal::new(cli.color, cli.progress);
    match execute(&cli.command, terminal) {
        Ok(Verdict::Fits) => 0,
        Ok(Verdict::DoesNotFit) => 1,
        Ok(Verdict::Refused) => REFUSED,
        Err(error) if is_closed_pipe(&error) => 0,
        Err(error) => {
            if !error.is::<Shown>() {
                terminal.error(format_args!("{error:#}"));
            }
            REFUSED
        }
    }
}

fn execute(command: &Command, terminal: Terminal) -> Result<Verdict> {
    match command {
        Command::Limit(args) => command::limit::run(args, terminal),
        Command::Watch(args) => command::watch::run(args, terminal),
        Command::Check(args) => command::check::run(args, terminal),
        Command::Report(args) => command::report::run(args, terminal),
        Command::Dialect(args) => command::dialect::run(args, terminal),
        Command::Diff(args) => command::diff::run(args, terminal),
        Command::Size(args) => command::size::run(args, terminal),
        Command::Moves(args) => command::moves::run(args, terminal),
        Command::Spindle(args) => command::spindle::run(args, terminal),
        Command::Plan(args) => command::plan::run(args, terminal),
        Command::Machine { command } => command::machine::run(command, terminal),
        Command::Excite(args) => command::excite::run(args, terminal),
        Command::Identify(args) => command::identify::run(args, terminal),
        Command::Tune(args) => command::tune::run(args, terminal),
        Command::Contour(args) => command::contour::run(args, terminal),
        Command::PowerFit(args) => command::power_fit::run(args, terminal),
        Command::Verify(args) => command::verify::run(args, terminal),
        Command::Explain(args) => command::explain::run(args),
        Command::Completions { shell } => completions(*shell),
        Command::Man => manual(),
    }
}

fn completions(shell: clap_complete::Shell) -> Result<Verdict> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "gwatt", &mut script);
    command::print(|out| out.write_all(&script))?;
    Ok(Verdict::Fits)
}

/// The manual page, those of the commands below it.
fn manual() -> Result<Verdict> {
    let mut root = Cli::command().disable_help_subcommand(true);
    root.build();
    let mut page = Vec::new();
    clap_mangen::Man::new(root.clone()).render(&mut page)?;
    for command in root.get_subcommands() {
        clap_mangen::Man::new(command.clone()).render(&mut page)?;
    }
    command::print(|out| out.write_all(&page))?;
    Ok(Verdict::Fits)
}

/// The reader of the output went away, as `head` does: nothing is wrong.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<io::Error>()
            .is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
    })
}
