//! netCDF files of Capytaine, classic and on HDF5.
//!
//! Knows the variables' names, their dimensions in any order, and the freedoms' names `m01__heave`; frequencies may be unsorted, 0 and
//! infinite. Does not know the files' bytes: a library reads them, and that it panics over one is a refusal like any other.
//! Which sense of time the code chose is immaterial for added mass and damping.

use crate::bem_data::{AtFrequency, BemData};
use crate::options::{WaterDepth, WaterFacts};
use netcdf_reader::{NcFile, NcOpenOptions};
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_plan::water_file::{FREEDOMS, ModuleLengths};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Most bytes of a variable: those of 500 modules at 50 frequencies.
const MOST_BYTES: usize = 1 << 30;
/// What a value of netCDF takes at most.
const VALUE_BYTES: u64 = 8;
/// Most freedoms: those of 500 modules.
const MOST_FREEDOMS: usize = 1500;
/// The dimensions of the coefficients.
const DIMENSIONS: [&str; 3] = ["omega", "influenced_dof", "radiating_dof"];

/// Whether bytes begin as a classic netCDF file does.
pub(crate) fn is_classic(bytes: &[u8]) -> bool {
    matches!(bytes, [b'C', b'D', b'F', 1 | 2 | 5, ..])
}

/// Whether bytes begin as an HDF5 file does.
pub(crate) fn is_hdf5(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89HDF\r\n\x1a\n")
}

/// Reads a file's bytes.
///
/// # Errors
/// [`Refusal`] with the variable's name.
pub(crate) fn read(file: &Path, bytes: &[u8]) -> Result<BemData, Refusal> {
    let read = || Dataset::open(file, bytes)?.data();
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        let found = "a damaged netCDF file";
        Err(Refusal::new(file, "", found, "a whole netCDF file"))
    })
}

struct Dataset<'a> {
    file: &'a Path,
    variables: NcFile,
}

impl<'a> Dataset<'a> {
    fn open(file: &'a Path, bytes: &[u8]) -> Result<Self, Refusal> {
        let options = NcOpenOptions {
            max_read_bytes: MOST_BYTES,
            max_chunk_bytes: MOST_BYTES,
            ..NcOpenOptions::default()
        };
        let damaged = |e| Refusal::new(file, "", format!("a damaged netCDF file ({e})"), "a whole netCDF file");
        let variables = NcFile::from_bytes_with_options(bytes, options).map_err(damaged)?;
        // what is wrong with the list of variables is told once, here
        variables.variables().map_err(damaged)?;
        Ok(Self { file, variables })
    }

    fn refuse<T>(&self, variable: &str, found: impl Into<FoundValue>, allowed: &str) -> Result<T, Refusal> {
        Err(Refusal::new(self.file, variable, found, allowed))
    }

    fn has(&self, variable: &str) -> bool {
        self.variables.variable(variable).is_ok()
    }

    /// A variable's lengths by the names of its dimensions.
    fn dimensions(&self, variable: &str) -> Result<Vec<(String, usize)>, Refusal> {
        let Ok(found) = self.variables.variable(variable) else {
            return Err(Refusal::missing(self.file, variable));
        };
        let sizes = found.dimensions().iter().map(|dimension| dimension.size);
        let bytes = sizes.clone().try_fold(VALUE_BYTES, u64::checked_mul);
        if bytes.is_none_or(|bytes| bytes > MOST_BYTES as u64) {
            let sizes: Vec<String> = sizes.map(|size| size.to_string()).collect();
            return self.refuse(variable, format!("{} values", sizes.join(" x ")), "at most 1 GiB");
        }
        let named = found.dimensions().iter().map(|dimension| {
            let size = usize::try_from(dimension.size).unwrap_or(usize::MAX);
            (dimension.name.clone(), size)
        });
        Ok(named.collect())
    }

