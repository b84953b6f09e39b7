//! Checks a file's tree against the schema and takes out what does not fit,
//! so that the rest can be read and checked further.

use std::ops::Range;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::findings::Findings;
use super::hints;

/// The axis letters as keys: an unknown one gets its own message.
const AXIS_KEYS: &str = "X, Y, Z, A, B, C, U, V, W or E";

/// Walks a tree along a schema.
pub(crate) struct Structure<'a, 'f> {
    findings: &'f mut Findings<'a>,
    root: &'f Value,
}

impl<'a, 'f> Structure<'a, 'f> {
    /// A walk along `root`.
    pub(crate) fn new(findings: &'f mut Findings<'a>, root: &'f Value) -> Self {
        Self { findings, root }
    }

    /// Checks the whole file.
    pub(crate) fn check(&mut self, document: &mut DeTable<'_>) {
        let root = self.root;
        self.table(document, &(0..0), root, "");
    }

    /// Checks a table; `header` is where a missing key is reported.
    fn table(
        &mut self,
        table: &mut DeTable<'_>,
        header: &Range<usize>,
        schema: &Value,
        path: &str,
    ) {
        let empty = serde_json::Map::new();
        let known = schema["properties"].as_object().unwrap_or(&empty);
        for (key, mut value) in std::mem::replace(table, DeTable::new()) {
            let name = key.get_ref().as_ref();
            let here = join(path, name);
            // Of a table whose keys are free the values are known.
            let free = Some(&schema["additionalProperties"]).filter(|it| it.is_object());
            let fits = if let Some(schema) = known.get(name).or(free) {
                self.value(&mut value, schema, name, &here)
            } else {
                self.unknown(name, &key.span(), known, path);
                false
            };
            if fits {
                table.insert(key, value);
            } else {
                self.findings.refuse(here);
            }
        }
        for name in schema["required"].as_array().into_iter().flatten() {
            let Some(name) = name.as_str() else { continue };
            if !table.contains_key(name) && !self.findings.is_refused(&join(path, name)) {
                self.missing(name, header, known, path);
            }
        }
    }

    /// Checks a value; false: it has to go.
    fn value(
        &mut self,
        value: &mut Spanned<DeValue<'_>>,
        schema: &Value,
        name: &str,
        path: &str,
    ) -> bool {
        let span = value.span();
        if let Some(options) = schema["anyOf"].as_array() {
            return self.one_or_many(value, options, name, path);
        }
        match (schema["type"].as_str(), value.get_mut()) {
            (Some("object"), DeValue::Table(table)) => {
                self.table(table, &span, schema, path);
                true
            }
            (Some("array"), DeValue::Array(list)) => {
                self.list(list, &span, schema, name, path);
                true
            }
            (Some("number"), number @ (DeValue::Integer(_) | DeValue::Float(_))) => {
                self.number(number, &span, schema, name)
            }
            (Some("integer"), DeValue::Integer(number)) => {
                let fits = u32::from_str_radix(number.as_str(), number.radix()).is_ok();
                if !fits {
                    let message = format!("`{name}` is out of range");
                    self.findings.error("machine-range", &span, message, None);
                }
                fits
            }
            (Some("string"), DeValue::String(text)) => self.word(text, &span, schema, name),
            (Some("boolean"), DeValue::Boolean(_)) => true,
            (expected, found) => {
                let expected = expected.unwrap_or("");
                let entry = if path.ends_with(name) {
                    ""
                } else {
                    "an entry of "
                };
                let message = format!(
                    "{entry}`{name}` must be {}, not {}",
                    hints::type_name(expected),
                    hints::found_name(expected, found)
                );
                let help = hints::wrong_type(expected, found).or_else(|| hints::example(schema));
                self.findings.error("machine-type", &span, message, help);
                false
            }
        }
    }

    /// A value or a list of them: a single one is put into a list.
    fn one_or_many(
        &mut self,
        value: &mut Spanned<DeValue<'_>>,
        options: &[Value],
        name: &str,
        path: &str,
    ) -> bool {
        let is_list = matches!(value.get_ref(), DeValue::Array(_));
        let wanted = options
            .iter()
            .find(|option| (option["type"] == "array") == is_list);
        let Some(wanted) = wanted else { return false };
        if !self.value(value, wanted, name, path) {
            return false;
        }
        if !is_list {
            let span = value.span();
            let mut list = DeArray::new();
            let single = std::mem::replace(value.get_mut(), DeValue::Boolean(false));
            list.push(Spanned::new(span, single));
            *value.get_mut() = DeValue::Array(list);
        }
        true
    }

