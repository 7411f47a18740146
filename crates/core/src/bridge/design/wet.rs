//! The water of a module: whether its wet part, its numbers and its water line can be.
//!
//! Knows what numbers of the water contradict a module or each other. Does not know how the water is shared among nodes.

use super::{BankSpec, BridgeDesign, Direction};
use crate::input::{InvalidInput, Problem, not_negative, positive, within};

/// How far the sum of a draft and a freeboard may be off the depth, as both are rounded `[m]`, and as a share of it.
const ROUNDED_M: f64 = 0.010_001;
const ROUNDED: f64 = 0.01;

/// Density of fresh water `[kg/m^3]`, by which a mass gives a draft.
const WATER_KG_M3: f64 = 1000.0;

/// How often a draft may be that of the box with the model's mass, or that one it: a hull is no box, and a model may leave
/// out what a deck carries.
const FULLNESS: f64 = 2.0;

/// What a dry module may have of the water.
pub(super) const OF_DRY: &str = "nothing: the module is dry, its wet part begins where it ends";

/// Refuses a wet part that is not on the module, and numbers that describe no water, or water of a dry module.
///
/// # Errors
/// [`InvalidInput`] with the key's path.
pub(super) fn check_water(design: &BridgeDesign) -> Result<(), InvalidInput> {
    let length_m = design.module.length_m;
    let [from_m, _] = design.wet_m();
    within("wet_from_m", from_m, 0.0, length_m)?;
    if let Some(to_m) = design.wet_to_m {
        within("wet_to_m", to_m, from_m, length_m)?;
    }
    if design.is_dry() {
        if design.water.is_some() {
            let refused = InvalidInput::new(
                "water",
                "a water file",
                "no file where a module is dry: waves run under all modules",
            );
            return Err(refused.because(Problem::Misplaced));
        }
        let given = [
            (
                "hydrostatic_stiffness_pa_m",
                design.hydrostatic_stiffness_pa_m.is_some(),
            ),
            ("draft_buoyancy", design.draft_buoyancy.is_some()),
            ("added_mass_kg_m", design.added_mass_kg_m.is_some()),
            ("todd", design.todd.is_some()),
        ];
        return match given.into_iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(InvalidInput::new(key, "a value", OF_DRY).because(Problem::Misplaced)),
            None => Ok(()),
        };
    }
    match (design.hydrostatic_stiffness_pa_m, &design.draft_buoyancy) {
        (Some(p_b), None) => positive("hydrostatic_stiffness_pa_m", p_b).map(|_| ())?,
        (None, Some(table)) => table.check().map_err(|e| e.under("draft_buoyancy"))?,
        (found, _) => {
            let (found, problem) = both_or_neither(found.is_some());
            let refused = InvalidInput::new("hydrostatic_stiffness_pa_m", found, "either this or draft_buoyancy");
            return Err(refused.because(problem));
        }
    }
    if design.water.is_some() {
        let given = [
            ("added_mass_kg_m", design.added_mass_kg_m.is_some()),
            ("todd", design.todd.is_some()),
        ];
        return match given.into_iter().find(|(_, given)| *given) {
            Some((key, _)) => {
                let allowed = "nothing beside water, whose file has the added mass";
                Err(InvalidInput::new(key, "a value", allowed).because(Problem::Misplaced))
            }
            None => Ok(()),
        };
    }
    match (design.added_mass_kg_m, &design.todd) {
        (Some(m_a), None) => not_negative("added_mass_kg_m", m_a).map(|_| ()),
        (None, Some(todd)) => todd.check().map_err(|e| e.under("todd")),
        (found, _) => {
            let (found, problem) = both_or_neither(found.is_some());
            Err(InvalidInput::new("added_mass_kg_m", found, "either this, todd or water").because(problem))
        }
    }
}

/// Most modules of a bridge in water with memory: its mass couples the dofs of all modules, and its states take minutes.
const MOST_IN_WAVES: usize = 40;

/// Refuses a bridge that is too long for water with memory.
///
/// # Errors
/// [`InvalidInput`] on `modules`.
pub(super) fn check_modules_in_waves(design: &BridgeDesign) -> Result<(), InvalidInput> {
    if design.water.is_none() || design.modules <= MOST_IN_WAVES {
        return Ok(());
    }
    let allowed = format!("at most {MOST_IN_WAVES} in water with memory");
    Err(InvalidInput::new("modules", design.modules, allowed).because(Problem::Conflict))
}

