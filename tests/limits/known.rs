//! Limits in which the answer is known: creeping loads, no connectors, stiff connectors, axles apart, rigid modules.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, Quantity, Record};
use pontoon_core::vehicle::{Axle, Inertia, Vehicle, VehicleDesign};
use pontoon_core::water::WaterDistribution;
use pontoon_tests::*;
use std::sync::OnceLock;

/// Weight of the vehicle `[N]`.
const LOAD_N: f64 = PAPER_LOAD_N;

/// Gaps narrow enough that all connectors of the short bridge work.
const NARROW: Connection = gaps(0.001, 0.0005);

fn smoke() -> &'static Ready {
    static READY: OnceLock<Ready> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&design("smoke"), Model::SuperElement))
}

fn recorded(mut crossing: SingleCrossing) -> SingleCrossing {
    crossing.record = Record {
        positions: vec![1, 2, 3, 4],
        joints: vec![2, 3],
        ..Record::default()
    };
    crossing
}

fn cross(vehicle: &Vehicle, h: f64, change: impl FnOnce(&mut SingleCrossing)) -> CrossingResponse {
    let ready = smoke();
    let mut crossing = recorded(ready.crossing(Connection::Linear, LOAD_N, 8.0));
    change(&mut crossing);
    ready
        .crossings(vehicle, &settings(ready.rayleigh(), h, 0.9))
        .solve(&crossing)
        .expect("solved")
}

fn two_tracks(inertia: Inertia) -> Vehicle {
    footprint(&[-1.4, 1.4], inertia)
}

/// Deflections of the two inner positions and forces of both joints, in m and MN: of like size.
fn curves(r: &CrossingResponse) -> Vec<f64> {
    let scaled = |quantity: Quantity, position: usize, scale: f64| {
        history(r, quantity, position)
            .iter()
            .map(move |v| scale * v)
            .collect::<Vec<_>>()
    };
    [
        scaled(Quantity::Deflection, 2, 1.0),
        scaled(Quantity::Deflection, 3, 1.0),
        scaled(Quantity::Force, 2, 1e-6),
        scaled(Quantity::Force, 3, 1e-6),
    ]
    .concat()
}

/// Largest static deflection of any position, the load's places 0.05 m apart.
fn static_peak_m(connection: Connection, load_n: f64) -> f64 {
    let solver = smoke().statics(&two_tracks(Inertia::None));
    let at = |place: usize| {
        solver
            .solve(&smoke().case(connection, load_n, 0.05 * place as f64))
            .expect("solved")
    };
    largest((0..=402).flat_map(|place| at(place).deflection_m))
}

/// A vehicle that creeps meets the static peak. 0.2 %: at 0.2 m/s the bridge's slowest motion, 0.6 s, sees the load move by
/// a thousandth of the bridge's length; measured at 0.05 %. Twin: the load. The solver's own creeping peak looks at fewer
/// places and may be lower by what the peak falls off within a quarter element, 0.5 %.
#[test]
fn creeping_vehicle_meets_the_static_peak() {
    for connection in [Connection::Linear, NARROW] {
        let expected = static_peak_m(connection, LOAD_N);
        let creeping = |load_n: f64| {
            let crossing = |x: &mut SingleCrossing| {
                (x.connection, x.speed_m_s, x.load_n) = (connection, 0.2, load_n);
            };
            cross(&two_tracks(Inertia::Local), 0.02, crossing)
                .peak_deflection()
                .deflection
                .value
        };
        let [right, heavy] = [1.0, 1.05].map(|f| miss(creeping(f * LOAD_N), expected));
        held("creeping", 2e-3, right, heavy);
        let solver = smoke().statics(&two_tracks(Inertia::None));
        let coarse = |load_n: f64| {
            solver
                .creeping_peak_m(&smoke().case(connection, load_n, 0.0))
                .expect("solved")
        };
        assert!(
            coarse(LOAD_N) <= expected * (1.0 + 1e-9),
            "the coarse places are among the fine ones"
        );
        held(
            "creeping peak",
            5e-3,
            miss(coarse(LOAD_N), expected),
            miss(coarse(1.05 * LOAD_N), expected),
        );
    }
}

