//! `.1` and `.hst` files of WAMIT.
//!
//! Knows their columns, how coefficients are free of dimension, and which periods stand for the limits of frequency: 0 is infinite
//! frequency, a negative one zero frequency. Does not know generalised modes: their lengths are whatever their maker chose.

use crate::bem_data::{AtFrequency, BemData, needed};
use crate::numbers::{check_last_line, line_place, number, parsed, whole};
use crate::options::{BemModes, Options};
use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_plan::water_file::FREEDOMS;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::path::Path;

/// Highest number of a mode.
const MOST_MODES: usize = 10_000;
/// Rigid modes of a single body; what is numbered above them may be generalised.
const RIGID: usize = 6;
/// Share by which modules' breadths may differ and still be told as one.
const ONE_BREADTH: f64 = 0.01;

/// Whether a text is a `.1` file: after at most one line of words, lines of a period, two modes and one or two coefficients.
pub(crate) fn is_added_mass(text: &str) -> bool {
    columns(text).is_some_and(|count| (4..=5).contains(&count))
}

/// Whether a text is a `.hst` file: lines of two modes and one coefficient.
pub(crate) fn is_hydrostatics(text: &str) -> bool {
    columns(text) == Some(3)
}

/// Columns of the first line of numbers, which is among the first two.
fn columns(text: &str) -> Option<usize> {
    let lines = text.lines().filter(|line| !line.trim().is_empty()).take(2);
    lines
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .find(|words| words.iter().all(|word| parsed(word).is_some()))
        .map(|words| words.len())
}

/// The lines of numbers, with the numbers of these lines from 1.
fn rows(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    let numbered = text
        .lines()
        .zip(1..)
        .map(|(line, place)| (place, line.split_whitespace().collect()));
    numbered.filter(|(place, words): &(usize, Vec<&str>)| {
        let is_head = *place == 1 && words.iter().any(|word| parsed(word).is_none());
        !words.is_empty() && !is_head
    })
}

/// Coefficients at one period, by mode and mode.
struct AtPeriod {
    period_s: f64,
    line: usize,
    coefficients: HashMap<(usize, usize), [f64; 2]>,
}

/// Reads a `.1` file; `hydrostatics` is the text of the `.hst` file beside it.
///
/// # Errors
/// [`Refusal`] with the line.
pub(crate) fn read(
    file: &Path,
    text: &str,
    hydrostatics: Option<(&Path, &str)>,
    options: &Options,
) -> Result<BemData, Refusal> {
    let (periods, count) = periods(file, text)?;
    let places = options.modes.places(file, count)?;
    check_scale(file, options)?;
    let density = needed(file, "density_kg_m3", options.facts.density_kg_m3)?;
    let mut data = BemData::begin("WAMIT", &places, count);
    check_counts(file, &periods)?;
    for at in &periods {
        let absent = places
            .iter()
            .find(|&&place| !at.coefficients.contains_key(&(place, place)));
        if let Some(mode) = absent {
            let found = format!(
                "no coefficient of mode {} with itself at the period {}",
                mode + 1,
                at.period_s
            );
            let allowed = "one of each mode that is a module's freedom";
            return Err(Refusal::new(file, line_place(at.line), found, allowed));
        }
        let omega_rad_s = if at.period_s > 0.0 { TAU / at.period_s } else { 0.0 };
        let whole = |which: usize, factor: f64| -> Vec<f64> {
            let pairs = (0..places.len()).flat_map(|i| (0..places.len()).map(move |j| (i, j)));
            pairs
                .map(|(i, j)| {
                    let coefficient = at.coefficients.get(&(places[i], places[j]));
                    let rotations = [i, j].iter().filter(|&&place| place % FREEDOMS.len() != 0).count();
                    let power = i32::try_from(3 + rotations).unwrap_or(3);
                    factor * options.length_scale_m().powi(power) * coefficient.map_or(0.0, |pair| pair[which])
                })
                .collect()
        };
        if at.period_s == 0.0 {
            data.infinite_added_mass = Some(whole(0, density));
        } else {
            data.frequencies.push(AtFrequency {
                omega_rad_s,
                added_mass: whole(0, density),
                radiation_damping: whole(1, density * omega_rad_s),
            });
        }
    }
    if let Some((file, text)) = hydrostatics {
        water_plane(file, text, &places, options, &mut data)?;
    }
    Ok(data)
}

/// Refuses a period with fewer coefficients than another one: the code leaves those out that symmetry makes 0, at all periods the
/// same.
fn check_counts(file: &Path, periods: &[AtPeriod]) -> Result<(), Refusal> {
    let most = periods.iter().map(|at| at.coefficients.len()).max().unwrap_or(0);
    let short = periods.iter().find(|at| at.coefficients.len() < most);
    short.map_or(Ok(()), |at| {
        let found = format!("{} coefficients at the period {}", at.coefficients.len(), at.period_s);
        let allowed = format!("{most}, as another period has: whole files");
        Err(Refusal::new(file, line_place(at.line), found, allowed).because(RefusalKind::Conflict))
    })
}

