//! The memory of the water in time, from its damping over the frequency.
//!
//! Knows a table, the band in which it is used, and the integral over it. Does not know states or time integration.

use super::{MatrixSpline, RadiationTable, Scales, Window};
use crate::input::{InvalidInput, positive};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use nalgebra::{Complex, DMatrix, SymmetricEigen};
use std::f64::consts::PI;

/// Distance of the frequencies at which the kernel is summed `[rad/s]`, before it is made to divide the band.
const STEP_RAD_S: f64 = 0.02;

/// The frequencies at which a table's damping is used, and how it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Frequencies up to here are used `[rad/s]`. Beyond, panel meshes are too coarse.
    pub usable_to_rad_s: f64,
    /// From here the damping is 0 `[rad/s]`, reached with slope 0.
    pub zero_from_rad_s: f64,
}

impl Default for Band {
    /// Used to 5 rad/s, 0 from 6.5 rad/s.
    fn default() -> Self {
        Self {
            usable_to_rad_s: 5.0,
            zero_from_rad_s: 6.5,
        }
    }
}

/// The kernel `k(t) = (2/pi) int_0^wc B(w) cos(w t) dw`.
///
/// B(w) is the [spline](MatrixSpline) through B(0) = 0, the symmetrised matrices of the used band and B(wc) = 0. It is
/// projected to B >= 0 at the middles w_j of steps dw of 0.02 rad/s: eigenvalues below 0, in [scaled](Scales) freedoms, become 0.
/// The integral is their sum, which repeats after 2 pi / dw = 314 s. k is in `[N/m, N, N m]` by pairs of freedoms.
#[derive(Debug, Clone)]
pub struct Kernel {
    freedoms: usize,
    step_rad_s: f64,
    omega_rad_s: Vec<f64>,
    /// The upper half of B(w_j), column by column, in column j.
    damping: Mat<f64>,
    least_over_largest: f64,
}

impl Kernel {
    /// The kernel of a table in a band.
    ///
    /// # Errors
    /// [`InvalidInput`] on `radiation_damping` where it has an entry that is no number; on `omega_rad_s` with fewer than two
    /// frequencies above 0 in the band; on `usable_to_rad_s` or `zero_from_rad_s` where they are not positive and rising; on
    /// `length_m` where the scales are of another chain.
    pub fn new(table: &RadiationTable, scales: &Scales, band: Band) -> Result<Self, InvalidInput> {
        positive("usable_to_rad_s", band.usable_to_rad_s)?;
        if !(band.zero_from_rad_s.is_finite() && band.zero_from_rad_s > band.usable_to_rad_s) {
            let allowed = format!("a finite number above {}", band.usable_to_rad_s);
            return Err(InvalidInput::new("zero_from_rad_s", band.zero_from_rad_s, allowed));
        }
        let table = table.symmetrised(scales)?;
        let used = table.used(band.usable_to_rad_s);
        let n = table.freedoms();
        let (mut knots, mut values) = (vec![0.0], vec![DMatrix::zeros(n, n)]);
        for (&omega_rad_s, damping) in table.omega_rad_s()[..used].iter().zip(table.radiation_damping()) {
            if damping.iter().any(|entry| !entry.is_finite()) {
                let key = format!("radiation_damping at {omega_rad_s} rad/s");
                return Err(InvalidInput::new(key, f64::NAN, "finite numbers"));
            }
            if omega_rad_s > 0.0 {
                knots.push(omega_rad_s);
                values.push(scales.scaled(damping));
            }
        }
        if knots.len() < 3 {
            let allowed = "at least 2 frequencies above 0 in the used band";
            return Err(InvalidInput::new("omega_rad_s", knots.len() - 1, allowed));
        }
        knots.push(band.zero_from_rad_s);
        values.push(DMatrix::zeros(n, n));
        let spline = MatrixSpline::new(knots, values)?;
        Self::summed(&spline, scales, band.zero_from_rad_s)
    }

