//! Files of other kinds, known by how they begin.

/// Bytes from the beginning of a file that are looked at.
pub const FOREIGN_BYTES: usize = 4096;

/// What a file is, and what to do with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Foreign {
    /// As in "this is …".
    pub what: &'static str,
    /// What helps.
    pub help: &'static str,
}

/// How files begin that are no programs of words.
const BEGINNINGS: [(&[u8], &str, &str); 10] = [
    (
        b"GCDE",
        "binary G-code",
        "export it as plain G-code: slicers have a switch for that",
    ),
    (
        b"PK\x03\x04",
        "a packed file, such as a project (3MF, FCStd, F3Z)",
        "give the G-code that it produces",
    ),
    (b"\x1f\x8b", "a packed file (gzip)", "unpack it first"),
    (b"7z\xbc\xaf", "a packed file (7z)", "unpack it first"),
    (
        b"\xff\xfe",
        "text in UTF-16",
        "save the program as plain text (ASCII or UTF-8)",
    ),
    (
        b"\xfe\xff",
        "text in UTF-16",
        "save the program as plain text (ASCII or UTF-8)",
    ),
    (b"%PDF", "a PDF document", "give a part program"),
    (b"<", "an XML or HTML file", "give a part program"),
    (
        b"ISO-10303-21",
        "a STEP model",
        "give the program that a CAM system makes of it",
    ),
    (
        b"solid ",
        "an STL model",
        "give the program that a slicer or CAM system makes of it",
    ),
];

/// What the file is that begins with `bytes`, if it plainly is no program of
/// words.
#[must_use]
pub fn foreign(bytes: &[u8]) -> Option<Foreign> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let begins = BEGINNINGS
        .iter()
        .find(|(beginning, ..)| bytes.starts_with(beginning));
    if let Some((_, what, help)) = begins {
        return Some(Foreign { what, help });
    }
    let mut lines = bytes
        .split(|byte| matches!(byte, b'\n' | b'\r'))
        .map(<[u8]>::trim_ascii)
        .filter(|line| !line.is_empty());
    if lines.clone().take(20).any(begins_conversational) {
        return Some(Foreign {
            what: "a Heidenhain conversational program (Klartext)",
            help: "only programs of G-code words are read: have it posted as DIN/ISO",
        });
    }
    if lines.next() == Some(b"0") && lines.next() == Some(b"SECTION") {
        return Some(Foreign {
            what: "a DXF drawing",
            help: "give the program that a CAM system makes of it",
        });
    }
    None
}

/// `0 BEGIN PGM NAME MM`.
fn begins_conversational(line: &[u8]) -> bool {
    let digits = line.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let rest = line.get(digits..).unwrap_or_default().trim_ascii_start();
    rest.get(..10)
        .is_some_and(|front| front.eq_ignore_ascii_case(b"BEGIN PGM "))
}

#[cfg(test)]
mod tests {
    use super::foreign;

    #[test]
    fn files_of_other_kinds_are_named() {
        let what = |bytes: &[u8]| foreign(bytes).map(|foreign| foreign.what);
        let klartext = Some("a Heidenhain conversational program (Klartext)");
        assert_eq!(what(b"0  BEGIN PGM 123 MM\r\n1 L X+1\r\n"), klartext);
        assert_eq!(what(b"\n; part\nBEGIN PGM A INCH"), klartext);
        assert_eq!(what(b"GCDE\x01"), Some("binary G-code"));
        assert_eq!(what(b"  0\r\nSECTION\r\n"), Some("a DXF drawing"));
        assert_eq!(what(b"<?xml"), Some("an XML or HTML file"));
        for program in [&b"%\nO1\nG0 X0\n"[..], b"(BEGIN PGM)\nG1", b"0\nG1", b""] {
            assert_eq!(what(program), None);
        }
    }
}
