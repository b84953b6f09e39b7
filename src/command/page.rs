//! The page and the still picture of a program: what is gathered for them, and where they go.

use std::fs::File;
use std::io::{BufWriter, IntoInnerError, Read, Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Options, Summary};
use gwatt::report::{Compared, Found, LineTexts, Page, PageRows, PageSeries, Side};

use super::input::Program;
use super::output::{Spool, Target};
use super::setup::Setup;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Pictures<'a> {
    /// The page.
    pub html: Option<&'a Path>,
    /// The still picture.
    pub svg: Option<&'a Path>,
}

impl<'a> Pictures<'a> {
    /// Whether any is.
    pub fn is_any(self) -> bool {
        self.html.is_some() || self.svg.is_some()
    }

    /// Where they go.
    pub fn paths(self) -> impl Iterator<Item = &'a Path> {
        self.html.into_iter().chain(self.svg)
    }

    /// Refuses what the pictures cannot show.
    pub fn check(self, setup: &Setup) -> Result<()> {
        let names = [("--html shows", self.html), ("--svg shows", self.svg)];
        for (name, path) in names {
            if path.is_some() {
                setup.one_way(name)?;
            }
        }
        Ok(())
    }

    /// Opens what they go to, so that a place that cannot be written is known before the
    /// work begins.
    pub fn open(self) -> Result<Frames> {
        let spool = |path: Option<&Path>| -> Result<Option<(Spool, PathBuf)>> {
            let open = |path: &Path| Ok((Target::new(path)?.spool()?, path.to_owned()));
            path.map(open).transpose()
        };
        Ok(Frames {
            html: spool(self.html)?,
            svg: spool(self.svg)?,
        })
    }
}

/// Pictures on their way: dropped, they leave no trace.
#[derive(Debug)]
pub struct Frames {
    html: Option<(Spool, PathBuf)>,
    svg: Option<(Spool, PathBuf)>,
}

impl Frames {
    /// Draws them.
    pub fn draw(&mut self, page: &Page<'_>) -> Result<()> {
        type Frame = Option<(Spool, PathBuf)>;
        let write = |frame: Frame, html: bool| -> Result<Frame> {
            let Some((spool, path)) = frame else {
                return Ok(None);
            };
            let failed = || format!("cannot write {}", path.display());
            let mut out = BufWriter::new(spool);
            let drawn = if html {
                page.write_html(&mut out)
            } else {
                page.write_svg(&mut out)
            };
            drawn.and_then(|()| out.flush()).with_context(failed)?;
            let spool = out.into_inner().map_err(IntoInnerError::into_error)?;
            Ok(Some((spool, path)))
        };
        self.html = write(self.html.take(), true)?;
        self.svg = write(self.svg.take(), false)?;
        Ok(())
    }

    /// Puts them where they are to go.
    pub fn deliver(self) -> Result<()> {
        let mut both = self.html.into_iter().chain(self.svg);
        both.try_for_each(|(spool, _)| spool.deliver())
    }
}

/// The planned power of a program; `None` where it has too many moves to be followed.
pub fn planned(
    input: impl Read + Seek + Send,
    machine: &Machine,
    options: &Options,
    duration_s: f64,
    rows: &PageRows,
    side: Side,
) -> Result<Option<PageSeries>, Failure> {
    let mut series = PageSeries::new(machine, rows, side);
    let step_s = PageSeries::step_s(duration_s);
    match pipeline::series(input, machine, options, step_s, &mut series) {
        Ok(_) => {
            series.finish();
            Ok(Some(series))
        }
        // The peaks of its blocks are drawn all the same.
        Err(Failure::Unsuitable(_)) => Ok(None),
        Err(failure) => Err(failure),
    }
}

/// Draws a program as it is.
pub fn draw_report(
    frames: &mut Frames,
    program: &Program,
    setup: &Setup,
    machine: &Machine,
    summary: &Summary,
    rows: &PageRows,
) -> Result<(), Refused> {
    let options = setup.options_for(program);
    let input = program.open()?;
    let before = planned(
        input,
        machine,
        &options,
        summary.duration_s,
        rows,
        Side::Before,
    )?;
    let texts = LineTexts::read(program.open()?, rows, &[summary])?;
    let page = Page {
        program: &program.name,
        machine,
        found: Found::Report(summary),
        rows,
        before: before.as_ref(),
        after: None,
        texts: &texts,
    };
    Ok(frames.draw(&page)?)
}

/// Draws a program before and after it was limited.
pub fn draw_limit(
    frames: &mut Frames,
    program: &Program,
    setup: &Setup,
    found: Found<'_>,
    rows: &PageRows,
    written: File,
) -> Result<(), Refused> {
    let Found::Limit { summary, .. } = found else {
        return Ok(());
    };
    let (machine, options) = (&setup.machine, setup.options_for(program));
    let [before_s, after_s] = [&summary.before, &summary.after].map(|it| it.duration_s);
    let input = program.open()?;
    let before = planned(input, machine, &options, before_s, rows, Side::Before)?;
    // What was written is read as it was certified; a word that another reading permits is
    // not known here, and then its peaks stand alone.
    let after = planned(written, machine, &options, after_s, rows, Side::After);
    let after = after.unwrap_or_default();
    let summaries = [&summary.before, &summary.after];
    let texts = LineTexts::read(program.open()?, rows, &summaries)?;
    let page = Page {
        program: &program.name,
        machine,
        found,
        rows,
        before: before.as_ref(),
        after: after.as_ref(),
        texts: &texts,
    };
    Ok(frames.draw(&page)?)
}

/// Draws a program on two machines.
pub fn draw_diff(
    frames: &mut Frames,
    program: &Program,
    setups: [&Setup; 2],
    compared: Compared<'_>,
    rows: &PageRows,
) -> Result<(), Refused> {
    let series = |which: usize, side: Side| -> Result<Option<PageSeries>, Failure> {
        let options = setups[which].options_for(program);
        let duration_s = compared.summaries[which].duration_s;
        let machine = &setups[which].machine;
        planned(program.open()?, machine, &options, duration_s, rows, side)
    };
    let before = series(0, Side::Before)?;
    let after = series(1, Side::After)?;
    let texts = LineTexts::read(program.open()?, rows, &compared.summaries)?;
    let page = Page {
        program: &program.name,
        machine: &setups[0].machine,
        found: Found::Diff(compared),
        rows,
        before: before.as_ref(),
        after: after.as_ref(),
        texts: &texts,
    };
    Ok(frames.draw(&page)?)
}

/// Why nothing is drawn.
#[derive(Debug)]
pub enum Refused {
    /// The program.
    Program(Failure),
    /// Anything else.
    Error(anyhow::Error),
}

impl Refused {
    /// As an error, where the program was read before.
    pub fn into_error(self) -> anyhow::Error {
        match self {
            Self::Program(failure) => anyhow::Error::new(failure),
            Self::Error(error) => error,
        }
    }
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        Self::Program(failure)
    }
}

impl From<anyhow::Error> for Refused {
    fn from(error: anyhow::Error) -> Self {
        Self::Error(error)
    }
}
