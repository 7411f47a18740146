//! Mode shapes as a page animates them, and a study of modes as a table.
//!
//! Knows which bridge is meant. Does not know how modes are found.

use super::packed::Packed;
use pontoon_core::analysis::modes::shapes;
use pontoon_core::bridge::{Bridge, Ends, PreparedModule};
use pontoon_plan::job::{Job, Task};
use pontoon_plan::study_file::ModelSpec;
use pontoon_results::{Results, TableName};
use pontoon_study::modes::ModesError;
use serde::Serialize;

/// Bridges of a study of modes whose shapes are shown.
const MOST_BRIDGES: usize = 4;

/// Motions that nothing restores, of a bridge floating free, and the frequency below which a mode is one `[Hz]`: there is
/// nothing to see in them.
const RIGID: usize = 3;
const UNRESTORED_HZ: f64 = 1e-3;

/// Rows of modes that a page lists.
const MOST_ROWS: usize = 2_000;

/// Modes of one bridge.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeSet {
    /// Which bridge, and how it is held.
    pub label: String,
    /// The modes.
    pub list: Vec<ModeShape>,
}

/// A mode and the motion of its modules' corners.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeShape {
    /// Its number, from 1.
    pub number: usize,
    /// Natural frequency `[Hz]`.
    pub frequency_hz: f64,
    /// Name of its shape.
    pub shape: String,
    /// Motion along, across and up of the eight corners of each module, in the order of
    /// [`pontoon_core::analysis::modes::shapes`].
    pub motion: Packed,
}

/// A row of the table of modes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeLine {
    /// The job.
    pub job: u32,
    /// Its axes in words.
    pub axes: String,
    /// Number of the mode.
    pub number: u32,
    /// Natural frequency `[Hz]`.
    pub frequency_hz: f64,
    /// Name of its shape.
    pub shape: String,
}

/// Shapes of the first job's bridge floating free; of a study of modes those that its first jobs ask for. Notes say which
/// could not be found.
pub(super) fn mode_sets(
    all: &[Job],
    results: &Results,
    row_label: &dyn Fn(usize) -> String,
    most: usize,
) -> (Vec<ModeSet>, Vec<String>) {
    let (mut sets, mut notes) = (Vec::new(), Vec::new());
    let of_modes = all.first().is_some_and(|job| job.task == Task::Modes);
    for job in all.iter().take(if of_modes { MOST_BRIDGES } else { 1 }) {
        let (ends, model, count) = match job.as_modes() {
            Some(asked) => {
                let ends = if asked.supports { Ends::Supported } else { Ends::Free };
                (ends, asked.model, asked.count)
            }
            None => (Ends::Free, ModelSpec::SuperElement, most),
        };
        let held = if ends == Ends::Free {
            "floating free"
        } else {
            "on its supports"
        };
        let row = results.row_of_job(job.number as u64);
        let label = match row.map(row_label).filter(|axes| of_modes && !axes.is_empty()) {
            Some(axes) => format!("{held}: {axes}"),
            None => held.to_owned(),
        };
        let restored = |shape: &ModeShape| of_modes || shape.frequency_hz > UNRESTORED_HZ;
        match found(job, ends, model, count.min(most) + if of_modes { 0 } else { RIGID }) {
            Ok(list) => sets.push(ModeSet {
                label,
                list: list.into_iter().filter(restored).take(most).collect(),
            }),
            Err(reason) => notes.push(format!("No mode shapes, {label}: {reason}.")),
        }
    }
    (sets, notes)
}

fn found(job: &Job, ends: Ends, model: ModelSpec, count: usize) -> Result<Vec<ModeShape>, ModesError> {
    let design = &job.shared.bridge.design;
    let modules = PreparedModule::of_kinds(design, model.into())?;
    let bridge = Bridge::of_kinds(design, &modules, ends)?;
    let found = shapes(&bridge, count.min(bridge.dofs()))?;
    let shape = |(number, (mode, corners)): (usize, (_, Vec<[f64; 3]>))| {
        let mode: pontoon_core::analysis::modes::Mode = mode;
        ModeShape {
            number,
            frequency_hz: mode.frequency_hz,
            shape: mode.name,
            motion: Packed::F32(corners.iter().flatten().map(|x| *x as f32).collect()),
        }
    };
    Ok((1..).zip(found).map(shape).collect())
}

/// The table of modes, as far as a page lists it.
pub(super) fn mode_table(results: &Results, row_label: &dyn Fn(usize) -> String) -> Vec<ModeLine> {
    let Some(table) = results.table(TableName::Modes) else {
        return Vec::new();
    };
    let line = |row: usize| {
        let whole = |column: &str| table.number(column, row).map_or(u32::MAX, |x| x as u32);
        let job = whole("job");
        Some(ModeLine {
            job,
            axes: results.row_of_job(u64::from(job)).map(row_label).unwrap_or_default(),
            number: whole("number"),
            frequency_hz: table.number("frequency_hz", row)?,
            shape: table.cell("shape", row).text(),
        })
    };
    (0..table.rows()).take(MOST_ROWS).filter_map(line).collect()
}
