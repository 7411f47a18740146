//! The bridge of Fu, Cui, Chen, Wang: Marine Structures 18 (2005) 85-107: the identified one against what the paper prints,
//! one with the prototype's numbers against the prototype. That every printed statement
//! holds is for the references of `studies/fig12_14_gap_tension/reference.json` and its like.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::Mode;
use pontoon_core::bridge::{Model, Supports};
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, StaticResponse};
use pontoon_core::vehicle::Inertia;
use pontoon_judge::reference::Reference;
use pontoon_plan::input::{Document, canonical_text};
use pontoon_plan::study_file::Study;
use pontoon_tests::*;
use serde_json::Value;
use std::path::Path;
use std::sync::OnceLock;

/// Table 1 of the paper, full model `[Hz]`.
const BRIDGE_HZ: [(&str, f64); 14] = [
    ("vertical bending 1", 0.362),
    ("vertical bending 2", 0.410),
    ("vertical bending 3", 0.535),
    ("torsion 1", 0.726),
    ("vertical bending 4", 0.749),
    ("horizontal bending 1", 0.882),
    ("vertical bending 5", 1.040),
    ("torsion 2", 1.354),
    ("vertical bending 6", 1.395),
    ("vertical bending 7", 1.800),
    ("torsion 3", 1.968),
    ("vertical bending 8", 2.241),
    ("horizontal bending 2", 2.359),
    ("vertical bending 9", 2.702),
];

/// The single module, full model `[Hz]`.
const MODULE_HZ: [(&str, f64); 3] = [("heave", 0.355), ("roll", 0.353), ("pitch", 0.354)];

/// Enough of the lowest modes to hold all of the table.
const MODES: usize = 24;

fn bridge() -> &'static Ready {
    static READY: OnceLock<Ready> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&design("fu2005"), Model::SuperElement))
}

/// The bridge that has the prototype's water, masses and truss.
fn prototype() -> &'static Ready {
    static READY: OnceLock<Ready> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&prototype_design(), Model::SuperElement))
}

fn full_modes() -> &'static [Mode] {
    static READY: OnceLock<Vec<Mode>> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&design("fu2005"), Model::Full).modes(MODES))
}

/// Modes of bridges whose E is 5 % low and 5 % high.
fn modes_of_wrong_e() -> &'static [Vec<Mode>; 2] {
    static READY: OnceLock<[Vec<Mode>; 2]> = OnceLock::new();
    READY.get_or_init(|| {
        let of = |factor: f64| Ready::new(&with_e(&design("fu2005"), factor), Model::SuperElement).modes(MODES);
        [of(0.95), of(1.05)]
    })
}

/// Largest miss of a printed table.
fn misses(modes: &[Mode], table: &[(&str, f64)]) -> f64 {
    largest(table.iter().map(|&(name, hz)| {
        let found = frequency_hz(modes, name);
        println!(
            "  {name}: {found:.4} Hz, paper {hz}, {:+.2} %",
            100.0 * (found / hz - 1.0)
        );
        miss(found, hz)
    }))
}

/// What the paper prints of the bridge itself stands in its file to the last digit.
#[test]
fn the_bridge_has_the_printed_dimensions_gaps_and_supports() {
    let d = design("fu2005");
    assert_eq!((d.modules, d.positions()), (15, 16));
    let module = &d.module;
    assert_eq!((module.length_m, module.breadth_m, module.depth_m), (6.7, 8.082, 1.07));
    assert_eq!(module.material.youngs_modulus_pa, 2e11);
    let gaps_m = (d.connectors.gap_tension_m, d.connectors.gap_compression_m);
    assert_eq!(gaps_m, (0.028, 0.0055));
    assert_eq!(d.supports, Supports::default());
    assert!((d.position_x_m(7) - POSITION_7_M).abs() < 1e-12);
    let plates = [
        module.deck_thickness_m,
        module.bottom_thickness_m,
        module.side_thickness_m,
        module.end_thickness_m,
        module.longitudinal_walls.thickness_m,
        module.transverse_walls.thickness_m,
    ];
    assert!(plates.iter().all(|t| (0.001..=0.006).contains(t)), "{plates:?}");
}

