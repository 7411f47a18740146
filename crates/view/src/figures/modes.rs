//! Natural frequencies by the name of their shape, with what a reference has.
//!
//! Knows the table of modes and the checks of modes. Does not know shapes.

use super::family::{Family, FamilyLine, families};
use super::figure::{Figure, FigureAxis, FigureLine, FigureMeasure, FigurePanel, PlottedMark};
use super::marks::Origin;
use super::panels::caption;
use super::sheet::{Sheet, rows_by_job};
use pontoon_judge::checks::Expectation;
use pontoon_judge::reference::Reference;
use pontoon_results::{Table, TableName};

/// The axis of models.
const MODEL: &str = "analysis.model";

/// Shapes that one figure holds.
const MOST_SHAPES: usize = 40;

/// Frequencies of each family of models.
pub(super) fn frequencies(sheet: &mut Sheet<'_>, reference: Option<&Reference>) -> Vec<Figure> {
    let Some(table) = sheet.results.table(TableName::Modes) else {
        return Vec::new();
    };
    let mut families = families(sheet, None);
    // models are what one compares; bridges with other numbers of modules have other shapes
    if families.iter().any(|family| family.by.as_deref() == Some(MODEL)) {
        families.retain(|family| family.by.as_deref() == Some(MODEL));
    }
    let of_job = rows_by_job(table);
    let mut figures = Vec::new();
    for family in &families {
        let mut left_out: Vec<String> = family.left_out.clone().into_iter().collect();
        let name = family.name("frequencies");
        let of_line = |line: &FamilyLine| of_job.get(&sheet.job(line.rows[0])).cloned().unwrap_or_default();
        let mut shapes = shapes(table, family, &of_line);
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
        let line = |line: &FamilyLine| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: false,
            jobs: vec![sheet.job(line.rows[0])],
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
            lines: family.lines.iter().map(line).collect(),
            marks: reference
                .map(|reference| marks(sheet, reference, family, &place))
                .unwrap_or_default(),
            moments: Vec::new(),
        };
        figures.push(Figure {
            caption: caption(
                sheet,
                family,
                "Natural frequencies by the name of the shape",
                std::slice::from_ref(&panel),
            ),
            name,
            legend: family.legend(),
            panels: vec![panel],
            left_out,
        });
    }
    figures
}

/// The shapes of a family in the order of the lowest frequency that any line has of them.
fn shapes(table: &Table, family: &Family, of_line: &dyn Fn(&FamilyLine) -> Vec<usize>) -> Vec<String> {
    let mut shapes: Vec<(f64, String)> = Vec::new();
    for row in family.lines.iter().flat_map(of_line) {
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

/// What a reference has of the shapes, each number once, where it is said of one of the family's jobs.
fn marks(
    sheet: &Sheet<'_>,
    reference: &Reference,
    family: &Family,
    place: &dyn Fn(&str) -> Option<f64>,
) -> Vec<PlottedMark> {
    let jobs = sheet.results.jobs();
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
        let Some(place) = place(shape).filter(|_| family.rows().iter().any(fits)) else {
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
