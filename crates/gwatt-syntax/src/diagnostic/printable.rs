//! Bytes of a program as characters that can be printed.
//!
//! A program may hold any bytes: Latin-1 comments, tabs, NULs, sequences that
//! steer a terminal. Each character, and each byte that is none, becomes one
//! character that can be printed, so that columns and carets stay right.

/// The characters of `bytes` that can be printed, each with the number of bytes
/// it stands for.
pub(super) fn decode(bytes: &[u8]) -> impl Iterator<Item = (char, usize)> {
    bytes.utf8_chunks().flat_map(|chunk| {
        let valid = chunk.valid().chars();
        let invalid = chunk.invalid().iter();
        valid
            .map(|c| (printable(c), c.len_utf8()))
            .chain(invalid.map(|_| (char::REPLACEMENT_CHARACTER, 1)))
    })
}

/// `c`, or what is shown in its place: nothing may move the cursor, colour the
/// screen or turn the direction of the text.
fn printable(c: char) -> char {
    match c {
        '\t' => ' ',
        '\u{200B}'..='\u{200F}'
        | '\u{2028}'..='\u{202E}'
        | '\u{2060}'..='\u{206F}'
        | '\u{FEFF}' => char::REPLACEMENT_CHARACTER,
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

/// The first `max_chars` characters of `bytes` as printable text, with `…`
/// after them if there are more.
#[must_use]
pub fn excerpt(bytes: &[u8], max_chars: usize) -> String {
    let mut chars = decode(bytes).map(|(c, _)| c);
    let mut text: String = chars.by_ref().take(max_chars).collect();
    if chars.next().is_some() {
        text.push('…');
    }
    text
}
