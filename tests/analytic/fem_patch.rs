//! What every element must do on any mesh: hold constant stress, move rigidly at no cost, weigh what it weighs, and be
//! refused where it is none.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};
use pontoon_core::fem::{Beam, BeamSection, FemError, MassKind, Mesh, Shell, ShellSection, assemble};
use pontoon_tests::fem_model::{Factors, Model, RIGHT, general, holds, rectangle, rigid, shell};
type Place = Vector3<f64>;
/// A field on the patch: place in its plane to displacement and rotation.
type Field = fn(&Place) -> (Vector3<f64>, Vector3<f64>);

/// MacNeal and Harder's patch: 0.24 x 0.12, four inner nodes, five quadrilaterals, E = 1e6, nu = 0.25, t = 0.001.
fn patch(turn: &Rotation3<f64>, f: Factors, one_element: f64) -> (Model, Vec<Place>) {
    let outer = [(0.0, 0.0), (0.24, 0.0), (0.24, 0.12), (0.0, 0.12)];
    let inner = [(0.04, 0.02), (0.18, 0.03), (0.16, 0.08), (0.08, 0.08)];
    let plane: Vec<Place> = outer
        .into_iter()
        .chain(inner)
        .map(|(x, y)| Vector3::new(x, y, 0.0))
        .collect();
    let mut mesh = Mesh::default();
    let place = |i: usize| turn * plane[i] + Vector3::new(0.3, -0.2, 0.7);
    let n: [_; 8] = std::array::from_fn(|i| mesh.add_node(place(i)));
    let section = shell(1e6 * f.e, 0.25, 1e-3 * f.t, 1.0);
    for corners in [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]] {
        mesh.add_shell(corners.map(|i| n[i]), section);
    }
    let other = ShellSection {
        thickness_m: one_element * section.thickness_m,
        ..section
    };
    mesh.add_shell([n[4], n[5], n[6], n[7]], other);
    let mut model = Model::new(mesh);
    n[..4]
        .iter()
        .for_each(|&corner| model.hold(corner, &[0, 1, 2, 3, 4, 5]));
    (model, plane)
}

/// The field on all dofs, turned with the patch.
fn exact(field: Field, places: &[Place], turn: &Rotation3<f64>) -> Vec<f64> {
    let dofs = |p: &Place| {
        let (u, r) = field(p);
        (turn * u).iter().chain((turn * r).iter()).copied().collect::<Vec<_>>()
    };
    places.iter().flat_map(dofs).collect()
}

/// Largest error of the inner nodes over the largest displacement, rotations taken over the patch's length.
fn inner_error(field: Field, turn: &Rotation3<f64>, one_element: f64) -> f64 {
    let (model, places) = patch(turn, RIGHT, one_element);
    let expected = exact(field, &places, turn);
    let u = model.displacements_given(expected.clone());
    let weigh = |i: usize, v: f64| if i % 6 < 3 { v.abs() } else { 0.24 * v.abs() };
    let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0, f64::max);
    largest(&mut (0..u.len()).map(|i| weigh(i, u[i] - expected[i])))
        / largest(&mut expected.iter().enumerate().map(|(i, &v)| weigh(i, v)))
}

/// Twice the strain energy of the patch under its corner displacements.
fn energy(field: Field, turn: &Rotation3<f64>, f: Factors) -> f64 {
    let (model, places) = patch(turn, f, 1.0);
    let u = model.displacements_given(exact(field, &places, turn));
    let (k, _) = assemble(&model.mesh, MassKind::Lumped).unwrap();
    k.form(&u, &u)
}

/// `u = 1e-3 (x + y/2)`, `v = 1e-3 (y + x/2)` and a turn in the plane, which the drilling dof must follow.
fn membrane_field(p: &Place) -> (Vector3<f64>, Vector3<f64>) {
    let turn = 4e-4;
    let u = Vector3::new(
        1e-3 * (p.x + 0.5 * p.y) - turn * p.y,
        1e-3 * (p.y + 0.5 * p.x) + turn * p.x,
        0.0,
    );
    (u, Vector3::new(0.0, 0.0, turn))
}

