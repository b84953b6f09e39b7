//! Parameter files of RS274/NGC ("Parameters", "Parameter File"): a number and
//! its value in each line, as the control writes them when it ends.

use std::collections::BTreeMap;

use super::tool_table::words;
use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::source::{Span, lines};

/// Largest number of a parameter.
const NUMBER_MAX: f64 = 5602.0;

/// Values of numbered parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParameterFile {
    values: BTreeMap<u32, f64>,
}

impl ParameterFile {
    /// Reads a parameter file.
    ///
    /// # Errors
    ///
    /// What is wrong, line by line.
    pub fn parse(bytes: &[u8]) -> Result<Self, Vec<Diagnostic>> {
        let mut values = BTreeMap::new();
        let mut errors = Vec::new();
        for (text, line) in lines(bytes).zip(1..) {
            if let Err(error) = entry(text, &mut values, line) {
                errors.push(*error);
            }
            if errors.len() >= 50 {
                break;
            }
        }
        if errors.is_empty() {
            Ok(Self { values })
        } else {
            Err(errors)
        }
    }

    /// The value of a parameter that the file has.
    #[must_use]
    pub fn get(&self, number: u32) -> Option<f64> {
        self.values.get(&number).copied()
    }

    /// All of them, in the order of their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.values.iter().map(|(number, value)| (*number, *value))
    }
}

fn entry(text: &[u8], values: &mut BTreeMap<u32, f64>, line: u64) -> Result<(), Box<Diagnostic>> {
    let error = |message: String, span: Span| {
        let found = Diagnostic::error("parameter-file", message).at(line, span, text);
        Box::new(found.help("write a number and its value in each line, as in `5221 12.5`"))
    };
    let mut words = words(text);
    let Some(first) = words.next() else {
        return Ok(());
    };
    let number = parse(first.of(text))
        .filter(|number| number.fract() == 0.0 && (1.0..=NUMBER_MAX).contains(number))
        .ok_or_else(|| error("this is no number of a parameter".to_owned(), first))?;
    let second = words.next();
    let value = second.and_then(|span| parse(span.of(text)));
    let value = value.ok_or_else(|| {
        let message = format!("parameter {number} without a value");
        error(message, second.unwrap_or(first))
    })?;
    if let Some(more) = words.next() {
        return Err(error("a parameter has one value".to_owned(), more));
    }
    if values.insert(number as u32, value).is_some() {
        let message = format!("parameter {number} is in the file twice");
        return Err(error(message, first));
    }
    Ok(())
}

fn parse(text: &[u8]) -> Option<f64> {
    let value: f64 = std::str::from_utf8(text).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_values() {
        let parameters = ParameterFile::parse(b"5221\t12.500000\r\n\n  5230 -30 ;turn\n").unwrap();
        assert_eq!(parameters.get(5221), Some(12.5));
        assert_eq!(parameters.get(5230), Some(-30.0));
        assert_eq!(parameters.get(5222), None);
        assert_eq!(parameters.iter().count(), 2);
    }

    #[test]
    fn each_error_once() {
        let message = |text: &str| {
            let errors = ParameterFile::parse(text.as_bytes()).unwrap_err();
            let found = errors.first().unwrap();
            format!("{}:{} {}", found.line, found.span.start, found.message)
        };
        assert_eq!(message("x 1"), "1:0 this is no number of a parameter");
        assert_eq!(message("0 1"), "1:0 this is no number of a parameter");
        assert_eq!(message("1\n5603 1"), "1:0 parameter 1 without a value");
        assert_eq!(message("5603 1"), "1:0 this is no number of a parameter");
        assert_eq!(message("31 inf"), "1:3 parameter 31 without a value");
        assert_eq!(message("31 1 2"), "1:5 a parameter has one value");
        assert_eq!(
            message("31 1\n31 2"),
            "2:0 parameter 31 is in the file twice"
        );
    }
}
