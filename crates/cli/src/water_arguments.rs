//! The words of `pontoon water`.
//!
//! Knows what files of BEM codes do not hold. Does not know the files.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct WaterArguments {
    /// The file.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The bridge that is to float in it: the water must have its modules, and its hull the bridge's water plane.
    #[arg(long, value_name = "BRIDGE")]
    pub bridge: Option<PathBuf>,
    /// Where to write it as a water file.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Name of the water.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// The hull in words.
    #[arg(long, value_name = "TEXT")]
    pub hull: Option<String>,
    /// Length of each module; that of the bridge where one is given.
    #[arg(long, value_name = "X")]
    pub module_length_m: Option<f64>,
    /// Breadth of the hull at the water line.
    #[arg(long, value_name = "X")]
    pub waterline_breadth_m: Option<f64>,
    /// Draught of the hull.
    #[arg(long, value_name = "X")]
    pub draught_m: Option<f64>,
    /// Depth of the water.
    #[arg(long, value_name = "X", conflicts_with = "deep")]
    pub depth_m: Option<f64>,
    /// The water has no bottom that waves feel.
    #[arg(long)]
    pub deep: bool,
    /// Density of the water.
    #[arg(long, value_name = "X")]
    pub density_kg_m3: Option<f64>,
    /// Acceleration of gravity.
    #[arg(long, value_name = "X")]
    pub gravity_m_s2: Option<f64>,
    /// Frequency up to which the coefficients are to be used: that of a water file, 5 of other files where it is not given.
    #[arg(long, value_name = "W")]
    pub usable_to_rad_s: Option<f64>,
    /// Modes of WAMIT or NEMOH, from 1, that are heave, pitch and roll of the first module, of the second, and so on: where the
    /// modules are no bodies of six modes each.
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..))]
    pub modes: Vec<u16>,
    /// The length by which WAMIT made its coefficients free of dimension (ULEN); 1 where it is not given.
    #[arg(long, value_name = "X")]
    pub length_scale_m: Option<f64>,
}
