//! A line taken apart just so far that marks can be found in it, for whatever controller
//! it is.

/// Bytes of a line that are looked at.
const BYTES_MAX: usize = 1024;

/// A word of one letter.
#[derive(Debug, Clone, Copy)]
struct Word {
    letter: u8,
    /// Ten times its number; `None`: a variable or an expression.
    tenths: Option<i64>,
    /// An equals sign comes next.
    assigned: bool,
}

/// A line in capitals.
#[derive(Debug, Default)]
pub(super) struct Line {
    /// Without its block number, comments kept.
    raw: String,
    /// Without block number, comments and what stands in parentheses or quotes.
    code: String,
    /// What stands in comments.
    comment: String,
    words: Vec<Word>,
    /// Runs of two and more letters, with where they begin and end in `code`.
    names: Vec<(usize, usize)>,
}

impl Line {
    /// Takes another line.
    pub(super) fn set(&mut self, bytes: &[u8]) {
        let bytes = bytes.get(..BYTES_MAX.min(bytes.len())).unwrap_or_default();
        let text = String::from_utf8_lossy(bytes).to_ascii_uppercase();
        self.raw.clear();
        self.raw.push_str(without_number(text.trim()));
        self.split();
        self.take_apart();
    }

    /// Nothing stands in it.
    pub(super) fn is_empty(&self) -> bool {
        self.raw.is_empty()
    }

    /// More than comments and signs stands in it.
    pub(super) fn has_words(&self) -> bool {
        self.code.bytes().any(|byte| byte.is_ascii_alphanumeric())
    }

    /// The line with its comments.
    pub(super) fn raw(&self) -> &str {
        &self.raw
    }

    /// The line without comments and parentheses.
    pub(super) fn code(&self) -> &str {
        &self.code
    }

    /// Its comments.
    pub(super) fn comment(&self) -> &str {
        &self.comment
    }

    /// Whether it has this word; `tenths` is ten times the number.
    pub(super) fn has(&self, letter: u8, tenths: i64) -> bool {
        let mut words = self.words.iter();
        words.any(|word| word.letter == letter && word.tenths == Some(tenths))
    }

    /// Whether it has a word of this letter.
    pub(super) fn has_letter(&self, letter: u8) -> bool {
        self.words.iter().any(|word| word.letter == letter)
    }

    /// Whether it has any of these G codes, given ten times.
    pub(super) fn g(&self, any: &[i64]) -> bool {
        any.iter().any(|code| self.has(b'G', *code))
    }

    /// Whether it has any of these M codes.
    pub(super) fn m(&self, any: &[i64]) -> bool {
        any.iter().any(|code| self.has(b'M', *code * 10))
    }

    /// Whether it has one of these names of two and more letters.
    pub(super) fn named(&self, any: &[&str]) -> bool {
        self.names().any(|name| any.contains(&name))
    }

    /// Whether one of these names is followed by an equals sign, a digit or whatever
    /// `next` takes.
    pub(super) fn named_then(&self, any: &[&str], next: fn(u8) -> bool) -> bool {
        self.names.iter().any(|&(start, end)| {
            let name = self.code.get(start..end).unwrap_or_default();
            let follows = self.code.as_bytes().get(end).copied();
            any.contains(&name) && follows.is_some_and(next)
        })
    }

    /// Whether one of these letters is assigned to: with a number (`R1=5`) or without.
    pub(super) fn assigns(&self, letters: &[u8], numbered: bool) -> bool {
        self.words.iter().any(|word| {
            word.assigned && word.tenths.is_some() == numbered && letters.contains(&word.letter)
        })
    }

    /// The number of its only word, if that has this letter.
    pub(super) fn only(&self, letter: u8) -> bool {
        let alone = self.names.is_empty() && self.words.len() == 1;
        let word = self.words.first().filter(|_| alone);
        word.is_some_and(|word| word.letter == letter && word.tenths.is_some() && !word.assigned)
    }

    /// Whether a word of this letter has a number of at least `least`.
    pub(super) fn at_least(&self, letter: u8, least: i64) -> bool {
        let mut words = self.words.iter();
        words.any(|word| word.letter == letter && word.tenths.is_some_and(|it| it >= least * 10))
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let of = |&(start, end): &(usize, usize)| self.code.get(start..end).unwrap_or_default();
        self.names.iter().map(of)
    }

    /// Divides code from comments.
    fn split(&mut self) {
        self.code.clear();
        self.comment.clear();
        let (mut depth, mut quoted) = (0_u32, false);
        let mut rest = self.raw.chars();
        while let Some(char) = rest.next() {
            match char {
                '"' if depth == 0 => quoted = !quoted,
                _ if quoted => {}
                ';' if depth == 0 => {
                    self.comment.push_str(rest.as_str());
                    break;
                }
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ if depth > 0 => self.comment.push(char),
                _ => {
                    self.code.push(char);
                    continue;
                }
            }
            if depth == 0 && !quoted {
                self.code.push(' ');
            }
        }
        self.code.truncate(self.code.trim_end().len());
    }

    /// Finds words and names.
    fn take_apart(&mut self) {
        self.words.clear();
        self.names.clear();
        let bytes = self.code.as_bytes();
        let mut at = 0;
        while at < bytes.len() {
            let length = run(bytes, at, |byte| byte.is_ascii_uppercase() || byte == b'_');
            match length {
                0 => at += 1,
                1 => {
                    let letter = bytes.get(at).copied().unwrap_or_default();
                    let (tenths, end) = number(&self.code, at + 1);
                    let end = end + run(bytes, end, |byte| byte == b' ');
                    let next = bytes.get(end..).unwrap_or_default();
                    let assigned = next.starts_with(b"=") && !next.starts_with(b"==");
                    self.words.push(Word {
                        letter,
                        tenths,
                        assigned,
                    });
                    at = end.max(at + 1);
                }
                _ => {
                    self.names.push((at, at + length));
                    at += length;
                }
            }
        }
    }
}

/// How many bytes from `at` on are such.
fn run(bytes: &[u8], at: usize, such: impl Fn(u8) -> bool) -> usize {
    let rest = bytes.get(at..).unwrap_or_default();
    rest.iter().take_while(|byte| such(**byte)).count()
}

/// Ten times the number at `at`, rounded, and where it ends.
fn number(code: &str, at: usize) -> (Option<i64>, usize) {
    let at = at + run(code.as_bytes(), at, |byte| byte == b' ');
    let part = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+');
    let end = at + run(code.as_bytes(), at, part);
    let value: Option<f64> = code.get(at..end).and_then(|text| text.parse().ok());
    #[allow(clippy::cast_possible_truncation, reason = "the cast saturates")]
    let tenths = value.map(|value| (value * 10.0).round() as i64);
    (tenths, end)
}

/// A line without `/`, `N10` and blanks before it.
fn without_number(text: &str) -> &str {
    let text = text.trim_start_matches('/').trim_start();
    let Some(rest) = text.strip_prefix('N') else {
        return text;
    };
    let digits = run(rest.as_bytes(), 0, |byte| byte.is_ascii_digit());
    match rest.get(digits..) {
        Some(after) if digits > 0 => after.trim_start(),
        _ => text,
    }
}
