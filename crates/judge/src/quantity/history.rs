//! A history and what can be made of it.
//!
//! Knows when the vehicle is where. Does not know which history is meant.

use super::no_value::NoValue;
use super::spec::{Edge, HistoryReduction};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::vehicle::VehicleDesign;
use pontoon_plan::design::{Root, Varies};
use pontoon_plan::input::{Cell, Refusal, to_value, typed_value};
use pontoon_plan::study_file::filled_vehicle;
use pontoon_results::Results;
use serde_json::Value;
use std::path::Path;

/// Values at times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValueHistory {
    pub time_s: Vec<f64>,
    pub values: Vec<f64>,
}

/// The moments of a crossing that matter at one place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    /// Speed `[m/s]`.
    pub speed_m_s: f64,
    /// When the vehicle's centre is there `[s]`.
    pub arrival_s: f64,
    /// When the vehicle's last point leaves the bridge `[s]`.
    pub leaving_s: f64,
}

/// Where along the bridge a history is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Along {
    /// At a position or joint.
    Position(usize),
    /// At a place `[m]`.
    X(f64),
}

impl std::fmt::Display for Along {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Position(position) => write!(f, "{position}"),
            Self::X(x_m) => write!(f, "{x_m} m"),
        }
    }
}

/// The moments of the crossing in a row of the table of jobs.
///
/// # Errors
/// [`NoValue`] where the job is no crossing, or its documents are not read any more.
pub fn moments_of(results: &Results, row: usize, along: Along) -> Result<Moments, NoValue> {
    let speed_m_s = results.jobs().number("speed_m_s", row).ok_or(NoValue::NoSpeed)?;
    let file = Path::new("results");
    let documents = results.documents.bridge_and_vehicle();
    let [bridge, vehicle] = documents.map_err(|damaged| {
        let allowed = "the documents of a run that its folder keeps";
        Refusal::new(&results.place, "", damaged.to_string(), allowed)
    })?;
    let bridge: BridgeDesign = typed_value(file, "", &document(results, row, Root::Bridge, bridge)?)?;
    let written = match vehicle {
        Value::Null => to_value(&VehicleDesign::default()),
        vehicle => vehicle.clone(),
    };
    let vehicle: VehicleDesign = typed_value(file, "", &document(results, row, Root::Vehicle, &written)?)?;
    let vehicle = filled_vehicle(&vehicle)
        .and_then(|vehicle| vehicle.check(bridge.module.breadth_m))
        .map_err(|e| Refusal::of(file, "vehicle", e))?;
    let x_m = match along {
        Along::Position(position) => bridge.position_x_m(position),
        Along::X(x_m) => x_m,
    };
    Ok(Moments {
        speed_m_s,
        arrival_s: (x_m - vehicle.centre_ahead_m()) / speed_m_s,
        leaving_s: (bridge.length_m() + vehicle.behind_m()) / speed_m_s,
    })
}

/// A document of the study with the values of a job's axes in place.
fn document(results: &Results, row: usize, root: Root, base: &Value) -> Result<Value, NoValue> {
    let mut document = base.clone();
    for axis in results.axes() {
        let Some(Varies::Path(of, path)) = Varies::of(&axis) else {
            continue;
        };
        let cell = results.jobs().cell(&axis, row);
        if of != root || cell.is_nothing() {
            continue;
        }
        // lists stand in a table as their JSON text
        let tree = match &cell {
            Cell::Word(text) if !path.get(base).is_some_and(Value::is_string) => serde_json::from_str(text).ok(),
            _ => None,
        };
        path.set(&mut document, tree.unwrap_or_else(|| cell.value()))?;
    }
    Ok(document)
}

impl Moments {
    fn at(&self, edge: Edge) -> f64 {
        match edge {
            Edge::TimeS(time_s) => time_s,
            Edge::CentrePastM(way_m) => self.arrival_s + way_m / self.speed_m_s,
            Edge::AfterLeavingS(wait_s) => self.leaving_s + wait_s,
        }
    }
}

