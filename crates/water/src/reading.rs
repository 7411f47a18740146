//! A file of any known form, told by what it holds, made the neutral form.
//!
//! Knows which forms there are and what stands beside a file. Does not know how a form is read.

use crate::bem_data::{Asymmetry, check_modules};
use crate::options::{Options, WaterDepth, WaterFacts};
use crate::{capytaine, nemoh, wamit};
use pontoon_plan::input::{Document, FoundValue, Refusal};
use pontoon_plan::water_file::WaterFile;
use std::borrow::Cow;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

/// The form of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaterFormat {
    /// A water file.
    Neutral,
    /// Classic netCDF of Capytaine.
    CapytaineClassic,
    /// netCDF on HDF5 of Capytaine.
    CapytaineHdf5,
    /// `.1` of WAMIT.
    Wamit,
    /// `RadiationCoefficients.tec` of NEMOH.
    NemohTecplot,
    /// `CM.dat` and `CA.dat` of NEMOH.
    NemohTables,
}

impl Display for WaterFormat {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Neutral => "water file",
            Self::CapytaineClassic => "Capytaine, classic netCDF",
            Self::CapytaineHdf5 => "Capytaine, netCDF on HDF5",
            Self::Wamit => "WAMIT .1",
            Self::NemohTecplot => "NEMOH RadiationCoefficients.tec",
            Self::NemohTables => "NEMOH CM.dat and CA.dat",
        })
    }
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The neutral form.
    pub water: WaterFile,
    /// The form that the file had.
    pub format: WaterFormat,
    /// How far its matrices were from symmetric at each frequency; empty of a water file, which holds symmetric ones.
    pub asymmetries: Vec<Asymmetry>,
    /// What was left out, put in order or taken from beside the file, in words.
    pub notes: Vec<String>,
}

/// Reads a file of any known form.
///
/// # Errors
/// [`Refusal`] with the place: the key of a water file, the variable of a netCDF file, the line of a text.
pub fn read(file: &Path, options: &Options) -> Result<Reading, Refusal> {
    let bytes = bytes_of(file)?;
    let format = format_of(file, &bytes)?;
    let is_wamit = format == WaterFormat::Wamit;
    let is_nemoh = matches!(format, WaterFormat::NemohTecplot | WaterFormat::NemohTables);
    options.check_form(file, is_wamit || is_nemoh, is_wamit)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut hash = blake3::Hasher::new();
    hash.update(&bytes);
    let data = match format {
        WaterFormat::Neutral => return neutral(file, options),
        WaterFormat::CapytaineClassic | WaterFormat::CapytaineHdf5 => capytaine::read(file, &bytes)?,
        WaterFormat::Wamit => {
            let beside = file.with_extension("hst");
            let hydrostatics = beside.is_file().then(|| bytes_of(&beside)).transpose()?;
            let hydrostatics = hydrostatics.as_deref().map(String::from_utf8_lossy);
            let hydrostatics = hydrostatics.as_deref().map(|text| (beside.as_path(), text));
            wamit::read(file, &text, hydrostatics, options)?
        }
        WaterFormat::NemohTecplot => nemoh::read_tecplot(file, &text, options)?,
        WaterFormat::NemohTables => {
            let (other, is_mass) = other_table(file)?;
            let other_bytes = bytes_of(&other)?;
            let other_text = String::from_utf8_lossy(&other_bytes);
            let (this, other) = ((file, &*text), (&*other, &*other_text));
            let (mass, damping) = if is_mass { (this, other) } else { (other, this) };
            hash = blake3::Hasher::new();
            hash.update(mass.1.as_bytes()).update(damping.1.as_bytes());
            nemoh::read_tables(mass, damping, options)?
        }
    };
    let (water, asymmetries, notes) = data.water(file, hash.finalize().to_hex().to_string(), options)?;
    Ok(Reading {
        water,
        format,
        asymmetries,
        notes,
    })
}

