//! Crossings in water with memory against the frequency domain, against a constant added mass, and by both solvers.

#![allow(clippy::expect_used)]

use super::{Crossing, CrossingSettings, CrossingSolver, OperatorSolver};
use crate::analysis::modes::Rayleigh;
use crate::bridge::{Bridge, BridgeDesign, Ends, Heading, Load, Model, PreparedModule, Track, WaterSpec};
use crate::connector::Connection;
use crate::fem::{SparseRow, SymmetricMatrix};
use crate::operator::BridgeOperator;
use crate::radiation::{Band, Kernel, Radiation, RadiationTable, Scales, Window, chain_water};
use crate::response::{CrossingResponse, Record};
use crate::traffic::Traffic;
use crate::vehicle::{Inertia, Vehicle, VehicleDesign};
use crate::water::WaterDistribution;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::PI;
use std::sync::Arc;

const LOAD_N: f64 = 230_300.0;
const STRUCTURE: fn() -> Rayleigh = || Rayleigh::of_structure(0.02, 1.0);

fn smoke() -> BridgeDesign {
    serde_json::from_str(include_str!("../../../../../studies/bridges/smoke.json")).expect("a design")
}

fn in_water(radiation: Radiation) -> BridgeDesign {
    let mut design = smoke();
    design.added_mass_kg_m = None;
    design.water = Some(WaterSpec {
        radiation: Some(Arc::new(radiation)),
        ..WaterSpec::default()
    });
    design
}

fn chain(factor: f64) -> BridgeDesign {
    let of = smoke();
    in_water(chain_water(of.modules, of.module.length_m, of.module.breadth_m, factor))
}

fn bridge(design: &BridgeDesign) -> Arc<Bridge> {
    let module = PreparedModule::new(design, Model::SuperElement).expect("a module");
    Arc::new(Bridge::new(design, &module, Ends::Supported).expect("a bridge"))
}

fn settings(rayleigh: Rayleigh, time_step_s: f64, spectral_radius: f64) -> CrossingSettings {
    CrossingSettings {
        time_step_s,
        spectral_radius,
        rayleigh,
        newton_limit: 60,
        bisection_limit: 4,
    }
}

fn crossing(connection: Connection) -> Crossing {
    Crossing {
        connection,
        connector_stiffness_n_m: smoke().connectors.stiffness_n_m,
        own_laws: [].into(),
        tail_s: 4.0,
        record: Record {
            positions: vec![2, 3],
            joints: vec![2],
            ..Record::default()
        },
        dead: None,
    }
}

fn vehicle(track_y_m: &[f64], inertia: Inertia) -> Vehicle {
    let design = VehicleDesign {
        track_y_m: Some(track_y_m.to_vec()),
        inertia,
        ..VehicleDesign::default()
    };
    design.check(8.082).expect("a vehicle")
}

fn by_convolution(
    bridge: &Arc<Bridge>,
    settings: &CrossingSettings,
    of: (&Vehicle, f64),
    crossing: &Crossing,
) -> CrossingResponse {
    let solver = CrossingSolver::new(bridge, settings).expect("a solver");
    solver
        .solve(&Traffic::single(of.0, LOAD_N, of.1), crossing)
        .expect("solved")
}

fn by_states(
    bridge: &Arc<Bridge>,
    settings: &CrossingSettings,
    of: (&Vehicle, f64),
    crossing: &Crossing,
) -> CrossingResponse {
    let operator = Arc::new(BridgeOperator::new(bridge, 0.0).expect("an operator"));
    let solver = OperatorSolver::new(bridge, &operator, settings);
    solver
        .solve(&Traffic::single(of.0, LOAD_N, of.1), crossing)
        .expect("solved")
}

/// Largest difference of histories over the largest value of the second.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    off.fold(0.0, f64::max) / largest
}

