//! A crossing through the operator is the same to the last bit whatever shares its lanes, its thread or its list.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{CrossingSettings, OperatorSolver};
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, Record};
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::OnceLock;

type Answer = Result<CrossingResponse, AnalysisError>;

/// A vehicle and its crossing.
type Job = (Vehicle, SingleCrossing);

fn long() -> &'static Ready {
    static READY: OnceLock<Ready> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&with(&design("smoke"), |d| d.modules = 8), Model::SuperElement))
}

/// A solver on the modes that 0.3 % asks for, so that all that they leave out takes part.
fn solver(change: impl FnOnce(&mut CrossingSettings)) -> OperatorSolver {
    let mut settings = settings(long().rayleigh(), 0.05, 0.9);
    change(&mut settings);
    OperatorSolver::new(&long().bridge, &operator(long(), 3e-3), &settings)
}

/// Crossings of many kinds, two of each vehicle of which there are more than a solver keeps ready.
fn jobs() -> Vec<Job> {
    let mut numbers = Numbers::new(20_051);
    (0..24)
        .map(|i| {
            let inertia = [Inertia::Local, Inertia::None, Inertia::Convective][i % 3];
            let kind = (i % 12) as f64;
            let vehicle = match i % 4 {
                3 => wide_axles(
                    &[(0.2, 0.4, 0.5, 0.3, [-1.0, 1.8]), (3.0, 0.6, 0.6, 0.0, [-1.2, 2.0])],
                    inertia,
                    3,
                ),
                _ => footprint(&[-1.4 + 0.1 * kind, 1.4 + 0.1 * kind], inertia),
            };
            let connection = match i % 6 {
                5 => Connection::Linear,
                _ => gaps(numbers.between(0.0, 0.002), numbers.between(0.0, 0.001)),
            };
            let mut crossing = long().crossing(
                connection,
                numbers.between(0.5, 2.0) * PAPER_LOAD_N,
                numbers.between(4.0, 20.0),
            );
            crossing.tail_s = numbers.between(0.0, 1.0);
            if i % 2 == 0 {
                crossing.record = Record {
                    positions: vec![2, 3],
                    joints: vec![2, 3],
                    ..Record::default()
                };
            }
            (vehicle, crossing)
        })
        .collect()
}

fn alone(solver: &OperatorSolver, jobs: &[Job]) -> Vec<Answer> {
    jobs.iter()
        .map(|(vehicle, crossing)| solver.solve_single(vehicle, crossing))
        .collect()
}

/// Answers to the jobs in an order of their numbers.
fn together(solver: &OperatorSolver, jobs: &[Job], order: &[usize]) -> Vec<Answer> {
    let list: Vec<_> = order.iter().map(|&i| (&jobs[i].0, &jobs[i].1)).collect();
    solve_side_by_side(solver, &list, 0)
}

fn shuffled(count: usize, numbers: &mut Numbers) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, numbers.between(0.0, (i + 1) as f64) as usize);
    }
    order
}

fn same(what: &str, solver: &OperatorSolver, jobs: &[Job], order: &[usize], expected: &[Answer]) {
    for (place, (answer, &i)) in together(solver, jobs, order).iter().zip(order).enumerate() {
        assert_eq!(*answer, expected[i], "{what}: job {i} at place {place} of {order:?}");
    }
}

/// Among others in many orders, in lists of every length about a vector's, beside copies of itself. Two Newton solutions a
/// step, so that steps are halved in some lanes and not in others. Exact: no sum may depend on what stands beside it. Twin:
/// the next larger load.
#[test]
fn answer_does_not_depend_on_what_shares_the_lanes() {
    let (solver, jobs) = (solver(|s| s.newton_limit = 2), jobs());
    let expected = alone(&solver, &jobs);
    let solved: Vec<&CrossingResponse> = expected.iter().flatten().collect();
    let halved = solved.iter().filter(|r| r.statistics.bisections > 0).count();
    println!("{} of {} solved, {halved} with steps halved", solved.len(), jobs.len());
    assert!(
        solved.len() > 12 && halved > 3,
        "{} solved, {halved} halved",
        solved.len()
    );
    let mut numbers = Numbers::new(7);
    for _ in 0..6 {
        let order = shuffled(jobs.len(), &mut numbers);
        same("in another order", &solver, &jobs, &order, &expected);
    }
    for count in 1..=9 {
        let order = shuffled(jobs.len(), &mut numbers);
        same("in a short list", &solver, &jobs, &order[..count], &expected);
    }
    for i in 0..jobs.len() {
        same("beside copies", &solver, &jobs, &[i; 5], &expected);
    }
    let mut other = jobs[0].clone();
    other.1.load_n = other.1.load_n.next_up();
    assert_ne!(
        solver.solve_single(&other.0, &other.1),
        expected[0],
        "one unit in the last place of the load"
    );
}

