//! The text of a line as the firmwares read it: a command and its parameters.

use arrayvec::ArrayVec;

use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// M words after which stands free text or the name of a file.
///
/// Marlin: M117 and M118 (text), M16, M20, M23, M30, M33, M928 (names),
/// M0 and M1 (text on the display); `RepRapFirmware`: M36, M38, M39, M291.
/// M28 and M32, which write and run other files, are not known.
const TEXT: [u16; 14] = [
    0, 10, 160, 200, 230, 300, 330, 360, 380, 390, 1170, 1180, 2910, 9280,
];

/// What stands at the beginning of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Head<'t> {
    /// `G29`, `M117`, `T0`: letter, number × 10, and where it stands.
    Code(u8, u16, Span),
    /// `T?`, `T-1`, `Tx`: a tool by another name than its number.
    Tool(Span),
    /// `BED_MESH_CALIBRATE`, `if`.
    Name(&'t [u8], Span),
    /// `M9833`, `M620.11`: a word whose number no code of gwatt's own has.
    Odd(&'t [u8], Span),
    /// Anything else.
    Other,
}

/// A line without its number, its comment and its checksum.
#[derive(Debug, Clone, Copy)]
pub(super) struct Text<'t> {
    line: &'t [u8],
    /// Where the command begins.
    start: usize,
    /// Where the text ends.
    end: usize,
    /// The checksum, if there is one.
    pub(super) checksum: Option<Word>,
}

/// A letter with its value, if it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parameter {
    pub(super) letter: u8,
    pub(super) value: Option<f64>,
    pub(super) span: Span,
    pub(super) number: Span,
}

/// The parameters of a command.
pub(super) type Parameters = ArrayVec<Parameter, 32>;

/// A value that should be a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotANumber;

/// The value of a letter's parameter.
pub(super) fn value(parameters: &Parameters, letter: u8) -> Option<f64> {
    let mut all = parameters.iter();
    all.find(|parameter| parameter.letter == letter)?.value
}

/// Whether a letter is among the parameters.
pub(super) fn has(parameters: &Parameters, letter: u8) -> bool {
    parameters
        .iter()
        .any(|parameter| parameter.letter == letter)
}

impl<'t> Text<'t> {
    /// The command of a line; `end` is where the line end stands.
    pub(super) fn new(line: &'t [u8], end: usize) -> Self {
        let mut text = Self {
            line,
            start: 0,
            end,
            checksum: None,
        };
        text.start = text.blanks(0);
        let numbered = matches!(text.byte(text.start), Some(b'N' | b'n'))
            && text
                .byte(text.start + 1)
                .is_some_and(|byte| byte.is_ascii_digit());
        text.end = text.comment();
        if numbered {
            text.start = text.blanks(text.number(text.start + 1));
            text.take_checksum();
        }
        while text.end > text.start && matches!(text.byte(text.end - 1), Some(b' ' | b'\t')) {
            text.end -= 1;
        }
        text
    }

    fn byte(&self, at: usize) -> Option<u8> {
        self.line.get(at).copied().filter(|_| at < self.end)
    }

    fn blanks(&self, mut at: usize) -> usize {
        while matches!(self.byte(at), Some(b' ' | b'\t')) {
            at += 1;
        }
        at
    }

    /// Where the `;` of a comment stands: not the one in a text in quotes.
    fn comment(&self) -> usize {
        let mut quoted = false;
        let mut first = None;
        for at in self.start..self.end {
            match self.byte(at) {
                Some(b'"') => quoted = !quoted,
                Some(b';') if !quoted => return at,
                Some(b';') => first = first.or(Some(at)),
                _ => {}
            }
        }
        // A quote without its end quotes nothing.
        first.filter(|_| quoted).unwrap_or(self.end)
    }

    /// Takes `*97` off the end.
    fn take_checksum(&mut self) {
        let text = self.line.get(..self.end).unwrap_or_default();
        let Some(star) = text.iter().rposition(|byte| *byte == b'*') else {
            return;
        };
        let digits = text.get(star + 1..).unwrap_or_default().trim_ascii();
        let number = std::str::from_utf8(digits)
            .ok()
            .and_then(|digits| digits.parse::<u32>().ok());
        if let Some(number) = number {
            self.checksum = Some(Word {
                letter: b'*',
                value: f64::from(number),
                span: Span::new(star, self.end),
                number: Span::new(star + 1, self.end),
            });
            self.end = star;
        }
    }