/// `w = 1e-3 (x^2 + x y + y^2) / 2` and its slopes.
fn bending_field(p: &Place) -> (Vector3<f64>, Vector3<f64>) {
    let w = 0.5e-3 * (p.x * p.x + p.x * p.y + p.y * p.y);
    (
        Vector3::new(0.0, 0.0, w),
        Vector3::new(1e-3 * (p.y + 0.5 * p.x), -1e-3 * (p.x + 0.5 * p.y), 0.0),
    )
}

/// MacNeal and Harder 1985, section 2, membrane and bending patch; outer nodes prescribed. Expected: the field at the
/// inner nodes, to rounding (1e-9: condition number of a plate this thin, 1e6, times 1e-16, times fill). Twin: the
/// inner element 5 % too thick leaves 1e-4 and more.
#[test]
fn constant_stress_on_the_distorted_patch() {
    for turn in [Rotation3::identity(), general()] {
        for field in [membrane_field as Field, bending_field] {
            assert!(inner_error(field, &turn, 1.0) < 1e-9);
            assert!(inner_error(field, &turn, 1.05) > 1e-4);
        }
    }
}

/// The stress itself, through the energy `V sigma : eps` of the same patches. MacNeal and Harder give sigma = (1333,
/// 1333, 400) for the membrane and moments (1.111e-7, 1.111e-7, 3.333e-8) for bending: with `eps` = (1, 1, 1) 1e-3 and
/// `kappa` = (1, 1, 1) 1e-3 the energies are 3.0667 x 0.0288 x 1e-3 and 2.5556e-10 x 0.0288. Exact but for rounding.
#[test]
fn stress_of_the_distorted_patch() {
    let area = 0.24 * 0.12;
    for turn in [Rotation3::identity(), general()] {
        let membrane = (2.0 * 4000.0 / 3.0 + 400.0) * 1e-3 * 1e-3 * area;
        holds("patch, membrane", membrane, 1.0 - 1e-9..=1.0 + 1e-9, "Et", |f| {
            energy(membrane_field, &turn, f)
        });
        let bending = (2.0 / 9e6 + 1.0 / 30e6) * 1e-3 * area;
        holds("patch, bending", bending, 1.0 - 1e-9..=1.0 + 1e-9, "Et", |f| {
            energy(bending_field, &turn, f)
        });
    }
}

/// One element alone: a distorted quadrilateral, its corners lifted by `warp` in turn, in general position.
fn lone_shell(warp: f64, f: Factors) -> (Mesh, Vec<Place>) {
    let corners = [
        (0.0, 0.0, warp),
        (1.3, 0.1, -warp),
        (1.0, 0.9, warp),
        (-0.2, 0.7, -warp),
    ];
    let places: Vec<Place> = corners
        .iter()
        .map(|&(x, y, z)| general() * Vector3::new(x, y, z) + Vector3::new(2.0, -1.0, 0.5))
        .collect();
    let mut mesh = Mesh::default();
    let nodes = [0, 1, 2, 3].map(|i| mesh.add_node(places[i]));
    mesh.add_shell(nodes, shell(1e6 * f.e, 0.3, 0.1 * f.t, 8000.0 * f.rho));
    (mesh, places)
}

fn lone_beam(f: Factors) -> (Mesh, Vec<Place>) {
    let places = vec![Vector3::new(0.4, -0.3, 1.1), Vector3::new(1.2, 0.9, 0.2)];
    let mut mesh = Mesh::default();
    let nodes = [0, 1].map(|i| mesh.add_node(places[i]));
    mesh.add_beam(
        nodes,
        rectangle(0.1, 0.2, 5e-5, 1e6 * f.e, 0.3, 8000.0 * f.rho),
        Vector3::new(0.1, 0.2, 1.0),
    );
    (mesh, places)
}

