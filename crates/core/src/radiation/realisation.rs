//! The memory of the water as states: a few exponentials in place of a convolution.
//!
//! Knows a kernel, the groups of motions, and what makes states passive. Does not know modes or the step of the bridge.

use super::exponentials::Passivity;
use super::hankel::{self, HankelError};
use super::passive::{self, Filter};
use super::{FREEDOMS_PER_MODULE, Kernel, Scales, Window, motions};
use crate::input::{InvalidInput, positive};
use nalgebra::{Complex, DMatrix};
use thiserror::Error;

/// The least eigenvalue of Re K(i w) over the largest below which a realisation is refused `[-]`.
const PASSIVITY_REFUSES: f64 = -0.02;

/// The rms error of the kernel by its states beyond which a realisation is refused `[-]`: crossings of waters within 4 % agree with the
/// convolution, of one at 44 % forces were 12 % off.
const ERROR_REFUSES: f64 = 0.05;

/// How a realisation is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Eigenvalues of the Hankel matrix below this share of the largest are dropped `[-]`.
    pub tolerance: f64,
    /// Step of the samples `[s]`.
    pub dt_s: f64,
    /// The window in which the kernel is sampled, to its end.
    pub window: Window,
}

impl Default for Fit {
    /// Tolerance 4e-3, samples of 0.1 s over 40 s: crossings of a linear bridge are within 0.05 % of the convolution.
    fn default() -> Self {
        Self {
            tolerance: 4e-3,
            dt_s: 0.1,
            window: Window::STATES,
        }
    }
}

/// Why a kernel has no realisation.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RealisationError {
    /// A number of the fit was refused.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// The samples have no exponentials.
    #[error(transparent)]
    Hankel(#[from] HankelError),
    /// The states are not the memory.
    #[error(
        "the states repeat its memory within {error}, at most 0.05 is allowed: look for a damping that jumps over the frequency"
    )]
    Far {
        /// The rms error as a share of the kernel's rms.
        error: f64,
    },
    /// The states could give energy to a motion.
    #[error(
        "Re K(i w) has an eigenvalue of {least_over_largest} of its largest at {omega_rad_s} rad/s, at least -0.02 is allowed"
    )]
    NotPassive {
        /// The least eigenvalue over the largest.
        least_over_largest: f64,
        /// Where `[rad/s]`.
        omega_rad_s: f64,
    },
}

/// States of a group of motions that drives no other group: of its motions `z = W^T r` the kernel is
/// `Re sum_i g_i g_i^T e^(s_i t)`, with what filters add, and their forces f act on the freedoms as `W f`.
#[derive(Debug, Clone)]
pub struct StateGroup {
    /// W `[-, m/rad]`, a row for each freedom, a column for each motion; in scaled freedoms its columns are orthonormal.
    pub motions: DMatrix<f64>,
    /// Whether its motions are rolls.
    pub rolls: bool,
    /// The poles s_i `[1/s]`, with Im s >= 0: one of each conjugate pair.
    pub poles_1_s: Vec<Complex<f64>>,
    /// The shapes g_i `[(N/m)^(1/2)]`, a column for each pole, a row for each motion.
    pub shapes: DMatrix<Complex<f64>>,
    /// Filters on the motions that make the states take energy at every frequency.
    pub filters: Vec<Filter>,
}

/// The force of the water is `F = -Re sum_i (W g_i) x_i` with `x_i' = s_i x_i + (W g_i)^T r'`, the poles in [groups](StateGroup).
#[derive(Debug, Clone)]
pub struct Realisation {
    groups: Vec<StateGroup>,
    kernel_error: f64,
    left_out: f64,
    passivity: Passivity,
}

impl StateGroup {
    /// The number of its real states, those of filters among them: two for a pole with Im s > 0, one for a real one.
    pub fn real_states(&self) -> usize {
        let of = |s: &Complex<f64>| if s.im > 0.0 { 2 } else { 1 };
        let filters: usize = self.filters.iter().map(|filter| of(&filter.pole_1_s)).sum();
        self.poles_1_s.iter().map(of).sum::<usize>() + self.motions.ncols() * filters
    }
}