fn bytes_of(file: &Path) -> Result<Vec<u8>, Refusal> {
    let allowed = "a file of coefficients";
    let unreadable = |e| Refusal::new(file, "", format!("no readable file ({e})"), allowed);
    std::fs::read(file).map_err(unreadable)
}

/// The form of a file by what it holds.
fn format_of(file: &Path, bytes: &[u8]) -> Result<WaterFormat, Refusal> {
    let allowed = "a water file (JSON), netCDF of Capytaine, .1 of WAMIT, RadiationCoefficients.tec or CM.dat with CA.dat of NEMOH";
    let refuse = |found: &str| Err(Refusal::new(file, "", found, allowed));
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return refuse("an empty file");
    }
    if capytaine::is_classic(bytes) {
        return Ok(WaterFormat::CapytaineClassic);
    }
    if capytaine::is_hdf5(bytes) {
        return Ok(WaterFormat::CapytaineHdf5);
    }
    let text: Cow<'_, str> = String::from_utf8_lossy(bytes);
    if text.trim_start_matches('\u{feff}').trim_start().starts_with(['{', '[']) {
        return Ok(WaterFormat::Neutral);
    }
    if nemoh::is_tecplot(&text) {
        return Ok(WaterFormat::NemohTecplot);
    }
    if nemoh::is_table(&text) {
        return Ok(WaterFormat::NemohTables);
    }
    if wamit::is_added_mass(&text) {
        return Ok(WaterFormat::Wamit);
    }
    if wamit::is_hydrostatics(&text) {
        return refuse("a hydrostatic file of WAMIT, which is read beside its .1 file");
    }
    refuse("no coefficients of a known form")
}

fn neutral(file: &Path, options: &Options) -> Result<Reading, Refusal> {
    let mut water = WaterFile::of(file, &Document::read(file)?)?;
    check_modules(file, water.modules, options)?;
    let facts = WaterFacts {
        module_length_m: Some(water.module_length_m.clone()),
        waterline_breadth_m: water.waterline_breadth_m,
        draught_m: water.draught_m,
        depth: Some(water.depth_m.map_or(WaterDepth::Deep, WaterDepth::Metres)),
        density_kg_m3: Some(water.density_kg_m3),
        gravity_m_s2: Some(water.gravity_m_s2),
        name: Some(water.name.clone()),
        hull: Some(water.hull.clone()),
    };
    let facts = facts.with(file, &options.facts)?;
    water.name = facts.name.unwrap_or(water.name);
    water.hull = facts.hull.unwrap_or(water.hull);
    water.waterline_breadth_m = facts.waterline_breadth_m;
    water.draught_m = facts.draught_m;
    water.usable_to_rad_s = options.usable_to_rad_s.unwrap_or(water.usable_to_rad_s);
    // what the reader told is held to the ranges of the file
    let water = WaterFile::of(file, &Document::parse(file, &water.text())?)?;
    Ok(Reading {
        water,
        format: WaterFormat::Neutral,
        asymmetries: Vec::new(),
        notes: Vec::new(),
    })
}

/// The table that belongs to one of `CM.dat` and `CA.dat`, and whether this one is the added mass.
fn other_table(file: &Path) -> Result<(PathBuf, bool), Refusal> {
    let stem = file.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let other = match &*stem {
        "CM" => "CA",
        "CA" => "CM",
        "cm" => "ca",
        "ca" => "cm",
        _ => {
            let allowed = "CM.dat of added mass or CA.dat of damping: nothing else tells them apart";
            let found = FoundValue::value(&*stem).which("a table of NEMOH");
            return Err(Refusal::new(file, "", found, allowed));
        }
    };
    let extension = file
        .extension()
        .map(|extension| extension.to_string_lossy())
        .unwrap_or_default();
    Ok((
        file.with_file_name(format!("{other}.{extension}")),
        stem.eq_ignore_ascii_case("cm"),
    ))
}