/// Deflection of position 2 at the given times by the frequency domain: `(K + i w C - w^2 M + i w G^T K(i w) G) u = f`, the load as
/// the solver places it, repeated after `period_s`.
fn by_frequencies(bridge: &Bridge, rayleigh: Rayleigh, vehicle: &Vehicle, times_s: &[f64], period_s: f64) -> Vec<f64> {
    let waves = bridge.waves.as_ref().expect("waves");
    let (track, n) = (Track::new(bridge), bridge.dofs());
    let traffic = Traffic::single(vehicle, LOAD_N, 8.0);
    let (driven, h) = (&traffic.vehicles[0], times_s[1] - times_s[0]);
    let forces = |time_s: f64| -> Vec<(usize, f64)> {
        let mut load = Load::default();
        load.add(
            &track,
            &driven.vehicle,
            driven.load_n,
            Heading::of(&track, &driven.drive, time_s),
            false,
        );
        load.weight
            .0
            .iter()
            .map(|&(column, weight)| (track.dof(column), -weight))
            .collect()
    };
    let dense = |a: &SymmetricMatrix| {
        let mut matrix = DMatrix::<f64>::zeros(n, n);
        a.entries().for_each(|(i, j, v)| matrix[(i, j)] += v);
        matrix
    };
    let k_water = dense(&bridge.times_k_water.of_modules().expect("a matrix"));
    let (k, m) = (dense(&bridge.k), dense(&bridge.m));
    let damping = &k * rayleigh.a - &k_water * rayleigh.beyond_water() + &m * rayleigh.b;
    // the linear connection, which has no damping: both trusses at work
    let mut k = k;
    for link in &bridge.links {
        for &(i, a) in &link.row.0 {
            for &(j, b) in &link.row.0 {
                k[(i, j)] += 2.0 * smoke().connectors.stiffness_n_m * a * b;
            }
        }
    }
    let g = {
        let mut g = DMatrix::<f64>::zeros(waves.motions.len(), n);
        for (freedom, row) in waves.motions.iter().enumerate() {
            row.0.iter().for_each(|&(i, value)| g[(freedom, i)] += value);
        }
        g
    };
    let row: &SparseRow = &bridge.positions[1];
    let placed: Vec<(f64, Vec<(usize, f64)>)> = times_s.iter().map(|&t| (t, forces(t))).collect();
    let mut sum = vec![0.0; times_s.len()];
    let step_rad_s = 2.0 * PI / period_s;
    for index in 0..=(60.0 / step_rad_s) as usize {
        let omega = step_rad_s * index as f64;
        let mut load = DVector::<Complex<f64>>::zeros(n);
        for (t, forces) in &placed {
            let turn = Complex::new(0.0, -omega * t).exp() * h;
            forces.iter().for_each(|&(dof, force)| load[dof] += turn * force);
        }
        let memory = waves.radiation.kernel().transfer(omega, Window::CONVOLUTION);
        let on_dofs = |part: &dyn Fn(&Complex<f64>) -> f64| g.transpose() * memory.map(|x| part(&x)) * &g;
        let (re, im) = (on_dofs(&|x| x.re), on_dofs(&|x| x.im));
        let real = &k - &m * (omega * omega) - im * omega;
        let imaginary = (&damping + re) * omega;
        let matrix = DMatrix::from_fn(n, n, |i, j| Complex::new(real[(i, j)], imaginary[(i, j)]));
        let u = matrix.lu().solve(&load).expect("a solution");
        let seen: Complex<f64> = row.0.iter().map(|&(i, a)| u[i] * a).sum();
        let twice = if index == 0 { 1.0 } else { 2.0 };
        for (sum, t) in sum.iter_mut().zip(times_s) {
            *sum -= twice / period_s * (seen * Complex::new(0.0, omega * t).exp()).re;
        }
    }
    sum
}

/// Linear connection, weight alone, steps of 5 ms: within 0.1 % of the largest deflection, of which the step has 0.04 %. Twins: damping of the
/// water 5 % weaker, which a kernel 5 % weaker is; an added mass 5 % less.
#[test]
fn the_convolution_is_the_frequency_domain() {
    let wheels = vehicle(&[-1.4, 1.4], Inertia::None);
    let right = bridge(&chain(1.0));
    let settings = settings(STRUCTURE(), 0.005, 1.0);
    let linear = crossing(Connection::Linear);
    let expected = {
        let response = by_convolution(&right, &settings, (&wheels, 8.0), &linear);
        let times = &response.recorded.history_time_s;
        by_frequencies(&right, STRUCTURE(), &wheels, times, 40.0)
    };
    let miss = |bridge: &Arc<Bridge>| {
        let response = by_convolution(bridge, &settings, (&wheels, 8.0), &linear);
        apart(&response.recorded.histories[0].values, &expected)
    };
    let [found, weaker] = [1.0, 0.95].map(|factor| miss(&bridge(&chain(factor))));
    assert!(found < 1e-3 && weaker > 1e-3, "{found:e} {weaker:e}");
}

