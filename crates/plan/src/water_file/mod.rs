//! Water with memory as a file: added mass and radiation damping of a chain of modules over frequency, as one JSON file.
//!
//! | module | charter |
//! |---|---|
//! | `module_lengths` | the modules' lengths as the file writes them |
//! | `triangle` | symmetric matrices as lists of their upper triangles |
//! | `judged` | a water held against what radiation has to be, and against a bridge |
//! | `waters` | water files that bridges name, read once |
//!
//! Knows the keys, their ranges and how the file is written. Does not know what BEM codes write.

mod judged;
mod module_lengths;
mod triangle;
mod waters;

use crate::input::{Cell, Document, FoundValue, Refusal, RefusalKind, pretty, to_value, typed};
use pontoon_core::radiation::Band;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use std::path::Path;

pub use judged::{JudgedCheck, JudgedWater};
pub use module_lengths::ModuleLengths;
pub use triangle::{asymmetry, full, symmetric_part, triangle_length};
pub use waters::{BridgeWater, WaterDocument, Waters};

/// A water file: added mass and radiation damping of a chain of modules. Units are SI: forces `[N]` and moments `[N m]` per
/// acceleration or speed `[m]`, `[rad]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterFile {
    /// Name of the water.
    pub name: String,
    /// Where its numbers come from.
    pub source: WaterSource,
    /// Number of modules.
    #[schemars(range(min = 1, max = 500))]
    pub modules: usize,
    /// Their lengths `[m]`: one for all, or a list.
    pub module_length_m: ModuleLengths,
    /// Depth of the water `[m]`; null where it is deep.
    #[serde(deserialize_with = "number_or_null")]
    pub depth_m: Option<f64>,
    /// Density of the water `[kg/m^3]`.
    pub density_kg_m3: f64,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// The hull in words.
    pub hull: String,
    /// Breadth of the hull at the water line `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waterline_breadth_m: Option<f64>,
    /// Draught of the hull `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draught_m: Option<f64>,
    /// The freedoms of each module, in this order: heave, pitch, roll about (x_c, 0, 0).
    pub freedoms: [WaterFreedom; 3],
    /// Frequency up to which the coefficients are to be used `[rad/s]`.
    #[serde(default = "usable_to_rad_s")]
    pub usable_to_rad_s: f64,
    /// Frequencies `[rad/s]`, ascending; the first may be 0.
    #[schemars(length(min = 1))]
    pub omega_rad_s: Vec<f64>,
    /// Added mass `[kg, kg m, kg m^2]`: of each frequency the upper triangle of its matrix, row by row.
    pub added_mass: Vec<Vec<f64>>,
    /// Radiation damping `[N s/m, N s, N m s]`, as added mass.
    pub radiation_damping: Vec<Vec<f64>>,
    /// Added mass at infinite frequency, an upper triangle; null where it is not known.
    #[serde(default)]
    pub infinite_added_mass: Option<Vec<f64>>,
}

/// Where the numbers of a water file come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterSource {
    /// The program that computed them.
    pub program: String,
    /// Its version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Name of the file that it wrote.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The blake3 hash of that file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blake3: Option<String>,
    /// Whatever else a reader should know.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// How far its matrices were from symmetric, of which this file keeps the symmetric part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asymmetry: Option<LargestAsymmetry>,
}

/// The largest difference between an entry and its mirror image over the largest entry of the matrix, of all frequencies above 0 up
/// to `usable_to_rad_s`; pitch and roll over the root mean square of length and breadth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LargestAsymmetry {
    /// Of added mass.
    pub added_mass: f64,
    /// Of radiation damping.
    pub radiation_damping: f64,
}

/// A freedom of a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaterFreedom {
    /// Up.
    Heave,
    /// About +y.
    Pitch,
    /// About +x.
    Roll,
}

impl WaterFreedom {
    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Heave => "heave",
            Self::Pitch => "pitch",
            Self::Roll => "roll",
        }
    }
}

/// The freedoms of a module in the order of the matrices.
pub const FREEDOMS: [WaterFreedom; 3] = [WaterFreedom::Heave, WaterFreedom::Pitch, WaterFreedom::Roll];

fn usable_to_rad_s() -> f64 {
    5.0
}

/// A key that has to be there and may be null.
fn number_or_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Option::deserialize(deserializer)
}

/// Most modules of a bridge.
const MOST_MODULES: usize = 500;
/// Share of a matrix's largest entry below which an entry is what rounding leaves of 0.
const ROUNDING: f64 = 1e-12;

