//! Text of a file to the struct that mirrors it.

use serde::de::DeserializeOwned;
use serde_json::Value;
use toml::de::{DeTable, Deserializer};

use super::findings::Findings;
use super::structure::Structure;

/// Version of the file format that this build reads.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// Faults of syntax that are shown: what follows them is guesswork.
const FAULTS_MAX: usize = 3;
/// Lines from the beginning that say whether a file is a program.
const LINES: usize = 40;

/// Whether most of the first lines are a program's: blocks, comments, its marks.
fn is_program(text: &str) -> bool {
    let block = |line: &str| {
        let mut bytes = line.bytes();
        let first = bytes.next().unwrap_or_default().to_ascii_uppercase();
        match first {
            b'%' | b'(' | b';' => true,
            b'G' | b'M' | b'N' | b'O' | b'X' | b'Y' | b'Z' | b'T' => bytes
                .next()
                .is_some_and(|it| it.is_ascii_digit() || it == b'-'),
            _ => false,
        }
    };
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let (mut all, mut blocks) = (0, 0);
    for line in lines.take(LINES) {
        all += 1;
        blocks += usize::from(block(line));
    }
    blocks > 0 && 2 * blocks > all
}

/// Reads a file into its struct; what does not fit is reported and left out.
/// `None` when nothing can be read at all.
pub(crate) fn read<T: DeserializeOwned>(
    text: &str,
    schema: &Value,
    findings: &mut Findings<'_>,
) -> Option<T> {
    let (mut document, errors) = DeTable::parse_recoverable(text);
    let (mut readable, mut faults) = (true, 0);
    if let Some(first) = errors.first().filter(|_| is_program(text)) {
        let span = first.span().unwrap_or_default();
        let message = "this looks like a part program, not like a machine file";
        let help = Some("-m takes a machine file, or a name of `gwatt machine list`".to_owned());
        findings.error("machine-syntax", &span, message, help);
        return None;
    }
    for error in &errors {
        let span = error.span().unwrap_or_default();
        let message = error.message().lines().next().unwrap_or("cannot be read");
        if message == "duplicate key" {
            let key = text.get(span.clone()).unwrap_or("");
            let help = Some("keep one of the two".to_owned());
            findings.error(
                "machine-twice",
                &span,
                format!("`{key}` is given twice"),
                help,
            );
        } else {
            // What follows a syntax error is guesswork: no further checks.
            readable = false;
            faults += 1;
            if faults <= FAULTS_MAX {
                findings.error("machine-syntax", &span, message, None);
            }
        }
    }
    if !readable {
        return None;
    }
    Structure::new(findings, schema).check(document.get_mut());
    match T::deserialize(Deserializer::from(document)) {
        Ok(file) => Some(file),
        Err(error) => {
            let message = error.message().lines().next().unwrap_or("").to_owned();
            findings.error(
                "machine-type",
                &error.span().unwrap_or_default(),
                message,
                None,
            );
            None
        }
    }
}
