//! `pontoon status`: how far runs have come.

use crate::args::{Common, Format, StatusArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_plan::input::Cell;
use pontoon_study::sweep::{Standings, standings};
use serde_json::{Value, json};

/// Says how far the runs of folders have come.
pub(crate) fn status(arguments: &StatusArguments, common: Common) -> Result<ExitStatus> {
    let all = standings(&arguments.folders)?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", object(&all)),
        _ => text(&all),
    })?;
    Ok(ExitStatus::Good)
}

fn object(all: &Standings) -> Value {
    let folder = |(path, standing): &(std::path::PathBuf, _)| {
        let mut of = json!(standing);
        of["folder"] = path.display().to_string().into();
        of
    };
    json!({
        "jobs": all.jobs, "done": all.done, "failed": all.failed, "missing": all.missing,
        "shards_missing": all.shards_missing, "folders": all.folders.iter().map(folder).collect::<Vec<_>>()
    })
}

fn text(all: &Standings) -> String {
    let columns = ["folder", "study", "shard", "jobs", "done", "failed", "missing", "state"].map(str::to_owned);
    let rows: Vec<Vec<Cell<'_>>> = all
        .folders
        .iter()
        .map(|(path, s)| {
            vec![
                Cell::Word(path.to_string_lossy()),
                s.study.as_str().into(),
                s.shard.as_deref().into(),
                s.jobs.into(),
                s.done.into(),
                s.failed.into(),
                s.missing.into(),
                s.state.as_str().into(),
            ]
        })
        .collect();
    let mut text = text::table(&columns, &rows);
    if rows.len() > 1 {
        text += &format!(
            "\njobs {}, done {}, failed {}, missing {}\n",
            all.jobs, all.done, all.failed, all.missing
        );
    }
    if !all.shards_missing.is_empty() {
        text += &format!("no folder of the shards {}\n", all.shards_missing.join(", "));
    }
    text
}
