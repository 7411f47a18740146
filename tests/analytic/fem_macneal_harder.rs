//! The standard problems of MacNeal and Harder (Finite Elements in Analysis and Design 1, 1985, 3-20), on their meshes.
//!
//! Bands are narrower than the 4.8 % by which a displacement answers to 5 % in E, so each has its twins (E and t). On
//! coarse meshes the band lies around what elements of this class (four nodes, incompatible modes, tied shear) are
//! published to give, not around 1: the ratio is part of the element's definition, and a change of it should be seen.
#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;
use pontoon_tests::fem_model::{Factors, Grid, holds, shell};
use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

const CLAMPED: [usize; 6] = [0, 1, 2, 3, 4, 5];

/// A band of half a percent around a ratio.
fn about(ratio: f64) -> RangeInclusive<f64> {
    ratio - 0.005 * ratio..=ratio + 0.005 * ratio
}

/// Clamps the left edge and spreads a unit force in `direction` over the right one as the shape functions do; returns
/// its work, the mean displacement of the loaded edge.
fn tip_deflection(mut grid: Grid, direction: usize) -> f64 {
    grid.hold_edges(&CLAMPED, &[], &[], &[]);
    let m = grid.m;
    for j in 0..=m {
        let share = if j == 0 || j == m { 0.5 } else { 1.0 } / m as f64;
        grid.model.push(grid.node(grid.n, j), direction, share);
    }
    grid.model.work()
}

