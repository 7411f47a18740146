//! What whoever reads a file of a BEM code has to tell beside it, because such files do not hold it.
//!
//! Knows facts of the water and the hull, and how modes are numbered. Does not know the files.

use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_plan::water_file::ModuleLengths;
use std::path::Path;

/// How deep the water is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WaterDepth {
    /// Without a bottom that waves feel.
    Deep,
    /// This deep `[m]`.
    Metres(f64),
}

/// Facts of the water and the hull. Files hold some of them; what a file and its reader both say has to agree, but for the
/// names, where the reader's word stands.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WaterFacts {
    /// Name of the water.
    pub name: Option<String>,
    /// The hull in words.
    pub hull: Option<String>,
    /// The modules' lengths `[m]`.
    pub module_length_m: Option<ModuleLengths>,
    /// Breadth of the hull at the water line `[m]`.
    pub waterline_breadth_m: Option<f64>,
    /// Draught of the hull `[m]`.
    pub draught_m: Option<f64>,
    /// How deep the water is.
    pub depth: Option<WaterDepth>,
    /// Its density `[kg/m^3]`.
    pub density_kg_m3: Option<f64>,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: Option<f64>,
}

/// Which modes of a file, numbered from 1, are the freedoms of the modules.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum BemModes {
    /// Each module is a body of six modes: of body m, heave is 6 (m - 1) + 3, roll + 4, pitch + 5.
    #[default]
    Bodies,
    /// The mode of heave, pitch and roll of the first module, of the second one, and so on: what generalised modes need.
    Listed(Vec<usize>),
}

/// What a reader is told beside the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Facts that the file may not hold.
    pub facts: WaterFacts,
    /// Number of modules that the file has to have; any number where absent.
    pub modules: Option<usize>,
    /// Where the file comes from and whatever else a reader should know.
    pub note: Option<String>,
    /// Frequency up to which the coefficients are to be used `[rad/s]`; where absent that of a water file, 5 of other files.
    pub usable_to_rad_s: Option<f64>,
    /// Which modes are the modules' freedoms, of WAMIT and NEMOH.
    pub modes: BemModes,
    /// The length by which WAMIT made its coefficients free of dimension, `ULEN` `[m]`; 1 where absent.
    pub length_scale_m: Option<f64>,
}

impl Options {
    /// Refuses, of a form that numbers no modes or has dimensions, what holds for another form alone.
    ///
    /// # Errors
    /// [`Refusal`] at the option.
    pub(crate) fn check_form(&self, file: &Path, is_numbered: bool, is_scaled: bool) -> Result<(), Refusal> {
        let misplaced = |key: &str, of: &str| {
            let refused = Refusal::new(file, key, "a value", format!("no value of this form: it is for {of}"));
            Err(refused.because(RefusalKind::Misplaced))
        };
        match (&self.modes, self.length_scale_m) {
            (BemModes::Listed(_), _) if !is_numbered => misplaced("modes", "WAMIT and NEMOH"),
            (_, Some(_)) if !is_scaled => misplaced("length_scale_m", "WAMIT"),
            _ => Ok(()),
        }
    }

    /// Frequency up to which the coefficients of a BEM code are to be used `[rad/s]`.
    pub(crate) fn usable_to_rad_s(&self) -> f64 {
        self.usable_to_rad_s.unwrap_or(5.0)
    }

    /// The length by which coefficients are free of dimension `[m]`.
    pub(crate) fn length_scale_m(&self) -> f64 {
        self.length_scale_m.unwrap_or(1.0)
    }
}

/// Modes of a body.
const MODES_OF_BODY: usize = 6;
/// Places of heave, pitch and roll among the modes of a body.
const OF_BODY: [usize; 3] = [2, 4, 3];

impl BemModes {
    /// Places, from 0, of the modules' freedoms among `count` modes of a file.
    ///
    /// # Errors
    /// [`Refusal`] where the file has no such modes.
    pub(crate) fn places(&self, file: &Path, count: usize) -> Result<Vec<usize>, Refusal> {
        let listed = match self {
            Self::Bodies if count == 0 || !count.is_multiple_of(MODES_OF_BODY) => {
                let allowed = "6 modes for each module, or a list of the modes that are heave, pitch and roll of each";
                return Err(Refusal::new(file, "modes", count, allowed).because(RefusalKind::Conflict));
            }
            Self::Bodies => {
                let bodies = 0..count / MODES_OF_BODY;
                return Ok(bodies
                    .flat_map(|body| OF_BODY.map(|place| MODES_OF_BODY * body + place))
                    .collect());
            }
            Self::Listed(listed) => listed,
        };
        if listed.is_empty() || !listed.len().is_multiple_of(OF_BODY.len()) {
            let found = format!("a list of {} modes", listed.len());
            return Err(Refusal::new(file, "modes", found, "three modes for each module"));
        }
        for (i, mode) in listed.iter().enumerate() {
            let key = format!("modes[{i}]");
            if *mode == 0 || *mode > count {
                let allowed = format!("a mode of the file, 1 to {count}");
                return Err(Refusal::new(file, key, *mode, allowed));
            }
            if listed[..i].contains(mode) {
                let refused = Refusal::new(file, key, *mode, "each mode once");
                return Err(refused.because(RefusalKind::Repeated));
            }
        }
        Ok(listed.iter().map(|mode| mode - 1).collect())
    }
}

