//! Files do not import each other in a circle, inside a crate either: what two files share
//! stands in a third.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::layers::{CRATES, folder_of, rust_files};

type Module = Vec<String>;

/// The module of a file below `src`.
fn module_of(path: &Path) -> Module {
    let parts = path.with_extension("");
    let mut parts: Module = parts
        .iter()
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if matches!(
        parts.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        parts.pop();
    }
    parts
}

/// A text without comments and tests.
fn code_of(text: &str) -> String {
    let before_tests = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = before_tests.unwrap_or_default().lines();
    let code = lines.map(|line| line.split("//").next().unwrap_or_default());
    code.collect::<Vec<_>>().join("\n")
}

/// The paths of a `use`: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn paths_of(tree: &str) -> Vec<String> {
    let Some((front, rest)) = tree.split_once('{') else {
        return vec![tree.to_owned()];
    };
    let inside = rest.rsplit_once('}').map_or(rest, |(inside, _)| inside);
    let (mut depth, mut start, mut found) = (0, 0, Vec::new());
    let signs = inside.char_indices().chain([(inside.len(), ',')]);
    for (at, sign) in signs {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(&inside[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    found.retain(|part| !part.is_empty());
    found
        .into_iter()
        .flat_map(|part| paths_of(&format!("{front}{part}")))
        .collect()
}

/// All paths in a text that begin in this crate or near the file.
fn paths_in(code: &str) -> Vec<Vec<String>> {
    let mut found: Vec<String> = Vec::new();
    for rest in code.split("use ").skip(1) {
        let tree: String = rest
            .split(';')
            .next()
            .unwrap_or_default()
            .split_whitespace()
            .collect();
        found.extend(paths_of(&tree));
    }
    for first in ["crate::", "super::"] {
        // `super::super::a` is one path.
        let starts = code.match_indices(first);
        for (at, _) in starts.filter(|(at, _)| !code[..*at].ends_with("::")) {
            let rest = &code[at..];
            let end = rest.find(|sign: char| !(sign.is_alphanumeric() || "_:".contains(sign)));
            found.push(rest[..end.unwrap_or(rest.len())].to_owned());
        }
    }
    let path = |text: String| text.split("::").map(str::to_owned).collect::<Vec<_>>();
    let mut paths: Vec<Vec<String>> = found.into_iter().map(path).collect();
    paths.retain(|path| matches!(path[0].as_str(), "crate" | "self" | "super"));
    paths
}

/// Where a path of a module leads, from the crate on.
fn resolved(module: &Module, path: &[String]) -> Module {
    let supers = path.iter().take_while(|part| *part == "super").count();
    match path[0].as_str() {
        "crate" => path[1..].to_vec(),
        "self" => [module, &path[1..]].concat(),
        _ => [
            &module[..module.len().saturating_sub(supers)],
            &path[supers..],
        ]
        .concat(),
    }
}

/// Which files of a folder import which.
fn imports_of(folder: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    let files = rust_files(folder);
    let texts: BTreeMap<Module, String> = files
        .iter()
        .map(|file| {
            let module = module_of(file.strip_prefix(folder).unwrap());
            (module, code_of(&fs::read_to_string(file).unwrap()))
        })
        .collect();
    let target = |path: &Module| {
        (1..=path.len())
            .rev()
            .map(|end| path[..end].to_vec())
            .find(|module| texts.contains_key(module))
    };
    texts
        .iter()
        .map(|(module, code)| {
            let paths = paths_in(code);
            let targets = paths
                .iter()
                .filter_map(|path| target(&resolved(module, path)));
            (module.clone(), targets.filter(|it| it != module).collect())
        })
        .collect()
}

/// All modules that one leads to.
fn reached(from: &Module, imports: &BTreeMap<Module, BTreeSet<Module>>) -> BTreeSet<Module> {
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
fn circles(imports: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<BTreeSet<Module>> {
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
    for (name, _) in CRATES {
        let found = circles(&imports_of(&folder_of(name).join("src")));
        let names = |circle: &BTreeSet<Module>| {
            let names: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
            names.join(" ")
        };
        let shown: Vec<String> = found.iter().map(names).collect();
        assert!(shown.is_empty(), "{name}:\n{}", shown.join("\n"));
    }
}

#[test]
fn circles_are_found() {
    let module = |name: &str| vec![name.to_owned()];
    let imports = [("a", "b"), ("b", "c"), ("c", "a"), ("d", "a")];
    let imports: BTreeMap<Module, BTreeSet<Module>> = imports
        .into_iter()
        .map(|(from, to)| (module(from), BTreeSet::from([module(to)])))
        .collect();
    let found = circles(&imports);
    assert_eq!(found, [["a", "b", "c"].map(module).into_iter().collect()]);
    let code = "use super::{held::Held, idle};\nuse crate::a::{b::{C, d}, e};\n";
    let paths: Vec<String> = paths_in(&code_of(code))
        .iter()
        .map(|it| it.join("::"))
        .collect();
    for path in [
        "super::held::Held",
        "super::idle",
        "crate::a::b::d",
        "crate::a::e",
    ] {
        assert!(paths.iter().any(|it| it == path), "{path} {paths:?}");
    }
}
