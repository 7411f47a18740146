//! Kernel, states and a time integration against a public barge in regular waves.
//!
//! Knows the barge's added mass, damping and forces. Does not know bridges.

use super::exponentials::Exponentials;
use super::{Band, Filter, Kernel, RadiationTable, Scales, StepCoefficients, Window, added_mass_infinite};
use super::{hankel, passive};
use crate::scheme::Scheme;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::PI;

const DENSITY_KG_M3: f64 = 1000.0;
const GRAVITY_M_S2: f64 = 9.81;

/// The freedoms of the file in their order here: two modules of three.
const FREEDOMS: [usize; 6] = [3, 5, 7, 8, 9, 10];

/// The pairs of a row "water", by their places in [`FREEDOMS`].
const PAIRS: [[usize; 2]; 12] = [
    [0, 0],
    [0, 2],
    [2, 2],
    [0, 4],
    [2, 4],
    [4, 4],
    [1, 1],
    [1, 3],
    [3, 3],
    [1, 5],
    [3, 5],
    [5, 5],
];

/// Amplitudes of heave and mode 7 of the file barge.4 `[m]`, over all ten freedoms, at 7.95 s. At 3.30 s it has 0.001167 and
/// 0.029652, where six freedoms have 1.3 and 0.8 % less.
const OF_FILE_7_95_S: [f64; 2] = [0.265_769, 0.187_392];

/// Steps a period.
const STEPS: usize = 200;

/// Periods over which an amplitude is taken, the last ones.
const TAKEN: usize = 10;

/// Time over which waves rise `[s]`.
const RISE_S: f64 = 300.0;

/// The barge in [scaled](Scales) freedoms, its table apart: all are about its rms height in a freedom `[m]`.
struct Barge {
    table: RadiationTable,
    scales: Scales,
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// Periods `[s]` and the forces of a wave of 1 m.
    waves: Vec<(f64, DVector<Complex<f64>>)>,
}

impl Barge {
    /// With damping times `factor`.
    fn read(factor: f64) -> Self {
        // a barge of 80 m for the pitch; what has the scale 1 stays as it is
        let one = 12_f64.sqrt();
        let scales = Scales::new(&[80.0, one], one).unwrap();
        let rms = scales.rms_m().to_vec();
        let place = |number: f64| FREEDOMS.iter().position(|&f| f as f64 == number).unwrap();
        let symmetric = |entries: &[f64], factor: f64| {
            let mut matrix = DMatrix::zeros(6, 6);
            for (&[i, j], &entry) in PAIRS.iter().zip(entries) {
                matrix[(i, j)] = entry * factor;
                matrix[(j, i)] = entry * factor;
            }
            matrix
        };
        let (mut water, mut infinite, mut waves) = (Vec::new(), None, Vec::new());
        let (mut mass, mut stiffness) = (DMatrix::zeros(6, 6), DMatrix::zeros(6, 6));
        for line in include_str!("barge.txt").lines().filter(|line| !line.starts_with('#')) {
            let (what, numbers) = line.split_once(' ').unwrap();
            let numbers: Vec<f64> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
            match (what, numbers.as_slice()) {
                ("water", [period, entries @ ..]) if *period == 0.0 => {
                    infinite = Some(symmetric(entries, DENSITY_KG_M3))
                }
                ("water", [period, entries @ ..]) => {
                    let omega = 2.0 * PI / period;
                    let (a, b) = entries.split_at(PAIRS.len());
                    water.push((
                        omega,
                        symmetric(a, DENSITY_KG_M3),
                        symmetric(b, factor * DENSITY_KG_M3 * omega),
                    ));
                }
                ("wave", [period, parts @ ..]) => {
                    let force = |i: usize| Complex::new(parts[2 * i], parts[2 * i + 1]);
                    let scaled = |i: usize, _| force(i) * (DENSITY_KG_M3 * GRAVITY_M_S2 / rms[i]);
                    waves.push((*period, DVector::from_fn(6, scaled)));
                }
                ("stiffness", &[i, j, k]) => stiffness[(place(i), place(j))] += DENSITY_KG_M3 * GRAVITY_M_S2 * k,
                ("body", &[i, m, k]) => {
                    mass[(place(i), place(i))] = m;
                    stiffness[(place(i), place(i))] += k;
                }
                _ => panic!("{line}"),
            }
        }
        water.sort_by(|a, b| a.0.total_cmp(&b.0));
        let omega = water.iter().map(|row| row.0).collect();
        let a = water.iter().map(|row| row.1.clone()).collect();
        let b = water.iter().map(|row| row.2.clone()).collect();
        Self {
            table: RadiationTable::new(2, omega, a, b, infinite).unwrap(),
            mass: scales.scaled(&mass),
            stiffness: scales.scaled(&stiffness),
            scales,
            waves,
        }
    }

