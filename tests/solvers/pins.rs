//! Forces of the pins: free bodies in equilibrium, the operator beside the reference solver, numbers of independent codes.
//!
//! Knows bridges, what acts on their modules and what pins must carry. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::OperatorSolver;
use pontoon_core::analysis::statics::StaticSolver;
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::Connection;
use pontoon_core::operator::{BridgeOperator, Followed};
use pontoon_core::response::{Axis, CrossingResponse, PeakOf, PinPeaks, Record, Section, Subject, WatchedPeak};
use pontoon_core::stop::Stop;
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::chain::Chain;
use pontoon_tests::*;
use std::sync::Arc;

/// The operator of a bridge with its pins.
fn operator(ready: &Ready, tolerance: f64) -> Arc<BridgeOperator> {
    let followed = Followed {
        pins: true,
        places_x_m: PLACES_X_M.to_vec(),
    };
    let made = BridgeOperator::new_unless(&ready.bridge, tolerance, &followed, Stop::never());
    Arc::new(made.expect("an operator"))
}

/// Places that are followed: at a joint, inside a module, near the end.
const PLACES_X_M: [f64; 3] = [6.7, 9.4, 39.9];

/// A crossing that records its pins and all that comes with them.
fn with_pins(crossing: SingleCrossing) -> SingleCrossing {
    let watched = |of: PeakOf, number: Option<usize>| WatchedPeak { of, number };
    SingleCrossing {
        record: Record {
            pins: true,
            sections: true,
            places_x_m: PLACES_X_M.to_vec(),
            more: vec![
                Subject::Pin {
                    joint: 3,
                    index: 1,
                    axis: Axis::Z,
                },
                Subject::Place(1),
                Subject::Section {
                    joint: 4,
                    of: Section::Bending,
                },
            ],
            at_peaks: vec![
                watched(PeakOf::Deflection, None),
                watched(PeakOf::Compression, Some(3)),
                watched(PeakOf::Pin, None),
            ],
            ..Record::default()
        },
        ..crossing
    }
}

/// Extremes of section forces of one kind, or of the angles. Axial force, shear across and lateral bending are what is
/// left of pins and connectors of far larger forces, so that the largest force of a pin, with a lever of 1 m, stands beside
/// them.
fn sections(r: &CrossingResponse, of: Section) -> Vec<f64> {
    let own = r.recorded.sections.iter().filter(|peaks| peaks.of == of);
    let mut found: Vec<f64> = own
        .flat_map(|peaks| [peaks.peaks.compression.value, peaks.peaks.tension.value])
        .collect();
    if matches!(of, Section::Axial | Section::ShearY | Section::LateralBending) {
        found.push(largest(extremes(r.pins.iter())));
    }
    found
}

/// Largest deflection and uplift of each place.
fn places(r: &CrossingResponse) -> Vec<f64> {
    let each = r.recorded.places.iter();
    each.flat_map(|place| [place.deflection.value, place.uplift.value])
        .collect()
}

/// Six modules of smoke's.
fn six() -> BridgeDesign {
    with(&design("smoke"), |d| d.modules = 6)
}

/// Both solvers' answers.
fn both(ready: &Ready, tolerance: f64, vehicle: &Vehicle, crossing: &SingleCrossing) -> [CrossingResponse; 2] {
    let settings = settings(ready.rayleigh(), 0.01, 0.9);
    let operated = OperatorSolver::new(&ready.bridge, &operator(ready, tolerance), &settings);
    let reference = ready.crossings(vehicle, &settings);
    [
        operated.solve_single(vehicle, crossing).expect("solved"),
        reference.solve(crossing).expect("solved"),
    ]
}

/// All extremes of some pins `[N]`.
fn extremes<'a>(pins: impl Iterator<Item = &'a PinPeaks>) -> Vec<f64> {
    let of = |pin: &PinPeaks| {
        let sides = pin.extremes.components.map(|c| [c.compression.value, c.tension.value]);
        sides
            .into_iter()
            .flatten()
            .chain([pin.extremes.resultant.value])
            .collect::<Vec<_>>()
    };
    pins.flat_map(of).collect()
}

