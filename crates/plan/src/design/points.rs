//! The points of some axes, one after the other.
//!
//! Knows their order. Stores none: a point is made when it is asked for. Does not know what a point means.

use super::axes::Axis;
use super::column::ValueColumn;
use super::condition::Test;
use super::grid_sieve::GridSieve;
use super::saltelli::SaltelliRow;
use super::sampling::{LatinHypercubeAxis, SobolPoints};
use super::trajectories::{MorrisWalk, Trajectories, Trajectory};
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
    /// Two samples of that sequence and what is made of their rows.
    Saltelli(SaltelliSample),
    /// Trajectories.
    Morris(MorrisSample),
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

/// Two samples A and B, and of each row the points that have one factor of the other sample.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SaltelliSample {
    /// Number of rows of each sample.
    pub(super) count: usize,
    /// Seed.
    pub(super) seed: u64,
    /// Whether rows of B with one factor of A are points too.
    pub(super) second_order: bool,
    /// What each axis is drawn from.
    pub(super) drawn: Vec<SampledAxis>,
}

/// Trajectories over ranges.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MorrisSample {
    /// Number of trajectories.
    pub(super) trajectories: usize,
    /// Levels of each range.
    pub(super) levels: usize,
    /// Seed.
    pub(super) seed: u64,
    /// What each axis is drawn from.
    pub(super) drawn: Vec<SampledAxis>,
}

impl SaltelliSample {
    /// Points of one row: A, A with each factor of B, with pairs B with each factor of A, B.
    fn width(&self) -> usize {
        let factors = self.drawn.iter().filter(|drawn| drawn.is_range()).count();
        if self.second_order {
            2 * factors + 2
        } else {
            factors + 2
        }
    }
}

impl MorrisSample {
    /// Points of one trajectory.
    fn width(&self) -> usize {
        factors(&self.drawn) + 1
    }
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
            Self::Saltelli(sample) => sample.count.checked_mul(sample.width()),
            Self::Morris(sample) => sample.trajectories.checked_mul(sample.width()),
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

    /// What each axis is drawn from; nothing where axes are listed.
    pub(super) fn drawn(&self) -> &[SampledAxis] {
        match self {
            Self::LatinHypercube(sample) | Self::Sobol(sample) => &sample.drawn,
            Self::Saltelli(sample) => &sample.drawn,
            Self::Morris(sample) => &sample.drawn,
            Self::Grid(_) | Self::Zip(_) | Self::Cases(..) => &[],
        }
    }

    /// The trajectories of Morris; none of another form.
    pub(super) fn trajectories(&self, axes: &[Axis]) -> Option<impl Iterator<Item = Trajectory> + use<>> {
        let Self::Morris(sample) = self else { return None };
        let names = names_of_ranges(axes, &sample.drawn);
        Some(Trajectories::new(&names, sample.levels, sample.seed).take(sample.trajectories))
    }
}

/// The points of some axes, in order, that meet conditions, each with its number among all: of a grid the first axis changes
/// slowest. Of a point that does not meet them no value is made but those that conditions ask for.
pub(super) fn values<'a>(
    axes: &'a [Axis],
    point_source: &'a PointSource,
    tests: &'a [Test],
) -> impl Iterator<Item = (usize, Vec<Cell<'a>>)> {
    let values = |source: &ValueSource<'a>| (0..axes.len()).map(|axis| source.value(axis)).collect();
    met(axes, point_source, tests, move |number, source| {
        (number, values(source))
    })
}

/// How many points meet conditions.
pub(super) fn count_met(axes: &[Axis], point_source: &PointSource, tests: &[Test]) -> usize {
    met(axes, point_source, tests, |_, _| ()).count()
}

/// What is made of each point that meets conditions.
fn met<'a, T>(
    axes: &'a [Axis],
    point_source: &'a PointSource,
    tests: &'a [Test],
    of: impl Fn(usize, &ValueSource<'a>) -> T,
) -> impl Iterator<Item = T> {
    let mut source = ValueSource::of(axes, point_source);
    let sieve = match point_source {
        PointSource::Grid(values) if !tests.is_empty() => Some(GridSieve::new(values, tests)),
        _ => None,
    };
    let mut numbers = 0..point_source.count().unwrap_or(0);
    std::iter::from_fn(move || {
        for number in numbers.by_ref() {
            if sieve.as_ref().is_some_and(|sieve| !sieve.passes(number)) {
                continue;
            }
            source.go_to(number)?;
            if sieve.is_some() || tests.iter().all(|test| test.met(|axis| source.value(axis))) {
                return Some(of(number, &source));
            }
        }
        None
    })
}

