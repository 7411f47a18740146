//! `pontoon rate`: which vehicle may cross how.

use super::run::sweep_of;
use crate::args::{Common, Format, RateArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_plan::input::{Cell, Refusal};
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::Study;
use pontoon_results::Results;
use pontoon_view::class_table::ClassTable;
use serde_json::json;

/// Runs one crossing a cell, and prints the table.
pub(crate) fn rate(arguments: &RateArguments, common: Common) -> Result<ExitStatus> {
    let study = Study::open_rated(&arguments.study)?;
    let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
    let (out, good) = sweep_of(&study, &jobs, arguments, common)?;
    let results = Results::read(&out)?;
    let Some(table) = ClassTable::of(&results) else {
        return Ok(ExitStatus::Short);
    };
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!({ "results": out, "table": table })),
        _ => format!("{}\nresults in {}\n", written(&table), out.display()),
    })?;
    Ok(if good { ExitStatus::Good } else { ExitStatus::Short })
}

fn written(table: &ClassTable) -> String {
    let names: Vec<String> = table.names.iter().chain(&table.heads).cloned().collect();
    let cells = |line: Vec<String>| line.into_iter().map(|cell| Cell::Word(cell.into())).collect();
    let rows: Vec<Vec<Cell<'_>>> = table.lines().map(cells).collect();
    format!("{}\n\n{}", ClassTable::LEGEND, text::table(&names, &rows))
}