/// Without gaps one truss or the other works at every elongation: the linear law of half the stiffness. 1e-9: rounding over
/// some hundred steps. Twins: the stiffness of the truss; a gap of a tenth of a millimetre.
#[test]
fn closed_gaps_of_twice_the_stiffness_are_the_linear_connection() {
    let vehicle = two_tracks(Inertia::Local);
    let linear = curves(&cross(&vehicle, 0.01, |_| {}));
    let closed = |factor: f64, gap_m: f64| {
        let crossing = |x: &mut SingleCrossing| {
            x.connection = gaps(gap_m, gap_m);
            x.connector_stiffness_n_m *= factor;
        };
        apart(&curves(&cross(&vehicle, 0.01, crossing)), &linear)
    };
    held("closed gaps, stiffness", 1e-9, closed(2.0, 0.0), closed(2.1, 0.0));
    held("closed gaps, gap", 1e-9, closed(2.0, 0.0), closed(2.0, 1e-4));
}

/// Gaps that never close are connectors without stiffness. 1e-9: rounding. Twin: the load.
#[test]
fn wide_gaps_are_no_connectors() {
    let vehicle = two_tracks(Inertia::Local);
    let none = curves(&cross(&vehicle, 0.01, |x| x.connector_stiffness_n_m = 1e-6));
    let wide = |load_n: f64| {
        let crossing = |x: &mut SingleCrossing| (x.connection, x.load_n) = (gaps(10.0, 10.0), load_n);
        apart(&curves(&cross(&vehicle, 0.01, crossing)), &none)
    };
    held("wide gaps", 1e-9, wide(LOAD_N), wide(1.05 * LOAD_N));
}

/// Each gap that opens lets the bridge sag further, from both trusses to none.
#[test]
fn softer_connections_deflect_more() {
    let solver = smoke().statics(&two_tracks(Inertia::None));
    let deflection_m = |connection: Connection| {
        solver
            .solve(&smoke().case(connection, LOAD_N, 6.7))
            .expect("solved")
            .deflection_m[1]
    };
    let row = [
        Connection::Linear,
        gaps(0.0, 0.0),
        gaps(0.0, 0.0005),
        PAPER_GAPS,
        gaps(10.0, 10.0),
    ]
    .map(deflection_m);
    assert!(row.windows(2).all(|w| w[0] < w[1]), "{row:?}");
}

/// Without inertia and with the linear connection a crossing is linear: two axles are the sum of one and one, the second's
/// patch 5 m behind. 1e-9: rounding. Twin: the front axle's weight.
#[test]
fn axles_superpose() {
    let (front, rear) = ((0.0, 0.3, 1.0), (5.0, 0.7, 0.0));
    let history_of = |r: &CrossingResponse| -> Vec<f64> {
        // from t = 0 on, to where the shortest ends; a vehicle that comes later finds the bridge at rest
        let first = (r.recorded.history_time_s[0] / 0.01).round() as i64;
        let from_zero = |quantity: Quantity| -> Vec<f64> {
            let values = history(r, quantity, 2);
            let at = |step: i64| usize::try_from(step - first).map_or(0.0, |i| values[i]);
            (0..300).map(at).collect()
        };
        let force = from_zero(Quantity::Force).into_iter().map(|f| 1e-6 * f);
        from_zero(Quantity::Deflection).into_iter().chain(force).collect()
    };
    let alone = |axle: (f64, f64, f64)| {
        let vehicle = axles(&[(axle.0, 1.0, axle.2)], Inertia::None, 4);
        history_of(&cross(&vehicle, 0.01, |x| {
            x.load_n *= axle.1;
            x.tail_s = 4.0;
        }))
    };
    let both = history_of(&cross(&axles(&[front, rear], Inertia::None, 4), 0.01, |x| {
        x.tail_s = 4.0
    }));
    assert_eq!(both.len(), 600, "three seconds of both");
    let (a, b) = (alone(front), alone(rear));
    let sum = |f: f64| -> Vec<f64> { a.iter().zip(&b).map(|(a, b)| f * a + b).collect() };
    held("axles", 1e-9, apart(&sum(1.0), &both), apart(&sum(1.05), &both));
}