/// Times closer than this are one time `[s]`.
const SAME_TIME_S: f64 = 1e-9;

impl ValueHistory {
    /// The part between two moments, both included; at least two times.
    pub(super) fn part(&self, moments: &Moments, from: Option<Edge>, to: Option<Edge>) -> Result<Self, NoValue> {
        let from_s = from.map_or(f64::NEG_INFINITY, |edge| moments.at(edge));
        let to_s = to.map_or(f64::INFINITY, |edge| moments.at(edge));
        let inside = |&(t, _): &(f64, f64)| t >= from_s - SAME_TIME_S && t <= to_s + SAME_TIME_S;
        let (time_s, values): (Vec<f64>, Vec<f64>) = self.points().filter(inside).unzip();
        let step = self.time_s.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max) + SAME_TIME_S;
        let ends = self.time_s.first().zip(self.time_s.last());
        let covers = |(first, last): (&f64, &f64)| {
            (from.is_none() || from_s >= first - step) && (to.is_none() || to_s <= last + step)
        };
        if !ends.is_some_and(covers) {
            return Err(NoValue::ShortHistory { from_s, to_s });
        }
        if time_s.len() < 2 {
            let values = time_s.len();
            return Err(NoValue::ThinHistory { values, from_s, to_s });
        }
        Ok(Self { time_s, values })
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.time_s.iter().copied().zip(self.values.iter().copied())
    }

    /// One number of it.
    pub(super) fn reduced(&self, moments: &Moments, reduction: HistoryReduction) -> Result<f64, NoValue> {
        let max = self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let min = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        match reduction {
            HistoryReduction::Max => Ok(max),
            HistoryReduction::Min => Ok(min),
            HistoryReduction::MaxAbs => Ok(max.max(-min)),
            HistoryReduction::MaxNegative => Ok((0.0 - min).max(0.0)),
            HistoryReduction::Amplitude => Ok(0.5 * (max - min)),
            HistoryReduction::PeriodS => self.period_s(),
            HistoryReduction::HumpDurationS => self.hump_duration_s(max),
            HistoryReduction::AsymmetryWithinM(way_m) => self.asymmetry(moments, way_m, max),
        }
    }

    /// Times of the zero crossings, interpolated.
    fn zeros(&self) -> Vec<f64> {
        let pairs = self.time_s.windows(2).zip(self.values.windows(2));
        pairs
            .filter(|(_, w)| (w[0] > 0.0) != (w[1] > 0.0))
            .map(|(t, w)| t[0] + (t[1] - t[0]) * w[0] / (w[0] - w[1]))
            .collect()
    }

    fn period_s(&self) -> Result<f64, NoValue> {
        match self.zeros().as_slice() {
            [first, .., last] => Ok(2.0 * (last - first) / (self.zeros().len() - 1) as f64),
            few => Err(NoValue::NoPeriod(few.len())),
        }
    }

    fn hump_duration_s(&self, max: f64) -> Result<f64, NoValue> {
        let top = self.points().find(|&(_, w)| w == max).map_or(0.0, |(t, _)| t);
        let zeros = self.zeros();
        let before = zeros.iter().copied().filter(|&t| t < top).fold(None, |_, t| Some(t));
        let after = zeros.iter().copied().find(|&t| t > top);
        before
            .zip(after)
            .map(|(before, after)| after - before)
            .ok_or(NoValue::NoHump)
    }

    /// The value at a time, interpolated.
    fn at(&self, time_s: f64) -> Option<f64> {
        let i = self.time_s.partition_point(|&t| t < time_s - SAME_TIME_S);
        let (t1, w1) = (*self.time_s.get(i)?, self.values[i]);
        if (t1 - time_s).abs() <= SAME_TIME_S {
            return Some(w1);
        }
        let (t0, w0) = (*self.time_s.get(i.checked_sub(1)?)?, self.values[i - 1]);
        Some(w0 + (w1 - w0) * (time_s - t0) / (t1 - t0))
    }

    /// Largest `|w(t_a - s) - w(t_a + s)|` over the largest value, where the history has both.
    fn asymmetry(&self, moments: &Moments, way_m: f64, max: f64) -> Result<f64, NoValue> {
        let reach_s = way_m / moments.speed_m_s;
        let covered = |t: f64| self.at(t).is_some();
        if !(covered(moments.arrival_s - reach_s) && covered(moments.arrival_s + reach_s)) {
            return Err(NoValue::ShortAbout(way_m));
        }
        let differences = self
            .time_s
            .iter()
            .map(|t| t - moments.arrival_s)
            .filter(|s| (0.0..=reach_s).contains(s))
            .filter_map(|s| {
                let (before, after) = (self.at(moments.arrival_s - s)?, self.at(moments.arrival_s + s)?);
                Some((before - after).abs())
            });
        let largest = differences.fold(None, |most: Option<f64>, d| Some(most.map_or(d, |m| m.max(d))));
        largest
            .filter(|_| max > 0.0)
            .map(|d| d / max)
            .ok_or(NoValue::NoHumpAbout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const MOMENTS: Moments = Moments {
        speed_m_s: 2.0,
        arrival_s: 5.0,
        leaving_s: 8.0,
    };

    fn sampled(f: impl Fn(f64) -> f64) -> ValueHistory {
        let time_s: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
        ValueHistory {
            values: time_s.iter().map(|&t| f(t)).collect(),
            time_s,
        }
    }

    fn reduced(history: &ValueHistory, reduction: HistoryReduction) -> f64 {
        history.reduced(&MOMENTS, reduction).unwrap()
    }

    #[test]
    fn a_sine_has_its_period_amplitude_and_hump() {
        let sine = sampled(|t| 3.0 * (2.0 * PI * (t - 0.3) / 1.6).sin());
        assert!((reduced(&sine, HistoryReduction::PeriodS) - 1.6).abs() < 1e-3);
        assert!((reduced(&sine, HistoryReduction::Amplitude) - 3.0).abs() < 1e-3);
        assert!((reduced(&sine, HistoryReduction::HumpDurationS) - 0.8).abs() < 1e-3);
        assert!((reduced(&sine, HistoryReduction::MaxNegative) - 3.0).abs() < 1e-3);
    }

    #[test]
    fn parts_begin_and_end_where_the_vehicle_is() {
        let line = sampled(|t| t);
        let part = line
            .part(&MOMENTS, Some(Edge::CentrePastM(2.0)), Some(Edge::AfterLeavingS(0.5)))
            .unwrap();
        assert!((part.time_s[0] - 6.0).abs() < 1e-9 && (reduced(&part, HistoryReduction::Max) - 8.5).abs() < 1e-9);
        let part = line.part(&MOMENTS, None, Some(Edge::TimeS(0.1))).unwrap();
        assert_eq!(part.time_s.len(), 11);
        assert!(
            line.part(&MOMENTS, Some(Edge::TimeS(11.0)), None)
                .unwrap_err()
                .to_string()
                .contains("0 values")
        );
    }

    #[test]
    fn asymmetry_is_that_of_what_is_odd_about_the_arrival() {
        let hump = |t: f64| (-((t - 5.0) / 2.0).powi(2)).exp();
        assert!(reduced(&sampled(hump), HistoryReduction::AsymmetryWithinM(4.0)) < 1e-12);
        // 0.01 (t - 5) differs by 0.02 s at s; within 4 m at 2 m/s s is 2
        let tilted = sampled(|t| hump(t) + 0.01 * (t - 5.0));
        let found = reduced(&tilted, HistoryReduction::AsymmetryWithinM(4.0));
        assert!((found - 0.04).abs() < 1e-4, "{found}");
    }

    #[test]
    fn what_never_crosses_zero_has_no_period() {
        assert!(sampled(|_| 1.0).reduced(&MOMENTS, HistoryReduction::PeriodS).is_err());
    }
}
