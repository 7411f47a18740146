//! Constant stress on a distorted patch whose inner nodes are condensed and recovered, and the forces of a beam.
#![allow(clippy::unwrap_used)]

use nalgebra::{Matrix3, Rotation3, Vector3};
use pontoon_core::fem::{Beam, BeamForces, MassKind, Mesh, NodeId, Shell, assemble};
use pontoon_core::superelement::SuperElement;
use pontoon_tests::fem_model::{Grid, Model, general, rectangle, shell};
use pontoon_tests::{held, largest};

const E: f64 = 2e11;
const NU: f64 = 0.3;
const T: f64 = 0.02;

/// Lines of the patch each way.
const N: usize = 4;
const M: usize = 3;

/// Factors on what makes a stress of a strain; `one_t` is on the thickness of one inner element.
#[derive(Clone, Copy)]
struct Coefficients {
    e: f64,
    nu: f64,
    t: f64,
    one_t: f64,
}

const RIGHT: Coefficients = Coefficients {
    e: 1.0,
    nu: 1.0,
    t: 1.0,
    one_t: 1.0,
};

/// Membrane strain `(e_x, e_y, g_xy)` and curvature `(k_x, k_y, k_xy)`, the same everywhere.
struct Constant {
    strain: [f64; 3],
    curvature: [f64; 3],
}

impl Constant {
    /// Displacement and rotation of a place: `w = -(k_x x^2 + k_y y^2 + k_xy x y) / 2` bends so that positive curvature
    /// stretches the top, `beta = -grad w`.
    fn dofs(&self, p: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let ([ex, ey, g], [kx, ky, kxy]) = (self.strain, self.curvature);
        let w = -0.5 * (kx * p.x * p.x + ky * p.y * p.y + kxy * p.x * p.y);
        let [beta_x, beta_y] = [kx * p.x + 0.5 * kxy * p.y, ky * p.y + 0.5 * kxy * p.x];
        [
            Vector3::new(ex * p.x + 0.5 * g * p.y, ey * p.y + 0.5 * g * p.x, w),
            Vector3::new(-beta_y, beta_x, 0.0),
        ]
    }

    /// Closed form: `s_x = E / (1 - nu^2) (e_x + nu e_y)`, `s_xy = E / (2 (1 + nu)) g_xy`, of bending at the top with
    /// `t / 2` times the curvature.
    fn stress_pa(&self) -> [Matrix3<f64>; 2] {
        let of = |[x, y, xy]: [f64; 3], height: f64| {
            let c = E / (1.0 - NU * NU) * height;
            let (s_x, s_y, s_xy) = (c * (x + NU * y), c * (y + NU * x), 0.5 * E / (1.0 + NU) * height * xy);
            Matrix3::new(s_x, s_xy, 0.0, s_xy, s_y, 0.0, 0.0, 0.0, 0.0)
        };
        [of(self.strain, 1.0), of(self.curvature, 0.5 * T)]
    }
}

/// 2 x 1.2 m, its inner nodes moved by up to a third of an element, so that no inner element is a parallelogram.
fn place(i: usize, j: usize) -> Vector3<f64> {
    let (x, y) = (2.0 * i as f64 / N as f64, 1.2 * j as f64 / M as f64);
    if i == 0 || j == 0 || i == N || j == M {
        return Vector3::new(x, y, 0.0);
    }
    let aside = [
        (0.13, 0.1),
        (-0.12, 0.07),
        (0.06, -0.12),
        (-0.05, -0.1),
        (0.15, 0.03),
        (-0.1, 0.12),
    ];
    let (dx, dy) = aside[(i + (N - 1) * (j - 1)) % aside.len()];
    Vector3::new(x + dx, y + dy, 0.0)
}

/// Largest miss of the stresses at the centre and at a point aside of each element, over the largest stress of the state. The
/// outer nodes are masters and move as the state says; the inner ones are condensed out and recovered.
fn miss(state: &Constant, turn: &Rotation3<f64>, by: Coefficients) -> f64 {
    let section = shell(E * by.e, NU * by.nu, T * by.t, 7850.0);
    let at = |s: f64, t: f64| {
        let (i, j) = ((s * N as f64).round() as usize, (t * M as f64).round() as usize);
        turn * place(i, j) + Vector3::new(3.0, -1.0, 2.0)
    };
    let mut grid = Grid::new(N, M, section, at);
    let inner = N + 1;
    grid.model.mesh.shells[inner].section.thickness_m *= by.one_t;
    let mesh = &grid.model.mesh;
    let is_outer = |node: usize| {
        let (i, j) = (node % (N + 1), node / (N + 1));
        i == 0 || j == 0 || i == N || j == M
    };
    let nodes = 0..mesh.nodes.len();
    let outer = nodes.clone().filter(|&node| is_outer(node));
    let masters: Vec<usize> = outer
        .flat_map(|node| (0..6).map(move |d| NodeId(node).dof(d)))
        .collect();
    let (k, m) = assemble(mesh, MassKind::Consistent).unwrap();
    let condensed = SuperElement::condense(&k, &m, &masters, 0).unwrap();
    let exact: Vec<f64> = nodes
        .flat_map(|node| {
            let of_node = state.dofs(&place(node % (N + 1), node / (N + 1)));
            of_node
                .into_iter()
                .flat_map(|v| (turn * v).iter().copied().collect::<Vec<_>>())
                .collect::<Vec<_>>()
        })
        .collect();
    let mut u = vec![0.0; k.order()];
    for (column, &dof) in condensed.transformation.col_iter().zip(&condensed.masters) {
        u.iter_mut().zip(column.iter()).for_each(|(u, t)| *u += t * exact[dof]);
    }
    let expected = state.stress_pa().map(|s| turn.matrix() * s * turn.matrix().transpose());
    let size = largest(expected.iter().flatten().map(|s| s.abs()));
    let shells =
        mesh.shells.iter().enumerate().flat_map(|(number, cell)| {
            let element = Shell::new(number, &cell.nodes.map(|n| mesh.place(n)), cell.section).unwrap();
            let own: [f64; 24] = std::array::from_fn(|i| u[cell.nodes[i / 6].dof(i % 6)]);
            let axes = element.frame.axes;
            [(0.0, 0.0), (0.4, -0.7)].map(|(xi, eta)| {
                let found = Shell::stress(&element.stress_matrix(xi, eta), &own);
                let turned = expected.map(|s| axes * s * axes.transpose());
                let pairs = [found.membrane_pa, found.bending_pa].into_iter().zip(turned);
                largest(pairs.flat_map(|([s_1, s_2, s_12], s)| {
                    [s_1 - s[(0, 0)], s_2 - s[(1, 1)], s_12 - s[(0, 1)]].map(f64::abs)
                })) / size
            })
        });
    largest(shells.collect::<Vec<_>>())
}

