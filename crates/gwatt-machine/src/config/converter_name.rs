//! Converters by their names.

use super::findings::Findings;
use super::value::At;
use crate::model::Converter;

/// The converter of that name.
pub(super) fn converter_of(
    findings: &mut Findings<'_>,
    name: &At<String>,
    converters: &[Converter],
) -> Option<usize> {
    let found = converters.iter().position(|other| other.name == name.value);
    if found.is_none() {
        let message = format!("no converter is named \"{}\"", name.value);
        findings.error("machine-load", &name.span, message, None);
    }
    found
}
