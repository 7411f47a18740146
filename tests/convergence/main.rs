//! Slopes: the error against the mesh and the time step.

mod contact_force;
mod fem_shells;
mod orders;
