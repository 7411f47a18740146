//! Water with memory as a file: added mass and radiation damping of a chain of modules over frequency.
//!
//! | module | charter |
//! |---|---|
//! | `water_file` | the neutral form: its keys, read, checked and written |
//! | `module_lengths` | the modules' lengths as the file writes them |
//! | `triangle` | symmetric matrices as lists of their upper triangles |
//! | `options` | what whoever reads a file of a BEM code has to tell beside it |
//! | `bem_data` | what a BEM code's file holds, before it is the neutral form |
//! | `numbers` | numbers of a text with the lines they stand on |
//! | `capytaine` | netCDF files of Capytaine |
//! | `wamit` | `.1` and `.hst` files of WAMIT |
//! | `nemoh` | `RadiationCoefficients.tec`, and `CM.dat` with `CA.dat`, of NEMOH |
//! | `judged` | a water held against what radiation has to be, and against a bridge |
//! | `reading` | a file of any of these forms, told by what it holds, made the neutral form |
//!
//! Freedoms of a module are heave, pitch and roll: its motion up, about +y and about +x, each about the point (x_c, 0, 0) at the
//! middle of its length, on its centre line, in the still water plane.
//!
//! Knows files of hydrodynamic coefficients and how they are damaged. Does not know how a bridge moves in them.

mod bem_data;
mod capytaine;
mod judged;
mod module_lengths;
mod nemoh;
mod numbers;
mod options;
mod reading;
mod triangle;
mod wamit;
mod water_file;

pub use bem_data::Asymmetry;
pub use judged::{JudgedCheck, JudgedWater};
pub use module_lengths::ModuleLengths;
pub use options::{BemModes, Options, WaterDepth, WaterFacts};
pub use reading::{Reading, WaterFormat, read};
pub use triangle::{full, triangle_length};
pub use water_file::{FREEDOMS, LargestAsymmetry, WaterFile, WaterFreedom, WaterSource, schema};