    /// The kernel of damping in scaled freedoms from 0 to `to_rad_s`.
    fn summed(spline: &MatrixSpline, scales: &Scales, to_rad_s: f64) -> Result<Self, InvalidInput> {
        let steps = (0_u32..).find(|&i| f64::from(i) * STEP_RAD_S >= to_rad_s * (1.0 - 1e-12));
        let step_rad_s = to_rad_s / f64::from(steps.unwrap_or(1));
        let middles = (0_u32..).map(|i| (f64::from(i) + 0.5) * step_rad_s);
        let omega_rad_s: Vec<f64> = middles.take_while(|&omega| omega < to_rad_s).collect();
        let n = scales.freedoms();
        let mut damping = Mat::zeros(n * (n + 1) / 2, omega_rad_s.len());
        let (mut least, mut largest) = (0.0_f64, 0.0_f64);
        for (j, &omega_rad_s) in omega_rad_s.iter().enumerate() {
            let eigen = SymmetricEigen::try_new(spline.at(omega_rad_s), f64::EPSILON, 0).ok_or_else(|| {
                InvalidInput::new("radiation_damping", "no eigenvalues", "matrices that have eigenvalues")
            })?;
            least = least.min(eigen.eigenvalues.min());
            largest = largest.max(eigen.eigenvalues.max());
            let roots = eigen.eigenvalues.map(|l| l.max(0.0).sqrt());
            let factor = DMatrix::from_fn(n, n, |i, k| eigen.eigenvectors[(i, k)] * roots[k] * scales.rms_m()[i]);
            let positive = &factor * factor.transpose();
            for (row, (i, k)) in upper(n).enumerate() {
                damping[(row, j)] = positive[(i, k)];
            }
        }
        Ok(Self {
            freedoms: n,
            step_rad_s,
            omega_rad_s,
            damping,
            least_over_largest: if largest > 0.0 { least / largest } else { 0.0 },
        })
    }

    /// The number of freedoms, three for each module.
    pub fn freedoms(&self) -> usize {
        self.freedoms
    }

    /// The least eigenvalue that the projection found over all frequencies, as a share of the largest `[-]`: 0 or less, in
    /// scaled freedoms.
    pub fn least_over_largest(&self) -> f64 {
        self.least_over_largest
    }

    /// k(t) at `t_s` `[s]`.
    pub fn at(&self, t_s: f64) -> DMatrix<f64> {
        self.at_times(&[t_s], |_| 1.0).pop().unwrap_or_default()
    }

    /// `k(i dt_s)` for i of 0 to `count` - 1; `dt_s` `[s]`.
    pub fn sampled(&self, dt_s: f64, count: usize) -> Vec<DMatrix<f64>> {
        self.at_times(&times(dt_s, count), |_| 1.0)
    }

    /// `g(i dt_s) k(i dt_s)` with a window g, for i of 0 to `count` - 1; `dt_s` `[s]`.
    pub fn windowed(&self, dt_s: f64, count: usize, window: Window) -> Vec<DMatrix<f64>> {
        self.at_times(&times(dt_s, count), |t_s| window.at(t_s))
    }

    /// `K(i w) = int_0^inf g(t) k(t) e^(-i w t) dt` of the kernel in a window g, at `omega_rad_s`, in closed form.
    ///
    /// With the window's transform G it is `(1/pi) dw sum_j B(w_j) (G(w - w_j) + G(w + w_j))`. In `[N s/m, N s, N s m]` by pairs
    /// of freedoms.
    pub fn transfer(&self, omega_rad_s: f64, window: Window) -> DMatrix<Complex<f64>> {
        let weights = Mat::from_fn(self.omega_rad_s.len(), 2, |j, part| {
            let omega_j = self.omega_rad_s[j];
            let g = window.transform(omega_rad_s - omega_j) + window.transform(omega_rad_s + omega_j);
            self.step_rad_s / PI * if part == 0 { g.re } else { g.im }
        });
        let sums = self.sums(&weights);
        let mut transfer = DMatrix::zeros(self.freedoms, self.freedoms);
        for (row, (i, k)) in upper(self.freedoms).enumerate() {
            let value = Complex::new(sums[(row, 0)], sums[(row, 1)]);
            transfer[(i, k)] = value;
            transfer[(k, i)] = value;
        }
        transfer
    }

