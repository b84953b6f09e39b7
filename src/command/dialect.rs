//! `gwatt dialect`, `--dialect auto`, and which profile would read what is refused.

use anyhow::{Result, bail};
use gwatt::dialect::{Recognised, listed, recognise};
use gwatt::machine::{self, Language, builtin};
use gwatt::pipeline::{self, Failure, Limits};
use gwatt::report::Verdict;

use super::input::Program;
use super::listing::Listing;
use super::output::print;
use super::setup::Setup;
use super::terminal::{Messages, Shown, Terminal};
use crate::cli::DialectArgs;

/// Larger programs are not read just to try.
const TRIAL_BYTES_MAX: u64 = 4 << 20;
/// Moves and lines that a trial repeats at most.
const TRIAL_REPEATS_MAX: u64 = 100_000;

/// Says which controllers programs are for.
pub fn run(args: &DialectArgs, terminal: Terminal) -> Result<Verdict> {
    let mut programs = Listing::of(&args.programs, terminal)?.programs();
    let setup = args.machine.as_deref();
    let setup = setup
        .map(|name| Setup::of(name, &args.reading, terminal))
        .transpose()?;
    let mut usual: Option<Setup> = None;
    let mut worst = Verdict::Fits;
    for program in &mut programs {
        let looked = program.keep().and_then(|()| look(program));
        let found = match looked {
            Ok(found) => found,
            Err(failure) => {
                terminal.failure(&program.name, &failure);
                worst = Verdict::Refused;
                continue;
            }
        };
        if found.foreign.is_some() || found.no_program.is_some() {
            worst = Verdict::Refused;
        }
        let unmarked = found.profiles.is_empty();
        let on = match &setup {
            _ if found.no_program.is_some() || found.foreign.is_some() => None,
            None if unmarked => {
                if usual.is_none() {
                    usual = Some(Setup::of(USUAL, &args.reading, terminal)?);
                }
                usual.as_ref()
            }
            given => given.as_ref(),
        };
        let tried = on.map_or(String::new(), |setup| {
            let all: Vec<&str> = builtin::controllers().iter().map(|it| it.name).collect();
            let names = if unmarked { &all } else { &found.profiles };
            reading(&read_without_errors(setup, program, names), names.len())
        });
        let name = &program.name;
        print(|out| writeln!(out, "{name}: {}{tried}", verdict(&found)))?;
    }
    Ok(worst)
}

/// The machine that programs without marks are tried on: it has the axes of most.
const USUAL: &str = "five-axis";

/// Profiles that marks may speak for at most; with more, all are tried.
const RELATIVES_MOST: usize = 8;

/// Which of so many profiles read a program without errors, in words.
fn reading(read: &[&str], tried: usize) -> String {
    match read {
        [] if tried > RELATIVES_MOST => "; no profile reads it without errors".to_owned(),
        [] => "; not read without errors on this machine".to_owned(),
        all if all.len() == tried && tried > RELATIVES_MOST => {
            "; all profiles read it without errors".to_owned()
        }
        some => format!("; read without errors as {}", listed(some)),
    }
}

/// The answer in words.
fn verdict(found: &Recognised) -> String {
    if let Some(why) = &found.no_program {
        return format!("none: {why}");
    }
    match &found.foreign {
        Some(foreign) => format!("none: this is {}; {}", foreign.what, foreign.help),
        None if found.profiles.is_empty() => {
            "not clear: there are no marks of a particular controller".to_owned()
        }
        None => format!("{} ({})", listed(&found.profiles), found.seen()),
    }
}

fn look(program: &Program) -> Result<Recognised, Failure> {
    let input = program.open()?;
    recognise(input, &program.name).map_err(Failure::Input)
}

/// With `--dialect auto`, has `setup` read programs as the one controller that all of
/// them are for, and says so.
pub fn settle(setup: &mut Setup, programs: &mut [Program], terminal: Terminal) -> Result<()> {
    for program in &mut *programs {
        if let Err(failure) = program.keep() {
            terminal.failure(&program.name, &failure);
            bail!(Shown);
        }
    }
    if !setup.auto {
        return Ok(());
    }
    let mut settled: Option<(&str, Language)> = None;
    for program in &*programs {
        let (language, note) = match choose(setup, program) {
            Ok(chosen) => chosen,
            Err(failure) => bail!("{}: {failure}", program.name),
        };
        terminal.note(format_args!("{}: {note}", program.name));
        if let Some((first, other)) = settled.as_ref().filter(|(_, it)| it.name != language.name) {
            bail!(
                "--dialect auto: {first} is for {}, {} for {}; give programs of one controller \
                 at a time",
                other.name,
                program.name,
                language.name
            );
        }
        settled = Some((&program.name, language));
    }
    if let Some((_, language)) = settled {
        setup.machine.controller.language = language;
    }
    Ok(())
}