/// The bridge file is what the program identified from the documents that lie in `studies`: any that changed since has
/// another hash than its provenance says, and `scripts/identify` must run again.
#[test]
fn the_bridge_was_identified_from_the_documents_that_are_here() {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
    let hash = |document: &Value| blake3::hash(canonical_text(document).as_bytes()).to_hex().to_string();
    let of_file = |place: &str| Document::read(&studies.join(place)).expect("a document").hash();
    let of_reference = |study: &str| {
        let reference = Reference::open(&studies.join(study)).expect("a reference");
        hash(&reference.judged)
    };
    let mut expected = vec![
        ("start".to_owned(), of_file("identification/start.json")),
        ("parameters".to_owned(), of_file("identification/parameters.json")),
    ];
    for study in ["table1", "fig09_static"] {
        expected.push(("reference".to_owned(), of_reference(study)));
        let opened = Study::open(&studies.join(study)).expect("a study");
        expected.push(("study".to_owned(), hash(&opened.computed())));
    }
    let provenance = design("fu2005").provenance.expect("a provenance");
    let found = provenance.documents.into_iter().map(|d| (d.role, d.blake3));
    assert_eq!(found.collect::<Vec<_>>(), expected);
}

/// 1 %: the bridge was fitted to this mass, which public sources give to three digits; 5 % is asked for.
#[test]
fn structural_mass_is_that_of_the_river_link() {
    let mass_kg = |factor: f64| {
        let heavy = with(&design("fu2005"), |d| d.module.material.density_kg_m3 *= factor);
        Ready::new(&heavy, Model::Full).module.structural_mass_kg()
    };
    held(
        "structural mass",
        0.01,
        miss(mass_kg(1.0), 6790.0),
        miss(mass_kg(1.05), 6790.0),
    );
}

/// 0.5 %: three printed digits are worth 0.15 %, the rest is the identified water's. Twin: p_b.
#[test]
fn module_heaves_rolls_and_pitches_as_printed() {
    let modes = |p_b: f64| {
        let one = with(&with_p_b(&design("fu2005"), p_b), |d| d.modules = 1);
        Ready::new(&one, Model::Full).modes(8)
    };
    let [right, wrong] = [1.0, 1.05].map(|p_b| misses(&modes(p_b), &MODULE_HZ));
    held("module modes", 0.005, right, wrong);
}

/// 2 %: the plates are identified, not printed; fourteen modes hang on two thicknesses and one truss. Twin: E.
#[test]
fn fourteen_modes_as_printed() {
    let right = misses(full_modes(), &BRIDGE_HZ);
    held("bridge modes", 0.02, right, misses(&modes_of_wrong_e()[0], &BRIDGE_HZ));
}

/// Above the full model by Rayleigh's principle, but for the eigensolver's 1e-7, and by no more than 0.1 %, a twentieth
/// of what the modes may miss the paper by. Twins: E low goes below, E high goes too far above.
#[test]
fn super_element_is_an_upper_bound_and_close() {
    let above = |modes: &[Mode]| -> Vec<f64> {
        let of = |&(name, _): &(&str, f64)| frequency_hz(modes, name) / frequency_hz(full_modes(), name) - 1.0;
        BRIDGE_HZ.iter().map(of).collect()
    };
    let [right, low, high] = [&bridge().modes(MODES), &modes_of_wrong_e()[0], &modes_of_wrong_e()[1]].map(|m| above(m));
    let below = |ratios: &[f64]| largest(ratios.iter().map(|r| -r));
    held("below the full model", 1e-7, below(&right), below(&low));
    held("above the full model", 0.001, largest(right), largest(high));
}

/// Place of position 7 `[m]`.
const POSITION_7_M: f64 = 40.2;

