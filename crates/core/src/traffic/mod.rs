//! Traffic: which vehicles drive over a bridge, how fast, when and which way.
//!
//! Knows each vehicle's way against time and whether two run into each other; `design` is a traffic as it is written. Does not know
//! the deck's motion.

mod design;

use crate::input::{InvalidInput, Problem, bound, positive};
use crate::response::RidePart;
use crate::road::Road;
use crate::vehicle::Vehicle;
pub use design::{ColumnDesign, Deck, SpacingFrom, StudyVehicle, TrafficDesign, TrafficEntry, VehicleOrFile};
use std::sync::Arc;

/// How a vehicle drives. Its way is what its front has covered since the end of the bridge that it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Speed until it accelerates or brakes `[m/s]`, above 0.
    pub speed_m_s: f64,
    /// Whether it comes from the right end and drives toward x = 0.
    pub backward: bool,
    /// When its front is at that end `[s]`.
    pub start_s: f64,
    /// Acceleration from there on, or that of braking to a stop `[m/s^2]`.
    pub acceleration_m_s2: f64,
    /// Way after which it stands `[m]`; it brakes as late as it may.
    pub stop_way_m: Option<f64>,
}

/// A vehicle's way, speed and acceleration along its direction at one time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Progress {
    /// What its front has covered since its end of the bridge `[m]`.
    pub way_m: f64,
    /// Speed `[m/s]`.
    pub speed_m_s: f64,
    /// Acceleration `[m/s^2]`.
    pub acceleration_m_s2: f64,
}

/// A span of time in which the acceleration is constant.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// When it begins `[s]`, and what holds then.
    from_s: f64,
    then: Progress,
}

impl Piece {
    fn at(&self, time_s: f64) -> Progress {
        let (t, then) = (time_s - self.from_s, self.then);
        Progress {
            way_m: then.way_m + t * (then.speed_m_s + 0.5 * then.acceleration_m_s2 * t),
            speed_m_s: then.speed_m_s + then.acceleration_m_s2 * t,
            acceleration_m_s2: then.acceleration_m_s2,
        }
    }
}

impl Drive {
    /// Constant speed from t = 0 on, below 0 from the right end.
    pub fn steady(speed_m_s: f64) -> Self {
        Self {
            speed_m_s: speed_m_s.abs(),
            backward: speed_m_s < 0.0,
            start_s: 0.0,
            acceleration_m_s2: 0.0,
            stop_way_m: None,
        }
    }

    /// Checks it on a bridge of length `length_m` for a vehicle that reaches `behind_m` behind its front.
    ///
    /// # Errors
    /// [`InvalidInput`] at `speed_m_s`, `acceleration_m_s2` or `stop_x_m`: a speed that is not above 0, an acceleration that stops
    /// the vehicle on the bridge without a place to stop, a stop that it cannot come to.
    pub fn check(&self, length_m: f64, behind_m: f64) -> Result<(), InvalidInput> {
        positive("speed_m_s", self.speed_m_s)?;
        let (v, a) = (self.speed_m_s, self.acceleration_m_s2);
        let conflict = |key: &str, found: f64, allowed: String| {
            Err(InvalidInput::new(key, found, allowed).because(Problem::Conflict))
        };
        if !a.is_finite() {
            return Err(InvalidInput::new("acceleration_m_s2", a, "a finite number"));
        }
        match self.stop_way_m {
            None => {
                let whole_m = length_m + behind_m;
                let least = -0.5 * v * v / whole_m;
                if a <= least {
                    let allowed = format!(
                        "above {}, with which it leaves the bridge, or a stop_x_m beside it",
                        bound(least)
                    );
                    return conflict("acceleration_m_s2", a, allowed);
                }
            }
            Some(way_m) => {
                let x_m = if self.backward { length_m - way_m } else { way_m };
                if !(0.0..=length_m).contains(&way_m) {
                    let allowed = format!("a place on the bridge, from 0 to {}", bound(length_m));
                    return Err(InvalidInput::new("stop_x_m", x_m, allowed));
                }
                if a >= 0.0 {
                    return conflict(
                        "acceleration_m_s2",
                        a,
                        "a number below 0, with which it brakes to its stop".to_owned(),
                    );
                }
                let braking_m = -0.5 * v * v / a;
                if braking_m > way_m {
                    let allowed = format!(
                        "at least {} from the end that it comes from, which is what it brakes in",
                        bound(braking_m)
                    );
                    return conflict("stop_x_m", x_m, allowed);
                }
            }
        }
        Ok(())
    }

