//! A page of programs that were limited together: one is seen at a time.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::columns::figure;
use super::figures::{fits, word};
use super::page::{begin, element, end};
use super::shown::{Found, Page};
use crate::pipeline::{SetFile, Summary};

/// A page on its way: what is held of a program that is written are its figures.
#[derive(Debug)]
pub struct SetPage<W> {
    out: W,
    programs: Vec<Value>,
}

impl<W: Write> SetPage<W> {
    /// Begins a page.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(mut out: W) -> io::Result<Self> {
        begin(&mut out)?;
        Ok(Self {
            out,
            programs: Vec::new(),
        })
    }

    /// The next program, as it was limited.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn add(&mut self, page: &Page<'_>) -> io::Result<()> {
        let id = match self.programs.len() {
            0 => "data".to_owned(),
            place => format!("data-{place}"),
        };
        page.write_data(&id, &mut self.out)?;
        writeln!(self.out)?;
        let (before, after) = match page.found {
            Found::Limit { summary, .. } => (&summary.before, &summary.after),
            Found::Report(summary) => (summary, summary),
            Found::Diff(compared) => (compared.summaries[0], compared.summaries[1]),
        };
        let both = |value: fn(&Summary) -> Value| json!([value(before), value(after)]);
        self.programs.push(json!({
            "program": page.program,
            "word": word(page),
            "fits": fits(page),
            "peak_w": both(|it| figure(it.peak_w)),
            "duration_s": both(|it| figure(it.duration_s)),
            "unfit_count": both(|it| it.unfit_count.into()),
        }));
        Ok(())
    }

    /// The end of it, with the files of subprograms; `written` says whether all files are
    /// delivered.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn finish(mut self, files: &[SetFile], written: bool) -> io::Result<W> {
        let files = files.get(self.programs.len()..).unwrap_or_default();
        let files = files.iter().map(|it| json!([it.name, it.edited_lines]));
        let set = json!({
            "programs": self.programs,
            "files": files.collect::<Vec<_>>(),
            "written": written,
        });
        element("set-data", &set, &mut self.out)?;
        end(&mut self.out)?;
        Ok(self.out)
    }
}
