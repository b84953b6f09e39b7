//! Rows as CSV (RFC 4180).

use std::io::{self, Write};

use super::record::{COLUMNS, Record};
use crate::pipeline::{Row, RowSink};

/// Writes rows as CSV below a header.
#[derive(Debug)]
pub struct CsvRows<W: Write> {
    out: csv::Writer<W>,
}

impl<W: Write> CsvRows<W> {
    /// Writes the header to `out`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(out: W) -> io::Result<Self> {
        let mut out = csv::WriterBuilder::new()
            .has_headers(false)
            .terminator(csv::Terminator::CRLF)
            .from_writer(out);
        out.write_record(COLUMNS)?;
        Ok(Self { out })
    }

    /// Writes what is still held back and gives the writer below back.
    ///
    /// # Errors
    /// Those of the writer below.
    pub fn finish(self) -> io::Result<W> {
        self.out
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

impl<W: Write + Send> RowSink for CsvRows<W> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        Ok(self.out.serialize(Record::from(row))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::record::example;

    #[test]
    fn a_row_stands_below_its_names() -> io::Result<()> {
        let mut bytes = Vec::new();
        let mut rows = CsvRows::new(&mut bytes)?;
        rows.row(&example())?;
        rows.finish()?;
        insta::assert_snapshot!(String::from_utf8_lossy(&bytes).replace('\r', ""), @r#"
        line,n_word,move,axes,start_s,duration_s,peak_w,regen_w,limit_w,ratio,energy_j,action,knob,value_before,value_after,peak_after_w,duration_after_s,regen_after_w,regen_limit_w,certificate,converter,run,file
        3,101,rapid,XYZ,360.25,1.5,4200,0.3,3150,0.75,1234.5,write as feed,F,,12345.678,3149.999,1.75,,,planned,"left, ""A""",2,sub.nc
        "#);
        Ok(())
    }

    /// The header is a list of its own: it must not drift from the fields.
    #[test]
    fn columns_are_the_fields_of_a_record() -> Result<(), serde_json::Error> {
        let row = example();
        let json = serde_json::to_string(&Record::from(&row))?;
        let mut at = 0;
        for column in COLUMNS {
            let key = format!("\"{column}\":");
            let found = json[at..].find(&key);
            assert!(found.is_some(), "{column} is missing or out of order");
            at += found.unwrap_or(0) + key.len();
        }
        assert_eq!(json.matches("\":").count(), COLUMNS.len());
        Ok(())
    }
}
