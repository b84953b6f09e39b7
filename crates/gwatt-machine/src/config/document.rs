//! Text of a file to the struct that mirrors it.

use serde::de::DeserializeOwned;
use serde_json::Value;
use toml::de::{DeTable, Deserializer};

use super::findings::Findings;
use super::structure::Structure;

/// Version of the file format that this build reads.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// Reads a file into its struct; what does not fit is reported and left out.
/// `None` when nothing can be read at all.
pub(crate) fn read<T: DeserializeOwned>(
    text: &str,
    schema: &Value,
    findings: &mut Findings<'_>,
) -> Option<T> {
    let (mut document, errors) = DeTable::parse_recoverable(text);
    let mut readable = true;
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
            findings.error("machine-syntax", &span, message, None);
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
