//! Slopes: the error against the mesh and the time step.

mod fem_shells;
mod orders;