/// Maxwell and Betti: position 3 under a load at 2 is position 2 under a load at 3, on a bridge of four modules of which
/// these are no mirror images. 0.1 %: the load stands on the deck and the deflection is the bottom's, the squash of the box
/// between them, 1e-4, is not the same on both sides of a joint. Twin: one of the two loads.
#[test]
fn deflections_are_reciprocal() {
    let ready = Ready::new(&with(&design("smoke"), |d| d.modules = 4), Model::SuperElement);
    let point = Axle {
        behind_front_m: 0.0,
        share: Some(1.0),
        track_y_m: vec![0.0],
        ..Axle::default()
    };
    let vehicle = VehicleDesign {
        axles: Some(vec![point]),
        ..VehicleDesign::default()
    };
    let solver = ready.statics(&vehicle.check(8.082).expect("a vehicle"));
    let deflection_m = |load_n: f64, at: usize, seen: usize| {
        let case = ready.case(Connection::Linear, load_n, ready.design.position_x_m(at));
        solver.solve(&case).expect("solved").deflection_m[seen - 1]
    };
    let (there, back) = (|load_n: f64| deflection_m(load_n, 2, 3), deflection_m(LOAD_N, 3, 2));
    assert!(
        miss(deflection_m(LOAD_N, 2, 2), deflection_m(LOAD_N, 3, 3)) > 0.05,
        "no mirror images"
    );
    held(
        "reciprocity",
        1e-3,
        miss(there(LOAD_N), back),
        miss(there(1.05 * LOAD_N), back),
    );
}

/// Stiffer connectors raise the bending frequencies to those of modules tied at deck and bottom, the distance falling with
/// the flexibility 1/k. The limit foretold from k and 10 k is therefore the same for two pairs of k; 2e-6: what 1/k^2
/// leaves. Twin: one of the k.
#[test]
fn stiff_connectors_make_one_beam() {
    let hz = |k: f64| {
        let d = with(&design("smoke"), |d| d.connectors.stiffness_n_m = k);
        let modes = Ready::new(&d, Model::SuperElement).modes(12);
        ["vertical bending 1", "vertical bending 2"].map(|name| frequency_hz(&modes, name))
    };
    let rising: Vec<[f64; 2]> = [2e7, 2e8, 2e9, 2e10, 2e11, 2e12].into_iter().map(hz).collect();
    let wrong = hz(1.05 * 2e11);
    for mode in 0..2 {
        let f: Vec<f64> = rising.iter().map(|f| f[mode]).collect();
        assert!(f.windows(2).all(|w| w[0] < w[1]), "{f:?}");
        let limit = |soft: f64, stiff: f64| (10.0 * stiff - soft) / 9.0;
        let [right, wrong] = [f[4], wrong[mode]].map(|middle| miss(limit(f[3], middle), limit(middle, f[5])));
        held("stiff limit", 2e-6, right, wrong);
    }
}

/// What the mass adds vanishes with the speed: convective, local and no inertia agree at 0.5 m/s within 0.1 %, a fiftieth
/// of what they differ by at 15 m/s. Twin: the load.
#[test]
fn inertia_vanishes_with_the_speed() {
    let of = |inertia: Inertia, speed_m_s: f64, load_n: f64| {
        curves(&cross(&two_tracks(inertia), 0.01, |x| {
            (x.speed_m_s, x.load_n) = (speed_m_s, load_n)
        }))
    };
    let [slow, fast] = [0.5, 15.0].map(|speed_m_s| of(Inertia::Local, speed_m_s, LOAD_N));
    for inertia in [Inertia::None, Inertia::Convective] {
        let away = |load_n: f64| apart(&of(inertia, 0.5, load_n), &slow);
        held(
            &format!("{inertia:?} against local, slow"),
            1e-3,
            away(LOAD_N),
            away(1.05 * LOAD_N),
        );
        let away = apart(&of(inertia, 15.0, LOAD_N), &fast);
        assert!(away > 0.05, "{inertia:?} against local at 15 m/s: {away}");
    }
}

