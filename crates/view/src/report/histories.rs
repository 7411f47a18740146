//! Recorded histories, thinned for a page.
//!
//! Knows how many histories fit a page with fewer points. Does not know which jobs matter.

use super::packed::Packed;
use crate::thinning::thinned;
use pontoon_results::{Results, ResultsError, Table, TableName, labels};
use serde::Serialize;
use std::collections::HashSet;

/// Most histories that a page carries.
const MOST: usize = 160;

/// A history.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HistoryLine {
    /// The job.
    pub job: u32,
    /// Its axes in words.
    pub axes: String,
    /// Position or joint; none of a place inside a module.
    pub position: Option<u32>,
    /// Where it is, in words.
    pub place: String,
    /// What it is of, as `deflection_m`.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// Times `[s]`.
    pub time_s: Packed,
    /// Values.
    pub value: Packed,
}

/// A history as its rows come.
#[derive(Debug, Default)]
struct Gathered {
    job: u32,
    quantity: String,
    place: Place,
    time_s: Vec<f64>,
    value: Vec<f64>,
}

/// Where a history is: at a position or joint, at a place along, of a pin across, of a vehicle or its wheel.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Place {
    position: Option<f64>,
    x_m: Option<f64>,
    y_m: Option<f64>,
    vehicle: Option<f64>,
    axle: Option<f64>,
}

impl Place {
    fn of(part: &Table, row: usize) -> Self {
        let number = |column| part.number(column, row);
        Self {
            position: number("position"),
            x_m: number("x_m"),
            y_m: number("y_m"),
            vehicle: number("vehicle"),
            axle: number("axle"),
        }
    }

    fn words(self, quantity: &str) -> String {
        let along = match (self.position, self.x_m) {
            _ if self.vehicle.is_some() => {
                let axle = self.axle.map(|axle| format!(", axle {axle}"));
                format!(
                    "vehicle {}{}",
                    self.vehicle.unwrap_or_default(),
                    axle.unwrap_or_default()
                )
            }
            (Some(position), _) if quantity == "deflection_m" => format!("position {position}"),
            (Some(joint), _) => format!("joint {joint}"),
            (None, x_m) => format!("x {} m", labels::as_written(x_m.unwrap_or_default())),
        };
        match self.y_m {
            Some(y_m) => format!("{along}, y {} m", labels::as_written(y_m)),
            None => along,
        }
    }
}

impl Gathered {
    fn is(&self, job: u32, quantity: &str, place: Place) -> bool {
        self.job == job && self.place == place && self.quantity == quantity
    }

    fn line(&self, axes: String) -> HistoryLine {
        let kept = thinned(&self.value);
        let of = |list: &[f64]| Packed::numbers(kept.iter().map(|&i| Some(list[i])));
        HistoryLine {
            job: self.job,
            axes,
            position: self.place.position.map(|position| position as u32),
            place: self.place.words(&self.quantity),
            quantity: self.quantity.clone(),
            unit: labels::unit(&self.quantity),
            time_s: of(&self.time_s),
            value: of(&self.value),
        }
    }
}

/// The first histories of the jobs that are wanted, and how many there are of all jobs.
///
/// # Errors
/// [`ResultsError::Damaged`].
pub(super) fn histories(
    results: &Results,
    wanted: &HashSet<u32>,
    row_label: &dyn Fn(usize) -> String,
) -> Result<(Vec<HistoryLine>, usize), ResultsError> {
    let (mut lines, mut count, mut now) = (Vec::new(), 0, Gathered::default());
    let mut flush = |now: &Gathered| {
        if !now.value.is_empty() && lines.len() < MOST {
            let row = results.row_of_job(u64::from(now.job));
            lines.push(now.line(row.map(row_label).unwrap_or_default()));
        }
    };
    let columns = [
        "job", "time_s", "quantity", "position", "x_m", "y_m", "vehicle", "axle", "value",
    ];
    results.scan(TableName::Histories, &columns, |part| {
        let Some(quantities) = part.word_cells("quantity") else {
            return;
        };
        for (row, quantity) in quantities.iter().enumerate() {
            let quantity = quantity.as_deref().unwrap_or_default();
            let job = part.number("job", row).map_or(u32::MAX, |x| x as u32);
            let place = Place::of(part, row);
            if count == 0 || !now.is(job, quantity, place) {
                flush(&now);
                count += 1;
                now = Gathered {
                    job,
                    quantity: quantity.to_owned(),
                    place,
                    ..Gathered::default()
                };
            }
            let sample = part.number("time_s", row).zip(part.number("value", row));
            if let Some((time_s, value)) = sample.filter(|_| wanted.contains(&job)) {
                now.time_s.push(time_s);
                now.value.push(value);
            }
        }
    })?;
    flush(&now);
    Ok((lines, count))
}
