//! Prints what the operator's crossings cost on one thread of this machine, and what its core could do at most, as one JSON
//! document: `speed [seconds for each figure]`. scripts/bench reads it.
//!
//! Knows a clock, which no test does. Does not know what another code needs, nor what is asked.

#![allow(clippy::expect_used)]

use pontoon_core::operator::{InstructionPath, StepClock, StepPart};
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::scenario::{OPERATOR_TOLERANCE, Scenario, TAIL_S, TIME_STEP_S, truck, vehicle, vehicle_off_centre};
use pontoon_tests::{SingleCrossing, SolvesSingle, solve_side_by_side};
use pulp::{Arch, Simd, WithSimd};
use serde_json::{Value, json};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let seconds = std::env::args()
        .nth(1)
        .map_or(0.5, |word| word.parse().expect("seconds"));
    let path = InstructionPath::of_this_machine();
    let start = Instant::now();
    let scenario = Scenario::new();
    let ready_s = start.elapsed().as_secs_f64();
    let mut crossings = Vec::new();
    for speed_m_s in [15.0, 7.0] {
        let crossing = scenario.crossing(speed_m_s, scenario.everything());
        for (inertia, place, vehicle) in [
            (Inertia::None, "centred", vehicle(Inertia::None)),
            (Inertia::Local, "centred", vehicle(Inertia::Local)),
            (Inertia::Convective, "centred", vehicle(Inertia::Convective)),
            (Inertia::Local, "off the centre", vehicle_off_centre(Inertia::Local)),
        ] {
            let mut of = figures(&scenario, &vehicle, &crossing, seconds);
            (of["inertia"], of["place"]) = (json!(inertia), json!(place));
            crossings.push(of);
        }
    }
    let report = json!({
        "instructions": path.name,
        "lanes": path.lanes,
        "time_step_s": TIME_STEP_S,
        "tail_s": TAIL_S,
        "ready_s": ready_s,
        "operator": {
            "tolerance": OPERATOR_TOLERANCE,
            "modes": scenario.solver.operator().cutoff().modes,
        },
        "crossings": crossings,
        "trucks": trucks(&scenario, seconds),
        "breakdown": breakdown(&scenario, seconds),
        "peak_flop_per_s": peak_flop_per_s(seconds),
    });
    println!("{report}");
}

/// Seconds a step of a crossing alone, beside its likes, and beside crossings of other speeds, whose vehicles are at other places.
fn figures(scenario: &Scenario, vehicle: &Vehicle, crossing: &SingleCrossing, seconds: f64) -> Value {
    let (solver, lanes) = (&scenario.solver, InstructionPath::of_this_machine().lanes);
    let solve = |jobs: &[(&Vehicle, &SingleCrossing)]| drop(black_box(solve_side_by_side(solver, jobs, 0)));
    let steps = |crossing: &SingleCrossing| scenario.steps(vehicle, crossing) as f64;
    let jobs = vec![(vehicle, crossing); ROUNDS * lanes];
    let lone_s = least_s(seconds, || solve(&jobs[..1]));
    let full_s = least_s(seconds, || solve(&jobs));
    let with_speed = |i: usize| SingleCrossing {
        speed_m_s: crossing.speed_m_s * (1.0 + 0.001 * i as f64),
        ..crossing.clone()
    };
    let mixed: Vec<SingleCrossing> = (0..jobs.len()).map(with_speed).collect();
    let mixed_jobs: Vec<_> = mixed.iter().map(|crossing| (vehicle, crossing)).collect();
    let mixed_s = least_s(seconds, || solve(&mixed_jobs));
    json!({
        "speed_m_s": crossing.speed_m_s,
        "lone_step_s": lone_s / steps(crossing),
        "full_step_s": full_s / steps(crossing) / jobs.len() as f64,
        "mixed_step_s": mixed_s / mixed.iter().map(steps).sum::<f64>(),
    })
}

/// What a step costs with the truck on springs, and with its axle loads as masses on the deck.
fn trucks(scenario: &Scenario, seconds: f64) -> Vec<Value> {
    let solver = &scenario.solver;
    let mut trucks = Vec::new();
    for speed_m_s in [15.0, 7.0] {
        for (kind, vehicle) in [
            ("on springs", truck(None)),
            ("convective", truck(Some(Inertia::Convective))),
            ("local", truck(Some(Inertia::Local))),
        ] {
            let crossing = SingleCrossing {
                load_n: vehicle.weight_n.expect("axle loads"),
                ..scenario.crossing(speed_m_s, scenario.everything())
            };
            let steps = solver
                .solve_single(&vehicle, &crossing)
                .expect("a crossing")
                .statistics
                .steps as f64;
            let jobs = vec![(&vehicle, &crossing); ROUNDS * InstructionPath::of_this_machine().lanes];
            let lone_s = least_s(seconds, || drop(black_box(solver.solve_single(&vehicle, &crossing))));
            let full_s = least_s(seconds, || drop(black_box(solve_side_by_side(solver, &jobs, 0))));
            trucks.push(json!({
                "speed_m_s": speed_m_s,
                "truck": kind,
                "lone_step_s": lone_s / steps,
                "full_step_s": full_s / steps / jobs.len() as f64,
            }));
        }
    }
    trucks
}