    /// Its largest speed while its front is on a bridge `[m/s]`.
    pub fn top_speed_m_s(&self, length_m: f64) -> f64 {
        let (v, a) = (self.speed_m_s, self.acceleration_m_s2);
        (v * v + 2.0 * a.max(0.0) * length_m).sqrt()
    }

    /// Spans of constant acceleration in their order; the first has no beginning.
    fn pieces(&self) -> impl Iterator<Item = Piece> {
        let (v, a) = (self.speed_m_s, self.acceleration_m_s2);
        let steady = |from_s: f64, way_m: f64, speed_m_s: f64, acceleration_m_s2: f64| Piece {
            from_s,
            then: Progress {
                way_m,
                speed_m_s,
                acceleration_m_s2,
            },
        };
        let before = steady(self.start_s, 0.0, v, 0.0);
        let [then, last] = match self.stop_way_m {
            Some(stop_m) => {
                let braking_m = -0.5 * v * v / a;
                let from_s = self.start_s + (stop_m - braking_m) / v;
                [
                    Some(steady(from_s, stop_m - braking_m, v, a)),
                    Some(steady(from_s - v / a, stop_m, 0.0, 0.0)),
                ]
            }
            None if a != 0.0 => [Some(steady(self.start_s, 0.0, v, a)), None],
            None => [None, None],
        };
        [Some(before), then, last].into_iter().flatten()
    }

    /// Where it is at a time.
    #[inline(always)]
    pub fn at(&self, time_s: f64) -> Progress {
        if self.acceleration_m_s2 != 0.0 {
            return self.accelerated(time_s);
        }
        Progress {
            way_m: self.speed_m_s * (time_s - self.start_s),
            speed_m_s: self.speed_m_s,
            acceleration_m_s2: 0.0,
        }
    }

    /// Where it is where it accelerates or brakes.
    fn accelerated(&self, time_s: f64) -> Progress {
        let mut now = None;
        for piece in self.pieces() {
            if now.is_none() || piece.from_s <= time_s {
                now = Some(piece.at(time_s));
            }
        }
        now.unwrap_or_default()
    }

    /// When its front has covered a way `[s]`; none where it stops before.
    pub fn reaches_s(&self, way_m: f64) -> Option<f64> {
        if self.acceleration_m_s2 == 0.0 {
            return Some(self.start_s + way_m / self.speed_m_s);
        }
        let pieces: Vec<Piece> = self.pieces().collect();
        let until = |i: usize| pieces.get(i + 1).map_or(f64::INFINITY, |next| next.from_s);
        pieces.iter().enumerate().find_map(|(i, piece)| {
            let Progress {
                way_m: from_m,
                speed_m_s: v,
                acceleration_m_s2: a,
            } = piece.then;
            roots([from_m - way_m, v, 0.5 * a])
                .map(|t| piece.from_s + t)
                .find(|&time_s| (i == 0 || time_s >= piece.from_s) && time_s <= until(i))
        })
    }
}

/// Real roots of `c_0 + c_1 t + c_2 t^2`, increasing.
fn roots([c_0, c_1, c_2]: [f64; 3]) -> impl Iterator<Item = f64> {
    let mut found = [None, None];
    if c_2 == 0.0 {
        if c_1 != 0.0 {
            found[0] = Some(-c_0 / c_1);
        }
    } else {
        let under = c_1 * c_1 - 4.0 * c_2 * c_0;
        if under >= 0.0 {
            let q = -0.5 * (c_1 + under.sqrt().copysign(c_1));
            let (a, b) = (q / c_2, if q == 0.0 { 0.0 } else { c_0 / q });
            found = [Some(a.min(b)), Some(a.max(b))];
        }
    }
    found.into_iter().flatten()
}

/// A vehicle that drives.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven {
    /// The vehicle where its lane is.
    pub vehicle: Arc<Vehicle>,
    /// Its weight `[N]`; a vehicle of other weight has all its masses, springs and dampers scaled.
    pub load_n: f64,
    /// How it drives.
    pub drive: Drive,
}

