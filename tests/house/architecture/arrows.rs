//! Which file of a crate uses which, and `impl` blocks that stand outside the file of their type.
//!
//! Knows paths wherever they may stand: in `use`, in code, in macros, in attributes. Does not know which arrows are good.

use super::modules::{Found, Modules, attributes, imports, is_test};
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, ItemImpl, ItemMod, ItemUse, Macro, Meta, Path, Type, Visibility};

/// From file to file: the names that the first takes from the second.
pub(super) type Arrows = BTreeMap<(usize, usize), BTreeSet<String>>;

/// What the files of a crate have to do with each other.
#[derive(Debug, Default)]
pub(super) struct Uses {
    /// Arrows of the program.
    pub program: Arrows,
    /// Arrows of the tests inside the files.
    pub tests: Arrows,
    /// `impl` blocks outside the file of their type: the type, its file, the file of the block. Such a block is an arrow that
    /// no path shows: who calls a method does not say in which file it stands.
    pub outside: Vec<(String, usize, usize)>,
}

impl Uses {
    /// Reads all files of a crate. What the root re-exports is its table of contents, no use.
    pub(super) fn of(modules: &Modules) -> Self {
        let mut uses = Self::default();
        for (number, file) in modules.files.iter().enumerate() {
            let mut reader = Reader {
                modules,
                uses: &mut uses,
                file: number,
                here: file.module.clone(),
                in_test: file.is_test,
            };
            file.items.iter().for_each(|item| reader.visit_item(item));
        }
        uses
    }
}

struct Reader<'a> {
    modules: &'a Modules,
    uses: &'a mut Uses,
    file: usize,
    here: Vec<String>,
    in_test: bool,
}

fn segments(path: &Path) -> Vec<String> {
    path.segments.iter().map(|s| s.ident.to_string()).collect()
}

impl Reader<'_> {
    fn add(&mut self, path: &[String]) {
        let Some(found) = self.modules.resolve(&self.here, path) else {
            return;
        };
        let to = self.modules.file(&found);
        if to != self.file {
            let arrows = if self.in_test {
                &mut self.uses.tests
            } else {
                &mut self.uses.program
            };
            let name = match found {
                Found::Item(_, name) => name,
                Found::Module(path) => path.last().cloned().unwrap_or_default(),
            };
            arrows.entry((self.file, to)).or_default().insert(name);
        }
    }

    /// Paths in what has no grammar: arguments of macros and attributes.
    fn add_words(&mut self, tokens: &str) {
        let text = tokens.replace(" ::", "::").replace(":: ", "::");
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != ':');
        for word in words.filter(|word| word.contains("::") && !word.starts_with("::")) {
            let path: Vec<String> = word
                .split("::")
                .map(|s| s.trim_matches(':').to_owned())
                .filter(|s| !s.is_empty())
                .collect();
            self.add(&path);
        }
    }

    fn in_tests<T>(&mut self, attributes: &[Attribute], read: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.in_test;
        self.in_test |= is_test(attributes);
        let answer = read(self);
        self.in_test = before;
        answer
    }

    /// Whether something in a path is defined in this file.
    fn is_at_home(&self, path: &Path) -> bool {
        let own = |path: &[String]| {
            let found = self.modules.resolve(&self.here, path);
            found.is_some_and(|found| self.modules.file(&found) == self.file)
        };
        let mut paths = Paths::default();
        paths.visit_path(path);
        paths.0.iter().any(|path| own(path))
    }
}

/// All paths in a piece of code.
#[derive(Default)]
struct Paths(Vec<Vec<String>>);

impl Visit<'_> for Paths {
    fn visit_path(&mut self, path: &Path) {
        self.0.push(segments(path));
        visit::visit_path(self, path);
    }
}

impl Visit<'_> for Reader<'_> {
    fn visit_item(&mut self, item: &Item) {
        self.in_tests(attributes(item), |reader| visit::visit_item(reader, item));
    }

    fn visit_impl_item(&mut self, item: &ImplItem) {
        let attributes: &[Attribute] = match item {
            ImplItem::Fn(item) => &item.attrs,
            ImplItem::Const(item) => &item.attrs,
            _ => &[],
        };
        self.in_tests(attributes, |reader| visit::visit_impl_item(reader, item));
    }

    fn visit_item_mod(&mut self, item: &ItemMod) {
        if item.content.is_none() {
            return;
        }
        self.here.push(item.ident.to_string());
        visit::visit_item_mod(self, item);
        self.here.pop();
    }

    fn visit_item_use(&mut self, item: &ItemUse) {
        let is_contents = self.file == 0 && !matches!(item.vis, Visibility::Inherited);
        if !is_contents {
            for import in imports(&item.tree) {
                self.add(&import.path);
            }
        }
    }

    fn visit_path(&mut self, path: &Path) {
        if path.leading_colon.is_none() {
            self.add(&segments(path));
        }
        visit::visit_path(self, path);
    }

    fn visit_visibility(&mut self, _: &Visibility) {}

    fn visit_macro(&mut self, item: &Macro) {
        self.visit_path(&item.path);
        self.add_words(&item.tokens.to_string());
    }

    fn visit_attribute(&mut self, attribute: &Attribute) {
        if let Meta::List(list) = &attribute.meta {
            self.add_words(&list.tokens.to_string());
        }
    }

    fn visit_item_impl(&mut self, item: &ItemImpl) {
        let mut of = &*item.self_ty;
        while let Type::Reference(inner) = of {
            of = &inner.elem;
        }
        if let Type::Path(of) = of
            && let Some(found) = self.modules.resolve(&self.here, &segments(&of.path))
            && let Found::Item(_, name) = &found
        {
            let (home, by_trait) = (self.modules.file(&found), item.trait_.as_ref());
            // a trait at home here, or one with a type at home here in its brackets, may be given to any type
            let good = home == self.file || by_trait.is_some_and(|(_, path, _)| self.is_at_home(path));
            if !good && !self.in_test {
                self.uses.outside.push((name.clone(), home, self.file));
            }
        }
        visit::visit_item_impl(self, item);
    }
}
