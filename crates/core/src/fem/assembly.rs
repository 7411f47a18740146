//! From a mesh to its stiffness and mass.
//!
//! Knows which dofs an element touches. Does not know boundary conditions: those are the caller's choice of dofs.

use super::{Beam, FemError, Mesh, NodeId, Shell, SymmetricMatrix};
use nalgebra::SMatrix;

/// How element mass is shared among nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MassKind {
    /// By the shape functions.
    Consistent,
    /// On the diagonal blocks.
    Lumped,
}

/// Stiffness and mass of a mesh, 6 dofs a node, nothing held.
///
/// # Errors
/// [`FemError::Degenerate`] with the element, [`FemError::OutOfMemory`].
pub fn assemble(mesh: &Mesh, mass: MassKind) -> Result<(SymmetricMatrix, SymmetricMatrix), FemError> {
    let mut k = Vec::with_capacity(576 * mesh.shells.len() + 144 * mesh.beams.len());
    let mut m = Vec::with_capacity(k.capacity());
    for (number, shell) in mesh.shells.iter().enumerate() {
        let element = Shell::new(number, &shell.nodes.map(|n| mesh.place(n)), shell.section)?;
        add(&mut k, &shell.nodes, &element.stiffness());
        add(
            &mut m,
            &shell.nodes,
            &match mass {
                MassKind::Consistent => element.mass_consistent(),
                MassKind::Lumped => element.mass_lumped(),
            },
        );
    }
    for (number, beam) in mesh.beams.iter().enumerate() {
        let element = Beam::new(number, &beam.nodes.map(|n| mesh.place(n)), &beam.up, beam.section)?;
        add(&mut k, &beam.nodes, &element.stiffness());
        add(
            &mut m,
            &beam.nodes,
            &match mass {
                MassKind::Consistent => element.mass_consistent(),
                MassKind::Lumped => element.mass_lumped(),
            },
        );
    }
    let n = mesh.dofs();
    Ok((
        SymmetricMatrix::from_entries(n, &k)?,
        SymmetricMatrix::from_entries(n, &m)?,
    ))
}

fn add<const N: usize>(entries: &mut Vec<(usize, usize, f64)>, nodes: &[NodeId], element: &SMatrix<f64, N, N>) {
    let dof = |i: usize| nodes[i / 6].dof(i % 6);
    for j in 0..N {
        for i in 0..N {
            let value = 0.5 * (element[(i, j)] + element[(j, i)]);
            if value != 0.0 {
                entries.push((dof(i), dof(j), value));
            }
        }
    }
}
