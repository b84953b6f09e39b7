//! A program that fits.

use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};

use tempfile::SpooledTempFile;

use super::Error;
use crate::machine::Machine;
use crate::pipeline::{self, Allowed, Law, LimitOptions, LimitSummary, Options, Restart, Strategy};

/// Bytes of a program that are held in memory before a temporary file takes them.
const SPOOL_BYTES: usize = 16 << 20;

/// A program that fits, and what was done to it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Limited {
    /// The figures before and after, and the certificate's conditions.
    pub summary: LimitSummary,
    text: Vec<u8>,
}

impl Limited {
    /// The program as it is to be run.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// The same, taken out.
    #[must_use]
    pub fn into_text(self) -> Vec<u8> {
        self.text
    }
}

/// How a program is made to fit.
///
/// ```
/// use gwatt::Limit;
/// use gwatt::pipeline::Allowed;
///
/// # fn main() -> Result<(), gwatt::Error> {
/// let (machine, _) = gwatt::Machine::load("three-axis")?;
/// let program = "G21 G90\nG1 X400 Y300 Z-200 F30000\nM30\n";
///
/// // A cutting feed is lowered on request alone.
/// let error = gwatt::limit(program, &machine).unwrap_err();
/// assert_eq!(error.diagnostics()[0].line, 2);
///
/// let limit = Limit {
///     how: gwatt::pipeline::LimitOptions {
///         allowed: Allowed { feed: true, ..Allowed::NOTHING },
///         ..Limit::default().how
///     },
///     ..Limit::default()
/// };
/// let limited = limit.run(program, &machine)?;
/// assert!(limited.summary.after.fits());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// What may be changed, and by which strategy.
    pub how: LimitOptions,
    /// How the program is read and judged.
    pub options: Options,
}

impl Default for Limit {
    fn default() -> Self {
        Self {
            how: LimitOptions {
                strategy: Strategy::Optimal,
                law: Law::Exact,
                allowed: Allowed::NOTHING,
                ..LimitOptions::USUAL
            },
            options: Options::default(),
        }
    }
}

impl Limit {
    /// Writes a program that fits.
    ///
    /// # Errors
    /// [`Error::DoesNotFit`] where no program can be certified; [`Error::Refused`] for one
    /// that cannot be read; or what is asked of this machine cannot be done.
    pub fn run(&self, program: impl AsRef<[u8]>, machine: &Machine) -> Result<Limited, Error> {
        let mut text = Vec::new();
        let program = Cursor::new(program.as_ref());
        let summary = self.certified(program, machine, &mut text)?;
        Ok(Limited { summary, text })
    }

    /// Reads a program of any length, and writes one that fits to `output`, whole or not at
    /// all: a temporary file holds what is not certified yet.
    ///
    /// # Errors
    /// See [`Self::run`]; and whatever reading, writing and the temporary file give.
    ///
    /// ```
    /// # fn main() -> Result<(), gwatt::Error> {
    /// # let (machine, _) = gwatt::Machine::load("three-axis")?;
    /// # let input = std::io::Cursor::new("G21 G90\nG0 X400 Y300\nM30\n");
    /// let mut output = Vec::new();
    /// let summary = gwatt::Limit::default().stream(input, &machine, &mut output)?;
    /// assert!(summary.certified && output.starts_with(b"G21 G90\n"));
    /// # Ok(())
    /// # }
    /// ```
    pub fn stream(
        &self,
        input: impl Read + Seek + Send,
        machine: &Machine,
        mut output: impl Write,
    ) -> Result<LimitSummary, Error> {
        let mut spool = Spool(SpooledTempFile::new(SPOOL_BYTES));
        let summary = self.certified(input, machine, &mut spool)?;
        let Spool(mut written) = spool;
        written
            .seek(SeekFrom::Start(0))
            .and_then(|_| io::copy(&mut written, &mut output))
            .and_then(|_| output.flush())
            .map_err(Error::Output)?;
        Ok(summary)
    }

    fn certified(
        &self,
        input: impl Read + Seek + Send,
        machine: &Machine,
        output: impl Write + Restart + Send,
    ) -> Result<LimitSummary, Error> {
        let summary = pipeline::limit(input, machine, &self.options, self.how, output, None)?;
        if !summary.certified {
            return Err(Error::DoesNotFit(Box::new(summary)));
        }
        Ok(summary)
    }
}

/// What is not certified yet.
struct Spool(SpooledTempFile);

impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Restart for Spool {
    fn restart(&mut self) -> io::Result<()> {
        self.0.set_len(0)?;
        self.0.seek(SeekFrom::Start(0)).map(|_| ())
    }
}
