//! The bridge operator with every mode there is, held against the reference solver: nothing is left out, so that both must
//! give the same motion but for rounding.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::OperatorSolver;
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::{BridgeDesign, Direction, Model};
use pontoon_core::connector::Connection;
use pontoon_core::operator::BridgeOperator;
use pontoon_core::response::{CrossingResponse, PlacedPeak, Record};
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::{Arc, OnceLock};

/// Weight of the vehicle `[N]`.
const LOAD_N: f64 = PAPER_LOAD_N;

/// Rounding. The acceleration of a step is `1/(beta h^2)`, some 4e4 at 10 ms, times a displacement that is exact to 1e-16
/// and enters the next; undamped and at spectral radius 1 nothing takes it out again. Measured: 1e-12 to 1e-11 of
/// deflections and forces with damping, 1.2e-10 of contact forces at worst without.
const ROUNDING: f64 = 1e-9;

const KINDS: [Inertia; 3] = [Inertia::None, Inertia::Local, Inertia::Convective];

/// A bridge with its operator of every mode, beside one of stiffer steel for the twins.
struct Pair {
    right: Ready,
    wrong: Ready,
    operators: [Arc<BridgeOperator>; 2],
}

impl Pair {
    fn new(design: &BridgeDesign) -> Self {
        let of = |factor: f64| Ready::new(&with_e(design, factor), Model::SuperElement);
        let (right, wrong) = (of(1.0), of(1.05));
        let operators = [&right, &wrong].map(|ready| operator(ready, 0.0));
        Self {
            right,
            wrong,
            operators,
        }
    }

    /// Both solvers of the right bridge, the wrong one's operator.
    fn solvers(&self, rayleigh: Rayleigh, h: f64, spectral_radius: f64, newton_limit: usize) -> (Both, OperatorSolver) {
        let mut settings = settings(rayleigh, h, spectral_radius);
        settings.newton_limit = newton_limit;
        let both = Both::new(&self.right, &self.operators[0], &settings);
        (
            both,
            OperatorSolver::new(&self.wrong.bridge, &self.operators[1], &settings),
        )
    }
}

fn smoke() -> &'static Pair {
    static PAIR: OnceLock<Pair> = OnceLock::new();
    PAIR.get_or_init(|| Pair::new(&design("smoke")))
}

/// Holds the operator against the reference solver, in every quantity; the wrong operator as the twin.
fn agree(
    what: &str,
    (both, twin): &(Both, OperatorSolver),
    vehicle: &Vehicle,
    crossing: &SingleCrossing,
) -> [CrossingResponse; 2] {
    let [found, expected] = both.solve(vehicle, crossing).expect("solved");
    let wrong = twin.solve_single(vehicle, crossing).expect("solved");
    let [right, wrong] = [&found, &wrong].map(|r| Apart::of(r, &expected, crossing.load_n).most());
    held(what, ROUNDING, right, wrong);
    assert_eq!(
        found.recorded.history_time_s, expected.recorded.history_time_s,
        "{what}: times of the histories"
    );
    assert_eq!(
        found.statistics, expected.statistics,
        "{what}: steps, solutions, switches, bisections"
    );
    let scale_m = expected.peak_deflection().deflection.value;
    for (found, expected) in found.positions.iter().zip(&expected.positions) {
        assert_eq!((found.position, found.x_m), (expected.position, expected.x_m));
        // of a position that stands still the time is that of rounding
        if expected.deflection.value > 1e-3 * scale_m {
            assert_eq!(
                found.deflection.time_s, expected.deflection.time_s,
                "{what}: time of a peak"
            );
        }
    }
    same_places(what, &found, &expected, scale_m);
    let energies = [&found, &expected].map(|r| r.energy);
    assert!(energies[0].energy_residual < 1e-12, "{what}: {:?}", energies[0]);
    let dissipation = (energies[0].numerical_dissipation - energies[1].numerical_dissipation).abs();
    assert!(
        dissipation < ROUNDING,
        "{what}: numerical dissipation differs by {dissipation:e}"
    );
    [found, expected]
}

/// Times and places of edge, roll, trim and smallest contact force are the reference solver's.
fn same_places(what: &str, found: &CrossingResponse, expected: &CrossingResponse, scale_m: f64) {
    let placed = |r: &CrossingResponse| [r.peak_edge, r.peak_roll, r.peak_trim];
    for (i, (found, expected)) in placed(found).into_iter().zip(placed(expected)).enumerate() {
        // a roll of rounding is anywhere
        if expected.value > 1e-4 * scale_m {
            let of = |peak: PlacedPeak| (peak.at, peak.time_s);
            assert_eq!(of(found), of(expected), "{what}: place and time of peak {i}");
        }
    }
    let least = |r: &CrossingResponse| (r.least_contact.axle, r.least_contact.time_s);
    assert_eq!(
        least(found),
        least(expected),
        "{what}: axle and time of the smallest force"
    );
}

