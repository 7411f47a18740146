//! The road on the deck: how uneven it is.
//!
//! Knows profiles against the place along the bridge, and those of ISO 8608 from a seed. Does not know vehicles.

use crate::input::{Found, InvalidInput, Problem, bound, not_negative, positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// A road as a study writes it: exactly one of a table, a bump, a step and a class of ISO 8608.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoadDesign {
    /// Places along the bridge and heights there `[m]`, straight between; level beyond its ends, which are those of the bridge
    /// or farther out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<Vec<[f64; 2]>>,
    /// A bump that rises and falls as a cosine.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bump: Option<Unevenness>,
    /// A step: straight from 0 to its height over its length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<Unevenness>,
    /// Class of ISO 8608: phases drawn from `seed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iso_8608: Option<IsoClass>,
    /// Seed of the phases; 1 where absent. A key of `iso_8608`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 9_007_199_254_740_992_u64))]
    pub seed: Option<u64>,
    /// Whether all wheel lines share one profile or each has its own; shared where absent. A key of `iso_8608`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<RoadLines>,
    /// Way before the bridge on which a vehicle settles on the road `[m]`; 50 where absent. A key of `iso_8608`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub run_in_m: Option<f64>,
    /// Number of waves; 1000 where absent, by which a profile repeats after 251 m. A key of `iso_8608`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 100, max = 100_000))]
    pub waves: Option<usize>,
}

/// A bump or a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Unevenness {
    /// Where it begins `[m]`.
    pub x_m: f64,
    /// Its length `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub length_m: f64,
    /// Its height, negative downward `[m]`.
    pub height_m: f64,
}

/// Classes of ISO 8608, from very good to very poor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[allow(missing_docs)]
pub enum IsoClass {
    A,
    B,
    C,
    D,
    E,
    F,
    G,
    H,
}

impl IsoClass {
    /// Displacement spectral density at 0.1 waves a metre, geometric mean of the class `[m^3]`.
    pub fn density_m3(self) -> f64 {
        16e-6 * 4.0_f64.powi(self as i32)
    }
}

/// Which wheel lines share a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoadLines {
    /// All.
    #[default]
    Shared,
    /// None: each place across has phases of its own, which follow from the seed and the place.
    Own,
}

/// Lowest and highest wave number `[1/m]`, and that at which a class is named.
const LOWEST_1_M: f64 = 0.02;
const HIGHEST_1_M: f64 = 4.0;
const NAMED_1_M: f64 = 0.1;
/// Waves where none are stated.
const WAVES: usize = 1000;
/// Run-in where none is stated `[m]`.
const RUN_IN_M: f64 = 50.0;
/// Way over which a road of waves rises from a level one where vehicles begin `[m]`, at most half the run-in.
const FADE_M: f64 = 10.0;
/// Distance of the places between which a profile of waves is a cubic `[m]`: 25 in its shortest wave, so that the cubic is off
/// by 1e-5 of that wave's amplitude, which is 4e-5 m in class C.
const PLACES_M: f64 = 0.01;

/// Where vehicles drive: which of the road is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Ways<'a> {
    /// Length of the bridge `[m]`.
    pub length_m: f64,
    /// How far wheels reach beyond an end of the bridge while others are on it `[m]`.
    pub beyond_m: f64,
    /// Places of the wheel lines across `[m]`.
    pub y_m: &'a [f64],
}

