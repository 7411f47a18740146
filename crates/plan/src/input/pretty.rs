//! A document as a person would write it.
//!
//! Knows line lengths. Does not know what any key means.

use serde_json::Value;

/// Longest line that an object or list is kept on.
const LINE: usize = 118;

/// A document with two blanks a level, what fits on a line on one line; a last line end.
pub fn pretty(document: &Value) -> String {
    let mut text = String::new();
    write(document, 0, 0, &mut text);
    text + "\n"
}

/// Writes a value that begins behind `used` characters of a line, at a level.
fn write(value: &Value, level: usize, used: usize, text: &mut String) {
    let line = on_one_line(value);
    if used + line.chars().count() <= LINE && level > 0 {
        text.push_str(&line);
        return;
    }
    let inner = "  ".repeat(level + 1);
    let parts: Vec<(String, &Value)> = match value {
        Value::Object(map) if !map.is_empty() => map
            .iter()
            .map(|(key, v)| (format!("{}: ", Value::from(key.as_str())), v))
            .collect(),
        Value::Array(list) if !list.is_empty() => list.iter().map(|v| (String::new(), v)).collect(),
        _ => {
            text.push_str(&line);
            return;
        }
    };
    let (open, close) = if value.is_object() { ('{', '}') } else { ('[', ']') };
    text.push(open);
    for (i, (key, part)) in parts.iter().enumerate() {
        text.push_str(if i == 0 { "\n" } else { ",\n" });
        text.push_str(&inner);
        text.push_str(key);
        write(part, level + 1, inner.len() + key.chars().count() + 1, text);
    }
    text.push('\n');
    text.push_str(&"  ".repeat(level));
    text.push(close);
}

fn on_one_line(value: &Value) -> String {
    let joined = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Object(map) if !map.is_empty() => {
            let parts = map
                .iter()
                .map(|(key, v)| format!("{}: {}", Value::from(key.as_str()), on_one_line(v)));
            format!("{{ {} }}", joined(parts.collect()))
        }
        Value::Array(list) => format!("[{}]", joined(list.iter().map(on_one_line).collect())),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_fits_stays_on_a_line_and_nothing_is_lost() {
        let document =
            json!({"name": "b", "list": [1.5, 2], "inner": {"a": null, "long": vec!["x".repeat(50); 3]}, "none": {}});
        let text = pretty(&document);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), document);
        assert!(text.contains("\"list\": [1.5, 2],\n"), "{text}");
        assert!(text.lines().all(|line| line.len() <= LINE), "{text}");
    }
}