    /// The end of digits with at most one point from `at` on.
    fn number(&self, mut at: usize) -> usize {
        let mut points = 0;
        while let Some(byte) = self.byte(at) {
            points += usize::from(byte == b'.');
            if !(byte.is_ascii_digit() || byte == b'.' && points == 1) {
                break;
            }
            at += 1;
        }
        at
    }

    /// The value of the digits from `start` to `end`.
    fn read(&self, start: usize, end: usize) -> Option<f64> {
        let mut text = ArrayVec::<u8, 40>::new();
        for byte in self.line.get(start..end)? {
            if !matches!(byte, b' ' | b'\t') {
                text.try_push(*byte).ok()?;
            }
        }
        let value: f64 = std::str::from_utf8(&text).ok()?.parse().ok()?;
        value.is_finite().then_some(value)
    }

    /// The command, and where its parameters begin.
    pub(super) fn head(&self) -> (Head<'t>, usize) {
        let start = self.start;
        let Some(letter) = self.byte(start).map(|byte| byte.to_ascii_uppercase()) else {
            return (Head::Other, start);
        };
        if matches!(letter, b'G' | b'M' | b'T') {
            let digits = self.blanks(start + 1);
            let end = self.number(digits);
            let span = Span::new(start, end);
            let begins = self.byte(digits).is_some_and(|byte| byte.is_ascii_digit());
            let number = self.read(digits, end).filter(|_| begins);
            if let Some(number) = number {
                let name = self.line.get(start..end).unwrap_or_default();
                let odd = Head::Odd(name, span);
                let code = super::super::g_codes::code_number(number);
                let head = code.map_or(odd, |number| Head::Code(letter, number, span));
                return (head, end);
            }
        }
        let mut end = start;
        while self
            .byte(end)
            .is_some_and(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
        {
            end += 1;
        }
        let span = Span::new(start, end);
        if letter == b'T' && end <= start + 2 {
            let end = self.end;
            return (Head::Tool(Span::new(start, end)), end);
        }
        let named = letter.is_ascii_alphabetic() && end > start + 1 || letter == b'_';
        let second = self.byte(start + 1);
        // `P0` of Prusa's tool changers is a command too.
        let parks = letter == b'P' && second.is_some_and(|byte| byte.is_ascii_digit());
        let begins_name = second.is_some_and(|byte| byte.is_ascii_alphabetic() || byte == b'_');
        if named && (begins_name || parks) {
            let name = self.line.get(start..end).unwrap_or_default();
            return (Head::Name(name, span), end);
        }
        (Head::Other, start)
    }

    /// Whether free text stands after a word.
    pub(super) fn is_text(letter: u8, number: u16) -> bool {
        letter == b'M' && TEXT.contains(&number)
    }

    /// What stands from `at` on.
    pub(super) fn rest(&self, at: usize) -> &'t [u8] {
        self.line.get(at..self.end).unwrap_or_default()
    }

    /// The same line from its next command on.
    pub(super) fn from(self, start: usize) -> Self {
        Self { start, ..self }
    }

    /// `XY` for X and Y, as firmware reads it that looks for each letter (Marlin's parser:
    /// "Another parameter right away?"; `RepRapFirmware`'s `Seen`).
    pub(super) fn axis_flags(&self, at: usize) -> Option<Parameters> {
        let mut list = Parameters::new();
        for place in at..self.end {
            match self.byte(place)?.to_ascii_uppercase() {
                b' ' | b'\t' => {}
                letter @ (b'X' | b'Y' | b'Z') if !list.is_full() => list.push(Parameter {
                    letter,
                    value: None,
                    span: Span::new(place, place + 1),
                    number: Span::new(place + 1, place + 1),
                }),
                _ => return None,
            }
        }
        Some(list)
    }