/// A patch two elements long whose middle is a mesh line: two points integrate the bilinear deck exactly, 1e-12. Elsewhere
/// the midpoint rule of eight points misses the lines by 1e-4. Twin of both: the patch's length.
#[test]
fn points_of_a_patch_integrate_its_footprint() {
    let at = |points: usize, length_m: f64, x_m: f64| {
        let vehicle = axles(&[(0.0, 1.0, length_m)], Inertia::None, points);
        let case = smoke().case(Connection::Linear, LOAD_N, x_m);
        smoke().statics(&vehicle).solve(&case).expect("solved").deflection_m
    };
    let length_m = 3.35;
    for (points, x_m, tolerance) in [(2, 8.375, 1e-12), (8, 9.0, 1e-4)] {
        let exact = at(64, length_m, x_m);
        let [right, long] = [1.0, 1.05].map(|f| apart(&at(points, f * length_m, x_m), &exact));
        held(&format!("{points} points at {x_m} m"), tolerance, right, long);
    }
}

/// Two motions of a rigid module on water, heave and pitch about its middle, driven by moving points. Fourth-order
/// Runge-Kutta with steps far below the crossing solver's.
#[derive(Clone)]
struct Rigid {
    /// Mass `[kg]` and moment of inertia `[kg m^2]`, water included.
    m: [f64; 2],
    /// Stiffness of the water, N/m and N m.
    k: [f64; 2],
    rayleigh: Rayleigh,
    length_m: f64,
    speed_m_s: f64,
    /// For each point its place ahead of the front `[m]` and its weight `[N]`.
    points: Vec<(f64, f64)>,
    /// Mass over weight, per gravity.
    mass_factor: f64,
    inertia: Inertia,
}

impl Rigid {
    /// Time derivative of heave, pitch and their velocities.
    fn rate(&self, t: f64, y: [f64; 4]) -> [f64; 4] {
        let Rayleigh { a, b, .. } = self.rayleigh;
        let damped = |i: usize| -self.k[i] * y[i] - (a * self.k[i] + b * self.m[i]) * y[i + 2];
        let (mut m, mut f) = ([[self.m[0], 0.0], [0.0, self.m[1]]], [damped(0), damped(1)]);
        for &(ahead, weight) in &self.points {
            let s = self.speed_m_s * t + ahead;
            if !(0.0..=self.length_m).contains(&s) {
                continue;
            }
            let n = [1.0, s - 0.5 * self.length_m];
            let mass = if self.inertia == Inertia::None {
                0.0
            } else {
                self.mass_factor * weight / 9.80665
            };
            // along a straight deck the path's second derivative is u'' + 2 V slope'
            let known = if self.inertia == Inertia::Convective {
                2.0 * self.speed_m_s * y[3]
            } else {
                0.0
            };
            for i in 0..2 {
                f[i] -= n[i] * (weight + mass * known);
                for j in 0..2 {
                    m[i][j] += n[i] * mass * n[j];
                }
            }
        }
        let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        let heave = (f[0] * m[1][1] - f[1] * m[0][1]) / det;
        [y[2], y[3], heave, (f[1] * m[0][0] - f[0] * m[1][0]) / det]
    }

