//! The plane chain of `tests/data/chain.json` against a second one, written here from nothing: its own beams, dense matrices,
//! its own time integration and contact.
//!
//! Knows u, w and rotation of the points of a plane. Does not know the core's bridge, which it must meet.

#![allow(clippy::expect_used)]

use nalgebra::{DMatrix, DVector};
use pontoon_core::response::CrossingResponse;
use pontoon_tests::chain::Chain;
use pontoon_tests::*;

/// Peaks of positions and joints: deflection and uplift `[m]`, compression and tension `[N]`.
struct Peaks {
    moves: Vec<[f64; 2]>,
    forces: Vec<[f64; 2]>,
}

/// The second chain. Dofs u, w (up), t (turn, the slope w,x) of each line node, module after module; hinged ends share u
/// and w. Posts are not meshed: a force F at a post's top is the moment F d at its foot, the post itself a spring in
/// series with the truss.
struct Plane {
    chain: Chain,
    m: DMatrix<f64>,
    k: DMatrix<f64>,
    /// Number of a dof of a module's node; none where held.
    map: Vec<Vec<[Option<usize>; 3]>>,
}

impl Plane {
    fn new(chain: &Chain) -> Self {
        let (modules, elements) = (chain.modules, chain.module.elements);
        let mut dofs = 0;
        let mut fresh = || {
            dofs += 1;
            Some(dofs - 1)
        };
        let mut map: Vec<Vec<[Option<usize>; 3]>> = Vec::new();
        for j in 0..modules {
            let mut nodes: Vec<[Option<usize>; 3]> = Vec::new();
            for i in 0..=elements {
                let hinge = map.last().and_then(|before| before.last()).filter(|_| i == 0);
                let node = match hinge {
                    Some(hinge) => [hinge[0], hinge[1], fresh()],
                    None if (j, i) == (0, 0) => [None, None, fresh()],
                    None if (j + 1, i) == (modules, elements) => [fresh(), None, fresh()],
                    None => [fresh(), fresh(), fresh()],
                };
                nodes.push(node);
            }
            map.push(nodes);
        }
        let size = map.iter().flatten().flatten().flatten().max().expect("dofs") + 1;
        let mut plane = Self {
            chain: chain.clone(),
            m: DMatrix::zeros(size, size),
            k: DMatrix::zeros(size, size),
            map,
        };
        let beam = &chain.module;
        let l = beam.length_m / elements as f64;
        let (ea, ei, mass) = (
            beam.axial_stiffness_n / l,
            beam.bending_stiffness_n_m2 / l.powi(3),
            beam.mass_kg_m * l,
        );
        let bend = [
            [12.0, 6.0, -12.0, 6.0],
            [6.0, 4.0, -6.0, 2.0],
            [-12.0, -6.0, 12.0, -6.0],
            [6.0, 2.0, -6.0, 4.0],
        ];
        let weigh = [
            [156.0, 22.0, 54.0, -13.0],
            [22.0, 4.0, 13.0, -3.0],
            [54.0, 13.0, 156.0, -22.0],
            [-13.0, -3.0, -22.0, 4.0],
        ];
        for j in 0..modules {
            for i in 0..elements {
                let [a, b] = [plane.map[j][i], plane.map[j][i + 1]];
                let (bending, axial) = ([a[1], a[2], b[1], b[2]], [a[0], b[0]]);
                for p in 0..4 {
                    for q in 0..4 {
                        let length = l.powi((p % 2 + q % 2) as i32);
                        put(&mut plane.k, bending[p], bending[q], ei * bend[p][q] * length);
                        put(
                            &mut plane.m,
                            bending[p],
                            bending[q],
                            mass / 420.0 * weigh[p][q] * length,
                        );
                    }
                }
                for p in 0..2 {
                    for q in 0..2 {
                        put(&mut plane.k, axial[p], axial[q], if p == q { ea } else { -ea });
                        put(
                            &mut plane.m,
                            axial[p],
                            axial[q],
                            if p == q { mass / 3.0 } else { mass / 6.0 },
                        );
                    }
                    put(
                        &mut plane.k,
                        bending[2 * p],
                        bending[2 * p],
                        0.5 * l * chain.hydrostatic_stiffness_n_m2,
                    );
                    put(
                        &mut plane.m,
                        bending[2 * p],
                        bending[2 * p],
                        0.5 * l * chain.added_mass_kg_m,
                    );
                }
            }
        }
        plane
    }

    /// Elongation of a joint's connector for unit dofs: the tops of the posts move back as their feet turn.
    fn elongations(&self) -> DMatrix<f64> {
        let mut b = DMatrix::zeros(self.chain.modules - 1, self.k.nrows());
        for joint in 0..self.chain.modules - 1 {
            let (left, right) = (
                self.map[joint][self.chain.module.elements][2],
                self.map[joint + 1][0][2],
            );
            for (dof, sign) in [(left, 1.0), (right, -1.0)] {
                b[(joint, dof.expect("ends turn"))] = sign * self.chain.module.depth_m;
            }
        }
        b
    }

