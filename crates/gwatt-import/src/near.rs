//! What an importer works on: files as one text, with those that they include in place.

use std::ops::Range;

use gwatt_syntax::diagnostic::Diagnostic;

use crate::text::{File, Log, Place, Text};

/// Files next to those that are imported: includes, HAL files.
pub trait Near {
    /// The files that `pattern` stands for, which a line of the file `from` names; `*` and
    /// `?` may stand in its last part. None where there are none.
    fn files(&self, from: &str, pattern: &str) -> Vec<File>;
}

/// No file is next to it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nothing;

impl Near for Nothing {
    fn files(&self, _: &str, _: &str) -> Vec<File> {
        Vec::new()
    }
}

/// Files that are imported as one.
pub(crate) struct Job {
    texts: Vec<Text>,
    /// Lines in the order in which the control reads them.
    order: Vec<(usize, Range<usize>)>,
}

/// Deeper, or more, is a circle.
const DEPTH: usize = 8;
const FILES: usize = 200;

impl Job {
    /// The files, with what they include; `include` is the pattern that a line names.
    ///
    /// # Errors
    /// A file that is no text.
    pub(crate) fn new(
        files: &[File],
        near: &dyn Near,
        include: fn(&str) -> Option<&str>,
        log: &mut Log,
    ) -> Result<Self, Box<Diagnostic>> {
        let mut job = Self {
            texts: Vec::new(),
            order: Vec::new(),
        };
        for file in files {
            job.add(file, near, include, log, 0)?;
        }
        Ok(job)
    }

    fn add(
        &mut self,
        file: &File,
        near: &dyn Near,
        include: fn(&str) -> Option<&str>,
        log: &mut Log,
        depth: usize,
    ) -> Result<(), Box<Diagnostic>> {
        let text = Text::new(file)?;
        let index = self.texts.len();
        let includes: Vec<(usize, String)> = text
            .lines
            .iter()
            .enumerate()
            .filter_map(|(line, text)| Some((line, include(text)?.to_owned())))
            .collect();
        let lines = text.lines.len();
        self.texts.push(text);
        let mut from = 0;
        for (line, pattern) in includes {
            self.order.push((index, from..line + 1));
            from = line + 1;
            let found = near.files(&file.name, &pattern);
            let whole = self.texts[index].place(line);
            if found.is_empty() && !pattern.contains(['*', '?']) {
                let message = format!("`{pattern}` was not found: nothing of it counts");
                let help = "put it where the line says, or give it as another FILE";
                log.warning(&whole.of(whole.line().trim()), message, help);
            }
            if depth >= DEPTH || self.texts.len() + found.len() > FILES {
                let message = format!("`{pattern}`: too many files include each other");
                log.error(&whole.of(whole.line().trim()), message, "look for a circle");
                continue;
            }
            for file in &found {
                self.add(file, near, include, log, depth + 1)?;
            }
        }
        self.order.push((index, from..lines));
        Ok(())
    }

    /// All lines in order; each with the number of its piece, since sections end with it.
    pub(crate) fn places(&self) -> impl Iterator<Item = (usize, Place<'_>)> {
        let pieces = self.order.iter().enumerate();
        pieces.flat_map(move |(piece, (text, lines))| {
            lines
                .clone()
                .filter_map(move |line| Some((piece, self.texts.get(*text)?.place(line))))
        })
    }

    /// The name of the first file.
    pub(crate) fn name(&self) -> &str {
        self.texts.first().map_or("", |text| &text.name)
    }

    /// Names of all files.
    pub(crate) fn names(&self) -> Vec<String> {
        self.texts.iter().map(|text| text.name.clone()).collect()
    }
}
