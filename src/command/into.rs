//! Results that go into a machine file.

use std::fs;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use gwatt::identify::Outcome;
use gwatt::identify::merge::{AxisFigures, into_machine};
use gwatt::identify::response_table::{self, ResponseFigures};
use gwatt::machine::AxisId;
use gwatt::report::Verdict;

use super::output::{Spool, Target, back_up};
use super::setup::machine_file;
use super::terminal::Terminal;

/// Largest machine file that is read.
const BYTES_MAX: u64 = 1 << 20;

/// The axis of a letter.
pub fn axis_of(letter: char) -> Result<AxisId> {
    let upper = letter.to_ascii_uppercase();
    u8::try_from(upper)
        .ok()
        .and_then(AxisId::from_letter)
        .with_context(|| format!("{letter} is no axis; there are X Y Z A B C U V W"))
}

/// The verdict of a run that was to write into a machine file. Where it did not, since
/// what was found is not good, a note says so.
pub fn written(path: Option<&Path>, is_refused: bool, terminal: Terminal) -> Verdict {
    let Some(path) = path.filter(|_| is_refused) else {
        return Verdict::Fits;
    };
    terminal.note(format_args!(
        "{} is as it was, since the verdict is not good; --force writes all the same",
        path.display()
    ));
    Verdict::DoesNotFit
}

/// A result on its way into a machine file.
#[derive(Debug)]
pub struct Merged {
    /// `None`: it has these figures already.
    spool: Option<Spool>,
}

impl Merged {
    /// Prepares the file; nothing is changed yet.
    pub fn new(
        path: &Path,
        axis: AxisId,
        figures: &AxisFigures,
        margin: Option<f64>,
    ) -> Result<Self> {
        Self::made(path, |name, text| {
            into_machine(name, text, axis, figures, margin)
        })
    }

    /// Prepares the file with responses and filters.
    pub fn responses(path: &Path, list: &[(AxisId, ResponseFigures)]) -> Result<Self> {
        Self::made(path, |name, text| {
            response_table::into_machine(name, text, list)
        })
    }

    /// Prepares the file that `change` makes of the present one.
    pub fn made(path: &Path, change: impl FnOnce(&str, &str) -> Outcome<String>) -> Result<Self> {
        let name = path.display().to_string();
        if !path.exists() && machine_file(Some(&name)).is_none() {
            bail!("{name} is built in: `gwatt machine show {name} > mine.toml` makes a file of it");
        }
        let metadata = fs::metadata(path).with_context(|| format!("cannot read {name}"))?;
        ensure!(metadata.is_file(), "{name} is not a file");
        if metadata.len() > BYTES_MAX {
            bail!("{name} is larger than a machine file can be");
        }
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
        let merged = change(&name, &text)?;
        if merged == text {
            return Ok(Self { spool: None });
        }
        let mut spool = Target::new(path)?.spool()?;
        spool
            .write_all(merged.as_bytes())
            .with_context(|| format!("cannot write {name}"))?;
        Ok(Self { spool: Some(spool) })
    }

    /// Puts the new file in place of the old one, which keeps another name.
    pub fn deliver(self, path: &Path, terminal: Terminal) -> Result<()> {
        let Some(spool) = self.spool else {
            terminal.note(format_args!(
                "{} is unchanged: its values already cover what was found",
                path.display()
            ));
            return Ok(());
        };
        let real =
            fs::canonicalize(path).with_context(|| format!("cannot write {}", path.display()))?;
        let backup = back_up(&real)?;
        spool.deliver()?;
        terminal.note(format_args!(
            "{} has the new figures; the old version is kept as {}",
            path.display(),
            backup.display()
        ));
        Ok(())
    }
}
