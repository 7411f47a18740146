//! Heights along a bridge: outlines of its modules, bottoms that meet in the hinges, joints of unlike depths.
//!
//! Knows how modules stand side by side. Does not know meshes or water.

use super::{BridgeDesign, ModuleRow};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M};
use crate::module::Outline;

/// The outline of each module from left to right as it stands there.
pub(super) fn outlines(design: &BridgeDesign) -> Vec<Outline> {
    match &design.row {
        Some(row) => row.outlines().collect(),
        None => vec![design.module.outline(); design.modules],
    }
}

/// Height of each module's bottom at its left end above that of the first module, as bottoms meet in the hinges `[m]`.
pub(super) fn bases_m(design: &BridgeDesign) -> Vec<f64> {
    let rise = |base_m: &mut f64, of: Outline| {
        let own_m = *base_m;
        *base_m += of.rise_m();
        Some(own_m)
    };
    design.outlines().into_iter().scan(0.0, rise).collect()
}

/// Height of the deck at a place along the bridge above the bottom of its left end `[m]`; beyond an end that of the end.
pub(super) fn deck_m(design: &BridgeDesign, x_m: f64) -> f64 {
    let (positions_m, outlines) = (design.positions_m(), design.outlines());
    let behind = positions_m.partition_point(|position_m| *position_m <= x_m);
    let j = behind.saturating_sub(1).min(outlines.len() - 1);
    let along_m = (x_m - positions_m[j]).clamp(0.0, outlines[j].length_m);
    design.bases_m()[j] + outlines[j].deck_at_m(along_m)
}

/// The joints whose two ends have other depths than each other.
fn joints_of_unlike_depths(design: &BridgeDesign) -> Vec<usize> {
    let depths_m: Vec<[f64; 2]> = design.outlines().iter().map(Outline::depths_m).collect();
    let unlike = |joint: &usize| (depths_m[joint - 2][1] - depths_m[joint - 1][0]).abs() > SAME_PLACE_M;
    (2..=design.modules).filter(unlike).collect()
}

/// Whether there are such joints.
pub(super) fn has_unlike_depths(design: &BridgeDesign) -> bool {
    !joints_of_unlike_depths(design).is_empty()
}

/// Refuses connectors above a hinge at a joint of unlike depths, where they would act on the hinge itdesign.
///
/// # Errors
/// [`InvalidInput`] with the key's path.
pub(super) fn check_unlike_depths(design: &BridgeDesign) -> Result<(), InvalidInput> {
    for joint in joints_of_unlike_depths(design) {
        let hinges = &design.hinges_of(joint).y_m;
        let above = |y_m: &f64| hinges.iter().any(|hinge| (hinge - y_m).abs() <= SAME_PLACE_M);
        if let Some(i) = design.connectors.y_m.iter().position(above) {
            let allowed = format!("a place without a hinge: the depths at joint {joint} are not alike");
            let refused = InvalidInput::new(format!("connectors.y_m[{i}]"), design.connectors.y_m[i], allowed);
            return Err(refused.because(Problem::Conflict));
        }
    }
    Ok(())
}

/// Depth of the deepest module, and its still-water draft where its kind has one `[m]`.
pub(super) fn deepest_m(design: &BridgeDesign) -> (f64, Option<f64>) {
    let kinds = design.row.iter().flat_map(ModuleRow::kinds_in_row);
    let each = kinds.map(|kind| (kind.module.outline().largest_depth_m(), kind.draft_m));
    let first = (design.module.outline().largest_depth_m(), design.draft_m);
    // of equal depths one whose draft is known
    let better = |a: (f64, Option<f64>), b: (f64, Option<f64>)| b.0 > a.0 || (b.0 == a.0 && a.1.is_none());
    each.fold(first, |a, b| if better(a, b) { b } else { a })
}