impl WaterFacts {
    /// These facts of a file with those of its reader.
    ///
    /// # Errors
    /// [`Refusal`] at the key of a fact that file and reader have otherwise.
    pub(crate) fn with(self, file: &Path, told: &Self) -> Result<Self, Refusal> {
        let number =
            |key: &str, own: Option<f64>, told: Option<f64>| agreed(file, key, own, told, near, |x| (*x).into());
        Ok(Self {
            name: told.name.clone().or(self.name),
            hull: told.hull.clone().or(self.hull),
            module_length_m: agreed(
                file,
                "module_length_m",
                self.module_length_m,
                told.module_length_m.clone(),
                same_lengths,
                |lengths| match lengths {
                    ModuleLengths::Same(length) => (*length).into(),
                    ModuleLengths::Each(_) => "a list".into(),
                },
            )?,
            waterline_breadth_m: number(
                "waterline_breadth_m",
                self.waterline_breadth_m,
                told.waterline_breadth_m,
            )?,
            draught_m: number("draught_m", self.draught_m, told.draught_m)?,
            depth: agreed(
                file,
                "depth_m",
                self.depth,
                told.depth,
                |a, b| match (a, b) {
                    (WaterDepth::Metres(a), WaterDepth::Metres(b)) => near(a, b),
                    (a, b) => a == b,
                },
                |depth| match depth {
                    WaterDepth::Metres(depth) => (*depth).into(),
                    WaterDepth::Deep => "deep water".into(),
                },
            )?,
            density_kg_m3: number("density_kg_m3", self.density_kg_m3, told.density_kg_m3)?,
            gravity_m_s2: number("gravity_m_s2", self.gravity_m_s2, told.gravity_m_s2)?,
        })
    }
}

/// Share by which two statements of one number may differ: files round them.
const AGREED: f64 = 1e-6;

fn near(a: &f64, b: &f64) -> bool {
    a == b || (a - b).abs() <= AGREED * a.abs().max(b.abs())
}

fn same_lengths(a: &ModuleLengths, b: &ModuleLengths) -> bool {
    match (a, b) {
        (ModuleLengths::Same(a), ModuleLengths::Same(b)) => near(a, b),
        (ModuleLengths::Each(a), ModuleLengths::Each(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b))
        }
        (ModuleLengths::Same(one), ModuleLengths::Each(each))
        | (ModuleLengths::Each(each), ModuleLengths::Same(one)) => each.iter().all(|length| near(length, one)),
    }
}

/// What the file says, or what its reader was told where it says nothing.
fn agreed<T>(
    file: &Path,
    key: &str,
    own: Option<T>,
    told: Option<T>,
    same: impl Fn(&T, &T) -> bool,
    found: impl Fn(&T) -> FoundValue,
) -> Result<Option<T>, Refusal> {
    match (own, told) {
        (Some(own), Some(told)) if !same(&own, &told) => {
            let allowed = format!("{}, as told beside the file", found(&told).text());
            Err(Refusal::new(file, key, found(&own), allowed).because(RefusalKind::Conflict))
        }
        (Some(own), _) => Ok(Some(own)),
        (None, told) => Ok(told),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_of_bodies_are_heave_pitch_and_roll_of_each() {
        let file = Path::new("w.1");
        assert_eq!(BemModes::Bodies.places(file, 12).unwrap(), [2, 4, 3, 8, 10, 9]);
        let e = BemModes::Bodies.places(file, 10).unwrap_err();
        assert_eq!((e.path.as_str(), e.kind), ("modes", RefusalKind::Conflict), "{e}");
        for (listed, path) in [
            (vec![3, 5], "modes"),
            (vec![], "modes"),
            (vec![3, 5, 11], "modes[2]"),
            (vec![3, 0, 4], "modes[1]"),
            (vec![3, 5, 3], "modes[2]"),
        ] {
            let e = BemModes::Listed(listed).places(file, 10).unwrap_err();
            assert_eq!(e.path, path, "{e}");
        }
        assert_eq!(BemModes::Listed(vec![3, 5, 4]).places(file, 10).unwrap(), [2, 4, 3]);
    }

    #[test]
    fn a_fact_that_is_told_otherwise_is_refused_at_its_key() {
        let of_file = WaterFacts {
            density_kg_m3: Some(1000.0),
            depth: Some(WaterDepth::Deep),
            hull: Some("a box".into()),
            ..WaterFacts::default()
        };
        let told = |told: WaterFacts| of_file.clone().with(Path::new("w.nc"), &told);
        let read = told(WaterFacts {
            density_kg_m3: Some(1_000.000_1),
            hull: Some("our hull".into()),
            draught_m: Some(0.2),
            ..WaterFacts::default()
        })
        .unwrap();
        assert_eq!((read.density_kg_m3, read.draught_m), (Some(1000.0), Some(0.2)));
        assert_eq!(read.hull.as_deref(), Some("our hull"));
        let other = WaterFacts {
            density_kg_m3: Some(1025.0),
            ..WaterFacts::default()
        };
        assert_eq!(
            told(other).unwrap_err().to_string(),
            "w.nc: density_kg_m3: found 1000, allowed: 1025, as told beside the file"
        );
        let other = WaterFacts {
            depth: Some(WaterDepth::Metres(4.0)),
            ..WaterFacts::default()
        };
        assert_eq!(told(other).unwrap_err().path, "depth_m");
    }
}