    /// `weight(t) k(t)` at the times `t_s` `[s]`.
    fn at_times(&self, t_s: &[f64], weight: impl Fn(f64) -> f64) -> Vec<DMatrix<f64>> {
        let weights = Mat::from_fn(self.omega_rad_s.len(), t_s.len(), |j, i| {
            2.0 / PI * self.step_rad_s * weight(t_s[i]) * libm::cos(self.omega_rad_s[j] * t_s[i])
        });
        let sums = self.sums(&weights);
        let matrix = |column: usize| {
            let mut matrix = DMatrix::zeros(self.freedoms, self.freedoms);
            for (row, (i, k)) in upper(self.freedoms).enumerate() {
                matrix[(i, k)] = sums[(row, column)];
                matrix[(k, i)] = sums[(row, column)];
            }
            matrix
        };
        (0..t_s.len()).map(matrix).collect()
    }

    /// `sum_j B(w_j) weights[j][c]` in column c: upper halves.
    fn sums(&self, weights: &Mat<f64>) -> Mat<f64> {
        let mut sums = Mat::zeros(self.damping.nrows(), weights.ncols());
        matmul(
            sums.as_mut(),
            Accum::Replace,
            self.damping.as_ref(),
            weights.as_ref(),
            1.0,
            Par::Seq,
        );
        sums
    }
}

/// The pairs of the upper half of a matrix of order n, column by column.
fn upper(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|k| (0..=k).map(move |i| (i, k)))
}

/// `count` times from 0 on, `dt_s` apart.
fn times(dt_s: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64 * dt_s).collect()
}

#[cfg(test)]
mod tests {
    use super::super::added_mass_infinite;
    use super::super::fixture::{bell, bell_kernel, heaving_box, made_up};
    use super::*;

    fn kernel(table: &RadiationTable, scales: &Scales) -> Kernel {
        Kernel::new(table, scales, Band::default()).unwrap()
    }

    #[test]
    fn a_bell_of_damping_has_its_kernel_and_its_added_mass() {
        let made_up = made_up();
        let error = |factor: f64| {
            let b = made_up.b.iter().map(|b| b * factor).collect();
            let table = RadiationTable::new(2, made_up.omega.clone(), made_up.a.clone(), b, None).unwrap();
            let kernel = kernel(&table, &made_up.scales);
            let samples = kernel.sampled(0.25, 41);
            assert!((kernel.at(2.5) - &samples[10]).amax() < 1e-12 * samples[0].amax());
            let residue = &made_up.residue;
            let of_time = samples
                .iter()
                .enumerate()
                .map(|(i, k)| (k - residue * bell_kernel(0.25 * i as f64)).amax());
            let infinite = added_mass_infinite(&kernel, &table, &made_up.scales, Window::STATES).unwrap();
            let of_mass = (infinite - &made_up.infinite).amax() / made_up.infinite.amax();
            let transfer = kernel.transfer(1.7, Window::STATES);
            let of_transfer = (transfer.map(|k| k.re) - residue * bell(1.7).0).amax() / residue.amax();
            [of_time.fold(0.0, f64::max) / samples[0].amax(), of_mass, of_transfer]
        };
        let ([time, mass, transfer], twin) = (error(1.0), error(1.05));
        assert!(
            time < 1e-3 && mass < 1e-3 && transfer < 1e-3,
            "{time} {mass} {transfer}"
        );
        assert!(twin[0] > 1e-2 && twin[1] > 3e-3 && twin[2] > 1e-2, "{twin:?}");
    }

