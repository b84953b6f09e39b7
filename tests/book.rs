//! The documentation as a book: its contents name every page, once.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::layers::root;

/// The pages that the contents name, in their order.
fn listed() -> Vec<String> {
    let contents = fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    let links = contents.split("](").skip(1);
    links
        .filter_map(|rest| rest.split(')').next())
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_contents_name_every_page_once() {
    let listed = listed();
    let set: BTreeSet<String> = listed.iter().cloned().collect();
    assert_eq!(set.len(), listed.len(), "a page is named twice: {listed:?}");
    let mut pages = BTreeSet::new();
    for folder in ["", "rules/"] {
        for entry in fs::read_dir(root().join("docs").join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let is_page = Path::new(&name).extension().is_some_and(|it| it == "md");
            if is_page && name != "SUMMARY.md" {
                pages.insert(format!("{folder}{name}"));
            }
        }
    }
    assert_eq!(set, pages);
}

/// mdBook takes headings for parts, and lists for chapters, each two blanks deeper below another.
#[test]
fn the_contents_are_those_of_a_book() {
    let contents = fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    for line in contents.lines().filter(|line| !line.is_empty()) {
        let chapter = line.trim_start().strip_prefix("- [");
        let indent = line.len() - line.trim_start().len();
        let first = line == "[gwatt](README.md)";
        let right = line.starts_with("# ") || first || chapter.is_some() && indent <= 2;
        assert!(right, "{line}");
    }
}

/// Links that leave the folder of the book are those that `docs/book.sh` leads to the repository.
#[test]
fn links_leave_the_book_in_one_way() {
    for page in listed() {
        let text = fs::read_to_string(root().join("docs").join(&page)).unwrap();
        let depth = page.matches('/').count();
        for target in text.split("](").skip(1) {
            let target = target.split(')').next().unwrap_or_default();
            let ups = target.matches("../").count();
            if ups > depth {
                assert!(
                    ups == depth + 1 && target.starts_with("../"),
                    "{page}: {target}"
                );
            }
        }
    }
}

/// The book itself, where mdBook is there.
#[test]
fn it_is_built() {
    if std::process::Command::new("mdbook")
        .arg("--version")
        .output()
        .is_err()
    {
        crate::evidence::cannot_run("mdbook is not there");
        return;
    }
    crate::evidence::runs();
    let out = tempfile::tempdir().unwrap();
    let built = std::process::Command::new("bash")
        .arg(root().join("docs/book.sh"))
        .arg(out.path())
        .arg("https://example.org/gwatt")
        .output()
        .unwrap();
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    for page in listed() {
        let name = page
            .replace("README.md", "index.md")
            .replace(".md", ".html");
        let html = fs::read_to_string(out.path().join(&name));
        let html = html.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!html.contains("href=\"../../"), "{name}");
    }
    let index = fs::read_to_string(out.path().join("python.html")).unwrap();
    assert!(index.contains("https://example.org/gwatt/python/examples/timeline.py"));
}
