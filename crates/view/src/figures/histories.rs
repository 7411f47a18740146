//! Against time: what the recorded positions and joints did.
//!
//! Knows the table of histories. Does not know which jobs belong together.

use super::figure::{Figure, FigureLine, FigureMeasure, FigureMoment, FigurePanel, MomentKind};
use super::figure_context::{FigureContext, MarkRequest};
use super::marks::Chart;
use super::panels::{Split, by_speed, caption};
use super::series_group::series_groups;
use crate::thinning::thinned;
use pontoon_judge::quantity::{Along, moments_of};
use pontoon_results::{Table, TableName, labels};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// What was recorded: a quantity of a position or joint, of a pin at its place across.
type Channel = (String, u32, Option<u64>);

/// How a quantity is drawn: the stem of the figure's name, what it is called, its measure.
fn drawn(quantity: &str) -> Option<(&'static str, &'static str, FigureMeasure)> {
    Some(match quantity {
        "deflection_m" => ("deflection", "Deflection of position", FigureMeasure::DEFLECTION),
        "force_n" => ("force", "Force of the joint at position", FigureMeasure::FORCE),
        "pin_x_n" => (
            "pin-x",
            "Force along the bridge of a pin of joint",
            FigureMeasure::PIN_FORCE,
        ),
        "pin_y_n" => ("pin-y", "Force across of a pin of joint", FigureMeasure::PIN_FORCE),
        "pin_z_n" => ("pin-z", "Vertical force of a pin of joint", FigureMeasure::PIN_FORCE),
        "angle_rad" => ("angle", "Angle of joint", FigureMeasure::ANGLE),
        "bending_nm" => ("bending", "Bending moment of joint", FigureMeasure::BENDING),
        _ => return None,
    })
}

/// Rows of the table of histories by job and channel.
type Recorded = HashMap<(u64, Channel), Range<usize>>;

/// Arrivals closer than this are one `[s]`: a hundredth of a time step.
const SAME_ARRIVAL_S: f64 = 1e-4;

/// Figures of recorded histories: each channel by each group.
pub(super) fn histories(context: &mut FigureContext<'_>) -> Vec<Figure> {
    let Some(table) = context.results.table(TableName::Histories) else {
        return Vec::new();
    };
    let (channels, recorded) = recorded(context, table);
    let series_groups = series_groups(context, Some("speed_m_s"));
    let mut figures = Vec::new();
    for channel in &channels {
        let (quantity, position, across) = channel;
        let Some((stem, what, y)) = drawn(quantity) else {
            continue;
        };
        // pins of a joint by number, as a name has no sign and no point
        let pin = across.map(|across| {
            let others = channels.iter().filter(|of| (&of.0, of.1) == (quantity, *position));
            1 + others.take_while(|of| of.2 != Some(across)).count()
        });
        let pin_stem = pin.map(|pin| format!("-{pin}")).unwrap_or_default();
        let at = across.map(|across| format!(" at y {} m", labels::as_written(f64::from_bits(across))));
        let at = at.unwrap_or_default();
        for series_group in &series_groups {
            let name = series_group.name(&format!("{stem}-{position}{pin_stem}"));
            let (split, left_out) = by_speed(context, series_group, &name);
            let of = |split: &Split| panel(context, table, split, channel, y, &recorded);
            let panels: Vec<FigurePanel> = split.iter().map(of).filter(|panel| !panel.lines.is_empty()).collect();
            if panels.is_empty() {
                continue;
            }
            figures.push(Figure {
                caption: caption(
                    context,
                    series_group,
                    &format!("{what} {position}{at} against time"),
                    &panels,
                ),
                name,
                legend: series_group.legend(),
                panels,
                left_out: series_group.left_out.clone().into_iter().chain(left_out).collect(),
            });
        }
    }
    figures
}