/// The language that a program is to be read in under `--dialect auto`, with the reason.
pub fn choose(setup: &Setup, program: &Program) -> Result<(Language, String), Failure> {
    let found = look(program)?;
    let own = &setup.machine.controller.language;
    let refused = |message: String| Err(Failure::Unsuitable(format!("--dialect auto: {message}")));
    if let Some(foreign) = &found.foreign {
        return refused(format!("this is {}; {}", foreign.what, foreign.help));
    }
    let seen = found.seen();
    let (name, why) = match found.profiles.as_slice() {
        [] => (
            own.name.as_str(),
            "the machine's own, as there are no marks of a particular controller".to_owned(),
        ),
        [one] => (*one, seen),
        several if several.contains(&own.name.as_str()) => {
            let others: Vec<&str> = several
                .iter()
                .filter(|name| **name != own.name)
                .copied()
                .collect();
            let why = format!("the machine's own; {seen} may be {} too", listed(&others));
            (own.name.as_str(), why)
        }
        several => {
            return refused(format!(
                "it may be for {}: {seen}; name one of them",
                listed(several)
            ));
        }
    };
    let language = if name == own.name {
        own.clone()
    } else {
        match machine::builtin_controller(name) {
            Some(controller) => controller.language,
            None => return refused(format!("there is no profile {name}")),
        }
    };
    if let Some(given) = unsuitable(setup, &language) {
        return refused(format!("--set {given}: `{name}` has no such variable"));
    }
    Ok((language, format!("read as {name}: {why}")))
}

/// A variable that was given and that a language does not have.
fn unsuitable(setup: &Setup, language: &Language) -> Option<String> {
    let given = &setup.options.reading.given;
    let wrong = given.iter().find(|given| !given.suits(language))?;
    Some(wrong.to_string())
}

/// Says why a program came to no result, under the profiles that would read it.
pub fn failure(setup: &Setup, program: &Program, failure: &Failure, messages: &mut Messages) {
    if let Some(hint) = hint(setup, program, failure) {
        messages.note(format_args!("{}: {hint}", program.name));
    }
    messages.failure(&program.name, failure);
}

/// Which other profiles a refused program is for, and from what that is seen; `None`
/// where its marks speak for none.
pub fn hint(setup: &Setup, program: &Program, failure: &Failure) -> Option<String> {
    let Failure::Refused { .. } = failure else {
        return None;
    };
    let own = setup.machine.controller.language.name.as_str();
    let found = look(program).ok()?;
    let is_own = found.profiles.contains(&own);
    let mut others = found.profiles.clone();
    others.retain(|name| *name != own);
    let seen = found.seen();
    let read = read_without_errors(setup, program, &others);
    match (read.as_slice(), is_own) {
        ([], true) => None,
        ([], false) if others.is_empty() => None,
        ([], false) => Some(format!(
            "it is read as {own}, but looks as if it is for {} ({seen}), which on this machine \
             does not read it without errors either",
            listed(&others)
        )),
        ([first, ..], _) => Some(format!(
            "it is read as {own}; without errors it is read as {} ({seen}): use --dialect {first}",
            listed(&read)
        )),
    }
}

/// The profiles among `names` as which a program is read without errors.
fn read_without_errors(
    setup: &Setup,
    program: &Program,
    names: &[&'static str],
) -> Vec<&'static str> {
    let mut options = setup.options_for(program);
    options.reading.limits = Limits {
        repeated_moves: options.reading.limits.repeated_moves.min(TRIAL_REPEATS_MAX),
        idle_lines: options.reading.limits.idle_lines.min(TRIAL_REPEATS_MAX),
        ..options.reading.limits
    };
    let mut machine = setup.machine.clone();
    let mut is_read = |name: &&str| {
        let Some(controller) = machine::builtin_controller(name) else {
            return false;
        };
        if unsuitable(setup, &controller.language).is_some() {
            return false;
        }
        machine.controller.language = controller.language;
        let read = program
            .open()
            .and_then(|input| pipeline::moves(input, &machine, &options, &mut |_, _| Ok(())));
        read.is_ok()
    };
    if program.bytes() > TRIAL_BYTES_MAX {
        return Vec::new();
    }
    names.iter().filter(|name| is_read(name)).copied().collect()
}
