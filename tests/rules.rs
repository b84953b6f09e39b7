//! Every rule that a message can name has a text, and what the texts say is true.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use gwatt::machine::{Controller, Machine};
use gwatt::pipeline::{self, Failure, Options};
use gwatt::report::{Checked, sarif};
use gwatt::rules::{find, index, rules};

use crate::layers::root;

/// Texts of the code in kebab case that are no rules.
const NO_RULES: [&str; 28] = [
    "anti-resonance",
    "as-type-1",
    "beckhoff-as1000",
    "mitsubishi-hg-kn",
    "sanyo-ss242",
    "set-data",
    "twincat-scope",
    "yaskawa-sgm7j",
    "yaskawa-sgmsh",
    "fanuc-lathe",
    "fanuc-lathe-b",
    "five-axis",
    "haas-lathe",
    "kebab-case",
    "least-increment",
    "linear-gantry",
    "linear-motor",
    "linuxcnc-mill",
    "marlin-config",
    "max-accel",
    "max-vel",
    "min-1",
    "nothing-slowed",
    "okuma-lathe",
    "position-scale",
    "router-48v",
    "three-axis",
    "twincat-nci",
];

/// What stands right before the name of a rule of one word.
const BEFORE: [&str; 13] = [
    "Diagnostic::error(",
    ".error(",
    "warning(",
    "note(",
    "note_once(",
    "fault(",
    "Fault::new(",
    "IdentifyError::new(",
    "Obstacle::new(",
    "notes.push((",
    "reasons.push(place,",
    "rule:",
    "RULE: &str =",
];

/// The code of all crates, without tests and blanks before literals.
static CODE: LazyLock<Vec<(PathBuf, String)>> = LazyLock::new(|| {
    let mut folders = vec![root().join("src")];
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        folders.push(entry.unwrap().path().join("src"));
    }
    let files = folders.iter().flat_map(|it| crate::layers::rust_files(it));
    let code = files.filter(|path| path.file_stem().unwrap() != "tests");
    code.map(|path| {
        let text = fs::read_to_string(&path).unwrap();
        let code = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap_or_default();
        let lines = code
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        let text = lines.collect::<Vec<_>>().join("\n");
        (path, text)
    })
    .collect()
});

fn is_name(text: &str) -> bool {
    let part = |part: &str| {
        !part.is_empty()
            && part
                .bytes()
                .all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit())
    };
    text.starts_with(|first: char| first.is_ascii_lowercase()) && text.split('-').all(part)
}

/// The names in quotes, with whether they stand where a rule must.
fn names(code: &str) -> Vec<(&str, bool)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices('"') {
        let rest = &code[at + 1..];
        let Some(name) = rest.split('"').next().filter(|name| is_name(name)) else {
            continue;
        };
        let before = code[..at].trim_end();
        found.push((name, BEFORE.iter().any(|it| before.ends_with(it))));
    }
    found
}

#[test]
fn every_rule_has_a_text_and_every_text_a_rule() {
    let mut named = BTreeSet::new();
    let mut without_text = BTreeMap::new();
    for (path, code) in CODE.iter() {
        for (name, is_rule) in names(code) {
            named.insert(name.to_owned());
            let is_rule = is_rule || name.contains('-') && !NO_RULES.contains(&name);
            if is_rule && find(name).is_none() {
                without_text.insert(name, path);
            }
        }
    }
    assert!(
        without_text.is_empty(),
        "rules without a text in docs/rules: {without_text:#?}\n(texts that are no rules stand \
         in NO_RULES)"
    );
    let lost: Vec<&str> = rules()
        .iter()
        .map(|rule| rule.name)
        .filter(|name| !named.contains(*name))
        .collect();
    assert!(lost.is_empty(), "texts without a rule: {lost:?}");
    let gone: Vec<&str> = NO_RULES
        .into_iter()
        .filter(|name| !named.contains(*name) || find(name).is_some())
        .collect();
    assert!(gone.is_empty(), "NO_RULES lists {gone:?}");
}

