//! The memory of the water as states: a few exponentials in place of a convolution.
//!
//! Knows a kernel, the groups of motions, and what makes states passive. Does not know modes or the step of the bridge.

use super::exponentials::Passivity;
use super::hankel::{self, HankelError};
use super::{FREEDOMS_PER_MODULE, Kernel, Scales, Window, motions};
use crate::input::{InvalidInput, positive};
use nalgebra::{Complex, DMatrix, DVector};
use thiserror::Error;

/// The least eigenvalue of Re K(i w) over the largest below which a realisation is refused `[-]`.
const PASSIVITY_REFUSES: f64 = -0.02;

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
    /// Tolerance 1e-2, samples of 0.1 s over 40 s.
    fn default() -> Self {
        Self {
            tolerance: 1e-2,
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

/// `k(t) = Re sum_i c_i c_i^T e^(s_i t)`; the force of the water is `F = -Re sum_i c_i x_i` with `x_i' = s_i x_i + c_i^T r'`.
#[derive(Debug, Clone)]
pub struct Realisation {
    poles_1_s: Vec<Complex<f64>>,
    shapes: DMatrix<Complex<f64>>,
    kernel_error: f64,
    left_out: f64,
    passivity: Passivity,
}

impl Realisation {
    /// The states of a kernel.
    ///
    /// Each group of motions is realised for itself: heave with pitch in motions whose bottoms meet at the joints, and roll;
    /// both split by the mirror where the lengths are mirror-equal. Poles with Re s < 0 and Im s < 12 rad/s are kept.
    ///
    /// # Errors
    /// [`RealisationError`]. The least eigenvalue of Re K(i w) may be -2 % of the largest; a small one is left to
    /// [`dashpot`](Self::dashpot).
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
        let (mut poles_1_s, mut shapes) = (Vec::new(), Vec::new());
        for basis in motions::groups(scales) {
            let samples: Vec<_> = samples.iter().map(|k| basis.transpose() * k * &basis).collect();
            let found = hankel::exponentials(&samples, fit.dt_s, fit.tolerance)?.usable();
            for (i, sample) in samples.iter().enumerate() {
                within += sample.norm_squared();
                error += (sample - found.at(i as f64 * fit.dt_s)).norm_squared();
            }
            passivity.widen(&found);
            for (i, &s) in found.poles_1_s.iter().enumerate() {
                poles_1_s.push(s);
                let c = basis.map(|x| Complex::new(x, 0.0)) * found.shapes.column(i);
                shapes.extend(c.iter().zip(scales.rms_m()).map(|(c, rms_m)| c * *rms_m));
            }
        }
        if passivity.least_over_largest() < PASSIVITY_REFUSES {
            return Err(RealisationError::NotPassive {
                least_over_largest: passivity.least_over_largest(),
                omega_rad_s: passivity.least_at_rad_s,
            });
        }
        Ok(Self {
            shapes: DMatrix::from_vec(scales.freedoms(), poles_1_s.len(), shapes),
            poles_1_s,
            kernel_error: if within > 0.0 { (error / within).sqrt() } else { 0.0 },
            left_out: if whole > 0.0 {
                1.0 - (within / whole).sqrt()
            } else {
                0.0
            },
            passivity,
        })
    }

    /// The poles s_i `[1/s]`, with Im s >= 0: one of each conjugate pair.
    pub fn poles_1_s(&self) -> &[Complex<f64>] {
        &self.poles_1_s
    }

    /// The shapes c_i `[(N/m)^(1/2), m (N/m)^(1/2)]`, a column for each pole, a row for each freedom.
    pub fn shapes(&self) -> &DMatrix<Complex<f64>> {
        &self.shapes
    }

    /// The number of real states: two for a pole with Im s > 0, one for a real one.
    pub fn real_states(&self) -> usize {
        self.poles_1_s.iter().map(|s| if s.im > 0.0 { 2 } else { 1 }).sum()
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

    /// The eigenvalues of Re K(i w) of the states.
    pub fn passivity(&self) -> Passivity {
        self.passivity
    }

    /// The dashpot `|l_min| D^2` that makes the states passive, in the freedoms r `[N s/m, N s m]`: its diagonal.
    pub fn dashpot(&self, scales: &Scales) -> DVector<f64> {
        let diagonal = scales
            .rms_m()
            .iter()
            .map(|rms_m| self.passivity.dashpot_n_s_m() * rms_m * rms_m);
        DVector::from_iterator(scales.freedoms(), diagonal)
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
            let all = Exponentials {
                poles_1_s: fine.poles_1_s().to_vec(),
                shapes: fine.shapes().clone(),
            };
            let found = made_up.scales.scaled(&all.at(t));
            let expected = made_up.scales.scaled(&kernel.at(t)) * (factor * window.at(t));
            let sum = groups.iter().map(|q| {
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
        let dashpot = fine.dashpot(&made_up.scales);
        let of_pitch = passivity.dashpot_n_s_m() * made_up.scales.rms_m()[1].powi(2);
        assert!(dashpot[1] > 0.0 && (dashpot[1] / of_pitch - 1.0).abs() < 1e-12);
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
        assert_eq!(
            (
                none.real_states(),
                none.kernel_error(),
                none.passivity().dashpot_n_s_m()
            ),
            (0, 0.0, 0.0)
        );
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
