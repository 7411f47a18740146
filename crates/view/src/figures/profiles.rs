//! Along the bridge: the deflected line of standing loads, the envelope of crossings.
//!
//! Knows the table of positions. Does not know which jobs belong together.

use super::figure::{Figure, FigureLine, FigureMeasure, FigureMoment, FigurePanel, MomentKind};
use super::figure_context::{FigureContext, MarkRequest, rows_by_job};
use super::marks::Chart;
use super::panels::{Split, by_speed, caption};
use super::series_group::{SeriesGroup, series_groups};
use pontoon_results::{Table, TableName};
use std::collections::{BTreeSet, HashMap};

/// The deflected lines of a static study.
pub(super) fn deflected(context: &mut FigureContext<'_>) -> Vec<Figure> {
    let Some(table) = context.results.table(TableName::Positions) else {
        context
            .left_out
            .push("deflection along the bridge: the study left no table of positions".to_owned());
        return Vec::new();
    };
    let series_groups = series_groups(context, None);
    let of_job = rows_by_job(table);
    let figure = |series_group: &SeriesGroup| {
        let rows = series_group.rows();
        let lines = series_group.lines.iter().map(|line| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: true,
            jobs: vec![context.job(line.rows[0])],
            points: points(table, of_job.get(&context.job(line.rows[0])), "deflection_m", 1.0),
        });
        let lines = lines.collect();
        let asked = MarkRequest {
            chart: Chart::Profile,
            table: TableName::Positions,
            columns: &["deflection_m", "peak_deflection_m"],
            position: None,
            x: FigureMeasure::ALONG,
            y: FigureMeasure::DEFLECTION,
            sign: 1.0,
        };
        let panel = FigurePanel {
            title: String::new(),
            x: FigureMeasure::ALONG.axis(),
            y: FigureMeasure::DEFLECTION.axis(),
            marks: context.marks_of(&rows, &asked),
            moments: load_of(context, table, &rows, &of_job),
            lines,
        };
        Figure {
            name: series_group.name("deflection-along-bridge"),
            caption: caption(
                context,
                series_group,
                "Deflection along the bridge under the standing vehicle",
                std::slice::from_ref(&panel),
            ),
            legend: series_group.legend(),
            panels: vec![panel],
            left_out: series_group.left_out.clone().into_iter().collect(),
        }
    };
    series_groups.iter().map(figure).collect()
}

/// The envelopes of a study of crossings: largest deflection and, above the unloaded bridge, largest uplift.
pub(super) fn envelopes(context: &mut FigureContext<'_>) -> Vec<Figure> {
    let Some(table) = context.results.table(TableName::Positions) else {
        return Vec::new();
    };
    let series_groups = series_groups(context, Some("speed_m_s"));
    let of_job = rows_by_job(table);
    let mut figures = Vec::new();
    for series_group in &series_groups {
        let name = series_group.name("envelope-along-bridge");
        let (split, left_out) = by_speed(context, series_group, &name);
        let panels: Vec<FigurePanel> = split
            .iter()
            .map(|split| envelope(context, table, &of_job, split))
            .collect();
        figures.push(Figure {
            caption: caption(
                context,
                series_group,
                "Largest deflection (downward) and largest uplift (upward) along the bridge during the crossing",
                &panels,
            ),
            name,
            legend: series_group.legend(),
            panels,
            left_out: series_group.left_out.clone().into_iter().chain(left_out).collect(),
        });
    }
    figures
}

fn envelope(
    context: &FigureContext<'_>,
    table: &Table,
    of_job: &HashMap<u64, Vec<usize>>,
    split: &Split,
) -> FigurePanel {
    let rows: Vec<usize> = split.lines.iter().map(|line| line.row).collect();
    let sides = [("peak_deflection_m", 1.0), ("peak_uplift_m", -1.0)];
    let line = |(column, sign): (&str, f64)| {
        let column = column.to_owned();
        split.lines.iter().map(move |line| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: true,
            jobs: vec![context.job(line.row)],
            points: points(table, of_job.get(&context.job(line.row)), &column, sign),
        })
    };
    let marks = |(column, sign): (&str, f64)| {
        let asked = MarkRequest {
            chart: Chart::Profile,
            table: TableName::Positions,
            columns: &[column],
            position: None,
            x: FigureMeasure::ALONG,
            y: FigureMeasure::DEFLECTION,
            sign,
        };
        context.marks_of(&rows, &asked)
    };
    FigurePanel {
        title: split.title.clone(),
        x: FigureMeasure::ALONG.axis(),
        y: FigureMeasure::DEFLECTION.axis(),
        lines: sides.into_iter().flat_map(line).collect(),
        marks: sides.into_iter().flat_map(marks).collect(),
        moments: Vec::new(),
    }
}

fn points(table: &Table, rows: Option<&Vec<usize>>, column: &str, sign: f64) -> Vec<[f64; 2]> {
    let point = |row: &usize| {
        Some([
            table.number("x_m", *row)?,
            sign * table.number(column, *row)? * FigureMeasure::DEFLECTION.factor,
        ])
    };
    rows.into_iter().flatten().filter_map(point).collect()
}

/// Where the vehicle stands, where it does so at one place.
fn load_of(
    context: &FigureContext<'_>,
    table: &Table,
    rows: &[usize],
    of_job: &HashMap<u64, Vec<usize>>,
) -> Vec<FigureMoment> {
    let at = |row: &usize| {
        context.number("load_x_m", *row).or_else(|| {
            let position = context.number("load_position", *row)?;
            let mut own = of_job.get(&context.job(*row))?.iter();
            table.number(
                "x_m",
                *own.find(|own| table.number("position", **own) == Some(position))?,
            )
        })
    };
    let places: BTreeSet<u64> = rows.iter().filter_map(at).map(f64::to_bits).collect();
    let mut places = places.into_iter();
    match (places.next(), places.next()) {
        (Some(place), None) => vec![FigureMoment {
            kind: MomentKind::Standing,
            label: "vehicle".to_owned(),
            x: f64::from_bits(place),
        }],
        _ => Vec::new(),
    }
}
