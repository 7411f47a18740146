//! Masses on springs: a body on suspensions, the masses of axles on tyres.
//!
//! Knows matrices, wheels and the state at rest, all upward positive. Does not know the deck or time.
//!
//! A wheel is one patch. Its spring stands on the deck: the tyre, or where there is none the suspension itself. The vehicle moves by
//! `M z'' + C z' + K z = -W + G^T lambda`, K and C those of what is above the wheels' springs, lambda their forces.

use super::GRAVITY_M_S2;
use super::written::{Axle, Body};
use crate::input::{Found, InvalidInput, Problem, bound, not_negative, positive};
use crate::response::BodyMotion;
use nalgebra::{DMatrix, DVector};

/// How a vehicle on springs may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VehicleMotion {
    /// The body's centre, up.
    Bounce,
    /// The body's front, up.
    Pitch,
    /// The body's left side, up.
    Roll,
    /// The mass above the tyre of a patch, up.
    Hop {
        /// Number of the patch, from 0.
        patch: usize,
    },
}

/// The spring of one patch on the deck.
#[derive(Debug, Clone, PartialEq)]
pub struct SpringWheel {
    /// How far its upper end rises with each motion, a row of G.
    pub row: Vec<f64>,
    /// Stiffness `[N/m]`.
    pub stiffness_n_m: f64,
    /// Damping `[N s/m]`.
    pub damping_n_s_m: f64,
    /// Force at rest on a level road `[N]`.
    pub rest_n: f64,
}

/// A vehicle on springs.
#[derive(Debug, Clone, PartialEq)]
pub struct Springs {
    /// What moves, in the order of all lists.
    pub motions: Vec<VehicleMotion>,
    /// Masses `[kg]` and moments of inertia `[kg m^2]`.
    pub inertia: Vec<f64>,
    /// Stiffness K above the wheels' springs.
    pub stiffness: DMatrix<f64>,
    /// Damping C above them.
    pub damping: DMatrix<f64>,
    /// Weights, downward `[N]`.
    pub weight_n: Vec<f64>,
    /// The springs on the deck, one a patch.
    pub wheels: Vec<SpringWheel>,
    /// The state at rest on a level road, from springs without force `[m, rad]`.
    pub rest: Vec<f64>,
    /// Mass of the body times the height of its centre `[kg m]`: its product with a forward acceleration lifts the front.
    pub braking_kg_m: f64,
    /// The motions of the body, each with its place among all.
    pub body: Vec<(BodyMotion, usize)>,
    /// Weight that lies on the deck without a spring, of each patch `[N]`.
    rigid_n: Vec<f64>,
    /// Axle of each patch.
    axles: Vec<usize>,
}

/// One patch of an axle while matrices are written.
struct Wheel<'a> {
    axle: &'a Axle,
    number: usize,
    y_m: f64,
    /// Tracks that share what the axle has.
    tracks: f64,
}

impl Wheel<'_> {
    fn of(&self, whole: Option<f64>) -> f64 {
        whole.unwrap_or(0.0) / self.tracks
    }
}

impl VehicleMotion {
    /// What it is to the body; none of an axle's.
    pub fn of_body(self) -> Option<BodyMotion> {
        match self {
            Self::Bounce => Some(BodyMotion::Bounce),
            Self::Pitch => Some(BodyMotion::Pitch),
            Self::Roll => Some(BodyMotion::Roll),
            Self::Hop { .. } => None,
        }
    }
}