/// All that drives over a bridge in one crossing.
#[derive(Debug, Clone, PartialEq)]
pub struct Traffic {
    /// The vehicles.
    pub vehicles: Vec<Driven>,
    /// How uneven the road is; level where absent.
    pub road: Option<Arc<Road>>,
}

/// When a vehicle is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Presence {
    /// When its first point reaches the bridge or, where it settles on a road before, begins its run-in `[s]`.
    pub from_s: f64,
    /// When its last point leaves the bridge, or it comes to a stop there `[s]`.
    pub until_s: f64,
    /// Whether it leaves.
    leaves: bool,
}

impl Presence {
    /// Whether it has come and not left by the end of a step.
    pub(crate) fn holds(&self, time_s: f64) -> bool {
        self.from_s < time_s && !(self.leaves && time_s > self.until_s)
    }
}

impl Driven {
    /// What its masses, springs and dampers are multiplied by for its weight; 1 of a rigid vehicle.
    pub fn scale(&self) -> f64 {
        let springs = self.vehicle.springs.as_ref();
        springs.map_or(1.0, |springs| self.load_n / springs.whole_weight_n())
    }
}

/// Two vehicles that run into each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// The vehicles, from 0 in their order.
    pub vehicles: [usize; 2],
    /// Where on the bridge `[m]`.
    pub x_m: f64,
    /// When `[s]`.
    pub time_s: f64,
}

impl Traffic {
    /// One vehicle at constant speed, below 0 from the right end.
    pub fn single(vehicle: &Vehicle, load_n: f64, speed_m_s: f64) -> Self {
        Self {
            vehicles: vec![Driven {
                vehicle: Arc::new(vehicle.clone()),
                load_n,
                drive: Drive::steady(speed_m_s),
            }],
            road: None,
        }
    }

    /// Weight of all vehicles `[N]`.
    pub fn weight_n(&self) -> f64 {
        self.vehicles.iter().map(|driven| driven.load_n).sum()
    }

    /// When each vehicle is on a bridge.
    pub(crate) fn presences(&self, length_m: f64) -> Vec<Presence> {
        let presence = |driven: &Driven| {
            let (vehicle, drive) = (&*driven.vehicle, &driven.drive);
            let run_in_m = match (&self.road, &vehicle.springs) {
                (Some(road), Some(_)) => road.run_in_m,
                _ => 0.0,
            };
            let reaches = |way_m: f64| drive.reaches_s(way_m);
            let leaves_s = reaches(length_m + vehicle.behind_m());
            let stops_s = || drive.stop_way_m.and_then(reaches);
            Presence {
                from_s: reaches(-vehicle.ahead_m() - run_in_m).unwrap_or(drive.start_s),
                until_s: leaves_s.or_else(stops_s).unwrap_or(drive.start_s),
                leaves: leaves_s.is_some(),
            }
        };
        self.vehicles.iter().map(presence).collect()
    }

    /// What its vehicles on springs consist of.
    pub(crate) fn ride_parts(&self) -> Vec<RidePart> {
        let of = |(vehicle, driven): (usize, &Driven)| {
            let springs = driven.vehicle.springs.as_ref()?;
            Some(RidePart {
                vehicle,
                wheels: driven
                    .vehicle
                    .patches
                    .iter()
                    .map(|patch| (patch.axle, patch.y_m))
                    .collect(),
                motions: springs.body.clone(),
            })
        };
        self.vehicles.iter().enumerate().filter_map(of).collect()
    }

    /// Height of the road under a wheel on springs and its slope along x, means over the points of its patch; `place_m` is where
    /// along the bridge a place ahead of the front is.
    pub(crate) fn under(&self, vehicle: usize, wheel: usize, place_m: impl Fn(f64) -> f64) -> [f64; 2] {
        let Some(road) = &self.road else { return [0.0; 2] };
        let patch = &self.vehicles[vehicle].vehicle.patches[wheel];
        let profile = road.profile(patch.y_m);
        let mut mean = [0.0; 2];
        for point in &patch.points {
            let (share, [height, slope]) = (point.share / patch.share, profile.at(place_m(point.ahead_m)));
            mean[0] += share * height;
            mean[1] += share * slope;
        }
        mean
    }

    /// Height of the road where vehicles begin `[m]`.
    pub(crate) fn level_m(&self, backward: bool) -> f64 {
        self.road.as_ref().map_or(0.0, |road| road.level_m(backward))
    }