/// The paper's vehicle standing at position 7.
fn standing(ready: &Ready, connection: Connection, load_n: f64) -> StaticResponse {
    let solver = ready.statics(&footprint(&[-1.4, 1.4], Inertia::Local));
    solver
        .solve(&ready.case(connection, load_n, POSITION_7_M))
        .expect("solved")
}

/// 2 %: between the footprints of 6.7 m and 3.35 m the prototype moves by 3 %. Twin: the load. The influential length is
/// read off a printed curve, 3 %; closer, 0.3 %, is the prototype's. Twins: the gaps, p_b.
#[test]
fn linear_static_peak_and_influential_length() {
    let right = standing(bridge(), Connection::Linear, PAPER_LOAD_N);
    let heavy = standing(bridge(), Connection::Linear, 1.05 * PAPER_LOAD_N);
    let peak = |r: &StaticResponse| miss(r.deflection_m[6], 0.141);
    held("linear static peak", 0.02, peak(&right), peak(&heavy));

    let hanging = standing(bridge(), PAPER_GAPS, PAPER_LOAD_N);
    let length = |r: &StaticResponse, expected: f64| miss(r.influential_length_m, expected);
    held("influential length", 0.03, length(&right, 74.0), length(&hanging, 74.0));
    let right = standing(prototype(), Connection::Linear, PAPER_LOAD_N);
    let stiff_water = Ready::new(&with_p_b(&prototype_design(), 1.05), Model::SuperElement);
    let wrong = standing(&stiff_water, Connection::Linear, PAPER_LOAD_N);
    held("prototype's length", 0.003, length(&right, 72.3), length(&wrong, 72.3));
}

/// 3 %: a measured peak, printed to three digits, on a bridge whose gaps are nominal. Twin: the load. Prototype, 0.5 %: the
/// meshes differ. Twin: the compression gap.
#[test]
fn static_peak_with_gaps_and_uplift_on_both_sides() {
    let right = standing(bridge(), PAPER_GAPS, PAPER_LOAD_N);
    let light = standing(bridge(), PAPER_GAPS, 0.95 * PAPER_LOAD_N);
    let peak = |r: &StaticResponse, expected: f64| miss(r.deflection_m[6], expected);
    held("static peak with gaps", 0.03, peak(&right, 0.210), peak(&light, 0.210));
    let own = standing(prototype(), PAPER_GAPS, PAPER_LOAD_N);
    let wider = standing(prototype(), gaps(0.028, 1.05 * 0.0055), PAPER_LOAD_N);
    held("prototype's peak", 0.005, peak(&own, 0.207), peak(&wider, 0.207));

    let uplift = |side: &[f64]| largest(side.iter().map(|w| -w));
    let (left, right) = (uplift(&right.deflection_m[..6]), uplift(&right.deflection_m[7..]));
    assert!(
        left > 0.002 && right > 0.002,
        "uplift {left} m left, {right} m right of the load"
    );
}

/// The statements of the paper's section on statics.
#[test]
fn compression_gap_matters_more_than_tension_gap() {
    let peak =
        |tension: f64, compression: f64| standing(bridge(), gaps(tension, compression), PAPER_LOAD_N).deflection_m[6];
    let both = peak(0.028, 0.0055);
    let per_compression = (both - peak(0.028, 0.0)) / 0.0055;
    let per_tension = (both - peak(0.0, 0.0055)) / 0.028;
    assert!(
        per_compression > per_tension,
        "{per_compression} against {per_tension} m/m"
    );
    assert!(
        peak(0.028, 0.0) < 0.92 * 0.210,
        "without compression gap {} m",
        peak(0.028, 0.0)
    );
}

