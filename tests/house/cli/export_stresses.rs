//! `pontoon export --stresses`: the arrays against formulas written out by hand from the file's own mesh and motion, the
//! envelope against its instants, and what is refused.

use super::export_stage::{Grid, collection, contents, crossings, exported, names, refused, static_cases};
use crate::stage::Stage;
use serde_json::{Value, json};
use std::fs;

const SHELL_ARRAYS: [&str; 9] = [
    "membrane_11_pa",
    "membrane_22_pa",
    "membrane_12_pa",
    "bending_11_pa",
    "bending_22_pa",
    "bending_12_pa",
    "von_mises_top_pa",
    "von_mises_bottom_pa",
    "von_mises_pa",
];

/// A mesh with its motion and stresses: cells are rectangles and then lines.
struct Mesh {
    grid: Grid,
    points: Vec<[f64; 3]>,
    moved: Vec<[f64; 3]>,
    /// Points of each cell.
    cells: Vec<Vec<usize>>,
}

impl Mesh {
    fn read(stage: &Stage, file: &str) -> Self {
        let grid = Grid::read(&stage.path(file));
        let triples = |name: &str| grid.numbers(name).chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
        let nodes: Vec<usize> = grid.numbers("connectivity").iter().map(|&n| n as usize).collect();
        let ends: Vec<usize> = grid.numbers("offsets").iter().map(|&n| n as usize).collect();
        let begins = std::iter::once(&0).chain(&ends);
        Self {
            points: triples("points"),
            moved: triples("displacement"),
            cells: begins.zip(&ends).map(|(&from, &to)| nodes[from..to].to_vec()).collect(),
            grid,
        }
    }

    fn shells(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let cells = self.cells.iter().map(Vec::as_slice).enumerate();
        cells.filter(|(_, nodes)| nodes.len() == 4)
    }

    fn beams(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let cells = self.cells.iter().map(Vec::as_slice).enumerate();
        cells.filter(|(_, nodes)| nodes.len() == 2)
    }

    /// Direction in which two points are apart, and how far.
    fn between(&self, a: usize, b: usize) -> (usize, f64) {
        let apart = |d: usize| self.points[b][d] - self.points[a][d];
        let along = (0..3)
            .max_by(|&i, &j| apart(i).abs().total_cmp(&apart(j).abs()))
            .unwrap();
        (along, apart(along))
    }
}

