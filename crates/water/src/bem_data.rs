//! What a file of a BEM code holds, whole matrices in any order of frequencies, made the neutral form.
//!
//! Knows the neutral form and which facts it needs. Does not know where in a file anything stands: who read it has refused what is
//! not finite.

use crate::options::{Options, WaterDepth, WaterFacts};
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_plan::water_file::{
    FREEDOMS, LargestAsymmetry, ModuleLengths, WaterFile, WaterSource, asymmetry, symmetric_part,
};
use std::path::Path;

/// What a file of a BEM code holds of the modules' freedoms.
#[derive(Debug, Clone, Default)]
pub(crate) struct BemData {
    pub(crate) program: &'static str,
    pub(crate) version: Option<String>,
    pub(crate) modules: usize,
    pub(crate) facts: WaterFacts,
    pub(crate) frequencies: Vec<AtFrequency>,
    /// A whole matrix.
    pub(crate) infinite_added_mass: Option<Vec<f64>>,
    /// What was left out or taken from beside the file, in words.
    pub(crate) notes: Vec<String>,
}

/// Whole matrices at one frequency, row by row.
#[derive(Debug, Clone, Default)]
pub(crate) struct AtFrequency {
    pub(crate) omega_rad_s: f64,
    pub(crate) added_mass: Vec<f64>,
    pub(crate) radiation_damping: Vec<f64>,
}

/// How far a file's matrices are from symmetric at a frequency: the largest difference between an entry and its mirror image over
/// the largest entry, pitch and roll over the root mean square of length and breadth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asymmetry {
    /// The frequency `[rad/s]`.
    pub omega_rad_s: f64,
    /// Of added mass.
    pub added_mass: f64,
    /// Of radiation damping.
    pub radiation_damping: f64,
}

impl BemData {
    /// Nothing yet of a program's file of so many modes, of which those at some places are the modules' freedoms.
    pub(crate) fn begin(program: &'static str, places: &[usize], modes: usize) -> Self {
        let left = modes.saturating_sub(places.len());
        Self {
            program,
            modules: places.len() / FREEDOMS.len(),
            notes: match left {
                0 => Vec::new(),
                _ => vec![format!("{left} of {modes} modes are none of the modules' freedoms")],
            },
            ..Self::default()
        }
    }

    /// The neutral form, how far the matrices were from symmetric, and what is to be said of it.
    ///
    /// # Errors
    /// [`Refusal`] of what is missing, contradicts what the reader was told, or is no water.
    pub(crate) fn water(
        mut self,
        file: &Path,
        blake3: String,
        options: &Options,
    ) -> Result<(WaterFile, Vec<Asymmetry>, Vec<String>), Refusal> {
        check_modules(file, self.modules, options)?;
        let facts = std::mem::take(&mut self.facts).with(file, &options.facts)?;
        let module_length_m = needed(file, "module_length_m", facts.module_length_m)?;
        let depth = needed(file, "depth_m", facts.depth)?;
        let density_kg_m3 = needed(file, "density_kg_m3", facts.density_kg_m3)?;
        let gravity_m_s2 = needed(file, "gravity_m_s2", facts.gravity_m_s2)?;
        self.sort(file)?;
        let scales = scales(self.modules, &module_length_m, facts.waterline_breadth_m);
        let asymmetries: Vec<Asymmetry> = self.frequencies.iter().map(|at| at.asymmetry(&scales)).collect();
        let order = FREEDOMS.len() * self.modules;
        let triangle = |whole: &Vec<f64>| symmetric_part(order, whole);
        let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let water = WaterFile {
            name: facts.name.or(stem).unwrap_or_default(),
            source: WaterSource {
                program: self.program.to_owned(),
                version: self.version,
                file: file.file_name().map(|name| name.to_string_lossy().into_owned()),
                blake3: Some(blake3),
                note: options.note.clone(),
                asymmetry: Some(largest(&asymmetries, options.usable_to_rad_s())),
            },
            modules: self.modules,
            module_length_m,
            depth_m: match depth {
                WaterDepth::Deep => None,
                WaterDepth::Metres(depth) => Some(depth),
            },
            density_kg_m3,
            gravity_m_s2,
            hull: facts.hull.unwrap_or_else(|| "not described".to_owned()),
            waterline_breadth_m: facts.waterline_breadth_m,
            draught_m: facts.draught_m,
            freedoms: FREEDOMS,
            usable_to_rad_s: options.usable_to_rad_s(),
            omega_rad_s: self.frequencies.iter().map(|at| at.omega_rad_s).collect(),
            added_mass: self.frequencies.iter().map(|at| triangle(&at.added_mass)).collect(),
            radiation_damping: self
                .frequencies
                .iter()
                .map(|at| triangle(&at.radiation_damping))
                .collect(),
            infinite_added_mass: self.infinite_added_mass.as_ref().map(triangle),
        };
        water.check(file)?;
        Ok((water, asymmetries, self.notes))
    }