    /// The amplitudes by A and B of the table.
    fn by_frequency(&self, period_s: f64, force: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
        let omega = 2.0 * PI / period_s;
        let near = |w: &f64| (w / omega - 1.0).abs() < 1e-9;
        let row = self.table.omega_rad_s().iter().position(near).unwrap();
        let a = &self.mass + self.scales.scaled(&self.table.added_mass()[row]);
        let b = self.scales.scaled(&self.table.radiation_damping()[row]);
        let matrix = DMatrix::from_fn(6, 6, |i, j| {
            Complex::new(self.stiffness[(i, j)] - omega * omega * a[(i, j)], omega * b[(i, j)])
        });
        matrix.lu().solve(force).unwrap()
    }

    /// The memory of its water.
    fn kernel(&self) -> Kernel {
        Kernel::new(&self.table, &self.scales, Band::default()).unwrap()
    }

    /// The added mass at infinite frequency by Kramers and Kronig.
    fn infinite(&self) -> DMatrix<f64> {
        let infinite = added_mass_infinite(&self.kernel(), &self.table, &self.scales, Window::TRANSFER);
        self.scales.scaled(&infinite.unwrap())
    }
}

/// The barge in time, with states for the memory of its water.
struct InTime<'a> {
    barge: &'a Barge,
    mass: DMatrix<f64>,
    states: Exponentials,
    filters: Vec<Filter>,
}

