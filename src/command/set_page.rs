//! The page of programs that are limited together: what is gathered for it, and how it is drawn.

use std::io::{self, BufWriter, Cursor, IntoInnerError};
use std::path::Path;

use anyhow::{Context, Result};
use gwatt::machine::Machine;
use gwatt::pipeline::{Restart, RestartRows, Row, RowSink, SetProgram, SetSummary};
use gwatt::report::{Found, LineTexts, Page, PageRows, SetPage, Side};

use super::output::{Spool, Target};
use super::page::planned;
use super::rows::Rows;

/// The rows of several programs: all of them for reports, those of each for a page.
#[derive(Debug)]
pub struct SetRows {
    /// The reports.
    pub rows: Rows,
    /// What a page shows of each program, if one is asked for.
    pub pages: Vec<PageRows>,
    names: Vec<String>,
    /// Whose rows they are.
    place: usize,
}

impl SetRows {
    /// Rows of these programs, also for a page where one is wanted.
    pub fn new(rows: Rows, programs: &[SetProgram], page: bool) -> Self {
        let pages = programs.iter().filter(|_| page);
        Self {
            rows,
            pages: pages.map(|_| PageRows::default()).collect(),
            names: programs.iter().map(|it| it.name.clone()).collect(),
            place: 0,
        }
    }

    /// Where rows go; `None` where nobody wants them.
    pub fn sink(&mut self) -> Option<&mut dyn RestartRows> {
        let wanted = self.rows.sink().is_some() || !self.pages.is_empty();
        wanted.then_some(self as &mut dyn RestartRows)
    }
}

impl RowSink for SetRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        self.rows.row(row)?;
        let Some(page) = self.pages.get_mut(self.place) else {
            return Ok(());
        };
        if self.names.get(self.place) != Some(&row.file) {
            return page.row(row);
        }
        // Its own lines are named by their numbers alone.
        let mut own = row.clone();
        own.file.clear();
        page.row(&own)
    }

    fn begin_program(&mut self, place: usize) {
        self.place = place;
    }
}

impl Restart for SetRows {
    fn restart(&mut self) -> io::Result<()> {
        self.rows.restart()?;
        self.pages.fill_with(PageRows::default);
        Ok(())
    }
}

/// Opens what a page goes to, so that a place that cannot be written is known before the work
/// begins.
pub fn open(html: Option<&Path>) -> Result<Option<(Spool, &Path)>> {
    let open = |path| Ok((Target::new(path)?.spool()?, path));
    html.map(open).transpose()
}

/// Draws the programs before and after they were limited.
pub fn draw(
    (spool, path): (Spool, &Path),
    programs: &[SetProgram],
    machine: &Machine,
    limited: &SetSummary,
    (rows, partly): (&[PageRows], bool),
) -> Result<Spool> {
    let failed = || format!("cannot write {}", path.display());
    let mut set = SetPage::new(BufWriter::new(spool)).with_context(failed)?;
    let each = programs.iter().zip(&limited.programs).zip(rows);
    for (place, ((program, summary), rows)) in each.enumerate() {
        let text = || Cursor::new(&*program.text);
        let [before_s, after_s] = [&summary.before, &summary.after].map(|it| it.duration_s);
        let (options, side) = (&program.options, Side::Before);
        let before = planned(text(), machine, options, before_s, rows, side)?;
        let written = limited.files.get(place).map(|file| file.text.as_slice());
        let written = Cursor::new(written.unwrap_or_default());
        let options = limited.options_after(programs, place);
        // A word that another reading permits is not known here: its peaks stand alone.
        let after = planned(written, machine, &options, after_s, rows, Side::After);
        let after = after.unwrap_or_default();
        let texts = LineTexts::read(text(), rows, &[&summary.before, &summary.after])?;
        set.add(&Page {
            program: &program.name,
            machine,
            found: Found::Limit {
                summary,
                partly: partly && !summary.certified,
            },
            rows,
            before: before.as_ref(),
            after: after.as_ref(),
            texts: &texts,
        })
        .with_context(failed)?;
    }
    let out = set.finish(&limited.files, limited.certified() || partly);
    let out = out.with_context(failed)?;
    let spool = out.into_inner();
    spool
        .map_err(IntoInnerError::into_error)
        .with_context(failed)
}
