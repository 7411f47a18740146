//! Modules that slope and are wet in part, by hand: their plates, their water, the weight of what is dry, a tapered cantilever.

#![allow(clippy::expect_used)]

use super::prepared::Z;
use super::{BridgeDesign, Model, PreparedModule};
use crate::fem::{DOFS_PER_NODE, Factor, SymmetricMatrix};
use crate::module::{LongitudinalWalls, Outline, Stiffeners, TransverseWalls};
use crate::vehicle::GRAVITY_M_S2;
use crate::water::WaterDistribution;

const WATER_PA_M: f64 = 7000.0;
const ADDED_KG_M: f64 = 9000.0;

/// One module of plates alone, 20 m long and 1 m wide, 1 m deep at the left and 0.4 m at the right, its water consistent between two
/// places.
fn plates(wet_m: [f64; 2]) -> BridgeDesign {
    let text = include_str!("../../../../studies/bridges/smoke.json");
    let mut design: BridgeDesign = serde_json::from_str(text).expect("a design");
    design.modules = 1;
    design.hinges.y_m = vec![-0.5, 0.5];
    design.connectors.y_m = vec![0.0];
    let module = &mut design.module;
    (module.length_m, module.breadth_m, module.depth_m) = (20.0, 1.0, 1.0);
    (module.deck_right_m, module.bottom_right_m) = (Some(0.7), Some(0.3));
    module.longitudinal_walls = LongitudinalWalls::default();
    module.transverse_walls = TransverseWalls::default();
    module.stiffeners = Stiffeners::default();
    (module.deck_thickness_m, module.bottom_thickness_m) = (0.004, 0.004);
    (module.side_thickness_m, module.end_thickness_m) = (0.003, 0.005);
    module.material.poissons_ratio = 0.0;
    module.mesh.elements_along = 20;
    module.mesh.elements_over_depth = 2;
    (design.draft_m, design.freeboard_m) = (None, None);
    design.water_distribution = WaterDistribution::Consistent;
    (design.wet_from_m, design.wet_to_m) = (Some(wet_m[0]), Some(wet_m[1]));
    let is_dry = wet_m[0] == wet_m[1];
    design.hydrostatic_stiffness_pa_m = (!is_dry).then_some(WATER_PA_M);
    design.added_mass_kg_m = (!is_dry).then_some(ADDED_KG_M);
    design.check().expect("a module");
    design
}

fn full(design: &BridgeDesign) -> PreparedModule {
    PreparedModule::new(design, Model::Full).expect("a module")
}

/// A motion of all nodes: translations and rotations by place.
fn motion(module: &PreparedModule, of: impl Fn([f64; 3]) -> [f64; 6]) -> Vec<f64> {
    let each = module.mesh.nodes.iter();
    each.flat_map(|place| of([place.x, place.y, place.z])).collect()
}

