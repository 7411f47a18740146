//! Limits in which the answer is known, and two models that must agree.

mod creeping;
mod given_mesh;
mod known;