impl WaterFile {
    /// Reads and checks a water file.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(file: &Path) -> Result<Self, Refusal> {
        Self::of(file, &Document::read(file)?)
    }

    /// Reads and checks a document; `file` stands for it in messages.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn of(file: &Path, document: &Document) -> Result<Self, Refusal> {
        let water: Self = typed(file, "", document)?;
        water.check(file)?;
        Ok(water)
    }

    /// Order of the matrices.
    pub fn order(&self) -> usize {
        FREEDOMS.len() * self.modules
    }

    /// The file's text: whole lines of the matrices' rows, numbers of matrices at 7 significant digits, and those below 1e-12 of
    /// the largest entry of their matrix as 0.
    pub fn text(&self) -> String {
        let mut head = to_value(&Self {
            omega_rad_s: Vec::new(),
            added_mass: Vec::new(),
            radiation_damping: Vec::new(),
            infinite_added_mass: None,
            ..self.clone()
        });
        if let Some(keys) = head.as_object_mut() {
            for key in ["omega_rad_s", "added_mass", "radiation_damping", "infinite_added_mass"] {
                keys.shift_remove(key);
            }
        }
        let mut text = pretty(&head).trim_end_matches(['}', '\n']).to_owned();
        let omega: Vec<String> = self.omega_rad_s.iter().map(|&omega| written(omega)).collect();
        text.push_str(&format!(",\n  \"omega_rad_s\": [{}]", omega.join(", ")));
        for (key, matrices) in [
            ("added_mass", &self.added_mass),
            ("radiation_damping", &self.radiation_damping),
        ] {
            let matrices: Vec<String> = matrices.iter().map(|matrix| self.matrix_text(matrix)).collect();
            text.push_str(&format!(",\n  \"{key}\": [\n{}\n  ]", matrices.join(",\n")));
        }
        let infinite = self.infinite_added_mass.as_ref();
        let infinite = infinite.map_or("null".to_owned(), |matrix| self.matrix_text(matrix));
        text.push_str(&format!(
            ",\n  \"infinite_added_mass\": {}\n}}\n",
            infinite.trim_start()
        ));
        text
    }

    /// An upper triangle, a line for each row.
    fn matrix_text(&self, triangle: &[f64]) -> String {
        let largest = triangle.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        let words: Vec<String> = triangle
            .iter()
            .map(|&entry| written(rounded(entry, ROUNDING * largest)))
            .collect();
        let (mut rest, mut rows) = (words.as_slice(), Vec::new());
        for length in (1..=self.order()).rev() {
            let (row, behind) = rest.split_at(length.min(rest.len()));
            rows.push(row.join(","));
            rest = behind;
        }
        format!("    [{}]", rows.join(",\n     "))
    }

    /// Refuses what is no water.
    ///
    /// # Errors
    /// [`Refusal`] at the first key that is wrong.
    pub fn check(&self, file: &Path) -> Result<(), Refusal> {
        let refuse = |key: &str, found: FoundValue, allowed: &str| Err(Refusal::new(file, key, found, allowed));
        if self.name.trim().is_empty() {
            return refuse("name", "an empty name".into(), "a name");
        }
        if let Some(hash) = &self.source.blake3
            && (hash.len() != 64 || hash.bytes().any(|byte| !byte.is_ascii_hexdigit()))
        {
            return refuse("source.blake3", hash.as_str().into(), "64 hexadecimal digits");
        }
        if !(1..=MOST_MODULES).contains(&self.modules) {
            return refuse("modules", self.modules.into(), "a whole number from 1 to 500");
        }
        self.check_lengths(file)?;
        for (key, number) in [
            ("depth_m", self.depth_m),
            ("density_kg_m3", Some(self.density_kg_m3)),
            ("gravity_m_s2", Some(self.gravity_m_s2)),
            ("waterline_breadth_m", self.waterline_breadth_m),
            ("draught_m", self.draught_m),
            ("usable_to_rad_s", Some(self.usable_to_rad_s)),
        ] {
            if let Some(number) = number.filter(|number| !is_positive(*number)) {
                return refuse(key, number.into(), "a number above 0");
            }
        }
        let zero_from_rad_s = Band::default().zero_from_rad_s;
        if self.usable_to_rad_s >= zero_from_rad_s {
            let allowed = format!("a number below {zero_from_rad_s}, where damping is led to 0");
            return Err(Refusal::new(file, "usable_to_rad_s", self.usable_to_rad_s, allowed));
        }
        if let (Some(depth), Some(draught)) = (self.depth_m, self.draught_m)
            && depth <= draught
        {
            let allowed = format!("a depth above the draught of {draught} m");
            return Err(Refusal::new(file, "depth_m", depth, allowed).because(RefusalKind::Conflict));
        }
        if let Some(i) = (0..FREEDOMS.len()).find(|&i| self.freedoms[i] != FREEDOMS[i]) {
            let found = FoundValue::value(self.freedoms[i].word());
            return refuse(&format!("freedoms[{i}]"), found, "heave, pitch, roll, in this order");
        }
        self.check_frequencies(file)?;
        self.check_matrices(file, "added_mass", &self.added_mass)?;
        self.check_matrices(file, "radiation_damping", &self.radiation_damping)?;
        let infinite = self.infinite_added_mass.as_ref();
        infinite.map_or(Ok(()), |matrix| self.check_matrix(file, "infinite_added_mass", matrix))
    }

    fn check_lengths(&self, file: &Path) -> Result<(), Refusal> {
        let key = "module_length_m";
        let (lengths, listed) = match &self.module_length_m {
            ModuleLengths::Same(length) => (std::slice::from_ref(length), false),
            ModuleLengths::Each(lengths) if lengths.len() == self.modules => (lengths.as_slice(), true),
            ModuleLengths::Each(lengths) => {
                let found = format!("a list of length {}", lengths.len());
                let allowed = format!("a number, or a list of length {}", self.modules);
                return Err(Refusal::new(file, key, found, allowed).because(RefusalKind::Conflict));
            }
        };
        match lengths.iter().position(|length| !is_positive(*length)) {
            Some(i) => {
                let key = if listed { format!("{key}[{i}]") } else { key.to_owned() };
                Err(Refusal::new(file, key, lengths[i], "a number above 0"))
            }
            None => Ok(()),
        }
    }

    fn check_frequencies(&self, file: &Path) -> Result<(), Refusal> {
        if self.omega_rad_s.is_empty() {
            return Err(Refusal::new(
                file,
                "omega_rad_s",
                "an empty list",
                "at least one frequency",
            ));
        }
        let mut before = None;
        for (i, &omega) in self.omega_rad_s.iter().enumerate() {
            let key = || format!("omega_rad_s[{i}]");
            if !(omega.is_finite() && omega >= 0.0) {
                return Err(Refusal::new(file, key(), omega, "a finite number of at least 0"));
            }
            if let Some(before) = before.filter(|before| *before >= omega) {
                let allowed = format!("ascending frequencies, here above {before}");
                return Err(Refusal::new(file, key(), omega, allowed));
            }
            before = Some(omega);
        }
        Ok(())
    }

    fn check_matrices(&self, file: &Path, key: &str, matrices: &[Vec<f64>]) -> Result<(), Refusal> {
        let count = self.omega_rad_s.len();
        if matrices.len() != count {
            let found = format!("a list of length {}", matrices.len());
            let allowed = format!("a matrix for each of {count} frequencies");
            return Err(Refusal::new(file, key, found, allowed).because(RefusalKind::Conflict));
        }
        let mut numbered = matrices.iter().enumerate();
        numbered.try_for_each(|(i, matrix)| self.check_matrix(file, &format!("{key}[{i}]"), matrix))
    }

    fn check_matrix(&self, file: &Path, key: &str, matrix: &[f64]) -> Result<(), Refusal> {
        let (order, length) = (self.order(), triangle_length(self.order()));
        if matrix.len() != length {
            let found = format!("a list of length {}", matrix.len());
            let allowed = format!("a list of length {length}, the upper triangle of a matrix of {order} by {order}");
            return Err(Refusal::new(file, key, found, allowed).because(RefusalKind::Conflict));
        }
        match matrix.iter().position(|entry| !entry.is_finite()) {
            Some(i) => Err(Refusal::new(file, format!("{key}[{i}]"), matrix[i], "a finite number")),
            None => Ok(()),
        }
    }
}

fn is_positive(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

/// A number at 7 significant digits; 0 where it is not above `least`.
fn rounded(number: f64, least: f64) -> f64 {
    if number.abs() <= least {
        return 0.0;
    }
    format!("{number:.6e}").parse().unwrap_or(number)
}

/// A number as the file writes it.
fn written(number: f64) -> String {
    Cell::written(number).to_string()
}
