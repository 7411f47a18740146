//! What fuzzing keeps, read again as a run would read it: seeds, and inputs that once brought a reader down.

#[path = "../../fuzz/src/lib.rs"]
#[allow(unreachable_pub)]
mod readers;

use std::fs;
use std::path::Path;

fn outlived(name: &str) {
    let named = readers::READERS.into_iter().find(|(known, _)| *known == name);
    let (_, reader) = named.expect("a reader of this name");
    let folder = readers::folder();
    let mut seeds = 0;
    for kept in ["corpus", "found"] {
        let kept = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fuzz")
            .join(kept)
            .join(name);
        let Ok(listed) = fs::read_dir(&kept) else { continue };
        for entry in listed {
            let file = entry.expect("an entry").path();
            println!("{}", file.display());
            reader(folder.path(), &fs::read(&file).expect("a kept file"));
            seeds += 1;
        }
    }
    assert!(seeds > 0, "no seed of {name}");
}

#[test]
fn studies_that_are_kept_bring_nothing_down() {
    outlived("study");
}

#[test]
fn bridges_that_are_kept_bring_nothing_down() {
    outlived("bridge");
}

#[test]
fn references_that_are_kept_bring_nothing_down() {
    outlived("reference");
}

#[test]
fn journals_that_are_kept_bring_nothing_down() {
    outlived("journal");
}