    /// The first two vehicles that are in one place of one lane on a bridge at one time; none where all keep apart.
    pub fn collision(&self, length_m: f64) -> Option<Collision> {
        let mut first: Option<Collision> = None;
        for (i, one) in self.vehicles.iter().enumerate() {
            for (j, other) in self.vehicles.iter().enumerate().skip(i + 1) {
                let [[a, b], [c, d]] = [one, other].map(|driven| driven.vehicle.breadth_m());
                // lines without width share a lane where they are one line
                if a.max(c) > b.min(d) + TOUCHING_M || (b - a).min(d - c) > 0.0 && a.max(c) >= b.min(d) - TOUCHING_M {
                    continue;
                }
                if let Some((x_m, time_s)) = meeting(one, other, length_m)
                    && first.is_none_or(|earlier| time_s < earlier.time_s)
                {
                    first = Some(Collision {
                        vehicles: [i, j],
                        x_m,
                        time_s,
                    });
                }
            }
        }
        first
    }
}

/// Vehicles that overlap by no more than this touch `[m]`.
const TOUCHING_M: f64 = 1e-6;

/// What a vehicle covers along the bridge at a time: left and right end `[m]`.
fn covered_m(driven: &Driven, length_m: f64, time_s: f64) -> [f64; 2] {
    let (way_m, [rear, front]) = (driven.drive.at(time_s).way_m, driven.vehicle.reach_m());
    let [behind, ahead] = [way_m + rear, way_m + front];
    if driven.drive.backward {
        [length_m - ahead, length_m - behind]
    } else {
        [behind, ahead]
    }
}

/// Where and when two vehicles of one lane first overlap on the bridge.
fn meeting(one: &Driven, other: &Driven, length_m: f64) -> Option<(f64, f64)> {
    let mut times_s: Vec<f64> = Vec::new();
    for driven in [one, other] {
        let [rear, front] = driven.vehicle.reach_m();
        times_s.extend(driven.drive.pieces().map(|piece| piece.from_s));
        times_s.extend(driven.drive.reaches_s(-front));
        times_s.extend(driven.drive.reaches_s(length_m - rear));
    }
    // ends that pass each other, in every pair of spans
    for a in one.drive.pieces() {
        for b in other.drive.pieces() {
            for end in 0..2 {
                let place = |driven: &Driven, piece: &Piece, end: usize| -> [f64; 3] {
                    let [rear, front] = driven.vehicle.reach_m();
                    let (sign, from_m, own) = if driven.drive.backward {
                        (-1.0, length_m, if end == 0 { front } else { rear })
                    } else {
                        (1.0, 0.0, if end == 0 { rear } else { front })
                    };
                    let Progress {
                        way_m,
                        speed_m_s: v,
                        acceleration_m_s2: a,
                    } = piece.then;
                    let t = piece.from_s;
                    [
                        from_m + sign * (way_m + own - v * t + 0.5 * a * t * t),
                        sign * (v - a * t),
                        sign * 0.5 * a,
                    ]
                };
                let (p, q) = (place(one, &a, end), place(other, &b, 1 - end));
                times_s.extend(roots([p[0] - q[0], p[1] - q[1], p[2] - q[2]]));
            }
        }
    }
    times_s.retain(|time_s| time_s.is_finite());
    times_s.sort_by(f64::total_cmp);
    let both_m = |time_s: f64| {
        let [[a, b], [c, d]] = [one, other].map(|driven| covered_m(driven, length_m, time_s));
        [a.max(c).max(0.0), b.min(d).min(length_m)]
    };
    let last_s = times_s.last().copied()?;
    times_s.push(last_s + 1.0);
    times_s.windows(2).find_map(|span| {
        let [left_m, right_m] = both_m(0.5 * (span[0] + span[1]));
        (right_m - left_m > TOUCHING_M).then(|| (both_m(span[0])[0], span[0]))
    })
}

#[cfg(test)]
mod tests {
    use super::{Drive, Driven, Traffic};
    use crate::vehicle::VehicleDesign;
    use std::sync::Arc;

    fn driven(drive: Drive, y_m: f64) -> Driven {
        let design = VehicleDesign {
            track_y_m: Some(vec![y_m - 0.5, y_m + 0.5]),
            ..VehicleDesign::default()
        };
        Driven {
            vehicle: Arc::new(design.check(8.0).expect("a vehicle")),
            load_n: 1e5,
            drive,
        }
    }