    /// A variable's numbers, as they follow each other in the file.
    fn numbers(&self, variable: &str) -> Result<Vec<f64>, Refusal> {
        let expected: usize = self.dimensions(variable)?.iter().map(|(_, size)| size).product();
        let read = self.variables.read_variable_as_f64(variable);
        let numbers: Vec<f64> = match read {
            Ok(array) => array.iter().copied().collect(),
            Err(e) => return self.refuse(variable, format!("no readable numbers ({e})"), "numbers"),
        };
        match numbers.len() {
            length if length == expected => Ok(numbers),
            length => self.refuse(variable, format!("{length} numbers"), &format!("{expected} numbers")),
        }
    }

    /// The one number of a variable; none where there is no such variable.
    fn number(&self, variable: &str) -> Result<Option<f64>, Refusal> {
        if !self.has(variable) {
            return Ok(None);
        }
        let numbers = self.numbers(variable)?;
        match numbers.as_slice() {
            [first, rest @ ..] if rest.iter().all(|number| number == first) => Ok(Some(*first)),
            _ => self.refuse(variable, format!("{} numbers", numbers.len()), "a single number"),
        }
    }

    /// Names of freedoms, as module and freedom from 0.
    fn freedoms(&self, variable: &str) -> Result<Vec<(usize, usize)>, Refusal> {
        let dimensions = self.dimensions(variable)?;
        if let Some((_, size)) = dimensions.first().filter(|(_, size)| *size > MOST_FREEDOMS) {
            return self.refuse(variable, *size, "at most 1500 freedoms");
        }
        let names = match self.variables.read_variable_as_strings(variable) {
            Ok(names) => names,
            Err(e) => return self.refuse(variable, format!("no readable names ({e})"), "names of freedoms"),
        };
        if dimensions.first().is_none_or(|(_, size)| *size != names.len()) {
            return self.refuse(variable, format!("{} names", names.len()), "a name for each freedom");
        }
        let names: Vec<&str> = names.iter().map(|name| name.trim_end_matches(['\0', ' '])).collect();
        let modules = names.len().div_ceil(FREEDOMS.len());
        let known = |module: usize, freedom: usize| format!("m{:02}__{}", module + 1, FREEDOMS[freedom].word());
        let all = || (0..modules).flat_map(|module| (0..FREEDOMS.len()).map(move |freedom| (module, freedom)));
        let mut freedoms = Vec::new();
        for (i, name) in names.iter().enumerate() {
            let place = format!("{variable}[{i}]");
            let Some(freedom) = all().find(|&(module, freedom)| known(module, freedom) == *name) else {
                let all: Vec<String> = all().map(|(module, freedom)| known(module, freedom)).collect();
                return Err(Refusal::unknown(self.file, place, name, &all));
            };
            if freedoms.contains(&freedom) {
                let refused = Refusal::new(self.file, place, FoundValue::value(*name), "each freedom once");
                return Err(refused.because(RefusalKind::Repeated));
            }
            freedoms.push(freedom);
        }
        if let Some((module, freedom)) = all().find(|freedom| !freedoms.contains(freedom)) {
            let found = format!("no {}", known(module, freedom));
            return self.refuse(variable, found, "heave, pitch and roll of each module");
        }
        if freedoms.is_empty() {
            return self.refuse(variable, "no freedom", "heave, pitch and roll of each module");
        }
        Ok(freedoms)
    }

    /// Steps from one value to the next along frequency, influenced and radiating freedom.
    fn steps(&self, variable: &str, lengths: [usize; 3]) -> Result<[usize; 3], Refusal> {
        let (mut steps, mut step) = ([None; 3], 1);
        for (name, size) in self.dimensions(variable)?.iter().rev() {
            match DIMENSIONS.iter().position(|known| known == name) {
                Some(at) if *size == lengths[at] => steps[at] = Some(step),
                Some(at) => {
                    let found = format!("{size} values along {name}");
                    return self.refuse(variable, found, &format!("{} values", lengths[at]));
                }
                None if *size == 1 => {}
                None => {
                    let found = format!("{size} values along {name}");
                    return self.refuse(variable, found, "a single one of what is no frequency and no freedom");
                }
            }
            step *= size;
        }
        match steps {
            [Some(omega), Some(influenced), Some(radiating)] => Ok([omega, influenced, radiating]),
            _ => self.refuse(variable, "other dimensions", "omega, influenced_dof and radiating_dof"),
        }
    }

