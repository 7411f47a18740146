//! Closed forms and published benchmarks, each with its card: source, sketch, parameters, expected value, tolerance.

mod banks;
mod beam_module;
mod critical_speed;
mod fem_eigen;
mod fem_macneal_harder;
mod fem_patch;
mod fem_stress;
mod fem_vibration;
mod foundation;
mod gap_oscillator;
mod moving_load;
mod moving_mass;
mod sprung;
mod two_modules;
