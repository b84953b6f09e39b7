//! What the rules of messages mean: names in, texts out.
//!
//! Every finding carries the name of a rule (`error[arc-radius]`). The pages in `docs/rules` have
//! a section for each: what it means, why it matters for the power, an example, what to do. They
//! are part of the program, so that `gwatt explain`, SARIF and the documentation say the same.

mod index;
mod section;

use std::sync::LazyLock;

pub use index::index;
pub use section::Rule;

/// A page of rules.
struct Page {
    /// Its file in `docs/rules`.
    file: &'static str,
    text: &'static str,
}

/// A page by the name of its file.
macro_rules! page {
    ($file:literal) => {
        Page {
            file: $file,
            text: include_str!(concat!("../../docs/rules/", $file)),
        }
    };
}

/// All pages, in the order of the index.
const PAGES: [Page; 7] = [
    page!("text.md"),
    page!("flow.md"),
    page!("motion.md"),
    page!("cycles.md"),
    page!("machine-words.md"),
    page!("limits.md"),
    page!("machine-file.md"),
];

static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let pages = PAGES.iter();
    pages
        .flat_map(|page| section::rules(page.file, page.text))
        .collect()
});

/// All rules, page by page, in alphabetical order within each.
#[must_use]
pub fn rules() -> &'static [Rule] {
    &RULES
}

/// The rule with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.name == name)
}

/// Names of rules that look like `name`, the likeliest first.
#[must_use]
pub fn close_to(name: &str) -> Vec<&'static str> {
    let name = name.to_lowercase();
    let alike = |rule: &Rule| {
        let whole = strsim::jaro_winkler(&name, rule.name);
        // A part of it, as `radius`.
        let part = rule.name.split('-').any(|part| part == name);
        if part { whole.max(0.9) } else { whole }
    };
    let mut found: Vec<(f64, &str)> = RULES.iter().map(|it| (alike(it), it.name)).collect();
    found.retain(|(likeness, _)| *likeness >= LIKENESS_MIN);
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.cmp(b.1)));
    found.truncate(CLOSE_MAX);
    found.into_iter().map(|(_, name)| name).collect()
}

/// How alike names are that are proposed, from 0 to 1.
const LIKENESS_MIN: f64 = 0.85;
/// How many are proposed.
const CLOSE_MAX: usize = 5;

#[cfg(test)]
mod tests {
    use super::{close_to, find, rules};

    #[test]
    fn names_are_found() {
        let rule = find("arc-radius").unwrap();
        assert_eq!(rule.page, "motion.md");
        assert!(find("arc-radiuss").is_none());
        assert_eq!(close_to("arc-radiuss").first(), Some(&"arc-radius"));
        assert!(close_to("Radius").contains(&"arc-radius"));
        assert!(close_to("zzz").is_empty());
    }

    #[test]
    fn each_has_one_text() {
        let mut names: Vec<&str> = rules().iter().map(|rule| rule.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
