//! Commands as printers have them: `M203 X300.00 Y300.00 E120:100`.

use crate::text::Place;

/// A word: its letter and what stands after it.
pub(crate) struct Word<'t> {
    pub(crate) letter: char,
    pub(crate) text: &'t str,
    pub(crate) place: Place<'t>,
}

/// A command: its code such as `M203`, and its words.
pub(crate) struct Command<'t> {
    pub(crate) code: String,
    pub(crate) words: Vec<Word<'t>>,
    /// All of it.
    pub(crate) whole: &'t str,
    pub(crate) place: Place<'t>,
}

impl<'t> Command<'t> {
    /// The first word of a letter.
    pub(crate) fn word(&self, letter: char) -> Option<&Word<'t>> {
        self.words.iter().find(|word| word.letter == letter)
    }

    /// How a value of it is shown as a source.
    pub(crate) fn source(&self, word: &Word<'_>) -> String {
        let shown = format!("{} {}{}", self.code, word.letter, word.text);
        self.place.source(&shown)
    }
}

/// The commands of a line: what stands before the first one does not matter (`echo:  M203 …`,
/// times of a log), what stands after `;` is a comment.
pub(crate) fn commands<'t>(place: &Place<'t>) -> Vec<Command<'t>> {
    let line = place.line();
    let code = outside_quotes(line, ';').map_or(line, |end| line.get(..end).unwrap_or(line));
    let mut starts = starts(code);
    starts.push(code.len());
    let mut list = Vec::new();
    for pair in starts.windows(2) {
        let &[from, to] = pair else { continue };
        let whole = code.get(from..to).unwrap_or("").trim_end();
        let length = 1 + digits(whole.get(1..).unwrap_or(""));
        let Some((name, rest)) = whole.split_at_checked(length) else {
            continue;
        };
        let number = name.get(1..).unwrap_or("").trim_start_matches('0');
        let number = if number.is_empty() { "0" } else { number };
        list.push(Command {
            code: format!(
                "{}{number}",
                name.get(..1).unwrap_or("").to_ascii_uppercase()
            ),
            words: words(rest, place),
            whole,
            place: place.of(whole),
        });
    }
    list
}

/// Where commands begin: a letter G or M that no letter or digit precedes, with a number.
fn starts(code: &str) -> Vec<usize> {
    let bytes = code.as_bytes();
    let mut found = Vec::new();
    let mut quoted = false;
    let mut braces = 0_u32;
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            b'{' => braces += 1,
            b'}' => braces = braces.saturating_sub(1),
            b'G' | b'M' | b'g' | b'm' if !quoted && braces == 0 => {
                let free = at == 0
                    || bytes
                        .get(at - 1)
                        .is_none_or(|b| !b.is_ascii_alphanumeric() && *b != b'_');
                if free && bytes.get(at + 1).is_some_and(u8::is_ascii_digit) {
                    found.push(at);
                }
            }
            _ => {}
        }
    }
    found
}

fn digits(text: &str) -> usize {
    text.bytes()
        .take_while(|b| b.is_ascii_digit() || *b == b'.')
        .count()
}

/// Where a character stands outside quotes.
fn outside_quotes(text: &str, wanted: char) -> Option<usize> {
    let mut quoted = false;
    for (at, c) in text.char_indices() {
        if c == '"' {
            quoted = !quoted;
        } else if c == wanted && !quoted {
            return Some(at);
        }
    }
    None
}

/// Words: a letter, then everything up to a blank, an expression in braces as a whole.
fn words<'t>(rest: &'t str, place: &Place<'t>) -> Vec<Word<'t>> {
    let mut list = Vec::new();
    let mut from = 0;
    while let Some(tail) = rest.get(from..) {
        let skipped = tail.len() - tail.trim_start().len();
        let tail = tail.trim_start();
        let Some(letter) = tail.chars().next() else {
            break;
        };
        let body = tail.get(letter.len_utf8()..).unwrap_or("");
        let mut length = end_of_word(body);
        // `X 300`, as some write it.
        let blanks = body.len() - body.trim_start_matches([' ', '\t']).len();
        let next = body.trim_start_matches([' ', '\t']);
        if length == 0 && next.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.') {
            length = blanks + end_of_word(next);
        }
        let text = body.get(..length).unwrap_or("").trim();
        if letter.is_ascii_alphabetic() {
            list.push(Word {
                letter: letter.to_ascii_uppercase(),
                text,
                place: place.of(if text.is_empty() {
                    tail.get(..1).unwrap_or("")
                } else {
                    text
                }),
            });
        }
        from += skipped + letter.len_utf8() + length;
    }
    list
}

/// The length of a word's value: numbers may follow each other without a blank.
fn end_of_word(body: &str) -> usize {
    let mut braces = 0_u32;
    let mut quoted = false;
    let mut before = ' ';
    for (at, c) in body.char_indices() {
        let free = !quoted && braces == 0;
        match c {
            '"' => quoted = !quoted,
            '{' if !quoted => braces += 1,
            '}' if !quoted => braces = braces.saturating_sub(1),
            c if c.is_whitespace() && free => return at,
            // X100Y200
            c if c.is_ascii_alphabetic() && (before.is_ascii_digit() || before == '.') && free => {
                return at;
            }
            _ => {}
        }
        before = c;
    }
    body.len()
}

/// Whether a line holds a command.
pub(crate) fn is_command(line: &str) -> bool {
    let code = line.split(';').next().unwrap_or(line);
    !starts(code).is_empty()
}
