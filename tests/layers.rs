//! The shape of the code: which crate may import which, which module, how long
//! files are, and that no test is forgotten.

use std::fs;
use std::path::{Path, PathBuf};

const LINES_MAX: usize = 500;

/// The crates in their order, each with those that it imports; all but the last
/// stand in `crates`.
pub(crate) const CRATES: [(&str, &[&str]); 10] = [
    ("gwatt-syntax", &[]),
    ("gwatt-machine", &["gwatt-syntax"]),
    ("gwatt-motion", &["gwatt-machine"]),
    (
        "gwatt-interpret",
        &["gwatt-machine", "gwatt-motion", "gwatt-syntax"],
    ),
    ("gwatt-plan", &["gwatt-machine", "gwatt-motion"]),
    (
        "gwatt-power",
        &["gwatt-machine", "gwatt-motion", "gwatt-plan"],
    ),
    (
        "gwatt-limit",
        &["gwatt-machine", "gwatt-motion", "gwatt-plan", "gwatt-power"],
    ),
    ("gwatt-identify", &["gwatt-machine"]),
    ("gwatt-import", &["gwatt-machine", "gwatt-syntax"]),
    (
        "gwatt",
        &[
            "gwatt-identify",
            "gwatt-import",
            "gwatt-interpret",
            "gwatt-limit",
            "gwatt-machine",
            "gwatt-motion",
            "gwatt-plan",
            "gwatt-power",
            "gwatt-syntax",
        ],
    ),
];

/// The folder of a crate.
pub(crate) fn folder_of(name: &str) -> PathBuf {
    if name == "gwatt" {
        root().to_owned()
    } else {
        root().join("crates").join(name)
    }
}

/// The crates of the workspace that a `Cargo.toml` names below headings such as
/// `[dependencies]`; with `dev` those of tests, else all others.
fn dependencies(manifest: &str, dev: bool) -> Vec<String> {
    let mut names = Vec::new();
    let mut counts = false;
    for line in manifest.lines() {
        if let Some(heading) = line.strip_prefix('[') {
            let heading = heading.trim_end_matches(']');
            counts = heading.ends_with("dependencies")
                && heading != "workspace.dependencies"
                && heading.ends_with("dev-dependencies") == dev;
        } else if counts && line.starts_with("gwatt") {
            let end = line.find(|c: char| !(c.is_alphanumeric() || c == '-'));
            names.push(line[..end.unwrap_or(line.len())].to_owned());
        }
    }
    names
}

/// The Rust files of all crates and of the Python package, tests of the root excluded.
fn sources() -> Vec<PathBuf> {
    let folders = CRATES.iter().map(|(name, _)| folder_of(name).join("src"));
    let folders = folders.chain([root().join("python/src")]);
    folders.flat_map(|folder| rust_files(&folder)).collect()
}

/// The root of the package.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All Rust files below a folder, in a fixed order.
pub(crate) fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    let mut files = Vec::new();
    for path in entries {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// The modules in the order of `lib.rs`.
fn modules() -> Vec<String> {
    let lib = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    lib.lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .map(str::to_owned)
        .collect()
}

/// The module that a file of `src` belongs to.
fn module_of(path: &Path) -> String {
    let path = path.strip_prefix(root().join("src")).unwrap();
    let first = path.components().next().unwrap();
    let name = first.as_os_str().to_str().unwrap();
    name.trim_end_matches(".rs").to_owned()
}

/// The modules that a text names after `crate::`, with their lines; comments
/// may name any.
fn imports(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        for rest in code.split("crate::").skip(1) {
            let names: Vec<&str> = match rest.strip_prefix('{') {
                // `crate::{a::B, c}`
                Some(list) => list.split(',').map(str::trim).collect(),
                None => vec![rest],
            };
            for name in names {
                let end = name.find(|c: char| !(c.is_alphanumeric() || c == '_'));
                found.push((index + 1, name[..end.unwrap_or(name.len())].to_owned()));
            }
        }
    }
    found
}

#[test]
fn crates_import_only_from_above() {
    let mut above: Vec<&str> = Vec::new();
    for (name, imports) in CRATES {
        let manifest = fs::read_to_string(folder_of(name).join("Cargo.toml")).unwrap();
        assert_eq!(dependencies(&manifest, false), imports, "{name} imports");
        for import in dependencies(&manifest, true)
            .iter()
            .chain(&dependencies(&manifest, false))
        {
            assert!(
                above.contains(&import.as_str()),
                "{name} imports {import}, which does not stand above it"
            );
        }
        above.push(name);
    }
}

#[test]
fn all_crates_are_listed() {
    let mut found: Vec<String> = fs::read_dir(root().join("crates"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    found.push("gwatt".to_owned());
    found.sort();
    let mut listed = CRATES.map(|(name, _)| name.to_owned());
    listed.sort();
    assert_eq!(found, listed);
}

#[test]
fn every_crate_has_an_example_and_the_lints() {
    for (name, _) in CRATES {
        let read = |file| fs::read_to_string(folder_of(name).join(file)).unwrap();
        let manifest = read("Cargo.toml");
        assert!(manifest.contains("[lints]\nworkspace = true"), "{name}");
        for field in ["description", "keywords", "license", "categories"] {
            let given = |line: &str| line.starts_with(field);
            assert!(manifest.lines().any(given), "{name}: {field}");
        }
        if name != "gwatt" {
            assert!(read("README.md").contains("```rust"), "{name}");
            assert!(read("src/lib.rs").contains("include_str!(\"../README.md\")"));
        }
    }
}

#[test]
fn modules_import_only_from_above() {
    let order = modules();
    assert!(order.len() > 4, "{order:?}");
    let mut wrong = Vec::new();
    for path in rust_files(&root().join("src")) {
        let module = module_of(&path);
        // The binary stands below all modules of the library and uses it by name.
        let Some(rank) = order.iter().position(|name| *name == module) else {
            assert!(
                ["lib", "main", "cli", "command"].contains(&module.as_str()),
                "src/lib.rs does not list {module}"
            );
            continue;
        };
        for (line, import) in imports(&fs::read_to_string(&path).unwrap()) {
            let above = order.iter().position(|name| *name == import);
            if above.is_some_and(|above| above > rank) {
                wrong.push(format!(
                    "{}:{line}: {module} imports {import}",
                    path.display()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_are_short() {
    let long: Vec<String> = sources()
        .into_iter()
        .filter_map(|path| {
            let lines = fs::read_to_string(&path).unwrap().lines().count();
            (lines > LINES_MAX).then(|| format!("{}: {lines} lines", path.display()))
        })
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn no_test_is_forgotten() {
    let main = fs::read_to_string(root().join("tests/main.rs")).unwrap();
    for entry in fs::read_dir(root().join("tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let is_test = path.extension().is_some_and(|extension| extension == "rs");
        if is_test && name != "main" {
            assert!(
                main.lines().any(|line| line == format!("mod {name};")),
                "tests/main.rs does not list {name}"
            );
        }
    }
}

#[test]
fn imports_are_found() {
    let text =
        "use crate::{machine::Machine, plan};\nlet x = crate::limit::y(); // crate::report\n";
    let names: Vec<String> = imports(text).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["machine", "plan", "limit"]);
}