impl RoadDesign {
    /// The road of a bridge.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key: none or several forms, a key of another form, places that do not increase, a table that is
    /// shorter than the bridge, waves that repeat on the way.
    pub fn road(&self, ways: &Ways<'_>) -> Result<Road, InvalidInput> {
        let forms = [
            ("table", self.table.is_some()),
            ("bump", self.bump.is_some()),
            ("step", self.step.is_some()),
            ("iso_8608", self.iso_8608.is_some()),
        ];
        let given: Vec<&str> = forms.iter().filter(|(_, is)| *is).map(|(name, _)| *name).collect();
        if given.len() != 1 {
            let (found, problem) = match given.as_slice() {
                [] => ("none of them".to_owned(), Problem::Missing),
                several => (several.join(" and "), Problem::Misplaced),
            };
            let allowed = "exactly one of table, bump, step, iso_8608";
            return Err(InvalidInput::new("", found, allowed).because(problem));
        }
        if self.iso_8608.is_none() {
            for (key, is_given) in [
                ("seed", self.seed.is_some()),
                ("lines", self.lines.is_some()),
                ("run_in_m", self.run_in_m.is_some()),
                ("waves", self.waves.is_some()),
            ] {
                if is_given {
                    let found = format!("{key} beside a {}", given[0]);
                    let refused = InvalidInput::new(key, found, "none but with iso_8608");
                    return Err(refused.because(Problem::Misplaced));
                }
            }
        }
        let stated = |profile: Profile| Road {
            run_in_m: profile.beyond_m(ways.length_m),
            lines: vec![(None, Line::of(profile))],
        };
        if let Some(table) = &self.table {
            check_table(table, ways.length_m)?;
            return Ok(stated(Profile::Table(table.clone())));
        }
        for (key, of, profile) in [
            ("bump", self.bump, Profile::Bump as fn(Unevenness) -> Profile),
            ("step", self.step, Profile::Step),
        ] {
            let Some(of) = of else { continue };
            check_unevenness(&of, ways.length_m).map_err(|e| e.under(key))?;
            return Ok(stated(profile(of)));
        }
        let Some(class) = self.iso_8608 else {
            return Err(InvalidInput::new("", Found::Nothing, "a form of the road"));
        };
        let run_in_m = not_negative("run_in_m", self.run_in_m.unwrap_or(RUN_IN_M))?;
        let waves = self.waves.unwrap_or(WAVES);
        if !(100..=100_000).contains(&waves) {
            return Err(InvalidInput::new("waves", waves, "a whole number from 100 to 100000"));
        }
        let beyond_m = run_in_m + ways.beyond_m;
        let way_m = ways.length_m + 2.0 * beyond_m;
        let least = ((HIGHEST_1_M - LOWEST_1_M) * way_m).ceil();
        if (waves as f64) < least {
            let allowed = format!(
                "at least {least} waves, by which it repeats after the {} m of bridge and run-in on both sides",
                bound(way_m)
            );
            return Err(InvalidInput::new("waves", waves, allowed).because(Problem::Conflict));
        }
        let seed = self.seed.unwrap_or(1);
        let way = Way {
            length_m: ways.length_m,
            beyond_m,
            run_in_m,
        };
        let of_seed = |seed: u64| {
            Line::waves(Waves {
                class,
                seed,
                waves,
                way,
            })
        };
        let lines = match self.lines.unwrap_or_default() {
            RoadLines::Shared => vec![(None, of_seed(seed))],
            RoadLines::Own => {
                let own = |&y_m: &f64| (Some(millimetres(y_m)), of_seed(own_seed(seed, y_m)));
                ways.y_m.iter().map(own).collect()
            }
        };
        Ok(Road { run_in_m, lines })
    }
}

/// The way that a profile is made for.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Way {
    length_m: f64,
    /// How far it reaches beyond each end of the bridge, and how far vehicles run in there `[m]`.
    beyond_m: f64,
    run_in_m: f64,
}

impl Way {
    /// Share of a road's height at a place, and the slope of that share `[1/m]`: none where vehicles begin their run-in, all after
    /// [`FADE_M`].
    fn share(&self, x_m: f64) -> (f64, f64) {
        let fade_m = FADE_M.min(0.5 * self.run_in_m);
        let (into_m, sense) = if x_m < 0.5 * self.length_m {
            (x_m + self.run_in_m, 1.0)
        } else {
            (self.length_m + self.run_in_m - x_m, -1.0)
        };
        if into_m >= fade_m {
            (1.0, 0.0)
        } else if into_m <= 0.0 {
            (0.0, 0.0)
        } else {
            (into_m / fade_m, sense / fade_m)
        }
    }
}

