//! What BEM codes write of added mass and radiation damping, made [`WaterFile`](pontoon_plan::water_file::WaterFile)s.
//!
//! | module | charter |
//! |---|---|
//! | `options` | what whoever reads a file of a BEM code has to tell beside it |
//! | `bem_data` | what a BEM code's file holds, before it is the neutral form |
//! | `numbers` | numbers of a text with the lines they stand on |
//! | `capytaine` | netCDF files of Capytaine |
//! | `wamit` | `.1` and `.hst` files of WAMIT |
//! | `nemoh` | `RadiationCoefficients.tec`, and `CM.dat` with `CA.dat`, of NEMOH |
//! | `reading` | a file of any of these forms, told by what it holds, made the neutral form |
//!
//! Freedoms of a module are heave, pitch and roll: its motion up, about +y and about +x, each about the point (x_c, 0, 0) at the
//! middle of its length, on its centre line, in the still water plane.
//!
//! Knows files of hydrodynamic coefficients and how they are damaged. Does not know how a bridge moves in them.

mod bem_data;
mod capytaine;
mod nemoh;
mod numbers;
mod options;
mod reading;
mod wamit;

pub use bem_data::Asymmetry;
pub use options::{BemModes, Options, WaterDepth, WaterFacts};
pub use reading::{Reading, WaterFormat, read};
