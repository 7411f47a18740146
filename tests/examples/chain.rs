//! Asks the plane chain of `tests/data/chain.json` and prints the answer as one JSON document.
//!
//!     chain [time step in s]                  the crossings of chain.json, peaks in lists from left to right
//!     chain SCENARIO.json [time step in s]    one crossing or static case
//!
//! A scenario has the words of studies and bridge files; what it leaves out is chain.json's:
//!
//!     { "modules": 15, "others": [1, 2, 9],
//!       "joints": { "8": { "connectors": { "gap_compression_m": 0.020 } }, "2..6": { "connectors": { "tension": false } } },
//!       "connection": "nonlinear", "gap_tension_m": 0.028, "gap_compression_m": 0.0055,
//!       "analysis": { "kind": "crossing", "time_step_s": 0.0025, "tail_s": 2, "spectral_radius": 0.9 },
//!       "vehicle": { "axles": [ { "behind_front_m": 0, "share": 1, "patch_length_m": 0.3 } ], "inertia": "convective" },
//!       "load_n": 230300, "speed_m_s": 3 }
//!
//! A joint of the chain has one connector: `stiffness_n_m` in `joints` is the joint's, as `stiffness_of_a_joint_n_m` is in
//! chain.json. Tracks are the chain's two lines and `inertia` is `none` where a vehicle does not say otherwise. Of the kind
//! `static`, `"load_x_m"` or `"load_position"` takes the place of the speed. `others` are the modules that are of the other kind
//! of chain.json. Of the kind `modes` the bridge floats free, with the linear connection, and nothing loads it. `"traffic": [ { "vehicle": ..., "load_n": ...,
//! "speed_m_s": ... } ]` is another way to write the one vehicle. The time step of the command line counts in place of the
//! file's; a static case has none. What the chain does not know is refused with its key: exit status 2.
//!
//! The answer of a crossing (of a static case `deflection_m` and `force_n`, tension positive):
//!
//!     { "kind", "time_step_s",
//!       "positions": [ { "position", "x_m", "peak_deflection_m", "peak_deflection_time_s", "peak_uplift_m", ... } ],
//!       "joints": [ { "joint", "peak_compression_n", "peak_compression_time_s", "peak_tension_n", ... } ],
//!       "largest": { "peak_deflection_m", "peak_deflection_position", "peak_deflection_time_s", "peak_uplift_m", ...,
//!                    "peak_compression_n", "peak_compression_joint", ..., "min_contact_force_n" } }
//!
//! The answer of `modes` is a list of `frequency_hz`, `shape` and `vertical_share`. Times count from the front at x = 0; a peak of 0 has no time. `min_contact_force_n` is that of a vehicle with inertia.
//!
//! Knows its arguments and exit statuses. Does not know what other codes answer.

use pontoon_tests::chain::Chain;
use pontoon_tests::chain_answer::answer;
use pontoon_tests::chain_scenario::{ChainScenario, TIME_STEP_S};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let step = |word: &String| word.parse::<f64>().ok();
    match words.as_slice() {
        [] => crossings(TIME_STEP_S),
        [word] => match step(word) {
            Some(time_step_s) => crossings(time_step_s),
            None => scenario(word, None),
        },
        [file, word] if step(word).is_some() => scenario(file, step(word)),
        _ => failed(2, "found other arguments, allowed: [SCENARIO.json] [time step in s]"),
    }
}

fn crossings(time_step_s: f64) -> ExitCode {
    if !(time_step_s.is_finite() && time_step_s > 0.0) {
        return failed(
            2,
            &format!("time step: found {time_step_s}, allowed: a finite number above 0"),
        );
    }
    let chain = Chain::read();
    println!("{}", chain.report(time_step_s, &chain.cross(time_step_s)));
    ExitCode::SUCCESS
}

fn scenario(file: &str, time_step_s: Option<f64>) -> ExitCode {
    match ChainScenario::read(Path::new(file), time_step_s).map(|scenario| answer(&scenario)) {
        Ok(Ok(found)) => {
            println!("{found}");
            ExitCode::SUCCESS
        }
        Ok(Err(unsolved)) => failed(1, &format!("{file}: {unsolved}")),
        Err(refused) => failed(2, &refused.to_string()),
    }
}

fn failed(status: u8, message: &str) -> ExitCode {
    eprintln!("chain: {message}");
    ExitCode::from(status)
}