    /// Reads parameters from `at` to the next G or M word, whose place is
    /// given too; an error is where something else stands.
    pub(super) fn parameters(&self, mut at: usize) -> Result<(Parameters, Option<usize>), Span> {
        let mut list = Parameters::new();
        loop {
            at = self.blanks(at);
            let Some(byte) = self.byte(at) else {
                return Ok((list, None));
            };
            let start = at;
            let letter = byte.to_ascii_uppercase();
            if letter == b'(' {
                at = self.after_next(at, b')');
                // Firmware that knows no comment of this form takes its words.
                if holds_word(self.line.get(start..at).unwrap_or_default()) {
                    return Err(Span::new(start, at));
                }
                continue;
            }
            if !letter.is_ascii_alphabetic() || list.is_full() {
                return Err(Span::new(start, self.end));
            }
            let number = self.blanks(at + 1);
            let sign = usize::from(matches!(self.byte(number), Some(b'+' | b'-')));
            let digits = self.blanks(number + sign);
            let end = self.number(digits);
            if end > digits && matches!(letter, b'G' | b'M') && sign == 0 {
                return Ok((list, Some(start)));
            }
            let mut value = self.read(number, end);
            if value.is_none() && end > digits + 1 {
                return Err(Span::new(start, self.end));
            }
            at = match self.byte(number) {
                _ if value.is_some() => self.behind_list(end, &mut value),
                Some(b'"') => self.after_next(number, b'"'),
                _ => start + 1,
            };
            // A letter right after a letter is a word of text, not a flag.
            let joined = self
                .byte(start + 1)
                .is_some_and(|byte| byte.is_ascii_alphabetic());
            if value.is_none() && joined {
                return Err(Span::new(start, self.end));
            }
            list.push(Parameter {
                letter,
                value,
                span: Span::new(start, end.max(start + 1)),
                number: Span::new(number.min(end.max(start + 1)), end.max(start + 1)),
            });
        }
    }

    /// After further values of a list, as in `E300:300` (`RepRapFirmware`), of
    /// which the largest counts.
    fn behind_list(&self, mut at: usize, largest: &mut Option<f64>) -> usize {
        while self.byte(at) == Some(b':') {
            let sign = usize::from(matches!(self.byte(at + 1), Some(b'+' | b'-')));
            let end = self.number(at + 1 + sign);
            let value = self.read(at + 1, end);
            if let (Some(own), Some(value)) = (largest.as_mut(), value) {
                *own = own.max(value);
            }
            at = end;
        }
        at
    }

    /// After the next `close` after `at`, or the end.
    fn after_next(&self, at: usize, close: u8) -> usize {
        let mut end = at + 1;
        while self.byte(end).is_some_and(|byte| byte != close) {
            end += 1;
        }
        (end + 1).min(self.end)
    }

    /// The value of `KEY=value` after an extended command.
    ///
    /// Source: Klipper, "G-Codes": `COMMAND PARAMETER=value`.
    pub(super) fn argument(&self, at: usize, key: &str) -> Option<&'t [u8]> {
        let mut parts = self.rest(at).split(u8::is_ascii_whitespace);
        parts.find_map(|part| {
            let equals = part.iter().position(|byte| *byte == b'=')?;
            let (name, value) = part.split_at_checked(equals)?;
            name.eq_ignore_ascii_case(key.as_bytes())
                .then(|| value.get(1..).unwrap_or_default())
        })
    }

    /// The same as a number.
    pub(super) fn number_argument(&self, at: usize, key: &str) -> Result<Option<f64>, NotANumber> {
        let Some(text) = self.argument(at, key) else {
            return Ok(None);
        };
        let number = std::str::from_utf8(text)
            .ok()
            .and_then(|text| text.parse::<f64>().ok())
            .filter(|number| number.is_finite());
        number.map(Some).ok_or(NotANumber)
    }
}

/// Whether a letter with a number stands in a text.
pub(super) fn holds_word(text: &[u8]) -> bool {
    text.windows(2).any(|pair| match pair {
        [letter, number] => {
            letter.is_ascii_alphabetic()
                && (number.is_ascii_digit() || matches!(number, b'+' | b'-' | b'.'))
        }
        _ => false,
    })
}