    /// `k(t) = (1 - s t) e^(-s t)` has `B = 2 s w^2 / (s^2 + w^2)^2` and `A - A_inf = (s^2 - w^2) / (s^2 + w^2)^2`: exponential in
    /// time, 0 at w = 0, and slow to end in w.
    #[test]
    fn an_exponential_kernel_is_recovered_from_a_wide_band() {
        let s = 0.5;
        let omega: Vec<f64> = (0..=1200).map(|i| 0.05 * f64::from(i)).collect();
        let one = |x: f64| DMatrix::identity(3, 3) * x;
        let a = omega
            .iter()
            .map(|w| one(2.0 + (s * s - w * w) / (s * s + w * w).powi(2)))
            .collect();
        let b = omega
            .iter()
            .map(|w| one(2.0 * s * w * w / (s * s + w * w).powi(2)))
            .collect();
        let table = RadiationTable::new(1, omega, a, b, None).unwrap();
        let scales = Scales::new(&[12_f64.sqrt()], 12_f64.sqrt()).unwrap();
        let band = Band {
            usable_to_rad_s: 60.0,
            zero_from_rad_s: 70.0,
        };
        let kernel = Kernel::new(&table, &scales, band).unwrap();
        let infinite = added_mass_infinite(&kernel, &table, &scales, Window::TRANSFER).unwrap();
        let error = (infinite - one(2.0)).amax();
        assert!(error < 2e-5, "{error}");
        for t in [0.5, 1.0, 3.0, 10.0] {
            let k = (1.0 - s * t) * (-s * t).exp();
            let error = (kernel.at(t)[(0, 0)] - k).abs();
            assert!(error < 1e-3, "{t}: {error}");
        }
        // what is cut off above 65 rad/s is missing at once: (2/pi) 2 s / 65
        assert!((kernel.at(0.0)[(0, 0)] - 1.0 + 2.0 / PI / 65.0).abs() < 1e-3);
    }

    #[test]
    fn the_transfer_is_the_integral_over_the_windowed_kernel() {
        let (table, scales) = heaving_box(0, 1.0);
        let kernel = kernel(&table, &scales);
        let window = Window::CONVOLUTION;
        let dt = 0.01;
        let samples = kernel.windowed(dt, 3001, window);
        for omega in [0.0, 0.7, 2.2, 5.0] {
            let terms = samples.iter().enumerate().map(|(i, k)| {
                let (t, end) = (dt * i as f64, if i == 0 { 0.5 } else { 1.0 });
                Complex::new((omega * t).cos(), -(omega * t).sin()).scale(end * dt * k[(0, 0)])
            });
            let sum: Complex<f64> = terms.sum();
            let error = (kernel.transfer(omega, window)[(0, 0)] - sum).norm() / 2e4;
            assert!(error < 1e-4, "{omega}: {error}");
        }
    }

    #[test]
    fn damping_below_zero_is_projected_and_the_mirror_holds() {
        let mut made_up = made_up();
        let table = made_up.table();
        assert!(kernel(&table, &made_up.scales).least_over_largest() > -1e-3);
        made_up.set_least_damping(1.0, -0.05);
        let kernel = kernel(&made_up.table(), &made_up.scales);
        assert!(
            (kernel.least_over_largest() + 0.05).abs() < 0.03,
            "{}",
            kernel.least_over_largest()
        );
        let k = kernel.at(0.0);
        assert!(made_up.scales.scaled(&k).symmetric_eigenvalues().min() > 0.0);
        assert!((made_up.scales.mirrored(&k) - &k).amax() < 1e-12 * k.amax());
        assert_eq!(k.transpose(), k);
    }

    #[test]
    fn what_has_no_kernel_is_refused() {
        let mut made_up = made_up();
        let key = |table: &RadiationTable, band| Kernel::new(table, &made_up.scales, band).unwrap_err().key;
        let band = |usable_to_rad_s, zero_from_rad_s| Band {
            usable_to_rad_s,
            zero_from_rad_s,
        };
        let table = made_up.table();
        assert_eq!(key(&table, band(0.0, 6.5)), "usable_to_rad_s");
        assert_eq!(key(&table, band(5.0, 5.0)), "zero_from_rad_s");
        assert_eq!(key(&table, band(0.3, 5.0)), "omega_rad_s");
        let other = Scales::new(&[4.0], 3.0).unwrap();
        assert_eq!(
            Kernel::new(&table, &other, Band::default()).unwrap_err().key,
            "length_m"
        );
        made_up.b[5][(1, 2)] = f64::NAN;
        let key = Kernel::new(&made_up.table(), &made_up.scales, Band::default())
            .unwrap_err()
            .key;
        assert_eq!(key, "radiation_damping at 1 rad/s");
    }
}
