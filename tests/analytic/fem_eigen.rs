//! Factorisation and eigenvalues by themselves: accuracy, completeness amid clusters, refusals.
#![allow(clippy::unwrap_used)]

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};
use nalgebra::Vector3;
use pontoon_core::fem::{
    EigenPairs, Factor, FemError, MassKind, Mesh, ModeSearch, NodeId, ONE_SEARCH, SymmetricMatrix, count_below,
    lowest_modes,
};
use pontoon_core::stop::Stop;
use pontoon_tests::fem_model::{Grid, Model, RIGHT, shell, wrong};

type Problem = (SymmetricMatrix, SymmetricMatrix);

fn dense(a: &SymmetricMatrix) -> Mat<f64> {
    let mut d = Mat::zeros(a.order(), a.order());
    a.entries().for_each(|(i, j, v)| d[(i, j)] = v);
    d
}

fn diagonal(values: &[f64]) -> SymmetricMatrix {
    let entries: Vec<_> = values.iter().enumerate().map(|(i, &v)| (i, i, v)).collect();
    SymmetricMatrix::from_entries(values.len(), &entries).unwrap()
}

/// A plate floating free, `n` x `m` shells.
fn floating(n: usize, m: usize) -> Problem {
    let section = shell(200e9, 0.3, 0.05, 8000.0);
    let grid = Grid::new(n, m, section, |x, y| Vector3::new(10.0 * x, 10.0 * y, (x * y).sin()));
    let (k, m, _) = grid.model.matrices(MassKind::Consistent);
    (k, m)
}

/// Thirty equal strips side by side, clamped at one end, joined by nothing: every eigenvalue thirty times. With
/// `detuning` a soft foundation, different for each dof, spreads each thirty by so much.
fn strips(detuning: f64) -> Problem {
    let mut mesh = Mesh::default();
    let section = shell(200e9, 0.3, 0.05, 8000.0);
    for strip in 0..30 {
        let start = mesh.nodes.len();
        for i in 0..=20 {
            for j in 0..2 {
                mesh.add_node(Vector3::new(0.25 * f64::from(i), f64::from(2 * strip + j), 0.0));
            }
        }
        let node = |i: usize, j: usize| NodeId(start + 2 * i + j);
        for i in 0..20 {
            mesh.add_shell([node(i, 0), node(i + 1, 0), node(i + 1, 1), node(i, 1)], section);
        }
    }
    let mut model = Model::new(mesh);
    for strip in 0..30 {
        model.hold(NodeId(42 * strip), &[0, 1, 2, 3, 4, 5]);
        model.hold(NodeId(42 * strip + 1), &[0, 1, 2, 3, 4, 5]);
    }
    let (k, m, free) = model.matrices(MassKind::Consistent);
    let foundation = diagonal(&free.iter().map(|&i| detuning * i as f64).collect::<Vec<_>>());
    (SymmetricMatrix::combine(&[(1.0, &k), (1.0, &foundation)]).unwrap(), m)
}

/// Largest relative residual `|K x - lambda M x| / (|K x| + |lambda M x|)` of the elastic modes (where both sides are
/// more than rounding).
fn residual(problem: &Problem, lambda: &[f64], shapes: &Mat<f64>, from: usize) -> f64 {
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|v| v * v).sum::<f64>().sqrt();
    (from..lambda.len()).fold(0.0, |worst, j| {
        let x: Vec<f64> = shapes.col(j).iter().copied().collect();
        let (mut kx, mut mx) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        problem.0.multiply(&x, &mut kx);
        problem.1.multiply(&x, &mut mx);
        let r = norm(&mut kx.iter().zip(&mx).map(|(k, m)| k - lambda[j] * m));
        worst.max(r / (norm(&mut kx.iter().copied()) + norm(&mut mx.iter().map(|m| lambda[j] * m))))
    })
}

/// Largest entry of `X^T M X - I`.
fn unorthogonality(m: &SymmetricMatrix, shapes: &Mat<f64>) -> f64 {
    let mut mx = Mat::zeros(shapes.nrows(), shapes.ncols());
    m.multiply_columns(shapes.as_ref(), mx.as_mut());
    let gram = shapes.transpose() * &mx - Mat::<f64>::identity(shapes.ncols(), shapes.ncols());
    gram.norm_max()
}

