//! The exact step of a state of the water over a velocity that is linear in time.
//!
//! Knows one pole and one step. Does not know what drives the state.

use nalgebra::Complex;

/// The |z| below which the coefficients are summed as series.
const SMALL_Z: f64 = 0.3;

/// e^z.
pub(super) fn exponential(z: Complex<f64>) -> Complex<f64> {
    let (sine, cosine) = libm::sincos(z.im);
    Complex::new(cosine, sine) * libm::exp(z.re)
}

/// What carries a state over a step h: `x_1 = decay x_0 + p0 c^T r'_0 + p1 c^T r'_1`, exact where r' is linear in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepCoefficients {
    /// `e^z` with z = s h `[-]`.
    pub decay: Complex<f64>,
    /// `h (e^z (z - 1) + 1) / z^2` `[s]`.
    pub p0_s: Complex<f64>,
    /// `h (e^z - 1 - z) / z^2` `[s]`.
    pub p1_s: Complex<f64>,
}

impl StepCoefficients {
    /// The coefficients of a pole `[1/s]` over a step `[s]`. Near z = 0 the quotients are series:
    /// `p1 = h sum_k z^k / (k + 2)!`, `p0 = h sum_k (k + 1) z^k / (k + 2)!`.
    pub fn new(pole_1_s: Complex<f64>, step_s: f64) -> Self {
        let z = pole_1_s * step_s;
        let decay = exponential(z);
        let one = Complex::new(1.0, 0.0);
        let (p0, p1) = if z.norm() < SMALL_Z {
            let zero = Complex::new(0.0, 0.0);
            let mut term = one.scale(0.5);
            let (mut p0, mut p1) = (zero, zero);
            for k in 0_u32..14 {
                p1 += term;
                p0 += term * f64::from(k + 1);
                term = term * z / f64::from(k + 3);
            }
            (p0, p1)
        } else {
            ((decay * (z - one) + one) / (z * z), (decay - one - z) / (z * z))
        };
        Self {
            decay,
            p0_s: p0 * step_s,
            p1_s: p1 * step_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The state after a step, by Simpson's rule over `e^(s (h - t)) r'(t)`.
    fn integrated(s: Complex<f64>, h: f64, x0: Complex<f64>, r0: f64, r1: f64) -> Complex<f64> {
        let n = 2000;
        let force = |i: u32| {
            let t = h * f64::from(i) / f64::from(n);
            (s * (h - t)).exp() * (r0 + (r1 - r0) * t / h)
        };
        let weight = |i: u32| {
            if i == 0 || i == n {
                1.0
            } else {
                2.0 + 2.0 * f64::from(i % 2)
            }
        };
        let sum: Complex<f64> = (0..=n).map(|i| force(i) * weight(i)).sum();
        x0 * (s * h).exp() + sum * (h / f64::from(n) / 3.0)
    }

    #[test]
    fn a_step_is_exact_for_a_linear_velocity() {
        let x0 = Complex::new(0.3, -0.2);
        for (s, h) in [
            ((-1.2, 0.0), 0.01),
            ((-0.3, 4.0), 0.01),
            ((-0.3, 4.0), 0.2),
            ((-2.0, 6.0), 1.0),
            ((0.0, 0.0), 0.5),
        ] {
            let s = Complex::new(s.0, s.1);
            let of = |factor: f64| {
                let c = StepCoefficients::new(s, h);
                c.decay * x0 + c.p0_s * 1.7 * factor + c.p1_s * -0.4 - integrated(s, h, x0, 1.7, -0.4)
            };
            assert!(of(1.0).norm() < 1e-12, "{s} {h}: {}", of(1.0).norm());
            assert!(of(1.05).norm() > 1e-4);
        }
    }

    #[test]
    fn series_and_quotients_meet() {
        for angle in 0..8 {
            let (sine, cosine) = (0.785 * f64::from(angle)).sin_cos();
            let at = |size: f64| StepCoefficients::new(Complex::new(cosine, sine) * size, 1.0);
            let (below, above) = (at(SMALL_Z * (1.0 - 1e-14)), at(SMALL_Z * (1.0 + 1e-14)));
            assert!((below.p0_s - above.p0_s).norm() < 1e-13 && (below.p1_s - above.p1_s).norm() < 1e-13);
        }
    }
}