    /// Stiffness of a truss with the two posts that it pulls at, of k of the truss.
    fn in_series(&self, k: f64) -> f64 {
        let posts = 2.0 * self.chain.module.depth_m.powi(3) / (3.0 * self.chain.module.posts.0);
        1.0 / (1.0 / k + posts)
    }

    /// Weight on the line nodes: each point shared between the two nodes beside it.
    fn load(&self, centre_x_m: f64) -> DVector<f64> {
        let mut f = DVector::zeros(self.k.nrows());
        let c = &self.chain;
        let elements = c.module.elements;
        let l = c.module.length_m / elements as f64;
        for point in 0..c.points {
            let x = centre_x_m + c.footprint_length_m * ((point as f64 + 0.5) / c.points as f64 - 0.5);
            if x < 0.0 || x > c.modules as f64 * c.module.length_m {
                continue;
            }
            let cell = ((x / l) as usize).min(c.modules * elements - 1);
            let place = x / l - cell as f64;
            for (node, share) in [(cell % elements, 1.0 - place), (cell % elements + 1, place)] {
                if let Some(dof) = self.map[cell / elements][node][1] {
                    f[dof] -= share * c.weight_n / c.points as f64;
                }
            }
        }
        f
    }

    /// A crossing by Newmark's trapezoidal rule with steps `h`; in each step the trusses at work are found by trial: solve,
    /// see which want to work, until none changes.
    fn cross(&self, linear: bool, speed_m_s: f64, h: f64) -> Peaks {
        let c = &self.chain;
        let (joints, damping) = (c.modules - 1, &self.k * c.rayleigh.a + &self.m * c.rayleigh.b);
        let b = self.elongations();
        let truss = self.in_series(if linear { 2.0 } else { 1.0 } * c.joint_stiffness_n_m);
        let effective = &self.m * (4.0 / (h * h)) + &damping * (2.0 / h) + &self.k;
        let inverse = effective.clone().try_inverse().expect("a definite matrix");
        let columns = &inverse * b.transpose();
        let flexibility = &b * &columns;
        let n = self.k.nrows();
        let (mut u, mut v, mut a) = (DVector::zeros(n), DVector::zeros(n), DVector::<f64>::zeros(n));
        let mut working = vec![if linear { 1 } else { 0 }; joints];
        let mut peaks = Peaks {
            moves: vec![[0.0; 2]; c.modules + 1],
            forces: vec![[0.0; 2]; joints],
        };
        let length_m = c.modules as f64 * c.module.length_m;
        let reach = 0.5 * c.footprint_length_m * (1.0 - 1.0 / c.points as f64);
        let start = -((reach / speed_m_s / h).floor() + 1.0) * h;
        let steps = (((length_m + reach) / speed_m_s + c.tail_s - start) / h).ceil() as usize;
        for step in 1..=steps {
            let rest = &self.m * (&u * (4.0 / (h * h)) + &v * (4.0 / h) + &a) + &damping * (&u * (2.0 / h) + &v);
            let free = &inverse * (self.load(speed_m_s * (start + step as f64 * h)) + rest);
            let e_free = &b * &free;
            let mut forces = DVector::zeros(joints);
            for trial in 0.. {
                assert!(trial < 50, "the trusses do not settle");
                let active: Vec<usize> = (0..joints).filter(|&i| working[i] != 0).collect();
                let gap = |i: usize| match (linear, working[i]) {
                    (true, _) => 0.0,
                    (_, sense) if sense > 0 => c.gap_tension_m,
                    _ => -c.gap_compression_m,
                };
                let small = DMatrix::from_fn(active.len(), active.len(), |p, q| {
                    flexibility[(active[p], active[q])] + if p == q { 1.0 / truss } else { 0.0 }
                });
                let asked = DVector::from_fn(active.len(), |p, _| e_free[active[p]] - gap(active[p]));
                let found = if active.is_empty() {
                    asked
                } else {
                    small.lu().solve(&asked).expect("a definite matrix")
                };
                forces.fill(0.0);
                active
                    .iter()
                    .zip(found.iter())
                    .for_each(|(&i, &force)| forces[i] = force);
                // elongation of truss and posts together
                let e = &e_free - &flexibility * &forces;
                let wanted: Vec<i32> = e
                    .iter()
                    .map(|&e| match e {
                        _ if linear => 1,
                        e if e > c.gap_tension_m => 1,
                        e if e < -c.gap_compression_m => -1,
                        _ => 0,
                    })
                    .collect();
                if wanted == working {
                    break;
                }
                working = wanted;
            }
            let new = free - &columns * &forces;
            let new_v = (&new - &u) * (2.0 / h) - &v;
            a = (&new_v - &v) * (2.0 / h) - a;
            (u, v) = (new, new_v);
            for (position, peak) in peaks.moves.iter_mut().enumerate() {
                let node = match position {
                    p if p < c.modules => self.map[p][0],
                    _ => self.map[c.modules - 1][c.module.elements],
                };
                let up = node[1].map_or(0.0, |dof| u[dof]);
                *peak = [peak[0].max(-up), peak[1].max(up)];
            }
            for (peak, force) in peaks.forces.iter_mut().zip(forces.iter()) {
                *peak = [peak[0].max(-force), peak[1].max(*force)];
            }
        }
        peaks
    }
}