fn check_table(table: &[[f64; 2]], length_m: f64) -> Result<(), InvalidInput> {
    for (i, [x_m, height_m]) in table.iter().enumerate() {
        for (j, value) in [x_m, height_m].into_iter().enumerate() {
            if !value.is_finite() {
                return Err(InvalidInput::new(format!("table[{i}][{j}]"), *value, "a finite number"));
            }
        }
        if i > 0 && *x_m <= table[i - 1][0] {
            let allowed = format!("above {}, the place before it", bound(table[i - 1][0]));
            return Err(InvalidInput::new(format!("table[{i}][0]"), *x_m, allowed));
        }
    }
    let (Some(first), Some(last)) = (table.first(), table.last()) else {
        return Err(InvalidInput::new(
            "table",
            "an empty list",
            "places from 0 to the bridge's end",
        ));
    };
    if first[0] > 0.0 || last[0] < length_m {
        let found = format!("a profile from {} to {} m", bound(first[0]), bound(last[0]));
        let allowed = format!(
            "one of the whole bridge, from 0 or before to {} m or beyond",
            bound(length_m)
        );
        return Err(InvalidInput::new("table", found, allowed).because(Problem::Conflict));
    }
    Ok(())
}

fn check_unevenness(of: &Unevenness, length_m: f64) -> Result<(), InvalidInput> {
    positive("length_m", of.length_m)?;
    if !of.height_m.is_finite() {
        return Err(InvalidInput::new("height_m", of.height_m, "a finite number"));
    }
    if !(of.x_m.is_finite() && of.x_m + of.length_m > 0.0 && of.x_m < length_m) {
        let allowed = format!("a place where it is on the bridge, before {}", bound(length_m));
        return Err(InvalidInput::new("x_m", of.x_m, allowed));
    }
    Ok(())
}

/// An uneven road, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Road {
    /// Way before either end of the bridge on which vehicles drive on it, from where it is level `[m]`.
    pub run_in_m: f64,
    /// Profiles by place across in whole millimetres; one for all places where none is named.
    lines: Vec<(Option<i64>, Line)>,
}

/// The profile of a line, summed up when it is first driven on.
#[derive(Debug, Clone)]
struct Line {
    waves: Option<Waves>,
    profile: OnceLock<Profile>,
}

/// What waves are summed up from.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Waves {
    class: IsoClass,
    seed: u64,
    waves: usize,
    way: Way,
}

impl Line {
    fn of(profile: Profile) -> Self {
        Self {
            waves: None,
            profile: OnceLock::from(profile),
        }
    }

    fn waves(waves: Waves) -> Self {
        Self {
            waves: Some(waves),
            profile: OnceLock::new(),
        }
    }

    fn profile(&self) -> &Profile {
        self.profile
            .get_or_init(|| self.waves.map_or(Profile::Table(Vec::new()), |waves| waves.profile()))
    }
}

impl PartialEq for Line {
    fn eq(&self, other: &Self) -> bool {
        match (self.waves, other.waves) {
            (None, None) => self.profile == other.profile,
            (own, other) => own == other,
        }
    }
}

impl Road {
    /// The profile of a wheel line at `y_m`.
    pub fn profile(&self, y_m: f64) -> &Profile {
        let own = self
            .lines
            .iter()
            .find(|(line, _)| line.is_none_or(|line| line == millimetres(y_m)));
        own.unwrap_or(&self.lines[0]).1.profile()
    }

    /// Whether the wheel lines at `y_m` and at its mirror image have one profile.
    pub(crate) fn is_alike_across(&self, y_m: f64) -> bool {
        std::ptr::eq(self.profile(y_m), self.profile(-y_m))
    }