/// Where the time of a step goes at 15 m/s: weight only, `local` and `convective`, on the centre line and off it, and the truck
/// with and without its springs; one lane at work and all of them.
fn breakdown(scenario: &Scenario, seconds: f64) -> Vec<Value> {
    let crossing = scenario.crossing(15.0, scenario.everything());
    let lanes = InstructionPath::of_this_machine().lanes;
    let mut vehicles = Vec::new();
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        vehicles.push((json!(inertia), "centred", vehicle(inertia)));
        vehicles.push((json!(inertia), "off the centre", vehicle_off_centre(inertia)));
    }
    vehicles.push((json!("convective"), "two axles", truck(Some(Inertia::Convective))));
    vehicles.push((json!("on springs"), "two axles", truck(None)));
    let mut cases = Vec::new();
    for (inertia, place, vehicle) in &vehicles {
        let crossing = SingleCrossing {
            load_n: vehicle.weight_n.unwrap_or(crossing.load_n),
            ..crossing.clone()
        };
        for at_work in [1, lanes] {
            let jobs = vec![(vehicle, &crossing); at_work];
            cases.push(json!({
                "inertia": inertia,
                "place": place,
                "lanes": at_work,
                "parts": parts(scenario, &jobs, seconds),
            }));
        }
    }
    cases
}

/// Seconds and operations of each part of a step, of one crossing of those that are solved side by side.
fn parts(scenario: &Scenario, jobs: &[(&Vehicle, &SingleCrossing)], seconds: f64) -> Vec<Value> {
    let begun = Instant::now();
    let traffics: Vec<_> = jobs
        .iter()
        .map(|(vehicle, crossing)| crossing.traffic(vehicle))
        .collect();
    let crossings: Vec<_> = jobs.iter().map(|(_, crossing)| crossing.crossing()).collect();
    let list: Vec<_> = traffics.iter().zip(&crossings).collect();
    let mut least: Option<Laps> = None;
    while least.is_none() || begun.elapsed().as_secs_f64() < seconds {
        let mut laps = Laps::default();
        black_box(scenario.solver.solve_all_timed(&list, 0, &mut laps));
        if least.as_ref().is_none_or(|known| laps.total_s() < known.total_s()) {
            least = Some(laps);
        }
    }
    let laps = least.unwrap_or_default();
    let of = (laps.steps * jobs.len()) as f64;
    let part = |part: StepPart| {
        let i = part as usize;
        // what all lanes do at once is counted for one, what each does by itself for all
        let crossings = match part {
            StepPart::Loads | StepPart::RidingMasses | StepPart::Contact | StepPart::GatherAndScatter => of,
            _ => of / jobs.len() as f64,
        };
        json!({ "part": format!("{part:?}"), "seconds": laps.seconds[i] / of, "flop": laps.flop[i] / crossings })
    };
    StepPart::ALL.map(part).to_vec()
}

/// A clock that is looked at between the parts of all steps.
struct Laps {
    last: Instant,
    /// What a look at the clock takes.
    look_s: f64,
    steps: usize,
    seconds: [f64; StepPart::ALL.len()],
    flop: [f64; StepPart::ALL.len()],
}

impl Laps {
    fn total_s(&self) -> f64 {
        self.seconds.iter().sum()
    }
}

impl Default for Laps {
    fn default() -> Self {
        const LOOKS: u32 = 1000;
        let begun = Instant::now();
        for _ in 0..LOOKS {
            black_box(Instant::now());
        }
        Self {
            last: Instant::now(),
            look_s: begun.elapsed().as_secs_f64() / f64::from(LOOKS),
            steps: 0,
            seconds: [0.0; StepPart::ALL.len()],
            flop: [0.0; StepPart::ALL.len()],
        }
    }
}

impl StepClock for Laps {
    fn begin(&mut self) {
        self.steps += 1;
        self.last = Instant::now();
    }

    fn lap(&mut self, part: StepPart, flop: impl FnOnce() -> f64) {
        let now = Instant::now();
        self.seconds[part as usize] += ((now - self.last).as_secs_f64() - self.look_s).max(0.0);
        self.flop[part as usize] += flop();
        self.last = Instant::now();
    }
}

/// Crossings that a lane takes one after the other.
const ROUNDS: usize = 8;

/// Least time of something that is done again and again for a while.
fn least_s(seconds: f64, work: impl Fn()) -> f64 {
    let (start, mut least) = (Instant::now(), f64::INFINITY);
    loop {
        let begun = Instant::now();
        work();
        least = least.min(begun.elapsed().as_secs_f64());
        if start.elapsed().as_secs_f64() > seconds {
            return least;
        }
    }
}

/// Fused multiply-adds that do not wait for each other: as many as hide the latency of two units.
const CHAINS: usize = 12;

/// Multiply-adds of each chain.
const LINKS: usize = 1_000_000;

/// What one core does at most on vectors as the lanes have.
fn peak_flop_per_s(seconds: f64) -> f64 {
    let flop = (2 * CHAINS * LINKS * InstructionPath::of_this_machine().lanes) as f64;
    let factor = black_box(0.999);
    let run = || {
        black_box(Arch::new().dispatch(Chains { factor }));
    };
    flop / least_s(seconds, run)
}

struct Chains {
    factor: f64,
}

impl WithSimd for Chains {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (a, b) = (simd.splat_f64s(self.factor), simd.splat_f64s(1.0 - self.factor));
        let mut x = [simd.splat_f64s(0.5); CHAINS];
        for (i, x) in x.iter_mut().enumerate() {
            *x = simd.splat_f64s(i as f64);
        }
        for _ in 0..LINKS {
            for x in &mut x {
                *x = simd.mul_add_f64s(*x, a, b);
            }
        }
        x.iter().map(|x| simd.reduce_sum_f64s(*x)).sum()
    }
}
