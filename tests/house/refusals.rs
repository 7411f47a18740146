//! The list of all messages of refusals that tests meet, and what of a refusal does not hang on its words.
//!
//! The list (`tests/data/refusals.txt`) is there to be read: a message that is not in it fails the test that meets it, and
//! `scripts/refusals` writes it anew.

use pontoon_judge::calibrate::Parameters;
use pontoon_judge::reference::Reference;
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind, mark};
use pontoon_plan::job::Jobs;
use pontoon_plan::study_file::Study;
use std::collections::BTreeSet;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::process::Output;
use std::sync::OnceLock;

/// The list.
const LIST: &str = include_str!("../data/refusals.txt");

/// Names a file to which each message is appended in place of being looked for in the list.
const COLLECT: &str = "PONTOON_REFUSALS";

/// Expects the message of an end with status 2 to be in the list. The folder of the test stands in it as `DIR`.
pub(crate) fn listed(output: &Output, folder: &Path) {
    static LISTED: OnceLock<BTreeSet<&str>> = OnceLock::new();
    if output.status.code() != Some(2) {
        return;
    }
    let told = String::from_utf8_lossy(&output.stderr);
    let message = told.lines().next().unwrap_or_default();
    let message = message.replace(&folder.display().to_string(), "DIR");
    if let Some(to) = std::env::var_os(COLLECT) {
        let mut to = OpenOptions::new().create(true).append(true).open(to).unwrap();
        to.write_all(format!("{message}\n").as_bytes()).unwrap();
        return;
    }
    let listed = LISTED.get_or_init(|| LIST.lines().collect());
    assert!(
        listed.contains(message.as_str()),
        "not in tests/data/refusals.txt, which scripts/refusals writes anew: {message}"
    );
}

/// Which file of a case is changed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Of {
    Study,
    Bridge,
    Reference,
    Parameters,
}

const STUDY: &str = r#"{
  "name": "s", "bridge": "bridge.json",
  "vehicle": { "footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4] },
  "analysis": { "kind": "crossing", "time_step_s": 0.02 },
  "design": [ { "grid": { "connection": ["linear"], "speed_m_s": [5, 10], "load_n": 100000 } } ],
  "record": { "histories": { "positions": [2] } }
}
"#;

const REFERENCE: &str = r#"{
  "name": "r", "source": "a book",
  "checks": [
    { "id": "a", "value": { "of": { "select": { "table": "jobs", "column": "steps" } }, "expected": 1, "absolute_tolerance": 0 } },
    { "id": "b", "where": { "speed_m_s": { "from": 1 } }, "bound": { "of": { "history": { "quantity": "force_n", "position": 2, "reduce": "max" } }, "at_least": 0 } },
    { "id": "c", "curve": { "table": "positions", "column": "peak_deflection_m", "against": "x_m", "points": [[0, 1], [1, 2]], "relative_tolerance": 0.1 } }
  ]
}
"#;

const PARAMETERS: &str = r#"{
  "parameters": [ { "name": "hydrostatic_stiffness_pa_m", "lower": 7000, "upper": 8000 } ],
  "fit": ["a"]
}
"#;

/// Reads the files of a case as a run does, up to the refusal.
fn refusal(folder: &Path, of: Of) -> Option<Refusal> {
    match of {
        Of::Study | Of::Bridge => match Study::open(folder) {
            Ok(study) => Jobs::new(&study).find_map(Result::err),
            Err(refused) => Some(refused),
        },
        Of::Reference => Reference::open(&folder.join("reference.json")).err(),
        Of::Parameters => Parameters::open(&folder.join("parameters.json")).err(),
    }
}

/// The bytes that are marked, as a text.
fn marked<'a>(text: &'a str, refused: &Refusal) -> &'a str {
    mark(text, refused).map_or("", |mark| &text[mark.bytes])
}

/// A case: a text of a file, what stands in its place, the kind and path of the refusal, the text that is marked.
type Case = (Of, &'static str, &'static str, RefusalKind, &'static str, &'static str);

use RefusalKind::{
    Conflict, Misplaced, Missing, NotAllowed, Repeated, RepeatedKey, Syntax, UnknownKey, UnknownWord, WrongType,
};

