//! The super-element and the water, against the full module and by hand.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::{BridgeDesign, DraftBuoyancy, Model, Todd};
use pontoon_core::connector::Connection;
use pontoon_core::fem::{Factor, MassKind, SymmetricMatrix, assemble};
use pontoon_core::module::{ModuleMesh, mesh_module};
use pontoon_core::superelement::SuperElement;
use pontoon_core::vehicle::Inertia;
use pontoon_core::water::{WaterDistribution, spread};
use pontoon_tests::*;
use std::f64::consts::PI;

/// Structure and water of one module, as the bridge puts them together.
fn module_matrices(design: &BridgeDesign) -> (ModuleMesh, SymmetricMatrix, SymmetricMatrix) {
    let meshed = mesh_module(&design.module, &[], &design.hinges.y_m);
    let (k, m) = assemble(&meshed.mesh, MassKind::Consistent).expect("matrices");
    let water = |per_area: f64| -> SymmetricMatrix {
        let entries: Vec<_> = spread(&meshed.grid, design.wet_m(), per_area, design.water_distribution)
            .iter()
            .map(|(a, b, v)| (a.dof(2), b.dof(2), *v))
            .collect();
        SymmetricMatrix::from_entries(meshed.mesh.dofs(), &entries).expect("a matrix")
    };
    let k = SymmetricMatrix::combine(&[(1.0, &k), (1.0, &water(design.p_b()))]).expect("a matrix");
    let m = SymmetricMatrix::combine(&[(1.0, &m), (1.0, &water(design.m_a() / design.module.breadth_m))]);
    (meshed, k, m.expect("a matrix"))
}

/// z of the deck, and what keeps the module from drifting: the hinge nodes of the left end in all directions.
fn masters(design: &BridgeDesign, meshed: &ModuleMesh) -> Vec<usize> {
    let (nx, ny) = (meshed.grid.x.len(), meshed.grid.y.len());
    let mut masters: Vec<usize> = (0..nx)
        .flat_map(|ix| (0..ny).map(move |iy| (ix, iy)))
        .map(|(ix, iy)| meshed.grid.deck(ix, iy).dof(2))
        .collect();
    for iy in design.hinges.y_m.iter().filter_map(|&y| meshed.grid.y_line(y)) {
        masters.extend([0, 1, 2].map(|d| meshed.grid.bottom(0, iy).dof(d)));
    }
    masters.sort_unstable();
    masters
}

/// The part of a matrix among the places that `keep` names.
fn part(a: &SymmetricMatrix, keep: &[usize]) -> SymmetricMatrix {
    let place = |i: usize| keep.binary_search(&i).ok();
    let entries: Vec<_> = a
        .entries()
        .filter_map(|(i, j, v)| place(i).zip(place(j)).map(|(i, j)| (i, j, v)))
        .collect();
    SymmetricMatrix::from_entries(keep.len(), &entries).expect("a matrix")
}

/// 1e-8: rounding of the condensation's solves on a stiffness of condition 1e7. Twin: E.
#[test]
fn guyan_is_exact_for_loads_on_masters() {
    let deck_z = |design: &BridgeDesign, full: bool| -> Vec<f64> {
        let (meshed, k, m) = module_matrices(design);
        let masters = masters(design, &meshed);
        // hinge nodes of the left end, held along and across: the water holds the rest
        let held: Vec<usize> = [-1.125, 0.0, 1.125]
            .iter()
            .filter_map(|&y| meshed.grid.y_line(y))
            .flat_map(|iy| [0, 1].map(|d| meshed.grid.bottom(0, iy).dof(d)))
            .collect();
        let (dofs, k) = if full {
            ((0..k.order()).collect(), k)
        } else {
            let condensed = SuperElement::condense(&k, &m, &masters, 0).expect("condensed");
            (masters.clone(), condensed.k)
        };
        let kept: Vec<usize> = (0..dofs.len()).filter(|&i| !held.contains(&dofs[i])).collect();
        // a load on all masters, unlike from one to the next
        let load = |dof: &usize| masters.binary_search(dof).map_or(0.0, |p| 1e4 * (1.0 + (p % 7) as f64));
        let mut u: Vec<f64> = kept.iter().map(|&i| load(&dofs[i])).collect();
        Factor::new("test", &part(&k, &kept))
            .expect("positive definite")
            .solve(&mut u);
        let master = |i: &usize| masters.binary_search(&dofs[kept[*i]]).is_ok();
        (0..u.len()).filter(master).map(|i| u[i]).collect()
    };
    let plain = design("smoke");
    let full = deck_z(&plain, true);
    let [right, wrong] = [1.0, 1.05].map(|e| apart(&deck_z(&with_e(&plain, e), false), &full));
    held("Guyan", 1e-8, right, wrong);
}