/// Statics: the pins of a joint with its connectors carry what the part left of it lacks, along and up. Along, nothing acts on
/// the part left of a joint but its support, so that pins and connectors add up to the same force at every joint. Up, the
/// pins carry load, water and support of the part. By hand from the response's own equilibrium. Tolerance: 1e-10 of the
/// load. Twin: 5 % more load.
#[test]
fn pins_carry_what_the_free_body_lacks_at_rest() {
    let ready = Ready::new(&six(), Model::SuperElement);
    let solver = StaticSolver::new(&ready.bridge).expect("statics");
    let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
    for connection in [Connection::Linear, gaps(0.002, 0.001)] {
        for place in 0..=12 {
            let case = ready.case(connection, PAPER_LOAD_N, 3.35 * f64::from(place));
            let answer = solver.solve(&vehicle, &case).expect("solved");
            let per_joint = ready.design.hinges.y_m.len();
            let mut along = Vec::new();
            for (pins, joint) in answer.pins_n.chunks(per_joint).zip(&answer.joints) {
                // the pin pushes the left module, the connector pulls it
                along.push(pins.iter().map(|force| force[0]).sum::<f64>() + joint.sum_n);
            }
            let off = largest(along.iter().map(|force| force.abs())) / PAPER_LOAD_N;
            assert!(off < 1e-10, "{connection:?} {place}: {along:?}");
        }
    }
}

/// Crossings: the operator beside the reference solver, all modes kept (rounding but for the inertia of nothing left out) and
/// as studies have it (1 % of the largest pin force, half a per cent for the sums over a joint). Twin: 5 % more load.
#[test]
fn operator_finds_the_pins_of_the_reference_solver() {
    let ready = Ready::new(&six(), Model::SuperElement);
    for (tolerance, each, sums) in [(0.0, 1e-8, 1e-8), (6e-4, 1e-2, 5e-3)] {
        for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
            let vehicle = footprint(&[-0.4, 2.4], inertia);
            let asked = with_pins(ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, 8.0));
            let heavy = SingleCrossing {
                load_n: 1.05 * asked.load_n,
                ..asked.clone()
            };
            let [found, expected] = both(&ready, tolerance, &vehicle, &asked);
            let [heavier, _] = both(&ready, tolerance, &vehicle, &heavy);
            let pins_at = |r: &[PinPeaks]| r.iter().map(|pin| (pin.joint, pin.y_m)).collect::<Vec<_>>();
            assert_eq!(pins_at(&found.pins), pins_at(&expected.pins));
            assert_eq!(found.pins.len(), 5 * 4);
            for (what, allowed, is_sum) in [("pins", each, false), ("joints", sums, true)] {
                let of = |r: &CrossingResponse| extremes(r.pins.iter().filter(|pin| pin.y_m.is_none() == is_sum));
                let [right, wrong] = [&found, &heavier].map(|r| apart(&of(r), &of(&expected)));
                held(
                    &format!("{what}, {inertia:?}, tolerance {tolerance}"),
                    allowed,
                    right,
                    wrong,
                );
            }
            for of in Section::ALL {
                let [right, wrong] = [&found, &heavier].map(|r| apart(&sections(r, of), &sections(&expected, of)));
                held(
                    &format!("{of:?}, {inertia:?}, tolerance {tolerance}"),
                    each,
                    right,
                    wrong,
                );
            }
            let [right, wrong] = [&found, &heavier].map(|r| apart(&places(r), &places(&expected)));
            held(
                &format!("places, {inertia:?}, tolerance {tolerance}"),
                sums,
                right,
                wrong,
            );
            let curve = |r: &CrossingResponse, i: usize| r.recorded.histories[i].values.clone();
            for i in 0..3 {
                let [right, wrong] = [&found, &heavier].map(|r| apart(&curve(r, i), &curve(&expected, i)));
                held(
                    &format!("history {i}, {inertia:?}, tolerance {tolerance}"),
                    2.0 * each,
                    right,
                    wrong,
                );
            }
        }
    }
}