/// The prototype's crossings of 230.3 kN: gaps in tension and compression `[mm]` (none: linear), speed `[m/s]`, deflection of
/// position 7 `[cm]`, largest compression of joint 7 `[kN]`. The other three settings at 3 and 7 m/s are left out for time.
const CROSSINGS: [(Option<[f64; 2]>, f64, f64, f64); 14] = [
    (None, 3.0, 14.7, 649.0),
    (Some([28.0, 5.5]), 3.0, 21.3, 557.0),
    (None, 7.0, 15.0, 632.0),
    (Some([28.0, 5.5]), 7.0, 21.6, 575.0),
    (None, 10.0, 14.8, 682.0),
    (None, 15.0, 19.1, 729.0),
    (Some([28.0, 5.5]), 10.0, 23.3, 640.0),
    (Some([28.0, 5.5]), 15.0, 31.9, 925.0),
    (Some([28.0, 0.0]), 10.0, 21.1, 780.0),
    (Some([28.0, 0.0]), 15.0, 30.3, 1110.0),
    (Some([5.0, 5.5]), 10.0, 20.0, 524.0),
    (Some([5.0, 5.5]), 15.0, 30.4, 826.0),
    (Some([0.0, 5.5]), 10.0, 18.4, 472.0),
    (Some([0.0, 5.5]), 15.0, 29.1, 829.0),
];

fn connection(gaps_mm: Option<[f64; 2]>) -> Connection {
    gaps_mm.map_or(Connection::Linear, |[t, p]| gaps(1e-3 * t, 1e-3 * p))
}

/// Crossings as the study makes them: connection, speed `[m/s]`, load `[N]`.
fn cross(ready: &Ready, jobs: &[(Connection, f64, f64)]) -> Vec<CrossingResponse> {
    let vehicle = footprint(&[-1.4, 1.4], Inertia::Local);
    let solver = ready.crossings(&vehicle, &settings(ready.rayleigh(), 0.01, 0.9));
    let answer = |&(connection, speed_m_s, load_n): &(Connection, f64, f64)| {
        solver
            .solve(&ready.crossing(connection, load_n, speed_m_s))
            .expect("solved")
    };
    on_two_threads(jobs, answer)
}

fn crossings() -> &'static [CrossingResponse] {
    static READY: OnceLock<Vec<CrossingResponse>> = OnceLock::new();
    READY.get_or_init(|| cross(prototype(), &CROSSINGS.map(|c| (connection(c.0), c.1, PAPER_LOAD_N))))
}

/// Deflection and uplift of position 7 `[m]`, largest compression and tension of joint 7 `[N]`.
fn at_7(r: &CrossingResponse) -> [f64; 4] {
    let (position, joint) = (&r.positions[6], &r.joints[5].sum);
    [
        position.deflection.value,
        position.uplift.value,
        joint.compression.value,
        joint.tension.value,
    ]
}

/// The crossing of one row of the table.
fn row(gaps_mm: Option<[f64; 2]>, speed_m_s: f64) -> [f64; 4] {
    let place = CROSSINGS.iter().position(|c| c.0 == gaps_mm && c.1 == speed_m_s);
    at_7(&crossings()[place.expect("a row of the table")])
}

/// The row whose largest compression is one of a train of impacts 0.33 s apart, 525 and 545 kN: a load 1 % lighter makes them
/// 499 and 507, 1 % heavier 538 and 572, half the time step moves them by 0.7 %.
const IMPACT_ROW: usize = 3;

/// 4 % and 8 % are asked for; what the forces leave of it but for one row, 2.5 %, is held. Twin: the vehicle 5 % heavier.
/// The one row, held within 8 %, has the linear connection for a twin.
#[test]
fn crossings_follow_the_prototype() {
    let missed = |r: &CrossingResponse, row: &(Option<[f64; 2]>, f64, f64, f64)| {
        let [deflection, _, compression, _] = at_7(r);
        [miss(100.0 * deflection, row.2), miss(1e-3 * compression, row.3)]
    };
    let all: Vec<[f64; 2]> = crossings()
        .iter()
        .zip(&CROSSINGS)
        .map(|(r, row)| missed(r, row))
        .collect();
    for (missed, row) in all.iter().zip(&CROSSINGS) {
        println!("  {row:?} {missed:.4?}");
    }
    let heavy = &cross(prototype(), &[(PAPER_GAPS, 15.0, 1.05 * PAPER_LOAD_N)])[0];
    let heavy = missed(heavy, &CROSSINGS[7]);
    held(
        "deflection of position 7",
        0.04,
        largest(all.iter().map(|m| m[0])),
        heavy[0],
    );
    let smooth = (0..all.len()).filter(|&i| i != IMPACT_ROW);
    held(
        "compression of joint 7",
        0.025,
        largest(smooth.map(|i| all[i][1])),
        heavy[1],
    );
    let linear = missed(&crossings()[2], &CROSSINGS[IMPACT_ROW]);
    held("compression with impacts", 0.08, all[IMPACT_ROW][1], linear[1]);
}

