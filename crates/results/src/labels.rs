//! What columns and axes are called, in which unit they are, and how a number is written for people: the one place that makes
//! labels and digits.
//!
//! Knows the registries of columns and of axes, and the suffixes by which all other names tell units. Does not know tables.

use crate::registry::{Column, Digits};
use pontoon_plan::design::NamedAxis;
use pontoon_plan::input::Cell;
use std::collections::{HashMap, HashSet};

/// Suffixes of names with the units that they tell, the longer before the shorter.
const UNITS: [(&str, &str); 18] = [
    ("_n_s_m", "N s/m"),
    ("_kg_m3", "kg/m³"),
    ("_kg_m2", "kg/m²"),
    ("_pa_m", "Pa/m"),
    ("_kg_m", "kg/m"),
    ("_m_s", "m/s"),
    ("_n_m", "N/m"),
    ("_nm", "N m"),
    ("_1_s", "1/s"),
    ("_m2", "m²"),
    ("_m4", "m⁴"),
    ("_pa", "Pa"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_rad", "rad"),
    ("_m", "m"),
    ("_n", "N"),
    ("_s", "s"),
];

/// The unit of a column or axis; empty where it has none.
pub fn unit(name: &str) -> &'static str {
    let axis = NamedAxis::of(name).map(|axis| axis.unit);
    let column = || Column::named(name).map(|column| column.unit);
    axis.or_else(column).unwrap_or_else(|| split(name).1)
}

fn split(name: &str) -> (&str, &'static str) {
    let found = UNITS
        .iter()
        .find_map(|(suffix, unit)| Some((name.strip_suffix(suffix)?, *unit)));
    found.filter(|(stem, _)| !stem.is_empty()).unwrap_or((name, ""))
}

/// What a column or axis is called in words: `gap_tension_m` is "tension gap", `bridge.module.deck_thickness_m` "module deck
/// thickness".
pub fn label(name: &str) -> String {
    let axis = NamedAxis::of(name).map(|axis| axis.label);
    let column = || Column::named(name).map(|column| column.label);
    if let Some(label) = axis.or_else(column) {
        return label.to_owned();
    }
    let (stem, _) = split(name);
    let path = ["bridge.", "vehicle.", "analysis."]
        .iter()
        .find_map(|root| stem.strip_prefix(root))
        .unwrap_or(stem);
    path.replace(['.', '_'], " ")
}

/// Orders of magnitude in which a number is written out; others are written with an exponent.
const WRITTEN_OUT: std::ops::Range<i32> = -5..9;

/// A number with so many significant digits, all of them written.
pub fn all_digits(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    let order = x.abs().log10().floor() as i32;
    let behind = digits.saturating_sub(1);
    if WRITTEN_OUT.contains(&order) {
        let decimals = usize::try_from(behind as i32 - order).unwrap_or(0);
        format!("{x:.decimals$}")
    } else {
        format!("{x:.behind$e}")
    }
}

/// A number with at most so many significant digits, none that says nothing; a whole one in full.
pub fn number(x: f64, digits: usize) -> String {
    let text = all_digits(x, digits);
    let (mantissa, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    let mantissa = if mantissa.contains('.') {
        mantissa.trim_end_matches('0').trim_end_matches('.')
    } else {
        mantissa
    };
    format!("{mantissa}{exponent}")
}

/// A count with its noun: "1 thread", "2 threads".
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {}", plural(noun, count))
}

/// A noun as it stands behind a count.
pub fn plural(noun: &str, count: usize) -> String {
    format!("{noun}{}", if count == 1 { "" } else { "s" })
}

/// A number as a person wrote it, without what decimals leave in the last bits.
pub fn as_written(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-6 {
        return format!("{x:e}");
    }
    format!("{}", (x * 1e9).round() / 1e9)
}

/// A share as a percentage with its sign.
pub fn percent(share: f64) -> String {
    let x = 100.0 * share;
    if x != 0.0 && x.abs() < 0.005 {
        format!("{x:+.0e} %")
    } else {
        format!("{x:+.2} %")
    }
}

/// Digits of a number on a page and in a figure.
pub const SHOWN: usize = 5;

/// Digits of a value of an axis in a table of the terminal.
const LISTED: usize = 6;

