//! Words for messages: names of types, suggestions, and what a number out of
//! range was probably meant to be.

use serde_json::Value;
use toml::de::DeValue;

/// The number in a TOML value; `None` if there is none.
pub(crate) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|number| number as f64),
        _ => None,
    }
}

/// A schema type in plain words.
pub(crate) fn type_name(name: &str) -> &'static str {
    match name {
        "object" => "a table",
        "array" => "a list",
        "number" => "a number",
        "integer" => "a whole number",
        "string" => "text in quotes",
        "boolean" => "true or false",
        _ => "something else",
    }
}

/// What stands there, in plain words.
pub(crate) fn found_name(expected: &str, value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::Float(_) if expected == "integer" => "one with a decimal point",
        DeValue::Table(_) => "a table",
        DeValue::Array(_) => "a list",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::String(_) => "text",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
    }
}

/// What to do about a value of the wrong type.
pub(crate) fn wrong_type(expected: &str, found: &DeValue<'_>) -> Option<String> {
    match (expected, found) {
        ("number" | "integer", DeValue::String(text)) if text.trim().parse::<f64>().is_ok() => {
            Some(format!("write it without quotes: {}", text.trim()))
        }
        ("number" | "integer", DeValue::String(_)) => Some(
            "write a number alone, without quotes: its unit is that at the end of the name"
                .to_owned(),
        ),
        ("array", DeValue::Table(_)) => Some("write its header in double brackets".to_owned()),
        ("array", DeValue::String(text)) => Some(format!("write it as a list: [\"{text}\"]")),
        ("string", DeValue::Integer(_) | DeValue::Float(_) | DeValue::Boolean(_)) => {
            Some("write it in quotes".to_owned())
        }
        _ => None,
    }
}

/// How to write a table, or a list of tables, that `schema` describes.
pub(crate) fn example(schema: &Value) -> Option<String> {
    let is_list = schema["type"] == "array";
    let table = if is_list { &schema["items"] } else { schema };
    let required = table["required"].as_array()?.iter();
    let keys: Vec<String> = required
        .filter_map(|key| Some(format!("{} = …", key.as_str()?)))
        .collect();
    let entry = format!("{{ {} }}", keys.join(", "));
    match (keys.is_empty(), is_list) {
        (true, _) => None,
        (false, true) => Some(format!("write it as [{entry}, …]")),
        (false, false) => Some(format!("write it as {entry}")),
    }
}

/// What a number out of range was probably meant to be.
pub(crate) fn out_of_range(name: &str, number: f64) -> Option<String> {
    let percent = || format!("in percent? {number} % is {}", number / 100.0);
    match name {
        "efficiency"
        | "margin"
        | "min_feed_ratio"
        | "friction_min_ratio"
        | "mass_error"
        | "friction_error"
        | "velocity_feedforward"
        | "acceleration_feedforward"
            if number >= 1.0 =>
        {
            Some(percent())
        }
        "rapid" if number > 100.0 => {
            Some("the rapids' own speed is 100 %; no override exceeds it".to_owned())
        }
        "feed" | "spindle" | "rapid" if number > 0.0 => {
            Some(format!("as a factor? {number} is {} %", number * 100.0))
        }
        "servo_factor_motor" | "servo_factor_regen" => {
            Some("1 means: real acceleration is the commanded one".to_owned())
        }
        _ => None,
    }
}

/// The candidate that is nearest to `word`, if one is near.
pub(crate) fn closest<'c>(
    word: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    let word = word.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| {
            (
                strsim::jaro_winkler(&word, &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(likeness, _)| *likeness > 0.8)
        // The first of equals, so that the answer does not depend on chance.
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map(|(_, candidate)| candidate)
}

/// `did you mean "…"?`, if a candidate is near.
pub(crate) fn did_you_mean<'c>(
    word: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<String> {
    closest(word, candidates).map(|close| format!("did you mean \"{close}\"?"))
}

/// `"a", "b" or "c"`.
pub(crate) fn alternatives(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// The keys of a table, for a message; a long list helps nobody.
pub(crate) fn keys(known: &serde_json::Map<String, Value>) -> String {
    if known.len() > 16 {
        return "`gwatt machine schema` lists the keys".to_owned();
    }
    let names: Vec<&str> = known.keys().map(String::as_str).collect();
    format!("known here: {}", names.join(", "))
}

/// The table of the file in which a key is known.
pub(crate) fn elsewhere(name: &str, root: &Value) -> Option<String> {
    let tables = root["properties"].as_object()?;
    tables
        .iter()
        .find(|(_, table)| holds(table, name))
        .map(|(table, _)| format!("`{name}` belongs to `{table}`"))
}

/// Whether a schema, or one inside it, has the key.
fn holds(schema: &Value, name: &str) -> bool {
    let inside = |value: &Value| {
        value
            .as_object()
            .is_some_and(|map| map.contains_key(name) || map.values().any(|next| holds(next, name)))
    };
    let any = |key: &str| {
        schema[key]
            .as_array()
            .is_some_and(|list| list.iter().any(|next| holds(next, name)))
    };
    inside(&schema["properties"]) || any("anyOf") || holds_items(schema, name)
}

fn holds_items(schema: &Value, name: &str) -> bool {
    !schema["items"].is_null() && holds(&schema["items"], name)
}

/// The first paragraph of a description as one line without a full stop.
pub(crate) fn first_line(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or(text);
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    line.trim_end_matches('.').to_owned()
}
