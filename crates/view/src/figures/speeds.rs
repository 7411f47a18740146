//! Against the speed: peaks of deflection and of the joints' forces.
//!
//! Knows the table of jobs. Does not know which jobs belong together.

use super::figure::{Figure, FigureLine, FigureMeasure, FigurePanel};
use super::figure_context::{FigureContext, MarkRequest};
use super::marks::Chart;
use super::panels::caption;
use super::series_group::{GroupedLine, SeriesGroup, series_groups};
use crate::thinning::spread;
use pontoon_results::{Column, SpeedFigure, TableName};

/// Jobs that are points of a figure without lines.
const MOST_POINTS: usize = 2000;

/// The name of a figure and what is drawn in it.
fn words(figure: SpeedFigure) -> (&'static str, &'static str) {
    match figure {
        SpeedFigure::Deflection => (
            "peak-deflection",
            "Largest deflection and largest uplift of the bridge against speed",
        ),
        SpeedFigure::Force => (
            "peak-force",
            "Largest compression and largest tension of a joint against speed",
        ),
    }
}

/// The columns of a figure, each with what it counts.
fn columns(figure: SpeedFigure) -> impl Iterator<Item = (&'static str, FigureMeasure)> {
    let curves = Column::measures().filter_map(|column| Some((column.name, column.curve?)));
    curves
        .filter(move |(_, curve)| curve.figure == figure)
        .map(|(name, curve)| (name, FigureMeasure::of(&curve)))
}

/// Peaks against speed, a line each value of an axis; of jobs that have nothing alike a point each.
pub(super) fn speeds(context: &mut FigureContext<'_>) -> Vec<Figure> {
    if !context.varying.iter().any(|axis| axis == "speed_m_s") {
        return Vec::new();
    }
    let mut series_groups = series_groups(context, Some("speed_m_s"));
    series_groups.retain(|series_group| series_group.lines.iter().any(|line| line.rows.len() > 1));
    let joined = !series_groups.is_empty();
    if !joined {
        series_groups.push(points(context));
    }
    let mut figures = Vec::new();
    for series_group in &series_groups {
        for figure in SpeedFigure::ALL {
            let (stem, what) = words(figure);
            let panels: Vec<FigurePanel> = columns(figure)
                .map(|(column, y)| panel(context, series_group, column, y, joined))
                .collect();
            figures.push(Figure {
                name: series_group.name(stem),
                caption: caption_of(context, series_group, what),
                legend: series_group.legend(),
                panels,
                left_out: series_group.left_out.clone().into_iter().collect(),
            });
        }
    }
    figures
}

fn caption_of(context: &FigureContext<'_>, series_group: &SeriesGroup, what: &str) -> String {
    caption(context, series_group, what, &[])
}

/// All jobs as points.
fn points(context: &FigureContext<'_>) -> SeriesGroup {
    let (all, chosen) = (context.rows.len(), spread(context.rows.len(), MOST_POINTS));
    let left_out = (chosen.len() < all).then(|| format!("peaks against speed: {} of {all} jobs", all - chosen.len()));
    SeriesGroup {
        by: None,
        suffix: String::new(),
        lines: vec![GroupedLine {
            label: "a job".to_owned(),
            style: 1,
            rows: chosen.into_iter().map(|i| context.rows[i]).collect(),
        }],
        left_out,
    }
}

fn panel(
    context: &FigureContext<'_>,
    series_group: &SeriesGroup,
    column: &str,
    y: FigureMeasure,
    joined: bool,
) -> FigurePanel {
    let line = |line: &GroupedLine| {
        let point = |row: &usize| {
            let point = [
                context.number("speed_m_s", *row)?,
                context.number(column, *row)? * y.factor,
            ];
            Some((point, context.job(*row)))
        };
        let mut points: Vec<([f64; 2], u64)> = line.rows.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]).then(a.1.cmp(&b.1)));
        FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined,
            jobs: points.iter().map(|(_, job)| *job).collect(),
            points: points.into_iter().map(|(point, _)| point).collect(),
        }
    };
    let asked = MarkRequest {
        chart: Chart::Speed,
        table: TableName::Jobs,
        columns: &[column],
        position: None,
        x: FigureMeasure::SPEED,
        y,
        sign: 1.0,
    };
    FigurePanel {
        title: String::new(),
        x: FigureMeasure::SPEED.axis(),
        y: y.axis(),
        lines: series_group.lines.iter().map(line).collect(),
        marks: context.marks_of(&series_group.rows(), &asked),
        moments: Vec::new(),
    }
}