const REGULAR: [[f64; 7]; 2] = [[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 2];
const PARALLELOGRAM: [[f64; 7]; 2] = [[0.0, 0.9, 1.9, 2.9, 3.9, 4.9, 6.0], [0.0, 1.1, 2.1, 3.1, 4.1, 5.1, 6.0]];
const TRAPEZOID: [[f64; 7]; 2] = [[0.0, 1.1, 1.9, 3.1, 3.9, 5.1, 6.0], [0.0, 0.9, 2.1, 2.9, 4.1, 4.9, 6.0]];

/// Straight cantilever 6 x 0.2 x 0.1, E = 1e7, nu = 0.3, six elements whose sides lean by 45 degrees where distorted;
/// each split into `parts` x `parts`.
fn straight(x: [[f64; 7]; 2], parts: usize, f: Factors) -> Grid {
    Grid::new(6 * parts, parts, shell(1e7 * f.e, 0.3, 0.1 * f.t, 1.0), |s, t| {
        let i = ((6.0 * s) as usize).min(5);
        let part = 6.0 * s - i as f64;
        let along = |row: &[f64; 7]| row[i] * (1.0 - part) + row[i + 1] * part;
        Vector3::new(along(&x[0]) * (1.0 - t) + along(&x[1]) * t, 0.2 * t, 0.0)
    })
}

/// Rotation of the tip under a unit torque, applied as a couple of the corners as the paper does.
fn tip_twist(mut grid: Grid) -> f64 {
    grid.hold_edges(&CLAMPED, &[], &[], &[]);
    let (below, above) = (grid.node(grid.n, 0), grid.node(grid.n, grid.m));
    grid.model.push(below, 2, -5.0);
    grid.model.push(above, 2, 5.0);
    grid.model.work()
}

/// Straight cantilever. References: extension 3e-5, in-plane shear 0.1081, out-of-plane shear 0.4321. Published for
/// elements with incompatible modes or the equal Pian-Sumihara: in-plane 0.993 regular, 0.632 parallelogram, 0.052
/// trapezoid. No four-node element with two displacements a node passes the patch test and bends as a trapezoid too
/// (MacNeal: Finite Elements in Analysis and Design 3, 1987), so 0.052 is the class's fate, not a defect; it goes away
/// with the mesh (last line).
#[test]
fn straight_cantilever() {
    for (name, mesh, ratios) in [
        ("regular", REGULAR, [0.9957, 0.9929, 0.9801]),
        ("parallelogram", PARALLELOGRAM, [0.9992, 0.6323, 0.9780]),
        ("trapezoid", TRAPEZOID, [0.9993, 0.0515, 0.9632]),
    ] {
        for (direction, reference) in [(0, 3e-5), (1, 0.1081), (2, 0.4321)] {
            holds(
                &format!("cantilever, {name}, {direction}"),
                reference,
                about(ratios[direction]),
                "Et",
                |f| tip_deflection(straight(mesh, 1, f), direction),
            );
        }
    }
    holds("cantilever, trapezoid, 1, fine", 0.1081, 0.97..=1.0, "Et", |f| {
        tip_deflection(straight(TRAPEZOID, 16, f), 1)
    });
}

/// Twist of the straight cantilever. MacNeal and Harder's reference is 0.03208; Saint-Venant's beta = 0.229 for sides
/// 2:1 gives 0.03406. The published QUAD4 ratios to 0.03208 are 0.941 (regular); a fine mesh comes to the second.
#[test]
fn twisted_by_a_torque() {
    for (name, mesh, ratio) in [
        ("regular", REGULAR, 0.9407),
        ("parallelogram", PARALLELOGRAM, 0.8491),
        ("trapezoid", TRAPEZOID, 0.8842),
    ] {
        holds(&format!("torque, {name}"), 0.03208, about(ratio), "Et", |f| {
            tip_twist(straight(mesh, 1, f))
        });
    }
    holds("torque, fine", 0.03406, 0.98..=1.02, "Et", |f| {
        tip_twist(straight(REGULAR, 8, f))
    });
}

/// In-plane pure bending of long elements: 6 x 0.2, nu = 0, tip couple M; `v = M L^2 / (2 E I)` is within the
/// incompatible modes whatever the elements' aspect ratio, here 5:1, 25:1 and 150:1. What is left, an eighth of its
/// product with the square of the aspect ratio, is the hourglass share (1e-5) of the drilling stiffness.
#[test]
fn long_elements_bend_in_their_plane() {
    for (width, band) in [(0.2, 0.9999..=1.0001), (0.04, 0.999..=1.001), (1.0 / 150.0, 0.97..=1.0)] {
        let inertia = 0.1 * f64::powi(width, 3) / 12.0;
        holds(
            &format!("pure bending 1:{width}"),
            18.0 / (1e7 * inertia),
            band,
            "Et",
            |f| {
                let section = shell(1e7 * f.e, 0.0, 0.1 * f.t, 1.0);
                let mut grid = Grid::new(6, 1, section, |s, t| Vector3::new(6.0 * s, width * (t - 0.5), 0.0));
                grid.hold_edges(&CLAMPED, &[], &[], &[]);
                let (below, above) = (grid.node(6, 0), grid.node(6, 1));
                grid.model.push(below, 0, 1.0 / width);
                grid.model.push(above, 0, -1.0 / width);
                grid.model.displacement(below, 1)
            },
        );
    }
}

/// Curved cantilever: radii 4.12 and 4.32, quarter circle, t = 0.1, E = 1e7, nu = 0.25, six elements. References:
/// in-plane 0.08734, out-of-plane 0.5022. QUAD4 in the paper: 0.833 and 0.951. A fine mesh comes to
/// 0.0883 in its plane, as the curved beam with shear does (pi F R^3 / (4 E I) + ... = 0.0886); out of its plane it is
/// still 2 % stiff against the beam's 0.500, because torsion of a bar twice as wide as thick is hard on four elements.
#[test]
fn curved_cantilever() {
    let curved = |n: usize, m: usize, f: Factors| {
        Grid::new(n, m, shell(1e7 * f.e, 0.25, 0.1 * f.t, 1.0), |s, t| {
            let (r, angle) = (4.12 + 0.2 * t, FRAC_PI_2 * (1.0 - s));
            Vector3::new(r * angle.cos(), r * angle.sin(), 0.0)
        })
    };
    for (n, m, direction, reference, ratio) in [
        (6, 1, 0, 0.08734, 0.8875),
        (6, 1, 2, 0.5022, 0.9422),
        (24, 4, 0, 0.08734, 1.0106),
        (24, 4, 2, 0.5022, 0.9791),
    ] {
        holds(
            &format!("curved cantilever {n}x{m}, {direction}"),
            reference,
            about(ratio),
            "Et",
            |f| tip_deflection(curved(n, m, f), direction),
        );
    }
}

/// Twisted cantilever, each element warped: 12 x 1.1, twist 90 degrees, E = 29e6, nu = 0.22, 12 x 2. References:
/// t = 0.32 in-plane 0.005424, out-of-plane 0.001754; later literature adds 1.390 and 0.3431 at t = 0.05, 5256 and 1294
/// at t = 0.0032, which tell whether the links to the mean plane and the drilling stiffness are right. Band 1 % about
/// 1: the class's best give 0.99 to 1.01.
#[test]
fn twisted_cantilever() {
    let twisted = |t: f64, f: Factors| {
        Grid::new(12, 2, shell(29e6 * f.e, 0.22, t * f.t, 1.0), |s, y| {
            let (angle, w) = (FRAC_PI_2 * s, 1.1 * (y - 0.5));
            Vector3::new(12.0 * s, w * angle.cos(), w * angle.sin())
        })
    };
    for (t, in_plane, out_of_plane) in [
        (0.32, 5.424e-3, 1.754e-3),
        (0.05, 1.390, 0.3431),
        (0.0032, 5256.0, 1294.0),
    ] {
        for (direction, reference) in [(2, in_plane), (1, out_of_plane)] {
            holds(
                &format!("twisted cantilever, t = {t}, {direction}"),
                reference,
                0.99..=1.01,
                "Et",
                |f| tip_deflection(twisted(t, f), direction),
            );
        }
    }
}

/// Thin rectangular plates 2 x b, t = 1e-4, E = 1.7472e7, nu = 0.3, a quarter in `n` x `n`; uniform load 1e-4, point
/// load 4e-4 at the centre. References (Timoshenko, Woinowsky-Krieger, in units of 1e-3 q a^4 / D and 1e-3 P a^2 / D):
/// b = 2: supported 4.062, 11.60, clamped 1.265, 5.60; b = 10: supported 12.97, 16.96, clamped 1000/384 (a strip; the
/// paper prints 2.56, the value for b = 4), 7.23. Band: 0.5 % below to 0.5 % above, 1.5 % below where a point load
/// meets elements of 5:1.
#[test]
fn rectangular_plates() {
    for (b, clamped, n, uniform, point) in [
        (2.0, false, 8, 4.062, 11.60),
        (2.0, true, 16, 1.265, 5.60),
        (10.0, false, 16, 12.97, 16.96),
        (10.0, true, 16, 1000.0 / 384.0, 7.23),
    ] {
        let plate = |load: f64, pressure: bool, f: Factors| {
            let section = shell(1.7472e7 * f.e, 0.3, 1e-4 * f.t, 1.0);
            let mut quarter = Grid::new(n, n, section, |s, t| Vector3::new(s, 0.5 * b * t, 0.0));
            quarter.hold_all(&[0, 1, 5]);
            let (right, top): (&[usize], &[usize]) = if clamped {
                (&[2, 3, 4], &[2, 3, 4])
            } else {
                (&[2, 3], &[2, 4])
            };
            quarter.hold_edges(&[4], right, &[3], top);
            let centre = quarter.node(0, 0);
            if pressure {
                quarter
                    .model
                    .push_area(Vector3::new(0.0, 0.0, load), section.thickness_m);
            } else {
                quarter.model.push(centre, 2, 0.25 * load);
            }
            quarter.model.displacement(centre, 2)
        };
        let name = format!("plate 2 x {b}, clamped {clamped}");
        holds(&format!("{name}, uniform"), uniform, 0.995..=1.005, "Et", |f| {
            plate(1e-4, true, f)
        });
        let low = if b > 2.0 { 0.983 } else { 0.995 };
        holds(&format!("{name}, point"), point, low..=1.005, "Et", |f| {
            plate(4e-4, false, f)
        });
    }
}

/// Hemisphere of 10 with a hole of 18 degrees: t = 0.04, E = 6.825e7, nu = 0.3, a quarter under two unit forces, one
/// in, one out. Reference 0.0940 (paper), 0.0935 by later fine meshes (Simo, Fox, Rifai 1989: 0.093). Nearly
/// inextensional: an element with membrane locking or a drilling stiffness that holds gives half of it. The paper's
/// QUAD4 has 0.97 to 1.02 of 0.0940.
#[test]
fn hemisphere_with_a_hole() {
    for (n, ratio) in [(8, 0.988), (16, 0.990), (32, 0.9935)] {
        holds(&format!("hemisphere {n}"), 0.0940, about(ratio), "Et", |f| {
            let mut quarter = Grid::new(n, n, shell(6.825e7 * f.e, 0.3, 0.04 * f.t, 1.0), |s, t| {
                let (around, up) = (FRAC_PI_2 * s, 72_f64.to_radians() * t);
                10.0 * Vector3::new(up.cos() * around.cos(), up.cos() * around.sin(), up.sin())
            });
            quarter.hold_edges(&[1, 3, 5], &[0, 4, 5], &[], &[]);
            let (a, b) = (quarter.node(0, 0), quarter.node(n, 0));
            quarter.model.hold(quarter.node(n / 2, 0), &[2]);
            quarter.model.push(a, 0, 1.0);
            quarter.model.push(b, 1, -1.0);
            quarter.model.displacement(a, 0)
        });
    }
}