/// A water without damping whose added mass is that of a strip is the constant added mass, shared consistently: what plates bend
/// between the wall lines is 4e-4. Twin: 5 % less added mass.
#[test]
fn water_without_damping_is_an_added_mass() {
    let of = smoke();
    let (l, b, m) = (
        of.module.length_m,
        of.module.breadth_m,
        of.added_mass_kg_m.expect("a mass"),
    );
    let strip = |factor: f64| {
        let own = factor * m * l;
        let mass = DMatrix::from_fn(9, 9, |i, j| match (i == j, i % 3) {
            (false, _) => 0.0,
            (true, 0) => own,
            (true, 1) => own * l * l / 12.0,
            (true, _) => own * b * b / 12.0,
        });
        let scales = Scales::new(&[l; 3], b).expect("scales");
        let omega: Vec<f64> = (0..=25).map(|i| 0.2 * f64::from(i)).collect();
        let zero = vec![DMatrix::zeros(9, 9); omega.len()];
        let table = RadiationTable::new(3, omega, vec![mass; 26], zero, None).expect("a table");
        let kernel = Kernel::new(&table, &scales, Band::default()).expect("a kernel");
        in_water(Radiation::new(kernel, &table, scales, "strip".to_owned()).expect("a water"))
    };
    let mut constant = of;
    constant.water_distribution = WaterDistribution::Consistent;
    let wheels = vehicle(&[-0.4, 2.4], Inertia::Local);
    let settings = settings(Rayleigh::new(0.02, 0.1), 0.01, 0.9);
    let linear = crossing(Connection::Linear);
    let expected = by_convolution(&bridge(&constant), &settings, (&wheels, 8.0), &linear);
    let miss = |design: &BridgeDesign| {
        let mut design = design.clone();
        design.water_distribution = WaterDistribution::Consistent;
        let found = by_convolution(&bridge(&design), &settings, (&wheels, 8.0), &linear);
        assert_eq!(found.energy.radiated_j, 0.0);
        let roll = (found.peak_roll.value / expected.peak_roll.value - 1.0).abs();
        apart(
            &found.recorded.histories[0].values,
            &expected.recorded.histories[0].values,
        )
        .max(roll)
    };
    let (right, wrong) = (miss(&strip(1.0)), miss(&strip(0.95)));
    assert!(right < 1e-3 && wrong > 1e-3, "{right:e} {wrong:e}");
}

const GAPS: Connection = Connection::Nonlinear {
    gap_tension_m: 0.004,
    gap_compression_m: 0.001,
};

/// The operator with every mode, its states beside the convolution: histories within 0.05 % with a linear connection, peaks of
/// deflections and forces within 0.1 % with gaps, roll within 0.1 %; energies close to rounding and waves never give more
/// than they took. Twin: damping of the water 5 % weaker.
#[test]
fn states_repeat_the_convolution() {
    let [right, weaker] = [1.0, 0.95].map(|factor| bridge(&chain(factor)));
    let settings = settings(STRUCTURE(), 0.01, 0.9);
    for (what, tracks, inertia, connection) in [
        ("weight", [-1.4, 1.4], Inertia::None, Connection::Linear),
        ("off the centre", [0.3, 3.1], Inertia::None, Connection::Linear),
        ("masses, gaps", [-1.4, 1.4], Inertia::Local, GAPS),
        ("masses off the centre, gaps", [0.3, 3.1], Inertia::Convective, GAPS),
    ] {
        let (wheels, asked) = (vehicle(&tracks, inertia), crossing(connection));
        let expected = by_convolution(&right, &settings, (&wheels, 8.0), &asked);
        let miss = |bridge: &Arc<Bridge>| {
            let found = by_states(bridge, &settings, (&wheels, 8.0), &asked);
            assert!(found.energy.energy_residual < 1e-11, "{what}: {:?}", found.energy);
            assert!(
                found.energy.radiated_j > 0.0 && found.energy.least_radiated_j > -1e-6,
                "{what}: {:?}",
                found.energy
            );
            let share = |found: f64, expected: f64| (found / expected - 1.0).abs();
            let history = apart(
                &found.recorded.histories[0].values,
                &expected.recorded.histories[0].values,
            );
            let peaks = found.positions.iter().zip(&expected.positions).skip(1).take(2);
            let peaks = peaks
                .map(|(a, b)| share(a.deflection.value, b.deflection.value))
                .fold(0.0, f64::max);
            let force = share(
                found.joints[0].sum.compression.value,
                expected.joints[0].sum.compression.value,
            );
            let roll = match tracks[0] < 0.0 {
                true => 0.0,
                false => share(found.peak_roll.value, expected.peak_roll.value),
            };
            match connection {
                Connection::Linear => (history / 5e-4).max(roll / 1e-3),
                _ => peaks.max(force).max(roll) / 1e-3,
            }
        };
        let found = miss(&right);
        assert!(found <= 1.0, "{what}: {found} of what is allowed");
        if connection == Connection::Linear {
            assert!(miss(&weaker) > 1.0, "{what}: a weaker water passes");
        }
    }
}

