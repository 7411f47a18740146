//! Water with memory on the modes: the states of its kernel, laid out for lanes, and what a step length makes of them (W7).
//!
//! Knows which motions the modes make and which forces the states give. Does not know crossings.

use super::panel::Panel;
use super::persist::NumberReader;
use crate::bridge::{Bridge, BridgeWaves};
use crate::radiation::{Filter, RealisationError, StateGroup, StepCoefficients};
use faer::Mat;
use nalgebra::{Complex, DMatrix};

/// Rolls of a mode below this share of the largest motion of any mode are rounding of its shape.
const NO_ROLL: f64 = 1e-9;

/// Water with memory on the modes of an operator.
#[derive(Debug, Clone, Default)]
pub(super) struct OperatorWaves {
    /// Groups of motions, those of heave with pitch before those of rolls.
    pub(super) groups: Vec<WaveGroup>,
    /// The error of the kernel by its states, as a share of its rms.
    pub(super) kernel_error: f64,
    /// The least eigenvalue of Re K(i w) over the largest, before filters lift it to 0.
    pub(super) least_over_largest: f64,
    pub(super) real_states: usize,
}

/// A group of motions with its states.
#[derive(Debug, Clone)]
pub(super) struct WaveGroup {
    rolls: bool,
    /// Motions of the group on the modes, `W^T G Phi`, motions x modes.
    motions: DMatrix<f64>,
    /// What pins feel of its forces, pins x motions.
    pins: DMatrix<f64>,
    poles_1_s: Vec<Complex<f64>>,
    /// Motions x poles.
    shapes: DMatrix<Complex<f64>>,
    /// Filters on the motions.
    filters: Vec<Filter>,
}

impl OperatorWaves {
    /// Of a bridge's waves on the shapes of its first `modes`; `pins` says whether pins are followed.
    pub(super) fn new(
        bridge: &Bridge,
        waves: &BridgeWaves,
        (shapes, modes): (&Mat<f64>, usize),
        pins: bool,
    ) -> Result<Self, RealisationError> {
        let states = waves.radiation.states()?;
        let on_modes = DMatrix::from_fn(waves.motions.len(), modes, |freedom, k| {
            waves.motions[freedom].0.iter().map(|&(i, g)| g * shapes[(i, k)]).sum()
        });
        let rows = bridge.pins.iter().flat_map(|pin| &pin.rows);
        let rows: Vec<_> = rows.filter(|_| pins).map(|row| &row.waves.0).collect();
        let of_group = |group: &StateGroup| WaveGroup {
            rolls: group.rolls,
            motions: group.motions.transpose() * &on_modes,
            pins: DMatrix::from_fn(rows.len(), group.motions.ncols(), |i, j| {
                rows[i]
                    .iter()
                    .map(|&(freedom, share)| share * group.motions[(freedom, j)])
                    .sum()
            }),
            poles_1_s: group.poles_1_s.clone(),
            shapes: group.shapes.clone(),
            filters: group.filters.clone(),
        };
        Ok(Self {
            groups: states.groups().iter().map(of_group).collect(),
            least_over_largest: states.passivity().least_over_largest(),
            real_states: states.real_states(),
            kernel_error: states.kernel_error(),
        })
    }

    /// On modes that are their own mirror images, which do not roll.
    pub(super) fn of_side(&self, modes: &[usize]) -> Self {
        let of_group = |group: &WaveGroup| WaveGroup {
            motions: group.motions.select_columns(modes),
            ..group.clone()
        };
        Self {
            groups: self.of_kind(false).into_iter().map(of_group).collect(),
            ..self.clone()
        }
    }

    /// Its counts: real states, and of each group whether it rolls, motions, poles, filters.
    pub(super) fn counts(&self) -> Vec<u64> {
        let of_group = |group: &WaveGroup| {
            let rolls = usize::from(group.rolls);
            [rolls, group.motions.nrows(), group.poles_1_s.len(), group.filters.len()]
        };
        let groups = self.groups.iter().flat_map(of_group);
        [self.real_states].into_iter().chain(groups).map(|n| n as u64).collect()
    }

