//! JSON Schema of the files, made from the same structs that read them.

use std::sync::LazyLock;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

use super::controller_file::ControllerFile;
use super::machine_file::MachineFile;

/// JSON Schema of a machine file.
#[must_use]
pub fn schema() -> Value {
    MACHINE.clone()
}

/// JSON Schema of a controller profile.
#[must_use]
pub fn controller_schema() -> Value {
    CONTROLLER.clone()
}

// Made once: it takes longer than reading a file with it.
pub(super) static MACHINE: LazyLock<Value> = LazyLock::new(of::<MachineFile>);
pub(super) static CONTROLLER: LazyLock<Value> = LazyLock::new(of::<ControllerFile>);

/// The schema of `T`, all in one piece: the structure check walks along it.
fn of<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
    let mut schema = settings
        .into_generator()
        .into_root_schema_for::<T>()
        .to_value();
    remove_null(&mut schema);
    list_words(&mut schema);
    schema
}

/// TOML has no null: an optional field is there with its type, or not there.
fn remove_null(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if let Some(Value::Array(types)) = map.get_mut("type") {
                types.retain(|name| name != "null");
                if types.len() == 1 {
                    let only = types.remove(0);
                    map.insert("type".to_owned(), only);
                }
            }
            if let Some(Value::Array(values)) = map.get_mut("enum") {
                values.retain(|value| !value.is_null());
            }
            if let Some(Value::Array(options)) = map.get_mut("anyOf") {
                options.retain(|option| option.get("type").is_none_or(|name| name != "null"));
                if options.len() == 1
                    && let Value::Object(only) = options.remove(0)
                {
                    map.remove("anyOf");
                    // A field's own description is nearer than its type's.
                    for (key, value) in only {
                        map.entry(key).or_insert(value);
                    }
                }
            }
            map.values_mut().for_each(remove_null);
        }
        Value::Array(list) => list.iter_mut().for_each(remove_null),
        _ => {}
    }
}

/// Words with a description each come as a list of constants: next to them,
/// the plain list of words that the structure check looks for.
fn list_words(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            let words: Option<Vec<Value>> =
                map.get("oneOf").and_then(Value::as_array).map(|list| {
                    list.iter()
                        .filter_map(|word| word.get("const").cloned())
                        .collect()
                });
            if let Some(words) = words.filter(|words| !words.is_empty()) {
                map.entry("type").or_insert_with(|| "string".into());
                map.entry("enum").or_insert_with(|| words.into());
            }
            map.values_mut().for_each(list_words);
        }
        Value::Array(list) => list.iter_mut().for_each(list_words),
        _ => {}
    }
}
