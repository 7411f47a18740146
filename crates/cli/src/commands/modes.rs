//! `pontoon modes`: natural frequencies with the name of each shape.

use crate::args::{Common, Format, ModesArguments};
use crate::ending::Ending;
use crate::terminal::Look;
use crate::words;
use anyhow::Result;
use pontoon_plan::input::Refusal;
use pontoon_plan::study_file::read_bridge;
use pontoon_study::modes::{ModesError, ModesRequest, modes as find};
use serde_json::{Value, json};
use unicode_width::UnicodeWidthStr;

/// Finds the lowest modes of a bridge file.
pub(crate) fn modes(arguments: &ModesArguments, common: Common) -> Result<Ending> {
    let file = read_bridge(&arguments.bridge)?;
    let request = ModesRequest {
        model: arguments.model.into(),
        count: usize::from(arguments.count),
        supports: arguments.supports,
        module: arguments.module,
    };
    let found = find(&file, request).map_err(|error| match error {
        ModesError::Bridge(pontoon_study::modes::BridgeError::Design(refused)) => {
            anyhow::Error::from(Refusal::of(&file.file, "", refused))
        }
        other => other.into(),
    })?;
    words::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(found)),
        _ => {
            let columns = [
                "number",
                "frequency_hz",
                "shape",
                "vertical_share",
                "torsion_share",
                "horizontal_share",
                "axial_share",
            ];
            let row = |mode: &Value| columns.iter().map(|column| mode[column].clone()).collect();
            let rows: Vec<Vec<Value>> = found.iter().map(|mode| row(&json!(mode))).collect();
            fitting(&columns.map(str::to_owned), &rows)
        }
    })?;
    Ok(Ending::Good)
}

/// The table with as many of its shares as a terminal has room for.
fn fitting(columns: &[String], rows: &[Vec<Value>]) -> String {
    let table = |columns: &[String]| words::table(columns, rows);
    let fits = |table: &String| {
        let width = Look::of_results().width;
        width.is_none_or(|width| table.lines().all(|line| line.width() <= width))
    };
    let fewer = (3..=columns.len()).rev().map(|count| table(&columns[..count]));
    fewer.into_iter().find(fits).unwrap_or_else(|| table(&columns[..3]))
}