/// Irons' patch test of all six constant states, through a condensation. 1e-10: rounding of the condensation's solves;
/// 5e-13 found. Twins: E, nu, the thickness (of all where stress counts with it, of one element in any state). Shear has no
/// part of nu but by G.
#[test]
fn constant_strain_and_curvature_on_a_condensed_distorted_patch() {
    for turn in [Rotation3::identity(), general()] {
        for component in 0..6 {
            let mut list = [0.0; 6];
            list[component] = 1e-3;
            let state = Constant {
                strain: [list[0], list[1], list[2]],
                curvature: [list[3], list[4], list[5]],
            };
            let right = miss(&state, &turn, RIGHT);
            let mut twins = vec![
                ("E", Coefficients { e: 1.05, ..RIGHT }),
                ("nu", Coefficients { nu: 1.05, ..RIGHT }),
                ("thickness of one element", Coefficients { one_t: 1.05, ..RIGHT }),
            ];
            if component > 2 {
                twins.push(("thickness", Coefficients { t: 1.05, ..RIGHT }));
            }
            for (what, wrong) in twins {
                held(
                    &format!("state {component}, {what}"),
                    1e-10,
                    right,
                    miss(&state, &turn, wrong),
                );
            }
        }
    }
}

/// A beam of three elements in general position, clamped, with a force and a moment at its end: at the middle of each element
/// `N = F_1`, `V_2 = F_2`, `V_3 = F_3`, `T = M_1`, `M_2 = M_2 - F_3 a`, `M_3 = M_3 + F_2 a`, a the distance to the end. 1e-9: rounding of the solve. Twin: the matrix of a stiffer beam.
#[test]
fn forces_of_a_beam_at_the_middle_of_its_elements() {
    let miss = |e: f64| -> f64 {
        let mut mesh = Mesh::default();
        let along = general() * Vector3::x();
        let nodes: Vec<NodeId> = [0.0, 0.7, 1.1, 2.0].iter().map(|x| mesh.add_node(along * *x)).collect();
        let up = general() * Vector3::new(0.3, 1.0, 0.0);
        let section = rectangle(0.1, 0.16, 3e-5, E, NU, 7850.0);
        nodes
            .windows(2)
            .for_each(|ends| mesh.add_beam([ends[0], ends[1]], section, up));
        let mut model = Model::new(mesh);
        model.hold(nodes[0], &[0, 1, 2, 3, 4, 5]);
        let (force, moment) = (Vector3::new(2e4, 3e3, -1e3), Vector3::new(700.0, -900.0, 400.0));
        for (first, load) in [(0, general() * force), (3, general() * moment)] {
            (0..3).for_each(|d| model.push(nodes[3], first + d, load[d]));
        }
        let u = model.displacements();
        let misses = [(0, 1.65), (1, 1.1), (2, 0.45)].map(|(element, to_end)| {
            let ends = [nodes[element], nodes[element + 1]];
            let stiffer = pontoon_core::fem::BeamSection {
                youngs_modulus_pa: e * E,
                ..section
            };
            let beam = Beam::new(element, &ends.map(|n| model.mesh.place(n)), &up, stiffer).unwrap();
            let own: [f64; 12] = std::array::from_fn(|i| u[ends[i / 6].dof(i % 6)]);
            let found = Beam::forces(&beam.force_matrix(), &own);
            let expected = BeamForces {
                axial_n: force.x,
                shear_n: [force.y, force.z],
                torque_newton_m: moment.x,
                bending_newton_m: [moment.y - force.z * to_end, moment.z + force.y * to_end],
            };
            let list = |f: BeamForces| {
                [
                    f.axial_n / 1e3,
                    f.torque_newton_m,
                    f.bending_newton_m[0],
                    f.bending_newton_m[1],
                ]
            };
            largest(
                list(found)
                    .iter()
                    .zip(list(expected))
                    .map(|(a, b)| (a - b).abs() / b.abs()),
            )
        });
        largest(misses)
    };
    held("forces of a beam", 1e-9, miss(1.0), miss(1.05));
}
