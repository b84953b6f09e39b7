//! How the landmarks of a SINUMERIK text are found.

use super::rest::Rest;
use super::{Landmarks, Survey};
use crate::flow::text::Text;

impl Landmarks {
    pub(in crate::flow) fn of_siemens(text: &Text) -> Self {
        let mut survey = Survey::default();
        for line in 0..text.len() {
            survey.siemens_line(line, text.line(line));
        }
        survey.marks
    }
}

impl Survey {
    fn siemens_line(&mut self, line: usize, text: &[u8]) {
        if let Some((name, main)) = program_name(text) {
            self.open.clear();
            self.program(line, name, main);
            return;
        }
        let mut rest = Rest(text);
        rest.skip(0);
        rest.byte_order_mark();
        rest.skip(0);
        rest.block_delete();
        if let Some(number) = rest.block_number(b"Nn:") {
            rest.block_delete();
            self.label(number, line);
        }
        if let Some(label) = label(&mut rest) {
            if label == "ENDLABEL" {
                self.marks.label_ends.push(line);
            }
            self.label(label, line);
        }
        self.siemens_structure(line, rest);
    }

    fn siemens_structure(&mut self, line: usize, mut rest: Rest<'_>) {
        let word = rest.name();
        match word.as_str() {
            "IF" if !jumps(&rest) => self.begin("IF", line),
            "WHILE" => self.begin("WHILE", line),
            "FOR" => self.begin("FOR", line),
            "LOOP" => self.begin("LOOP", line),
            // With a label it repeats a section.
            "REPEAT" if rest.name().is_empty() => self.begin("REPEAT", line),
            // It ends the IF, and is known only where it has an end itself.
            "ELSE" => {
                if self.end("IF", line) {
                    self.marks.parts.remove(&line);
                    self.begin("IF", line);
                }
            }
            "ENDLABEL" => self.marks.label_ends.push(line),
            "UNTIL" => _ = self.end("REPEAT", line),
            word => {
                let kind = word.strip_prefix("END");
                if let Some(kind @ ("IF" | "WHILE" | "FOR" | "LOOP")) = kind {
                    self.end(kind, line);
                }
            }
        }
    }
}

/// The name in `%_N_NAME_MPF`, upper case, and whether it is a main program.
fn program_name(line: &[u8]) -> Option<(String, bool)> {
    let line = line.trim_ascii().to_ascii_uppercase();
    let name =
        Rest(line.strip_prefix(b"%_N_")?).run(|byte| byte.is_ascii_alphanumeric() || *byte == b'_');
    let main = name.strip_suffix("_MPF");
    let stem = name.strip_suffix("_SPF").or(main).unwrap_or(&name);
    Some((stem.to_owned(), main.is_some()))
}

fn label(rest: &mut Rest<'_>) -> Option<String> {
    let before = rest.0;
    let name = rest.name();
    if !name.is_empty() && rest.0.first() == Some(&b':') {
        rest.skip(1);
        return Some(name);
    }
    rest.0 = before;
    None
}

/// Whether a GOTO follows, outside quotes and comments.
fn jumps(rest: &Rest<'_>) -> bool {
    let mut rest = Rest(rest.0);
    let mut quoted = false;
    while let Some(&byte) = rest.0.first() {
        if byte == b'"' {
            quoted = !quoted;
        } else if byte == b';' && !quoted {
            return false;
        } else if !quoted && (byte.is_ascii_alphabetic() || byte == b'_') {
            if rest.name().starts_with("GOTO") {
                return true;
            }
            continue;
        }
        rest.0 = rest.0.get(1..).unwrap_or_default();
    }
    false
}
