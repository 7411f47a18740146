//! Nodes and the elements between them.
//!
//! Knows places and connectivity. Does not know matrices or loads.

use super::beam::BeamSection;
use super::section::ShellSection;
use nalgebra::Vector3;

/// Degrees of freedom of a node: three translations, three rotations.
pub const DOFS_PER_NODE: usize = 6;

/// Number of a node in its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub usize);

impl NodeId {
    /// Number of the node's degree of freedom `direction` (0 to 5).
    #[inline]
    pub fn dof(self, direction: usize) -> usize {
        self.0 * DOFS_PER_NODE + direction
    }
}

/// A 4-node shell of the mesh, nodes in cyclic order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshShell {
    /// Corner nodes.
    pub nodes: [NodeId; 4],
    /// Section.
    pub section: ShellSection,
}

/// A 2-node beam of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshBeam {
    /// End nodes.
    pub nodes: [NodeId; 2],
    /// Section.
    pub section: BeamSection,
    /// A vector that fixes the section's second axis: local y lies in the plane of the beam's axis and this vector.
    pub up: Vector3<f64>,
}

/// A mesh of shells and beams.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Places of the nodes `[m]`.
    pub nodes: Vec<Vector3<f64>>,
    /// Shells.
    pub shells: Vec<MeshShell>,
    /// Beams.
    pub beams: Vec<MeshBeam>,
}

impl Mesh {
    /// Adds a node.
    pub fn add_node(&mut self, place: Vector3<f64>) -> NodeId {
        self.nodes.push(place);
        NodeId(self.nodes.len() - 1)
    }

    /// Adds a shell.
    pub fn add_shell(&mut self, nodes: [NodeId; 4], section: ShellSection) {
        self.shells.push(MeshShell { nodes, section });
    }

    /// Adds a beam.
    pub fn add_beam(&mut self, nodes: [NodeId; 2], section: BeamSection, up: Vector3<f64>) {
        self.beams.push(MeshBeam { nodes, section, up });
    }

    /// Place of a node `[m]`.
    pub fn place(&self, node: NodeId) -> Vector3<f64> {
        self.nodes[node.0]
    }

    /// Mass of all elements `[kg]`: `rho t A` of shells, A half the product of their diagonals, and `rho A L` of beams.
    pub fn mass_kg(&self) -> f64 {
        let shells = self.shells.iter().map(|shell| {
            let [a, b, c, d] = shell.nodes.map(|node| self.place(node));
            let area = 0.5 * (c - a).cross(&(d - b)).norm();
            shell.section.density_kg_m3 * shell.section.thickness_m * area
        });
        let beams = self.beams.iter().map(|beam| {
            let [a, b] = beam.nodes.map(|node| self.place(node));
            beam.section.density_kg_m3 * beam.section.area_m2 * (b - a).norm()
        });
        shells.chain(beams).sum()
    }

    /// Number of degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.nodes.len() * DOFS_PER_NODE
    }
}
