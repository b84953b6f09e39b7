//! The JSON Schema knows what the reader knows.

use gwatt::machine::{controller_schema, schema};

#[test]
fn names_required_keys_and_ranges() {
    let schema = schema();
    let required: Vec<&str> = schema["required"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|v| v.as_str())
        .collect();
    assert_eq!(
        required,
        ["schema", "name", "controller", "converter", "axes"]
    );
    let axis = &schema["properties"]["axes"]["properties"]["X"]["properties"];
    assert_eq!(axis["mass_kg"]["type"], "number");
    assert_eq!(axis["mass_kg"]["exclusiveMinimum"], 0.0);
    assert_eq!(axis["efficiency"]["maximum"], 1.0);
    assert_eq!(
        axis["kind"]["enum"],
        serde_json::json!(["linear", "rotary"])
    );
    assert_eq!(schema["properties"]["axes"]["additionalProperties"], false);
    let text = schema.to_string() + &controller_schema().to_string();
    assert!(
        !text.contains("\"null\"") && !text.contains("$ref"),
        "{text}"
    );
}

#[test]
fn every_field_of_a_machine_is_described() {
    fn walk(schema: &serde_json::Value, path: &str) {
        for (key, value) in schema["properties"].as_object().into_iter().flatten() {
            let here = format!("{path}.{key}");
            let axis_letter = key.len() == 1;
            assert!(
                axis_letter || value["description"].is_string(),
                "{here} is not described"
            );
            walk(value, &here);
            walk(&value["items"], &here);
            value["anyOf"]
                .as_array()
                .into_iter()
                .flatten()
                .for_each(|option| walk(option, &here));
        }
    }
    walk(&schema(), "");
    walk(&controller_schema(), "");
}
