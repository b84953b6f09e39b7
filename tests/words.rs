//! Prose in the field's own words: what CONTRIBUTING.md lists as avoided stands nowhere, neither in
//! texts nor in names.

use std::fs;
use std::path::{Path, PathBuf};

use crate::layers::root;

/// What is looked through, from the root on.
const PLACES: [&str; 13] = [
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "README.md",
    "benches",
    "crates",
    "docs",
    "examples",
    "fuzz/fuzz_targets",
    "machine-configs",
    "python",
    "src",
    "tests",
];
const KINDS: [&str; 8] = ["css", "html", "js", "md", "py", "rs", "sh", "toml"];
/// Texts of others, and what was recorded.
const NOT_OURS: [&str; 3] = ["vendor", "target", "snapshots"];

/// The words of the list, each with what takes its place.
fn avoided(contributing: &str) -> Vec<(String, String)> {
    let block = contributing.split_once("```words\n").map(|it| it.1);
    let block = block.and_then(|it| it.split_once("```")).map(|it| it.0);
    let lines = block.unwrap_or_default().lines();
    let entries = lines.filter_map(|line| line.split_once(" -> "));
    entries
        .map(|(word, instead)| (word.to_owned(), instead.to_owned()))
        .collect()
}

/// Whether a word stands in a line, as a whole and in any case.
fn stands_in(word: &str, line: &str) -> bool {
    let line = line.to_lowercase();
    let is_part = |sign: Option<char>| sign.is_some_and(|it| it.is_alphanumeric() || it == '_');
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        !is_part(before) && !is_part(after)
    })
}

fn files(place: &Path, found: &mut Vec<PathBuf>) {
    if place.is_file() {
        let kind = place.extension().map(|it| it.to_string_lossy());
        if kind.is_some_and(|kind| KINDS.contains(&&*kind)) {
            found.push(place.to_owned());
        }
        return;
    }
    for entry in fs::read_dir(place).into_iter().flatten().flatten() {
        let name = entry.file_name();
        if !NOT_OURS.iter().any(|other| name == *other) {
            files(&entry.path(), found);
        }
    }
}

/// A line without what is quoted as code.
fn without_code(line: &str) -> String {
    let parts = line.split('`').enumerate();
    parts
        .filter(|(index, _)| index % 2 == 0)
        .map(|(_, part)| part)
        .collect()
}

/// The lines of a text with words that are avoided; the list itself and names that pages quote may
/// have them.
fn found_in(text: &str, is_page: bool, words: &[(String, String)]) -> Vec<String> {
    let mut in_list = false;
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        in_list = line == "```words" || in_list && line != "```";
        let quoted = in_list || line.contains("alias = ");
        let shown = if is_page {
            without_code(line)
        } else {
            line.to_owned()
        };
        let hits = words
            .iter()
            .filter(|(word, _)| !quoted && stands_in(word, &shown));
        found.extend(hits.map(|(word, instead)| format!("{number}: `{word}`, better `{instead}`")));
    }
    found
}

#[test]
fn words_that_are_avoided_stand_nowhere() {
    let root = root();
    let contributing = fs::read_to_string(root.join("CONTRIBUTING.md")).unwrap();
    let words = avoided(&contributing);
    assert!(words.len() > 10, "the list in CONTRIBUTING.md is not read");
    let mut all = Vec::new();
    for place in PLACES {
        files(&root.join(place), &mut all);
    }
    assert!(all.len() > 500, "{} files", all.len());
    all.sort();
    let mut shown = Vec::new();
    for path in all {
        if path.ends_with("tests/words.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let is_page = path.extension().is_some_and(|kind| kind == "md");
        let name = path.strip_prefix(root).unwrap().display().to_string();
        shown.extend(
            found_in(&text, is_page, &words)
                .into_iter()
                .map(|hit| format!("{name}:{hit}")),
        );
    }
    assert!(
        shown.is_empty(),
        "{} lines\n{}",
        shown.len(),
        shown.join("\n")
    );
}

#[test]
fn words_are_found_as_wholes() {
    let words = avoided("# Words\n```words\ntold -> known\ntold apart -> distinguished\n```\n");
    assert_eq!(words.len(), 2);
    assert_eq!(
        found_in(
            "a Told b\nretold\ntold_us\n```words\ntold\n```\nit is told.\n",
            false,
            &words
        ),
        ["1: `told`, better `known`", "7: `told`, better `known`"]
    );
    let page = "the name `told` is `a told` b\nwhat is `told` told\n";
    assert_eq!(found_in(page, true, &words), ["2: `told`, better `known`"]);
}