    fn list(
        &mut self,
        list: &mut DeArray<'_>,
        span: &Range<usize>,
        schema: &Value,
        name: &str,
        path: &str,
    ) {
        if list.is_empty() && schema["minItems"].as_u64().unwrap_or(0) > 0 {
            let message = format!("`{name}` is empty");
            self.findings.error("machine-missing", span, message, None);
        }
        let old = std::mem::replace(list, DeArray::new());
        for (index, mut item) in old.into_iter().enumerate() {
            let here = join(path, &index.to_string());
            if self.value(&mut item, &schema["items"], name, &here) {
                list.push(item);
            } else {
                self.findings.refuse(path.to_owned());
            }
        }
    }

    /// Checks a number; one that is only out of range stays, so that the rest
    /// of its table is checked with it.
    fn number(
        &mut self,
        value: &DeValue<'_>,
        span: &Range<usize>,
        schema: &Value,
        name: &str,
    ) -> bool {
        let Some(number) = hints::number(value).filter(|number| number.is_finite()) else {
            let message = format!("`{name}` must be a finite number");
            self.findings.error("machine-range", span, message, None);
            return false;
        };
        if let Some(fault) = beyond_computing(number) {
            let message = format!("`{name}` {fault}");
            self.findings.error("machine-range", span, message, None);
            return false;
        }
        if let Some(range) = out_of_range(number, schema) {
            let message = format!("`{name}` must be {range}, but is {number}");
            let help = hints::out_of_range(name, number);
            self.findings.error("machine-range", span, message, help);
        }
        true
    }

    /// Checks a text; only some words may be permitted.
    fn word(&mut self, text: &str, span: &Range<usize>, schema: &Value, name: &str) -> bool {
        let Some(words) = schema["enum"].as_array() else {
            return true;
        };
        let words: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
        if words.contains(&text) {
            return true;
        }
        let message = format!(
            "`{name}` must be {}, not \"{text}\"",
            hints::alternatives(&words)
        );
        let help = hints::did_you_mean(text, words.iter().copied());
        self.findings.error("machine-value", span, message, help);
        false
    }

    fn unknown(
        &mut self,
        name: &str,
        span: &Range<usize>,
        known: &serde_json::Map<String, Value>,
        path: &str,
    ) {
        if known.len() == 10 && known.contains_key("X") {
            let message = format!("`{name}` is not an axis letter");
            let upper = name.to_uppercase();
            let help = if known.contains_key(&upper) {
                self.findings.refuse(join(path, &upper));
                format!("in upper case: `{upper}`")
            } else {
                format!("an axis is {AXIS_KEYS}")
            };
            self.findings
                .error("machine-axis", span, message, Some(help));
            return;
        }
        let message = format!("unknown key `{name}`");
        let close = hints::closest(name, known.keys().map(String::as_str));
        let help = close
            .map(|close| format!("did you mean `{close}`?"))
            .or_else(|| hints::elsewhere(name, self.root))
            .or_else(|| Some(hints::keys(known)));
        if let Some(close) = close {
            // The key that was meant is not reported as missing too.
            self.findings.refuse(join(path, close));
        }
        self.findings
            .error("machine-unknown-key", span, message, help);
    }

    fn missing(
        &mut self,
        name: &str,
        header: &Range<usize>,
        known: &serde_json::Map<String, Value>,
        path: &str,
    ) {
        let place = match path.rsplit('.').find(|part| part.parse::<u32>().is_err()) {
            None | Some("") => "the file".to_owned(),
            Some(table) => format!("`{table}`"),
        };
        let message = format!("`{name}` is missing in {place}");
        let help = known
            .get(name)
            .and_then(|schema| schema["description"].as_str())
            .map(hints::first_line);
        self.findings
            .error("machine-missing", header, message, help);
    }
}

/// What is wrong with a number whose products and quotients with others may leave the range of
/// floating-point numbers. Quantities of machines are far from it, in any unit.
fn beyond_computing(number: f64) -> Option<&'static str> {
    const LARGEST: f64 = 1e30;
    let size = number.abs();
    if size > LARGEST || size > 0.0 && size < 1.0 / LARGEST {
        Some("is too large or too small to compute with")
    } else {
        None
    }
}

/// The range of a schema in words, if the number is outside.
fn out_of_range(number: f64, schema: &Value) -> Option<String> {
    let bound = |key: &str| schema[key].as_f64();
    if let Some(min) = bound("exclusiveMinimum").filter(|&min| number <= min) {
        return Some(format!("greater than {min}"));
    }
    if let Some(min) = bound("minimum").filter(|&min| number < min) {
        let words = if min == 0.0 {
            "0 or greater".to_owned()
        } else {
            format!("at least {min}")
        };
        return Some(words);
    }
    if let Some(max) = bound("exclusiveMaximum").filter(|&max| number >= max) {
        return Some(format!("less than {max}"));
    }
    bound("maximum")
        .filter(|&max| number > max)
        .map(|max| format!("at most {max}"))
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}
