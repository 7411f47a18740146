//! Profiles of roads against another program's numbers and by hand.
//!
//! Knows seeds, waves and stated forms. Does not know vehicles.

use super::{IsoClass, Profile, RoadDesign, SplitMix64, Unevenness, Ways};

fn class_c(seed: u64) -> Profile {
    let design = RoadDesign {
        iso_8608: Some(IsoClass::C),
        seed: Some(seed),
        ..RoadDesign::default()
    };
    let ways = Ways {
        length_m: 100.5,
        beyond_m: 8.0,
        y_m: &[],
    };
    design.road(&ways).expect("a road").profile(0.0).clone()
}

/// Numbers of an independent program for class C, seed 1: the first phases to all digits, heights and slope to 1e-6 of the
/// road's. Another seed and a density that is 5 % off are found.
#[test]
fn waves_of_a_seed_are_those_of_another_program() {
    let mut phases = SplitMix64(1);
    for expected in [
        0.566_561_575_172_280_9,
        0.745_781_757_262_701_1,
        0.971_002_753_586_796_2,
    ] {
        assert!((phases.unit() - expected).abs() < 1e-15);
    }
    let checks = [(0.0, 0, -0.015_274_32), (10.0, 0, 0.015_467_85), (10.0, 1, 0.014_151_8)];
    let off = |profile: &Profile, factor: f64| {
        let misses = checks.map(|(x_m, which, expected)| (factor * profile.at(x_m)[which] - expected).abs());
        misses.into_iter().fold(0.0, f64::max)
    };
    let right = off(&class_c(1), 1.0);
    // half of the last digit that is told
    assert!(right < 6e-9, "{right:e}");
    assert!(off(&class_c(2), 1.0) > 1e-3 && off(&class_c(1), 1.05_f64.sqrt()) > 1e-4);
}

/// Between the places a profile of waves is what the waves sum up to: heights of a centimetre to 1e-8 m, slopes of 0.03 to 5e-6,
/// what a cubic leaves of the shortest waves. A wave left out is more.
#[test]
fn cubic_between_places_follows_the_waves() {
    let profile = class_c(1);
    let Profile::Places { .. } = &profile else { panic!() };
    let exact = |x: f64| {
        let (mut phases, mut sum) = (SplitMix64(1), [0.0; 2]);
        for i in 0..1000 {
            let n = 0.02 + (f64::from(i) + 0.5) * 0.003_98;
            let a = (2.0 * 256e-6 * (n / 0.1_f64).powi(-2) * 0.003_98).sqrt();
            let (sine, cosine) = (std::f64::consts::TAU * (n * x + phases.unit())).sin_cos();
            sum[0] += a * cosine;
            sum[1] -= a * std::f64::consts::TAU * n * sine;
        }
        sum
    };
    let mut worst = [0.0_f64; 2];
    for i in 0..200 {
        let x = -20.0 + 0.7013 * f64::from(i);
        let (found, exact) = (profile.at(x), exact(x));
        for (worst, (found, exact)) in worst.iter_mut().zip(found.iter().zip(exact)) {
            *worst = worst.max((found - exact).abs());
        }
    }
    assert!(worst[0] < 1e-8 && worst[1] < 5e-6, "{worst:?}");
}

/// What begins before the bridge or ends behind it is driven on; of a table the level places before its first rise are not.
#[test]
fn a_stated_road_is_driven_on_from_where_it_is_level() {
    let ways = Ways {
        length_m: 100.5,
        beyond_m: 8.0,
        y_m: &[],
    };
    let table = |table: &[[f64; 2]]| RoadDesign {
        table: Some(table.to_vec()),
        ..RoadDesign::default()
    };
    let bump = |x_m: f64| RoadDesign {
        bump: Some(Unevenness {
            x_m,
            length_m: 2.0,
            height_m: 0.05,
        }),
        ..RoadDesign::default()
    };
    for (design, run_in_m) in [
        (table(&[[-40.0, 0.1], [-5.0, 0.1], [0.0, 0.0], [110.0, 0.0]]), 5.0),
        (table(&[[-5.0, 0.0], [90.0, 0.0], [104.0, 0.2], [120.0, 0.2]]), 3.5),
        (table(&[[-5.0, 0.1], [110.0, 0.1]]), 0.0),
        (bump(-1.0), 1.0),
        (bump(50.0), 0.0),
        (bump(100.0), 1.5),
    ] {
        let road = design.road(&ways).expect("a road");
        assert!(
            (road.run_in_m - run_in_m).abs() < 1e-12,
            "{design:?}: {}",
            road.run_in_m
        );
        let at = road.profile(0.0).at(-road.run_in_m);
        assert!(
            (at[0] - road.level_m(false)).abs() < 1e-12,
            "{design:?} begins at {} m",
            at[0]
        );
    }
}