/// A floating plate of 2052 dofs, slightly curved: six zeros and 34 elastic modes against the dense eigenvalues of
/// `L^-1 M L^-T` from a dense Cholesky factor. Agreement 1e-8 (the drilling dofs' condition number, 1e8, times 1e-16),
/// zeros below 1e-8 of the first elastic one. Twin: 5 % off in one eigenvalue leaves a residual of 2 %.
#[test]
fn as_the_dense_solution() {
    let problem = floating(18, 17);
    let shift = 50.0;
    let EigenPairs { lambda, shapes } = lowest_modes(&problem.0, &problem.1, 40, shift).unwrap();
    let l = (dense(&problem.0) + faer::Scale(shift) * dense(&problem.1))
        .llt(Side::Lower)
        .unwrap()
        .L()
        .to_owned();
    let mut a = dense(&problem.1);
    solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), Par::Seq);
    let mut a = a.transpose().to_owned();
    solve_lower_triangular_in_place(l.as_ref(), a.as_mut(), Par::Seq);
    let mu = a.self_adjoint_eigenvalues(Side::Lower).unwrap();
    let exact: Vec<f64> = mu.iter().rev().take(40).map(|mu| 1.0 / mu - shift).collect();
    for j in 6..40 {
        assert!(
            (lambda[j] / exact[j] - 1.0).abs() < 1e-8,
            "mode {j}: {} {}",
            lambda[j],
            exact[j]
        );
    }
    assert!(
        lambda[..6].iter().all(|l| l.abs() < 1e-8 * lambda[6]),
        "{:?}",
        &lambda[..7]
    );
    assert!(residual(&problem, &lambda, &shapes, 6) < 1e-6);
    let mut off = lambda.clone();
    off[20] *= 1.05;
    assert!(residual(&problem, &off, &shapes, 6) > 0.02);
    assert!(unorthogonality(&problem.1, &shapes) < 1e-9);
    assert_eq!(
        count_below(&problem.0, &problem.1, 0.5 * (lambda[38] + lambda[39])).unwrap(),
        39
    );
}

/// No mode of a cluster is missed, whether the count ends before, at, or behind its end, or in the next one: all thirty
/// first bending modes come before the second. A Lanczos method on single vectors takes second modes for
/// the last of the first.
#[test]
fn clusters_of_thirty() {
    for detuning in [0.0, 1e-3] {
        let problem = strips(detuning);
        let (k, m) = (&problem.0, &problem.1);
        for count in [10, 30, 31, 45, 75] {
            let EigenPairs { lambda, shapes } = lowest_modes(k, m, count, 50.0).unwrap();
            let first = lambda.iter().filter(|&&l| l < 110.0).count();
            assert_eq!(first, count.min(30), "{count} modes, detuning {detuning}");
            assert!(lambda.windows(2).all(|l| l[0] <= l[1]));
            assert!(
                residual(&problem, &lambda, &shapes, 0) < 1e-6,
                "{count} modes, detuning {detuning}"
            );
            assert!(unorthogonality(m, &shapes) < 1e-9, "{count} modes, detuning {detuning}");
        }
        assert_eq!(
            (count_below(k, m, 50.0).unwrap(), count_below(k, m, 1000.0).unwrap()),
            (0, 30)
        );
    }
}

/// Modes found window after window are those of one search for all: on a floating plate and on equal strips (every eigenvalue
/// thirty times, so that windows end amid copies). Eigenvalues agree to 1e-8, see
/// [`as_the_dense_solution`]; no mode is missed, as counts say; none is found twice, as they are orthogonal. Twin: 5 % off in
/// one eigenvalue.
#[test]
fn windows_find_what_one_search_finds() {
    for (problem, rigid) in [(floating(18, 17), 6), (strips(0.0), 0)] {
        let (k, m) = (&problem.0, &problem.1);
        let mut search = ModeSearch::new(k, m, ONE_SEARCH, 50.0, Stop::never()).unwrap();
        while search.pairs().lambda.len() < 320 {
            search.extend().unwrap();
        }
        let EigenPairs { lambda, shapes } = search.pairs();
        assert!(lambda.windows(2).all(|l| l[0] <= l[1]));
        let whole = lowest_modes(k, m, lambda.len(), 50.0).unwrap();
        let apart = |found: &[f64]| {
            let pairs = found.iter().zip(&whole.lambda).skip(rigid);
            pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
        };
        assert!(apart(lambda) < 1e-8, "{:.1e} apart", apart(lambda));
        let mut off = lambda.clone();
        off[200] *= 1.05;
        assert!(apart(&off) > 1e-8);
        assert!(residual(&problem, lambda, shapes, rigid) < 1e-6);
        assert!(unorthogonality(m, shapes) < 1e-7);
    }
}

/// The search ends where no mode is left: 300 masses on 2,400 dofs.
#[test]
fn search_ends_with_the_masses() {
    let mut masses = vec![0.0; 2400];
    masses[..300].fill(1.0);
    let (k, m) = (
        diagonal(&(1..=2400).map(f64::from).collect::<Vec<_>>()),
        diagonal(&masses),
    );
    let mut search = ModeSearch::new(&k, &m, ONE_SEARCH, 1.0, Stop::never()).unwrap();
    while search.pairs().lambda.len() < 300 {
        search.extend().unwrap();
    }
    for (found, exact) in search.pairs().lambda.iter().zip(1..) {
        assert!((found / f64::from(exact) - 1.0).abs() < 1e-10, "{found} {exact}");
    }
    assert!(matches!(search.extend(), Err(FemError::Eigen { .. })));
}