/// Messages that tests and pages show name rules that have a text.
#[test]
fn messages_name_rules_that_have_a_text() {
    let mut places = vec![root().join("README.md")];
    for folder in ["docs", "src", "tests", "crates", "examples"] {
        let files = walkdir_files(&root().join(folder));
        places.extend(files.into_iter().filter(|path| {
            let ending = path.extension().unwrap_or_default();
            ["rs", "md", "snap", "trycmd"]
                .iter()
                .any(|it| ending == *it)
        }));
    }
    let mut wrong = BTreeSet::new();
    for path in places {
        let text = fs::read_to_string(&path).unwrap();
        for kind in ["error[", "warning[", "note["] {
            for (at, _) in text.match_indices(kind) {
                let rest = &text[at + kind.len()..];
                let name = rest.split(']').next().unwrap_or_default();
                let shown = rest[name.len()..].starts_with("]: ");
                // There the rules are made up.
                let made_up = path.ends_with("gwatt-syntax/src/diagnostic/render.rs");
                if shown && !made_up && is_name(name) && find(name).is_none() {
                    wrong.insert(format!("{}: {name}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn walkdir_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(walkdir_files(&path));
        } else {
            found.push(path);
        }
    }
    found
}

/// What it means, why it matters, an example, what to do, each in its place.
#[test]
fn texts_are_whole() {
    for rule in rules() {
        let parts: Vec<&str> = rule.text.split("\n\n").collect();
        let name = rule.name;
        assert!(parts[0].len() > 20 && parts[0].ends_with('.'), "{name}");
        assert!(parts[1].starts_with("Power: "), "{name}");
        let mut last = 3;
        if parts[2].ends_with("`:") {
            let (_, program) = rule.example().expect(name);
            assert!(!program.is_empty(), "{name}");
            last = 4;
        } else {
            assert!(parts[2].starts_with("Example: "), "{name}");
        }
        assert!(parts[last].starts_with("Do: "), "{name}");
        assert_eq!(parts.len(), last + 1, "{name}");
        assert!(rule.summary().len() < 200, "{name}: {}", rule.summary());
    }
    for page in [
        "text",
        "flow",
        "motion",
        "cycles",
        "machine-words",
        "limits",
        "machine-file",
    ] {
        let file = format!("{page}.md");
        let listed = rules().iter().filter(|rule| rule.page == file);
        let names: Vec<&str> = listed.map(|rule| rule.name).collect();
        assert!(names.is_sorted(), "{page}: {names:?}");
    }
}

/// The machine that an example is read on.
fn machine(dialect: &str) -> Machine {
    let name = match dialect {
        it if it.contains("lathe") => "lathe",
        "marlin" | "klipper" | "reprap" => "printer",
        _ => "three-axis",
    };
    let (mut machine, _) = Machine::load(name).unwrap();
    machine.controller = Controller::load(dialect).unwrap().0;
    machine
}

/// Programs in the texts bring the message that they are an example of.
#[test]
fn examples_bring_their_message() {
    let mut ran = 0;
    let mut wrong = Vec::new();
    for rule in rules() {
        let Some((dialect, program)) = rule.example() else {
            continue;
        };
        ran += 1;
        let machine = machine(dialect);
        let outcome = pipeline::analyze(Cursor::new(&program), &machine, &Options::default(), None);
        let said: Vec<&str> = match &outcome {
            Ok(summary) => {
                let peak = summary.unfit.iter().map(|_| "peak-power");
                summary
                    .notes
                    .iter()
                    .map(|note| note.rule)
                    .chain(peak)
                    .collect()
            }
            Err(Failure::Refused { diagnostics, .. }) => {
                diagnostics.iter().map(|found| found.rule).collect()
            }
            Err(failure) => panic!("{}: {failure}", rule.name),
        };
        if !said.contains(&rule.name) {
            wrong.push(format!("{} on {dialect}: {said:?}", rule.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(ran > 100, "{ran}");
}

/// The page of the documentation is made from the texts.
#[test]
fn the_index_is_the_page() {
    let path = root().join("docs/rules.md");
    if std::env::var_os("TRYCMD").is_some_and(|it| it == "overwrite") {
        fs::write(&path, index()).unwrap();
    }
    let page = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        page == index(),
        "docs/rules.md is old: `just bless` writes it again"
    );
}

/// SARIF describes the rules that it names by these texts.
#[test]
fn sarif_says_what_the_texts_say() {
    let machine = machine("iso");
    let program = "G2 X10 Y0 I9 J0 F1000\n";
    let outcome = pipeline::analyze(Cursor::new(program), &machine, &Options::default(), None);
    let checked = Checked {
        program: "part.ngc".to_owned(),
        outcome,
        changes: None,
        held: None,
    };
    let mut out = Vec::new();
    sarif(&[checked], Some("https://example.org/rules/"), &mut out).unwrap();
    let sarif: serde_json::Value = serde_json::from_slice(&out).unwrap();
    let described = &sarif["runs"][0]["tool"]["driver"]["rules"][0];
    let rule = find("arc-radius").unwrap();
    assert_eq!(described["id"], rule.name);
    assert_eq!(described["shortDescription"]["text"], rule.summary());
    assert_eq!(described["fullDescription"]["text"], rule.meaning());
    assert_eq!(
        described["helpUri"],
        "https://example.org/rules/motion.md#arc-radius"
    );
    assert_eq!(described["help"]["text"], rule.text);
    assert_eq!(described["help"]["markdown"], rule.text);
}
