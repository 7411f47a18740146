//! Natural frequencies by the name of their shape, with what a reference has.
//!
//! Knows the table of modes and the checks of modes. Does not know shapes.

use super::figure::{Figure, FigureAxis, FigureLine, FigureMeasure, FigurePanel, PlottedMark};
use super::figure_context::{FigureContext, rows_by_job};
use super::marks::Origin;
use super::panels::caption;
use super::series_group::{GroupedLine, SeriesGroup, series_groups};
use pontoon_judge::checks::Expectation;
use pontoon_judge::reference::Reference;
use pontoon_results::{Table, TableName};

/// The axis of models.
const MODEL: &str = "analysis.model";

/// Shapes that one figure holds.
const MOST_SHAPES: usize = 40;

/// Frequencies of each group of models.
pub(super) fn frequencies(context: &mut FigureContext<'_>, reference: Option<&Reference>) -> Vec<Figure> {
    let Some(table) = context.results.table(TableName::Modes) else {
        return Vec::new();
    };
    let mut series_groups = series_groups(context, None);
    // models are what one compares; bridges with other numbers of modules have other shapes
    if series_groups
        .iter()
        .any(|series_group| series_group.by.as_deref() == Some(MODEL))
    {
        series_groups.retain(|series_group| series_group.by.as_deref() == Some(MODEL));
    }
    let of_job = rows_by_job(table);
    let mut figures = Vec::new();
    for series_group in &series_groups {
        let mut left_out: Vec<String> = series_group.left_out.clone().into_iter().collect();
        let name = series_group.name("frequencies");
        let of_line = |line: &GroupedLine| of_job.get(&context.job(line.rows[0])).cloned().unwrap_or_default();
        let mut shapes = shapes(table, series_group, &of_line);
        if shapes.len() > MOST_SHAPES {
            left_out.push(format!(
                "{name}: {} of {} shapes",
                shapes.len() - MOST_SHAPES,
                shapes.len()
            ));
            shapes.truncate(MOST_SHAPES);
        }
        let place = |shape: &str| shapes.iter().position(|known| known == shape).map(|place| place as f64);
        let point = |row: usize| {
            Some([
                table.number("frequency_hz", row)?,
                place(table.cell("shape", row).word()?)?,
            ])
        };
        let line = |line: &GroupedLine| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: false,
            jobs: vec![context.job(line.rows[0])],
            points: of_line(line).into_iter().filter_map(point).collect(),
        };
        let panel = FigurePanel {
            title: String::new(),
            x: FigureMeasure::FREQUENCY.axis(),
            y: FigureAxis {
                label: String::new(),
                unit: String::new(),
                down: true,
                words: shapes.clone(),
            },
            lines: series_group.lines.iter().map(line).collect(),
            marks: reference
                .map(|reference| marks(context, reference, series_group, &place))
                .unwrap_or_default(),
            moments: Vec::new(),
        };
        figures.push(Figure {
            caption: caption(
                context,
                series_group,
                "Natural frequencies by the name of the shape",
                std::slice::from_ref(&panel),
            ),
            name,
            legend: series_group.legend(),
            panels: vec![panel],
            left_out,
        });
    }
    figures
}

/// The shapes of a group in the order of the lowest frequency that any line has of them.
fn shapes(table: &Table, series_group: &SeriesGroup, of_line: &dyn Fn(&GroupedLine) -> Vec<usize>) -> Vec<String> {
    let mut shapes: Vec<(f64, String)> = Vec::new();
    for row in series_group.lines.iter().flat_map(of_line) {
        let (Some(frequency_hz), Some(shape)) = (
            table.number("frequency_hz", row),
            table.cell("shape", row).word().map(str::to_owned),
        ) else {
            continue;
        };
        match shapes.iter_mut().find(|(_, known)| *known == shape) {
            Some((lowest, _)) => *lowest = lowest.min(frequency_hz),
            None => shapes.push((frequency_hz, shape)),
        }
    }
    shapes.sort_by(|a, b| a.0.total_cmp(&b.0));
    shapes.into_iter().map(|(_, shape)| shape).collect()
}

/// What a reference has of the shapes, each number once, where it is said of one of the group's jobs.
fn marks(
    context: &FigureContext<'_>,
    reference: &Reference,
    series_group: &SeriesGroup,
    place: &dyn Fn(&str) -> Option<f64>,
) -> Vec<PlottedMark> {
    let jobs = context.results.jobs();
    let mut marks: Vec<PlottedMark> = Vec::new();
    for check in &reference.checks {
        let Expectation::Mode { shape, frequency_hz } = check.expectation() else {
            continue;
        };
        let fits = |row: &usize| {
            check
                .filter
                .0
                .iter()
                .all(|(column, allowed)| allowed.allows(&jobs.cell(column, *row)))
        };
        let Some(place) = place(shape).filter(|_| series_group.rows().iter().any(fits)) else {
            continue;
        };
        let point = [frequency_hz, place];
        if !marks.iter().any(|mark| mark.point == point) {
            marks.push(PlottedMark {
                label: "reference value".to_owned(),
                origin: Origin::Expected,
                id: check.id.clone(),
                point,
            });
        }
    }
    marks
}
