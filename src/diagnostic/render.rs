//! A diagnostic drawn for a terminal.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

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
        let title = level.clone().primary_title(message).id(self.rule);
        let report = if self.line == 0 {
            vec![title.element(Origin::path(file)).elements(help)]
        } else {
            let shown = Shown::new(self);
            let line = self.shown_line();
            let origin = Origin::path(file.clone()).line(line);
            let snippet = Snippet::source(shown.text)
                .line_start(line)
                .annotation(AnnotationKind::Primary.span(shown.marked));
            if shown.cut_before {
                // The renderer counts columns in what it is given, so the place
                // stands in a group of its own.
                let origin = origin.char_column(self.column as usize);
                let behind = Group::with_level(level).element(snippet).elements(help);
                vec![title.element(origin), behind]
            } else {
                vec![title.element(snippet.path(file)).elements(help)]
            }
        };
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.term_width(COLUMNS).render(&report)
    }

    /// The line number for the renderer, which counts on from it.
    fn shown_line(&self) -> usize {
        let line = usize::try_from(self.line).unwrap_or(usize::MAX);
        line.min(usize::MAX / 2)
    }
}

#[cfg(test)]
mod tests {
    use crate::source::Span;

    use super::*;

    #[test]
    fn show() {
        let e = Diagnostic::error("arc-radius", "the arc has no radius");
        println!("{}", e.clone().render("a.ngc", false));
        println!("{}", e.clone().help("help me").render("a.ngc", false));
        println!(
            "{}",
            e.clone()
                .at(7, Span::new(3, 5), b"G1 X1")
                .render("a.ngc", false)
        );
        println!(
            "{}",
            e.clone()
                .at(7, Span::new(3, 5), b"G1 X1")
                .help("see")
                .render("a.ngc", true)
        );
        println!(
            "{:?}",
            e.clone()
                .at(7, Span::new(3, 5), b"G1 X1")
                .help("see")
                .render("a.ngc", true)
        );
        println!(
            "{}",
            e.clone()
                .at(u64::MAX, Span::new(5, 5), b"G1 X1")
                .help("see")
                .render("a.ngc", false)
        );
        println!(
            "{}",
            e.clone()
                .at(1, Span::new(0, 0), b"")
                .help("see")
                .render("a.ngc", false)
        );
        println!(
            "{}",
            Diagnostic::warning("w", "a \x1b[31m b\n")
                .at(
                    1234,
                    Span::new(7, 9),
                    b"\tX1\xe9\0\x1bG1(\xc3\xa4\xe4\xc2\x9b)\r\n"
                )
                .help("see")
                .render("a\x07.ngc", false)
        );
        let long = [b"(".as_slice(), &[b'x'; 9000], b")G1X1"].concat();
        println!(
            "{}",
            e.clone()
                .at(7, Span::new(9002, 9004), &long)
                .render("a.ngc", false)
        );
        println!(
            "{}",
            e.clone()
                .at(7, Span::new(0, 9002), &long)
                .render("a.ngc", false)
        );
        println!(
            "{}",
            e.clone()
                .at(7, Span::new(5000, 5003), &long)
                .render("a.ngc", false)
        );
    }
}