/// Lengths that are something, and of which four decimals show nothing `[m]`; what is less is what rounding leaves.
const LITTLE_M: std::ops::Range<f64> = 1e-9..5e-5;

/// A number of a column with the digits that people read of it; a little length with an exponent, for it is not nothing.
pub fn digits(name: &str, x: f64) -> String {
    let Some(column) = Column::named(name) else {
        return number(x, LISTED);
    };
    match column.digits {
        Digits::Decimals(_) if column.unit == "m" && LITTLE_M.contains(&x.abs()) => format!("{x:.1e}"),
        Digits::Decimals(decimals) => format!("{x:.decimals$}"),
        Digits::Significant(digits) => number(x, digits),
    }
}

/// A cell of a column in a table of the terminal: a dash where there is nothing.
pub fn listed(name: &str, cell: &Cell<'_>) -> String {
    match cell {
        Cell::Nothing => "-".to_owned(),
        Cell::Whole(whole) => whole.to_string(),
        Cell::Number(x) => digits(name, *x),
        other => printable(&other.text()),
    }
}

/// Values of an axis in a table of the terminal, a text each: what differs has as many more digits as it takes to read otherwise.
pub fn listed_apart(cells: &[&Cell<'_>]) -> Vec<String> {
    apart(cells, LISTED, |cell, digits| match cell {
        Cell::Number(x) => number(*x, digits),
        other => listed("", other),
    })
}

/// Values of a column as people say them, a text each: what differs has as many more digits as it takes to read otherwise.
pub fn values_apart(name: &str, cells: &[&Cell<'_>]) -> Vec<String> {
    apart(cells, SHOWN, |cell, digits| value_to(name, cell, digits))
}

/// Significant digits that tell any two numbers apart.
const ALL: usize = 17;

/// A text for each of some values, from `digits` on with more of them where a text stands for two values.
fn apart(cells: &[&Cell<'_>], digits: usize, text: impl Fn(&Cell<'_>, usize) -> String) -> Vec<String> {
    let mut texts: Vec<String> = cells.iter().map(|cell| text(cell, digits)).collect();
    for more in digits + 1..=ALL {
        let mut first: HashMap<&str, &Cell<'_>> = HashMap::new();
        let mut several: HashSet<String> = HashSet::new();
        for (text, cell) in texts.iter().zip(cells) {
            if *first.entry(text).or_insert(cell) != *cell {
                several.insert(text.clone());
            }
        }
        if several.is_empty() {
            break;
        }
        for (written, cell) in texts.iter_mut().zip(cells) {
            if several.contains(written.as_str()) {
                *written = text(cell, more);
            }
        }
    }
    texts
}

/// A value of a column as people say it: `0.028` of `gap_tension_m` is "28 mm", `230300` of `load_n` "230.3 kN".
pub fn value(name: &str, cell: &Cell<'_>) -> String {
    value_to(name, cell, SHOWN)
}

/// A number with its unit, lengths below 0.1 m in mm, forces from 1 kN on in kN.
pub fn value_in(unit: &str, x: f64) -> String {
    written_in(unit, x, SHOWN)
}

fn value_to(name: &str, cell: &Cell<'_>, digits: usize) -> String {
    match cell.number() {
        Some(x) => written_in(unit(name), x, digits),
        None if cell.is_nothing() => "-".to_owned(),
        None => cell.text(),
    }
}

fn written_in(unit: &str, x: f64, digits: usize) -> String {
    let (x, unit) = match unit {
        "m" if x.abs() < 0.1 => (1e3 * x, "mm"),
        "N" if x.abs() >= 1e3 => (1e-3 * x, "kN"),
        unit => (x, unit),
    };
    let space = if unit.is_empty() { "" } else { " " };
    format!("{}{space}{unit}", number(x, digits))
}

/// A word that keeps to its line: a blank for whatever is no character to be seen.
pub fn printable(word: &str) -> String {
    word.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_their_units_and_read_as_words() {
        assert_eq!(
            ["speed_m_s", "load_n", "gap_tension_m", "connection"].map(unit),
            ["m/s", "N", "m", ""]
        );
        assert_eq!(unit("bridge.hydrostatic_stiffness_pa_m"), "Pa/m");
        assert_eq!(label("bridge.hydrostatic_stiffness_pa_m"), "hydrostatic stiffness");
        assert_eq!(
            ["peak_deflection_m", "gap_tension_m", "speed_m_s"].map(label),
            ["peak deflection", "tension gap", "speed"]
        );
        // a path that a name of its own stands for is called as that
        assert_eq!(label("bridge.connectors.gap_tension_m"), "tension gap");
    }

    #[test]
    fn values_are_said_in_the_unit_that_fits() {
        let said = [
            ("gap_tension_m", Cell::Number(0.028)),
            ("gap_compression_m", Cell::Number(0.0055)),
            ("gap_tension_m", Cell::Number(0.0)),
            ("load_n", Cell::Whole(230_300)),
            ("speed_m_s", Cell::Number(6.09)),
            ("connection", Cell::from("linear")),
            ("load_position", Cell::Whole(7)),
            ("gap_tension_m", Cell::Nothing),
        ];
        let said = said.map(|(name, cell)| value(name, &cell));
        assert_eq!(
            said,
            ["28 mm", "5.5 mm", "0 mm", "230.3 kN", "6.09 m/s", "linear", "7", "-"]
        );
    }

    #[test]
    fn numbers_have_the_digits_that_are_asked_for() {
        let texts = [0.1 + 0.2, 1e-9, 123_456.7, 3.0, -0.0].map(|x| number(x, 5));
        assert_eq!(texts, ["0.3", "1e-9", "123457", "3", "0"]);
        let texts = [0.141_234, 74.0, 230_300.0, -0.000_123_46, 0.0, 1e12, 9.9999].map(|x| all_digits(x, 4));
        assert_eq!(
            texts,
            ["0.1412", "74.00", "230300", "-0.0001235", "0", "1.000e12", "10.000"]
        );
        assert_eq!([0.021, -0.000_04, 1e-9].map(percent), ["+2.10 %", "-4e-3 %", "+1e-7 %"]);
        assert_eq!([0.1 + 0.2, 74.0, 1e-7].map(as_written), ["0.3", "74", "1e-7"]);
    }

    #[test]
    fn one_is_singular_and_every_other_count_plural() {
        assert_eq!(
            [0, 1, 2].map(|n| counted(n, "thread")),
            ["0 threads", "1 thread", "2 threads"]
        );
    }

    #[test]
    fn what_differs_reads_otherwise() {
        let below = Cell::Number(0.1 - 1.4e-17);
        let cells = [
            Cell::Whole(5),
            Cell::Number(5.000_000_000_000_001),
            Cell::Number(5.0),
            Cell::Number(1.0 / 3.0),
        ];
        assert_eq!(
            listed_apart(&cells.each_ref()),
            ["5", "5.000000000000001", "5", "0.333333"]
        );
        let cells = [Cell::Number(0.1), below, Cell::Nothing, Cell::from("a")];
        assert_eq!(listed_apart(&cells.each_ref())[2..], ["-", "a"]);
        assert_ne!(listed_apart(&cells.each_ref())[0], listed_apart(&cells.each_ref())[1]);
        let cells = [Cell::Number(230_300.4), Cell::Number(230_300.3), Cell::Number(5e3)];
        assert_eq!(
            values_apart("load_n", &cells.each_ref()),
            ["230.3004 kN", "230.3003 kN", "5 kN"]
        );
    }

    #[test]
    fn a_column_is_read_to_its_own_digits() {
        let texts = [
            ("peak_deflection_m", Cell::Number(0.14)),
            ("peak_compression_n", Cell::Number(373_692.38)),
            ("frequency_hz", Cell::Number(0.4)),
            ("speed_m_s", Cell::Number(6.09)),
            ("speed_m_s", Cell::Whole(3)),
            ("peak_deflection_m", Cell::Nothing),
            ("peak_deflection_m", Cell::Number(0.000_034_1)),
            ("peak_deflection_m", Cell::Number(0.000_06)),
            ("peak_deflection_m", Cell::Number(1e-17)),
        ];
        let texts = texts.map(|(name, cell)| listed(name, &cell));
        assert_eq!(
            texts,
            [
                "0.1400", "373692", "0.40000", "6.09", "3", "-", "3.4e-5", "0.0001", "0.0000"
            ]
        );
    }
}