    /// Ways, speeds and times by hand: 10 m/s that brakes at 2 m/s^2 to a stop at 60 m drives 35 m in 3.5 s, brakes for 5 s and
    /// stands; 10 m/s and 1 m/s^2 have covered 55.125 m in 4.5 s. A braking that is 5 % off is found.
    #[test]
    fn ways_are_those_of_constant_accelerations() {
        let braked = |a: f64| Drive {
            acceleration_m_s2: a,
            stop_way_m: Some(60.0),
            ..Drive::steady(10.0)
        };
        let drive = braked(-2.0);
        for (t, way, speed) in [
            (-1.0, -10.0, 10.0),
            (3.5, 35.0, 10.0),
            (6.0, 53.75, 5.0),
            (9.0, 60.0, 0.0),
        ] {
            let now = drive.at(t);
            assert!(
                (now.way_m - way).abs() < 1e-12 && (now.speed_m_s - speed).abs() < 1e-12,
                "{t}: {now:?}"
            );
        }
        assert!((braked(-2.1).at(6.0).way_m - 53.75).abs() > 0.1);
        assert_eq!(drive.reaches_s(60.5), None);
        assert!((drive.reaches_s(53.75).expect("reached") - 6.0).abs() < 1e-12);
        let faster = Drive {
            acceleration_m_s2: 1.0,
            start_s: 2.0,
            ..Drive::steady(10.0)
        };
        assert!((faster.at(6.5).way_m - 55.125).abs() < 1e-12);
        assert!((faster.reaches_s(55.125).expect("reached") - 6.5).abs() < 1e-12);
        assert!((faster.reaches_s(-20.0).expect("reached") - 0.0).abs() < 1e-12);
        assert!(braked(-0.5).check(100.0, 5.0).is_err(), "100 m to brake in");
        assert!(braked(-1.0).check(100.0, 5.0).is_ok());
        let stops = Drive {
            acceleration_m_s2: -0.5,
            ..Drive::steady(10.0)
        };
        assert!(stops.check(100.0, 5.0).is_err() && stops.check(90.0, 5.0).is_ok());
    }

    /// A footprint of 3.35 m at 10 m/s that starts 4 s after one at 5 m/s, 20 m behind it: the gap of 16.65 m is closed after
    /// 3.33 s more, where the first's rear is. Other lanes, later starts and shorter bridges keep them apart; two that come from both
    /// ends meet in the middle. A speed that is 5 % off moves the place by more than rounding.
    #[test]
    fn vehicles_run_into_each_other_where_they_meet() {
        let late = |speed_m_s: f64, start_s: f64| Drive {
            start_s,
            ..Drive::steady(speed_m_s)
        };
        let traffic = |vehicles: [Driven; 2]| Traffic {
            vehicles: vehicles.into(),
            road: None,
        };
        let slow = driven(Drive::steady(5.0), 0.0);
        let found = |speed: f64, y_m: f64, length_m: f64| {
            traffic([slow.clone(), driven(late(speed, 4.0), y_m)]).collision(length_m)
        };
        let met = found(10.0, 0.0, 100.0).expect("they meet");
        let (time_s, x_m) = (4.0 + 16.65 / 5.0, 5.0 * (4.0 + 16.65 / 5.0) - 1.675);
        assert!(
            (met.time_s - time_s).abs() < 1e-9 && (met.x_m - x_m).abs() < 1e-9,
            "{met:?}"
        );
        assert!((found(10.5, 0.0, 100.0).expect("they meet").x_m - x_m).abs() > 0.5);
        assert_eq!(found(10.0, 1.5, 100.0), None, "another lane");
        assert_eq!(found(10.0, 0.0, 30.0), None, "the first has left");
        assert_eq!(found(5.0, 0.0, 100.0), None, "as fast");
        let against = traffic([slow.clone(), driven(Drive::steady(-5.0), 0.0)]);
        let met = against.collision(100.0).expect("they meet");
        assert!((met.x_m - 50.0).abs() < 1e-9, "{met:?}");
        let at_once = traffic([slow.clone(), driven(late(5.0, 0.3), 0.0)]);
        let met = at_once.collision(100.0).expect("one on the other");
        assert!(met.x_m.abs() < 1e-9, "{met:?}");
    }
}