    fn data(&self) -> Result<BemData, Refusal> {
        let omegas = self.numbers("omega")?;
        let (influenced, radiating) = (self.freedoms("influenced_dof")?, self.freedoms("radiating_dof")?);
        if influenced.len() != radiating.len() {
            let allowed = format!("{} freedoms, as many as influenced ones", influenced.len());
            return self.refuse("radiating_dof", radiating.len(), &allowed);
        }
        let lengths = [omegas.len(), influenced.len(), radiating.len()];
        let order = influenced.len();
        let place = |&(module, freedom): &(usize, usize)| FREEDOMS.len() * module + freedom;
        let mut data = BemData {
            program: "Capytaine",
            version: self.attribute("capytaine_version"),
            modules: order / FREEDOMS.len(),
            facts: self.facts()?,
            ..BemData::default()
        };
        let masses = (self.numbers("added_mass")?, self.steps("added_mass", lengths)?);
        let dampings = (
            self.numbers("radiation_damping")?,
            self.steps("radiation_damping", lengths)?,
        );
        for (row, &omega) in omegas.iter().enumerate() {
            if omega.is_nan() || omega < 0.0 {
                return self.refuse(&format!("omega[{row}]"), omega, "a frequency of at least 0");
            }
            let matrix = |variable: &str, (numbers, steps): &(Vec<f64>, [usize; 3])| {
                let mut matrix = vec![0.0; order * order];
                for (i, of_force) in influenced.iter().enumerate() {
                    for (j, of_motion) in radiating.iter().enumerate() {
                        let number = numbers[row * steps[0] + i * steps[1] + j * steps[2]];
                        if !number.is_finite() {
                            let names = [of_force, of_motion]
                                .map(|(module, freedom)| format!("m{:02}__{}", module + 1, FREEDOMS[*freedom].word()));
                            let found = format!("{number} at {omega} rad/s, {} by {}", names[0], names[1]);
                            return self.refuse(variable, found, "finite numbers: leave such a frequency out");
                        }
                        matrix[place(of_force) * order + place(of_motion)] = number;
                    }
                }
                Ok(matrix)
            };
            let added_mass = matrix("added_mass", &masses)?;
            if omega.is_finite() {
                data.frequencies.push(AtFrequency {
                    omega_rad_s: omega,
                    added_mass,
                    radiation_damping: matrix("radiation_damping", &dampings)?,
                });
            } else if data.infinite_added_mass.replace(added_mass).is_some() {
                let refused = Refusal::new(self.file, format!("omega[{row}]"), omega, "each frequency once");
                return Err(refused.because(RefusalKind::Repeated));
            }
        }
        Ok(data)
    }

    fn facts(&self) -> Result<WaterFacts, Refusal> {
        let depth = self.number("water_depth")?.map(|depth| match depth {
            f64::INFINITY => WaterDepth::Deep,
            depth => WaterDepth::Metres(depth),
        });
        let length = |name: &str| {
            self.variables
                .global_attribute(name)
                .ok()
                .and_then(|found| found.value.as_f64())
        };
        Ok(WaterFacts {
            name: self.attribute("name"),
            hull: self.attribute("hull"),
            module_length_m: length("module_length_m").map(ModuleLengths::Same),
            waterline_breadth_m: length("waterline_breadth_m"),
            draught_m: length("draught_m"),
            depth,
            density_kg_m3: self.number("rho")?,
            gravity_m_s2: self.number("g")?,
        })
    }

    /// A text about the file as a whole.
    fn attribute(&self, name: &str) -> Option<String> {
        let found = self.variables.global_attribute(name).ok()?;
        found.value.as_string().filter(|text| !text.trim().is_empty())
    }
}