/// Refuses a length scale where modes may be generalised ones.
fn check_scale(file: &Path, options: &Options) -> Result<(), Refusal> {
    let scale = options.length_scale_m();
    if !(scale.is_finite() && scale > 0.0) {
        return Err(Refusal::new(file, "length_scale_m", scale, "a number above 0"));
    }
    match &options.modes {
        BemModes::Listed(listed) if scale != 1.0 && listed.iter().any(|mode| *mode > RIGID) => {
            let allowed = "1 where listed modes may be generalised ones, whose lengths are their maker's";
            Err(Refusal::new(file, "length_scale_m", scale, allowed).because(RefusalKind::Conflict))
        }
        _ => Ok(()),
    }
}

/// The coefficients at each period, and the number of modes.
fn periods(file: &Path, text: &str) -> Result<(Vec<AtPeriod>, usize), Refusal> {
    check_last_line(file, text)?;
    let (mut periods, mut place_of, mut count) = (Vec::<AtPeriod>::new(), HashMap::new(), 0);
    for (line, words) in rows(text) {
        let period_s = number(file, line, words[0])?;
        // zero frequency, however its period is written
        let period_s = if period_s < 0.0 { -1.0 } else { period_s + 0.0 };
        let known = if period_s > 0.0 { 5..=5 } else { 4..=5 };
        if !known.contains(&words.len()) {
            let found = format!("a line of {} numbers", words.len());
            let allowed = "period, mode, mode, added mass, and damping at a period above 0";
            return Err(Refusal::new(file, line_place(line), found, allowed));
        }
        let modes = (
            whole(file, line, words[1], MOST_MODES)? - 1,
            whole(file, line, words[2], MOST_MODES)? - 1,
        );
        let added_mass = number(file, line, words[3])?;
        let damping = words.get(4).map_or(Ok(0.0), |word| number(file, line, word))?;
        count = count.max(modes.0 + 1).max(modes.1 + 1);
        let place = *place_of.entry(period_s.to_bits()).or_insert_with(|| {
            periods.push(AtPeriod {
                period_s,
                line,
                coefficients: HashMap::new(),
            });
            periods.len() - 1
        });
        if periods[place]
            .coefficients
            .insert(modes, [added_mass, damping])
            .is_some()
        {
            let found = format!("modes {} and {} at the period {period_s}", modes.0 + 1, modes.1 + 1);
            let refused = Refusal::new(file, line_place(line), found, "each pair of modes once at each period");
            return Err(refused.because(RefusalKind::Repeated));
        }
    }
    Ok((periods, count))
}

/// Takes the breadth at the water line from the hydrostatic stiffness of heave.
fn water_plane(
    file: &Path,
    text: &str,
    places: &[usize],
    options: &Options,
    data: &mut BemData,
) -> Result<(), Refusal> {
    check_last_line(file, text)?;
    let mut stiffness = HashMap::new();
    for (line, words) in rows(text) {
        if words.len() != 3 {
            let found = format!("a line of {} numbers", words.len());
            return Err(Refusal::new(file, line_place(line), found, "mode, mode, stiffness"));
        }
        let i = whole(file, line, words[0], MOST_MODES)? - 1;
        let j = whole(file, line, words[1], MOST_MODES)? - 1;
        stiffness.insert((i, j), number(file, line, words[2])?);
    }
    let heaves = places.iter().step_by(FREEDOMS.len());
    let areas: Vec<f64> = heaves
        .filter_map(|&heave| stiffness.get(&(heave, heave)))
        .map(|stiffness| stiffness * options.length_scale_m().powi(2))
        .collect();
    if areas.len() != data.modules {
        let found = format!("the stiffness of heave of {} modules", areas.len());
        let allowed = format!("that of each of {} modules", data.modules);
        return Err(Refusal::new(file, "", found, allowed));
    }
    let total: f64 = areas.iter().sum();
    data.notes
        .push(format!("the water plane has {total:.4} m2 by the .hst file"));
    let Some(lengths) = &options.facts.module_length_m else {
        return Ok(());
    };
    let breadths: Vec<f64> = areas
        .iter()
        .zip(0..)
        .filter_map(|(area, m)| Some(area / lengths.of(m)?))
        .collect();
    let (least, most) = breadths
        .iter()
        .fold((f64::MAX, 0.0_f64), |(least, most), b| (least.min(*b), most.max(*b)));
    let is_one =
        breadths.len() == data.modules && most.is_finite() && least > 0.0 && most - least <= ONE_BREADTH * most;
    if is_one && options.facts.waterline_breadth_m.is_none() {
        data.facts.waterline_breadth_m = Some(breadths.iter().sum::<f64>() / breadths.len() as f64);
    }
    Ok(())
}