/// Six rigid motions cost nothing and nothing else is free: `K x = 0` to rounding (1e-13 of `|K| |x|`), six eigenvalues
/// of K within 1e-12 of the largest, the seventh above 1e-9 (the weakest is the drilling hourglass, 1e-5 of the
/// membrane). Twin: a rotation whose translations are 5 % short is no rigid motion.
#[test]
fn six_rigid_motions_and_no_more() {
    let (flat, warped, beam) = (lone_shell(0.0, RIGHT), lone_shell(0.15, RIGHT), lone_beam(RIGHT));
    for (mesh, places) in [flat, warped, beam] {
        let (k, _) = assemble(&mesh, MassKind::Lumped).unwrap();
        let n = k.order();
        let scale = k.entries().map(|e| e.2.abs()).fold(0.0, f64::max);
        let force = |x: &[f64]| {
            let mut f = vec![0.0; n];
            k.multiply(x, &mut f);
            f.iter().fold(0.0_f64, |m, f| m.max(f.abs())) / scale
        };
        for (mode, x) in rigid(&places).iter().enumerate() {
            assert!(force(x) < 1e-13, "rigid motion {mode} costs {:.1e}", force(x));
            if mode >= 3 {
                let short: Vec<f64> = x
                    .iter()
                    .enumerate()
                    .map(|(i, x)| if i % 6 < 3 { 0.95 * x } else { *x })
                    .collect();
                assert!(force(&short) > 1e-6, "a false rotation costs {:.1e}", force(&short));
            }
        }
        let dense = faer::Mat::from_fn(n, n, |i, j| k.column(j).find(|e| e.0 == i).map_or(0.0, |e| e.1));
        let lambda = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        assert!(lambda[5].abs() < 1e-12 * lambda[n - 1] && lambda[0] > -1e-12 * lambda[n - 1]);
        assert!(
            lambda[6] > 1e-9 * lambda[n - 1],
            "seventh eigenvalue {:.1e}",
            lambda[6] / lambda[n - 1]
        );
    }
}

/// K and M are symmetric to the last bit, whatever the shape.
#[test]
fn symmetric_to_the_last_bit() {
    for (mesh, _) in [lone_shell(0.15, RIGHT), lone_beam(RIGHT)] {
        for kind in [MassKind::Consistent, MassKind::Lumped] {
            let (k, m) = assemble(&mesh, kind).unwrap();
            for a in [k, m] {
                for (i, j, v) in a.entries() {
                    assert!(a.column(i).any(|e| e == (j, v)), "entry ({i}, {j})");
                }
            }
        }
    }
}

/// Translating mass: `r^T M r = rho t A` (area 0.975 of the distorted quadrilateral, in its mean plane where it
/// is warped) and `rho A L` of the beam (L = 1.7), for both kinds of mass in all directions; exact.
#[test]
fn translating_mass() {
    let length = (0.8_f64.powi(2) + 1.2_f64.powi(2) + 0.9_f64.powi(2)).sqrt();
    let area = 0.5 * (1.0 * 0.6 + 0.9 * 1.5);
    let mass = |mesh: Mesh, kind, direction: usize| {
        let (_, m) = assemble(&mesh, kind).unwrap();
        let r: Vec<f64> = (0..m.order())
            .map(|i| f64::from(u8::from(i % 6 == direction)))
            .collect();
        m.form(&r, &r)
    };
    for kind in [MassKind::Consistent, MassKind::Lumped] {
        for d in 0..3 {
            let exact = 1.0 - 1e-12..=1.0 + 1e-12;
            holds("mass, flat", 800.0 * area, exact.clone(), "tr", |f| {
                mass(lone_shell(0.0, f).0, kind, d)
            });
            holds("mass, warped", 800.0 * area, exact.clone(), "tr", |f| {
                mass(lone_shell(0.15, f).0, kind, d)
            });
            holds("mass, beam", 160.0 * length, exact, "r", |f| {
                mass(lone_beam(f).0, kind, d)
            });
        }
    }
}

