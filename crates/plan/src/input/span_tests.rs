//! Places that refusals mean, told as the text that stands there.

use super::{Document, FoundValue, Mark, MarkKind, Refusal, RefusalKind, mark};
use serde_json::{Value, json};
use std::path::Path;

/// A refusal without words.
fn refusal(kind: RefusalKind, path: &str, found: Option<Value>) -> Refusal {
    let found = found.map_or(FoundValue::NOTHING, FoundValue::value);
    Refusal::new(Path::new("f.json"), path, found, "").because(kind)
}

/// The text at the place and what it is.
fn at<'a>(text: &'a str, kind: RefusalKind, path: &str, found: Option<Value>) -> Option<(&'a str, MarkKind)> {
    let mark = mark(text, &refusal(kind, path, found))?;
    Some((&text[mark.bytes], mark.kind))
}

/// The place of what makes a text no JSON.
fn fault(text: &str) -> Mark {
    mark(text, &refusal(RefusalKind::Syntax, "any.key", None)).unwrap()
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
    let at = |path, found| at(STUDY, RefusalKind::NotAllowed, path, found);
    let value = |text| Some((text, MarkKind::Value));
    assert_eq!(at("vehicle.track_y_m[1]", Some(json!(9))), value("9"));
    assert_eq!(at("vehicle.track_y_m", None), value("[-1.4, 9]"));
    assert_eq!(at("design[0].grid.speed.linspace", None), value("[1, 2]"));
    // what goes over lines is shown by its beginning
    assert_eq!(at("design", None), value("["));
    assert_eq!(at("design[1]", None), value("{}"));
}

#[test]
fn an_axis_is_a_key_with_points_and_what_was_found_one_of_its_values() {
    use RefusalKind::{Misplaced, NotAllowed, UnknownWord};
    let value = |text| Some((text, MarkKind::Value));
    let modules = "design[0].grid.bridge.modules";
    assert_eq!(at(STUDY, NotAllowed, modules, Some(json!(0))), value("0.0"));
    assert_eq!(at(STUDY, NotAllowed, modules, Some(json!(7))), value("[3, 0.0]"));
    let track = "design[0].grid.vehicle.track_y_m[0]";
    assert_eq!(at(STUDY, NotAllowed, track, Some(json!(-5))), value("-5"));
    assert_eq!(at(STUDY, NotAllowed, track, Some(json!(-1))), value("-1"));
    let word = "design[0].grid.word";
    assert_eq!(at(STUDY, UnknownWord, word, Some(json!("baad"))), value("\"baad\""));
    let key = Some(("\"bridge.hinges.y_m[7]\"", MarkKind::Key));
    assert_eq!(at(STUDY, Misplaced, "design[0].grid.bridge.hinges.y_m[7]", None), key);
}

#[test]
fn unknown_keys_are_shown_and_missing_ones_by_what_should_hold_them() {
    use RefusalKind::{Missing, NotAllowed, UnknownKey};
    let axels = at(STUDY, UnknownKey, "vehicle.axels", Some(json!("axels")));
    assert_eq!(axels, Some(("\"axels\"", MarkKind::Key)));
    let around = |path| at(STUDY, Missing, path, None);
    assert_eq!(around("vehicle.inertia"), Some(("\"vehicle\": {", MarkKind::Around)));
    assert_eq!(around("design[1]"), Some(("{", MarkKind::Around)));
    assert_eq!(around("name"), Some(("{", MarkKind::Around)));
    let together = Refusal {
        made_wrong: Some("bridge.mesh".into()),
        ..refusal(NotAllowed, "design[0].grid", None)
    };
    let found = mark(STUDY, &together).unwrap();
    assert_eq!((&STUDY[found.bytes], found.kind), ("\"grid\"", MarkKind::Around));
    let one_of = r#"{ "of": { "slect": {} } }"#;
    let key = at(one_of, UnknownKey, "of.slect", Some(json!("slect")));
    assert_eq!(key, Some(("\"slect\"", MarkKind::Key)));
}

#[test]
fn what_has_no_place_is_not_shown() {
    assert_eq!(at(STUDY, RefusalKind::Whole, "", None), None);
    let elsewhere = "elsewhere.module";
    assert_eq!(at(STUDY, RefusalKind::NotAllowed, elsewhere, Some(json!(-1))), None);
    assert_eq!(at("", RefusalKind::Missing, "a", None), None);
}

