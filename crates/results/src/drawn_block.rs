//! Designs of tests: their blocks and points.
//!
//! Knows how a design is read from its document. Does not know what is estimated.

use pontoon_plan::design::{Axis, Block, Design};
use pontoon_plan::input::{Cell, typed_value};
use serde_json::{Value, json};
use std::path::Path;

/// The block of a design, and the numbers of its points.
pub(super) fn drawn_block(design: &Value) -> (Block, Vec<Vec<f64>>) {
    let file = Path::new("study.json");
    let designs: Vec<Design> = typed_value(file, "design", &json!([design])).unwrap();
    let block = Block::read(file, &designs, &[]).unwrap().remove(0);
    let number = |(_, cell): (&Axis, &Cell<'_>)| cell.number().unwrap();
    let points = block
        .points()
        .map(|point| point.values().map(number).collect())
        .collect();
    (block, points)
}
