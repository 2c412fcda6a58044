//! JSON schemas of what is printed as JSON.

use schemars::JsonSchema;

/// The schema that all values of a type follow, indented, with a final line feed.
pub(crate) fn of<T: JsonSchema>() -> serde_json::Result<String> {
    let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
    let schema = settings.into_generator().into_root_schema_for::<T>();
    Ok(serde_json::to_string_pretty(&schema)? + "\n")
}
