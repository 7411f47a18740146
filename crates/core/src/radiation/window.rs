//! A window that ends a memory in time, and its Fourier integral.
//!
//! Knows cosines. Does not know what remembers.

use crate::input::{InvalidInput, not_negative};
use nalgebra::Complex;
use std::f64::consts::PI;

/// The window `g(t) = 1` to `full_to_s`, `cos^2((pi/2) (t - full_to_s) / (zero_from_s - full_to_s))` from there to
/// `zero_from_s`, 0 beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    full_to_s: f64,
    zero_from_s: f64,
}

impl Window {
    /// For a kernel that is realised by states: 25 to 40 s.
    pub const STATES: Self = Self {
        full_to_s: 25.0,
        zero_from_s: 40.0,
    };

    /// For a kernel that is convolved step by step: 20 to 30 s.
    pub const CONVOLUTION: Self = Self {
        full_to_s: 20.0,
        zero_from_s: 30.0,
    };

    /// For transfer functions, where nothing is to be saved: 50 to 80 s.
    pub const TRANSFER: Self = Self {
        full_to_s: 50.0,
        zero_from_s: 80.0,
    };

    /// A window that is 1 up to `full_to_s` `[s]` and 0 from `zero_from_s` `[s]`, the later of the two.
    ///
    /// # Errors
    /// [`InvalidInput`] on `full_to_s` or `zero_from_s`.
    pub fn new(full_to_s: f64, zero_from_s: f64) -> Result<Self, InvalidInput> {
        not_negative("full_to_s", full_to_s)?;
        if !(zero_from_s.is_finite() && zero_from_s > full_to_s) {
            let allowed = format!("a finite number above {full_to_s}");
            return Err(InvalidInput::new("zero_from_s", zero_from_s, allowed));
        }
        Ok(Self { full_to_s, zero_from_s })
    }

    /// Up to where the window is 1 `[s]`.
    pub fn full_to_s(&self) -> f64 {
        self.full_to_s
    }

    /// From where the window is 0 `[s]`.
    pub fn zero_from_s(&self) -> f64 {
        self.zero_from_s
    }

    /// g(t) at `t_s` `[s]` of at least 0.
    pub fn at(&self, t_s: f64) -> f64 {
        let along = (t_s - self.full_to_s) / (self.zero_from_s - self.full_to_s);
        libm::cos(along.clamp(0.0, 1.0) * PI / 2.0).powi(2)
    }

    /// `G(w) = int_0^inf g(t) e^(-i w t) dt` `[s]` at `omega_rad_s`, in closed form: with `cos^2 a = (1 + cos 2 a) / 2` the window
    /// is a sum of three exponentials over its fall.
    pub fn transform(&self, omega_rad_s: f64) -> Complex<f64> {
        let (a, b) = (self.full_to_s, self.zero_from_s);
        let p = PI / (b - a);
        let turned = |sign: f64| {
            let (sine, cosine) = libm::sincos(sign * p * a);
            Complex::new(cosine, -sine) * exponential(omega_rad_s - sign * p, a, b)
        };
        exponential(omega_rad_s, 0.0, a)
            + exponential(omega_rad_s, a, b).scale(0.5)
            + (turned(1.0) + turned(-1.0)).scale(0.25)
    }
}

/// `int_from^to e^(-i w t) dt`, also where w is next to 0.
fn exponential(omega_rad_s: f64, from_s: f64, to_s: f64) -> Complex<f64> {
    let half = 0.5 * (to_s - from_s);
    let x = omega_rad_s * half;
    let sinc = if x.abs() < 1e-4 {
        1.0 - x * x / 6.0
    } else {
        libm::sin(x) / x
    };
    let (sine, cosine) = libm::sincos(0.5 * (from_s + to_s) * omega_rad_s);
    Complex::new(cosine, -sine).scale(2.0 * half * sinc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_falls_as_a_cosine() {
        let w = Window::STATES;
        assert_eq!(
            (w.at(0.0), w.at(25.0), w.at(40.0), w.at(50.0)),
            (1.0, 1.0, w.at(41.0), w.at(40.0))
        );
        assert!((w.at(32.5) - 0.5).abs() < 1e-15 && w.at(40.0) < 1e-30);
        assert_eq!(Window::new(2.0, 2.0).unwrap_err().key, "zero_from_s");
        assert_eq!(Window::new(-1.0, 2.0).unwrap_err().key, "full_to_s");
    }

    #[test]
    fn its_transform_is_the_integral() {
        let w = Window::new(2.0, 5.0).unwrap();
        let (n, h) = (50_000, 1e-4);
        // PI / 3 is where the fall's own cosine resonates
        for omega in [0.0, 1e-6, 0.3, PI / 3.0, -PI / 3.0, 4.0, -9.0] {
            let sum: Complex<f64> = (0..n)
                .map(|i| (f64::from(i) + 0.5) * h)
                .map(|t| Complex::new((omega * t).cos(), -(omega * t).sin()).scale(w.at(t) * h))
                .sum();
            let error = (w.transform(omega) - sum).norm();
            assert!(error < 1e-7, "{omega}: {error}");
        }
        let twin = Window::new(2.0 * 1.05, 5.0).unwrap();
        assert!((twin.transform(0.3) - w.transform(0.3)).norm() > 1e-2);
    }
}
