//! Along the bridge: the deflected line of standing loads, the envelope of crossings.
//!
//! Knows the table of positions. Does not know which jobs belong together.

use super::family::{Family, families};
use super::figure::{Figure, FigureLine, FigureMeasure, FigureMoment, FigurePanel, MomentKind};
use super::marks::Chart;
use super::panels::{Split, by_speed, caption};
use super::sheet::{MarkRequest, Sheet, rows_by_job};
use pontoon_results::{Table, TableName};
use std::collections::{BTreeSet, HashMap};

/// The deflected lines of a static study.
pub(super) fn deflected(sheet: &mut Sheet<'_>) -> Vec<Figure> {
    let Some(table) = sheet.results.table(TableName::Positions) else {
        sheet
            .left_out
            .push("deflection along the bridge: the study left no table of positions".to_owned());
        return Vec::new();
    };
    let families = families(sheet, None);
    let of_job = rows_by_job(table);
    let figure = |family: &Family| {
        let rows = family.rows();
        let lines = family.lines.iter().map(|line| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: true,
            jobs: vec![sheet.job(line.rows[0])],
            points: points(table, of_job.get(&sheet.job(line.rows[0])), "deflection_m", 1.0),
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
            marks: sheet.marks_of(&rows, &asked),
            moments: load_of(sheet, table, &rows, &of_job),
            lines,
        };
        Figure {
            name: family.name("deflection-along-bridge"),
            caption: caption(
                sheet,
                family,
                "Deflection along the bridge under the standing vehicle",
                std::slice::from_ref(&panel),
            ),
            legend: family.legend(),
            panels: vec![panel],
            left_out: family.left_out.clone().into_iter().collect(),
        }
    };
    families.iter().map(figure).collect()
}

/// The envelopes of a study of crossings: largest deflection and, above the unloaded bridge, largest uplift.
pub(super) fn envelopes(sheet: &mut Sheet<'_>) -> Vec<Figure> {
    let Some(table) = sheet.results.table(TableName::Positions) else {
        return Vec::new();
    };
    let families = families(sheet, Some("speed_m_s"));
    let of_job = rows_by_job(table);
    let mut figures = Vec::new();
    for family in &families {
        let name = family.name("envelope-along-bridge");
        let (split, left_out) = by_speed(sheet, family, &name);
        let panels: Vec<FigurePanel> = split
            .iter()
            .map(|split| envelope(sheet, table, &of_job, split))
            .collect();
        figures.push(Figure {
            caption: caption(
                sheet,
                family,
                "Largest deflection (downward) and largest uplift (upward) along the bridge during the crossing",
                &panels,
            ),
            name,
            legend: family.legend(),
            panels,
            left_out: family.left_out.clone().into_iter().chain(left_out).collect(),
        });
    }
    figures
}

fn envelope(sheet: &Sheet<'_>, table: &Table, of_job: &HashMap<u64, Vec<usize>>, split: &Split) -> FigurePanel {
    let rows: Vec<usize> = split.lines.iter().map(|line| line.row).collect();
    let sides = [("peak_deflection_m", 1.0), ("peak_uplift_m", -1.0)];
    let line = |(column, sign): (&str, f64)| {
        let column = column.to_owned();
        split.lines.iter().map(move |line| FigureLine {
            label: line.label.clone(),
            style: line.style,
            joined: true,
            jobs: vec![sheet.job(line.row)],
            points: points(table, of_job.get(&sheet.job(line.row)), &column, sign),
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
        sheet.marks_of(&rows, &asked)
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
fn load_of(sheet: &Sheet<'_>, table: &Table, rows: &[usize], of_job: &HashMap<u64, Vec<usize>>) -> Vec<FigureMoment> {
    let at = |row: &usize| {
        sheet.number("load_x_m", *row).or_else(|| {
            let position = sheet.number("load_position", *row)?;
            let mut own = of_job.get(&sheet.job(*row))?.iter();
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