#[rustfmt::skip]
const CASES: &[Case] = &[
    (Of::Study, r#""name": "s","#, "", Missing, "name", "{"),
    (Of::Study, r#""kind": "crossing", "#, "", Missing, "analysis.kind", r#""analysis": {"#),
    (Of::Study, r#""speed_m_s": [5, 10], "#, "", Missing, "design[0].grid.speed_m_s", r#""grid": {"#),
    (Of::Study, r#""vehicle": {"#, r#""vehicl": {"#, UnknownKey, "vehicl", r#""vehicl""#),
    (Of::Study, "footprint_length_m", "footprint_m", UnknownKey, "vehicle.footprint_m", r#""footprint_m""#),
    (Of::Study, r#""speed_m_s": [5"#, r#""sped_m_s": [5"#, UnknownKey, "design[0].grid.sped_m_s", r#""sped_m_s""#),
    (Of::Study, r#""kind": "crossing""#, r#""kind": "crosing""#, UnknownWord, "analysis.kind", r#""crosing""#),
    (Of::Study, r#"["linear"]"#, r#"["linear", "linaer"]"#, UnknownWord, "design[0].grid.connection", r#""linaer""#),
    (Of::Study, r#""load_n": 100000"#, r#""load_n": "much""#, WrongType, "design[0].grid.load_n", r#""much""#),
    (Of::Study, "[-1.4, 1.4]", r#"[-1.4, "x"]"#, WrongType, "vehicle.track_y_m[1]", r#""x""#),
    (Of::Study, "[5, 10]", "[5, -10]", NotAllowed, "design[0].grid.speed_m_s", "-10"),
    (Of::Study, "0.02 }", "1e-9 }", Conflict, "analysis.time_step_s", "1e-9"),
    (Of::Study, "3.35", "-3.35", NotAllowed, "vehicle.footprint_length_m", "-3.35"),
    (Of::Study, r#""positions": [2]"#, r#""positions": [2, 99]"#, NotAllowed, "record.histories.positions[1]", "99"),
    (Of::Study, r#""positions": [2]"#, r#""positions": [2, 2]"#, Repeated, "record.histories.positions[1]", "2"),
    (Of::Study, r#""time_step_s": 0.02"#, r#""time_step_s": 0.02, "count": 3"#, Misplaced, "analysis.count", r#""count""#),
    (Of::Study, r#""load_n": 100000"#, r#""load_n": 1, "load_n": 2"#, RepeatedKey, "design[0].grid", r#""load_n""#),
    (Of::Study, r#""load_n": 100000"#, r#""load_n": 100000, "load_position": 2"#, Misplaced, "design[0].grid.load_position", "2"),
    (Of::Study, "[5, 10],", "[5, 10]", Syntax, "design[0].grid", r#"""#),
    (Of::Study, "100000", "1e999", Syntax, "design[0].grid.load_n", "1e999"),
    (Of::Bridge, r#""depth_m": 1.07,"#, "", Missing, "module.depth_m", r#""module": {"#),
    (Of::Bridge, r#""breadth_m""#, r#""bredth_m""#, UnknownKey, "module.bredth_m", r#""bredth_m""#),
    (Of::Bridge, r#""depth_m": 1.07"#, r#""depth_m": 0"#, NotAllowed, "module.depth_m", "0"),
    (Of::Bridge, r#""modules": 3"#, r#""modules": 3.5"#, WrongType, "modules", "3.5"),
    (Of::Reference, r#""id": "b""#, r#""id": "a""#, Repeated, "checks[1].id", r#""a""#),
    (Of::Reference, r#""expected": 1, "#, "", Missing, "checks[0].value.expected", r#""value": {"#),
    (Of::Reference, r#""at_least": 0"#, r#""at_least": 0, "above": 0"#, Misplaced, "checks[1].bound", r#""bound""#),
    (Of::Reference, r#""reduce": "max""#, r#""reduce": "most""#, UnknownWord, "checks[1].bound.of.history.reduce", r#""most""#),
    (Of::Reference, "[[0, 1], [1, 2]]", "[[0, 1], [0, 2]]", Conflict, "checks[2].curve.points[1][0]", "0"),
    (Of::Reference, r#"{ "from": 1 }"#, r#"{ "form": 1 }"#, UnknownKey, "checks[1].where.speed_m_s.form", r#""form""#),
    (Of::Parameters, r#""upper": 8000"#, r#""upper": 6000"#, Conflict, "parameters[0].upper", "6000"),
    (Of::Parameters, r#""fit": ["a"]"#, r#""fit": ["a"], "tolerance": 0"#, NotAllowed, "tolerance", "0"),
    (Of::Parameters, r#", "upper": 8000"#, "", Missing, "parameters[0].upper", "{"),
];

/// Kind, path and marked bytes of refusals, as they are and with all their words replaced.
#[test]
fn nothing_but_the_message_hangs_on_words() {
    let smoke = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json");
    let bridge = fs::read_to_string(smoke).unwrap();
    let mut faults = Vec::new();
    for (of, from, to, kind, path, expected) in CASES {
        let folder = tempfile::tempdir().unwrap();
        let files = [
            (Of::Study, "study.json", STUDY),
            (Of::Bridge, "bridge.json", &bridge),
            (Of::Reference, "reference.json", REFERENCE),
            (Of::Parameters, "parameters.json", PARAMETERS),
        ];
        let mut changed = String::new();
        for (which, name, text) in files {
            let text = if which == *of {
                assert!(text.contains(from), "{name} has no {from}");
                changed = text.replacen(from, to, 1);
                &changed
            } else {
                text
            };
            fs::write(folder.path().join(name), text).unwrap();
        }
        let Some(refused) = refusal(folder.path(), *of) else {
            faults.push(format!("{to}: not refused"));
            continue;
        };
        let other = |text: &str| {
            if text.is_empty() {
                String::new()
            } else {
                "\u{6a4b}".to_owned()
            }
        };
        let translated = Refusal {
            found: Box::new(FoundValue {
                words: other(&refused.found.words),
                value: refused.found.value.clone(),
            }),
            allowed: other(&refused.allowed),
            nearest: refused.nearest.as_deref().map(|name| other(name).into()),
            ..refused.clone()
        };
        for of in [&refused, &translated] {
            let found = (of.kind, of.path.as_str(), marked(&changed, of));
            if found != (*kind, *path, *expected) {
                faults.push(format!("{to}: {found:?}, not {:?}: {of}", (kind, path, expected)));
            }
        }
    }
    assert!(CASES.len() >= 30, "{}", CASES.len());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
