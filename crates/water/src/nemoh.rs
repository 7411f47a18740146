//! Radiation coefficients as NEMOH 2 and 3 write them: `RadiationCoefficients.tec`, and the tables `CM.dat` (added mass) and `CA.dat`
//! (damping).
//!
//! Knows both forms, in SI units as the code writes them, and that long lines are wrapped. Does not know `Nemoh.cal`: about which
//! point a body turns is for its maker to choose.

use crate::bem_data::{AtFrequency, BemData};
use crate::numbers::{Words, check_last_line, line_place, whole};
use crate::options::Options;
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use std::f64::consts::TAU;
use std::path::Path;

/// Most frequencies of a file.
const MOST_FREQUENCIES: usize = 1_000_000;
/// Most modes of a file: six of each of 500 bodies.
const MOST_MODES: usize = 3000;
/// Share by which frequencies that are written twice may differ.
const SAME: f64 = 1e-4;

/// Whether a text is a `RadiationCoefficients.tec`.
pub(crate) fn is_tecplot(text: &str) -> bool {
    text.trim_start().starts_with("VARIABLES") && lines(text).any(|(_, line)| is_zone(line))
}

/// Whether a text is a `CM.dat` or `CA.dat`: a count behind a colon, then a frequency.
pub(crate) fn is_table(text: &str) -> bool {
    let mut lines = text.lines();
    let count = lines.next().and_then(count_of);
    let words = lines.next().map(|line| line.split_whitespace().collect::<Vec<_>>());
    count.is_some() && words.is_some_and(|words| words.len() == 1 && words[0].parse::<f64>().is_ok())
}

/// The word behind the last colon of a line.
fn count_of(line: &str) -> Option<&str> {
    let word = line.rsplit_once(':')?.1.trim();
    (!word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit())).then_some(word)
}

/// Lines with their numbers from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().zip(1..).map(|(text, line)| (line, text))
}

fn is_zone(line: &str) -> bool {
    line.trim_start()
        .get(..4)
        .is_some_and(|word| word.eq_ignore_ascii_case("zone"))
}

/// Reads a `RadiationCoefficients.tec`: a zone for each motion, in it a line for each frequency with added mass and damping of each
/// force.
///
/// # Errors
/// [`Refusal`] with the line.
pub(crate) fn read_tecplot(file: &Path, text: &str, options: &Options) -> Result<BemData, Refusal> {
    check_last_line(file, text)?;
    let lines: Vec<(usize, &str)> = lines(text).collect();
    let zones: Vec<usize> = (0..lines.len()).filter(|&at| is_zone(lines[at].1)).collect();
    let count = zones.len();
    let head = &lines[..zones.first().copied().unwrap_or(0)];
    let forces: usize = head.iter().map(|(_, line)| line.matches("\"A").count()).sum();
    if forces != count {
        let found = format!("{forces} forces and {count} motions");
        return Err(Refusal::new(
            file,
            "",
            found,
            "as many zones of motions as forces: whole files",
        ));
    }
    if count > MOST_MODES {
        return Err(Refusal::new(file, "modes", count, "at most 3000 modes"));
    }
    let unit = FrequencyUnit::of(file, head)?;
    let mut frequencies = Vec::<(usize, f64)>::new();
    // by frequency, motion and force: added mass and damping
    let mut table = Vec::<Vec<[f64; 2]>>::new();
    for (motion, &zone) in zones.iter().enumerate() {
        let (place, title) = lines[zone];
        let rows = whole(file, place, rows_of(title), MOST_FREQUENCIES)?;
        let end = zones.get(motion + 1).copied().unwrap_or(lines.len());
        let mut words = Words::new(file, lines[zone + 1..end].iter().copied());
        if motion > 0 && rows != frequencies.len() {
            let allowed = format!("{} frequencies, as in the first zone", frequencies.len());
            return Err(Refusal::new(file, line_place(place), rows, allowed).because(RefusalKind::Conflict));
        }
        for row in 0..rows {
            let (line, written) = words.next("a frequency")?;
            let omega = unit.omega(file, line, written)?;
            if motion == 0 {
                frequencies.push((line, omega));
                table.push(vec![[0.0; 2]; count * count]);
            }
            check_frequency(file, line, omega, frequencies[row].1)?;
            for force in 0..count {
                let entry = [words.next("added mass")?.1, words.next("damping")?.1];
                table[row][motion * count + force] = entry;
            }
        }
        words.end("no more numbers in the zone than its title says")?;
    }
    let omegas = frequencies.iter().map(|(_, omega)| *omega);
    data(file, count, omegas.zip(table).collect(), options)
}

/// The word behind `I=` in the title of a zone.
fn rows_of(title: &str) -> &str {
    let behind = title.rsplit_once("I=").map_or("", |(_, behind)| behind);
    behind.split(',').next().unwrap_or_default().trim()
}

/// How a file writes frequencies.
#[derive(Clone, Copy)]
enum FrequencyUnit {
    RadPerSecond,
    Hertz,
    /// Periods.
    Second,
}