/// A lane and its mirror image are mirror images, and a vehicle on the centre line wakes no roll. 1e-9 of the largest: rounding of
/// modes that are not quite symmetric.
#[test]
fn mirrored_lanes_are_mirrored() {
    let right = bridge(&chain(1.0));
    let settings = settings(STRUCTURE(), 0.01, 0.9);
    let solve = |tracks: [f64; 2]| {
        by_states(
            &right,
            &settings,
            (&vehicle(&tracks, Inertia::Local), 8.0),
            &crossing(Connection::Linear),
        )
    };
    let [one, other, further] = [[0.3, 3.1], [-3.1, -0.3], [0.6, 3.4]].map(solve);
    let share = |a: &CrossingResponse, b: &CrossingResponse| {
        let peaks = a
            .positions
            .iter()
            .zip(&b.positions)
            .map(|(a, b)| (a.deflection.value - b.deflection.value).abs());
        let largest = b.positions.iter().map(|p| p.deflection.value).fold(0.0, f64::max);
        let roll = (a.peak_roll.value / b.peak_roll.value - 1.0).abs();
        (peaks.fold(0.0, f64::max) / largest)
            .max(roll)
            .max((a.energy.radiated_j / b.energy.radiated_j - 1.0).abs())
    };
    assert!(share(&one, &other) < 1e-9, "{:e}", share(&one, &other));
    assert!(share(&further, &one) > 1e-3, "another lane passes");
}

/// Crossings side by side, more than there are lanes, on the centre line and off it in turn, leave what each leaves alone, to the bit:
/// rolls wake lane by lane, and nothing of a lane's last crossing is left.
#[test]
fn lanes_in_waves_are_as_if_alone() {
    let right = bridge(&chain(1.0));
    let operator = Arc::new(BridgeOperator::new(&right, 0.0).expect("an operator"));
    let solver = OperatorSolver::new(&right, &operator, &settings(STRUCTURE(), 0.01, 0.9));
    let crossing = crossing(GAPS);
    // the first ones leave all lanes at once
    let speed_m_s = |i: u32| if i < 16 { 10.0 } else { 20.0 - 0.4 * f64::from(i) };
    let traffic = |i: u32| {
        let on_centre = i > 16 && i.is_multiple_of(3);
        let tracks = if on_centre { [-1.4, 1.4] } else { [0.3, 3.1] };
        Traffic::single(&vehicle(&tracks, Inertia::Local), LOAD_N, speed_m_s(i))
    };
    let traffics: Vec<Traffic> = (0..28).map(traffic).collect();
    let asked: Vec<(&Traffic, &Crossing)> = traffics.iter().map(|traffic| (traffic, &crossing)).collect();
    let beside: Vec<CrossingResponse> = solver
        .solve_all(&asked, 0)
        .into_iter()
        .map(|r| r.expect("solved"))
        .collect();
    for (traffic, beside) in traffics.iter().zip(&beside) {
        let alone = OperatorSolver::new(&right, &operator, &settings(STRUCTURE(), 0.01, 0.9));
        assert_eq!(&alone.solve(traffic, &crossing).expect("solved"), beside);
    }
}