/// The plane chain: numbers of two independent codes, a plain prototype and one of OpenSees elements. A static load whose centre
/// stands at 43.55 m, and at position 7; a crossing at 3 m/s. Tolerances: statics 5e-4 (asked of other codes: 0.5 %), crossings 3 %
/// of the largest, as a patch's points pass the joint one by one. Twin: 5 % more load.
#[test]
fn pins_of_the_chain_are_those_of_independent_codes() {
    let chain = Chain::read();
    let (ready, vehicle) = (chain.ready(), chain.vehicle());
    let statics = ready.statics(&vehicle);
    let of_joint = |pins: &[[f64; 3]], joint: usize, axis: usize| -> f64 {
        pins[2 * (joint - 2)..][..2].iter().map(|force| force[axis] / 1e3).sum()
    };
    for (x_m, expected) in [
        (43.55, [302.907, -77.097, 77.097]),
        (6.0 * 6.7, [519.105, 0.0, f64::NAN]),
    ] {
        let found = |factor: f64| {
            let case = ready.case(chain.connection(false), factor * chain.weight_n, x_m);
            let pins = statics.solve(&case).expect("solved").pins_n;
            [of_joint(&pins, 7, 0), of_joint(&pins, 7, 2), of_joint(&pins, 8, 2)]
        };
        let known = if expected[2].is_nan() { 2 } else { 3 };
        let [right, wrong] = [1.0, 1.05].map(|factor| apart(&found(factor)[..known], &expected[..known]));
        held(&format!("statics at {x_m} m"), 5e-4, right, wrong);
    }
    let crossings = ready.crossings(&vehicle, &settings(chain.rayleigh, 0.0025, 0.9));
    let found = |factor: f64| {
        let mut asked = with_pins(ready.crossing(chain.connection(false), factor * chain.weight_n, 3.0));
        asked.tail_s = chain.tail_s;
        asked.record.more.clear();
        asked.record.places_x_m.clear();
        let r = crossings.solve(&asked).expect("solved");
        let sum = r
            .pins
            .iter()
            .find(|pin| pin.joint == 7 && pin.y_m.is_none())
            .expect("joint 7");
        let [x, _, z] = sum.extremes.components;
        let angle = r
            .recorded
            .sections
            .iter()
            .find(|of| of.joint == 7 && of.of == Section::Angle);
        let angle = angle.expect("an angle").peaks;
        println!("{angle:?}");
        [
            // milliradians by their own largest, so that all numbers count alike
            557.0 / 25.6 * 1e3 * angle.tension.value,
            557.0 / 16.1 * 1e3 * angle.compression.value,
            x.tension.value / 1e3,
            z.compression.value / 1e3,
            z.tension.value / 1e3,
            100.0 * z.compression.time_s / 14.45,
            100.0 * z.tension.time_s / 13.38,
        ]
    };
    let expected = [557.0, 557.0, 557.0, 95.2, 96.8, 100.0, 100.0];
    let [right, wrong] = [1.0, 1.05].map(found);
    println!("{right:?}");
    held("3 m/s", 3e-2, apart(&right, &expected), apart(&wrong, &expected));
}

/// What is told of the instant of a peak is what histories have then, in both solvers: bit for bit. The peak itself is among it.
#[test]
fn the_response_at_a_peak_is_that_of_the_histories() {
    let ready = Ready::new(&six(), Model::SuperElement);
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let asked = with_pins(ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, 8.0));
    for r in both(&ready, 6e-4, &vehicle, &asked) {
        let recorded = &r.recorded;
        for at in &recorded.at_peaks {
            let told = |subject: Subject| at.numbers.iter().find(|(of, _)| *of == subject).expect("told").1;
            for history in &recorded.histories {
                let (times, time_s) = if history.subject.is_of_balance() {
                    (&recorded.balance_time_s, at.balance_s)
                } else {
                    (&recorded.history_time_s, at.time_s)
                };
                let step = times.iter().position(|t| *t == time_s).expect("a step");
                assert_eq!(history.values[step], told(history.subject), "{:?}", at.peak);
            }
            let expected = match at.peak.of {
                PeakOf::Deflection => r.peak_deflection().deflection.value,
                PeakOf::Compression => r.joints[1].sum.compression.value,
                _ => r
                    .pins
                    .iter()
                    .filter(|pin| pin.y_m.is_some())
                    .map(|pin| pin.extremes.resultant.value)
                    .fold(0.0, f64::max),
            };
            // vectors and numbers add squares in another order
            assert!(
                (at.largest - expected).abs() <= 1e-15 * expected,
                "{:?}: {} {expected}",
                at.peak,
                at.largest
            );
        }
        assert_eq!(recorded.at_peaks.len(), 3);
        // a place at a joint is its position
        assert_eq!(recorded.places[0].deflection, r.positions[1].deflection);
    }
}
