//! Files do not import each other in a circle, inside a crate either: what two files share
//! stands in a third.
//!
//! A path counts for the file that defines what it names: by way of a child (`use child::X`), of
//! a module in scope (`child::f()`) or of a file that only re-exports it. What a method needs
//! that is called on a value is not seen.

mod imports;
mod paths;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::layers::{CRATES, folder_of};
use imports::{Files, Imports, imports_of};
use paths::{Module, code_of, module_of, uses_of};

/// All modules that one leads to.
fn reached(from: &Module, imports: &Imports) -> BTreeSet<Module> {
    let mut found = BTreeSet::new();
    let mut next = vec![from.clone()];
    while let Some(module) = next.pop() {
        for other in imports.get(&module).into_iter().flatten() {
            if found.insert(other.clone()) {
                next.push(other.clone());
            }
        }
    }
    found
}

/// Files of which each leads to all others.
fn circles(imports: &Imports) -> Vec<BTreeSet<Module>> {
    let reach: BTreeMap<&Module, BTreeSet<Module>> = imports
        .keys()
        .map(|module| (module, reached(module, imports)))
        .collect();
    let mut found = BTreeSet::new();
    for (module, own) in &reach {
        if own.contains(*module) {
            let mutual = own.iter().filter(|other| reach[other].contains(*module));
            found.insert(mutual.cloned().collect::<BTreeSet<Module>>());
        }
    }
    found.into_iter().collect()
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut shown = Vec::new();
    for (name, _) in CRATES {
        for circle in circles(&imports_of(&folder_of(name).join("src"))) {
            let names = circle.iter().map(|module| module.join("/"));
            shown.push(format!("{name}: {}", names.collect::<Vec<_>>().join(" ")));
        }
    }
    assert!(shown.is_empty(), "{}", shown.join("\n"));
}

#[test]
fn circles_are_found() {
    let module = |name: &str| vec![name.to_owned()];
    let imports = [("a", "b"), ("b", "c"), ("c", "a"), ("d", "a")];
    let imports: Imports = imports
        .into_iter()
        .map(|(from, to)| (module(from), BTreeSet::from([module(to)])))
        .collect();
    let found = circles(&imports);
    assert_eq!(found, [["a", "b", "c"].map(module).into_iter().collect()]);
}

/// The imports of a crate of these files, each as `from to`.
fn imports_between(files: &[(&str, &str)]) -> Vec<String> {
    let module = |path: &str| module_of(Path::new(path));
    let code = files
        .iter()
        .map(|(path, text)| (module(path), code_of(text)));
    let imports = Files::new(code.collect()).imports();
    let shown = |(from, to): (&Module, &BTreeSet<Module>)| -> Vec<String> {
        let to = to
            .iter()
            .map(|to| format!("{} {}", from.join("/"), to.join("/")));
        to.collect()
    };
    imports.iter().flat_map(shown).collect()
}

#[test]
fn trees_of_paths_are_read() {
    let text = "use super::{held::Held, idle};\nuse crate::a::{b::{C, d as e}, f};\n\
                pub(in crate::a) use g::{\n    self,\n    H, // one\n};\nfn i() {}\n";
    let (uses, rest) = uses_of(&code_of(text));
    let shown = uses
        .iter()
        .map(|it| format!("{} {}", it.path.join("::"), it.name));
    let expected = [
        "super::held::Held Held",
        "super::idle idle",
        "crate::a::b::C C",
        "crate::a::b::d e",
        "crate::a::f f",
        "g g",
        "g::H H",
    ];
    assert_eq!(shown.collect::<Vec<_>>(), expected);
    assert_eq!(rest.trim(), "fn i() {}");
}

#[test]
fn a_path_by_way_of_a_child_counts() {
    let child = ("a/b.rs", "use super::A;\npub struct B;");
    for parent in [
        "mod b;\nuse b::B;\npub struct A(B);",
        "mod b;\npub struct A(b::B);",
        "mod b;\npub use b::B;\npub struct A(B);",
    ] {
        let found = imports_between(&[("lib.rs", "mod a;"), ("a/mod.rs", parent), child]);
        assert_eq!(found, ["a a/b", "a/b a"], "{parent}");
    }
}

#[test]
fn a_path_counts_for_the_file_that_defines_what_it_names() {
    let files = [
        (
            "lib.rs",
            "mod a;\nmod d;\npub use d::*;\npub use outside::Other;",
        ),
        (
            "a/mod.rs",
            "mod b;\nmod c;\npub(crate) use b::B as Better;\nuse std::fmt;",
        ),
        ("a/b.rs", "use super::c;\npub struct B(c::C);"),
        ("a/c.rs", "pub struct C;"),
        (
            "d.rs",
            "use crate::Other;\nuse crate::a::Better;\npub struct D;",
        ),
        ("e.rs", "pub struct E(crate::D, super::a::Better);"),
    ];
    assert_eq!(
        imports_between(&files),
        ["a/b a/c", "d a/b", "e a/b", "e d"]
    );
}

#[test]
fn what_is_only_passed_on_is_not_needed() {
    let files = [
        ("a/mod.rs", "mod b;\npub use b::B;\npub struct A;"),
        ("a/b.rs", "use super::A;\npub(in crate::a) struct B(A);"),
    ];
    assert_eq!(imports_between(&files), ["a/b a"]);
}