/// The states over steps of one length.
struct SteppedStates<'a> {
    steps: Vec<(StepCoefficients, &'a [Complex<f64>])>,
    filters: Vec<(StepCoefficients, &'a DMatrix<f64>)>,
    x: Vec<Complex<f64>>,
    filtered: Vec<DVector<Complex<f64>>>,
}

/// What an integration finds.
struct Steady {
    amplitude: DVector<Complex<f64>>,
    /// Least energy that the water had taken at any time, and what it had taken at the end `[J]`.
    least_j: f64,
    radiated_j: f64,
}

impl<'a> InTime<'a> {
    /// With a memory of `factor` times its water's.
    fn new(barge: &'a Barge, factor: f64) -> Self {
        let (dt_s, window) = (0.2, Window::STATES);
        let samples = barge.kernel().windowed(dt_s, 200, window);
        let samples: Vec<_> = samples.iter().map(|k| barge.scales.scaled(k) * factor).collect();
        let states = hankel::exponentials(&samples, dt_s, 3e-5).unwrap().usable();
        Self {
            barge,
            mass: &barge.mass + barge.infinite(),
            filters: passive::filters(&states),
            states,
        }
    }

    /// From rest in a wave that rises, the velocity in the memory predicted as an operator does.
    fn solved(&self, period_s: f64, wave: &DVector<Complex<f64>>, to_s: f64) -> Steady {
        let (h, omega) = (period_s / STEPS as f64, 2.0 * PI / period_s);
        let s = Scheme::new(h, 1.0);
        let (c_m, _, c_k) = s.effective();
        let inverse = (&self.mass * c_m + &self.barge.stiffness * c_k).try_inverse().unwrap();
        let turned = |t: f64| Complex::new((omega * t).cos(), (omega * t).sin());
        let force = |t: f64| {
            let turn = turned(t) * (0.5 - 0.5 * (PI * (t / RISE_S).min(1.0)).cos());
            wave.map(|f| (f * turn).re)
        };
        let at = |alpha: f64, new: &DVector<f64>, old: &DVector<f64>| new * (1.0 - alpha) + old * alpha;
        let mut memory = self.memory(h);
        let zero = DVector::zeros(6);
        let (mut u, mut v, mut a) = (zero.clone(), zero.clone(), zero.clone());
        let (mut old_force, mut old_water) = (force(0.0), zero);
        let mut steady = Steady {
            amplitude: DVector::zeros(6),
            least_j: 0.0,
            radiated_j: 0.0,
        };
        let count = (to_s / period_s) as usize * STEPS;
        for step in 1..=count {
            let t = step as f64 * h;
            let (new_force, water) = (force(t), memory.ahead(&v, &(&v + &a * h)));
            let (free_v, free_a) = (&v * s.v_v + &a * s.v_a, &v * s.a_v + &a * s.a_a);
            let by_water = at(s.alpha_f, &water, &old_water);
            let right = at(s.alpha_f, &new_force, &old_force) + &by_water
                - &self.mass * at(s.alpha_m, &free_a, &a)
                - &self.barge.stiffness * &u;
            let d = &inverse * right;
            steady.radiated_j -= by_water.dot(&d);
            steady.least_j = steady.least_j.min(steady.radiated_j);
            u += &d;
            v = &d * s.c_v + free_v;
            a = &d * s.c_a + free_a;
            memory.follow(&v);
            (old_force, old_water) = (new_force, water);
            if step + STEPS * TAKEN > count {
                let turn = turned(-t) * (2.0 / (STEPS * TAKEN) as f64);
                steady.amplitude += u.map(|u| turn * u);
            }
        }
        steady
    }

    fn memory(&self, h: f64) -> SteppedStates<'_> {
        let step = |&pole: &Complex<f64>| StepCoefficients::new(pole, h);
        let shapes = self.states.shapes.as_slice().chunks_exact(6);
        let of_filter = |filter: &'_ Filter| step(&filter.pole_1_s);
        SteppedStates {
            steps: self.states.poles_1_s.iter().map(step).zip(shapes).collect(),
            filters: self
                .filters
                .iter()
                .map(|filter| (of_filter(filter), &filter.stiffness_n_m))
                .collect(),
            x: vec![Complex::new(0.0, 0.0); self.states.poles_1_s.len()],
            filtered: vec![DVector::zeros(6); self.filters.len()],
        }
    }
}

impl SteppedStates<'_> {
    /// The force at the step's end by the velocity at its begin and that expected at its end, which the states do not yet take.
    fn ahead(&mut self, v: &DVector<f64>, expected: &DVector<f64>) -> DVector<f64> {
        let mut force = DVector::zeros(6);
        for ((step, shape), x) in self.steps.iter().zip(&mut self.x) {
            *x = step.decay * *x + step.p0_s * along(shape, v);
            let end = *x + step.p1_s * along(shape, expected);
            force.iter_mut().zip(*shape).for_each(|(f, c)| *f -= (c * end).re);
        }
        for ((step, stiffness), x) in self.filters.iter().zip(&mut self.filtered) {
            x.iter_mut()
                .zip(v.iter())
                .for_each(|(x, v)| *x = step.decay * *x + step.p0_s * *v);
            force -= *stiffness * x.zip_map(expected, |x, v| (x + step.p1_s * v).re);
        }
        force
    }

    /// Takes the velocity at the step's end.
    fn follow(&mut self, v: &DVector<f64>) {
        for ((step, shape), x) in self.steps.iter().zip(&mut self.x) {
            *x += step.p1_s * along(shape, v);
        }
        for ((step, _), x) in self.filters.iter().zip(&mut self.filtered) {
            x.iter_mut().zip(v.iter()).for_each(|(x, v)| *x += step.p1_s * *v);
        }
    }
}