impl Springs {
    /// The springs of checked places; none of a vehicle without any.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path of a mass, stiffness or damping that may not be, of what nothing holds up.
    pub(super) fn of(axles: &[Axle], body: Option<&Body>) -> Result<Option<Self>, InvalidInput> {
        for (k, axle) in axles.iter().enumerate() {
            check_axle(axle, body.is_some()).map_err(|e| e.under(&format!("axles[{k}]")))?;
        }
        if let Some(body) = body {
            check_body(body, axles).map_err(|e| e.under("body"))?;
        } else if axles.iter().all(|axle| axle.tyre_stiffness_n_m.is_none()) {
            return Ok(None);
        }
        for (k, axle) in axles.iter().enumerate() {
            let sprung = axle.tyre_stiffness_n_m.or(axle.suspension_stiffness_n_m);
            if sprung.is_none() {
                let key = format!(
                    "axles[{k}].{}",
                    if body.is_some() {
                        "suspension_stiffness_n_m"
                    } else {
                        "tyre_stiffness_n_m"
                    }
                );
                let refused = InvalidInput::new(key, Found::Nothing, "a spring of every axle, where one has any");
                return Err(refused.because(Problem::Missing));
            }
        }
        Self::assembled(axles, body).map(Some)
    }

    fn assembled(axles: &[Axle], body: Option<&Body>) -> Result<Self, InvalidInput> {
        let wheels: Vec<Wheel<'_>> = axles
            .iter()
            .enumerate()
            .flat_map(|(number, axle)| {
                let tracks = axle.track_y_m.len() as f64;
                axle.track_y_m.iter().map(move |&y_m| Wheel {
                    axle,
                    number,
                    y_m,
                    tracks,
                })
            })
            .collect();
        let (mut motions, mut inertia) = (Vec::new(), Vec::new());
        if let Some(body) = body {
            let pitch = body.pitch_inertia_kg_m2.map(|of| (VehicleMotion::Pitch, of));
            let roll = body.roll_inertia_kg_m2.map(|of| (VehicleMotion::Roll, of));
            let all = [Some((VehicleMotion::Bounce, body.mass_kg)), pitch, roll];
            (motions, inertia) = all.into_iter().flatten().unzip();
        }
        let of_body = motions.len();
        for (patch, wheel) in wheels.iter().enumerate() {
            if wheel.axle.tyre_stiffness_n_m.is_some() && wheel.axle.unsprung_mass_kg.is_some() {
                motions.push(VehicleMotion::Hop { patch });
                inertia.push(wheel.of(wheel.axle.unsprung_mass_kg));
            }
        }
        let n = motions.len();
        let body_row = |wheel: &Wheel<'_>| -> Vec<f64> {
            let ahead_m = body.map_or(0.0, |body| body.behind_front_m - wheel.axle.behind_front_m);
            let mut row = vec![0.0; n];
            for (entry, motion) in row.iter_mut().zip(&motions[..of_body]) {
                *entry = match motion {
                    VehicleMotion::Pitch => ahead_m,
                    VehicleMotion::Roll => wheel.y_m,
                    _ => 1.0,
                };
            }
            row
        };
        let (mut stiffness, mut damping) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        let mut on_deck = Vec::new();
        for (patch, wheel) in wheels.iter().enumerate() {
            let axle = wheel.axle;
            let hop = motions
                .iter()
                .position(|motion| *motion == VehicleMotion::Hop { patch });
            let mut row = body_row(wheel);
            let (mut k, mut c) = (axle.suspension_stiffness_n_m, axle.suspension_damping_n_s_m);
            if let Some(hop) = hop {
                if k.is_some() {
                    row[hop] = -1.0;
                    let row = DVector::from_vec(std::mem::take(&mut row));
                    let outer = &row * row.transpose();
                    stiffness += &outer * wheel.of(k);
                    damping += &outer * wheel.of(c);
                }
                row = vec![0.0; n];
                row[hop] = 1.0;
            }
            if axle.tyre_stiffness_n_m.is_some() {
                (k, c) = (axle.tyre_stiffness_n_m, axle.tyre_damping_n_s_m);
            }
            on_deck.push(SpringWheel {
                row,
                stiffness_n_m: wheel.of(k),
                damping_n_s_m: wheel.of(c),
                rest_n: 0.0,
            });
        }
        let weight = |(motion, mass): (&VehicleMotion, &f64)| match motion {
            VehicleMotion::Bounce | VehicleMotion::Hop { .. } => mass * GRAVITY_M_S2,
            VehicleMotion::Pitch | VehicleMotion::Roll => 0.0,
        };
        let rides = |wheel: &Wheel<'_>| match wheel.axle.tyre_stiffness_n_m {
            None => wheel.of(wheel.axle.unsprung_mass_kg) * GRAVITY_M_S2,
            Some(_) => 0.0,
        };
        let mut springs = Self {
            weight_n: motions.iter().zip(&inertia).map(weight).collect(),
            rigid_n: wheels.iter().map(rides).collect(),
            axles: wheels.iter().map(|wheel| wheel.number).collect(),
            braking_kg_m: body.map_or(0.0, |body| body.mass_kg * body.height_m.unwrap_or(0.0)),
            rest: vec![0.0; n],
            body: (0..)
                .zip(&motions)
                .filter_map(|(place, motion)| Some((motion.of_body()?, place)))
                .collect(),
            motions,
            inertia,
            stiffness,
            damping,
            wheels: on_deck,
        };
        springs.come_to_rest()?;
        Ok(springs)
    }

    /// K and the stiffness of the wheels' springs on a deck that stands still.
    pub fn whole_stiffness(&self) -> DMatrix<f64> {
        let mut whole = self.stiffness.clone();
        for wheel in &self.wheels {
            let row = DVector::from_column_slice(&wheel.row);
            whole += &row * row.transpose() * wheel.stiffness_n_m;
        }
        whole
    }

    /// Finds the state at rest, `(K + G^T k G) z_0 = -W`, and the wheels' forces there.
    fn come_to_rest(&mut self) -> Result<(), InvalidInput> {
        let free =
            |found: String, allowed: &str| Err(InvalidInput::new("body", found, allowed).because(Problem::Conflict));
        let whole = self.whole_stiffness();
        // each motion by its own stiffness: what is left of a free one is rounding
        let scale: Vec<f64> = whole
            .diagonal()
            .iter()
            .map(|k| 1.0 / k.max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| whole[(i, j)] * scale[i] * scale[j]);
        let least = scaled.clone().symmetric_eigenvalues().min();
        let Some(factor) = scaled.cholesky().filter(|_| least > FREE) else {
            return free(
                "a motion that no spring holds".to_owned(),
                "wheels at two places along where it pitches, and across where it rolls",
            );
        };
        let pressed = DVector::from_fn(scale.len(), |i, _| -self.weight_n[i] * scale[i]);
        let rest = factor.solve(&pressed);
        self.rest = rest.iter().zip(&scale).map(|(z, scale)| z * scale).collect();
        for (number, wheel) in self.wheels.iter_mut().enumerate() {
            let height: f64 = wheel.row.iter().zip(&self.rest).map(|(g, z)| g * z).sum();
            wheel.rest_n = -wheel.stiffness_n_m * height;
            if wheel.rest_n <= 0.0 {
                let axle = self.axles[number] + 1;
                return free(
                    format!("a centre that lifts axle {axle} off the road at rest"),
                    "a centre of mass between the axles, so that each presses the road",
                );
            }
        }
        Ok(())
    }

    /// The springs of one side: of each patch its image is given, and which patches are kept. A wheel that is kept and the mass above
    /// it stand for both images and move as each; the body does not roll. None of springs that are not their own image.
    pub(super) fn one_side(&self, images: &[usize], kept: &[usize]) -> Option<Self> {
        let alike = |(patch, &image): (usize, &usize)| {
            let [own, other] = [patch, image].map(|i| (self.wheels[i].stiffness_n_m, self.wheels[i].damping_n_s_m));
            own == other && self.axles[patch] == self.axles[image] && self.rigid_n[patch] == self.rigid_n[image]
        };
        if !images.iter().enumerate().all(alike) {
            return None;
        }
        // the motions of the whole that each motion of the side stands for
        let mut stands_for: Vec<(VehicleMotion, Vec<usize>)> = Vec::new();
        for (place, motion) in self.motions.iter().enumerate() {
            let VehicleMotion::Hop { patch } = *motion else {
                stands_for.push((*motion, vec![place]));
                continue;
            };
            let Some(patch_of_side) = kept.iter().position(|own| *own == patch) else {
                continue;
            };
            let hop_of = |patch: usize| self.motions.iter().position(|of| *of == VehicleMotion::Hop { patch });
            let mut places = vec![place];
            if images[patch] != patch {
                places.push(hop_of(images[patch])?);
            }
            stands_for.push((VehicleMotion::Hop { patch: patch_of_side }, places));
        }
        let n = stands_for.len();
        let rolls = |i: usize| stands_for[i].0 == VehicleMotion::Roll;
        let sum = |of: &[f64]| -> Vec<f64> {
            let places = stands_for.iter().map(|(_, places)| places);
            places.map(|places| places.iter().map(|&i| of[i]).sum()).collect()
        };
        let reduced = |of: &DMatrix<f64>| {
            DMatrix::from_fn(n, n, |i, j| {
                // what rolls is no image of what does not
                if rolls(i) != rolls(j) {
                    return 0.0;
                }
                let rows = stands_for[i].1.iter();
                rows.flat_map(|&row| stands_for[j].1.iter().map(move |&column| (row, column)))
                    .map(|at| of[at])
                    .sum()
            })
        };
        let wheel = |&patch: &usize| {
            let (of, both) = (&self.wheels[patch], if images[patch] == patch { 1.0 } else { 2.0 });
            let row = sum(&of.row);
            SpringWheel {
                row: (0..n).map(|i| if rolls(i) { 0.0 } else { row[i] }).collect(),
                stiffness_n_m: both * of.stiffness_n_m,
                damping_n_s_m: both * of.damping_n_s_m,
                rest_n: if images[patch] == patch {
                    of.rest_n
                } else {
                    of.rest_n + self.wheels[images[patch]].rest_n
                },
            }
        };
        let rest = |(motion, places): &(VehicleMotion, Vec<usize>)| match motion {
            VehicleMotion::Roll => 0.0,
            _ => self.rest[places[0]],
        };
        let both = |of: &[f64]| -> Vec<f64> {
            let with_image = |&patch: &usize| of[patch] * if images[patch] == patch { 1.0 } else { 2.0 };
            kept.iter().map(with_image).collect()
        };
        Some(Self {
            inertia: sum(&self.inertia),
            stiffness: reduced(&self.stiffness),
            damping: reduced(&self.damping),
            weight_n: sum(&self.weight_n),
            wheels: kept.iter().map(wheel).collect(),
            rest: stands_for.iter().map(rest).collect(),
            braking_kg_m: self.braking_kg_m,
            body: self.body.clone(),
            rigid_n: both(&self.rigid_n),
            axles: kept.iter().map(|&patch| self.axles[patch]).collect(),
            motions: stands_for.into_iter().map(|(motion, _)| motion).collect(),
        })
    }

    /// Weight of all masses `[N]`.
    pub fn whole_weight_n(&self) -> f64 {
        self.weight_n.iter().chain(&self.rigid_n).sum()
    }

    /// Share of the weight that a patch carries at rest, and what of that lies on the deck without a spring.
    pub(super) fn patch_shares(&self, patch: usize) -> (f64, f64) {
        let carried_n = self.wheels[patch].rest_n + self.rigid_n[patch];
        (carried_n / self.whole_weight_n(), self.rigid_n[patch] / carried_n)
    }

    /// Share of the weight that each axle carries at rest.
    pub(super) fn axle_shares(&self, axles: &[Axle]) -> Vec<f64> {
        let mut shares = vec![0.0; axles.len()];
        for (patch, &axle) in self.axles.iter().enumerate() {
            shares[axle] += self.patch_shares(patch).0;
        }
        shares
    }

    /// Natural frequencies on a deck that stands still, without damping, increasing `[Hz]`.
    pub fn frequencies_hz(&self) -> Vec<f64> {
        let whole = self.whole_stiffness();
        let per_mass = DMatrix::from_fn(whole.nrows(), whole.nrows(), |i, j| {
            whole[(i, j)] / (self.inertia[i] * self.inertia[j]).sqrt()
        });
        let eigenvalues = per_mass.symmetric_eigenvalues();
        let hertz = |value: &f64| value.max(0.0).sqrt() / std::f64::consts::TAU;
        let mut frequencies_hz: Vec<f64> = eigenvalues.iter().map(hertz).collect();
        frequencies_hz.sort_by(f64::total_cmp);
        frequencies_hz
    }
}

