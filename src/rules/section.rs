//! A section of a page: the text of one rule.

/// The text of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule {
    /// Its name, as it stands in messages.
    pub name: &'static str,
    /// The file in `docs/rules` that has its section.
    pub page: &'static str,
    /// The section without its heading: paragraphs in Markdown that read well as they are.
    pub text: &'static str,
}

impl Rule {
    /// What it means: the first paragraph, in one line.
    #[must_use]
    pub fn meaning(&self) -> String {
        let paragraph = self.text.split("\n\n").next().unwrap_or_default();
        paragraph.lines().collect::<Vec<_>>().join(" ")
    }

    /// The first sentence of that.
    #[must_use]
    pub fn summary(&self) -> String {
        let meaning = self.meaning();
        let end = meaning.find(". ").map_or(meaning.len(), |end| end + 1);
        meaning.get(..end).unwrap_or(&meaning).to_owned()
    }

    /// The paragraph that begins with `label`, as `Power: `; without the label.
    #[must_use]
    pub fn part(&self, label: &str) -> Option<&'static str> {
        let mut paragraphs = self.text.split("\n\n");
        paragraphs.find_map(|paragraph| paragraph.strip_prefix(label))
    }

    /// An example that is a program, and the dialect that it is read as.
    #[must_use]
    pub fn example(&self) -> Option<(&'static str, String)> {
        let (dialect, rest) = self.part("Example, `")?.split_once('`')?;
        if rest != ":" {
            return None;
        }
        let after = self.text.split_once("`:\n\n")?.1;
        let lines = after.lines().map_while(|line| line.strip_prefix("    "));
        let mut program = String::new();
        for line in lines {
            program.push_str(line);
            program.push('\n');
        }
        Some((dialect, program))
    }
}

/// The rules of a page.
pub(super) fn rules(page: &'static str, text: &'static str) -> impl Iterator<Item = Rule> + use<> {
    text.split("\n## ").skip(1).filter_map(move |section| {
        let (name, text) = section.split_once('\n')?;
        Some(Rule {
            name,
            page,
            text: text.trim(),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::rules;

    const PAGE: &str = "# Words\n\nAbout words.\n\n## a-rule\n\nIt means\nthis. And more.\n\n\
                        Power: much.\n\nExample, `iso`:\n\n    G1 X1\n    M30\n\nDo: it.\n\n\
                        ## other\n\nShort.\n\nPower: none.\n\nExample: a file\n\nDo: nothing.\n";

    #[test]
    fn a_page_is_read() {
        let all: Vec<_> = rules("words.md", PAGE).collect();
        let [first, second] = all.as_slice() else {
            panic!("{all:?}")
        };
        assert_eq!((first.name, first.page), ("a-rule", "words.md"));
        assert_eq!(first.meaning(), "It means this. And more.");
        assert_eq!(first.summary(), "It means this.");
        assert_eq!(first.part("Do: "), Some("it."));
        assert_eq!(first.example(), Some(("iso", "G1 X1\nM30\n".to_owned())));
        assert_eq!(second.summary(), "Short.");
        assert_eq!(second.example(), None);
        assert_eq!(second.part("Example: "), Some("a file"));
    }
}