    /// Height of the road where vehicles begin, at its left or right end `[m]`.
    pub(crate) fn level_m(&self, right: bool) -> f64 {
        match &self.lines[0].1.profile.get() {
            Some(Profile::Table(table)) => {
                let end = if right { table.last() } else { table.first() };
                end.map_or(0.0, |end| end[1])
            }
            Some(Profile::Step(of)) if right => of.height_m,
            _ => 0.0,
        }
    }
}

fn millimetres(y_m: f64) -> i64 {
    (1000.0 * y_m).round() as i64
}

/// The seed of a line's own phases.
fn own_seed(seed: u64, y_m: f64) -> u64 {
    let mut stream = SplitMix64(seed);
    stream.next() ^ SplitMix64(millimetres(y_m) as u64).next()
}

/// Height of a road against the place along.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// Straight between places.
    Table(Vec<[f64; 2]>),
    /// `h/2 (1 - cos 2 pi s)`, s from 0 to 1 over its length.
    Bump(Unevenness),
    /// `h s`, then h.
    Step(Unevenness),
    /// A cubic between places that are a centimetre apart.
    Places {
        /// Number of the first place: it is at so many distances.
        first: i64,
        /// Height `[m]` and slope at each.
        places: Vec<[f64; 2]>,
    },
}

impl Profile {
    /// How far it is uneven beyond an end of a bridge, the farther of both `[m]`.
    fn beyond_m(&self, length_m: f64) -> f64 {
        let uneven = match self {
            Self::Table(table) => {
                let rises = |pair: &[[f64; 2]]| pair[0][1] != pair[1][1];
                let first = table.windows(2).position(rises).map(|i| table[i][0]);
                first.zip(table.windows(2).rposition(rises).map(|i| table[i + 1][0]))
            }
            Self::Bump(of) | Self::Step(of) => Some((of.x_m, of.x_m + of.length_m)),
            Self::Places { .. } => None,
        };
        uneven.map_or(0.0, |(from_m, to_m)| 0.0_f64.max(-from_m).max(to_m - length_m))
    }

    /// Height `[m]` and slope at a place along the bridge; of a kink the slope on its right.
    #[inline]
    pub fn at(&self, x_m: f64) -> [f64; 2] {
        match self {
            Self::Table(table) => {
                let next = table.partition_point(|[x, _]| *x <= x_m);
                let (Some(&[a, h_a]), Some(&[b, h_b])) =
                    (next.checked_sub(1).and_then(|i| table.get(i)), table.get(next))
                else {
                    let end = if next == 0 { table.first() } else { table.last() };
                    return [end.map_or(0.0, |end| end[1]), 0.0];
                };
                let slope = (h_b - h_a) / (b - a);
                [h_a + slope * (x_m - a), slope]
            }
            Self::Bump(of) => {
                let s = (x_m - of.x_m) / of.length_m;
                if !(0.0..1.0).contains(&s) {
                    return [0.0; 2];
                }
                let (sine, cosine) = libm::sincos(TAU * s);
                [
                    0.5 * of.height_m * (1.0 - cosine),
                    0.5 * of.height_m * TAU / of.length_m * sine,
                ]
            }
            Self::Step(of) => {
                let s = (x_m - of.x_m) / of.length_m;
                let slope = if (0.0..1.0).contains(&s) {
                    of.height_m / of.length_m
                } else {
                    0.0
                };
                [of.height_m * s.clamp(0.0, 1.0), slope]
            }
            Self::Places { first, places } => {
                let at = x_m / PLACES_M - *first as f64;
                let left = (at.floor().max(0.0) as usize).min(places.len() - 2);
                let (t, [[h_0, s_0], [h_1, s_1]]) =
                    ((at - left as f64).clamp(0.0, 1.0), [places[left], places[left + 1]]);
                let (rise, [m_0, m_1]) = (h_1 - h_0, [s_0 * PLACES_M, s_1 * PLACES_M]);
                let (b, c) = (3.0 * rise - 2.0 * m_0 - m_1, m_0 + m_1 - 2.0 * rise);
                [
                    h_0 + t * (m_0 + t * (b + t * c)),
                    (m_0 + t * (2.0 * b + t * 3.0 * c)) / PLACES_M,
                ]
            }
        }
    }
}

