//! The rows of a report on their way to files.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use gwatt::pipeline::{Restart, RestartRows, Row, RowSink};
use gwatt::report::{CsvRows, JsonRows, PageRows};

use super::output::{Spool, Target};

/// The reports that are asked for.
#[derive(Debug)]
pub struct Rows {
    csv: Option<CsvRows<Spool>>,
    json: Option<(JsonRows<BufWriter<File>>, Spool)>,
    /// What a picture shows of them.
    pub page: Option<PageRows>,
    targets: (Option<Target>, Option<PathBuf>),
}

impl Rows {
    /// Opens what is asked for.
    pub fn new(csv: Option<Target>, json: Option<&Path>) -> Result<Self> {
        let targets = (csv.clone(), json.map(Path::to_owned));
        let csv = match csv {
            Some(target) => Some(CsvRows::new(target.spool()?)?),
            None => None,
        };
        let json = match json {
            Some(path) => {
                let blocks = tempfile::tempfile().context("cannot make a temporary file")?;
                let rows = JsonRows::new(BufWriter::new(blocks));
                Some((rows, Target::new(path)?.spool()?))
            }
            None => None,
        };
        Ok(Self {
            csv,
            json,
            page: None,
            targets,
        })
    }

    /// The same with what a picture shows of them, if one is asked for.
    pub fn with_page(mut self, wanted: bool) -> Self {
        self.page = wanted.then(PageRows::default);
        self
    }

    /// Where rows go; `None` where nobody wants them, which saves their making.
    pub fn sink(&mut self) -> Option<&mut dyn RestartRows> {
        let wanted = self.csv.is_some() || self.json.is_some() || self.page.is_some();
        wanted.then_some(self as &mut dyn RestartRows)
    }

    /// Delivers the reports; `write_json` puts the rows into their object.
    pub fn deliver(
        self,
        write_json: impl FnOnce(File, &mut dyn Write) -> io::Result<()>,
    ) -> Result<()> {
        if let Some((rows, spool)) = self.json {
            let mut blocks = rows
                .finish()?
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?;
            blocks.seek(SeekFrom::Start(0))?;
            let mut out = BufWriter::new(spool);
            write_json(blocks, &mut out)?;
            let spool = out.into_inner().map_err(io::IntoInnerError::into_error)?;
            spool.deliver()?;
        }
        if let Some(rows) = self.csv {
            rows.finish()?.deliver()?;
        }
        Ok(())
    }
}

impl RowSink for Rows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        if let Some(csv) = &mut self.csv {
            csv.row(row)?;
        }
        if let Some((json, _)) = &mut self.json {
            json.row(row)?;
        }
        if let Some(page) = &mut self.page {
            page.row(row)?;
        }
        Ok(())
    }
}

impl Restart for Rows {
    fn restart(&mut self) -> io::Result<()> {
        let (csv, json) = self.targets.clone();
        let page = self.page.is_some();
        let again = Self::new(csv, json.as_deref()).map_err(io::Error::other)?;
        *self = again.with_page(page);
        Ok(())
    }
}