    /// Puts frequencies in order.
    fn sort(&mut self, file: &Path) -> Result<(), Refusal> {
        if !self.frequencies.is_sorted_by(|a, b| a.omega_rad_s <= b.omega_rad_s) {
            self.notes.push("the frequencies were put in order".to_owned());
        }
        self.frequencies.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
        let twice = self
            .frequencies
            .windows(2)
            .find(|pair| pair[0].omega_rad_s == pair[1].omega_rad_s);
        twice.map_or(Ok(()), |pair| {
            let refused = Refusal::new(file, "omega_rad_s", pair[0].omega_rad_s, "each frequency once");
            Err(refused.because(RefusalKind::Repeated))
        })
    }
}

impl AtFrequency {
    fn asymmetry(&self, scales: &[f64]) -> Asymmetry {
        Asymmetry {
            omega_rad_s: self.omega_rad_s,
            added_mass: asymmetry(scales, &self.added_mass),
            radiation_damping: asymmetry(scales, &self.radiation_damping),
        }
    }
}

/// Refuses another number of modules than the reader was told.
///
/// # Errors
/// [`Refusal`] at `modules`.
pub(crate) fn check_modules(file: &Path, modules: usize, options: &Options) -> Result<(), Refusal> {
    match options.modules {
        Some(told) if told != modules => {
            let allowed = format!("{told}, the number of modules that is asked for");
            Err(Refusal::new(file, "modules", modules, allowed).because(RefusalKind::Conflict))
        }
        _ => Ok(()),
    }
}

/// A fact; one that neither the file holds nor its reader was told is refused.
///
/// # Errors
/// [`Refusal`] at its key.
pub(crate) fn needed<T>(file: &Path, key: &str, fact: Option<T>) -> Result<T, Refusal> {
    let allowed = "told beside the file, which does not hold it";
    fact.ok_or_else(|| Refusal::new(file, key, FoundValue::NOTHING, allowed))
}

/// Lengths by which the modules' freedoms are put in one unit: 1 of heave, the root mean square of length and breadth of pitch and
/// roll.
fn scales(modules: usize, lengths: &ModuleLengths, breadth: Option<f64>) -> Vec<f64> {
    let of_module = |module| {
        let length = lengths.of(module).filter(|length| *length > 0.0).unwrap_or(1.0);
        let breadth = breadth.filter(|breadth| *breadth > 0.0).unwrap_or(length);
        [1.0, length / 12.0_f64.sqrt(), breadth / 12.0_f64.sqrt()]
    };
    (0..modules).flat_map(of_module).collect()
}

fn largest(asymmetries: &[Asymmetry], usable_to_rad_s: f64) -> LargestAsymmetry {
    let used = asymmetries
        .iter()
        .filter(|at| at.omega_rad_s > 0.0 && at.omega_rad_s <= usable_to_rad_s);
    let none = LargestAsymmetry {
        added_mass: 0.0,
        radiation_damping: 0.0,
    };
    used.fold(none, |largest, at| LargestAsymmetry {
        added_mass: largest.added_mass.max(at.added_mass),
        radiation_damping: largest.radiation_damping.max(at.radiation_damping),
    })
}
