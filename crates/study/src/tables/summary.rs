//! The summary: peaks against speed, a row a speed for each combination of the other axes; of a study of modes a row a mode.
//!
//! Knows the order of rows and how a cell is written. Does not know terminals.

use super::frames::axis_names;
use crate::modes::ModeRow;
use crate::plan::Job;
use crate::run::JobRecord;
use crate::spec::{Kind, Study};
use serde::Serialize;
use serde_json::Value;
use std::collections::HashMap;

/// A cell: a number, a word, or nothing.
pub type Cell = Value;

/// The summary of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SummaryTable {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
}

const PEAKS: [&str; 4] = [
    "peak_deflection_m",
    "peak_uplift_m",
    "peak_compression_n",
    "peak_tension_n",
];

impl SummaryTable {
    /// The summary of a run: combinations of the other axes in the order of their first job, speeds increasing. A job
    /// that failed has empty peaks.
    pub fn new(study: &Study, jobs: &[Job], records: &[JobRecord]) -> Self {
        if study.spec.analysis.kind == Kind::Modes {
            return Self::of_modes(study, jobs, records);
        }
        let (against, others): (Vec<String>, Vec<String>) =
            axis_names(study).into_iter().partition(|name| name == "speed_m_s");
        let mut groups: HashMap<String, usize> = HashMap::new();
        let mut rows: Vec<(usize, f64, Vec<Cell>)> = Vec::new();
        for (job, record) in jobs.iter().zip(records) {
            let mut cells: Vec<Cell> = others.iter().map(|name| job.column(name)).collect();
            let next = groups.len();
            let group = *groups.entry(Value::from(cells.clone()).to_string()).or_insert(next);
            let speed: Vec<Value> = against.iter().map(|name| job.column(name)).collect();
            let at = speed.first().and_then(Value::as_f64).unwrap_or_default();
            cells.extend(speed);
            let s = &record.summary;
            let peaks = [
                s.peak_deflection_m,
                s.peak_uplift_m,
                s.peak_compression_n,
                s.peak_tension_n,
            ];
            cells.extend(peaks.map(Value::from));
            rows.push((group, at, cells));
        }
        rows.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let columns = others
            .into_iter()
            .chain(against)
            .chain(PEAKS.map(str::to_owned))
            .collect();
        Self {
            columns,
            rows: rows.into_iter().map(|(_, _, cells)| cells).collect(),
        }
    }

    /// The summary of a study of modes: the axes, then number, frequency and shape of each mode.
    fn of_modes(study: &Study, jobs: &[Job], records: &[JobRecord]) -> Self {
        let axes = axis_names(study);
        let row = |job: &Job, mode: &ModeRow| -> Vec<Cell> {
            let of_mode = [mode.number.into(), mode.frequency_hz.into(), mode.shape.clone().into()];
            axes.iter().map(|name| job.column(name)).chain(of_mode).collect()
        };
        let all = jobs.iter().zip(records);
        let rows = all.flat_map(|(job, record)| record.modes.iter().map(|mode| row(job, mode)).collect::<Vec<_>>());
        Self {
            rows: rows.collect(),
            columns: [axes, ["number", "frequency_hz", "shape"].map(str::to_owned).to_vec()].concat(),
        }
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let line = |cells: &mut dyn Iterator<Item = String>| cells.collect::<Vec<_>>().join(",") + "\n";
        let mut text = line(&mut self.columns.iter().map(|name| quoted(name)));
        for row in &self.rows {
            text += &line(&mut row.iter().map(cell));
        }
        text
    }
}

fn cell(value: &Cell) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(word) => quoted(word),
        other => quoted(&other.to_string()),
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn csv_leaves_nulls_empty_and_quotes_lists() {
        let table = SummaryTable {
            columns: vec![
                "connection".to_owned(),
                "vehicle.track_y_m".to_owned(),
                "peak_deflection_m".to_owned(),
            ],
            rows: vec![
                vec![json!("linear"), json!([-1.4, 1.4]), json!(0.25)],
                vec![json!("linear"), json!([1]), json!(null)],
            ],
        };
        assert_eq!(
            table.csv(),
            "connection,vehicle.track_y_m,peak_deflection_m\nlinear,\"[-1.4,1.4]\",0.25\nlinear,[1],\n"
        );
    }
}
