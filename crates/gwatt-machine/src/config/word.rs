//! Program words as they are written in files: a letter and a number.

/// Letter (upper case) and number of a word such as `M8` or `g61.1`; `None`
/// if it is not one.
pub(crate) fn parse(text: &str) -> Option<(u8, f64)> {
    let (&letter, digits) = text.trim().as_bytes().split_first()?;
    let plain = !digits.is_empty()
        && digits.len() <= 9
        && digits[0].is_ascii_digit()
        && digits.iter().all(|&b| b.is_ascii_digit() || b == b'.');
    let number = std::str::from_utf8(digits).ok()?.parse().ok()?;
    (letter.is_ascii_alphabetic() && plain).then(|| (letter.to_ascii_uppercase(), number))
}

/// Letter and ten times the number: G61.1 is 611; `None` if it is no such
/// word or has more than one decimal.
pub(crate) fn code(text: &str) -> Option<(u8, u16)> {
    let (letter, number) = parse(text)?;
    let tenfold = number * 10.0;
    let exact = (tenfold - tenfold.round()).abs() < 1e-6;
    // As text: a cast would hide a number that is too large.
    let code = format!("{tenfold:.0}").parse().ok()?;
    exact.then_some((letter, code))
}

/// A single letter, in upper case.
pub(crate) fn letter(text: &str) -> Option<u8> {
    match text.as_bytes() {
        [letter] if letter.is_ascii_alphabetic() => Some(letter.to_ascii_uppercase()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_words() {
        assert_eq!(parse("M8"), Some((b'M', 8.0)));
        assert_eq!(parse("m08"), Some((b'M', 8.0)));
        assert_eq!(code("G61.1"), Some((b'G', 611)));
        assert_eq!(letter("p"), Some(b'P'));
    }

    #[test]
    fn refuses_what_is_no_word() {
        for text in [
            "", "M", "8", "M-8", "M8 M9", "M8x", "M1e3", "Mnan", "Ü8", "M1.2.3", "M.",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert_eq!(code("G61.15"), None);
        assert_eq!(code("G99999"), None);
        assert_eq!(letter("PP"), None);
    }
}
