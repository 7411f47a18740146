//! Modules of beams: two parallel lines along the bottom that bend as one plane beam under loads symmetric about y = 0.
//!
//! Knows how such a module is meshed and put into a bridge through `PreparedModule::from_mesh`. Does not know what is
//! expected of it.

use crate::{Ready, design, with};
use pontoon_core::bridge::{BridgeDesign, Model, PreparedModule};
use pontoon_core::fem::{BeamSection, Mesh, NodeId};
use pontoon_core::module::{Grid, LongitudinalWalls, ModuleMesh, Stiffeners, TransverseWalls};
use pontoon_core::vehicle::{Axle, Inertia, Vehicle, VehicleDesign};
use pontoon_core::water::WaterDistribution;
use std::array::from_fn;

/// Young's modulus of all sections `[Pa]`; what is given is the product with it.
const E_PA: f64 = 2e11;

/// A module of beams; stiffness and mass are those of both lines together.
///
/// Lines at y = plus and minus half the breadth along z = 0, a post from each of their nodes to a deck node above it, a cross
/// beam between each pair of nodes. Posts and cross beams have no mass; under loads symmetric about y = 0 the cross beams do
/// nothing and the posts carry loads down and connector forces as moments.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamModule {
    /// Length `[m]`.
    pub length_m: f64,
    /// Distance of the two lines `[m]`.
    pub breadth_m: f64,
    /// Height of the posts `[m]`.
    pub depth_m: f64,
    /// Elements along a line.
    pub elements: usize,
    /// EI `[N m^2]`.
    pub bending_stiffness_n_m2: f64,
    /// EA `[N]`.
    pub axial_stiffness_n: f64,
    /// Mass per length `[kg/m]`.
    pub mass_kg_m: f64,
    /// EI `[N m^2]` and EA `[N]` of the two posts at one place.
    pub posts: (f64, f64),
}

impl BeamModule {
    /// A slender beam: posts `rigid` times as stiff as the beam, in bending and along.
    pub fn slender(length_m: f64, elements: usize, ei_n_m2: f64, mass_kg_m: f64, rigid: f64) -> Self {
        let breadth_m = 2.0;
        // a radius of gyration of a fifth of an element
        let ea_n = ei_n_m2 / (0.2 * length_m / elements as f64).powi(2);
        Self {
            length_m,
            breadth_m,
            depth_m: 1.0,
            elements,
            bending_stiffness_n_m2: ei_n_m2,
            axial_stiffness_n: ea_n,
            mass_kg_m,
            posts: (rigid * ei_n_m2, rigid * ea_n),
        }
    }

    /// The mesh: Euler-Bernoulli beams with the consistent mass of their deflection, without rotary inertia.
    ///
    /// # Panics
    /// Where the numbers make no grid.
    pub fn mesh(&self) -> ModuleMesh {
        let mut mesh = Mesh::default();
        let x: Vec<f64> = (0..=self.elements)
            .map(|i| self.length_m * i as f64 / self.elements as f64)
            .collect();
        let y = [-0.5 * self.breadth_m, 0.5 * self.breadth_m];
        let mut level = |z: f64| -> Vec<NodeId> {
            let places = x.iter().flat_map(|&x| y.iter().map(move |&y| [x, y, z]));
            places.map(|place| mesh.add_node(place.into())).collect()
        };
        let (bottom, deck) = (level(0.0), level(self.depth_m));
        // the one bends, the other stretches and weighs: so there is no rotary inertia
        let bends = section(0.5 * self.bending_stiffness_n_m2, 0.0, 0.0);
        let weighs = section(0.0, 0.5 * self.axial_stiffness_n, 0.5 * self.mass_kg_m);
        let post = section(0.5 * self.posts.0, 0.5 * self.posts.1, 0.0);
        let along = [0.0, 0.0, 1.0].into();
        for (i, pair) in bottom.chunks(2).enumerate() {
            for line in 0..2 {
                if let Some(next) = bottom.get(2 * i + 2 + line) {
                    mesh.add_beam([pair[line], *next], bends, along);
                    mesh.add_beam([pair[line], *next], weighs, along);
                }
                mesh.add_beam([pair[line], deck[2 * i + line]], post, [1.0, 0.0, 0.0].into());
            }
            mesh.add_beam([pair[0], pair[1]], post, along);
        }
        let grid = Grid::new(x, y.to_vec(), deck, bottom).expect("a grid");
        ModuleMesh { mesh, grid }
    }

