//! Vehicles on springs cross a simple span: numbers of two independent programs, published ones, and limits.
//!
//! Sketch: a beam EI, mu a metre, of span L on simple supports, at rest; a vehicle stands at rest on its springs and comes on at
//! t = 0. `M u'' + K u = -sum of r_i^T lambda_i`, `M_v z'' + C_v z' + K_v z = -W + G^T lambda`,
//! `lambda_i = max(0, k_i d_i + c_i d_i')`, `d_i = r_i u + rho_i - G_i z`. Expected numbers are converged ones of a program in sine
//! modes and, where that is said, of an integrator of another kind (DOP853), both written for this purpose; beside them the
//! published ones that the same cases have. Their gravity is 9.81 m/s^2: the equations are linear while wheels press, so that a road
//! and answers are scaled from the engine's 9.80665.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::{Crossing, CrossingSolver};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{Quantity, Record};
use pontoon_core::road::{RoadDesign, Ways};
use pontoon_core::traffic::{Drive, Driven, Traffic};
use pontoon_core::vehicle::{Axle, Body, GRAVITY_M_S2, Inertia, Vehicle, VehicleDesign};
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::sync::Arc;

const SPAN_M: f64 = 25.0;
/// Gravity of the expected numbers over the engine's.
const HEAVIER: f64 = 9.81 / GRAVITY_M_S2;

/// A span and what crosses it.
#[derive(Debug, Clone)]
struct Case {
    ei: f64,
    mass_kg_m: f64,
    rayleigh: Rayleigh,
    vehicle: VehicleDesign,
    speed_m_s: f64,
    acceleration_m_s2: f64,
    /// Height of a ramp from L/3 to L/2, the road behind it as high `[m]`.
    ramp_m: f64,
    elements: usize,
    time_step_s: f64,
    radius: f64,
}

/// What a case answers.
#[derive(Debug, Clone, Copy)]
struct Found {
    /// Largest midspan deflection `[mm]` and when `[s]`.
    peak_mm: f64,
    time_s: f64,
    /// Smallest and largest force of the wheels together while on the span `[kN]`.
    contact_kn: [f64; 2],
    energy_residual: f64,
}

/// One axle on both lines of the span.
fn axle() -> Axle {
    Axle {
        track_y_m: vec![-1.0, 1.0],
        ..Axle::default()
    }
}

/// A mass on a spring and a damper.
fn sprung(mass_kg: f64, stiffness: f64, damping: f64) -> VehicleDesign {
    VehicleDesign {
        axles: Some(vec![Axle {
            unsprung_mass_kg: Some(mass_kg),
            tyre_stiffness_n_m: Some(stiffness),
            tyre_damping_n_s_m: Some(damping),
            ..axle()
        }]),
        ..VehicleDesign::default()
    }
}

impl Case {
    /// The span of 18,358 kg/m under 5,750 kg on 1.595e6 N/m at 25 m/s.
    fn plain() -> Self {
        Self {
            ei: 3.5e10 * 1.3901,
            mass_kg_m: 18_358.0,
            rayleigh: Rayleigh { a: 0.0, b: 0.0 },
            vehicle: sprung(5750.0, 1.595e6, 0.0),
            speed_m_s: 25.0,
            acceleration_m_s2: 0.0,
            ramp_m: 0.0,
            elements: 40,
            time_step_s: 2.5e-4,
            radius: 0.9,
        }
    }

    /// The span of the classical case.
    fn classical() -> Self {
        Self {
            ei: 2.87e9 * 2.90,
            mass_kg_m: 2303.0,
            speed_m_s: 100.0 / 3.6,
            ..Self::plain()
        }
    }

    fn traffic(&self, vehicle: &Vehicle) -> Traffic {
        let mut traffic = Traffic {
            vehicles: vec![Driven {
                load_n: vehicle.weight_n.unwrap_or(5750.0 * GRAVITY_M_S2),
                vehicle: Arc::new(vehicle.clone()),
                drive: Drive {
                    acceleration_m_s2: self.acceleration_m_s2,
                    ..Drive::steady(self.speed_m_s)
                },
            }],
            road: None,
        };
        if self.ramp_m != 0.0 {
            let height_m = self.ramp_m / HEAVIER;
            let table = [
                [0.0, 0.0],
                [SPAN_M / 3.0, 0.0],
                [0.5 * SPAN_M, height_m],
                [SPAN_M, height_m],
            ];
            let design = RoadDesign {
                table: Some(table.to_vec()),
                ..RoadDesign::default()
            };
            let ways = Ways {
                length_m: SPAN_M,
                beyond_m: 0.0,
                y_m: &[],
            };
            traffic.road = Some(Arc::new(design.road(&ways).expect("a road")));
        }
        traffic
    }