fn crossing(pair: &Pair, connection: Connection) -> SingleCrossing {
    let mut crossing = pair.right.crossing(connection, LOAD_N, 8.0);
    crossing.record = Record {
        positions: vec![1, 2, 3, 4],
        joints: vec![2, 3],
        ..Record::default()
    };
    crossing
}

/// Both wheels on the centre, off it, one wheel on the edge, short patches, patches with a width on lanes of their own.
fn vehicles(inertia: Inertia) -> [(&'static str, Vehicle); 5] {
    let wide = [(0.1, 0.4, 0.5, 0.6, [-1.0, 2.0]), (3.1, 0.6, 0.4, 0.4, [-1.2, 2.2])];
    [
        ("footprint", footprint(&[-1.4, 1.4], inertia)),
        ("off centre", footprint(&[0.3, 3.7], inertia)),
        ("on the edge", footprint(&[4.041], inertia)),
        ("short patches", axles(&[(0.0, 0.4, 0.3), (2.5, 0.6, 0.2)], inertia, 4)),
        ("wide patches", wide_axles(&wide, inertia, 5)),
    ]
}

/// Spectral radii and dampings.
fn schemes() -> [(f64, Rayleigh); 3] {
    let undamped = Rayleigh::new(0.0, 0.0);
    let damped = smoke().right.rayleigh();
    [(0.9, damped), (1.0, damped), (1.0, undamped)]
}

/// Every vehicle, inertia and scheme over connections.
fn all_agree(connections: &[(&str, Connection)]) -> Vec<[CrossingResponse; 2]> {
    let mut answers = Vec::new();
    for (spectral_radius, rayleigh) in schemes() {
        let solvers = smoke().solvers(rayleigh, 0.01, spectral_radius, 40);
        for inertia in KINDS {
            for (name, vehicle) in vehicles(inertia) {
                for (kind, connection) in connections {
                    let what = format!(
                        "{kind}, {name}, {inertia:?}, radius {spectral_radius}, a {:.4}",
                        rayleigh.a
                    );
                    answers.push(agree(&what, &solvers, &vehicle, &crossing(smoke(), *connection)));
                }
            }
        }
    }
    answers
}

/// Connectors that always work or never: the step is linear. Tolerance: [`ROUNDING`]. Twin: the steel's E.
#[test]
fn linear_steps_are_the_reference_solvers() {
    let answers = all_agree(&[("linear", Connection::Linear), ("wide gaps", gaps(9.0, 9.0))]);
    assert!(answers.iter().all(|[r, _]| r.statistics.contact_switches == 0));
}

/// Connectors that open and close: not only until the first contact but to the end, for each step finds the same active set
/// in as many solutions. Tolerance: [`ROUNDING`]; were a switch to fall on another step, 1e-3 of a force would show. Twin:
/// the steel's E.
#[test]
fn contacts_are_the_reference_solvers() {
    let answers = all_agree(&[("gaps", gaps(0.001, 0.0005))]);
    assert!(answers.iter().all(|[r, _]| r.statistics.contact_switches >= 16));
    let solvers = smoke().solvers(smoke().right.rayleigh(), 0.01, 0.9, 40);
    for (name, vehicle) in vehicles(Inertia::Local) {
        agree(
            &format!("the paper's gaps, {name}"),
            &solvers,
            &vehicle,
            &crossing(smoke(), PAPER_GAPS),
        );
    }
}

/// The edges between a module's ends are looked at only where one could be lower than any before; the peak is the true one
/// nevertheless. Wheels from one edge to the other, a deck of half the thickness, stiff connectors: where no corner of a module
/// goes below a freeboard of all but a thousandth of the peak, the peak lies inside. Tolerance: [`ROUNDING`]. Twin: the
/// steel's E.
#[test]
fn edge_inside_a_module_is_not_missed() {
    let edge = |r: &CrossingResponse| r.peak_edge.value;
    let mut inside = 0;
    for modules in [2, 3] {
        let soft = with(&design("smoke"), |d| {
            d.modules = modules;
            d.module.deck_thickness_m *= 0.5;
        });
        let pair = Pair::new(&soft);
        let solvers = pair.solvers(pair.right.rayleigh(), 0.01, 0.9, 40);
        for y_m in [-4.041, -3.9, -2.5, 0.0, 1.1, 3.3, 4.041] {
            for inertia in KINDS {
                let mut crossing = pair.right.crossing(Connection::Linear, LOAD_N, 12.0);
                crossing.connector_stiffness_n_m *= 100.0;
                let what = format!("{modules} modules, wheel at {y_m}, {inertia:?}");
                let [found, _] = agree(&what, &solvers, &footprint(&[y_m], inertia), &crossing);
                let above = with(&soft, |d| d.freeboard_m = Some(0.999 * edge(&found)));
                // the operator knows the matrices and no freeboard
                let bridge = Ready::new(&above, Model::SuperElement).bridge;
                let settings = settings(pair.right.rayleigh(), 0.01, 0.9);
                let operated = OperatorSolver::new(&bridge, &pair.operators[0], &settings);
                let again = operated
                    .solve_single(&footprint(&[y_m], inertia), &crossing)
                    .expect("solved");
                assert_eq!(edge(&again), edge(&found), "{what}: a freeboard moves nothing");
                inside += usize::from(again.deck_submerged == Some(false));
            }
        }
    }
    println!("{inside} of 42 peaks lie inside a module");
    assert!(inside >= 10, "{inside} of 42 peaks lie inside a module");
}

/// Steps of 50 ms, two Newton solutions: where the contact needs a third they are halved, the halves solved apart from the
/// other lanes and the whole resumed. Tolerance: [`ROUNDING`], with as many halvings as the reference solver's. Twin: the
/// steel's E.
#[test]
fn halved_steps_are_the_reference_solvers() {
    let pair = Pair::new(&with(&design("smoke"), |d| d.modules = 6));
    let solvers = pair.solvers(pair.right.rayleigh(), 0.05, 0.9, 2);
    let mut halved = [0; 3];
    for (halved, inertia) in halved.iter_mut().zip(KINDS) {
        for speed_m_s in [6.0, 9.0, 13.0, 17.0] {
            let mut crossing = crossing(&pair, gaps(0.0005, 0.0002));
            crossing.speed_m_s = speed_m_s;
            let what = format!("two solutions a step, {inertia:?}, {speed_m_s} m/s");
            let [found, _] = agree(&what, &solvers, &footprint(&[-0.4, 2.4], inertia), &crossing);
            *halved += found.statistics.bisections;
        }
    }
    println!("{halved:?} steps halved");
    assert!(halved.iter().all(|&count| count > 0), "{halved:?} steps halved");
}

/// One solution a step and no halving, or halving that does not help: the same failure as the reference solver's, its time,
/// connector and halvings. Exact.
#[test]
fn unsettled_contact_is_the_reference_solvers() {
    for bisection_limit in [0, 3] {
        let mut settings = settings(smoke().right.rayleigh(), 0.01, 0.9);
        (settings.newton_limit, settings.bisection_limit) = (1, bisection_limit);
        let both = Both::new(&smoke().right, &smoke().operators[0], &settings);
        for inertia in KINDS {
            let (vehicle, crossing) = (footprint(&[-1.4, 1.4], inertia), crossing(smoke(), gaps(0.001, 0.0005)));
            let [found, expected] = [
                both.operated.solve_single(&vehicle, &crossing),
                both.reference.solve_single(&vehicle, &crossing),
            ];
            let named = matches!(expected, Err(AnalysisError::NotConverged { bisections, .. }) if bisections == bisection_limit);
            assert!(named, "{expected:?}");
            assert_eq!(found, expected);
        }
    }
}

/// Nothing holds the bridge along, or along and across: its stiffness is singular, its operator stands on a shifted one.
/// Tolerance: [`ROUNDING`]. Twin: the steel's E.
#[test]
fn bridge_that_floats_freely_has_an_operator() {
    for held in [&[Direction::Y, Direction::Z][..], &[Direction::Z]] {
        let free = with(&design("smoke"), |d| {
            (d.supports.left, d.supports.right) = (held.to_vec(), held.to_vec());
        });
        let pair = Pair::new(&free);
        let solvers = pair.solvers(pair.right.rayleigh(), 0.01, 0.9, 40);
        for connection in [Connection::Linear, gaps(0.001, 0.0005)] {
            for inertia in KINDS {
                let what = format!("{held:?} held, {connection:?}, {inertia:?}");
                agree(
                    &what,
                    &solvers,
                    &footprint(&[0.3, 3.1], inertia),
                    &crossing(&pair, connection),
                );
            }
        }
        assert_eq!(pair.operators[0].cutoff().modes, pair.right.bridge.dofs());
    }
}

/// Whether a corner of the bottom came out of the water or one of the deck went under: as the reference solver says, for
/// drafts and freeboards on both sides of the change.
#[test]
fn water_lines_are_the_reference_solvers() {
    let mut answers = Vec::new();
    for share in [0.2, 0.5, 0.8, 0.95, 1.05, 2.0] {
        let d = with(&design("smoke"), |d| {
            (d.draft_m, d.freeboard_m) = (Some(0.15 * share), Some(0.3 * share))
        });
        let ready = Ready::new(&d, Model::SuperElement);
        let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), 0.01, 0.9));
        let vehicle = footprint(&[0.3, 3.1], Inertia::Local);
        let [found, expected] = both
            .solve(&vehicle, &ready.crossing(PAPER_GAPS, LOAD_N, 12.0))
            .expect("solved");
        let of = |r: &CrossingResponse| (r.bottom_emerged, r.deck_submerged);
        assert_eq!(of(&found), of(&expected), "at {share}");
        answers.push(of(&found));
    }
    println!("{answers:?}");
    for change in [
        answers.iter().map(|a| a.0).collect::<Vec<_>>(),
        answers.iter().map(|a| a.1).collect(),
    ] {
        assert!(
            change.first() == Some(&Some(true)) && change.last() == Some(&Some(false)),
            "{change:?}"
        );
    }
}