/// c^T v.
fn along(shape: &[Complex<f64>], v: &DVector<f64>) -> Complex<f64> {
    shape.iter().zip(v.iter()).map(|(c, v)| c * *v).sum()
}

/// By Kramers and Kronig over 1.4 to 3 rad/s the file's own matrix, to 0.01 % of its largest entry; asked for is 0.05 %.
#[test]
fn its_added_mass_at_infinity_is_that_of_the_file() {
    let error = |factor: f64| {
        let barge = Barge::read(factor);
        let of_file = barge.scales.scaled(barge.table.infinite().unwrap());
        (barge.infinite() - &of_file).amax() / of_file.amax()
    };
    assert!(error(1.0) < 5e-4, "{:e}", error(1.0));
    assert!(error(0.95) > 2e-3, "{:e}", error(0.95));
}

/// The deviation of amplitudes from others: the larger of heave's and mode 7's, each as a share of its own; and the largest of all
/// six with their phases, as a share of the largest.
fn deviations(found: &DVector<Complex<f64>>, from: &DVector<Complex<f64>>) -> [f64; 2] {
    let own = |i: usize| (found[i].norm() / from[i].norm() - 1.0).abs();
    [own(0).max(own(2)), (found - from).camax() / from.camax()]
}

/// Steady amplitudes in time are those by A and B of the file, to 0.3 %, and with a memory 5 % weaker they are off by more.
///
/// At 3.30 s the heave, 1/25 of mode 7 there, is off by 0.42 %. That is the file's: near 3.2 s its A and B jump, and the kernel's
/// own transform gives 0.47 %. At 3.00 s, the resonance of mode 7 with a damping of 0.1 %, a steady state takes long: after 480 s with
/// waves that rise over 60 s mode 7 has 0.104 m, by frequency 0.0800 m; after 3000 s it is within the 0.3 %.
#[test]
fn its_steady_amplitudes_are_those_of_the_frequency_domain() {
    let barge = Barge::read(1.0);
    let [model, weaker] = [1.0, 0.95].map(|factor| InTime::new(&barge, factor));
    for (period_s, wave) in &barge.waves {
        let expected = barge.by_frequency(*period_s, wave);
        let to_s = if *period_s < 3.2 { 3000.0 } else { 900.0 };
        let found = model.solved(*period_s, wave, to_s);
        let twin = weaker.solved(*period_s, wave, to_s);
        let own = if (period_s - 3.3).abs() < 0.01 { 5e-3 } else { 3e-3 };
        let limits = [own, 3e-3];
        let (of_model, of_twin) = (
            deviations(&found.amplitude, &expected),
            deviations(&twin.amplitude, &expected),
        );
        for (i, limit) in limits.into_iter().enumerate() {
            assert!(of_model[i] < limit, "{period_s} s: {of_model:?}");
            assert!(of_twin[i] > limit, "{period_s} s: {of_twin:?}");
        }
        assert!(found.radiated_j > 0.0 && found.least_j >= -1e-9 * found.radiated_j);
        if (period_s - 7.95).abs() < 0.01 {
            let of_file = |steady: &Steady| {
                let [heave, mode_7] = OF_FILE_7_95_S;
                let amplitudes = [(0, heave), (2, mode_7)].map(|(i, own)| steady.amplitude[i].norm() / own - 1.0);
                amplitudes[0].abs().max(amplitudes[1].abs())
            };
            assert!(of_file(&found) < 3e-3, "{}", of_file(&found));
            assert!(of_file(&twin) > 3e-3, "{}", of_file(&twin));
        }
    }
}
