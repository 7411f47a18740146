//! What the benchmarks of the finite elements share: a mesh with supports and loads, and the reading of its answer.
//!
//! Knows the public face of `pontoon_core::fem` alone. Does not know a single reference value.

#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};
use pontoon_core::fem::{
    BeamSection, EigenPairs, Factor, MassKind, Mesh, NodeId, ShellSection, SymmetricMatrix, assemble, lowest_modes,
};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// A mesh, the dofs that are held and the load on the others.
pub struct Model {
    /// The mesh.
    pub mesh: Mesh,
    /// Whether a dof is held, of each.
    pub held: Vec<bool>,
    /// The load on each dof.
    pub load: Vec<f64>,
}

impl Model {
    /// A mesh that nothing holds and nothing loads.
    pub fn new(mesh: Mesh) -> Self {
        let n = mesh.dofs();
        Self {
            mesh,
            held: vec![false; n],
            load: vec![0.0; n],
        }
    }

    /// Holds directions of a node.
    pub fn hold(&mut self, node: NodeId, directions: &[usize]) {
        for &d in directions {
            self.held[node.dof(d)] = true;
        }
    }

    /// Adds a force or moment on a node.
    pub fn push(&mut self, node: NodeId, direction: usize, value: f64) {
        self.load[node.dof(direction)] += value;
    }

    /// Adds the work-equivalent load of `force` per unit of area: the mass matrix of unit mass per area times it.
    pub fn push_area(&mut self, force: Vector3<f64>, mass_per_area: f64) {
        let (_, m) = assemble(&self.mesh, MassKind::Consistent).unwrap();
        let n = self.mesh.dofs();
        let mut f = vec![0.0; n];
        m.multiply(
            &(0..n)
                .map(|i| if i % 6 < 3 { force[i % 6] } else { 0.0 })
                .collect::<Vec<_>>(),
            &mut f,
        );
        for (i, f) in f.iter().enumerate().filter(|(i, _)| i % 6 < 3) {
            self.load[i] += f / mass_per_area;
        }
    }

    fn free(&self) -> Vec<usize> {
        (0..self.held.len()).filter(|&i| !self.held[i]).collect()
    }

    /// The parts of K and M that belong to the dofs that are free, and those dofs.
    pub fn matrices(&self, mass: MassKind) -> (SymmetricMatrix, SymmetricMatrix, Vec<usize>) {
        let (k, m) = assemble(&self.mesh, mass).unwrap();
        let free = self.free();
        (part(&k, &free), part(&m, &free), free)
    }

    /// Displacements of all dofs under the load.
    pub fn displacements(&self) -> Vec<f64> {
        self.displacements_given(vec![0.0; self.held.len()])
    }

    /// Displacements of all dofs where those that are held move as given.
    pub fn displacements_given(&self, mut u: Vec<f64>) -> Vec<f64> {
        let (k, _) = assemble(&self.mesh, MassKind::Lumped).unwrap();
        u.iter_mut()
            .zip(&self.held)
            .filter(|(_, held)| !**held)
            .for_each(|(u, _)| *u = 0.0);
        let mut f = vec![0.0; u.len()];
        k.multiply(&u, &mut f);
        let free = self.free();
        let mut x: Vec<f64> = free.iter().map(|&i| self.load[i] - f[i]).collect();
        Factor::new("test", &part(&k, &free)).unwrap().solve(&mut x);
        for (&i, x) in free.iter().zip(x) {
            u[i] = x;
        }
        u
    }

    /// Displacement of one dof under the load.
    pub fn displacement(&self, node: NodeId, direction: usize) -> f64 {
        self.displacements()[node.dof(direction)]
    }

    /// Strain energy twice over, `f . u`: the measure in which the finite element error is smallest.
    pub fn work(&self) -> f64 {
        self.displacements().iter().zip(&self.load).map(|(u, f)| u * f).sum()
    }

    /// The lowest modes of the dofs that are not held.
    pub fn modes(&self, mass: MassKind, count: usize, shift: f64) -> EigenPairs {
        let (k, m, _) = self.matrices(mass);
        lowest_modes(&k, &m, count, shift).unwrap()
    }

    /// The lowest frequencies `[Hz]`.
    pub fn frequencies_hz(&self, mass: MassKind, count: usize, shift: f64) -> Vec<f64> {
        self.modes(mass, count, shift)
            .lambda
            .iter()
            .map(|l| l.max(0.0).sqrt() / TAU)
            .collect()
    }
}

/// Rows and columns `keep` of a matrix.
pub fn part(a: &SymmetricMatrix, keep: &[usize]) -> SymmetricMatrix {
    let mut place = vec![usize::MAX; a.order()];
    for (new, &old) in keep.iter().enumerate() {
        place[old] = new;
    }
    let entries: Vec<_> = a
        .entries()
        .map(|(i, j, v)| (place[i], place[j], v))
        .filter(|&(i, j, _)| i != usize::MAX && j != usize::MAX)
        .collect();
    SymmetricMatrix::from_entries(keep.len(), &entries).unwrap()
}

/// A mesh of `n` x `m` shells over the unit square, taken to its place by a map.
pub struct Grid {
    /// The model on it.
    pub model: Model,
    /// Elements along the first edge.
    pub n: usize,
    /// Elements along the second edge.
    pub m: usize,
}

