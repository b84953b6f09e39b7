//! What README.md and the pages in docs/ show is true, and their links lead somewhere.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn examples_are_true() {
    trycmd::TestCases::new().case("README.md").case("docs/*.md");
}

fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["docs", "docs/rules"].map(|it| fs::read_dir(root.join(it)).expect("a folder"));
    let files = folders.into_iter().flatten();
    let mut pages: Vec<PathBuf> = files.map(|entry| entry.expect("an entry").path()).collect();
    pages.push(root.join("README.md"));
    pages.retain(|page| page.extension().is_some_and(|it| it == "md"));
    pages.retain(|page| !page.ends_with("SUMMARY.md"));
    pages.sort();
    pages
}

/// The anchor of a heading, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter_map(|sign| match sign {
        ' ' => Some('-'),
        '-' | '_' => Some(sign),
        _ if sign.is_alphanumeric() => Some(sign),
        _ => None,
    });
    kept.collect::<String>().to_lowercase()
}

fn anchors(text: &str) -> Vec<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| anchor(line.trim_start_matches('#')))
        .collect()
}

#[test]
fn links_lead_somewhere() {
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        for target in text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next())
        {
            if target.starts_with("http") {
                continue;
            }
            let (file, wanted) = target.split_once('#').unwrap_or((target, ""));
            let other = match file {
                "" => page.clone(),
                file => page.with_file_name("").join(file),
            };
            assert!(other.exists(), "{}: {target}", page.display());
            if !wanted.is_empty() {
                let text = fs::read_to_string(&other).expect("a page");
                let has = anchors(&text).iter().any(|it| it == wanted);
                assert!(has, "{}: {target}", page.display());
            }
        }
    }
}

/// README.md is for somebody who sees gwatt for the first time.
#[test]
fn the_front_page_is_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("README.md")).expect("a page");
    assert!(text.lines().count() <= 150, "{}", text.lines().count());
    let index = fs::read_to_string(root.join("docs/README.md")).expect("a page")
        + &fs::read_to_string(root.join("docs/rules.md")).expect("a page");
    for page in pages() {
        let name = page
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let below = page.parent().is_some_and(|it| it.ends_with("rules"));
        let link = if below {
            format!("(rules/{name})")
        } else {
            format!("({name})")
        };
        let listed = name == "README.md" || index.contains(&link);
        assert!(listed, "docs/README.md does not list {name}");
    }
}

/// The picture on it is the one that gwatt draws.
#[test]
fn the_picture_is_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("pocket.svg");
    let ran = Command::new(env!("CARGO_BIN_EXE_gwatt"))
        .current_dir(root)
        .args([
            "limit",
            "examples/pocket.ngc",
            "-m",
            "vmc",
            "--allow",
            "feed",
            "-o",
        ])
        .arg(folder.path().join("fit.ngc"))
        .arg("--svg")
        .arg(&picture)
        .output()
        .expect("gwatt");
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let [drawn, shown] = [picture, root.join("docs/pocket.svg")]
        .map(|path| fs::read_to_string(path).expect("a picture"));
    // No assert_eq: the pictures are long.
    assert!(
        drawn == shown,
        "gwatt draws another picture: put it into docs/pocket.svg"
    );
}

/// What docs/commissioning.md writes, one command after another as on the page.
#[test]
fn a_drive_is_put_into_service() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shop = tempfile::tempdir().expect("a folder");
    let recordings = Path::new("examples/commissioning");
    fs::create_dir_all(shop.path().join(recordings)).expect("a folder");
    for name in ["moves.txt", "power.csv"] {
        let name = recordings.join(name);
        fs::copy(root.join(&name), shop.path().join(&name)).expect("a copy");
    }
    let page = fs::read_to_string(root.join("docs/commissioning.md")).expect("a page");
    let commands: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("    gwatt "))
        .collect();
    assert_eq!(commands.len(), 5);
    for line in commands {
        let ran = Command::new(env!("CARGO_BIN_EXE_gwatt"))
            .args(line.split(' '))
            .current_dir(shop.path())
            .output()
            .expect("gwatt runs");
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{line}: {said}");
    }
    let machine = fs::read_to_string(shop.path().join("mill.toml")).expect("a machine");
    assert!(machine.contains("efficiency = 0.95"), "{machine}");
    let signal = fs::read_to_string(shop.path().join("signal.csv")).expect("a signal");
    assert_eq!(signal.lines().count(), 6001);
}

/// What docs/newcomers.md writes, one command after another as on the page; and the files that
/// were filled in are what the imports gave, where nothing was asked for.
#[test]
fn three_newcomers_get_their_pictures() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let desk = tempfile::tempdir().expect("a folder");
    let folder = Path::new("examples/newcomers");
    fs::create_dir_all(desk.path().join(folder)).expect("a folder");
    for entry in fs::read_dir(root.join(folder)).expect("a folder") {
        let entry = entry.expect("an entry");
        let copy = desk.path().join(folder).join(entry.file_name());
        fs::copy(entry.path(), copy).expect("a copy");
    }
    let page = fs::read_to_string(root.join("docs/newcomers.md")).expect("a page");
    let commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("    gwatt "));
    let mut pages = 0;
    for line in commands {
        let ran = Command::new(env!("CARGO_BIN_EXE_gwatt"))
            .args(line.split(' '))
            .current_dir(desk.path())
            .output()
            .expect("gwatt runs");
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{line}: {said}");
        if let Some((_, name)) = line.split_once("--html ") {
            let page = fs::read_to_string(desk.path().join(name)).expect("a page");
            assert!(page.starts_with("<!DOCTYPE html>"), "{line}");
            pages += 1;
        }
    }
    assert_eq!(pages, 4);
    for (imported, filled) in [
        ("mine.toml", "mill.toml"),
        ("router.toml", "router.toml"),
        ("printer.toml", "printer.toml"),
    ] {
        let imported = fs::read_to_string(desk.path().join(imported)).expect("a machine");
        let filled = fs::read_to_string(root.join(folder).join(filled)).expect("a machine");
        let given = imported
            .lines()
            .filter(|line| !line.is_empty() && !line.starts_with('#'));
        for line in given {
            assert!(
                filled.lines().any(|own| own == line),
                "{filled}\nlacks {line}"
            );
        }
    }
}
