//! A diagnostic drawn for a terminal.

use annotate_snippets::{AnnotationKind, Element, Level, Origin, Renderer, Snippet};

use super::shown::{Shown, excerpt};
use super::{Diagnostic, Severity};

/// The renderer shall not cut lines: they are short enough already.
const COLUMNS: usize = 1000;

impl Diagnostic {
    /// The finding as text for a terminal, without a line end at its end.
    ///
    /// `file` is the name to show. With `colour` it holds ANSI sequences;
    /// control characters of the program or of the name never come through.
    #[must_use]
    pub fn render(&self, file: &str, colour: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let file = excerpt(file.as_bytes(), usize::MAX);
        let message = excerpt(self.message.as_bytes(), usize::MAX);
        let help = self.help.as_deref();
        let help = help.map(|help| Level::HELP.message(excerpt(help.as_bytes(), usize::MAX)));
        let report = level
            .primary_title(message)
            .id(self.rule)
            .elements(self.place(file))
            .elements(help);
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.term_width(COLUMNS).render(&[report])
    }

    /// Name of the file, line and column, and the line with carets under it.
    fn place(&self, file: String) -> Vec<Element<'static>> {
        let origin = Origin::path(file);
        if self.line == 0 {
            return vec![origin.into()];
        }
        // Halved at the top: the renderer counts on from the number.
        let line = usize::try_from(self.line)
            .unwrap_or(usize::MAX)
            .min(usize::MAX / 2);
        let shown = Shown::new(self);
        let snippet = Snippet::source(shown.text)
            .line_start(line)
            .annotation(AnnotationKind::Primary.span(shown.marked));
        vec![
            origin.line(line).char_column(self.column as usize).into(),
            snippet.into(),
        ]
    }
}
