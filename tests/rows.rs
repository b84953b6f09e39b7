//! Rows of a program, kept.

use gwatt::pipeline::{Restart, Row, RowSink};

/// Keeps every row.
#[derive(Default)]
pub struct Rows(pub Vec<Row>);

impl RowSink for Rows {
    fn row(&mut self, row: &Row) -> std::io::Result<()> {
        self.0.push(row.clone());
        Ok(())
    }
}

impl Restart for Rows {
    fn restart(&mut self) -> std::io::Result<()> {
        self.0.clear();
        Ok(())
    }
}
