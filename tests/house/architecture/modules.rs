//! The modules of one crate, and which file a path leads to.
//!
//! Knows `mod`, `use`, re-exports and the names that a module defines. Does not know what uses what.

use std::collections::{BTreeMap, BTreeSet};
use syn::{Attribute, Item, Meta, UseTree};

/// A module's path from the root of its crate: no names are the root itself.
pub(super) type ModulePath = Vec<String>;

/// What a `use` says, one entry a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Import {
    /// The path as written.
    pub path: Vec<String>,
    /// Name under which it is known here; none where all names are taken.
    pub name: Option<String>,
}

#[derive(Debug, Default)]
struct Module {
    file: usize,
    defined: BTreeSet<String>,
    imports: Vec<Import>,
}

/// A file of the crate.
pub(super) struct SourceFile {
    /// Its place below `src`.
    pub name: String,
    /// Its module.
    pub module: ModulePath,
    /// Whether all of it is compiled for tests only.
    pub is_test: bool,
    /// What stands in it.
    pub items: Vec<Item>,
}

/// What a path leads to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Found {
    /// A module.
    Module(ModulePath),
    /// Something that a module defines.
    Item(ModulePath, String),
}

/// The modules of a crate.
#[derive(Default)]
pub(super) struct Modules {
    /// Files, the root first.
    pub files: Vec<SourceFile>,
    all: BTreeMap<ModulePath, Module>,
}

/// The names of a path, as in `use`.
pub(super) fn imports(tree: &UseTree) -> Vec<Import> {
    let mut found = Vec::new();
    flatten(tree, &mut Vec::new(), &mut found);
    found
}

fn flatten(tree: &UseTree, before: &mut Vec<String>, found: &mut Vec<Import>) {
    let mut add = |last: Option<String>, name: Option<String>| {
        let path = before.iter().cloned().chain(last).collect();
        found.push(Import { path, name });
    };
    match tree {
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            flatten(&path.tree, before, found);
            before.pop();
        }
        UseTree::Name(name) if name.ident == "self" => {
            let known_as = before.last().cloned();
            add(None, known_as);
        }
        UseTree::Name(name) => add(Some(name.ident.to_string()), Some(name.ident.to_string())),
        UseTree::Rename(name) if name.ident == "self" => add(None, Some(name.rename.to_string())),
        UseTree::Rename(name) => add(Some(name.ident.to_string()), Some(name.rename.to_string())),
        UseTree::Glob(_) => add(None, None),
        UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, before, found)),
    }
}

/// Whether something is compiled for tests only.
pub(super) fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string() == "test",
        meta => meta.path().is_ident("test"),
    })
}

/// Attributes of an item.
pub(super) fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(x) => &x.attrs,
        Item::Enum(x) => &x.attrs,
        Item::Fn(x) => &x.attrs,
        Item::Impl(x) => &x.attrs,
        Item::Macro(x) => &x.attrs,
        Item::Mod(x) => &x.attrs,
        Item::Static(x) => &x.attrs,
        Item::Struct(x) => &x.attrs,
        Item::Trait(x) => &x.attrs,
        Item::Type(x) => &x.attrs,
        Item::Union(x) => &x.attrs,
        Item::Use(x) => &x.attrs,
        _ => &[],
    }
}

fn defined_name(item: &Item) -> Option<String> {
    match item {
        Item::Const(x) => Some(x.ident.to_string()),
        Item::Enum(x) => Some(x.ident.to_string()),
        Item::Fn(x) => Some(x.sig.ident.to_string()),
        Item::Macro(x) => x.ident.as_ref().map(ToString::to_string),
        Item::Static(x) => Some(x.ident.to_string()),
        Item::Struct(x) => Some(x.ident.to_string()),
        Item::Trait(x) => Some(x.ident.to_string()),
        Item::Type(x) => Some(x.ident.to_string()),
        Item::Union(x) => Some(x.ident.to_string()),
        _ => None,
    }
}

fn child(of: &[String], name: &str) -> ModulePath {
    of.iter().cloned().chain([name.to_owned()]).collect()
}

impl Modules {
    /// Reads a crate from its root file; `text` gives what stands in a file, none where there is no such file.
    pub(super) fn read(root: &str, text: &dyn Fn(&str) -> Option<String>) -> Self {
        let mut modules = Self::default();
        modules.read_file(root.to_owned(), "", Vec::new(), false, text);
        modules
    }