impl Realisation {
    /// The states of a kernel.
    ///
    /// Each group of motions is realised for itself: heave with pitch in motions whose bottoms meet at the joints, and roll;
    /// both split by the mirror where the lengths are mirror-equal. Poles with Re s < 0 and Im s < 12 rad/s are kept.
    ///
    /// # Errors
    /// [`RealisationError`]. The least eigenvalue of Re K(i w) may be -2 % of the largest; [filters](Filter) then lift it to 0.
    pub fn new(kernel: &Kernel, scales: &Scales, fit: Fit) -> Result<Self, RealisationError> {
        positive("tolerance", fit.tolerance)?;
        positive("dt_s", fit.dt_s)?;
        if kernel.freedoms() != scales.freedoms() {
            let allowed = format!(
                "a length for each of {} modules",
                kernel.freedoms() / FREEDOMS_PER_MODULE
            );
            return Err(InvalidInput::new("length_m", scales.length_m().len(), allowed).into());
        }
        let times = (0_u32..).map(|i| f64::from(i) * fit.dt_s);
        let count = times
            .take_while(|t_s| *t_s < fit.window.zero_from_s() * (1.0 - 1e-12))
            .count();
        let samples = kernel.windowed(fit.dt_s, count, fit.window);
        let samples: Vec<_> = samples.iter().map(|k| scales.scaled(k)).collect();
        let whole: f64 = samples.iter().map(DMatrix::norm_squared).sum();
        let (mut within, mut error) = (0.0, 0.0);
        let mut passivity = Passivity::of_none();
        let mut groups = Vec::new();
        for (rolls, basis) in motions::groups(scales) {
            let samples: Vec<_> = samples.iter().map(|k| basis.transpose() * k * &basis).collect();
            let found = hankel::exponentials(&samples, fit.dt_s, fit.tolerance)?.usable();
            let filters = passive::filters(&found);
            for (i, sample) in samples.iter().enumerate() {
                within += sample.norm_squared();
                let t_s = i as f64 * fit.dt_s;
                let states = filters.iter().fold(found.at(t_s), |sum, filter| sum + filter.at(t_s));
                error += (sample - states).norm_squared();
            }
            passivity.widen(&found);
            let scaled = |i: usize, j: usize| scales.rms_m()[i] * basis[(i, j)];
            groups.push(StateGroup {
                motions: DMatrix::from_fn(basis.nrows(), basis.ncols(), scaled),
                rolls,
                poles_1_s: found.poles_1_s,
                shapes: found.shapes,
                filters,
            });
        }
        if passivity.least_over_largest() < PASSIVITY_REFUSES {
            return Err(RealisationError::NotPassive {
                least_over_largest: passivity.least_over_largest(),
                omega_rad_s: passivity.least_at_rad_s,
            });
        }
        let kernel_error = if within > 0.0 { (error / within).sqrt() } else { 0.0 };
        if kernel_error > ERROR_REFUSES {
            return Err(RealisationError::Far { error: kernel_error });
        }
        Ok(Self {
            groups,
            kernel_error,
            left_out: if whole > 0.0 {
                1.0 - (within / whole).sqrt()
            } else {
                0.0
            },
            passivity,
        })
    }

    /// The groups, of heave with pitch first.
    pub fn groups(&self) -> &[StateGroup] {
        &self.groups
    }

    /// The number of real states: two for a pole with Im s > 0, one for a real one.
    pub fn real_states(&self) -> usize {
        self.groups.iter().map(StateGroup::real_states).sum()
    }

    /// The rms error of the kernel over all samples and groups, as a share of the kernel's rms in those groups `[-]`; in scaled
    /// freedoms.
    pub fn kernel_error(&self) -> f64 {
        self.kernel_error
    }

    /// By what share the kernel's rms is smaller in the groups `[-]`: what it has in motions that break the bottom line at a joint,
    /// and between groups, is left out.
    pub fn left_out(&self) -> f64 {
        self.left_out
    }

