//! Stresses of every shell and forces of every beam of a bridge, from the motion of its dofs.
//!
//! Knows the elements of a module and what the inertia of condensed dofs does to them. Does not know how the motion was
//! found, nor files.

use super::meshed::{MeshedBridge, translations_first};
use super::modules::Modules;
use super::{BridgeDesign, BridgeError, PreparedModule};
use crate::fem::{Beam, BeamForceMatrix, BeamForces, MeshBeam, MeshShell, Shell, ShellStress, ShellStressMatrix};
use faer::Mat;
use std::borrow::Borrow;

/// What makes stresses of the motion of a bridge: the matrices of the elements of each variant of its modules.
#[derive(Debug)]
pub struct StressRecovery {
    variants: Vec<ModuleElements>,
    /// Of each variant what the inertia of condensed dofs adds to the motion of the nodes; none where nothing is condensed.
    inertial: Option<Vec<Mat<f64>>>,
}

/// The elements of a module.
#[derive(Debug)]
struct ModuleElements {
    /// Each shell's nodes and its stress at the centre.
    shells: Vec<([usize; 4], ShellStressMatrix)>,
    /// Each beam's nodes and its forces at the middle.
    beams: Vec<([usize; 2], BeamForceMatrix)>,
}

/// Stresses of a bridge at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct BridgeStresses {
    /// At the centre of each shell, in the order of [`MeshedBridge::shells`].
    pub shells: Vec<ShellStress>,
    /// At the middle of each beam, in the order of [`MeshedBridge::beams`].
    pub beams: Vec<BeamForces>,
}

impl ModuleElements {
    fn of(module: &PreparedModule) -> Result<Self, BridgeError> {
        let mesh = &module.mesh;
        let shell = |(number, shell): (usize, &MeshShell)| {
            let element = Shell::new(number, &shell.nodes.map(|node| mesh.place(node)), shell.section)?;
            Ok((shell.nodes.map(|node| node.0), element.stress_matrix(0.0, 0.0)))
        };
        let beam = |(number, beam): (usize, &MeshBeam)| {
            let ends = beam.nodes.map(|node| mesh.place(node));
            let element = Beam::new(number, &ends, &beam.up, beam.section)?;
            Ok((beam.nodes.map(|node| node.0), element.force_matrix()))
        };
        let (shells, beams) = (mesh.shells.iter().enumerate(), mesh.beams.iter().enumerate());
        Ok(Self {
            shells: shells.map(shell).collect::<Result<_, BridgeError>>()?,
            beams: beams.map(beam).collect::<Result<_, BridgeError>>()?,
        })
    }
}

impl StressRecovery {
    /// Of the bridges of a module, prepared from `design`.
    ///
    /// # Errors
    /// [`BridgeError::Fem`], which the module would have met already.
    pub fn new(design: &BridgeDesign, module: &PreparedModule) -> Result<Self, BridgeError> {
        Self::of_kinds(design, &[module])
    }

    /// Of the bridges of the modules prepared from the variants of `design`.
    ///
    /// # Errors
    /// As [`StressRecovery::new`], and [`BridgeError::Design`] where these are not its modules.
    pub fn of_kinds<M: Borrow<PreparedModule>>(design: &BridgeDesign, prepared: &[M]) -> Result<Self, BridgeError> {
        let modules = Modules::new(design, prepared)?;
        let variants = || modules.variants.iter().zip(&modules.designs);
        let inertial: Vec<Option<Mat<f64>>> = variants()
            .map(|(module, design)| module.inertial_correction(design))
            .collect::<Result<_, _>>()?;
        let ordered = inertial
            .iter()
            .map(|matrix| matrix.as_ref().map(|m| translations_first(m.as_ref())));
        Ok(Self {
            variants: variants()
                .map(|(module, _)| ModuleElements::of(module))
                .collect::<Result<_, _>>()?,
            inertial: ordered.collect(),
        })
    }

    /// Stresses of the bridge of `meshed` where its dofs move by `u` `[m or rad]`; `inertial` is `u'' + b v`, on which the
    /// mass acts, or nothing at rest.
    ///
    /// The stress is that of the strain, without a damping's share. In a condensed module the inner dofs move by
    /// `T u + R (u'' + b v)`: exact in statics, where nothing acts on them, and in motion but for the acceleration that the
    /// fixed-master modes leave out. Verified by `tests/solvers/stresses.rs`.
    /// Equation (G4).
    pub fn stresses(&self, meshed: &MeshedBridge, u: &[f64], inertial: Option<&[f64]>) -> BridgeStresses {
        let [moved, turned] = [0, 3].map(|first| {
            let mut own = meshed.triples(u, first);
            if let (Some(matrices), Some(inertial)) = (&self.inertial, inertial) {
                let added = meshed.triples_by(matrices, inertial, first);
                let components = own.iter_mut().flatten().zip(added.iter().flatten());
                components.for_each(|(own, added)| *own += added);
            }
            own
        });
        let mut found = BridgeStresses {
            shells: Vec::with_capacity(meshed.shells.len()),
            beams: Vec::with_capacity(meshed.beams.len()),
        };
        let (mut moved, mut turned) = (&moved[..], &turned[..]);
        for (variant, nodes) in meshed.nodes_of_modules() {
            let module = (&moved[..nodes], &turned[..nodes]);
            (moved, turned) = (&moved[nodes..], &turned[nodes..]);
            let shell =
                |(nodes, matrix): &([usize; 4], ShellStressMatrix)| Shell::stress(matrix, &motion(nodes, module));
            let beam = |(nodes, matrix): &([usize; 2], BeamForceMatrix)| Beam::forces(matrix, &motion(nodes, module));
            let elements = &self.variants[variant];
            found.shells.extend(elements.shells.iter().map(shell));
            found.beams.extend(elements.beams.iter().map(beam));
        }
        found
    }
}

/// The degrees of freedom of an element with `DOFS / 6` nodes, from the translations and rotations of its module's nodes.
fn motion<const DOFS: usize>(nodes: &[usize], (moved, turned): (&[[f64; 3]], &[[f64; 3]])) -> [f64; DOFS] {
    std::array::from_fn(|i| {
        let node = nodes[i / 6];
        match i % 6 {
            direction @ 0..3 => moved[node][direction],
            direction => turned[node][direction - 3],
        }
    })
}
