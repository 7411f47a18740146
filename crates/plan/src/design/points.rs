//! The points of some axes, one after the other.
//!
//! Knows their order. Stores none: a point is made when it is asked for. Does not know what a point means.

use super::axes::Axis;
use super::column::ValueColumn;
use super::condition::Test;
use super::sampling::{LatinHypercubeAxis, SobolPoints};
use super::values::{Values, rounded};
use crate::input::Cell;
use std::sync::Arc;

/// How the points of a block are made.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PointSource {
    /// Every combination of the axes' values.
    Grid(Vec<Values>),
    /// The axes' values one by one; one value stands for all.
    Zip(Vec<Values>),
    /// Drawn at random, one in each part of each range.
    LatinHypercube(RandomSample),
    /// Points of the Sobol' sequence.
    Sobol(RandomSample),
    /// Point by point: the values of each axis, and how many points there are.
    Cases(Arc<Vec<ValueColumn>>, usize),
}

/// Points drawn from ranges.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RandomSample {
    /// Number of points.
    pub(super) count: usize,
    /// Seed.
    pub(super) seed: u64,
    /// What each axis is drawn from.
    pub(super) drawn: Vec<SampledAxis>,
}

/// What an axis of a sample is drawn from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SampledAxis {
    /// One value for all points.
    Constant(Cell<'static>),
    /// From the first to the second number.
    Range(f64, f64),
    /// A whole number from the first to the second, each as likely.
    Whole(i64, i64),
    /// One of some values, each as likely.
    OneOf(ValueColumn),
}

impl PointSource {
    /// Number of points, whatever conditions leave of them; `None` beyond what can be counted.
    pub(super) fn count(&self) -> Option<usize> {
        match self {
            Self::Grid(axes) => axes
                .iter()
                .try_fold(1_usize, |count, values| count.checked_mul(values.len())),
            Self::Zip(axes) => Some(axes.iter().map(Values::len).max().unwrap_or(1)),
            Self::LatinHypercube(sample) | Self::Sobol(sample) => Some(sample.count),
            Self::Cases(_, count) => Some(*count),
        }
    }

    /// Number of points, which may be beyond counting.
    pub(super) fn size(&self) -> f64 {
        match (self, self.count()) {
            (Self::Grid(axes), None) => axes.iter().map(|values| values.len() as f64).product(),
            (_, count) => count.map_or(f64::INFINITY, |count| count as f64),
        }
    }
}

/// The points of some axes, in order, that meet conditions, each with its number among all: of a grid the first axis changes
/// slowest.
pub(super) fn values<'a>(
    axes: &'a [Axis],
    point_source: &'a PointSource,
    tests: &'a [Test],
) -> impl Iterator<Item = (usize, Vec<Cell<'a>>)> {
    let mut source = ValueSource::of(axes, point_source);
    (0..point_source.count().unwrap_or(0))
        .map_while(move |number| Some((number, source.values(number)?)))
        .filter(|(_, values)| tests.iter().all(|test| test.met(values)))
}

/// What the values of the next point come from.
enum ValueSource<'a> {
    Grid(&'a [Values]),
    Zip(&'a [Values]),
    /// With the coordinates of the ranges.
    LatinHypercube(&'a [SampledAxis], Vec<LatinHypercubeAxis>),
    /// With the dimension of each range, in the order of the axes.
    Sobol(&'a [SampledAxis], Vec<usize>, SobolPoints),
    Cases(&'a [ValueColumn]),
}

impl<'a> ValueSource<'a> {
    fn of(axes: &[Axis], point_source: &'a PointSource) -> Self {
        match point_source {
            PointSource::Grid(values) => Self::Grid(values),
            PointSource::Zip(values) => Self::Zip(values),
            PointSource::LatinHypercube(RandomSample { count, seed, drawn }) => {
                let names = names_of_ranges(axes, drawn);
                let strata = names.iter().map(|name| LatinHypercubeAxis::new(*count, *seed, name));
                Self::LatinHypercube(drawn, strata.collect())
            }
            PointSource::Sobol(RandomSample { seed, drawn, .. }) => {
                let dimensions = dimensions(&names_of_ranges(axes, drawn));
                let points = SobolPoints::new(dimensions.len(), *seed);
                Self::Sobol(drawn, dimensions, points)
            }
            PointSource::Cases(columns, _) => Self::Cases(columns),
        }
    }

    /// The values of a point, to be asked from the first on; nothing where the sequence ends.
    fn values(&mut self, number: usize) -> Option<Vec<Cell<'a>>> {
        match self {
            Self::Grid(axes) => {
                let axes: &'a [Values] = axes;
                let mut rest = number;
                let mut values = Vec::with_capacity(axes.len());
                for axis in axes.iter().rev() {
                    values.push(axis.at(rest % axis.len()));
                    rest /= axis.len();
                }
                values.reverse();
                Some(values)
            }
            Self::Zip(axes) => {
                let axes: &'a [Values] = axes;
                let value = |values: &'a Values| values.at(if values.len() == 1 { 0 } else { number });
                Some(axes.iter().map(value).collect())
            }
            Self::LatinHypercube(drawn, strata) => {
                drawn_values(drawn, strata.iter_mut().map(|strata| strata.share(number)))
            }
            Self::Sobol(drawn, dimensions, points) => {
                let shares = points.next()?;
                drawn_values(drawn, dimensions.iter().map(|&dimension| shares[dimension]))
            }
            Self::Cases(columns) => {
                let columns: &'a [ValueColumn] = columns;
                Some(columns.iter().map(|column| column.at(number)).collect())
            }
        }
    }
}

/// The names that the random numbers of the ranges follow from, in the order of the axes.
fn names_of_ranges<'a>(axes: &'a [Axis], drawn: &[SampledAxis]) -> Vec<&'a str> {
    let ranges = axes.iter().zip(drawn).filter(|(_, drawn)| drawn.is_range());
    ranges.map(|(axis, _)| axis.drawn_by()).collect()
}

/// The dimension of each of some names: their place in the order of the alphabet, whatever the order of the file.
fn dimensions(names: &[&str]) -> Vec<usize> {
    let before = |name: &&str| names.iter().filter(|other| *other < name).count();
    names.iter().map(before).collect()
}

impl SampledAxis {
    /// Whether it is drawn, and so has random numbers of its own.
    pub(super) fn is_range(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }
}

/// The place of a share, 0 to 1, among so many equal parts.
fn part(share: f64, parts: usize) -> usize {
    ((share * parts as f64) as usize).min(parts - 1)
}

/// The values of a point whose ranges have these coordinates.
fn drawn_values<'a>(drawn: &'a [SampledAxis], mut shares: impl Iterator<Item = f64>) -> Option<Vec<Cell<'a>>> {
    let value = |drawn: &'a SampledAxis| match drawn {
        SampledAxis::Constant(value) => Some(value.borrowed()),
        SampledAxis::Range(from, to) => {
            let x = rounded(from + (to - from) * shares.next()?);
            Some(Cell::written(x.clamp(*from, *to)))
        }
        SampledAxis::Whole(from, to) => {
            let parts = usize::try_from(to - from).ok()?.saturating_add(1);
            Some(Cell::Whole(from + part(shares.next()?, parts) as i64))
        }
        SampledAxis::OneOf(values) => Some(values.at(part(shares.next()?, values.len()))),
    };
    drawn.iter().map(value).collect()
}
