//! Places that refusals mean, told as the text that stands there.

use super::{SpotKind, spot};
use crate::input::Refusal;

/// The text at the place and what it is.
fn at<'a>(text: &'a str, key: &str, found: &str) -> Option<(&'a str, SpotKind)> {
    let spot = spot(text, key, found)?;
    Some((&text[spot.bytes], spot.kind))
}

/// The text before the place.
fn before<'a>(text: &'a str, key: &str, found: &str) -> &'a str {
    &text[..spot(text, key, found).unwrap().bytes.start]
}

const STUDY: &str = r#"{
  "vehicle": { "track_y_m": [-1.4, 9], "axels": [] },
  "design": [
    { "grid": { "bridge.modules": [3, 0.0], "vehicle.track_y_m": [[-1, 1], [-5, 1]],
                "speed": { "linspace": [1, 2] }, "word": ["good", "baad"], "bridge.hinges.y_m[7]": 1 } },
    {}
  ]
}"#;

#[test]
fn values_are_found_along_their_path() {
    use SpotKind::Value;
    assert_eq!(at(STUDY, "vehicle.track_y_m[1]", "9"), Some(("9", Value)));
    assert_eq!(at(STUDY, "vehicle.track_y_m", "a list"), Some(("[-1.4, 9]", Value)));
    assert_eq!(
        at(STUDY, "design[0].grid.speed.linspace", "[1,2]"),
        Some(("[1, 2]", Value))
    );
    // what goes over lines is shown by its beginning
    assert_eq!(at(STUDY, "design", "5 points"), Some(("[", Value)));
    assert_eq!(at(STUDY, "design[1]", "several of them"), Some(("{}", Value)));
}

#[test]
fn an_axis_is_a_key_with_points_and_what_was_found_one_of_its_values() {
    use SpotKind::Value;
    assert_eq!(at(STUDY, "design[0].grid.bridge.modules", "0"), Some(("0.0", Value)));
    assert_eq!(
        at(STUDY, "design[0].grid.bridge.modules", "7"),
        Some(("[3, 0.0]", Value))
    );
    assert_eq!(
        at(STUDY, "design[0].grid.vehicle.track_y_m[0]", "-5"),
        Some(("-5", Value))
    );
    assert_eq!(
        at(STUDY, "design[0].grid.vehicle.track_y_m[0]", "-1"),
        Some(("-1", Value))
    );
    assert_eq!(
        at(STUDY, "design[0].grid.word", "unknown 'baad'"),
        Some(("\"baad\"", Value))
    );
    let found = "no place [7] in a list of 3";
    let key = Some(("\"bridge.hinges.y_m[7]\"", SpotKind::Key));
    assert_eq!(at(STUDY, "design[0].grid.bridge.hinges.y_m[7]", found), key);
}

#[test]
fn unknown_keys_are_shown_and_missing_ones_by_what_should_hold_them() {
    use SpotKind::{Around, Key};
    assert_eq!(
        at(STUDY, "vehicle.axels", "unknown key 'axels'"),
        Some(("\"axels\"", Key))
    );
    assert_eq!(
        at(STUDY, "vehicle.inertia", "nothing"),
        Some(("\"vehicle\": {", Around))
    );
    assert_eq!(at(STUDY, "design[1]", "neither of the two"), Some(("{", Around)));
    assert_eq!(at(STUDY, "name", "nothing"), Some(("{", Around)));
    assert_eq!(
        at(STUDY, "design[0].grid (bridge.mesh)", "a mesh"),
        Some(("\"grid\"", Around))
    );
    let one_of = r#"{ "of": { "slect": {} } }"#;
    assert_eq!(at(one_of, "of", "'slect'"), Some(("\"slect\"", Key)));
}

#[test]
fn what_has_no_place_is_not_shown() {
    assert_eq!(at(STUDY, "", "no readable file"), None);
    assert_eq!(at(STUDY, "the bridge at this point.module", "-1"), None);
    assert_eq!(at("", "a", "nothing"), None);
}

