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

/// What was recorded.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct Channel {
    quantity: String,
    of: ChannelOf,
    /// Place across of a pin or wheel, as bits `[m]`.
    y_m: Option<u64>,
}

/// What a recorded quantity is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum ChannelOf {
    /// A position or joint.
    Position(u32),
    /// A vehicle's axle.
    Axle(u32, u32),
    /// A vehicle's body.
    Body(u32),
}

impl ChannelOf {
    fn position(self) -> Option<u32> {
        match self {
            Self::Position(position) => Some(position),
            Self::Axle(..) | Self::Body(_) => None,
        }
    }

    /// Its numbers in a caption and in a name.
    fn words(self) -> [String; 2] {
        match self {
            Self::Position(n) => [n.to_string(), n.to_string()],
            Self::Axle(vehicle, axle) => [format!("{axle} of vehicle {vehicle}"), format!("{vehicle}-{axle}")],
            Self::Body(vehicle) => [vehicle.to_string(), vehicle.to_string()],
        }
    }
}

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
        "wheel_n" => ("wheel", "Force of a wheel of axle", FigureMeasure::WHEEL_FORCE),
        "bounce_m" => ("bounce", "Bounce of vehicle", FigureMeasure::BOUNCE),
        "pitch_rad" => ("pitch", "Pitch of vehicle", FigureMeasure::BODY_ANGLE),
        "roll_rad" => ("body-roll", "Roll of vehicle", FigureMeasure::BODY_ANGLE),
        "bending_nm" => ("bending", "Bending moment of joint", FigureMeasure::BENDING),
        _ => return None,
    })
}

/// Rows of the table of histories by job and channel.
type Recorded = HashMap<(u64, Channel), Range<usize>>;

/// Arrivals closer than this are one `[s]`: a hundredth of a time step.
const SAME_ARRIVAL_S: f64 = 1e-4;

/// Figures of recorded histories, of the bridge and of vehicles: each channel by each group.
pub(super) fn histories(context: &mut FigureContext<'_>) -> [Vec<Figure>; 2] {
    let Some(table) = context.results.table(TableName::Histories) else {
        return Default::default();
    };
    let (channels, recorded) = recorded(context, table);
    let series_groups = series_groups(context, Some("speed_m_s"));
    let mut figures: [Vec<Figure>; 2] = Default::default();
    for channel in &channels {
        let Some((stem, what, y)) = drawn(&channel.quantity) else {
            continue;
        };
        let [told, named] = channel.of.words();
        // pins of a joint and wheels of an axle by number, as a name has no sign and no point
        let number = channel.y_m.map(|_| {
            let same = |of: &&Channel| (&of.quantity, of.of) == (&channel.quantity, channel.of);
            1 + channels.iter().filter(same).take_while(|of| *of != channel).count()
        });
        let number = number.map(|number| format!("-{number}")).unwrap_or_default();
        let at = channel
            .y_m
            .map(|across| format!(" at y {} m", labels::as_written(f64::from_bits(across))));
        let at = at.unwrap_or_default();
        for series_group in &series_groups {
            let name = series_group.name(&format!("{stem}-{named}{number}"));
            let (split, left_out) = by_speed(context, series_group, &name);
            let of = |split: &Split| panel(context, table, split, channel, y, &recorded);
            let panels: Vec<FigurePanel> = split.iter().map(of).filter(|panel| !panel.lines.is_empty()).collect();
            if panels.is_empty() {
                continue;
            }
            figures[usize::from(channel.of.position().is_none())].push(Figure {
                caption: caption(
                    context,
                    series_group,
                    &format!("{what} {told}{at} against time"),
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
    let (mut channels, mut found) = (Vec::new(), Recorded::new());
    let (Some(job), Some(quantity)) = (table.numbers("job"), table.word_cells("quantity")) else {
        return (channels, found);
    };
    let [position, vehicle, axle, across] = ["position", "vehicle", "axle", "y_m"].map(|name| table.numbers(name));
    let count = |of: Option<&[Option<f64>]>, row: usize| of.and_then(|of| of[row]).map(|n| n as u32);
    let place = |row: usize| {
        let of = match (count(position, row), count(vehicle, row), count(axle, row)) {
            (Some(position), ..) => ChannelOf::Position(position),
            (None, Some(vehicle), Some(axle)) => ChannelOf::Axle(vehicle, axle),
            (None, Some(vehicle), None) => ChannelOf::Body(vehicle),
            (None, None, _) => return None,
        };
        Some((
            of,
            across.and_then(|across| across[row]).map(|y_m| (y_m + 0.0).to_bits()),
        ))
    };
    let jobs: BTreeSet<u64> = context.rows.iter().map(|row| context.job(*row)).collect();
    let mut start = 0;
    while start < table.rows() {
        let same =
            |row: &usize| job[*row] == job[start] && quantity[*row] == quantity[start] && place(*row) == place(start);
        let end = (start..table.rows()).take_while(same).count() + start;
        if let (Some(job), Some(quantity), Some((of, y_m))) = (job[start], &quantity[start], place(start)) {
            let channel = Channel {
                quantity: quantity.clone(),
                of,
                y_m,
            };
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
        columns: &[&channel.quantity],
        position: channel.of.position(),
        x: FigureMeasure::TIME,
        y,
        sign: 1.0,
    };
    FigurePanel {
        title: split.title.clone(),
        x: FigureMeasure::TIME.axis(),
        y: y.axis(),
        marks: context.marks_of(&rows, &asked),
        moments: channel
            .of
            .position()
            .map_or_else(Vec::new, |at| arrival(context, &rows, at)),
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