/// 1e-8: wheels, connectors, hinges and supports all act on masters, so that every condensation is statically exact on the
/// whole bridge, contact included; measured at 1e-12. Twin: E.
#[test]
fn condensed_bridge_is_statically_exact() {
    let vehicle = footprint(&[1.0, 3.0], Inertia::Local);
    for connection in [Connection::Linear, gaps(0.001, 0.0005)] {
        let answer = |design: &BridgeDesign, model: Model| {
            let ready = Ready::new(design, model);
            let case = ready.case(connection, PAPER_LOAD_N, 8.0);
            let r = ready.statics(&vehicle).solve(&case).expect("solved");
            // m and MN: of like size
            let forces = r.joints.iter().flat_map(|j| &j.connectors).map(|c| 1e-6 * c.1);
            r.deflection_m.iter().copied().chain(forces).collect::<Vec<f64>>()
        };
        let full = answer(&design("smoke"), Model::Full);
        for (modes, bottom) in [(0, true), (16, false)] {
            let [right, wrong] = [1.0, 1.05].map(|e| {
                let design = condensed(&with_e(&design("smoke"), e), modes, bottom);
                apart(&answer(&design, Model::SuperElement), &full)
            });
            held(&format!("{modes} modes, bottom {bottom}"), 1e-8, right, wrong);
        }
    }
}

/// Each step of Craig and Bampton's contains the one before: no frequency may rise (but for the eigensolver's 1e-8), and
/// none may fall below the full model's. With 64 modes they meet within 1e-5, a hundredth of what 16 leave. Twins: E.
#[test]
fn frequencies_fall_to_the_full_models_as_modes_are_added() {
    let hz = |design: &BridgeDesign, model: Model| -> Vec<f64> {
        let modes = Ready::new(design, model).modes(14);
        modes.iter().map(|m| m.frequency_hz).filter(|f| *f > 0.0).collect()
    };
    let full = hz(&design("smoke"), Model::Full);
    assert_eq!(full.len(), 11, "all but surge, sway and yaw");
    let with_modes = |e: f64, modes: usize| {
        hz(
            &condensed(&with_e(&design("smoke"), e), modes, false),
            Model::SuperElement,
        )
    };
    let rise = |to: &[f64], from: &[f64]| largest(to.iter().zip(from).map(|(to, from)| to / from - 1.0));
    let soft = with_modes(0.95, 64);
    let mut before = with_modes(1.0, 0);
    for modes in [2, 4, 8, 16, 32, 64] {
        let now = with_modes(1.0, modes);
        held(
            &format!("fall to {modes} modes"),
            1e-8,
            rise(&now, &before),
            rise(&with_modes(1.05, modes), &before),
        );
        held(
            &format!("bound by {modes} modes"),
            1e-8,
            rise(&full, &now),
            rise(&full, &soft),
        );
        before = now;
    }
    held("64 modes", 1e-5, apart(&before, &full), apart(&soft, &full));
}

/// 1e-9: rounding of two triple products, measured at 2e-14. Twin: Rayleigh's a.
#[test]
fn damping_condenses_with_its_parts() {
    let design = design("smoke");
    let (meshed, k, m) = module_matrices(&design);
    let masters = masters(&design, &meshed);
    let (a, b) = (0.04, 0.12);
    let c = SymmetricMatrix::combine(&[(a, &k), (b, &m)]).expect("a matrix");
    // the condensation of what stands in the mass's place is T^T c T
    let of = |second: &SymmetricMatrix| SuperElement::condense(&k, second, &masters, 0).expect("condensed");
    let (parts, whole) = (of(&m), of(&c).m);
    let dense = |x: &SymmetricMatrix| -> Vec<f64> {
        let mut d = vec![0.0; x.order() * x.order()];
        x.entries().for_each(|(i, j, v)| d[i * x.order() + j] = v);
        d
    };
    let sum = |a: f64| dense(&SymmetricMatrix::combine(&[(a, &parts.k), (b, &parts.m)]).expect("a matrix"));
    held(
        "damping",
        1e-9,
        apart(&sum(a), &dense(&whole)),
        apart(&sum(1.05 * a), &dense(&whole)),
    );
}