#[test]
fn what_is_no_json_is_shown_where_the_reader_stopped() {
    let place = |text: &'static str| {
        let (found, kind) = at(text, "any.key", "anything").unwrap();
        let SpotKind::Fault(message) = kind else {
            panic!("{text}: {kind:?}")
        };
        (found, message)
    };
    assert_eq!(place("{\"a\": 1\n \"b\": 2}"), ("\"", "expected `,` or `}`".to_owned()));
    assert_eq!(place("{\"a\":1,}").0, "}");
    assert_eq!(place("{\"a\": [1, NaN]}").0, "NaN");
    assert_eq!(place("{\"a\": -1e999}").0, "-1e999");
    assert_eq!(place("{} x").0, "x");
    assert_eq!(place("\u{feff}{}").0, "\u{feff}");
    assert_eq!(before("{\"a\": [1, 2\n\n", "", ""), "{\"a\": [1, 2");
    assert_eq!(before("{\"\u{fc}\": \u{e9}}", "", ""), "{\"\u{fc}\": ");
    let deep = "[".repeat(1000);
    assert_eq!(before(&deep, "", "").len(), 127);
}

#[test]
fn a_key_written_twice_is_shown_with_the_first() {
    let text = r#"{ "b": { "a": 0 }, "x": { "a": "a", "c": [{ "a": 1 }], "a": 2 } }"#;
    let spot = spot(text, "x", "the key 'a' twice").unwrap();
    assert_eq!(&text[spot.bytes.start..], "\"a\": 2 } }");
    let SpotKind::Twice(first) = spot.kind else {
        panic!("{:?}", spot.kind)
    };
    assert!(
        text[first.start..].starts_with("\"a\": \"a\""),
        "{}",
        &text[first.start..]
    );
    // where the text goes on as no JSON, the second is all that is known
    let broken = r#"{ "a": 1, "a": 2, ] "#;
    let (found, kind) = at(broken, "", "the key 'a' twice").unwrap();
    assert_eq!((found, kind), ("\"a\"", SpotKind::Key));
    assert_eq!(before(broken, "", ""), r#"{ "a": 1, "#);
}

#[test]
fn escaped_keys_and_characters_of_many_bytes_are_found_whole() {
    let text = "{ \"\\u0061b\": { \"t\u{e4}il \u{65e5}\": \"\u{65e5}\" } }";
    assert_eq!(
        at(text, "ab.t\u{e4}il \u{65e5}", "'\u{65e5}'"),
        Some(("\"\u{65e5}\"", SpotKind::Value))
    );
    assert_eq!(
        at(text, "ab", "unknown key 'ab'"),
        Some(("\"\\u0061b\"", SpotKind::Key))
    );
}

#[test]
fn places_of_real_refusals_of_the_strict_reader_are_those_that_the_message_tells() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("f.json");
    for (text, place) in [
        ("{\r\n\t\"a\": \"\u{65e5}\", oops }", "line 2, column 12"),
        ("{\"a\": 1,\n\n   \"a\": 2}", "line 3, column 4"),
        ("{\"a\": [", "line 1, column 8"),
    ] {
        std::fs::write(&file, text).unwrap();
        let refused: Refusal = super::read(&file).unwrap_err();
        assert!(refused.found.contains(place), "{refused}");
        let before = before(text, &refused.key, &refused.found);
        let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
        let line = before.matches('\n').count() + 1;
        assert_eq!(format!("line {line}, column {column}"), place);
    }
}

proptest::proptest! {
    #[test]
    fn a_place_is_always_one_of_the_text(
        text in r#"[\[\]{}:," a0\n\r\t\u{e9}\u{65e5}\u{feff}\\u-]{0,40}"#,
        valid in r#"\{"a": \[[0-9]{1,3}, "[a-z\u{e9}]{0,3}", \{"b\.c": null, "d": \[\]\}\], "e": \{"f": true\}\}"#,
        key in r"[abcdef.\[\]0-9 (\u{e9}]{0,12}",
        found in r"(nothing|no a|unknown 'a'|'[a-z]{0,2}'|[0-9]{1,3}|null|true)",
    ) {
        for text in [&text, &valid] {
            if let Some(spot) = spot(text, &key, &found) {
                assert!(text.get(spot.bytes.clone()).is_some(), "{text:?} {key:?} {spot:?}");
            }
        }
    }
}