    /// Deflections of both ends at whole steps.
    fn ends(&self, h: f64, steps: usize) -> Vec<f64> {
        let parts = 20;
        let (mut y, mut ends) = ([0.0; 4], vec![0.0, 0.0]);
        let dt = h / parts as f64;
        let to = |y: [f64; 4], k: [f64; 4], c: f64| std::array::from_fn::<f64, 4, _>(|i| y[i] + c * k[i]);
        for n in 0..steps * parts {
            let t = n as f64 * dt;
            let a = self.rate(t, y);
            let b = self.rate(t + 0.5 * dt, to(y, a, 0.5 * dt));
            let c = self.rate(t + 0.5 * dt, to(y, b, 0.5 * dt));
            let d = self.rate(t + dt, to(y, c, dt));
            y = std::array::from_fn(|i| y[i] + dt / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            if (n + 1) % parts == 0 {
                let half = 0.5 * self.length_m;
                ends.extend([half * y[1] - y[0], -half * y[1] - y[0]]);
            }
        }
        ends
    }
}

/// One module, a thousand times stiffer, floating free under a vehicle: two equations of motion, integrated here by other
/// means, for all three kinds of inertia, with damping. The first follow the free decay for a second, the convective one
/// ends as the vehicle leaves: over the step at a free end the path has no second derivative, so that its patch is short,
/// to come on within a step (with 0.1 m the entry alone makes 1 %). 5e-4: points come onto the
/// bridge within a step of 1 ms, a five-hundredth of the crossing; the module's own bending is 1e-5. Twins: the vehicle's
/// mass at the same weight, Rayleigh's a and b, the weight.
#[test]
fn rigid_module_follows_two_equations_of_motion() {
    let tolerance = 5e-4;
    let d = with(&with_e(&design("smoke"), 1e3), |d| {
        d.modules = 1;
        d.water_distribution = WaterDistribution::Consistent;
    });
    let ready = Ready::new(&d, Model::SuperElement);
    let (l, b, h, speed_m_s) = (d.module.length_m, d.module.breadth_m, 0.001, 3.0);
    // the pitching mass is taken from the pitching frequency, the rest is by hand
    let pitch = d.p_b() * b * l.powi(3) / 12.0;
    let omega = 2.0 * std::f64::consts::PI * frequency_hz(&ready.modes(8), "pitch");
    let damping = Rayleigh::new(0.05, 0.3);
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let list = [(0.1, 0.4, 0.1), (2.1, 0.6, 0.1)];
        let vehicle = match inertia {
            Inertia::Convective => axles(&[(0.1, 1.0, 0.003)], inertia, 4),
            _ => axles(&list, inertia, 4),
        };
        let by_hand = Rigid {
            m: [ready.module.structural_mass_kg() + d.m_a() * l, pitch / omega.powi(2)],
            k: [d.p_b() * b * l, pitch],
            rayleigh: damping,
            length_m: l,
            speed_m_s,
            points: vehicle.points().map(|p| (p.ahead_m, p.share * LOAD_N)).collect(),
            mass_factor: 1.0,
            inertia,
        };
        let solver = Crossings::new(&ready.free, &vehicle, &settings(damping, h, 0.9));
        let mut crossing = ready.crossing(Connection::Linear, LOAD_N, speed_m_s);
        crossing.record = Record {
            positions: vec![1, 2],
            joints: vec![],
            ..Record::default()
        };
        let r = solver.solve(&crossing).expect("solved");
        // the motion starts from rest a step before the first point comes on, which is the front or somewhat behind it
        let late = (r.recorded.history_time_s[1] / h).round() as usize;
        let behind_m = vehicle.points().map(|p| -p.ahead_m).fold(f64::INFINITY, f64::min);
        assert_eq!(late, (behind_m / speed_m_s / h).ceil() as usize);
        assert!((r.recorded.history_time_s[0] - (late as f64 - 1.0) * h).abs() < 1e-9);
        let steps = match inertia {
            Inertia::Convective => (l / speed_m_s / h) as usize - late,
            _ => r.recorded.history_time_s.len() - 2,
        };
        let ends = history(&r, Quantity::Deflection, 1)
            .iter()
            .zip(history(&r, Quantity::Deflection, 2));
        let found: Vec<f64> = ends
            .skip(1)
            .take(steps + 1)
            .flat_map(|(left, right)| [*left, *right])
            .collect();
        let away = |change: fn(&mut Rigid)| {
            let mut changed = by_hand.clone();
            change(&mut changed);
            apart(&found, &changed.ends(h, late + steps)[2 * late..])
        };
        let right = away(|_| {});
        held(
            &format!("rigid, {inertia:?}, a"),
            tolerance,
            right,
            away(|r| r.rayleigh.a *= 1.05),
        );
        held(
            &format!("rigid, {inertia:?}, b"),
            tolerance,
            right,
            away(|r| r.rayleigh.b *= 1.05),
        );
        held(
            &format!("rigid, {inertia:?}, weight"),
            tolerance,
            right,
            away(|r| {
                r.points.iter_mut().for_each(|p| p.1 *= 1.05);
                r.mass_factor /= 1.05;
            }),
        );
        if inertia != Inertia::None {
            held(
                &format!("rigid, {inertia:?}, mass"),
                tolerance,
                right,
                away(|r| r.mass_factor *= 1.05),
            );
        }
        if inertia == Inertia::Convective {
            let local = away(|r| r.inertia = Inertia::Local);
            held("rigid, convective terms", tolerance, right, local);
        }
    }
}