impl FrequencyUnit {
    fn of(file: &Path, head: &[(usize, &str)]) -> Result<Self, Refusal> {
        let label = head
            .first()
            .and_then(|(_, line)| line.split('"').nth(1))
            .unwrap_or_default();
        match label.to_lowercase() {
            label if label.contains("rad") => Ok(Self::RadPerSecond),
            label if label.contains("hz") => Ok(Self::Hertz),
            label if label.contains("(s)") => Ok(Self::Second),
            _ => {
                let allowed = "a first variable in rad/s, Hz or s";
                Err(Refusal::new(file, line_place(1), FoundValue::value(label), allowed))
            }
        }
    }

    fn omega(self, file: &Path, line: usize, written: f64) -> Result<f64, Refusal> {
        let omega = match self {
            Self::RadPerSecond => written,
            Self::Hertz => TAU * written,
            Self::Second => TAU / written,
        };
        let omega = Some(omega).filter(|omega| omega.is_finite() && *omega > 0.0);
        omega.ok_or_else(|| Refusal::new(file, line_place(line), written, "a frequency or period above 0"))
    }
}

/// Reads `CM.dat` and `CA.dat`: the number of frequencies, then each with the rows of its matrix.
///
/// # Errors
/// [`Refusal`] with the line.
pub(crate) fn read_tables(mass: (&Path, &str), damping: (&Path, &str), options: &Options) -> Result<BemData, Refusal> {
    let (masses, dampings) = (table(mass.0, mass.1)?, table(damping.0, damping.1)?);
    if masses.len() != dampings.len() {
        let allowed = format!("{} frequencies, as {} has", masses.len(), mass.0.display());
        return Err(Refusal::new(damping.0, line_place(1), dampings.len(), allowed).because(RefusalKind::Conflict));
    }
    let mut rows = Vec::new();
    let mut count = 0;
    for (mass, of_damping) in masses.into_iter().zip(dampings) {
        check_frequency(damping.0, of_damping.line, of_damping.omega_rad_s, mass.omega_rad_s)?;
        if mass.entries.len() != of_damping.entries.len() {
            let found = format!("a matrix of {} entries", of_damping.entries.len());
            let allowed = format!("one of {}, as added mass has", mass.entries.len());
            return Err(Refusal::new(damping.0, line_place(of_damping.line), found, allowed));
        }
        count = mass.entries.len().isqrt();
        let pairs = mass.entries.into_iter().zip(of_damping.entries).map(|(a, b)| [a, b]);
        rows.push((mass.omega_rad_s, pairs.collect()));
    }
    data(mass.0, count, rows, options)
}

/// A matrix of a table.
struct TableMatrix {
    line: usize,
    omega_rad_s: f64,
    entries: Vec<f64>,
}

fn table(file: &Path, text: &str) -> Result<Vec<TableMatrix>, Refusal> {
    check_last_line(file, text)?;
    let head = text.lines().next().and_then(count_of);
    let head = head.ok_or_else(|| Refusal::new(file, line_place(1), "no count", "the number of frequencies"))?;
    let frequencies = whole(file, 1, head, MOST_FREQUENCIES)?;
    let mut words = Words::new(file, lines(text).skip(1));
    let entries = (words.left() / frequencies).saturating_sub(1);
    if entries == 0 || entries.isqrt().pow(2) != entries || words.left() != frequencies * (entries + 1) {
        let found = format!("{} numbers behind {frequencies} frequencies", words.left());
        let allowed = "a frequency and a square matrix for each: whole files";
        return Err(Refusal::new(file, line_place(1), found, allowed));
    }
    let mut matrices = Vec::new();
    for _ in 0..frequencies {
        let (line, written) = words.next("a frequency")?;
        let omega_rad_s = FrequencyUnit::RadPerSecond.omega(file, line, written)?;
        let entries: Result<_, Refusal> = (0..entries).map(|_| Ok(words.next("a coefficient")?.1)).collect();
        matrices.push(TableMatrix {
            line,
            omega_rad_s,
            entries: entries?,
        });
    }
    Ok(matrices)
}

/// Refuses a frequency that is not the one of the same row elsewhere.
fn check_frequency(file: &Path, line: usize, omega: f64, elsewhere: f64) -> Result<(), Refusal> {
    if (omega - elsewhere).abs() <= SAME * elsewhere {
        return Ok(());
    }
    let allowed = format!("{elsewhere} rad/s, as the other matrices have in this row");
    let found = format!("the frequency {omega} rad/s");
    Err(Refusal::new(file, line_place(line), found, allowed).because(RefusalKind::Conflict))
}

/// The modules' freedoms of whole matrices of all modes.
fn data(file: &Path, count: usize, rows: Vec<(f64, Vec<[f64; 2]>)>, options: &Options) -> Result<BemData, Refusal> {
    let places = options.modes.places(file, count)?;
    let mut data = BemData::begin("NEMOH", &places, count);
    for (omega_rad_s, entries) in rows {
        let matrix = |which: usize| {
            let pairs = places.iter().flat_map(|&i| places.iter().map(move |&j| i * count + j));
            pairs.map(|place| entries[place][which]).collect()
        };
        data.frequencies.push(AtFrequency {
            omega_rad_s,
            added_mass: matrix(0),
            radiation_damping: matrix(1),
        });
    }
    Ok(data)
}
