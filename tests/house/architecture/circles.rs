//! Circles among the files of a crate.
//!
//! Knows arrows and which file is the parent of which. Does not know how arrows were found.

use super::arrows::{Arrows, Uses};
use super::modules::Modules;
use std::collections::BTreeSet;

/// A crate's modules and what they have to do with each other.
pub(super) struct Crate {
    /// Its modules.
    pub modules: Modules,
    /// Who uses whom.
    pub uses: Uses,
}

impl Crate {
    /// Reads a crate as [`Modules::read`].
    pub(super) fn read(root: &str, text: &dyn Fn(&str) -> Option<String>) -> Self {
        let modules = Modules::read(root, text);
        Self {
            uses: Uses::of(&modules),
            modules,
        }
    }

    /// Circles of files, in words. A file that holds modules may know those below it and they it; the root may not, as all
    /// hangs on it. No other way back is good, nor one that leads through a parent.
    pub(super) fn circles(&self) -> Vec<String> {
        let all: BTreeSet<usize> = (0..self.modules.files.len()).collect();
        let mut found = Vec::new();
        self.search(&all, &mut found);
        let name = |file: usize| self.modules.files[file].name.as_str();
        found
            .iter()
            .map(|circle| in_words(circle, &self.uses.program, &name))
            .collect()
    }

    fn is_parent(&self, of: usize, file: usize) -> bool {
        let [parent, child] = [of, file].map(|f| &self.modules.files[f].module);
        !parent.is_empty() && child.len() > parent.len() && child.starts_with(parent)
    }

    fn search(&self, files: &BTreeSet<usize>, found: &mut Vec<BTreeSet<usize>>) {
        for circle in tied(files, &self.uses.program) {
            let parent = circle
                .iter()
                .copied()
                .find(|&p| circle.iter().all(|&f| f == p || self.is_parent(p, f)));
            match parent {
                Some(parent) => self.search(&circle.into_iter().filter(|&f| f != parent).collect(), found),
                None => found.push(circle),
            }
        }
    }

    /// Circles of rooms, the modules of the root, in words.
    pub(super) fn circles_of_rooms(&self) -> Vec<String> {
        let rooms: BTreeSet<&String> = self.modules.files.iter().filter_map(|f| f.module.first()).collect();
        let rooms: Vec<&String> = rooms.into_iter().collect();
        let room = |file: usize| {
            let own = self.modules.files[file].module.first();
            rooms.iter().position(|&room| Some(room) == own)
        };
        let mut arrows = Arrows::new();
        for ((from, to), names) in &self.uses.program {
            if let (Some(from), Some(to)) = (room(*from), room(*to))
                && from != to
            {
                arrows.entry((from, to)).or_default().extend(names.iter().cloned());
            }
        }
        let circles = tied(&(0..rooms.len()).collect(), &arrows);
        circles
            .iter()
            .map(|circle| in_words(circle, &arrows, &|room| rooms[room]))
            .collect()
    }

    /// `impl` blocks outside the file of their type, in words.
    pub(super) fn outside(&self) -> Vec<String> {
        let name = |file: usize| &self.modules.files[file].name;
        let words = |(of, home, at): &(String, usize, usize)| {
            format!("impl of {of} stands in {}, not in {}", name(*at), name(*home))
        };
        self.uses.outside.iter().map(words).collect()
    }
}

/// Sets of at least two files each of which leads to all others of its set.
fn tied(files: &BTreeSet<usize>, arrows: &Arrows) -> Vec<BTreeSet<usize>> {
    let reach = |from: usize| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(file) = next.pop() {
            let ends = arrows.keys().filter(|(a, b)| *a == file && files.contains(b));
            for (_, to) in ends {
                if seen.insert(*to) {
                    next.push(*to);
                }
            }
        }
        seen
    };
    let reached: Vec<(usize, BTreeSet<usize>)> = files.iter().map(|&file| (file, reach(file))).collect();
    let mut sets: Vec<BTreeSet<usize>> = Vec::new();
    for (file, seen) in &reached {
        if seen.contains(file) && !sets.iter().any(|set| set.contains(file)) {
            let back = reached
                .iter()
                .filter(|(other, its)| seen.contains(other) && its.contains(file));
            sets.push(back.map(|(other, _)| *other).collect());
        }
    }
    sets.retain(|set| set.len() > 1);
    sets
}

/// A circle's members, then its arrows.
fn in_words<'a>(circle: &BTreeSet<usize>, arrows: &Arrows, name: &dyn Fn(usize) -> &'a str) -> String {
    let members: Vec<&str> = circle.iter().map(|&member| name(member)).collect();
    let mut words = members.join(" ");
    for ((from, to), names) in arrows {
        if circle.contains(from) && circle.contains(to) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            words += &format!("\n  {} -> {}: {}", name(*from), name(*to), names.join(", "));
        }
    }
    words
}

/// A made-up crate: file, text.
fn made_up(files: &[(&str, &str)]) -> Crate {
    let text = |name: &str| files.iter().find(|f| f.0 == name).map(|f| f.1.to_owned());
    Crate::read("lib.rs", &text)
}

/// The files of each circle found, without its arrows.
fn rings(files: &[(&str, &str)]) -> Vec<String> {
    made_up(files).circles().into_iter().map(members).collect()
}

fn members(words: String) -> String {
    words.lines().next().unwrap_or_default().to_owned()
}