fn largest(list: impl Iterator<Item = f64>) -> f64 {
    list.fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// A check with its twin: what is right misses by no more than the tolerance, what is wrong by more.
fn held(what: &str, tolerance: f64, right: f64, wrong: f64) {
    assert!(
        right <= tolerance && wrong > tolerance,
        "{what}: {right:.1e}, the twin {wrong:.1e}"
    );
}

/// E and Poisson's ratio of the stage's bridge.
fn material(stage: &Stage) -> [f64; 2] {
    let material = &stage.bridge["module"]["material"];
    ["youngs_modulus_pa", "poissons_ratio"].map(|key| material[key].as_f64().unwrap())
}

/// Membrane stress in the middle of a rectangle from the mean motion of its sides: how far the written arrays miss it, over
/// the largest.
fn membrane_miss(mesh: &Mesh, [e, nu]: [f64; 2]) -> f64 {
    let written = ["membrane_11_pa", "membrane_22_pa", "membrane_12_pa"].map(|name| mesh.grid.numbers(name));
    let size = largest(written.iter().flatten().copied());
    let misses = mesh.shells().flat_map(|(cell, n)| {
        let ((one, a), (two, b)) = (mesh.between(n[0], n[1]), mesh.between(n[0], n[3]));
        let mean = |d: usize, [i, j, k, l]: [usize; 4]| {
            let u = |node: usize| mesh.moved[n[node]][d];
            0.5 * (u(i) + u(j) - u(k) - u(l))
        };
        let (e_1, e_2) = (mean(one, [1, 2, 0, 3]) / a, mean(two, [2, 3, 0, 1]) / b);
        let g = mean(two, [1, 2, 0, 3]) / a + mean(one, [2, 3, 0, 1]) / b;
        let c = e / (1.0 - nu * nu);
        let expected = [c * (e_1 + nu * e_2), c * (e_2 + nu * e_1), 0.5 * e / (1.0 + nu) * g];
        [0, 1, 2].map(|i| written[i][cell] - expected[i])
    });
    largest(misses) / size
}

/// Von Mises stress from principal stresses, `sqrt((s_1^2 + s_2^2 + (s_1 - s_2)^2) / 2)`.
fn von_mises_pa([x, y, xy]: [f64; 3]) -> f64 {
    let (mean, radius) = (0.5 * (x + y), (0.5 * (x - y)).hypot(xy));
    let (one, two) = (mean + radius, mean - radius);
    (0.5 * (one * one + two * two + (one - two) * (one - two))).sqrt()
}

/// How far the von Mises arrays miss what membrane and bending make, over the largest; bending times a factor.
fn von_mises_miss(mesh: &Mesh, factor: f64) -> f64 {
    let [m_11, m_22, m_12, b_11, b_22, b_12, top, bottom, most] = SHELL_ARRAYS.map(|name| mesh.grid.numbers(name));
    let size = largest(most.iter().copied());
    let misses = mesh.shells().flat_map(|(i, _)| {
        let side = |sign: f64| {
            let s = sign * factor;
            von_mises_pa([m_11[i] + s * b_11[i], m_22[i] + s * b_22[i], m_12[i] + s * b_12[i]])
        };
        let (up, down) = (side(1.0), side(-1.0));
        [top[i] - up, bottom[i] - down, most[i] - up.max(down)]
    });
    largest(misses) / size
}

/// Axial force of a beam from how far its ends part, over the largest.
fn axial_miss(mesh: &Mesh, axial_stiffness_n: f64) -> f64 {
    let written = mesh.grid.numbers("axial_force_n");
    let misses = mesh.beams().map(|(cell, n)| {
        let (along, length) = mesh.between(n[0], n[1]);
        written[cell] - axial_stiffness_n * (mesh.moved[n[1]][along] - mesh.moved[n[0]][along]) / length
    });
    largest(misses) / largest(written.iter().copied())
}

/// Bending of a plate whose four sides carry stiffeners: those turn with it, so that their moments give its curvatures,
/// `-M_3 / (E I)` along each of them. Number of such plates, and the largest miss of
/// `(E t / 2) / (1 - nu^2) (k_1 + nu k_2)` and the other way round over the largest.
fn bending_miss(mesh: &Mesh, [e, nu]: [f64; 2], second_moment_m4: f64) -> (usize, f64) {
    let moment = mesh.grid.numbers("moment_3_newton_m");
    let thickness = mesh.grid.numbers("thickness_m");
    let plate = mesh.grid.numbers("plate");
    let written = ["bending_11_pa", "bending_22_pa"].map(|name| mesh.grid.numbers(name));
    let of_beam = |a: usize, b: usize| {
        let mut beams = mesh.beams();
        let found = beams.find(|(_, n)| (n[0] == a && n[1] == b) || (n[0] == b && n[1] == a));
        found.map(|(cell, _)| moment[cell] / (e * second_moment_m4))
    };
    let (mut plates, mut off, mut size) = (0, 0.0_f64, 0.0_f64);
    // deck and bottom
    for (cell, n) in mesh.shells().filter(|(cell, _)| plate[*cell] < 2.0) {
        let sides = [(0, 1), (3, 2), (0, 3), (1, 2)].map(|(a, b)| of_beam(n[a], n[b]));
        let [Some(near), Some(far), Some(left), Some(right)] = sides else {
            continue;
        };
        let (k_1, k_2) = (-0.5 * (near + far), -0.5 * (left + right));
        let c = 0.5 * e * thickness[cell] / (1.0 - nu * nu);
        for (written, expected) in [(&written[0], k_1 + nu * k_2), (&written[1], k_2 + nu * k_1)] {
            off = off.max((written[cell] - c * expected).abs());
            size = size.max(written[cell].abs());
        }
        plates += 1;
    }
    (plates, off / size)
}

/// Single precision of displacements, 1e-9 m, on elements of half a metre makes 2e-9 of strain beside 3e-4: 1e-4. Stresses
/// among themselves 3e-7, single precision. Twins: E, Poisson's ratio, A, I and bending 5 % off.
#[test]
fn stresses_of_a_static_study_are_those_of_the_motion_in_the_file() {
    let stage = static_cases();
    stage.ran("out");
    let told = exported(
        &stage,
        &["out", "--to", "vtk", "--job", "1", "--count", "0", "--stresses"],
    );
    assert_eq!(told["parts"].as_array().unwrap().len(), 3);
    let mesh = Mesh::read(&stage, "vtk/static-001.vtu");
    assert_eq!((mesh.shells().count(), mesh.beams().count()), (258, 348));
    let [e, nu] = material(&stage);
    for (what, wrong) in [("E", [1.05 * e, nu]), ("Poisson", [e, 1.05 * nu])] {
        let [right, wrong] = [[e, nu], wrong].map(|material| membrane_miss(&mesh, material));
        held(&format!("membrane, {what}"), 1e-4, right, wrong);
    }
    let [right, wrong] = [1.0, 1.05].map(|factor| von_mises_miss(&mesh, factor));
    held("von Mises", 3e-7, right, wrong);
    let stiffeners = &stage.bridge["module"]["stiffeners"];
    let [area, second_moment] = ["area_m2", "second_moment_m4"].map(|key| stiffeners[key].as_f64().unwrap());
    let [right, wrong] = [1.0, 1.05].map(|factor| axial_miss(&mesh, factor * e * area));
    held("axial force", 1e-4, right, wrong);
    let [(plates, right), (_, wrong)] = [1.0, 1.05].map(|factor| bending_miss(&mesh, [e, nu], factor * second_moment));
    held("bending", 3e-7, right, wrong);
    assert_eq!(plates, 48);
    // a number of shells is 0 of a beam, and the other way round
    let first_beam = mesh.shells().count();
    assert!(
        SHELL_ARRAYS
            .iter()
            .all(|name| mesh.grid.numbers(name)[first_beam..].iter().all(|s| *s == 0.0))
    );
    assert!(
        mesh.grid.numbers("axial_force_n")[..first_beam]
            .iter()
            .all(|n| *n == 0.0)
    );
    let contents: Value = serde_json::from_slice(&fs::read(stage.path("vtk/export.json")).unwrap()).unwrap();
    let words = contents["stresses"].to_string();
    assert!(SHELL_ARRAYS.iter().all(|name| words.contains(name)), "{words}");
}

/// The envelope is over all steps, however many are shown; with all of them shown it is the largest of what is shown, to the
/// last bit. Twin: a step later the
/// stress is another.
#[test]
fn an_envelope_of_a_crossing_is_the_largest_of_all_its_steps() {
    let stage = crossings();
    stage.ran("out");
    let job = ["out", "--job", "1", "--count", "0"];
    let told = exported(
        &stage,
        &[&job[..], &["--to", "all", "--every", "1", "--stresses"]].concat(),
    );
    assert_eq!(told["parts"][0]["file"], json!("crossing-envelope.pvd"));
    exported(
        &stage,
        &[&job[..], &["--to", "few", "--every", "7", "--stresses"]].concat(),
    );
    let envelope = Grid::read(&stage.path("all/crossing-envelope-001.vtu"));
    let found = ["von_mises_pa", "von_mises_time_s"].map(|name| envelope.numbers(name));
    let steps = collection(&stage.path("all/crossing.pvd"));
    let words = format!(
        "crossing: largest von Mises stress of each shell at {} time steps",
        steps.len()
    );
    assert_eq!(told["parts"][0]["shows"], json!(words));
    let shown = steps
        .iter()
        .map(|(_, file)| Grid::read(&stage.path("all").join(file)).numbers("von_mises_pa"));
    let shown: Vec<Vec<f64>> = shown.collect();
    let mut elsewhere = 0;
    for cell in 0..258 {
        let most = shown.iter().fold(0.0_f64, |most, now| most.max(now[cell]));
        assert!(most > 1e5 && found[0][cell] == most, "{} {most}", found[0][cell]);
        let step = steps.iter().position(|(time, _)| *time == found[1][cell]).unwrap();
        assert_eq!(shown[step][cell], most);
        elsewhere += usize::from(shown[step + 1][cell] != most);
    }
    assert!(elsewhere > 250, "{elsewhere}");
    let few = Grid::read(&stage.path("few/crossing-envelope-001.vtu"));
    assert_eq!(
        ["von_mises_pa", "von_mises_time_s"].map(|name| few.numbers(name)),
        found
    );
    let shown = collection(&stage.path("few/crossing.pvd"));
    assert_eq!(shown.len(), 1 + (steps.len() - 1).div_ceil(7));
}

/// Files of an export without stresses are those of one with them but for arrays that are added.
#[test]
fn stresses_come_on_demand_and_change_nothing_else() {
    let stage = Stage::new();
    stage.write();
    let load = ["bridge.json", "--count", "2", "--load-n", "1e5", "--load-position", "2"];
    exported(&stage, &[&load[..], &["--to", "plain"]].concat());
    exported(&stage, &[&load[..], &["--to", "stressed", "--stresses"]].concat());
    let (plain, stressed) = (contents(&stage.path("plain")), contents(&stage.path("stressed")));
    assert_eq!(names(&stage.path("plain")), names(&stage.path("stressed")));
    let differ = plain.iter().filter(|(name, bytes)| stressed[*name] != **bytes);
    assert_eq!(
        differ.map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        ["export.json", "static-001.vtu"]
    );
    let head = String::from_utf8_lossy(&plain["static-001.vtu"]).into_owned();
    assert!(!head.contains("_pa\"") && !String::from_utf8_lossy(&plain["export.json"]).contains("stresses"));
    let grids = ["plain", "stressed"].map(|folder| Grid::read(&stage.path(folder).join("static-001.vtu")));
    for name in ["points", "displacement", "plate", "thickness_m", "module"] {
        assert_eq!(grids[0].raw(name), grids[1].raw(name), "{name}");
    }
    let allowed = "a static case or a crossing with it";
    for words in [
        &["bridge.json", "--stresses"][..],
        &["bridge.json", "--count", "3", "--supports", "--stresses"],
    ] {
        refused(&stage, words, &["bridge.json: --stresses", "modes alone", allowed]);
    }
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "modes", "model": "super-element", "count": 5 });
    stage.study["design"] = json!([{ "cases": [{ "bridge.modules": 2 }] }]);
    stage.study["record"] = json!({});
    stage.ran("out");
    refused(
        &stage,
        &["out", "--stresses"],
        &["out: --stresses", "modes alone", allowed],
    );
}
