//! `pontoon modes`: natural frequencies with the name of each shape.

use crate::args::{Common, Format, ModesArguments};
use crate::exit_status::ExitStatus;
use crate::terminal::TextStyle;
use crate::text;
use anyhow::Result;
use pontoon_plan::input::{Cell, Refusal};
use pontoon_plan::study_file::read_bridge;
use pontoon_results::{Column, TableName, When};
use pontoon_study::modes::{ModesError, ModesRequest, modes as find};
use serde_json::json;
use unicode_width::UnicodeWidthStr;

/// Finds the lowest modes of a bridge file.
pub(crate) fn modes(arguments: &ModesArguments, common: Common) -> Result<ExitStatus> {
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
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(found)),
        _ => {
            // there is one job: its number says nothing
            let columns: Vec<&Column> = Column::of_table(TableName::Modes)
                .filter(|column| column.name != "job")
                .filter(|column| column.when != When::ModesInWaves || file.design.water.is_some())
                .collect();
            let names: Vec<String> = columns.iter().map(|column| column.name.to_owned()).collect();
            let row = |mode| columns.iter().map(|column| column.of_mode(mode)).collect();
            fitting(&names, &found.iter().map(row).collect::<Vec<_>>())
        }
    })?;
    Ok(ExitStatus::Good)
}

/// The table with as many of its shares as a terminal has room for.
fn fitting(columns: &[String], rows: &[Vec<Cell<'_>>]) -> String {
    let table = |columns: &[String]| text::table(columns, rows);
    let fits = |table: &String| {
        let width = TextStyle::of_results().width;
        width.is_none_or(|width| table.lines().all(|line| line.width() <= width))
    };
    let fewer = (3..=columns.len()).rev().map(|count| table(&columns[..count]));
    fewer.into_iter().find(fits).unwrap_or_else(|| table(&columns[..3]))
}