/// What was recorded, in the order of the table.
fn recorded(context: &FigureContext<'_>, table: &Table) -> (Vec<Channel>, Recorded) {
    let columns = (
        table.numbers("job"),
        table.word_cells("quantity"),
        table.numbers("position"),
    );
    let across = table.numbers("y_m");
    let y_of = |row: usize| across.and_then(|across| across[row]).map(|y_m| (y_m + 0.0).to_bits());
    let (mut channels, mut found) = (Vec::new(), Recorded::new());
    let (Some(job), Some(quantity), Some(position)) = columns else {
        return (channels, found);
    };
    let jobs: BTreeSet<u64> = context.rows.iter().map(|row| context.job(*row)).collect();
    let mut start = 0;
    while start < table.rows() {
        let same = |row: &usize| {
            job[*row] == job[start]
                && quantity[*row] == quantity[start]
                && position[*row] == position[start]
                && y_of(*row) == y_of(start)
        };
        let end = (start..table.rows()).take_while(same).count() + start;
        if let (Some(job), Some(quantity), Some(position)) = (job[start], &quantity[start], position[start]) {
            let channel = (quantity.clone(), position as u32, y_of(start));
            if jobs.contains(&(job as u64)) {
                if !channels.contains(&channel) {
                    channels.push(channel.clone());
                }
                found.insert((job as u64, channel), start..end);
            }
        }
        start = end;
    }
    (channels, found)
}

fn panel(
    context: &FigureContext<'_>,
    table: &Table,
    split: &Split,
    channel: &Channel,
    y: FigureMeasure,
    recorded: &Recorded,
) -> FigurePanel {
    let mut lines = Vec::new();
    for line in &split.lines {
        let job = context.job(line.row);
        if let Some(rows) = recorded.get(&(job, channel.clone())) {
            lines.push(FigureLine {
                label: line.label.clone(),
                style: line.style,
                joined: true,
                jobs: vec![job],
                points: points(table, rows, y),
            });
        }
    }
    let rows: Vec<usize> = split.lines.iter().map(|line| line.row).collect();
    let asked = MarkRequest {
        chart: Chart::History,
        table: TableName::Histories,
        columns: &[&channel.0],
        position: Some(channel.1),
        x: FigureMeasure::TIME,
        y,
        sign: 1.0,
    };
    FigurePanel {
        title: split.title.clone(),
        x: FigureMeasure::TIME.axis(),
        y: y.axis(),
        marks: context.marks_of(&rows, &asked),
        moments: arrival(context, &rows, channel.1),
        lines,
    }
}

/// A history with its peaks, thinned.
fn points(table: &Table, rows: &Range<usize>, y: FigureMeasure) -> Vec<[f64; 2]> {
    let (Some(time), Some(value)) = (table.numbers("time_s"), table.numbers("value")) else {
        return Vec::new();
    };
    let values: Vec<f64> = value[rows.clone()]
        .iter()
        .map(|value| value.unwrap_or_default())
        .collect();
    let kept = thinned(&values).into_iter().map(|i| rows.start + i);
    kept.filter_map(|row| Some([time[row]?, value[row]? * y.factor]))
        .collect()
}

/// When the vehicle's centre is at a position, where it is so for all jobs at once.
fn arrival(context: &FigureContext<'_>, rows: &[usize], position: u32) -> Vec<FigureMoment> {
    let at = |row: &usize| {
        moments_of(context.results, *row, Along::Position(position as usize))
            .ok()
            .map(|moments| moments.arrival_s)
    };
    let Some(times) = rows.iter().map(at).collect::<Option<Vec<f64>>>() else {
        return Vec::new();
    };
    match times.split_first() {
        Some((first, others)) if others.iter().all(|time| (time - first).abs() < SAME_ARRIVAL_S) => {
            vec![FigureMoment {
                kind: MomentKind::Arrival,
                label: format!("vehicle at {position}"),
                x: *first,
            }]
        }
        _ => Vec::new(),
    }
}