/// Share of its own stiffness below which a motion is held by rounding alone.
const FREE: f64 = 1e-10;

fn check_axle(axle: &Axle, has_body: bool) -> Result<(), InvalidInput> {
    let optional = |key: &str, value: Option<f64>, check: fn(&str, f64) -> Result<f64, InvalidInput>| {
        value.map_or(Ok(()), |value| check(key, value).map(|_| ()))
    };
    optional("unsprung_mass_kg", axle.unsprung_mass_kg, positive)?;
    optional("tyre_stiffness_n_m", axle.tyre_stiffness_n_m, positive)?;
    optional("tyre_damping_n_s_m", axle.tyre_damping_n_s_m, not_negative)?;
    optional("suspension_stiffness_n_m", axle.suspension_stiffness_n_m, positive)?;
    optional("suspension_damping_n_s_m", axle.suspension_damping_n_s_m, not_negative)?;
    let misplaced =
        |key: &str, value: f64, allowed: &str| Err(InvalidInput::new(key, value, allowed).because(Problem::Misplaced));
    let missing =
        |key: &str, allowed: &str| Err(InvalidInput::new(key, Found::Nothing, allowed).because(Problem::Missing));
    let (tyre, suspension) = (axle.tyre_stiffness_n_m, axle.suspension_stiffness_n_m);
    if let (Some(damping), None) = (axle.tyre_damping_n_s_m, tyre) {
        return misplaced("tyre_damping_n_s_m", damping, "a tyre_stiffness_n_m beside it");
    }
    if let (Some(damping), None) = (axle.suspension_damping_n_s_m, suspension) {
        return misplaced(
            "suspension_damping_n_s_m",
            damping,
            "a suspension_stiffness_n_m beside it",
        );
    }
    match (axle.unsprung_mass_kg, tyre, suspension) {
        (_, _, Some(stiffness)) if !has_body => misplaced(
            "suspension_stiffness_n_m",
            stiffness,
            "a body that the suspension carries",
        ),
        (None, Some(_), Some(_)) => missing("unsprung_mass_kg", "the mass between tyres and suspension"),
        (None, Some(_), None) if !has_body => missing("unsprung_mass_kg", "the mass on the tyres"),
        (Some(_), Some(_), None) if has_body => missing(
            "suspension_stiffness_n_m",
            "the suspension between the axle's mass and the body",
        ),
        (Some(mass), None, None) => misplaced(
            "unsprung_mass_kg",
            mass,
            "a tyre_stiffness_n_m or a suspension beside it",
        ),
        _ => Ok(()),
    }
}

fn check_body(body: &Body, axles: &[Axle]) -> Result<(), InvalidInput> {
    positive("mass_kg", body.mass_kg)?;
    not_negative("behind_front_m", body.behind_front_m)?;
    for (key, inertia) in [
        ("pitch_inertia_kg_m2", body.pitch_inertia_kg_m2),
        ("roll_inertia_kg_m2", body.roll_inertia_kg_m2),
    ] {
        inertia.map_or(Ok(0.0), |inertia| positive(key, inertia))?;
    }
    body.height_m
        .map_or(Ok(0.0), |height_m| not_negative("height_m", height_m))?;
    if body.pitch_inertia_kg_m2.is_none() {
        let apart = |axle: &&Axle| (axle.behind_front_m - body.behind_front_m).abs() > 1e-9;
        if let Some(axle) = axles.iter().find(apart) {
            let allowed = format!(
                "a moment of inertia, as an axle stands {} m from the centre",
                bound((axle.behind_front_m - body.behind_front_m).abs())
            );
            let refused = InvalidInput::new("pitch_inertia_kg_m2", Found::Nothing, allowed);
            return Err(refused.because(Problem::Missing));
        }
    }
    Ok(())
}
