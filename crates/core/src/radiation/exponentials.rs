//! A sum of exponentials, and whether it takes energy at every frequency.
//!
//! Knows poles and shapes. Does not know where they come from.

use super::state_step::exponential;
use nalgebra::{Complex, DMatrix};

/// States above this frequency are dropped `[rad/s]`: water does not have them, noise of samples does.
const FASTEST_RAD_S: f64 = 12.0;

/// Distance of the frequencies at which passivity is sampled, up to [`FASTEST_RAD_S`] `[rad/s]`.
const STEP_RAD_S: f64 = 0.02;

/// `k(t) = Re sum_i c_i c_i^T e^(s_i t)`: poles with Im s >= 0, a conjugate pair once.
#[derive(Debug, Clone)]
pub(super) struct Exponentials {
    /// s_i `[1/s]`.
    pub poles_1_s: Vec<Complex<f64>>,
    /// c_i, a column each.
    pub shapes: DMatrix<Complex<f64>>,
}

impl Exponentials {
    /// k(t).
    pub(super) fn at(&self, t_s: f64) -> DMatrix<f64> {
        weighted(self, |s| exponential(s * t_s))
    }

    /// Re K(i w).
    pub(super) fn taking(&self, omega_rad_s: f64) -> DMatrix<f64> {
        weighted(self, |s| middle(s, omega_rad_s))
    }

    /// The exponentials that die away and are not too fast.
    pub(super) fn usable(&self) -> Self {
        let usable = |s: Complex<f64>| s.re.is_finite() && s.re < 0.0 && s.im < FASTEST_RAD_S;
        let kept: Vec<usize> = (0..self.poles_1_s.len())
            .filter(|&i| usable(self.poles_1_s[i]))
            .collect();
        Self {
            poles_1_s: kept.iter().map(|&i| self.poles_1_s[i]).collect(),
            shapes: self.shapes.select_columns(&kept),
        }
    }
}

/// The eigenvalues of Re K(i w), in [scaled](super::Scales) freedoms, over 0.02 to 12 rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passivity {
    /// The least `[N s/m]`.
    pub least_n_s_m: f64,
    /// The largest `[N s/m]`.
    pub largest_n_s_m: f64,
    /// Where the least is `[rad/s]`.
    pub least_at_rad_s: f64,
}

impl Passivity {
    /// The least over the largest `[-]`; 0 where all are 0.
    pub fn least_over_largest(&self) -> f64 {
        if self.largest_n_s_m > 0.0 {
            self.least_n_s_m / self.largest_n_s_m
        } else {
            self.least_n_s_m.min(0.0)
        }
    }

    /// The bounds of no states.
    pub(super) fn of_none() -> Self {
        Self {
            least_n_s_m: 0.0,
            largest_n_s_m: 0.0,
            least_at_rad_s: STEP_RAD_S,
        }
    }

    /// Widens the bounds of the eigenvalues by those of a group.
    ///
    /// A conjugate pair stands once, so that `Re (C e^(s t))` with C = c c^T has the transform
    /// `(C / (i w - s) + conj(C) / (i w - conj(s))) / 2`.
    pub(super) fn widen(&mut self, of: &Exponentials) {
        for omega_rad_s in sampled(1) {
            let eigenvalues = of.taking(omega_rad_s).symmetric_eigenvalues();
            self.largest_n_s_m = self.largest_n_s_m.max(eigenvalues.max());
            if eigenvalues.min() < self.least_n_s_m {
                self.least_n_s_m = eigenvalues.min();
                self.least_at_rad_s = omega_rad_s;
            }
        }
    }
}

/// The frequencies at which passivity is sampled `[rad/s]`, every one of so many.
pub(super) fn sampled(every: u32) -> impl Iterator<Item = f64> {
    let frequencies = (1_u32..).map(move |i| f64::from(i * every) * STEP_RAD_S);
    frequencies.take_while(|omega| *omega < FASTEST_RAD_S - 0.5 * STEP_RAD_S)
}

/// g with `Re K(i w) = Re sum_i c_i c_i^T g(s_i)`: `(1/(i w - s) + 1/(-i w - s)) / 2`.
pub(super) fn middle(s: Complex<f64>, omega_rad_s: f64) -> Complex<f64> {
    let (a, b) = (Complex::new(0.0, omega_rad_s) - s, Complex::new(0.0, -omega_rad_s) - s);
    (a.inv() + b.inv()).scale(0.5)
}

/// `Re sum_i c_i c_i^T weight(s_i)`.
fn weighted(of: &Exponentials, weight: impl Fn(Complex<f64>) -> Complex<f64>) -> DMatrix<f64> {
    let n = of.shapes.nrows();
    let mut sum = DMatrix::zeros(n, n);
    for (&s, c) in of.poles_1_s.iter().zip(of.shapes.column_iter()) {
        let weight = weight(s);
        for j in 0..n {
            let right = c[j] * weight;
            for i in 0..n {
                sum[(i, j)] += c[i].re * right.re - c[i].im * right.im;
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(pole: Complex<f64>, shape: Complex<f64>) -> Exponentials {
        Exponentials {
            poles_1_s: vec![pole],
            shapes: DMatrix::from_element(1, 1, shape),
        }
    }

    fn bounds(of: &Exponentials) -> Passivity {
        let mut bounds = Passivity::of_none();
        bounds.widen(of);
        bounds
    }

    #[test]
    fn passivity_is_that_of_the_transfer_function() {
        // 4 e^(-t) cos(3 t): Re K = 2 (1/(1 + (w - 3)^2) + 1/(1 + (w + 3)^2)), largest next to 3
        let pair = bounds(&one(Complex::new(-1.0, 3.0), Complex::new(2.0, 0.0)));
        let re = |w: f64| 2.0 / (1.0 + (w - 3.0).powi(2)) + 2.0 / (1.0 + (w + 3.0).powi(2));
        let largest = (1..600).map(|i| re(0.02 * f64::from(i))).fold(0.0, f64::max);
        assert!((pair.largest_n_s_m - largest).abs() < 1e-12 && pair.least_n_s_m == 0.0);
        // -e^(-t): Re K = -1/(1 + w^2)
        let taking = bounds(&one(Complex::new(-1.0, 0.0), Complex::new(0.0, 1.0)));
        assert!((taking.least_n_s_m + 1.0 / (1.0 + 0.0004)).abs() < 1e-12);
        assert_eq!(taking.largest_n_s_m, 0.0);
        assert_eq!(taking.least_over_largest(), taking.least_n_s_m);
    }

    #[test]
    fn poles_that_grow_or_are_too_fast_are_dropped() {
        let poles = [
            (-1.0, 0.0),
            (0.1, 2.0),
            (-1.0, 20.0),
            (-0.2, 11.0),
            (f64::NEG_INFINITY, 0.0),
        ];
        let all = Exponentials {
            poles_1_s: poles.map(|(re, im)| Complex::new(re, im)).to_vec(),
            shapes: DMatrix::from_element(1, 5, Complex::new(1.0, 0.0)),
        };
        assert_eq!(all.usable().poles_1_s, [all.poles_1_s[0], all.poles_1_s[3]]);
        assert_eq!(all.usable().shapes.shape(), (1, 2));
    }
}