    /// Its numbers.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let mut numbers = vec![self.kernel_error, self.least_over_largest];
        for group in &self.groups {
            numbers.extend(group.motions.iter().chain(group.pins.iter()));
            let complex = group.poles_1_s.iter().chain(group.shapes.iter());
            numbers.extend(complex.flat_map(|x| [x.re, x.im]));
            for filter in &group.filters {
                numbers.extend([filter.pole_1_s.re, filter.pole_1_s.im]);
                numbers.extend(filter.stiffness_n_m.iter());
            }
        }
        numbers
    }

    /// Of counts and numbers; none where they do not fit.
    pub(super) fn read(counts: &[usize], [modes, pins]: [usize; 2], r: &mut NumberReader<'_>) -> Option<Self> {
        let &[kernel_error, least_over_largest] = &r.list(2)?[..] else {
            return None;
        };
        let (&real_states, counts) = counts.split_first()?;
        let (counts, rest) = counts.as_chunks::<4>();
        if !rest.is_empty() {
            return None;
        }
        let complex = |r: &mut NumberReader<'_>, count: usize| -> Option<Vec<Complex<f64>>> {
            Some(
                r.list(2 * count)?
                    .as_chunks::<2>()
                    .0
                    .iter()
                    .map(|&[re, im]| Complex::new(re, im))
                    .collect(),
            )
        };
        let mut groups = Vec::new();
        for &[rolls, motions, poles, filters] in counts {
            groups.push(WaveGroup {
                rolls: rolls != 0,
                motions: r.matrix(motions, modes)?,
                pins: r.matrix(pins, motions)?,
                poles_1_s: complex(r, poles)?,
                shapes: DMatrix::from_vec(motions, poles, complex(r, motions * poles)?),
                filters: {
                    let filter = || {
                        Some(Filter {
                            pole_1_s: *complex(r, 1)?.first()?,
                            stiffness_n_m: r.matrix(motions, motions)?,
                        })
                    };
                    std::iter::repeat_with(filter).take(filters).collect::<Option<_>>()?
                },
            });
        }
        Some(Self {
            groups,
            kernel_error,
            least_over_largest,
            real_states,
        })
    }

    /// The groups that roll, or those that do not.
    fn of_kind(&self, rolls: bool) -> Vec<&WaveGroup> {
        self.groups.iter().filter(|group| group.rolls == rolls).collect()
    }

    /// Motions of heave with pitch, and of rolls.
    pub(super) fn motions(&self) -> [usize; 2] {
        [false, true].map(|rolls| self.of_kind(rolls).iter().map(|group| group.motions.nrows()).sum())
    }

    /// Poles of heave with pitch, and of rolls; a filter has one for each motion.
    pub(super) fn poles(&self) -> [usize; 2] {
        let of = |group: &&WaveGroup| group.poles_1_s.len() + group.filters.len() * group.motions.nrows();
        [false, true].map(|rolls| self.of_kind(rolls).iter().map(of).sum())
    }

    /// The modes that roll, each with its largest roll.
    pub(super) fn rolling(&self) -> Vec<(usize, f64)> {
        let modes = self.groups.first().map_or(0, |group| group.motions.ncols());
        let largest = |k: usize, rolls: bool| {
            let own = self.of_kind(rolls);
            own.iter()
                .map(|group| group.motions.column(k).amax())
                .fold(0.0, f64::max)
        };
        let most = (0..modes).map(|k| largest(k, false)).fold(0.0, f64::max);
        let rolling = (0..modes).map(|k| (k, largest(k, true)));
        rolling.filter(|(_, roll)| *roll > NO_ROLL * most).collect()
    }
}

/// What a step length makes of the water: of heave with pitch, and of rolls.
#[derive(Debug, Clone)]
pub(super) struct WaveConstants {
    pub(super) kinds: [WaveKind; 2],
    /// The modes that roll, each with its largest roll.
    pub(super) rolling: Vec<(usize, f64)>,
}

/// Groups of one kind.
#[derive(Debug, Clone)]
pub(super) struct WaveKind {
    /// Motions of the modes' velocities, motions x modes, and its transpose.
    pub(super) motions: Panel,
    pub(super) forces: Panel,
    /// What pins feel.
    pub(super) pins: Panel,
    pub(super) groups: Vec<GroupSteps>,
}

/// The step of a group's states.
#[derive(Debug, Clone)]
pub(super) struct GroupSteps {
    pub(super) motions: usize,
    /// Of each pole decay, p0 and p1, real and imaginary part.
    pub(super) poles: Vec<[f64; 6]>,
    /// `[Re g, Im g]^T`, twice the poles x motions.
    pub(super) inputs: Panel,
    /// `[-Re g, Im g, -D_1]`, motions x (twice the poles + motions): the force of states and of the velocity at the step's end.
    pub(super) outputs: Panel,
    /// Of each filter decay, p0 and p1, and the forces of their states' real parts, `-D` side by side.
    pub(super) filters: Vec<[f64; 6]>,
    pub(super) filtered: Panel,
}

