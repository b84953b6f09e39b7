//! A diagnostic drawn for a terminal.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use super::printable::excerpt;
use super::shown::Shown;
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
        let file = self.file.as_deref().unwrap_or(file);
        let file = excerpt(file.as_bytes(), usize::MAX);
        let message = excerpt(self.message.as_bytes(), usize::MAX);
        let help = self.help.as_deref();
        let help = help.map(|help| Level::HELP.message(excerpt(help.as_bytes(), usize::MAX)));
        let title = level.clone().primary_title(message).id(self.rule);
        let report = if self.line == 0 {
            vec![title.element(Origin::path(file)).elements(help)]
        } else if self.text.is_empty() {
            // The line is known, its text is not.
            let origin = Origin::path(file).line(self.shown_line());
            vec![title.element(origin).elements(help)]
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
                let body = Group::with_level(level).element(snippet).elements(help);
                vec![title.element(origin), body]
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
    use insta::assert_snapshot;

    use super::*;
    use crate::source::Span;

    fn long_line() -> Vec<u8> {
        [b"(".as_slice(), &[b'x'; 9000], b")G1X1\r\n"].concat()
    }

    #[test]
    fn the_whole_file() {
        let found =
            Diagnostic::error("machine", "the machine has no axis").help("add a table [axes.X]");
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[machine]: the machine has no axis
        --> part.ngc
         = help: add a table [axes.X]
        "##);
    }

    #[test]
    fn severities() {
        let found = Diagnostic::note("tool-length", "the tool length is taken as 0").at(
            3,
            Span::new(0, 3),
            b"T1 M6",
        );
        assert_snapshot!(found.render("part.ngc", false), @r##"
        note[tool-length]: the tool length is taken as 0
         --> part.ngc:3:1
          |
        3 | T1 M6
          | ^^^
        "##);
    }

    #[test]
    fn the_end_of_a_line() {
        let found = Diagnostic::warning("feed", "no feed rate is given")
            .at(1234, Span::new(5, 5), b"G1 X1\n")
            .help("write F");
        assert_snapshot!(found.render("part.ngc", false), @r##"
        warning[feed]: no feed rate is given
            --> part.ngc:1234:6
             |
        1234 | G1 X1
             |      ^
             |
             = help: write F
        "##);
    }

    #[test]
    fn a_line_whose_text_is_not_known() {
        let mut found = Diagnostic::error("overload", "1.00 s of 0.20 s").help("wait");
        found.line = 7;
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[overload]: 1.00 s of 0.20 s
        --> part.ngc:7
         = help: wait
        "##);
    }

    #[test]
    fn bytes_that_are_no_text() {
        let found = Diagnostic::error("axis", "no such axis").at(
            8,
            Span::new(7, 9),
            b"\tX1\xE9\0\x1BU9 (\xC3\xA4\xE4\xC2\x9B)\r\n",
        );
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[axis]: no such axis
         --> part.ngc:8:8
          |
        8 |  X1���U9 (ä��)
          |        ^^
        "##);
    }

    #[test]
    fn control_characters_in_messages() {
        let found = Diagnostic::error("name", "no file \x1B[31m\u{9b}2J\u{202e}\n");
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[name]: no file �[31m�2J��
        --> part.ngc
        "##);
    }

    #[test]
    fn a_long_line() {
        let found =
            Diagnostic::error("axis", "no such axis").at(7, Span::new(9002, 9004), &long_line());
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[axis]: no such axis
         --> part.ngc:7:9003
          |
          |
        7 | …xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx)G1X1
          |                                                                                                                      ^^
        "##);
    }

    #[test]
    fn a_long_span() {
        let found =
            Diagnostic::error("axis", "no such axis").at(7, Span::new(0, 9002), &long_line());
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[axis]: no such axis
         --> part.ngc:7:1
          |
        7 | (xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
        "##);
    }

    #[test]
    fn the_middle_of_a_long_line() {
        let found =
            Diagnostic::error("axis", "no such axis").at(7, Span::new(5000, 5003), &long_line());
        assert_snapshot!(found.render("part.ngc", false), @r##"
        error[axis]: no such axis
         --> part.ngc:7:5001
          |
          |
        7 | …xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…
          |                                          ^^^
        "##);
    }

    #[test]
    fn colour_is_put_in_only_where_asked_for() {
        let found = Diagnostic::error("axis", "\x1B[32mno").at(1, Span::new(0, 2), b"U1\x1B[32m");
        assert!(!found.render("a\x1B[32m", false).contains('\x1B'));
        let coloured = found.render("a\x1B[32m", true);
        assert!(coloured.contains("\x1B[") && !coloured.contains("\x1B[32m"));
    }

    #[test]
    fn any_place_can_be_shown() {
        for line in [0, 1, u64::MAX] {
            for (start, end) in [(0, 0), (5, 2), (0, u32::MAX), (u32::MAX, 0)] {
                let found =
                    Diagnostic::error("axis", "no").at(line, Span { start, end }, b"\xFFG1");
                assert!(found.render("part.ngc", true).contains("no"));
            }
        }
    }
}
