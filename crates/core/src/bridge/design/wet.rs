//! The water of a module: its wet part, p_b and m_a.
//!
//! Knows where the water acts and how much of it. Does not know how it is shared among nodes.

use super::{BankSpec, BridgeDesign, Direction};
use crate::bridge::kinds::wet_m;
use crate::input::{InvalidInput, Problem, SAME_PLACE_M, not_negative, positive, within};

/// What a dry module may have of the water.
pub(super) const OF_DRY: &str = "nothing: the module is dry, its wet part begins where it ends";

impl BridgeDesign {
    /// Refuses a wet part that is not on the module, and numbers that describe no water, or water of a dry module.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub(super) fn check_water(&self) -> Result<(), InvalidInput> {
        let length_m = self.module.length_m;
        let [from_m, _] = self.wet_m();
        within("wet_from_m", from_m, 0.0, length_m)?;
        if let Some(to_m) = self.wet_to_m {
            within("wet_to_m", to_m, from_m, length_m)?;
        }
        if self.is_dry() {
            let given = [
                ("hydrostatic_stiffness_pa_m", self.hydrostatic_stiffness_pa_m.is_some()),
                ("draft_buoyancy", self.draft_buoyancy.is_some()),
                ("added_mass_kg_m", self.added_mass_kg_m.is_some()),
                ("todd", self.todd.is_some()),
            ];
            return match given.into_iter().find(|(_, given)| *given) {
                Some((key, _)) => Err(InvalidInput::new(key, "a value", OF_DRY).because(Problem::Misplaced)),
                None => Ok(()),
            };
        }
        match (self.hydrostatic_stiffness_pa_m, &self.draft_buoyancy) {
            (Some(p_b), None) => positive("hydrostatic_stiffness_pa_m", p_b).map(|_| ())?,
            (None, Some(table)) => table.check().map_err(|e| e.under("draft_buoyancy"))?,
            (found, _) => {
                let (found, problem) = both_or_neither(found.is_some());
                let refused = InvalidInput::new("hydrostatic_stiffness_pa_m", found, "either this or draft_buoyancy");
                return Err(refused.because(problem));
            }
        }
        match (self.added_mass_kg_m, &self.todd) {
            (Some(m_a), None) => not_negative("added_mass_kg_m", m_a).map(|_| ()),
            (None, Some(todd)) => todd.check().map_err(|e| e.under("todd")),
            (found, _) => {
                let (found, problem) = both_or_neither(found.is_some());
                Err(InvalidInput::new("added_mass_kg_m", found, "either this or todd").because(problem))
            }
        }
    }

    /// Lines along that a module's mesh has for its water: where its wet part begins and ends, where the file says so `[m]`.
    pub fn lines_along_m(&self) -> Vec<f64> {
        self.wet_from_m.into_iter().chain(self.wet_to_m).collect()
    }

    /// Where the wet part of the module's bottom begins and ends, from its left end `[m]`.
    pub fn wet_m(&self) -> [f64; 2] {
        wet_m(self.module.length_m, [self.wet_from_m, self.wet_to_m])
    }

    /// Length of the module's wet part `[m]`.
    pub(crate) fn wet_length_m(&self) -> f64 {
        let [from_m, to_m] = self.wet_m();
        to_m - from_m
    }

    /// Share of the module's length that is wet.
    pub fn wet_share(&self) -> f64 {
        self.wet_length_m() / self.module.length_m
    }

    /// Refuses a dry module of which an end is free to fall: no neighbour that floats, no support and no bank that holds z both ways.
    ///
    /// # Errors
    /// [`InvalidInput`] on `modules`.
    pub(super) fn check_dry_held(&self) -> Result<(), InvalidInput> {
        let variants = self.variants();
        let is_dry: Vec<bool> = variants
            .of_module
            .iter()
            .map(|&of| variants.designs[of].is_dry())
            .collect();
        let floats = |module: usize| (1..=self.modules).contains(&module) && !is_dry[module - 1];
        let is_held = |position: usize| {
            let supported = match position {
                1 => self.supports.left.contains(&Direction::Z),
                _ => position > self.modules && self.supports.right.contains(&Direction::Z),
            };
            let of_bank = |bank: &BankSpec| {
                !bank.one_sided && bank.direction == Direction::Z && bank.position(self.modules) == position
            };
            // the modules left and right of a position
            supported || floats(position - 1) || floats(position) || self.banks.iter().any(of_bank)
        };
        for module in (1..=self.modules).filter(|module| is_dry[module - 1]) {
            if let Some(position) = [module, module + 1].into_iter().find(|&position| !is_held(position)) {
                let found = format!("module {module}, which is dry, free at position {position}");
                let allowed = "dry modules held in z at both ends in a static case: by a neighbour that floats, by supports, or by a bank both ways";
                return Err(InvalidInput::new("modules", found, allowed).because(Problem::Conflict));
            }
        }
        Ok(())
    }

    /// Whether no water is under the module.
    pub(crate) fn is_dry(&self) -> bool {
        self.wet_length_m() <= SAME_PLACE_M
    }

    /// Whether some of the module's bottom is dry.
    pub(crate) fn is_dry_in_part(&self) -> bool {
        self.module.length_m - self.wet_length_m() > SAME_PLACE_M
    }

    /// p_b `[Pa/m]`, from the value or the table, whose slope is that of the wet part; 0 of a dry module.
    pub fn p_b(&self) -> f64 {
        match (self.hydrostatic_stiffness_pa_m, &self.draft_buoyancy) {
            (Some(p_b), _) => p_b,
            (None, Some(table)) => table.slope_n_m() / (self.wet_length_m() * self.module.breadth_m),
            (None, None) if self.is_dry() => 0.0,
            (None, None) => f64::NAN,
        }
    }

    /// m_a per metre of the wet part `[kg/m]`, from the value or Todd's formula; 0 of a dry module.
    pub fn m_a(&self) -> f64 {
        match (self.added_mass_kg_m, &self.todd) {
            (Some(m_a), _) => m_a,
            (None, Some(todd)) => todd.added_mass_kg_m(self.module.breadth_m),
            (None, None) if self.is_dry() => 0.0,
            (None, None) => f64::NAN,
        }
    }
}

/// What is wrong where exactly one of two keys is needed and both or neither are given.
fn both_or_neither(both: bool) -> (&'static str, Problem) {
    if both {
        ("both", Problem::Misplaced)
    } else {
        ("neither", Problem::Missing)
    }
}
