//! A study as a table of classes asks it: one crossing a cell, for each type of crossing.
//!
//! Knows which axes a table of classes adds to designs. Does not know vehicles or limits.

use super::raw::Kind;
use crate::design::{CROSSING_TYPES, NORMAL_SPEEDS_M_S};
use crate::input::{Document, FoundValue, Refusal, RefusalKind, canonical_text};
use serde_json::{Value, json};
use std::path::Path;

/// What a type of crossing is, and a speed.
const TYPE: &str = "crossing_type";
const SPEED: &str = "speed_m_s";

/// The document with the axes that a table of classes needs; what a rating searches is left out.
pub(super) fn rated(file: &Path, document: &Document) -> Result<Document, Refusal> {
    let mut value = document.value();
    let Some(keys) = value.as_object_mut() else {
        return Ok(document.clone());
    };
    if !keys.contains_key("limits") {
        return Err(Refusal::missing(file, "limits"));
    }
    if let Some(name) = keys
        .get("name")
        .and_then(Value::as_str)
        .map(|name| format!("{name}_classes"))
    {
        keys.insert("name".to_owned(), name.into());
    }
    keys.shift_remove("find");
    let kind = keys.get_mut("analysis").and_then(|analysis| analysis.get_mut("kind"));
    if let Some(kind) = kind.filter(|kind| **kind == json!(Kind::Rating)) {
        *kind = json!(Kind::Crossing);
    }
    let designs = keys.get_mut("design").and_then(Value::as_array_mut);
    for (number, design) in designs.into_iter().flatten().enumerate() {
        let Some(design) = design.as_object_mut() else { continue };
        let Some(grid) = design.get_mut("grid").and_then(Value::as_object_mut) else {
            let found = FoundValue::from("a design of another form");
            let refused = Refusal::new(
                file,
                format!("design[{number}]"),
                found,
                "a grid, to which types of crossings are added",
            );
            return Err(refused.because(RefusalKind::Misplaced));
        };
        grid.entry(TYPE).or_insert_with(|| json!(CROSSING_TYPES));
        grid.entry(SPEED).or_insert_with(|| json!(NORMAL_SPEEDS_M_S));
    }
    Document::parse(file, &canonical_text(&value))
}