/// What the values of the point under way come from.
enum ValueSource<'a> {
    /// With the place of each axis's value.
    Grid(&'a [Values], Vec<usize>),
    /// With the number of the point.
    Zip(&'a [Values], usize),
    /// With the coordinates of the ranges.
    LatinHypercube(Drawn<'a>, Vec<LatinHypercubeAxis>),
    /// With the dimension of each range, in the order of the axes.
    Sobol(Drawn<'a>, Vec<usize>, SobolPoints),
    /// With the row under way.
    Saltelli(Drawn<'a>, SaltelliRow),
    /// With the trajectory under way.
    Morris(Drawn<'a>, MorrisWalk),
    /// With the number of the point.
    Cases(&'a [ValueColumn], usize),
}

/// Axes that are drawn, with the coordinate of each range at the point under way.
struct Drawn<'a> {
    axes: &'a [SampledAxis],
    /// Of each axis the place of its coordinate, where it is a range.
    places: Vec<usize>,
    shares: Vec<f64>,
}

impl<'a> Drawn<'a> {
    fn new(axes: &'a [SampledAxis]) -> Self {
        let before = |i: usize| axes[..i].iter().filter(|axis| axis.is_range()).count();
        Self {
            axes,
            places: (0..axes.len()).map(before).collect(),
            shares: vec![0.0; before(axes.len())],
        }
    }

    fn value(&self, axis: usize) -> Cell<'a> {
        let share = || self.shares[self.places[axis]];
        match &self.axes[axis] {
            SampledAxis::Constant(value) => value.borrowed(),
            SampledAxis::Range(from, to) => {
                let x = rounded(from + (to - from) * share());
                Cell::written(x.clamp(*from, *to))
            }
            SampledAxis::Whole(from, to) => {
                let parts = usize::try_from(to - from).unwrap_or(usize::MAX).saturating_add(1);
                Cell::Whole(from + part(share(), parts) as i64)
            }
            SampledAxis::OneOf(values) => values.at(part(share(), values.len())),
        }
    }
}

impl<'a> ValueSource<'a> {
    fn of(axes: &[Axis], point_source: &'a PointSource) -> Self {
        match point_source {
            PointSource::Grid(values) => Self::Grid(values, vec![0; values.len()]),
            PointSource::Zip(values) => Self::Zip(values, 0),
            PointSource::LatinHypercube(RandomSample { count, seed, drawn }) => {
                let names = names_of_ranges(axes, drawn);
                let strata = names.iter().map(|name| LatinHypercubeAxis::new(*count, *seed, name));
                Self::LatinHypercube(Drawn::new(drawn), strata.collect())
            }
            PointSource::Sobol(RandomSample { seed, drawn, .. }) => {
                let dimensions = dimensions(&names_of_ranges(axes, drawn));
                let points = SobolPoints::new(dimensions.len(), *seed);
                Self::Sobol(Drawn::new(drawn), dimensions, points)
            }
            PointSource::Saltelli(sample) => {
                let dimensions = dimensions(&names_of_ranges(axes, &sample.drawn));
                let row = SaltelliRow::new(dimensions, sample.seed, sample.second_order);
                Self::Saltelli(Drawn::new(&sample.drawn), row)
            }
            PointSource::Morris(sample) => {
                let names = names_of_ranges(axes, &sample.drawn);
                let walk = MorrisWalk::new(&names, sample.levels, sample.seed);
                Self::Morris(Drawn::new(&sample.drawn), walk)
            }
            PointSource::Cases(columns, _) => Self::Cases(columns, 0),
        }
    }

    /// Goes to a point; of what is drawn from each to the next. Nothing where the sequence ends.
    fn go_to(&mut self, number: usize) -> Option<()> {
        match self {
            Self::Grid(axes, places) => {
                let mut rest = number;
                for (axis, place) in axes.iter().zip(places).rev() {
                    *place = rest % axis.len();
                    rest /= axis.len();
                }
            }
            Self::Zip(_, at) | Self::Cases(_, at) => *at = number,
            Self::LatinHypercube(drawn, strata) => {
                for (share, strata) in drawn.shares.iter_mut().zip(strata) {
                    *share = strata.share(number);
                }
            }
            Self::Sobol(drawn, dimensions, points) => {
                let shares = points.next()?;
                for (share, &dimension) in drawn.shares.iter_mut().zip(&*dimensions) {
                    *share = shares[dimension];
                }
            }
            Self::Saltelli(drawn, row) => {
                row.go_to(number)?;
                let shares = drawn.shares.iter_mut().enumerate();
                shares.for_each(|(factor, share)| *share = row.share(factor));
            }
            Self::Morris(drawn, walk) => {
                walk.go_to(number)?;
                let shares = drawn.shares.iter_mut().enumerate();
                shares.for_each(|(factor, share)| *share = walk.share(factor));
            }
        }
        Some(())
    }

    /// The value of an axis at the point under way.
    fn value(&self, axis: usize) -> Cell<'a> {
        match self {
            Self::Grid(axes, places) => axes[axis].at(places[axis]),
            Self::Zip(axes, number) => axes[axis].at(if axes[axis].len() == 1 { 0 } else { *number }),
            Self::LatinHypercube(drawn, _)
            | Self::Sobol(drawn, ..)
            | Self::Saltelli(drawn, _)
            | Self::Morris(drawn, _) => drawn.value(axis),
            Self::Cases(columns, number) => columns[axis].at(*number),
        }
    }
}

/// Number of axes that are drawn.
pub(super) fn factors(drawn: &[SampledAxis]) -> usize {
    drawn.iter().filter(|drawn| drawn.is_range()).count()
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