#[test]
fn rooms_may_be_a_circle_where_no_files_are() {
    let crate_ = made_up(&[
        ("lib.rs", "mod x; mod z;"),
        ("x/mod.rs", "mod y; mod w;"),
        ("x/y.rs", "use crate::z::Z;"),
        ("x/w.rs", "pub struct W;"),
        ("z.rs", "use crate::x::w::W; pub struct Z;"),
    ]);
    assert_eq!(crate_.circles(), [""; 0]);
    let rooms: Vec<String> = crate_.circles_of_rooms().into_iter().map(members).collect();
    assert_eq!(rooms, ["x z"]);
}

#[test]
fn two_files_that_know_each_other_are_a_circle_however_they_say_it() {
    let with = |a: &str, b: &str| {
        rings(&[
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", &format!("pub struct A; {a}")),
            ("b.rs", &format!("pub struct B; {b}")),
            ("c.rs", "pub struct C; #[cfg(test)] mod tests { use crate::a::A; }"),
        ])
    };
    assert_eq!(with("use crate::b::B;", "use crate::c::C;"), [""; 0]);
    assert_eq!(with("", "use crate::a::A;"), [""; 0]);
    for b in [
        "use crate::a::A;",
        "use crate::{a::{self, A as Other}, c::C};",
        "use super::a; fn f(_: a::A) {}",
        "fn f(_: &[Option<crate::a::A>]) {}",
        "fn f() { use super::a::A; }",
        "use super::*; fn f(_: a::A) {}",
        "fn f() { g!(1, super::a::A) }",
        "#[serde(with = \"crate::a\")] struct D;",
        "mod inside { use super::super::a::A; }",
        "impl Into<crate::a::A> for B { fn into(self) -> A {} }",
    ] {
        assert_eq!(with("use crate::b::B;", b), ["a.rs b.rs"], "{b}");
        assert_eq!(with("use crate::c::C;", b), [""; 0], "{b}");
        assert_eq!(with("use crate::c::C; use super::b as other;", b), ["a.rs b.rs"], "{b}");
    }
    for b in [
        "#[cfg(test)] mod tests { use crate::a::A; }",
        "#[cfg(test)] fn f(_: crate::a::A) {}",
        "pub(in crate::a) struct D;",
        "/// [`crate::a::A`]\nstruct D;",
        "use other::a::A;",
        "use ::crates::a;",
    ] {
        assert_eq!(with("use crate::b::B;", b), [""; 0], "{b}");
    }
}

#[test]
fn a_name_taken_through_a_re_export_leads_to_the_file_that_defines_it() {
    let with = |z: &str| {
        rings(&[
            ("lib.rs", "mod x; mod z;"),
            ("x/mod.rs", "mod y; mod w; pub use y::Y; pub use w::*; pub struct X;"),
            ("x/y.rs", "use crate::z::Z; pub struct Y;"),
            ("x/w.rs", "pub struct W;"),
            ("z.rs", &format!("pub struct Z; {z}")),
        ])
    };
    assert_eq!(with("use crate::x::Y;"), ["x/y.rs z.rs"]);
    assert_eq!(with("use crate::x::y::Y;"), ["x/y.rs z.rs"]);
    assert_eq!(with("use crate::x::W;"), [""; 0]);
}

#[test]
fn only_parent_and_child_may_know_each_other() {
    let with = |root: &str, x: &str, y: &str, w: &str, z: &str| {
        rings(&[
            ("lib.rs", &format!("mod x; mod z; {root}")),
            ("x/mod.rs", &format!("mod y; mod w; pub struct X; {x}")),
            ("x/y.rs", &format!("pub struct Y; {y}")),
            ("x/w.rs", &format!("pub struct W; {w}")),
            ("z.rs", &format!("pub struct Z; {z}")),
        ])
    };
    let (x, child) = ("fn f(_: y::Y, _: w::W) {}", "use super::X;");
    assert_eq!(with("", x, child, child, ""), [""; 0]);
    assert_eq!(with("", x, "use super::w::W;", child, ""), [""; 0]);
    assert_eq!(
        with("", x, "use super::w::W;", "use super::y::Y;", ""),
        ["x/y.rs x/w.rs"]
    );
    // around through a parent
    assert_eq!(
        with("", x, "use crate::z::Z;", "", "use crate::x::X;"),
        ["x/mod.rs x/y.rs z.rs"]
    );
    // the root is nobody's parent, but it may say what there is
    assert_eq!(
        with("pub struct R; fn f(_: z::Z) {}", "", "", "", "use crate::R;"),
        ["lib.rs z.rs"]
    );
    assert_eq!(
        with("pub struct R; pub use z::Z;", "", "", "", "use crate::R;"),
        [""; 0]
    );
}

#[test]
fn an_impl_outside_the_file_of_its_type_is_told() {
    let with = |b: &str| {
        made_up(&[
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "pub struct A; impl A {} impl Clone for A {}"),
            ("b.rs", &format!("use crate::a::A; pub struct B; trait Own {{}} {b}")),
        ])
        .outside()
    };
    let told = ["impl of A stands in b.rs, not in a.rs"];
    for b in [
        "impl A {}",
        "impl Drop for A {}",
        "impl PartialEq<u8> for &A {}",
        "impl super::a::A {}",
    ] {
        assert_eq!(with(b), told, "{b}");
    }
    for b in [
        "impl B {}",
        "impl Own for A {}",
        "impl From<B> for A {}",
        "impl<A> Own for A {}",
        "impl From<A> for B {}",
    ] {
        assert_eq!(with(b), [""; 0], "{b}");
    }
}