#[test]
fn what_is_no_json_is_shown_where_the_reader_stopped() {
    let place = |text: &'static str| {
        let fault = fault(text);
        let MarkKind::Fault(message) = fault.kind else {
            panic!("{text}: {fault:?}")
        };
        (&text[fault.bytes], message)
    };
    let message = Some("expected `,` or `}`".to_owned());
    assert_eq!(place("{\"a\": 1\n \"b\": 2}"), ("\"", message));
    assert_eq!(place("{\"a\":1,}").0, "}");
    assert_eq!(place("{\"a\": [1, NaN]}"), ("NaN", None));
    assert_eq!(place("{\"a\": -1e999}"), ("-1e999", None));
    assert_eq!(place("{} x").0, "x");
    let before = |text: &str| text[..fault(text).bytes.start].to_owned();
    assert_eq!(before("{\"a\": [1, 2\n\n"), "{\"a\": [1, 2");
    assert_eq!(before("{\"\u{fc}\": \u{e9}}"), "{\"\u{fc}\": ");
    assert_eq!(before(&"[".repeat(1000)).len(), 127);
}

#[test]
fn a_key_written_twice_is_shown_with_the_first() {
    let text = r#"{ "b": { "a": 0 }, "x": { "a": "a", "c": [{ "a": 1 }], "a": 2 } }"#;
    let twice = fault(text);
    assert_eq!(&text[twice.bytes.start..], "\"a\": 2 } }");
    let MarkKind::Twice(first) = twice.kind else {
        panic!("{:?}", twice.kind)
    };
    assert!(
        text[first.start..].starts_with("\"a\": \"a\""),
        "{}",
        &text[first.start..]
    );
    // where the text goes on as no JSON, the second is all that is known
    let broken = r#"{ "a": 1, "a": 2, ] "#;
    let twice = fault(broken);
    assert_eq!(
        (&broken[..twice.bytes.start], twice.kind),
        (r#"{ "a": 1, "#, MarkKind::Key)
    );
}

#[test]
fn escaped_keys_and_characters_of_many_bytes_are_found_whole() {
    let text = "{ \"\\u0061b\": { \"t\u{e4}il \u{65e5}\": \"\u{65e5}\" } }";
    assert_eq!(
        at(
            text,
            RefusalKind::NotAllowed,
            "ab.t\u{e4}il \u{65e5}",
            Some(json!("\u{65e5}"))
        ),
        Some(("\"\u{65e5}\"", MarkKind::Value))
    );
    assert_eq!(
        at(text, RefusalKind::UnknownKey, "ab", Some(json!("ab"))),
        Some(("\"\\u0061b\"", MarkKind::Key))
    );
}

#[test]
fn places_of_real_refusals_of_the_strict_reader_are_those_that_the_message_tells() {
    for (text, place) in [
        ("{\r\n\t\"a\": \"\u{65e5}\", oops }", "line 2, column 12"),
        ("{\"a\": 1,\n\n   \"a\": 2}", "line 3, column 4"),
        ("{\"a\": [", "line 1, column 8"),
        // a key that is written with escapes, and one that is a value too
        ("{\"name\": 1, \"na\\u006de\": 2}", "line 1, column 13"),
        ("{\"a\": 1,\n\"b\": \"a\",\n\"\\u0061\": 3}", "line 3, column 1"),
        ("{\"a/b\": 1, \"a\\/b\": 3}", "line 1, column 12"),
    ] {
        let refused = Document::parse(Path::new("f.json"), text).unwrap_err();
        assert!(refused.found.words.contains(place), "{refused}");
        let before = &text[..mark(text, &refused).unwrap().bytes.start];
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
        path in r"[abcdef.\[\]0-9 (\u{e9}]{0,12}",
        found in r#"(null|true|[0-9]{1,3}|"[a-z]{0,2}")"#,
        kind in proptest::sample::select(vec![
            RefusalKind::Missing, RefusalKind::UnknownKey, RefusalKind::Misplaced, RefusalKind::NotAllowed,
        ]),
    ) {
        for text in [&text, &valid] {
            let refused = refusal(kind, &path, serde_json::from_str(&found).ok());
            if let Some(mark) = mark(text, &refused) {
                assert!(text.get(mark.bytes.clone()).is_some(), "{text:?} {path:?} {mark:?}");
            }
        }
    }
}
