//! How the outline of a text is found.

use super::{Open, Outline, Rest, is_main, program_name};
use crate::flow::text::Text;

impl Outline {
    pub(crate) fn new(text: &Text) -> Self {
        let mut outline = Self::default();
        let mut open: Vec<(Open, usize)> = Vec::new();
        for line in 0..text.len() {
            let mut rest = Rest(text.line(line));
            if let Some(name) = program_name(rest.0) {
                open.clear();
                if is_main(rest.0) {
                    outline.mains.push(line);
                }
                outline.programs.push((line, name));
                continue;
            }
            if let Some(number) = rest.front() {
                outline.labels.entry(number).or_default().push(line);
            }
            if let Some(label) = rest.label() {
                if label == "ENDLABEL" {
                    outline.label_ends.push(line);
                }
                outline.labels.entry(label).or_default().push(line);
            }
            outline.structure(line, rest, &mut open);
        }
        outline
    }

    fn structure(&mut self, line: usize, mut rest: Rest<'_>, open: &mut Vec<(Open, usize)>) {
        let word = rest.name();
        let begins = match word.as_str() {
            "IF" if !rest.jumps() => Some(Open::If),
            "WHILE" => Some(Open::While),
            "FOR" => Some(Open::For),
            "LOOP" => Some(Open::Loop),
            // With a label it repeats a section.
            "REPEAT" if rest.name().is_empty() => Some(Open::Repeat),
            _ => None,
        };
        if let Some(kind) = begins {
            if kind == Open::For {
                self.counting.push(line);
            }
            open.push((kind, line));
            return;
        }
        let kind = match word.as_str() {
            "ELSE" | "ENDIF" => Open::If,
            "ENDWHILE" => Open::While,
            "ENDFOR" => Open::For,
            "ENDLOOP" => Open::Loop,
            "UNTIL" => Open::Repeat,
            "ENDLABEL" => return self.label_ends.push(line),
            _ => return,
        };
        // What is open inside without an end has none.
        while let Some((found, begin)) = open.pop() {
            if found != kind {
                continue;
            }
            self.partners.insert(begin, line);
            if word == "ELSE" {
                open.push((Open::If, line));
            } else {
                self.partners.insert(line, begin);
            }
            return;
        }
    }

    /// Where a subprogram, or a main program (`main`), begins after its header.
    pub(crate) fn program(&self, name: &str, main: bool) -> Option<usize> {
        let mut programs = self.programs.iter();
        let found = programs
            .find(|(line, found)| found == name && self.mains.binary_search(line).is_ok() == main);
        found.map(|(line, _)| line + 1)
    }

    /// The lines of the program that a line belongs to.
    fn borders(&self, line: usize, len: usize) -> (usize, usize) {
        let next = self.programs.partition_point(|(begin, _)| *begin <= line);
        let begin = next.checked_sub(1).and_then(|at| self.programs.get(at));
        (
            begin.map_or(0, |(line, _)| line + 1),
            self.programs.get(next).map_or(len, |(line, _)| *line),
        )
    }

    /// The first line of the program that `line` belongs to.
    pub(crate) fn start(&self, line: usize) -> usize {
        self.borders(line, usize::MAX).0
    }

    /// The next line of a label after `line`.
    pub(crate) fn forwards(&self, label: &str, line: usize, len: usize) -> Option<usize> {
        let (_, end) = self.borders(line, len);
        let lines = self.labels.get(label)?;
        let next = lines.partition_point(|found| *found <= line);
        lines.get(next).copied().filter(|found| *found < end)
    }

    /// The last line of a label before `line`, or that line itself.
    pub(crate) fn backwards(&self, label: &str, line: usize) -> Option<usize> {
        let (begin, _) = self.borders(line, usize::MAX);
        let lines = self.labels.get(label)?;
        let next = lines.partition_point(|found| *found <= line);
        let found = lines.get(next.checked_sub(1)?).copied();
        found.filter(|found| *found >= begin)
    }

    /// The first ENDLABEL from `from` to before `to`.
    pub(crate) fn label_end(&self, from: usize, to: usize) -> Option<usize> {
        let next = self.label_ends.partition_point(|line| *line < from);
        let found = self.label_ends.get(next).copied();
        found.filter(|line| *line < to)
    }

    pub(crate) fn partner(&self, line: usize) -> Option<usize> {
        self.partners.get(&line).copied()
    }

    pub(crate) fn counts(&self, line: usize) -> bool {
        self.counting.binary_search(&line).is_ok()
    }
}
