//! The weight of what the water does not carry: the plates and beams beside the wet part of a bottom.
//!
//! Knows which elements stand beside the wet part. Does not know who carries them.

use super::BridgeDesign;
use crate::fem::{DOFS_PER_NODE, FemError, MassKind, Mesh, NodeId, assemble};
use crate::vehicle::GRAVITY_M_S2;
use nalgebra::Vector3;

/// Weight of a module's elements whose centre is beside the wet part of the bottom, of a dry module of all: the load by the dofs of
/// the full module, up along z `[N or N m]`, `f = -g M r` with their consistent mass M and a unit heave r. None where nothing
/// is dry.
///
/// # Errors
/// [`FemError`] as [`assemble`].
/// Equation (W3).
pub(super) fn dry_weight(design: &BridgeDesign, mesh: &Mesh) -> Result<Option<Vec<f64>>, FemError> {
    if !design.is_dry_in_part() {
        return Ok(None);
    }
    let [from_m, to_m] = design.wet_m();
    let is_dry = |nodes: &[NodeId]| {
        let middle_m = nodes.iter().map(|&node| mesh.place(node).x).sum::<f64>() / nodes.len() as f64;
        design.is_dry() || middle_m < from_m || middle_m > to_m
    };
    let mut dry = mesh.clone();
    dry.shells.retain(|shell| is_dry(&shell.nodes));
    dry.beams.retain(|beam| is_dry(&beam.nodes));
    let (_, mass) = assemble(&dry, MassKind::Consistent)?;
    let heave: Vec<f64> = (0..mesh.dofs())
        .map(|i| if i % DOFS_PER_NODE == 2 { 1.0 } else { 0.0 })
        .collect();
    let mut weight = vec![0.0; mesh.dofs()];
    mass.multiply(&heave, &mut weight);
    weight.iter_mut().for_each(|force| *force *= -GRAVITY_M_S2);
    Ok(Some(weight))
}

/// Resultants of a load by the dofs of the full module about the left end's centre: up `[N]`, about x and about y `[N m]`.
pub(super) fn resultants(load: &[f64], mesh: &Mesh) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (node, of) in load.chunks_exact(DOFS_PER_NODE).enumerate() {
        let place: Vector3<f64> = mesh.place(NodeId(node));
        sums[0] += of[2];
        sums[1] += place.y * of[2] + of[3];
        sums[2] += of[4] - place.x * of[2];
    }
    sums
}
