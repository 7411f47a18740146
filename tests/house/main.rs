//! The house: its architecture, the program from outside (words, exit statuses, files), and what becomes of its promises when it is killed.
//!
//! Stands in the program's package because cargo names a package's program to that package's own tests alone.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod architecture;
mod cli;
mod corpus;
#[cfg(unix)]
mod faults;
mod numerics;
mod refusals;
mod stage;
mod tables;
