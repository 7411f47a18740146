//! `pontoon explain`: why a job ran or will run.

use crate::args::{Common, ExplainArguments, Format};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_study::sweep::{Explanation, explain as explain_job};
use serde_json::json;

/// Explains a job.
pub(crate) fn explain(arguments: &ExplainArguments, common: Common) -> Result<ExitStatus> {
    let told = explain_job(&arguments.folder, arguments.job)?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(told)),
        _ => text(&told),
    })?;
    Ok(ExitStatus::Good)
}

fn text(told: &Explanation) -> String {
    let mut lines = vec![
        ("job", told.job.to_string()),
        ("state", told.state.to_owned()),
        ("why", told.why.clone()),
    ];
    let failure = told.failure.as_ref().map(|failure| failure.kind.word().to_owned());
    lines.extend(failure.map(|kind| ("failure", kind)));
    lines.extend(told.reason.clone().map(|reason| ("reason", reason)));
    lines.extend(told.axes.iter().map(|(name, value)| (name.as_str(), value.to_string())));
    lines.push(("steps", told.steps.to_string()));
    lines.extend(told.shard.clone().map(|shard| ("shard", shard)));
    if told.deaths > 0 {
        lines.push(("deaths", told.deaths.to_string()));
    }
    lines.extend(told.recorded.clone().map(|when| ("recorded", when)));
    lines.extend(told.by.clone().map(|by| ("by", by)));
    lines.extend(told.file.as_ref().map(|file| ("file", file.display().to_string())));
    lines.push(("key", told.key.clone()));
    let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
    lines
        .iter()
        .map(|(name, value)| format!("{name:<width$}  {}\n", text::printable(value)))
        .collect()
}
