//! Designs that draw their points: the axes and what they are drawn from, read and checked.
//!
//! Knows forms, counts and ranges. Does not know how a point is drawn.

use super::axes::{Axis, AxisValues, NamedAxis};
use super::forms::{MorrisSpec, RangeMap, SaltelliSpec, SampleSpec};
use super::points::{MorrisSample, PointSource, RandomSample, SaltelliSample, SampledAxis, factors};
use super::sampling::SobolPoints;
use super::values::{MOST_POINTS, numbers};
use crate::input::{Cell, FoundValue, Refusal, RefusalKind};
use serde_json::Value;
use std::ops::RangeInclusive;
use std::path::Path;

/// Most parts of all ranges of a Latin hypercube, whose orders take four bytes a part.
const MOST_PARTS: usize = 100_000_000;

/// Most levels of Morris's trajectories.
const MOST_LEVELS: usize = 1000;

/// Reads samples of one file. Each reads the axes, and how their points are made.
pub(super) struct SampleReader<'a> {
    pub(super) file: &'a Path,
    /// Names to suggest.
    pub(super) known: &'a [String],
}

/// Axes and how their points are made.
type ReadSample = Result<(Vec<Axis>, PointSource), Refusal>;

impl SampleReader<'_> {
    fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl Into<FoundValue>,
        allowed: impl Into<String>,
    ) -> Result<T, Refusal> {
        Err(Refusal::new(self.file, key, found, allowed))
    }

    /// A Latin hypercube at `key`.
    pub(super) fn latin_hypercube(&self, key: &str, spec: &SampleSpec) -> ReadSample {
        let (axes, sample) = self.sample(key, spec)?;
        let ranges = factors(&sample.drawn);
        if sample.count > MOST_PARTS / ranges {
            let found = format!("{} points of {ranges} ranges", sample.count);
            let allowed = format!("at most {} points of so many ranges", MOST_PARTS / ranges);
            return self.refuse(format!("{key}.count"), found, allowed);
        }
        Ok((axes, PointSource::LatinHypercube(sample)))
    }

    /// Points of Sobol' at `key`.
    pub(super) fn sobol(&self, key: &str, spec: &SampleSpec) -> ReadSample {
        let (axes, sample) = self.sample(key, spec)?;
        self.check_dimensions(key, &sample.drawn, SobolPoints::MOST_DIMENSIONS)?;
        Ok((axes, PointSource::Sobol(sample)))
    }

    /// A design of Saltelli at `key`.
    pub(super) fn saltelli(&self, key: &str, spec: &SaltelliSpec) -> ReadSample {
        self.check_count(&format!("{key}.count"), spec.count, 2..=MOST_POINTS)?;
        let (axes, drawn) = self.axes(key, &spec.ranges)?;
        self.check_dimensions(key, &drawn, SobolPoints::MOST_DIMENSIONS / 2)?;
        let sample = SaltelliSample {
            count: spec.count,
            seed: spec.seed,
            second_order: spec.second_order,
            drawn,
        };
        Ok((axes, PointSource::Saltelli(sample)))
    }

    /// A design of Morris at `key`.
    pub(super) fn morris(&self, key: &str, spec: &MorrisSpec) -> ReadSample {
        self.check_count(&format!("{key}.trajectories"), spec.trajectories, 2..=MOST_POINTS)?;
        if !(2..=MOST_LEVELS).contains(&spec.levels) || spec.levels % 2 == 1 {
            let allowed = format!("an even number from 2 to {MOST_LEVELS}");
            return self.refuse(format!("{key}.levels"), spec.levels, allowed);
        }
        let (axes, drawn) = self.axes(key, &spec.ranges)?;
        let sample = MorrisSample {
            trajectories: spec.trajectories,
            levels: spec.levels,
            seed: spec.seed,
            drawn,
        };
        Ok((axes, PointSource::Morris(sample)))
    }

    fn check_count(&self, key: &str, count: usize, allowed: RangeInclusive<usize>) -> Result<(), Refusal> {
        if allowed.contains(&count) {
            return Ok(());
        }
        let allowed = format!("a whole number from {} to {}", allowed.start(), allowed.end());
        self.refuse(key, count, allowed)
    }

    fn check_dimensions(&self, key: &str, drawn: &[SampledAxis], most: usize) -> Result<(), Refusal> {
        match factors(drawn) {
            found if found > most => {
                let allowed = format!("at most {most} ranges");
                self.refuse(format!("{key}.ranges"), format!("{found} ranges"), allowed)
            }
            _ => Ok(()),
        }
    }

    /// The axes of a sample and what they are drawn from; `key` is where its count stands.
    fn sample(&self, key: &str, spec: &SampleSpec) -> Result<(Vec<Axis>, RandomSample), Refusal> {
        self.check_count(&format!("{key}.count"), spec.count, 1..=MOST_POINTS)?;
        let (axes, drawn) = self.axes(key, &spec.ranges)?;
        let sample = RandomSample {
            count: spec.count,
            seed: spec.seed,
            drawn,
        };
        Ok((axes, sample))
    }

    /// The axes of `ranges` below `key`, and what each is drawn from.
    fn axes(&self, key: &str, ranges: &RangeMap) -> Result<(Vec<Axis>, Vec<SampledAxis>), Refusal> {
        let key = format!("{key}.ranges");
        let axis = |(name, written): (&String, &Value)| {
            let at = format!("{key}.{name}");
            let axis = Axis::read(self.file, &at, name, self.known)?;
            Ok((axis, self.drawn(&at, name, written)?))
        };
        let read = ranges.0.iter().map(axis).collect::<Result<Vec<_>, _>>()?;
        let (axes, drawn): (_, Vec<SampledAxis>) = read.into_iter().unzip();
        if !drawn.iter().any(SampledAxis::is_range) {
            let refused = Refusal::new(
                self.file,
                key,
                "no range",
                "at least one axis with a range [from, to], whole or values",
            );
            return Err(refused.because(RefusalKind::Missing));
        }
        Ok((axes, drawn))
    }

    fn drawn(&self, key: &str, name: &str, written: &Value) -> Result<SampledAxis, Refusal> {
        let allowed = "[from, to], two numbers with from below to, {\"whole\": [from, to]}, {\"values\": [...]}, or one number or word";
        let counts = || matches!(NamedAxis::of(name).map(|axis| axis.values), Some(AxisValues::Counts));
        match written {
            Value::Number(_) | Value::String(_) | Value::Bool(_) => {
                Ok(SampledAxis::Constant(Cell::from(written).canonical()))
            }
            Value::Object(map) if map.len() == 1 => match map.iter().next() {
                Some((form, ends)) if form == "whole" => self.whole(&format!("{key}.whole"), ends),
                Some((form, Value::Array(list))) if form == "values" && !list.is_empty() => {
                    Ok(SampledAxis::OneOf(list.iter().map(Cell::from).collect()))
                }
                Some((form, list)) if form == "values" => {
                    self.refuse(format!("{key}.values"), list, "a list of at least one value")
                }
                Some((form, _)) => {
                    let known = ["whole", "values"].map(str::to_owned);
                    Err(Refusal::unknown_key(self.file, format!("{key}.{form}"), form, &known))
                }
                None => self.refuse(key, written, allowed),
            },
            Value::Array(_) if counts() => self.whole(key, written),
            _ if name == "connection" => self.refuse(key, written, "linear or nonlinear, the same for all points"),
            Value::Array(ends) => match (
                ends.as_slice(),
                ends.iter().map(Value::as_f64).collect::<Vec<_>>().as_slice(),
            ) {
                ([_, _], &[Some(from), Some(to)]) if from < to && (to - from).is_finite() => {
                    Ok(SampledAxis::Range(from, to))
                }
                ([_, _], &[Some(from), Some(to)]) if from < to => self.refuse(
                    key,
                    format!("from {from:e} to {to:e}"),
                    "ends that are not so far apart",
                ),
                _ => self.refuse(key, written, allowed),
            },
            _ => self.refuse(key, written, allowed),
        }
    }

    /// The whole numbers of `[from, to]`, both included.
    fn whole(&self, key: &str, ends: &Value) -> Result<SampledAxis, Refusal> {
        // beyond these, numbers of a file are no longer each a number of their own
        const MOST: f64 = 9e15;
        match numbers(ends) {
            Some([from, to]) if from < to && [from, to].iter().all(|end| end.fract() == 0.0 && end.abs() <= MOST) => {
                Ok(SampledAxis::Whole(from as i64, to as i64))
            }
            _ => self.refuse(key, ends, "[from, to], two whole numbers with from below to"),
        }
    }
}
