//! The index of all rules, as a page of the documentation.

use std::fmt::Write as _;

use super::{PAGES, rules};

/// The page `docs/rules.md`: every rule in one line, with a link to its section.
#[must_use]
pub fn index() -> String {
    let mut page = String::from(
        "# Rules\n\n\
         Every message names its rule, as in `error[arc-radius]`. `gwatt explain arc-radius` shows\n\
         what it means, why it matters for the power, an example, and what to do; `gwatt explain`\n\
         lists all rules. This page is made from the same texts.\n",
    );
    for source in &PAGES {
        let title = source.text.lines().next().unwrap_or_default();
        let title = title.trim_start_matches("# ");
        let _ = write!(
            page,
            "\n## [{title}](rules/{})\n\n| rule | meaning |\n|---|---|\n",
            source.file
        );
        for rule in rules().iter().filter(|rule| rule.page == source.file) {
            let (name, summary) = (rule.name, rule.summary().replace('|', "\\|"));
            let _ = writeln!(
                page,
                "| [{name}](rules/{}#{name}) | {summary} |",
                source.file
            );
        }
    }
    page
}