/// Modes are equal in every run: no time, no randomness.
#[test]
fn the_same_bits_twice() {
    let (k, m) = floating(12, 9);
    let [a, b] = [0, 1].map(|_| lowest_modes(&k, &m, 20, 50.0).unwrap());
    assert!(a.lambda == b.lambda && a.shapes == b.shapes);
}

/// Few dofs take the dense road, also where all modes are wanted: lambda of diagonal matrices.
#[test]
fn small_problems() {
    let (k, m) = (diagonal(&[8.0, 0.0, 3.0]), diagonal(&[2.0, 1.0, 1.0]));
    let modes = lowest_modes(&k, &m, 5, 1.0).unwrap();
    for (lambda, exact) in modes.lambda.iter().zip([0.0, 3.0, 4.0]) {
        assert!((lambda - exact).abs() < 1e-13);
    }
    assert_eq!(modes.lambda.len(), 3);
}

/// More modes than masses, an indefinite stiffness, a shift that is none and a count at an eigenvalue are errors, each its
/// own.
#[test]
fn refusals() {
    let (k, m) = (diagonal(&[1.0, 2.0, 3.0]), diagonal(&[1.0, 0.0, 1.0]));
    assert_eq!(
        lowest_modes(&k, &m, 3, 1.0).err(),
        Some(FemError::Eigen { asked: 3, converged: 2 })
    );
    let mut masses = vec![0.0; 900];
    masses[..20].fill(1.0);
    let many = diagonal(&(1..=900).map(f64::from).collect::<Vec<_>>());
    assert_eq!(
        lowest_modes(&many, &diagonal(&masses), 20, 1.0).map(|e| e.lambda.len()),
        Ok(20)
    );
    assert_eq!(
        lowest_modes(&many, &diagonal(&masses), 30, 1.0).err(),
        Some(FemError::Eigen {
            asked: 30,
            converged: 20
        })
    );
    let negative = lowest_modes(&diagonal(&[1.0, -2.0, 3.0]), &m, 2, 1.0).err();
    assert!(
        matches!(negative, Some(FemError::NotPositiveDefinite { dofs: 3, .. })),
        "{negative:?}"
    );
    for shift in [0.0, -1.0] {
        assert_eq!(
            lowest_modes(&k, &m, 2, shift).err(),
            Some(FemError::Shift { value: shift })
        );
    }
    let unit = diagonal(&[1.0; 3]);
    let at = |sigma: f64| count_below(&k, &unit, sigma);
    assert!(
        matches!(at(2.0), Err(FemError::BadFactor { dofs: 3, .. })),
        "{:?}",
        at(2.0)
    );
    assert_eq!(at(2.0 + 1e-9), Ok(2));
    assert!(matches!(
        lowest_modes(&k, &m, 2, f64::NAN).err(),
        Some(FemError::Shift { .. })
    ));
}

/// Solutions of a clamped plate reproduce a known vector to 1e-6 (its condition number, 1e10, times 1e-16); a matrix
/// that is not positive definite, or not a number, gives an error and no factor. Twin: 5 % more thickness is no
/// rounding.
#[test]
fn factor() {
    let plate = |t: f64| {
        let mut grid = Grid::new(12, 10, shell(200e9, 0.3, 0.05 * t, 1.0), |x, y| {
            Vector3::new(10.0 * x, 8.0 * y, 0.0)
        });
        grid.hold_edges(&[0, 1, 2, 3, 4, 5], &[], &[], &[]);
        grid.model.matrices(MassKind::Lumped).0
    };
    let k = plate(1.0);
    let error = |other: &SymmetricMatrix| {
        let x: Vec<f64> = (0..k.order()).map(|i| (i as f64).sin()).collect();
        let mut f = vec![0.0; x.len()];
        k.multiply(&x, &mut f);
        Factor::new("test", other).unwrap().solve(&mut f);
        f.iter().zip(&x).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
    };
    assert!(error(&k) < 1e-6, "error {:.1e}", error(&k));
    assert!(wrong('t').iter().all(|w| error(&plate(w.t / RIGHT.t)) > 1e-2));
    let refused = |values: &[f64]| Factor::new("test", &diagonal(values)).err();
    assert_eq!(refused(&[1.0, 2.0]), None);
    assert!(matches!(
        refused(&[1.0, -1e-3]),
        Some(FemError::NotPositiveDefinite { dofs: 2, .. })
    ));
    assert!(matches!(
        refused(&[1.0, 0.0]),
        Some(FemError::NotPositiveDefinite { .. })
    ));
    assert!(refused(&[1.0, f64::NAN]).is_some());
}