    /// Reads a file whose modules stand in the folder `folder`, which ends in a slash.
    fn read_file(
        &mut self,
        name: String,
        folder: &str,
        module: ModulePath,
        is_test: bool,
        text: &dyn Fn(&str) -> Option<String>,
    ) {
        let source = text(&name).unwrap_or_else(|| panic!("{name} cannot be read"));
        let file = syn::parse_file(&source).unwrap_or_else(|e| panic!("{name}: {e}"));
        let number = self.files.len();
        self.files.push(SourceFile {
            name,
            module: module.clone(),
            is_test,
            items: Vec::new(),
        });
        self.read_items(&file.items, number, folder, module, text);
        self.files[number].items = file.items;
    }

    fn read_items(
        &mut self,
        items: &[Item],
        file: usize,
        folder: &str,
        path: ModulePath,
        text: &dyn Fn(&str) -> Option<String>,
    ) {
        let mut module = Module {
            file,
            ..Module::default()
        };
        for item in items {
            module.defined.extend(defined_name(item));
            match item {
                Item::Use(item) => module.imports.extend(imports(&item.tree)),
                Item::Mod(inner) => {
                    let (name, path) = (inner.ident.to_string(), child(&path, &inner.ident.to_string()));
                    let inside = format!("{folder}{name}/");
                    if let Some((_, items)) = &inner.content {
                        self.read_items(items, file, &inside, path, text);
                        continue;
                    }
                    let mut place = format!("{folder}{name}.rs");
                    if text(&place).is_none() {
                        place = format!("{inside}mod.rs");
                    }
                    let is_test = is_test(&inner.attrs) || self.files[file].is_test;
                    self.read_file(place, &inside, path, is_test, text);
                }
                _ => {}
            }
        }
        self.all.insert(path, module);
    }

    /// The file of what was found.
    pub(super) fn file(&self, found: &Found) -> usize {
        let (Found::Module(path) | Found::Item(path, _)) = found;
        self.all[path].file
    }

    /// What a path in the module `here` leads to within the crate; none where it leads outside.
    pub(super) fn resolve(&self, here: &[String], path: &[String]) -> Option<Found> {
        self.resolve_within(here, path, 0)
    }

    /// `depth` re-exports have been followed.
    fn resolve_within(&self, here: &[String], path: &[String], depth: usize) -> Option<Found> {
        match path.first()?.as_str() {
            "crate" => self.walk(&[], &path[1..], depth),
            "self" | "super" => self.walk(here, path, depth),
            name => self
                .knows(here, name, depth)
                .then(|| self.walk(here, path, depth))
                .flatten(),
        }
    }

    /// Whether a module knows a name: its own, a child's, one that it imports.
    fn knows(&self, at: &[String], name: &str, depth: usize) -> bool {
        let module = &self.all[at];
        module.defined.contains(name)
            || self.all.contains_key(&child(at, name))
            || module.imports.iter().any(|i| i.name.as_deref() == Some(name))
            || self.taken_whole(at, name, depth).is_some()
    }

    /// The module whose names are all taken into `at` and that knows this one.
    fn taken_whole(&self, at: &[String], name: &str, depth: usize) -> Option<ModulePath> {
        let whole = self.all[at].imports.iter().filter(|i| i.name.is_none() && depth < 8);
        whole
            .filter_map(|i| self.resolve_within(at, &i.path, depth + 1))
            .find_map(|found| match found {
                Found::Module(other) if other != at && self.knows(&other, name, depth + 1) => Some(other),
                _ => None,
            })
    }

    fn walk(&self, at: &[String], rest: &[String], depth: usize) -> Option<Found> {
        let Some((name, more)) = rest.split_first() else {
            return Some(Found::Module(at.to_vec()));
        };
        if name == "self" {
            return self.walk(at, more, depth);
        }
        if name == "super" {
            return self.walk(&at[..at.len().checked_sub(1)?], more, depth);
        }
        let (module, inner) = (&self.all[at], child(at, name));
        let is_module = self.all.contains_key(&inner);
        if is_module && !more.is_empty() {
            return self.walk(&inner, more, depth);
        }
        if module.defined.contains(name) {
            return Some(Found::Item(at.to_vec(), name.clone()));
        }
        if let Some(import) = module.imports.iter().find(|i| i.name.as_ref() == Some(name))
            && depth < 16
            && import.path.first() != Some(name)
        {
            let path: Vec<String> = import.path.iter().chain(more).cloned().collect();
            return self.resolve_within(at, &path, depth + 1);
        }
        if is_module {
            return self.walk(&inner, more, depth);
        }
        match self.taken_whole(at, name, depth) {
            Some(other) => self.walk(&other, rest, depth + 1),
            None => Some(Found::Item(at.to_vec(), name.clone())),
        }
    }
}