    /// A bridge of `modules` such modules with water of `k_n_m2` a metre of bridge and metre of sinking and `m_a_kg_m` of added
    /// mass a metre, shared consistently; hinges and connectors on both lines, two trusses a joint of `truss_n_m` each,
    /// supports z at both ends, x at the left.
    pub fn design(&self, modules: usize, k_n_m2: f64, m_a_kg_m: f64, truss_n_m: f64) -> BridgeDesign {
        with(&design("smoke"), |d| {
            d.modules = modules;
            d.module.length_m = self.length_m;
            d.module.breadth_m = self.breadth_m;
            d.module.depth_m = self.depth_m;
            d.module.longitudinal_walls = LongitudinalWalls::default();
            d.module.transverse_walls = TransverseWalls::default();
            d.module.stiffeners = Stiffeners::default();
            d.module.mesh.elements_along = self.elements;
            d.hydrostatic_stiffness_pa_m = Some(k_n_m2 / self.breadth_m);
            d.added_mass_kg_m = Some(m_a_kg_m);
            d.water_distribution = WaterDistribution::Consistent;
            d.hinges.y_m = self.lines().to_vec();
            d.connectors.y_m = self.lines().to_vec();
            d.connectors.stiffness_n_m = truss_n_m;
        })
    }

    /// Places of the two lines across `[m]`.
    pub fn lines(&self) -> [f64; 2] {
        from_fn(|i| (i as f64 - 0.5) * self.breadth_m)
    }

    /// Trusses of the linear connection so stiff that a joint turns `rigid` times less than a module of this length bends.
    pub fn continuous_n_m(&self, rigid: f64) -> f64 {
        // two connectors of both trusses each at the height of the posts: 4 k d^2
        rigid * self.bending_stiffness_n_m2 / (self.length_m * 4.0 * self.depth_m.powi(2))
    }

    /// A vehicle of one axle: half the weight on each line, `points` along a patch of `patch_length_m` whose centre is
    /// the front.
    ///
    /// # Panics
    /// Where the axle is refused.
    pub fn axle(&self, patch_length_m: f64, points: usize, inertia: Inertia) -> Vehicle {
        let axle = Axle {
            behind_front_m: 0.0,
            share: Some(1.0),
            patch_length_m,
            track_y_m: self.lines().to_vec(),
            ..Axle::default()
        };
        let design = VehicleDesign {
            axles: Some(vec![axle]),
            inertia,
            patch_points: points,
            ..VehicleDesign::default()
        };
        design.check(self.breadth_m).expect("an axle")
    }

    /// The module in a bridge, every degree of freedom kept.
    ///
    /// # Panics
    /// Where module or bridge is refused.
    pub fn ready(&self, design: &BridgeDesign, model: Model) -> Ready {
        let module = PreparedModule::from_mesh(design, self.mesh(), model).expect("a module");
        Ready::of(design, module)
    }
}

/// A section by its products with E, EI `[N m^2]` and EA `[N]`, and its mass per length `[kg/m]`; as stiff in torsion (G = E/2)
/// as in bending.
fn section(ei_n_m2: f64, ea_n: f64, mass_kg_m: f64) -> BeamSection {
    let area_m2 = ea_n / E_PA;
    BeamSection {
        area_m2,
        i_y_m4: ei_n_m2 / E_PA,
        i_z_m4: ei_n_m2 / E_PA,
        torsion_m4: 2.0 * ei_n_m2 / E_PA,
        shear_area_m2: None,
        youngs_modulus_pa: E_PA,
        poissons_ratio: 0.0,
        density_kg_m3: if mass_kg_m > 0.0 { mass_kg_m / area_m2 } else { 0.0 },
    }
}
