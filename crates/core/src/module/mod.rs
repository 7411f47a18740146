//! The pontoon's geometry as finite elements.
//!
//! Knows how a box of plates, walls and stiffeners becomes a mesh with named grids of deck and bottom nodes. Does not
//! know water, hinges, connectors or neighbours.

mod box_mesh;
mod design;
mod grid;
mod outline;
mod plates;

pub use box_mesh::mesh_module;
pub(crate) use box_mesh::{MeshSize, lines_across, mesh_size};
pub use design::{LongitudinalWalls, Material, MeshDesign, ModuleDesign, Stiffeners, TransverseWalls};
pub use grid::{Grid, ModuleMesh};
pub use outline::Outline;
pub use plates::Plate;