impl Grid {
    /// The mesh of `n` x `m` shells of a section, its unit square taken to its place.
    pub fn new(n: usize, m: usize, section: ShellSection, place: impl Fn(f64, f64) -> Vector3<f64>) -> Self {
        let mut mesh = Mesh::default();
        for j in 0..=m {
            for i in 0..=n {
                mesh.add_node(place(i as f64 / n as f64, j as f64 / m as f64));
            }
        }
        let node = |i: usize, j: usize| NodeId(j * (n + 1) + i);
        for j in 0..m {
            for i in 0..n {
                mesh.add_shell(
                    [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)],
                    section,
                );
            }
        }
        Self {
            model: Model::new(mesh),
            n,
            m,
        }
    }

    /// The node at a corner of elements, from 0.
    pub fn node(&self, i: usize, j: usize) -> NodeId {
        NodeId(j * (self.n + 1) + i)
    }

    /// Holds directions along the edges: left (i = 0), right (i = n), bottom (j = 0), top (j = m).
    pub fn hold_edges(&mut self, left: &[usize], right: &[usize], bottom: &[usize], top: &[usize]) {
        for j in 0..=self.m {
            self.model.hold(self.node(0, j), left);
            self.model.hold(self.node(self.n, j), right);
        }
        for i in 0..=self.n {
            self.model.hold(self.node(i, 0), bottom);
            self.model.hold(self.node(i, self.m), top);
        }
    }

    /// Holds all nodes in some directions.
    pub fn hold_all(&mut self, directions: &[usize]) {
        for i in 0..(self.n + 1) * (self.m + 1) {
            self.model.hold(NodeId(i), directions);
        }
    }
}

/// Factors on the coefficients of a benchmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// On Young's modulus.
    pub e: f64,
    /// On the thickness.
    pub t: f64,
    /// On the density.
    pub rho: f64,
}

/// The benchmark as published.
pub const RIGHT: Factors = Factors {
    e: 1.0,
    t: 1.0,
    rho: 1.0,
};

/// Wrong by 5 % in one coefficient.
pub fn wrong(which: char) -> [Factors; 2] {
    [0.95, 1.05].map(|c| match which {
        'E' => Factors { e: c, ..RIGHT },
        't' => Factors { t: c, ..RIGHT },
        'r' => Factors { rho: c, ..RIGHT },
        _ => panic!("no coefficient {which}"),
    })
}

/// Asserts that value / reference lies in the band, and (the twin) that it leaves it when any of the coefficients
/// `which` ("E", "t", "r" for density) is 5 % wrong in either direction.
pub fn holds(name: &str, reference: f64, band: RangeInclusive<f64>, which: &str, value: impl Fn(Factors) -> f64) {
    hold_each(name, &[(reference, band)], which, |f| vec![value(f)]);
}

/// Asserts of several values at once what [`holds`] asserts of one.
pub fn hold_each(name: &str, cards: &[(f64, RangeInclusive<f64>)], which: &str, values: impl Fn(Factors) -> Vec<f64>) {
    let check = |factors: Factors, inside: bool| {
        for (i, (value, (reference, band))) in values(factors).iter().zip(cards).enumerate() {
            let ratio = value / reference;
            if inside {
                println!("{name} [{i}]: computed {value:.6e}, reference {reference:.6e}, ratio {ratio:.5}");
            }
            assert!(
                band.contains(&ratio) == inside,
                "{name} [{i}]: ratio {ratio:.5}, band {band:?}, {factors:?}"
            );
        }
    };
    check(RIGHT, true);
    for factors in which.chars().flat_map(wrong) {
        check(factors, false);
    }
}

/// Slopes `log(e_i / e_i+1) / log 2` of errors on meshes that double.
pub fn slopes(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).abs().log2()).collect()
}

/// A shell of one material.
pub fn shell(e: f64, nu: f64, t: f64, rho: f64) -> ShellSection {
    ShellSection {
        thickness_m: t,
        youngs_modulus_pa: e,
        poissons_ratio: nu,
        density_kg_m3: rho,
    }
}

/// A rectangular beam section, `b` along local y and `h` along local z, without torsion theory beyond what is given.
pub fn rectangle(b: f64, h: f64, torsion: f64, e: f64, nu: f64, rho: f64) -> BeamSection {
    BeamSection {
        area_m2: b * h,
        i_y_m4: b * h.powi(3) / 12.0,
        i_z_m4: h * b.powi(3) / 12.0,
        torsion_m4: torsion,
        shear_area_m2: Some(5.0 / 6.0 * b * h),
        youngs_modulus_pa: e,
        poissons_ratio: nu,
        density_kg_m3: rho,
    }
}

/// A rotation about no axis in particular.
pub fn general() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.4, -1.1, 2.3)
}

/// The six rigid motions of points: columns of u = a + b x p, theta = b.
pub fn rigid(points: &[Vector3<f64>]) -> [Vec<f64>; 6] {
    std::array::from_fn(|mode| {
        let mut x = Vec::with_capacity(6 * points.len());
        for p in points {
            let axis = Vector3::ith(mode % 3, 1.0);
            let (u, r) = if mode < 3 {
                (axis, Vector3::zeros())
            } else {
                (axis.cross(p), axis)
            };
            x.extend(u.iter().chain(r.iter()));
        }
        x
    })
}