    /// The eigenvalues of Re K(i w) of the states without filters.
    pub fn passivity(&self) -> Passivity {
        self.passivity
    }
}

#[cfg(test)]
mod tests {
    use super::super::exponentials::Exponentials;
    use super::super::fixture::made_up;
    use super::super::{Band, RadiationTable};
    use super::*;

    #[test]
    fn states_repeat_the_kernel_of_their_groups() {
        let made_up = made_up();
        let kernel = Kernel::new(&made_up.table(), &made_up.scales, Band::default()).unwrap();
        let window = Window::new(6.0, 8.0).unwrap();
        let fit = |tolerance| Fit {
            tolerance,
            dt_s: 0.1,
            window,
        };
        let fine = Realisation::new(&kernel, &made_up.scales, fit(1e-4)).unwrap();
        let coarse = Realisation::new(&kernel, &made_up.scales, fit(1e-2)).unwrap();
        assert!(
            fine.kernel_error() < 1e-3 && coarse.kernel_error() > fine.kernel_error(),
            "{fine:?}"
        );
        assert!(coarse.real_states() < fine.real_states());
        assert!(fine.left_out() > 0.0 && fine.left_out() < 1.0);
        let groups = motions::groups(&made_up.scales);
        let error = |t: f64, factor: f64| {
            let found = fine.groups().iter().map(|group| {
                let of = Exponentials {
                    poles_1_s: group.poles_1_s.clone(),
                    shapes: group.shapes.clone(),
                };
                let kernel = group.filters.iter().fold(of.at(t), |sum, filter| sum + filter.at(t));
                &group.motions * kernel * group.motions.transpose()
            });
            let found = made_up.scales.scaled(&found.fold(DMatrix::zeros(6, 6), |a, b| a + b));
            let expected = made_up.scales.scaled(&kernel.at(t)) * (factor * window.at(t));
            let sum = groups.iter().map(|(_, q)| {
                let p = q * q.transpose();
                &p * &expected * &p
            });
            (found - sum.fold(DMatrix::zeros(6, 6), |a, b| a + b)).amax()
                / made_up.scales.scaled(&kernel.at(0.0)).amax()
        };
        for t in [0.0, 0.05, 0.73, 2.0, 7.0] {
            assert!(error(t, 1.0) < 3e-3, "{t}: {}", error(t, 1.0));
        }
        assert!(error(0.0, 1.05) > 1e-2);
        let passivity = fine.passivity();
        assert!(passivity.least_over_largest() > -1e-2 && passivity.largest_n_s_m > 0.0);
    }

    #[test]
    fn water_without_damping_has_no_states() {
        let (zero, scales) = (vec![DMatrix::zeros(3, 3); 4], Scales::new(&[2.0], 1.0).unwrap());
        let table = RadiationTable::new(1, vec![0.0, 1.0, 2.0, 5.0], zero.clone(), zero, None).unwrap();
        let kernel = Kernel::new(&table, &scales, Band::default()).unwrap();
        let window = Window::new(2.0, 3.0).unwrap();
        let none = Realisation::new(
            &kernel,
            &scales,
            Fit {
                window,
                ..Fit::default()
            },
        )
        .unwrap();
        assert_eq!((none.real_states(), none.kernel_error()), (0, 0.0));
    }

    #[test]
    fn states_that_could_give_energy_are_refused() {
        let made_up = made_up();
        let kernel = Kernel::new(&made_up.table(), &made_up.scales, Band::default()).unwrap();
        let fit = |tolerance| Fit {
            tolerance,
            dt_s: 0.1,
            window: Window::new(6.0, 8.0).unwrap(),
        };
        let refused = Realisation::new(&kernel, &made_up.scales, fit(0.03)).unwrap_err();
        assert!(matches!(refused, RealisationError::NotPassive { .. }), "{refused}");
        let refused = Realisation::new(&kernel, &made_up.scales, fit(0.0)).unwrap_err();
        assert!(
            matches!(&refused, RealisationError::Input(input) if input.key == "tolerance"),
            "{refused}"
        );
    }
}