impl WaveConstants {
    /// Of steps of `h` `[s]`.
    pub(super) fn new(of: &OperatorWaves, h: f64) -> Self {
        let kind = |rolls: bool| {
            let groups = of.of_kind(rolls);
            let modes = groups.first().map_or(0, |group| group.motions.ncols());
            let pins = groups.first().map_or(0, |group| group.pins.nrows());
            let place: Vec<(&WaveGroup, usize)> = groups
                .iter()
                .flat_map(|&group| (0..group.motions.nrows()).map(move |row| (group, row)))
                .collect();
            WaveKind {
                motions: Panel::new(place.len(), modes, |i, k| place[i].0.motions[(place[i].1, k)]),
                forces: Panel::new(modes, place.len(), |k, i| place[i].0.motions[(place[i].1, k)]),
                pins: Panel::new(pins, place.len(), |p, i| place[i].0.pins[(p, place[i].1)]),
                groups: groups.iter().map(|group| GroupSteps::new(group, h)).collect(),
            }
        };
        Self {
            kinds: [false, true].map(kind),
            rolling: of.rolling(),
        }
    }
}

impl WaveKind {
    /// Poles of its groups, filters apart.
    #[inline(always)]
    pub(super) fn poles(&self) -> usize {
        self.groups.iter().map(|group| group.poles.len()).sum()
    }
}

impl GroupSteps {
    fn new(group: &WaveGroup, h: f64) -> Self {
        let (n, g) = (group.poles_1_s.len(), &group.shapes);
        let motions = g.nrows();
        let steps: Vec<StepCoefficients> = group.poles_1_s.iter().map(|&s| StepCoefficients::new(s, h)).collect();
        let of_step = |s: &StepCoefficients| [s.decay.re, s.decay.im, s.p0_s.re, s.p0_s.im, s.p1_s.re, s.p1_s.im];
        let filter = |filter: &Filter| of_step(&StepCoefficients::new(filter.pole_1_s, h));
        let filters: Vec<[f64; 6]> = group.filters.iter().map(filter).collect();
        // what a velocity at the step's end adds to the force there
        let at_end = DMatrix::from_fn(motions, motions, |i, j| {
            let own = |(k, step): (usize, &StepCoefficients)| (g[(i, k)] * step.p1_s * g[(j, k)]).re;
            let of_filter = |(step, filter): (&[f64; 6], &Filter)| filter.stiffness_n_m[(i, j)] * step[4];
            let of_filters = filters.iter().zip(&group.filters).map(of_filter);
            steps.iter().enumerate().map(own).sum::<f64>() + of_filters.sum::<f64>()
        });
        Self {
            motions,
            inputs: Panel::new(2 * n, motions, |row, j| match row.checked_sub(n) {
                None => g[(j, row)].re,
                Some(row) => g[(j, row)].im,
            }),
            outputs: Panel::new(motions, 2 * n + motions, |i, column| match column {
                column if column < n => -g[(i, column)].re,
                column if column < 2 * n => g[(i, column - n)].im,
                column => -at_end[(i, column - 2 * n)],
            }),
            poles: steps.iter().map(of_step).collect(),
            filtered: Panel::new(motions, motions * filters.len(), |i, column| {
                -group.filters[column / motions].stiffness_n_m[(i, column % motions)]
            }),
            filters,
        }
    }
}

impl OperatorWaves {
    /// What is told of the states.
    pub(super) fn told(&self) -> WaveStates {
        WaveStates {
            real_states: self.real_states,
            kernel_error: self.kernel_error,
            least_over_largest: self.least_over_largest,
        }
    }
}

/// The states of the water in an operator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveStates {
    /// Real states: two of each pair of conjugate poles.
    pub real_states: usize,
    /// The rms error of the kernel by its states, as a share of the kernel's rms; see [`kernel_error`](crate::radiation::Realisation::kernel_error).
    pub kernel_error: f64,
    /// The least eigenvalue of Re K(i w) of the states over the largest, before filters lift it to 0.
    pub least_over_largest: f64,
}