/// Refuses a dry module of which an end is free to fall: no neighbour that floats, no support and no bank that holds z.
///
/// # Errors
/// [`InvalidInput`] on `modules`.
pub(super) fn check_dry_held(design: &BridgeDesign) -> Result<(), InvalidInput> {
    let variants = design.variants();
    let is_dry: Vec<bool> = variants
        .of_module
        .iter()
        .map(|&of| variants.designs[of].is_dry())
        .collect();
    let floats = |module: usize| (1..=design.modules).contains(&module) && !is_dry[module - 1];
    let is_held = |position: usize| {
        let supported = match position {
            1 => design.supports.left.contains(&Direction::Z),
            _ => position > design.modules && design.supports.right.contains(&Direction::Z),
        };
        let of_bank = |bank: &BankSpec| bank.direction == Direction::Z && bank.position(design.modules) == position;
        // the modules left and right of a position
        supported || floats(position - 1) || floats(position) || design.banks.iter().any(of_bank)
    };
    for module in (1..=design.modules).filter(|module| is_dry[module - 1]) {
        if let Some(position) = [module, module + 1].into_iter().find(|&position| !is_held(position)) {
            let found = format!("module {module}, which is dry, free at position {position}");
            let allowed = "dry modules held in z at both ends: by a neighbour that floats, by supports, or by a bank";
            return Err(InvalidInput::new("modules", found, allowed).because(Problem::Conflict));
        }
    }
    Ok(())
}

/// Refuses a draft and a freeboard that contradict the depth of the only kind, each other, its mass or its table of buoyancies.
///
/// # Errors
/// [`InvalidInput`] with the key's path.
pub(super) fn check_own_water_line(design: &BridgeDesign) -> Result<(), InvalidInput> {
    let conflict =
        |key: &str, found: f64, allowed: String| Err(InvalidInput::new(key, found, allowed).because(Problem::Conflict));
    let depth_m = design.module.outline().largest_depth_m();
    let rounded = ROUNDED_M.max(ROUNDED * depth_m);
    for (key, value) in [("draft_m", design.draft_m), ("freeboard_m", design.freeboard_m)] {
        if let Some(value) = value.filter(|&value| value > depth_m) {
            return conflict(key, value, format!("at most {depth_m}, the depth of the module"));
        }
    }
    if let (Some(draft), Some(freeboard)) = (design.draft_m, design.freeboard_m)
        && (draft + freeboard - depth_m).abs() > rounded
    {
        let rest = metres(depth_m - draft);
        let allowed = format!("about {rest}, what the depth of {depth_m} leaves above the draft of {draft}");
        return conflict("freeboard_m", freeboard, allowed);
    }
    let Some(draft) = design.draft_m else { return Ok(()) };
    if let Some(table) = &design.draft_buoyancy
        && (draft - table.still_water_draft_m).abs() > rounded
    {
        let still = table.still_water_draft_m;
        let allowed = format!("about {still}, the draft of draft_buoyancy.still_water_draft_m");
        return conflict("draft_m", draft, allowed);
    }
    if design.is_dry_in_part() {
        // what holds up the rest is not known
        return Ok(());
    }
    let mass_kg = design.structural_mass_kg();
    let of_mass = mass_kg / (WATER_KG_M3 * design.module.length_m * design.module.breadth_m);
    if !(of_mass / FULLNESS..=of_mass * FULLNESS).contains(&draft) {
        let [least, most] = [of_mass / FULLNESS, of_mass * FULLNESS].map(metres);
        let allowed = format!(
            "about {}, which the mass of the module gives ({mass_kg:.0} kg), and no less than {least} or more than {most}",
            metres(of_mass)
        );
        return conflict("draft_m", draft, allowed);
    }
    Ok(())
}

/// A length to the millimetre, for a message.
fn metres(length_m: f64) -> f64 {
    (length_m * 1e3).round() / 1e3
}

/// What is wrong where exactly one of two keys is needed and both or neither are given.
fn both_or_neither(both: bool) -> (&'static str, Problem) {
    if both {
        ("both", Problem::Misplaced)
    } else {
        ("neither", Problem::Missing)
    }
}
