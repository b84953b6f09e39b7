//! Outputs that can be begun again.

use std::io::{self, BufWriter, Write};

use super::row::RowSink;

/// Something that is written to, and can be emptied: `limit` begins again when
/// a program turns out to have calls or loops.
pub trait Restart {
    /// Forgets everything that was written.
    ///
    /// # Errors
    /// Whatever emptying gives.
    fn restart(&mut self) -> io::Result<()>;
}

/// Rows that can be begun again.
pub trait RestartRows: RowSink + Restart {}

impl<T: RowSink + Restart> RestartRows for T {}

impl Restart for () {
    fn restart(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Restart for io::Sink {
    fn restart(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Restart for Vec<u8> {
    fn restart(&mut self) -> io::Result<()> {
        self.clear();
        Ok(())
    }
}

impl<T: Restart + ?Sized> Restart for &mut T {
    fn restart(&mut self) -> io::Result<()> {
        (**self).restart()
    }
}

impl<W: Write + Restart> Restart for BufWriter<W> {
    fn restart(&mut self) -> io::Result<()> {
        self.flush()?;
        self.get_mut().restart()
    }
}
