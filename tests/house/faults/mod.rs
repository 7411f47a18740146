//! The promise: kill it at any moment, in any way; start it again with the same command; finished jobs are not run again but
//! for the last second's, none is lost, none appears twice, and the tables are the same, byte for byte.
//!
//! What takes long is ignored here and run by `scripts/faults`; how often things are tried there is told in the environment
//! (`PONTOON_FAULT_TRIES`).

mod damage;
mod deaths;
mod disk;
mod kill;
mod million;
mod places;
mod ratings;
mod resume;
mod shards;
mod signals;
pub(crate) mod sweep;
