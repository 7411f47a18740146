//! `pontoon export`: mode shapes, static cases and crossings as VTK files.

use crate::args::{Common, ConnectionArgument, ExportArguments, Format};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_plan::input::{Cell, Refusal};
use pontoon_results::labels;
use pontoon_study::modes::BridgeError;
use pontoon_view::export::{ExportError, Exported, LoadRequest, Part, Request, export as write};
use serde_json::json;

/// Writes what is asked for and says which files to open.
pub(crate) fn export(arguments: &ExportArguments, common: Common) -> Result<ExitStatus> {
    let request = Request {
        count: arguments.count.map(usize::from),
        supports: arguments.supports,
        load: arguments.load_n.map(|load_n| LoadRequest {
            load_n,
            load_x_m: arguments.load_x_m,
            load_position: arguments.load_position,
            linear: arguments.connection == Some(ConnectionArgument::Linear),
            gap_tension_m: arguments.gap_tension_m,
            gap_compression_m: arguments.gap_compression_m,
        }),
        job: arguments.job,
        every: arguments.every,
        stresses: arguments.stresses,
    };
    let note = |what: &str| {
        if !common.quiet {
            text::note(what);
        }
    };
    let exported = write(&arguments.source, &arguments.to, &request, &note).map_err(|error| match error {
        ExportError::Refused(refused) => anyhow::Error::from(refused),
        ExportError::Results(error) => error.into(),
        ExportError::Bridge(BridgeError::Design(refused)) => Refusal::of(&arguments.source, "", refused).into(),
        other => other.into(),
    })?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(exported)),
        _ => text(&exported, &arguments.to.display().to_string()),
    })?;
    Ok(ExitStatus::Good)
}

fn text(exported: &Exported, to: &str) -> String {
    let columns = ["file", "instants", "points", "cells", "shows"].map(str::to_owned);
    let row = |part: &'_ Part| {
        vec![
            Cell::Word(part.file.clone().into()),
            part.instants.into(),
            part.points.into(),
            part.cells.into(),
            Cell::Word(part.shows.clone().into()),
        ]
    };
    let rows: Vec<Vec<Cell<'_>>> = exported.parts.iter().map(row).collect();
    format!(
        "{}{} in {to}\n",
        text::table(&columns, &rows),
        labels::counted(exported.files, "file")
    )
}