/// The paper prints 1.5; 1.42 to 1.58 is allowed, which no coefficient 5 % wrong leaves, but the linear connection
/// does. Closer, 1 %, is the prototype's 31.9 over 21.3 cm, as its rounding to a millimetre allows. Twin: m_a.
#[test]
fn hump_grows_by_half_from_3_to_15_m_s() {
    let hump = |gaps_mm: Option<[f64; 2]>| row(gaps_mm, 15.0)[0] / row(gaps_mm, 3.0)[0];
    let right = hump(Some([28.0, 5.5]));
    held("hump ratio", 0.08, (right - 1.5).abs(), (hump(None) - 1.5).abs());
    let heavy = Ready::new(&with_m_a(&prototype_design(), 1.05), Model::SuperElement);
    let wrong = cross(&heavy, &[3.0, 15.0].map(|v| (PAPER_GAPS, v, PAPER_LOAD_N)));
    let wrong = at_7(&wrong[1])[0] / at_7(&wrong[0])[0];
    let prototype = 31.9 / 21.3;
    held(
        "prototype's hump ratio",
        0.01,
        miss(right, prototype),
        miss(wrong, prototype),
    );
}

/// Residual: rounding over some thousand steps, measured at 5e-13. Numerical dissipation: 5 % is allowed, measured at
/// 0.4 %. `energy.rs` beside this file holds the twins of both.
#[test]
fn energy_closes_in_every_crossing() {
    let residual = largest(crossings().iter().map(|r| r.energy.energy_residual));
    let numerical = largest(crossings().iter().map(|r| r.energy.numerical_dissipation));
    assert!(
        residual <= 1e-9 && numerical <= 0.05,
        "residual {residual:e}, numerical dissipation {numerical:e}"
    );
}

/// The statements of the paper's section on crossings that the table decides.
#[test]
fn speed_and_gaps_act_as_printed() {
    let wide = Some([28.0, 5.5]);
    for gaps_mm in [None, wide] {
        let (slow, fast) = (row(gaps_mm, 3.0), row(gaps_mm, 15.0));
        assert!(fast[1] > slow[1], "{gaps_mm:?}: uplift grows with speed");
        assert!(
            fast[2].max(fast[3]) > slow[2].max(slow[3]),
            "{gaps_mm:?}: force grows with speed"
        );
        let standing = standing(prototype(), connection(gaps_mm), PAPER_LOAD_N).deflection_m[6];
        let creep = slow[0] / standing;
        assert!(
            (0.97..1.06).contains(&creep),
            "{gaps_mm:?}: {creep} times the static peak at 3 m/s"
        );
    }
    for speed_m_s in [10.0, 15.0] {
        let linear = row(None, speed_m_s)[0];
        for gaps_mm in [wide, Some([28.0, 0.0]), Some([5.0, 5.5]), Some([0.0, 5.5])] {
            assert!(linear < row(gaps_mm, speed_m_s)[0], "{gaps_mm:?}: linear deflects less");
        }
        let (closed, open) = (row(Some([28.0, 0.0]), speed_m_s), row(wide, speed_m_s));
        assert!(
            open[0] > closed[0] && open[1] > closed[1],
            "a compression gap raises deflection and uplift"
        );
    }
    let (slow, fast) = (row(wide, 3.0), row(wide, 15.0));
    assert!(
        slow[3] < 0.05 * slow[2] && fast[3] > 0.2 * fast[2],
        "in tension only when the load moves fast"
    );
}