fn put(a: &mut DMatrix<f64>, i: Option<usize>, j: Option<usize>, value: f64) {
    if let (Some(i), Some(j)) = (i, j) {
        a[(i, j)] += value;
    }
}

/// Largest difference of the peaks' deflections and of the joints' forces, each over the largest of them.
fn away(core: &CrossingResponse, plane: &Peaks) -> [f64; 2] {
    let sides = |of: &[[f64; 2]]| -> Vec<f64> { of.iter().flatten().copied().collect() };
    let moves: Vec<f64> = core
        .positions
        .iter()
        .flat_map(|p| [p.deflection.value, p.uplift.value])
        .collect();
    let forces: Vec<f64> = core
        .joints
        .iter()
        .flat_map(|j| [j.sum.compression.value, j.sum.tension.value])
        .collect();
    [
        apart(&moves, &sides(&plane.moves)),
        apart(&forces, &sides(&plane.forces)),
    ]
}

/// A coefficient of the chain, changed.
type Change = (&'static str, fn(&mut Chain));

/// Coefficients, each 5 % off.
const CHANGES: [Change; 9] = [
    ("p_b", |c| c.hydrostatic_stiffness_n_m2 *= 1.05),
    ("m_a", |c| c.added_mass_kg_m *= 1.05),
    ("mass", |c| c.module.mass_kg_m *= 1.05),
    ("EI", |c| c.module.bending_stiffness_n_m2 *= 1.05),
    ("depth", |c| c.module.depth_m *= 1.05),
    ("connector", |c| c.joint_stiffness_n_m *= 1.05),
    ("Rayleigh a", |c| c.rayleigh.a *= 1.05),
    ("Rayleigh b", |c| c.rayleigh.b *= 1.05),
    ("footprint", |c| c.footprint_length_m *= 1.05),
];

/// Holds the core's peaks against those of planes, one right and each of the others with a change.
fn compare(chain: &Chain, h: f64, tolerance: f64, changes: &[Change]) {
    let core = &chain.cross(h)[0];
    let planes = on_two_threads(
        &[&[("right", (|_| {}) as fn(&mut Chain))], changes].concat(),
        |change| {
            let mut changed = chain.clone();
            (change.1)(&mut changed);
            let (linear, speed_m_s) = changed.crossings[0];
            away(core, &Plane::new(&changed).cross(linear, speed_m_s, h))
        },
    );
    for ((name, _), wrong) in changes.iter().zip(&planes[1..]) {
        held(&format!("deflections, {name}"), tolerance, planes[0][0], wrong[0]);
        held(&format!("forces, {name}"), tolerance, planes[0][1], wrong[1]);
    }
}

/// Five modules of the chain, linear at 15 m/s: all peaks of positions and joints, over the largest of their kind. The core
/// runs with spectral radius 0.9, the plane with 1: 1e-4 is ten times the square of 2 ms over the 0.3 s of the fastest bending
/// mode that is seen (measured 1e-5, 2e-5). Twins: nine coefficients, each 5 % off.
#[test]
fn linear_chains_agree() {
    let small = Chain {
        modules: 5,
        crossings: vec![(true, 15.0)],
        ..Chain::read()
    };
    compare(&small, 0.002, 1e-4, &CHANGES);
}

/// Five modules of the chain with gaps at 10 m/s. 1e-3: contacts are met within a step, each scheme in its own way (measured
/// 3e-4, 1e-4).
#[test]
fn chains_with_gaps_agree() {
    let small = Chain {
        modules: 5,
        crossings: vec![(false, 10.0)],
        ..Chain::read()
    };
    let gap: Change = ("compression gap", |c| c.gap_compression_m *= 1.05);
    compare(&small, 0.002, 1e-3, &[&CHANGES[..], &[gap]].concat());
}

/// The chain as it is, fifteen modules, with gaps at 15 m/s. Twins: both gaps.
#[test]
fn whole_chains_agree() {
    let whole = Chain {
        crossings: vec![(false, 15.0)],
        ..Chain::read()
    };
    let gaps: [Change; 2] = [
        ("tension gap", |c| c.gap_tension_m *= 1.05),
        ("compression gap", |c| c.gap_compression_m *= 1.05),
    ];
    compare(&whole, 0.002, 1e-3, &gaps);
}
