//! `gwatt moves`.

use std::io::{self, BufWriter};
use std::slice;

use anyhow::Result;
use gwatt::pipeline;
use gwatt::report::{Verdict, write_move};

use super::dialect;
use super::input::Program;
use super::output::Target;
use super::settings::Settings;
use super::setup::Setup;
use super::terminal::Terminal;
use crate::cli::MovesArgs;

/// Prints every move of a program.
pub fn run(args: &MovesArgs, terminal: Terminal) -> Result<Verdict> {
    let mut program = Program::new(&args.program);
    let mut args = args.clone();
    let settings = Settings::of(slice::from_ref(&program), terminal)?;
    settings.fill(&mut args.machine, &mut args.reading)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    setup.one_way("`moves` shows")?;
    dialect::settle(&mut setup, slice::from_mut(&mut program), terminal)?;
    // A program may be refused at its last line: until then nothing is printed.
    let mut out = BufWriter::new(Target::Stdout.spool()?);
    let axes = setup.machine.axis_set;
    let outcome = program.open().and_then(|input| {
        let options = setup.options_for(&program);
        pipeline::moves(input, &setup.machine, &options, &mut |mv, seconds| {
            write_move(mv, seconds, axes, &mut out)
        })
    });
    match outcome {
        Ok(notes) => {
            terminal.diagnostics(&program.name, &notes);
            let spool = out.into_inner().map_err(io::IntoInnerError::into_error)?;
            spool.deliver()?;
            Ok(Verdict::Fits)
        }
        Err(failure) => {
            terminal.say(|messages| dialect::failure(&setup, &program, &failure, messages));
            Ok(Verdict::Refused)
        }
    }
}