/// Turning mass about the centre, consistent: a rectangle a x b about its normal, `rho t a b (a^2 + b^2) / 12`, and
/// about its side a, `rho t a b (b^2 + t^2) / 12`; a beam about its second axis, `rho A L (L^2 + b^2) / 12` with b the
/// depth. Exact, because rigid motion lies within the shape functions; turned inertia included.
#[test]
fn turning_mass() {
    let (a, b, t) = (1.6, 0.6, 0.1);
    let exact = 1.0 - 1e-12..=1.0 + 1e-12;
    let inertia = |m: &dyn Fn(usize, usize) -> f64, places: &[Place], axis: Vector3<f64>| {
        let x: Vec<f64> = places
            .iter()
            .flat_map(|p| axis.cross(p).iter().chain(axis.iter()).copied().collect::<Vec<_>>())
            .collect();
        (0..x.len())
            .map(|i| (0..x.len()).map(|j| x[i] * m(i, j) * x[j]).sum::<f64>())
            .sum()
    };
    let quad = [(-a, -b), (a, -b), (a, b), (-a, b)].map(|(x, y)| general() * Vector3::new(0.5 * x, 0.5 * y, 0.0));
    for (axis, square) in [(Vector3::z(), a * a + b * b), (Vector3::x(), b * b + t * t)] {
        holds(
            "turning mass, shell",
            8000.0 * t * a * b * square / 12.0,
            exact.clone(),
            "r",
            |f| {
                let m = Shell::new(0, &quad, shell(1e6, 0.3, t, 8000.0 * f.rho))
                    .unwrap()
                    .mass_consistent();
                // drilling carries no mass: about the normal the nodes' rotation adds nothing
                inertia(&|i, j| m[(i, j)], &quad, general() * axis)
            },
        );
    }
    let ends = [-0.7, 0.7].map(|x| general() * Vector3::new(x, 0.0, 0.0));
    holds(
        "turning mass, beam",
        160.0 * 1.4 * (1.4 * 1.4 + 0.04) / 12.0,
        exact,
        "r",
        |f| {
            let section = rectangle(0.1, 0.2, 5e-5, 1e6, 0.3, 8000.0 * f.rho);
            let m = Beam::new(0, &ends, &(general() * Vector3::y()), section)
                .unwrap()
                .mass_consistent();
            inertia(&|i, j| m[(i, j)], &ends, general() * Vector3::y())
        },
    );
}

/// What is no element is refused with its number and measure.
#[test]
fn degenerate_elements_are_refused() {
    let good = shell(1e6, 0.3, 0.1, 1.0);
    let quad = |c: [(f64, f64); 4], s| Shell::new(7, &c.map(|(x, y)| Vector3::new(x, y, 0.0)), s).err();
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let measure = |e: Option<FemError>| match e {
        Some(FemError::Degenerate {
            element: 7, measure, ..
        }) => measure,
        other => panic!("not refused: {other:?}"),
    };
    assert_eq!(quad(square, good), None);
    assert_eq!(
        measure(quad([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], good)),
        "area"
    );
    assert_eq!(
        measure(quad([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)], good)),
        "area"
    );
    assert_eq!(
        measure(quad([(0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)], good)),
        "Jacobian at a corner"
    );
    assert_eq!(
        measure(quad([(0.0, 0.0), (1.0, 0.0), (1.0, f64::NAN), (0.0, 1.0)], good)),
        "area"
    );
    assert_eq!(measure(quad(square, shell(1e6, 0.3, 0.0, 1.0))), "thickness");
    assert_eq!(measure(quad(square, shell(f64::NAN, 0.3, 0.1, 1.0))), "Young's modulus");
    assert_eq!(measure(quad(square, shell(1e6, 1.0, 0.1, 1.0))), "Poisson's ratio");
    assert_eq!(measure(quad(square, shell(1e6, 0.3, 0.1, -1.0))), "density");
    let section = rectangle(0.1, 0.2, 5e-5, 1e6, 0.3, 1.0);
    let beam = |a: Place, b: Place, up: Place, s: BeamSection| Beam::new(7, &[a, b], &up, s).err();
    let (o, x, z) = (Vector3::zeros(), Vector3::x(), Vector3::z());
    assert_eq!(beam(o, x, z, section), None);
    assert_eq!(measure(beam(x, x, z, section)), "length");
    for up in [x, o, Vector3::new(0.0, 0.0, f64::NAN)] {
        assert_eq!(
            measure(beam(o, x, up, section)),
            "sine of the angle between axis and up"
        );
    }
    assert_eq!(
        measure(beam(
            o,
            x,
            z,
            BeamSection {
                i_y_m4: -1.0,
                ..section
            }
        )),
        "second moment about y"
    );
    assert_eq!(
        measure(beam(
            o,
            x,
            z,
            BeamSection {
                shear_area_m2: Some(0.0),
                ..section
            }
        )),
        "shear area"
    );
}
