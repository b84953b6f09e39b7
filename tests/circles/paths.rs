//! The paths of a file: those that it brings into its scope, and those in its code.

use std::collections::BTreeSet;
use std::path::Path;

/// The parts of a path, of modules from the crate on.
pub(super) type Module = Vec<String>;

/// The module of a file below `src`.
pub(super) fn module_of(path: &Path) -> Module {
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
pub(super) fn code_of(text: &str) -> String {
    let before_tests = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = before_tests.unwrap_or_default().lines();
    let code = lines.map(|line| line.split("//").next().unwrap_or_default());
    code.collect::<Vec<_>>().join("\n")
}

/// The paths of a `use`: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn paths_of(tree: &str) -> Vec<String> {
    let Some((front, rest)) = tree.split_once('{') else {
        return vec![tree.trim().to_owned()];
    };
    let inside = rest.rsplit_once('}').map_or(rest, |(inside, _)| inside);
    let (mut depth, mut start, mut found) = (0, 0, Vec::new());
    let signs = inside.char_indices().chain([(inside.len(), ',')]);
    for (at, sign) in signs {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(inside[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    found.retain(|part| !part.is_empty());
    found
        .into_iter()
        .flat_map(|part| paths_of(&format!("{}{part}", front.trim())))
        .collect()
}

fn parts_of(path: &str) -> Module {
    path.split("::")
        .map(|part| part.trim().to_owned())
        .collect()
}

/// A line without `pub`, `pub(super)` and the like, and whether it has that.
fn without_visibility(line: &str) -> (&str, bool) {
    let line = line.trim_start();
    match line.strip_prefix("pub") {
        Some(rest) if rest.starts_with('(') => {
            let rest = rest.split_once(')').map_or(rest, |(_, rest)| rest);
            (rest.trim_start(), true)
        }
        Some(rest) if rest.starts_with(' ') => (rest.trim_start(), true),
        _ => (line, false),
    }
}

/// A path that a file brings into its scope.
pub(super) struct Use {
    pub(super) path: Module,
    pub(super) name: String,
    /// It is a re-export.
    pub(super) passed_on: bool,
}

/// What a text brings into its scope, and the rest of the text.
pub(super) fn uses_of(code: &str) -> (Vec<Use>, String) {
    let (mut uses, mut rest) = (Vec::new(), String::new());
    let mut lines = code.lines();
    while let Some(line) = lines.next() {
        let (bare, passed_on) = without_visibility(line);
        if bare.starts_with("mod ") && bare.ends_with(';') {
            continue;
        }
        let Some(tree) = bare.strip_prefix("use ") else {
            rest.push_str(bare);
            rest.push('\n');
            continue;
        };
        let mut tree = tree.to_owned();
        while !tree.contains(';') {
            let Some(line) = lines.next() else { break };
            tree.push_str(line.trim());
        }
        for path in paths_of(tree.trim_end().trim_end_matches(';')) {
            let (path, alias) = match path.split_once(" as ") {
                Some((path, alias)) => (path, Some(alias.trim().to_owned())),
                None => (path.as_str(), None),
            };
            let mut path = parts_of(path);
            if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
                path.pop();
            }
            let name = alias.or_else(|| path.last().cloned()).unwrap_or_default();
            uses.push(Use {
                path,
                name,
                passed_on,
            });
        }
    }
    (uses, rest)
}

/// The words of a text, and its paths of several.
pub(super) fn words_of(code: &str) -> (BTreeSet<&str>, Vec<Module>) {
    let ends = |sign: char| !(sign.is_alphanumeric() || "_:".contains(sign));
    let (mut words, mut paths) = (BTreeSet::new(), Vec::new());
    for text in code.split(ends) {
        let path = text.trim_end_matches(':');
        words.extend(path.split("::").next());
        if path.contains("::") {
            paths.push(parts_of(path));
        }
    }
    (words, paths)
}