/// Heave of a module whose water and mass are spread alike is a rigid motion: `sqrt(p_b B / m) / 2 pi` with the mass of
/// structure and water per metre. 1e-6: the bottom's ratio of water stiffness to mass is not quite the whole module's, and
/// the plates give by 5e-8. Twin: p_b.
#[test]
fn heave_by_hand_for_both_distributions_of_the_water() {
    for distribution in [WaterDistribution::Lumped, WaterDistribution::Consistent] {
        let plain = with(&design("smoke"), |d| {
            d.modules = 1;
            d.water_distribution = distribution;
        });
        let miss_by = |p_b: f64| {
            let ready = Ready::new(&with_p_b(&plain, p_b), Model::Full);
            let mass_kg_m = ready.module.structural_mass_kg() / plain.module.length_m + plain.m_a();
            let hand = (plain.p_b() * plain.module.breadth_m / mass_kg_m).sqrt() / (2.0 * PI);
            miss(frequency_hz(&ready.modes(8), "heave"), hand)
        };
        held(&format!("heave, {distribution:?}"), 1e-6, miss_by(1.0), miss_by(1.05));
    }
}

/// Both distributions hold the same water: its sum is p_b times the bottom, its first moments those of a rectangle. 1e-12:
/// sums of some hundred numbers. Twin: p_b.
#[test]
fn both_distributions_hold_the_same_water() {
    let d = design("smoke");
    let meshed = mesh_module(&d.module, &[], &d.hinges.y_m);
    let (l, b) = (d.module.length_m, d.module.breadth_m);
    let total = d.p_b() * l * b;
    for distribution in [WaterDistribution::Lumped, WaterDistribution::Consistent] {
        let resultants = |p_b: f64| {
            let mut sum = [0.0; 3];
            for (a, c, v) in spread(&meshed.grid, d.wet_m(), p_b, distribution) {
                let (row, place) = (meshed.mesh.nodes[a.dof(0) / 6], meshed.mesh.nodes[c.dof(0) / 6]);
                assert_eq!(row.z + place.z, 0.0, "the bottom");
                sum = [sum[0] + v, sum[1] + v * place.x, sum[2] + v * place.y];
            }
            sum
        };
        let by_hand = [total, 0.5 * l * total, 0.0];
        let [right, wrong] = [1.0, 1.05].map(|f| apart(&resultants(f * d.p_b()), &by_hand));
        held(&format!("water, {distribution:?}"), 1e-12, right, wrong);
    }
}

/// 1e-9: the eigensolver on equal matrices. Twin: the density of the water in Todd's formula.
#[test]
fn formulas_give_the_values_they_evaluate_to() {
    let plain = design("smoke");
    let by_formula = |scale: f64| {
        with(&plain, |d| {
            // C J such that 1/2 pi rho C J (B/2)^2 is the bridge's m_a
            let half = 0.5 * d.module.breadth_m;
            let cj = d.m_a() / (0.5 * PI * 1000.0 * half * half);
            d.todd = Some(Todd {
                water_density_kg_m3: 1000.0 * scale,
                section_coefficient: cj / 0.8,
                three_dimensional_correction: 0.8,
            });
            d.added_mass_kg_m = None;
            let slope = d.p_b() * d.module.length_m * d.module.breadth_m;
            d.draft_buoyancy = Some(DraftBuoyancy {
                draft_m: vec![0.0, 0.1, 0.3],
                buoyancy_n: vec![0.0, 0.05 * slope, 0.05 * slope + 0.2 * slope],
                still_water_draft_m: 0.2,
            });
            d.hydrostatic_stiffness_pa_m = None;
        })
    };
    let hz = |d: &BridgeDesign| -> Vec<f64> {
        Ready::new(d, Model::SuperElement)
            .modes(12)
            .iter()
            .map(|m| m.frequency_hz)
            .collect()
    };
    held(
        "formulas",
        1e-9,
        apart(&hz(&by_formula(1.0)), &hz(&plain)),
        apart(&hz(&by_formula(1.05)), &hz(&plain)),
    );
}

/// The mass by areas and lengths is that of the mass matrix. 1e-12: rounding. Twin: the density.
#[test]
fn mass_by_areas_and_lengths_is_that_of_a_unit_heave() {
    for name in ["smoke", "fu2005"] {
        let mass_kg = |factor: f64| {
            let heavy = with(&design(name), |d| d.module.material.density_kg_m3 *= factor);
            Ready::new(&heavy, Model::Full).module.structural_mass_kg()
        };
        let by_areas = design(name).structural_mass_kg();
        held(name, 1e-12, miss(by_areas, mass_kg(1.0)), miss(by_areas, mass_kg(1.05)));
    }
}
