//! Radiated waves: what the water gives back to a chain of modules that moves in it, by linear potential theory.
//!
//! Knows added mass and damping over the frequency, their memory in time and in states, and the checks that tell whether
//! a table can be believed. Does not know files, the bridge above the water, or time integration.
//!
//! A module m moves in three freedoms r_m = (heave `[m]`, pitch `[rad]`, roll `[rad]`) about the point (x_c, 0, 0) of its
//! middle. The forces of the water on all modules are, with A(w) `[kg, kg m, kg m^2]` and B(w) `[N s/m, N s, N s m]`,
//!
//! ```text
//! F(t) = -A_inf r''(t) - int_0^t k(t - s) r'(s) ds,     k(t) = (2/pi) int_0^inf B(w) cos(w t) dw
//! K(i w) = int_0^inf k(t) e^(-i w t) dt = B(w) + i w (A(w) - A_inf)        for motions e^(+i w t)
//! ```
//!
//! Source: W. E. Cummins, The impulse response function and ship motions (1962); T. F. Ogilvie, Recent progress toward the
//! understanding and prediction of ship motions (1964).

mod checks;
mod convolution;
mod exponentials;
mod hankel;
mod kernel;
mod kramers_kronig;
mod motions;
mod passive;
mod realisation;
mod scales;
mod spline;
mod state_step;
mod table;
mod water;
mod window;

pub use checks::{Check, CheckName, Limit, Outcome};
pub(crate) use convolution::{Convolution, Remembered};
pub use exponentials::Passivity;
pub use hankel::HankelError;
pub use kernel::{Band, Kernel};
pub use kramers_kronig::{added_mass_infinite, kramers_kronig};
pub use passive::Filter;
pub use realisation::{Fit, Realisation, RealisationError, StateGroup};
pub use scales::{FREEDOMS_PER_MODULE, Scales};
pub use spline::MatrixSpline;
pub use state_step::StepCoefficients;
pub use table::{FreedomMatrix, RadiationTable, total_heave};
pub use water::Radiation;
pub use window::Window;

#[cfg(test)]
mod barge;
#[cfg(test)]
mod fixture;
#[cfg(test)]
pub(crate) use fixture::chain_water;