/// A vehicle without mass after one with mass whose step was halved: nothing of the first is left where the halves are
/// solved. Exact. Every pair of jobs in turn, the one list first to last and the other way.
#[test]
fn halved_steps_leave_nothing_behind() {
    let (solver, jobs) = (solver(|s| s.newton_limit = 2), jobs());
    let expected = alone(&solver, &jobs);
    let halved = |i: &usize| expected[*i].as_ref().is_ok_and(|r| r.statistics.bisections > 0);
    let list: Vec<usize> = (0..jobs.len()).filter(halved).collect();
    let kinds = |inertia: Inertia| list.iter().filter(|i| jobs[**i].0.inertia == inertia).count();
    let counts = [Inertia::None, Inertia::Local, Inertia::Convective].map(kinds);
    assert!(
        counts.iter().all(|&count| count > 0),
        "{counts:?} halved of each inertia"
    );
    for &i in &list {
        for &j in &list {
            // more than any vector has lanes, so that the second follows where the first has been
            let order = [[i; 9], [j; 9]].concat();
            same("one after the other", &solver, &jobs, &order, &expected);
        }
    }
}

/// Threads share nothing that a crossing writes to. Exact.
#[test]
fn threads_share_a_solver() {
    let (solver, jobs) = (solver(|_| ()), jobs());
    let expected = alone(&solver, &jobs);
    let order: Vec<usize> = (0..jobs.len()).collect();
    let lists: Vec<&[usize]> = order.chunks(3).chain(order.chunks(7)).collect();
    // a fresh solver, so that both threads ask for its step lengths at once
    let fresh = self::solver(|_| ());
    let answers = on_two_threads(&lists, |list| together(&fresh, &jobs, list));
    for (list, answers) in lists.iter().zip(answers) {
        for (&i, answer) in list.iter().zip(answers) {
            assert_eq!(answer, expected[i], "job {i}");
        }
    }
}

/// A crossing asked for at a quarter of the time step is the crossing of a solver with that time step. Exact: a quarter is
/// no rounding. Twin: an eighth.
#[test]
fn refined_crossing_is_that_of_the_shorter_step() {
    let (coarse, jobs) = (solver(|_| ()), jobs());
    let fine = solver(|s| s.time_step_s /= 4.0);
    let list: Vec<_> = jobs[..6]
        .iter()
        .map(|(vehicle, crossing)| (vehicle, crossing))
        .collect();
    let expected = solve_side_by_side(&fine, &list, 0);
    assert_eq!(solve_side_by_side(&coarse, &list, 2), expected);
    assert_ne!(solve_side_by_side(&coarse, &list, 3), expected);
}

/// Where no step may be halved and a single Newton solution must do, a connector that closes ends its crossing, at the time
/// and in the connector that the reference solver names too; those beside it go on as if alone. Exact.
#[test]
fn crossing_that_fails_leaves_the_others_alone() {
    let strict = |s: &mut CrossingSettings| (s.newton_limit, s.bisection_limit) = (1, 0);
    let (solver, mut jobs) = (solver(strict), jobs());
    for (i, (_, crossing)) in jobs.iter_mut().enumerate() {
        match i % 3 {
            0 => {}
            1 => crossing.connection = Connection::Linear,
            _ => crossing.connection = gaps(9.0, 9.0),
        }
    }
    let expected = alone(&solver, &jobs);
    let failed = expected
        .iter()
        .filter(|a| matches!(a, Err(AnalysisError::NotConverged { .. })))
        .count();
    assert_eq!((failed, expected.iter().filter(|a| a.is_ok()).count()), (8, 16));
    let mut numbers = Numbers::new(11);
    for _ in 0..6 {
        let order = shuffled(jobs.len(), &mut numbers);
        same("among failures", &solver, &jobs, &order, &expected);
    }
    let mut settings = settings(long().rayleigh(), 0.05, 0.9);
    strict(&mut settings);
    let both = Both::new(long(), &operator(long(), 0.0), &settings);
    for (vehicle, crossing) in jobs.iter().step_by(3) {
        let [operated, reference] = [
            both.operated.solve_single(vehicle, crossing),
            both.reference.solve_single(vehicle, crossing),
        ];
        assert!(
            matches!(reference, Err(AnalysisError::NotConverged { bisections: 0, .. })),
            "{reference:?}"
        );
        assert_eq!(operated, reference);
    }
}