impl Waves {
    /// The sum of a class's waves over the way of vehicles, which rises from a level road where their run-in begins.
    /// `r(x) = sum of sqrt(2 G(n) dn) cos(2 pi n x + phi)`, `G(n) = G(0.1) (n/0.1)^-2`, n the centres of equal bands, phases in the
    /// order of n. Equation (V6).
    fn profile(&self) -> Profile {
        let width_1_m = (HIGHEST_1_M - LOWEST_1_M) / self.waves as f64;
        let mut phases = SplitMix64(self.seed);
        let [mut amplitudes, mut numbers, mut at_zero] = [(); 3].map(|()| vec![0.0; self.waves]);
        for i in 0..self.waves {
            let n = LOWEST_1_M + (i as f64 + 0.5) * width_1_m;
            let density = self.class.density_m3() * (n / NAMED_1_M).powi(-2);
            amplitudes[i] = (2.0 * density * width_1_m).sqrt();
            (numbers[i], at_zero[i]) = (TAU * n, TAU * phases.unit());
        }
        let (turn_sine, turn_cosine): (Vec<f64>, Vec<f64>) =
            numbers.iter().map(|number| libm::sincos(number * PLACES_M)).unzip();
        let first = (-self.way.beyond_m / PLACES_M).floor() as i64;
        let last = ((self.way.length_m + self.way.beyond_m) / PLACES_M).ceil() as i64 + 1;
        let mut places = vec![[0.0; 2]; (last - first) as usize + 1];
        for (block, of_block) in places.chunks_mut(TURNED).enumerate() {
            let x_m = (first + (block * TURNED) as i64) as f64 * PLACES_M;
            let turned = numbers.iter().zip(&at_zero).zip(&amplitudes);
            let (mut sine, mut cosine): (Vec<f64>, Vec<f64>) = turned
                .map(|((number, phase), amplitude)| {
                    let (sine, cosine) = libm::sincos(number * x_m + phase);
                    (amplitude * sine, amplitude * cosine)
                })
                .unzip();
            for place in of_block {
                let mut sums = [[0.0; 2]; SIDE_BY_SIDE];
                for from in (0..self.waves).step_by(SIDE_BY_SIDE) {
                    for (i, sum) in (from..self.waves.min(from + SIDE_BY_SIDE)).zip(&mut sums) {
                        let (s, c) = (sine[i], cosine[i]);
                        sum[0] += c;
                        sum[1] -= numbers[i] * s;
                        sine[i] = s * turn_cosine[i] + c * turn_sine[i];
                        cosine[i] = c * turn_cosine[i] - s * turn_sine[i];
                    }
                }
                for sum in sums {
                    (place[0], place[1]) = (place[0] + sum[0], place[1] + sum[1]);
                }
            }
        }
        for (i, [height, slope]) in (first..).zip(&mut places) {
            let (share, rise_1_m) = self.way.share(i as f64 * PLACES_M);
            (*height, *slope) = (share * *height, share * *slope + rise_1_m * *height);
        }
        Profile::Places { first, places }
    }
}

/// Waves that are summed up side by side, in this order on every machine.
const SIDE_BY_SIDE: usize = 8;

/// Places after which a wave is turned to afresh, so that rounding does not add up.
const TURNED: usize = 64;

/// Random numbers by Steele, Lea and Flood (OOPSLA 2014): the same on every machine.
struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From 0 to below 1 by the top 53 bits.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests;
