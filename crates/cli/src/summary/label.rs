//! Names of columns and values as heads and cells of a table for people.
//!
//! Knows which part of a name tells columns apart. Does not know what is in a table.

use pontoon_view::labels;
use pontoon_view::labels::printable;
use serde_json::Value;

/// A name in words and the unit that it ends in, if any: `gap_tension_m` is "tension gap" in "m".
pub(super) fn label(name: &str) -> (String, Option<&'static str>) {
    let unit = Some(labels::unit(name)).filter(|unit| !unit.is_empty());
    (printable(&labels::label(name)), unit)
}

/// Names of axes as heads: of a path its last part, where no other axis ends in the same.
pub(super) fn heads(names: &[String]) -> Vec<(String, Option<&'static str>)> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
    let short = |name: &String| {
        let alone = names.iter().filter(|other| last(other) == last(name)).count() == 1;
        label(&if alone { last(name) } else { name.clone() })
    };
    names.iter().map(short).collect()
}

/// A value of an axis with its name and unit: "tension gap 0.028 m".
pub(super) fn told((name, unit): &(String, Option<&str>), value: &Value) -> String {
    let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
    format!("{name} {}{unit}", axis(value))
}

/// A value of an axis: a number with at most six digits, none that says nothing; nothing is a dash.
pub(crate) fn axis(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(word) => printable(word),
        Value::Number(number) => number.as_f64().map_or(number.to_string(), digits),
        other => printable(&other.to_string()),
    }
}

fn digits(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-5..1e9).contains(&x.abs()) {
        return format!("{x:e}");
    }
    let decimals = usize::try_from(5 - x.abs().log10().floor() as i32).unwrap_or(0);
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A peak: lengths to a tenth of a millimetre, forces to a newton.
pub(super) fn peak(name: &str, x: f64) -> String {
    if name.ends_with("_n") {
        format!("{x:.0}")
    } else {
        format!("{x:.4}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_are_words_and_units() {
        assert_eq!(label("gap_tension_m"), ("tension gap".to_owned(), Some("m")));
        assert_eq!(label("speed_m_s"), ("speed".to_owned(), Some("m/s")));
        assert_eq!(label("hydrostatic_stiffness_pa_m").1, Some("Pa/m"));
        assert_eq!(label("connection"), ("connection".to_owned(), None));
        assert_eq!(label("y_m[0]"), ("y m[0]".to_owned(), None));
        let names = ["bridge.a.depth_m", "bridge.b.depth_m", "bridge.b.width_m"].map(str::to_owned);
        let heads: Vec<String> = heads(&names).into_iter().map(|(name, _)| name).collect();
        assert_eq!(heads, ["a depth", "b depth", "width"]);
    }

    #[test]
    fn values_have_no_more_digits_than_say_something() {
        let texts = [
            json!(3.0),
            json!(0.0055),
            json!(230_300),
            json!(1.0 / 3.0),
            json!(-0.0),
            json!(2e11),
            json!(null),
        ];
        assert_eq!(
            texts.map(|v| axis(&v)),
            ["3", "0.0055", "230300", "0.333333", "0", "2e11", "-"]
        );
        assert_eq!(axis(&json!([-1.4, 1.4])), "[-1.4,1.4]");
        assert_eq!(axis(&json!("a\nb")), "a b");
    }
}
