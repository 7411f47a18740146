//! What columns are called, in which unit they are, and how a value of them is said.
//!
//! Knows the suffixes by which names tell units. Does not know tables.

use serde_json::Value;

/// Suffixes of names with the units that they tell, the longer before the shorter.
const UNITS: [(&str, &str); 16] = [
    ("_kg_m3", "kg/m³"),
    ("_kg_m2", "kg/m²"),
    ("_pa_m", "Pa/m"),
    ("_kg_m", "kg/m"),
    ("_m_s", "m/s"),
    ("_n_m", "N/m"),
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

/// The unit that a name tells; empty where it tells none.
pub fn unit(name: &str) -> &'static str {
    split(name).1
}

fn split(name: &str) -> (&str, &'static str) {
    let found = UNITS
        .iter()
        .find_map(|(suffix, unit)| Some((name.strip_suffix(suffix)?, *unit)));
    found.filter(|(stem, _)| !stem.is_empty()).unwrap_or((name, ""))
}

/// What a column is called in words: `gap_tension_m` is "tension gap", `bridge.module.deck_thickness_m` "module deck
/// thickness".
pub fn label(name: &str) -> String {
    match name {
        "gap_tension_m" | "bridge.connectors.gap_tension_m" => return "tension gap".to_owned(),
        "gap_compression_m" | "bridge.connectors.gap_compression_m" => return "compression gap".to_owned(),
        "load_x_m" => return "load place".to_owned(),
        "min_contact_force_n" => return "smallest contact force".to_owned(),
        _ => {}
    }
    let (stem, _) = split(name);
    let path = ["bridge.", "vehicle.", "analysis."]
        .iter()
        .find_map(|root| stem.strip_prefix(root))
        .unwrap_or(stem);
    path.replace(['.', '_'], " ")
}

/// A number with five significant digits, whole ones in full, without zeros that say nothing.
pub fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    let digits = x.abs().log10().floor() as i32;
    if !(-5..9).contains(&digits) {
        return format!("{x:.3e}");
    }
    let decimals = usize::try_from(4 - digits).unwrap_or(0);
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A value of a column as people say it: `0.028` of `gap_tension_m` is "28 mm", `230300` of `load_n` "230.3 kN".
pub fn value(name: &str, value: &Value) -> String {
    let Some(x) = value.as_f64() else {
        return match value {
            Value::Null => "-".to_owned(),
            Value::String(word) => word.clone(),
            other => other.to_string(),
        };
    };
    let (x, unit) = match unit(name) {
        "m" if x.abs() < 0.1 => (1e3 * x, "mm"),
        "N" if x.abs() >= 1e3 => (1e-3 * x, "kN"),
        unit => (x, unit),
    };
    let space = if unit.is_empty() { "" } else { " " };
    format!("{}{space}{unit}", number(x))
}

/// A word that keeps to its line: a blank for whatever is no character to be seen.
pub fn printable(word: &str) -> String {
    word.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
    }

    #[test]
    fn values_are_said_in_the_unit_that_fits() {
        let said = [
            ("gap_tension_m", json!(0.028)),
            ("gap_compression_m", json!(0.0055)),
            ("gap_tension_m", json!(0.0)),
            ("load_n", json!(230_300)),
            ("speed_m_s", json!(6.09)),
            ("connection", json!("linear")),
            ("load_position", json!(7)),
            ("gap_tension_m", json!(null)),
        ];
        let said = said.map(|(name, v)| value(name, &v));
        assert_eq!(
            said,
            ["28 mm", "5.5 mm", "0 mm", "230.3 kN", "6.09 m/s", "linear", "7", "-"]
        );
        assert_eq!([0.1 + 0.2, 1e-9, 123_456.7].map(number), ["0.3", "1.000e-9", "123457"]);
    }
}
