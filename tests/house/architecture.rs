//! The rules of the house that a compiler does not hold.

mod arrows;
mod circles;
mod modules;

use circles::Crate;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .expect("the workspace")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All files below `dir` whose name ends in `ending`, sorted.
fn files(dir: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap_or_else(|e| panic!("{}: {e}", dir.display())) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            // packages of the page's tests are others' texts
            if path.ends_with("node_modules") {
                continue;
            }
            found.extend(files(&path, ending));
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn rust_files() -> Vec<PathBuf> {
    let mut all = files(&root().join("crates"), ".rs");
    all.extend(files(&root().join("tests"), ".rs"));
    assert!(all.len() > 40, "only {} files found", all.len());
    all
}

/// The libraries of a member, those of its tests left out.
fn dependencies(member: &str) -> Vec<String> {
    let manifest = read(&root().join("crates").join(member).join("Cargo.toml"));
    let table = manifest
        .split("[dependencies]\n")
        .nth(1)
        .expect("a table of dependencies");
    let table = table.split("\n[").next().unwrap_or_default();
    let name = |line: &str| line.split(['.', ' ', '=']).next().unwrap_or_default().to_owned();
    table
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .map(name)
        .collect()
}

/// Who may know whom, as `ARCHITECTURE.md` draws it: `study -> results, journal` is a line of its own.
fn arrows_drawn() -> Vec<(String, Vec<String>)> {
    let text = read(&root().join("ARCHITECTURE.md"));
    let arrow = |line: &str| {
        let (from, to) = line.strip_prefix("    ")?.split_once(" -> ")?;
        let to = to.split(',').map(|name| name.trim().to_owned()).collect();
        Some((from.trim().to_owned(), to))
    };
    text.lines().filter_map(arrow).collect()
}

/// All that a crate may know: what its arrows lead to, one after the other.
fn below(member: &str, arrows: &[(String, Vec<String>)]) -> Vec<String> {
    let own = arrows.iter().find(|(from, _)| from == member);
    let mut known: Vec<String> = own.map(|(_, to)| to.clone()).unwrap_or_default();
    for name in known.clone() {
        known.extend(below(&name, arrows));
    }
    known
}

const MEMBERS: [&str; 10] = [
    "core", "plan", "journal", "results", "study", "judge", "view", "water", "cli", "python",
];

/// The compiler refuses circles of crates. It does not refuse an arrow that nobody drew.
#[test]
fn crates_know_those_alone_that_the_architecture_draws() {
    let arrows = arrows_drawn();
    assert!(arrows.len() > 4, "only {arrows:?} found");
    for member in MEMBERS {
        let drawn = below(member, &arrows);
        for name in dependencies(member) {
            if let Some(name) = name.strip_prefix("pontoon-") {
                assert!(drawn.iter().any(|known| known == name), "{member} knows {name}");
            }
        }
    }
}

#[test]
fn libraries_are_known_where_they_belong() {
    let has = |member: &str, name: &str| dependencies(member).iter().any(|d| d == name);
    // numbers in, numbers out; rows that know no mechanics; words that know none
    assert!(!has("results", "pontoon-core") && !has("cli", "pontoon-core"));
    for (library, known) in [
        // its own arrays, and their way to another library
        ("polars-arrow", &["results", "python"][..]),
        ("polars-parquet", &["results"]),
        ("csv", &["results"]),
        // a long bridge prepared, jobs, and columns of a table read in parallel
        ("rayon", &["core", "results", "study"]),
        ("faer", &["core"]),
        ("resvg", &["view"]),
        ("anyhow", &["cli", "python"]),
        ("pyo3", &["python"]),
        ("netcdf-reader", &["water"]),
        ("clap", &["cli"]),
    ] {
        for member in MEMBERS {
            assert_eq!(has(member, library), known.contains(&member), "{library} in {member}");
        }
    }
}

/// The compiler forbids it in every other crate; in this one it warns of what is denied and not of what is allowed.
#[test]
fn unsafe_code_may_stand_in_one_file() {
    let root = root();
    let allowed: Vec<PathBuf> = rust_files()
        .into_iter()
        .filter(|file| read(file).contains(concat!("allow(unsafe", "_code")))
        .collect();
    assert_eq!(allowed, [root.join("crates/python/src/capsule.rs")]);
    for member in MEMBERS {
        let manifest = read(&root.join("crates").join(member).join("Cargo.toml"));
        let own = manifest.contains("[lints]\nworkspace = true");
        assert_eq!(own, member != "python", "{member}");
    }
    assert!(read(&root.join("crates/python/Cargo.toml")).contains("unsafe_code = \"deny\""));
}

#[test]
fn core_knows_no_files_clock_threads_or_randomness() {
    // what is prepared once for a bridge, see the decision on threads of a preparation
    let prepares = ["fem/windows.rs", "operator/basis.rs", "operator/residual_rows.rs"];
    for file in files(&root().join("crates/core/src"), ".rs") {
        let text = read(&file);
        let may_share = prepares.iter().any(|room| file.ends_with(room));
        for word in [
            "std::fs",
            "std::env",
            "std::io",
            "std::time",
            "std::thread",
            if may_share { "std::sync::atomic" } else { "rayon" },
            "rand::",
            "println!",
        ] {
            assert!(!text.contains(word), "{} has {word}", file.display());
        }
    }
}

#[test]
fn the_program_alone_prints() {
    for member in MEMBERS.into_iter().filter(|member| *member != "cli") {
        for file in files(&root().join("crates").join(member).join("src"), ".rs") {
            let text = read(&file);
            for word in ["println!", "eprint", "stdout()", "stderr()", "dbg!"] {
                assert!(!text.contains(word), "{} has {word}", file.display());
            }
        }
    }
}

/// A crate below `crates`, by the name of its folder.
fn read_crate(member: &str) -> Crate {
    let src = root().join("crates").join(member).join("src");
    let library = src.join("lib.rs").exists();
    Crate::read(if library { "lib.rs" } else { "main.rs" }, &|name| {
        fs::read_to_string(src.join(name)).ok()
    })
}

/// Floors of core from the ground up, as the table at the head of its root has them: a room knows its own floor and those
/// below.
fn floors() -> Vec<Vec<String>> {
    let mut floors: Vec<Vec<String>> = Vec::new();
    let text = read(&root().join("crates/core/src/lib.rs"));
    for row in text.lines().filter_map(|line| line.strip_prefix("//! | ")).skip(1) {
        let [floor, rooms, charter] = row.split('|').map(str::trim).collect::<Vec<_>>()[..3] else {
            panic!("{row} is not floor, rooms and charter");
        };
        assert_eq!(floor, floors.len().to_string(), "{row}");
        assert!(!charter.is_empty(), "{row} has no charter");
        floors.push(rooms.split('`').skip(1).step_by(2).map(str::to_owned).collect());
    }
    floors
}

#[test]
fn the_table_of_core_names_each_of_its_rooms_once() {
    let mut named = floors().concat();
    named.sort();
    let core = read_crate("core");
    let mut rooms: Vec<String> = core.modules.files[0]
        .items
        .iter()
        .filter_map(|item| match item {
            syn::Item::Mod(room) => Some(room.ident.to_string()),
            _ => None,
        })
        .collect();
    rooms.sort();
    assert!(rooms.len() > 10, "only {rooms:?} found");
    assert_eq!(named, rooms);
}

#[test]
fn rooms_of_core_know_only_their_own_floor_and_those_below() {
    let (core, floors) = (read_crate("core"), floors());
    let floor = |room: &str| {
        let at = floors.iter().position(|rooms| rooms.iter().any(|r| r == room));
        at.unwrap_or_else(|| panic!("{room} has no floor"))
    };
    let mut seen = 0;
    for ((from, to), names) in core.uses.program.iter().chain(&core.uses.tests) {
        let [file, used] = [from, to].map(|&file| &core.modules.files[file]);
        let (Some(own), Some(other)) = (file.module.first(), used.module.first()) else {
            panic!(
                "{} knows {names:?} of {}: the root holds rooms alone",
                file.name, used.name
            );
        };
        seen += usize::from(own != other);
        assert!(
            floor(other) <= floor(own),
            "{} of floor {} knows {names:?} of {}",
            file.name,
            floor(own),
            used.name
        );
    }
    assert!(seen > 20, "only {seen} uses found");
}

#[test]
fn files_of_a_crate_go_in_no_circle_but_parent_and_child() {
    let mut told = Vec::new();
    for member in MEMBERS {
        let read = read_crate(member);
        assert!(!read.uses.program.is_empty(), "{member}: no arrow found");
        let faults = [read.circles_of_rooms(), read.circles(), read.outside()].concat();
        told.extend(faults.into_iter().map(|fault| format!("{member}: {fault}")));
    }
    assert!(told.is_empty(), "{}", told.join("\n"));
}

#[test]
fn files_are_short_and_begin_with_what_they_are() {
    for file in rust_files() {
        let text = read(&file);
        let lines = text.lines().count();
        assert!(lines <= 600, "{} has {lines} lines", file.display());
        assert!(text.starts_with("//!"), "{} does not say what it is", file.display());
    }
}

#[test]
fn nothing_is_left_undone() {
    let words = ["todo", "unimplemented"].map(|word| format!("{word}!("));
    for file in rust_files() {
        let text = read(&file);
        for word in &words {
            assert!(!text.contains(word.as_str()), "{} has {word}", file.display());
        }
    }
}

#[test]
fn no_room_is_a_lumber_room() {
    for file in rust_files() {
        let name = file.to_string_lossy().into_owned();
        for word in ["utils", "common", "helpers"] {
            assert!(
                !name.contains(&format!("/{word}.rs")) && !name.contains(&format!("/{word}/")),
                "{name}"
            );
        }
    }
}

/// Endings that say a unit.
const UNITS: [&str; 17] = [
    "_m", "_m2", "_m3", "_m4", "_s", "_n", "_pa", "_hz", "_rad", "_kg", "_m_s", "_n_m", "_kg_m", "_kg_m3", "_pa_m",
    "_1_s", "_m_s2",
];
/// Names of pure numbers.
const PURE: [&str; 10] = [
    "wear_seed",
    "ratio",
    "share",
    "spectral_radius",
    "ladder_ratio",
    "relative_width",
    "section_coefficient",
    "three_dimensional_correction",
    "load_position",
    "poissons_ratio",
];

/// Numbers in the unit of something else that is named beside them: a column, a quantity, a parameter whose name ends in
/// its unit.
const OF_WHAT_IS_NAMED: [&str; 33] = [
    // pairs of a place and a height, both in metres
    "table",
    "normal",
    "uniform",
    "time_step_tolerance",
    "operator_tolerance",
    "deflection_tolerance",
    "compression_tolerance",
    "tension_tolerance",
    "above",
    "below",
    "weights",
    "hold",
    "sets",
    "expected",
    "relative_tolerance",
    "absolute_tolerance",
    "value",
    "uncertainty",
    "at_least",
    "at_most",
    "within",
    "points",
    "number",
    "start",
    "found",
    "held",
    "standard_error",
    "lower",
    "upper",
    "sum_of_squares_start",
    "sum_of_squares_best",
    "difference_share",
    "tolerance",
];

/// The names of all properties of a schema that hold numbers other than counts, or lists of them.
fn number_names(schema: &serde_json::Value, out: &mut Vec<String>) {
    match schema {
        serde_json::Value::Object(map) => {
            if let Some(serde_json::Value::Object(properties)) = map.get("properties") {
                let number = |value: &serde_json::Value| {
                    value.get("properties").is_none() && value.to_string().contains("\"number\"")
                };
                out.extend(
                    properties
                        .iter()
                        .filter(|(_, value)| number(value))
                        .map(|(name, _)| name.clone()),
                );
            }
            map.values().for_each(|value| number_names(value, out));
        }
        serde_json::Value::Array(list) => list.iter().for_each(|value| number_names(value, out)),
        _ => {}
    }
}

#[test]
fn every_number_that_a_person_types_ends_in_its_unit() {
    for schema in [
        pontoon_plan::schema::study(),
        pontoon_plan::schema::bridge(),
        pontoon_plan::schema::vehicle(),
        pontoon_judge::schema::reference(),
        pontoon_judge::schema::parameters(),
    ] {
        let mut names = Vec::new();
        number_names(&schema, &mut names);
        names.retain(|name| !["linspace", "geomspace", "from", "to", "between"].contains(&name.as_str()));
        assert!(names.len() > 4, "only {names:?} found");
        for name in names {
            let good = PURE.contains(&name.as_str())
                || OF_WHAT_IS_NAMED.contains(&name.as_str())
                || UNITS.iter().any(|unit| name.ends_with(unit));
            assert!(good, "{name} does not say its unit");
        }
    }
}

/// Whether a word in backticks is the path of a file of this repository.
fn is_path(word: &str) -> bool {
    let known = [".rs", ".json", ".md", ".toml", ".ipynb"]
        .iter()
        .any(|ending| word.ends_with(ending));
    let plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "._/-".contains(c));
    known && plain && word.contains('/') && !word.starts_with("results/") && !word.starts_with('/')
}

#[test]
fn paths_in_docs_exist() {
    let mut docs = rust_files();
    docs.extend(files(&root().join("crates"), ".md"));
    for folder in ["studies", "book/src", "tests"] {
        docs.extend(files(&root().join(folder), ".md"));
    }
    docs.extend(["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name)));
    for file in docs {
        let rust = file.extension().is_some_and(|e| e == "rs");
        let text = read(&file);
        // a page of the book tells the reader as which file to save a block
        let saved = |word: &str| text.contains(&format!(" file={word}"));
        for line in text.lines().filter(|line| !rust || line.trim_start().starts_with("//")) {
            for word in line.split('`').skip(1).step_by(2).filter(|word| is_path(word)) {
                let mut near = file.ancestors().skip(1).take_while(|dir| dir.starts_with(root()));
                assert!(
                    saved(word) || near.any(|dir| dir.join(word).exists()),
                    "{} names {word}, which does not exist",
                    file.display()
                );
            }
        }
    }
}