    fn solve(&self) -> Found {
        let module = BeamModule::slender(0.5 * SPAN_M, self.elements, self.ei, self.mass_kg_m, 1e4);
        let ready = module.ready(&module.design(2, 1e-3, 0.0, module.continuous_n_m(1e9)), Model::Full);
        let crossing = Crossing {
            tail_s: 0.0,
            record: Record {
                positions: vec![2],
                ..Record::default()
            },
            ..ready.crossing(Connection::Linear, 1.0, 1.0).crossing()
        };
        let vehicle = self.vehicle.check(module.breadth_m).expect("a vehicle");
        let traffic = self.traffic(&vehicle);
        let settings = settings(self.rayleigh, self.time_step_s, self.radius);
        let solver = CrossingSolver::new(&ready.bridge, &settings).expect("factors");
        let mut run = solver.begin(&traffic, &crossing);
        let mut contact_kn = [f64::INFINITY, 0.0_f64];
        while run.step().expect("a step") {
            let state = run.snapshot();
            if let Some(ride) = state.rides.first()
                && state.wheels.iter().all(|wheel| wheel.row.is_some())
            {
                let sum = 1e-3 * HEAVIER * ride.wheels_n.iter().sum::<f64>();
                contact_kn = [contact_kn[0].min(sum), contact_kn[1].max(sum)];
            }
        }
        let r = run.finish();
        let (times, deflection_m) = (&r.recorded.history_time_s, history(&r, Quantity::Deflection, 2));
        let mut peak = (0.0, 0.0);
        for (t, w) in times.iter().zip(deflection_m) {
            if *w > peak.0 {
                peak = (*w, *t);
            }
        }
        Found {
            peak_mm: 1e3 * HEAVIER * peak.0,
            time_s: peak.1,
            contact_kn,
            energy_residual: r.energy.energy_residual,
        }
    }
}

/// Body of the two masses: the bogie on its suspension over the wheel, which stands on a contact spring.
fn two_masses() -> VehicleDesign {
    VehicleDesign {
        axles: Some(vec![Axle {
            unsprung_mass_kg: Some(5750.0),
            tyre_stiffness_n_m: Some(1.0 / 9.1e-8),
            suspension_stiffness_n_m: Some(1.595e8),
            suspension_damping_n_s_m: Some(1000.0),
            ..axle()
        }]),
        body: Some(Body {
            mass_kg: 3000.0,
            behind_front_m: 0.0,
            pitch_inertia_kg_m2: None,
            roll_inertia_kg_m2: None,
            height_m: None,
        }),
        ..VehicleDesign::default()
    }
}

#[test]
fn look() {
    let rigid = |inertia| VehicleDesign {
        axles: Some(vec![Axle {
            share: Some(1.0),
            patch_length_m: if inertia == Inertia::Convective { 0.05 } else { 0.0 },
            ..axle()
        }]),
        inertia,
        ..VehicleDesign::default()
    };
    let cases = [
        ("plain", Case::plain()),
        (
            "ramp",
            Case {
                ramp_m: 0.01,
                ..Case::plain()
            },
        ),
        (
            "ramp damped",
            Case {
                ramp_m: 0.01,
                vehicle: sprung(5750.0, 1.595e6, 4e5),
                ..Case::plain()
            },
        ),
        (
            "accelerated",
            Case {
                ramp_m: 0.01,
                vehicle: sprung(5750.0, 1.595e6, 4e5),
                acceleration_m_s2: 10.0,
                ..Case::plain()
            },
        ),
        ("classical", Case::classical()),
        (
            "soft",
            Case {
                vehicle: sprung(5750.0, 1e2, 0.0),
                ..Case::classical()
            },
        ),
        (
            "stiff",
            Case {
                vehicle: sprung(5750.0, 1e10, 0.0),
                ..Case::classical()
            },
        ),
        (
            "none",
            Case {
                vehicle: rigid(Inertia::None),
                ..Case::classical()
            },
        ),
        (
            "convective",
            Case {
                vehicle: rigid(Inertia::Convective),
                ..Case::classical()
            },
        ),
        (
            "local",
            Case {
                vehicle: rigid(Inertia::Local),
                ..Case::classical()
            },
        ),
        (
            "two masses",
            Case {
                ei: 2.87e9 * 0.29,
                mass_kg_m: 230.3,
                rayleigh: Rayleigh { a: 0.001, b: 0.01 },
                vehicle: two_masses(),
                ..Case::classical()
            },
        ),
    ];
    for (what, case) in cases {
        for elements in [20, 40, 80] {
            println!(
                "{what} {elements}: {:?}",
                Case {
                    elements,
                    ..case.clone()
                }
                .solve()
            );
        }
    }
}