fn product(a: &SymmetricMatrix, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    a.multiply(x, &mut y);
    y
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Passes where `right` is within the tolerance and `wrong`, which is 5 % off, is not.
fn held(what: &str, tolerance: f64, right: f64, wrong: f64) {
    assert!(right <= tolerance, "{what}: {right:e} is above {tolerance:e}");
    assert!(wrong > tolerance, "{what}: 5 % off passes with {wrong:e}");
}

/// Rigid motions of a sloping box strain nothing: 1e-12 of the largest term of a sum, its rounding. Twin: a turn that lifts 5 % more
/// than it turns.
#[test]
fn rigid_motions_of_a_sloping_box_are_strain_free() {
    let module = full(&plates([0.0, 0.0]));
    let miss = |rigid: [f64; 6], lifts: f64| {
        let [a, b, c, p, q, r] = rigid;
        let u = motion(&module, |[x, y, z]| {
            [
                a + q * z - r * y,
                b + r * x - p * z,
                c + lifts * (p * y - q * x),
                p,
                q,
                r,
            ]
        });
        let term = largest(module.k.entries().map(|(_, j, v)| v * u[j]));
        largest(product(&module.k, &u)) / term
    };
    for which in 0..6 {
        let rigid = std::array::from_fn(|i| if i == which { 1.0 } else { 0.0 });
        let right = miss(rigid, 1.0);
        assert!(right < 1e-12, "motion {which}: {right:e}");
    }
    held(
        "turned about y",
        1e-12,
        miss([0.0, 0.0, 0.0, 0.0, 1.0, 0.0], 1.0),
        miss([0.0, 0.0, 0.0, 0.0, 1.0, 0.0], 1.05),
    );
}

/// Area `[m^2]` times thickness, and first moment about the left end, of the plates of [`plates`] up to a place; the end plate on
/// the right where that is the whole.
fn volume(to_m: f64) -> [f64; 2] {
    let outline = plates([0.0, 20.0]).module.outline();
    let depth_m = |x: f64| outline.deck_at_m(x) - outline.bottom_at_m(x);
    let slope = |rise_m: f64| f64::hypot(1.0, rise_m / 20.0);
    let flat = 0.004 * to_m * (slope(-0.3) + slope(0.3));
    let (left, right) = (depth_m(0.0), depth_m(to_m));
    let sides = 2.0 * 0.003 * to_m * 0.5 * (left + right);
    let sides_middle_m = to_m / 3.0 * (left + 2.0 * right) / (left + right);
    let end = if to_m == 20.0 { 0.005 * depth_m(20.0) } else { 0.0 };
    let ends = 0.005 * depth_m(0.0) + end;
    [
        flat + sides + ends,
        flat * 0.5 * to_m + sides * sides_middle_m + end * to_m,
    ]
}

/// The weight of a dry box and of the dry part of another is that of their plates, and so is the moment about the left end:
/// 1e-12, rounding. Twin: plates 5 % off.
#[test]
fn the_dry_part_weighs_what_its_plates_weigh() {
    let density = plates([0.0, 0.0]).module.material.density_kg_m3;
    for (wet_m, dry_to_m) in [
        ([0.0, 0.0], 20.0),
        ([20.0, 20.0], 20.0),
        ([5.0, 20.0], 5.0),
        ([7.3, 20.0], 7.3),
    ] {
        let module = full(&plates(wet_m));
        let [up, about_x, about_y] = module.dry_resultants();
        let miss = |off: f64| {
            let [force, moment] = volume(dry_to_m).map(|v| off * density * GRAVITY_M_S2 * v);
            let about_y = (about_y - moment).abs() / moment;
            largest([(up + force) / force, about_x / force, about_y])
        };
        held(&format!("dry to {dry_to_m} m"), 1e-12, miss(1.0), miss(1.05));
        let by_dofs: f64 = module
            .dry_weight()
            .dot(&motion(&module, |_| [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
        assert!((by_dofs - up).abs() < 1e-12 * up.abs());
        // condensed it is the same load on masters that move as one
        if dry_to_m == 5.0 {
            let design = plates(wet_m);
            let condensed = PreparedModule::new(&design, Model::SuperElement).expect("a module");
            assert_eq!(condensed.dry_resultants(), module.dry_resultants());
        }
    }
    let wet = full(&plates([0.0, 20.0]));
    assert!(wet.dry_weight().0.is_empty());
    assert_eq!(wet.dry_resultants(), [0.0; 3]);
    let mass_kg = density * volume(20.0)[0];
    assert!((wet.structural_mass_kg() - mass_kg).abs() < 1e-12 * mass_kg);
}

/// Force and moments of the water under a part of the bottom for heave, a unit turn about y and about x, and its added mass, by
/// hand: 1e-10, rounding of sums over the mesh. Twin: 5 % more water.
#[test]
fn water_acts_between_the_places_of_the_wet_part() {
    for [from, to] in [[0.0, 20.0], [4.0, 20.0], [2.5, 11.3], [0.0, 6.0]] {
        let module = full(&plates([from, to]));
        let of = |z: fn(f64, f64) -> f64| motion(&module, |[x, y, _]| [0.0, 0.0, z(x, y), 0.0, 0.0, 0.0]);
        let [heave, along, across] = [of(|_, _| 1.0), of(|x, _| x), of(|_, y| y)];
        let [up, about_x, about_y] = &module.water;
        let mass_kg = module.m.form(&heave, &heave) - module.structural_mass_kg();
        let power = |n: i32| (to.powi(n) - from.powi(n)) / f64::from(n);
        let miss = |water: f64| {
            let p = water * WATER_PA_M;
            largest([
                up.dot(&heave) / (-p * power(1)) - 1.0,
                up.dot(&along) / (-p * power(2)) - 1.0,
                about_y.dot(&heave) / (p * power(2)) - 1.0,
                about_y.dot(&along) / (p * power(3)) - 1.0,
                about_x.dot(&across) / (-p * power(1) / 12.0) - 1.0,
                mass_kg / (water * ADDED_KG_M * (to - from)) - 1.0,
            ])
        };
        held(&format!("water from {from} to {to} m"), 1e-10, miss(1.0), miss(1.05));
    }
}

/// Deflection of the free end of [`plates`] clamped at its left end under a unit force `[m]`: `int M^2/EI + V^2/GA dx`, the force
/// that inclined plates carry taken off the shear.
fn cantilever_m(stiffer: f64) -> f64 {
    let design = plates([0.0, 0.0]);
    let outline = design.module.outline();
    let e = stiffer * design.module.material.youngs_modulus_pa;
    let parts = 20_000;
    let dx = 20.0 / f64::from(parts);
    let at = |x: f64| {
        let depth = outline.deck_at_m(x) - outline.bottom_at_m(x);
        let inertia = 2.0 * 0.004 * (0.5 * depth).powi(2) + 2.0 * 0.003 * depth.powi(3) / 12.0;
        let moment = 20.0 - x;
        let flanges = 0.004 * depth.powi(2) / 2.0 / inertia;
        let shear = 1.0 - flanges * moment / depth * (0.6 / 20.0);
        moment.powi(2) / (e * inertia) + shear.powi(2) / (0.5 * e * 2.0 * 0.003 * depth)
    };
    (0..parts).map(|i| at((f64::from(i) + 0.5) * dx) * dx).sum()
}

/// A tapered cantilever of shells bends as a beam of its sections: 1 %, what shear lag and the mesh take. Twin: E 5 % off.
#[test]
fn a_tapered_cantilever_bends_as_its_sections_say() {
    let module = full(&plates([0.0, 0.0]));
    let tip = |place: [f64; 3]| place[0] > 20.0 - 1e-9;
    let nodes = || module.mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).enumerate();
    let free: Vec<usize> = nodes()
        .filter(|(_, place)| place[0] > 1e-9)
        .flat_map(|(node, _)| (0..DOFS_PER_NODE).map(move |d| node * DOFS_PER_NODE + d))
        .collect();
    let place = |dof: usize| free.binary_search(&dof).ok();
    let entries = module
        .k
        .entries()
        .filter_map(|(i, j, v)| Some((place(i)?, place(j)?, v)));
    let k = SymmetricMatrix::from_entries(free.len(), &entries.collect::<Vec<_>>()).expect("a matrix");
    let at_tip: Vec<usize> = nodes()
        .filter(|(_, of)| tip(*of))
        .filter_map(|(node, _)| place(node * DOFS_PER_NODE + Z))
        .collect();
    let share = 1.0 / at_tip.len() as f64;
    let mut u = vec![0.0; free.len()];
    at_tip.iter().for_each(|&dof| u[dof] = share);
    Factor::new("a cantilever", &k).expect("a factor").solve(&mut u);
    let found: f64 = at_tip.iter().map(|&dof| share * u[dof]).sum();
    let miss = |stiffer: f64| (found / cantilever_m(stiffer) - 1.0).abs();
    held("tapered cantilever", 1e-2, miss(1.0), miss(1.05));
}

/// A kind's mirror image mirrored is the kind, and its heights are those of its ends exchanged.
#[test]
fn an_outline_mirrored_twice_is_itself() {
    let outline = Outline {
        length_m: 8.0,
        bottom_m: [0.0, 0.25],
        deck_m: [1.0, 0.75],
    };
    let image = outline.mirrored();
    assert_eq!((image.bottom_m, image.deck_m), ([0.0, -0.25], [0.5, 0.75]));
    assert_eq!(image.mirrored(), outline);
    assert_eq!((image.depths_m(), outline.depths_m()), ([0.5, 1.0], [1.0, 0.5]));
}
