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

const MODEL: &str = "give the program that a CAM system makes of it";
const UNPACK: &str = "unpack it first";
const PROGRAM: &str = "give a part program";

/// How files begin that are no programs of words.
const BEGINNINGS: [(&[u8], &str, &str); 28] = [
    (
        b"%@MACRO",
        "a macro of a Syntec control, whose numbers and variables are not those of ISO programs",
        "give the moves that it makes as an ISO program",
    ),
    (
        b"GCDE",
        "binary G-code",
        "export it as plain G-code: slicers have a switch for that",
    ),
    (
        b"PK\x03\x04",
        "a packed file, such as a project (3MF, FCStd, F3D, F3Z)",
        "give the G-code that it produces",
    ),
    (b"PK\x05\x06", "an empty packed file (zip)", PROGRAM),
    (b"\x1f\x8b", "a packed file (gzip)", UNPACK),
    (b"7z\xbc\xaf", "a packed file (7z)", UNPACK),
    (b"BZh", "a packed file (bzip2)", UNPACK),
    (b"\xfd7zXZ", "a packed file (xz)", UNPACK),
    (b"\x28\xb5\x2f\xfd", "a packed file (zstd)", UNPACK),
    (b"Rar!", "a packed file (RAR)", UNPACK),
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
    (b"%PDF", "a PDF document", PROGRAM),
    (b"<svg", "an SVG drawing", MODEL),
    (b"<", "an XML or HTML file", PROGRAM),
    (b"{\"", "a JSON file", PROGRAM),
    (
        b"{\\rtf",
        "a document (RTF)",
        "save the program as plain text",
    ),
    (
        b"\xd0\xcf\x11\xe0",
        "a document or project of an office or CAD program",
        MODEL,
    ),
    (b"ISO-10303-21", "a STEP model", MODEL),
    (b"AutoCAD Binary DXF", "a DXF drawing", MODEL),
    (b"AC10", "a DWG drawing", MODEL),
    (b"3D Geometry File Format", "a Rhino model", MODEL),
    (b"SQLite format 3", "a database", PROGRAM),
    (
        b"solid ",
        "an STL model",
        "give the program that a slicer or CAM system makes of it",
    ),
    (b"\x89PNG", "a picture (PNG)", PROGRAM),
    (b"\xff\xd8\xff", "a picture (JPEG)", PROGRAM),
    (b"MZ\x90", "a program for Windows", PROGRAM),
    (b"\x7fELF", "a program for Linux", PROGRAM),
];

/// What the file is that begins with `bytes`, if it plainly is no program of
/// words.
#[must_use]
pub fn foreign(bytes: &[u8]) -> Option<Foreign> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if is_svg(bytes) {
        return Some(Foreign {
            what: "an SVG drawing",
            help: MODEL,
        });
    }
    let begins = BEGINNINGS
        .iter()
        .find(|(beginning, ..)| bytes.starts_with(beginning));
    if let Some((_, what, help)) = begins {
        return Some(Foreign { what, help });
    }
    if is_binary_stl(bytes) {
        return Some(Foreign {
            what: "an STL model",
            help: "give the program that a slicer or CAM system makes of it",
        });
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
    if let Some(settings) = settings(&lines) {
        return Some(settings);
    }
    // IGES: the 73rd column of its first line names the section S.
    let first = lines.clone().next().unwrap_or_default();
    if first.len() >= 73 && first.get(72) == Some(&b'S') && first.ends_with(b"1") {
        return Some(Foreign {
            what: "an IGES model",
            help: MODEL,
        });
    }
    // A comment of a DXF drawing has the code 999.
    while lines.clone().next() == Some(b"999") {
        lines.nth(1);
    }
    if lines.next() == Some(b"0") && lines.next() == Some(b"SECTION") {
        return Some(Foreign {
            what: "a DXF drawing",
            help: MODEL,
        });
    }
    None
}

/// Files that go with a machine and are given in place of its programs.
fn settings<'a>(lines: &(impl Iterator<Item = &'a [u8]> + Clone)) -> Option<Foreign> {
    let has = |wanted: fn(&[u8]) -> bool| lines.clone().any(wanted);
    if has(|line| line.starts_with(b"schema =")) && has(|line| line.starts_with(b"[converter]")) {
        return Some(Foreign {
            what: "a machine file",
            help: "it goes after -m; give a part program here",
        });
    }
    let of_control = |line: &[u8]| matches!(line, b"[printer]" | b"[EMC]" | b"[TRAJ]");
    has(of_control).then_some(Foreign {
        what: "a file of settings (Klipper, LinuxCNC)",
        help: "`gwatt machine import` makes a machine file of it; give a part program here",
    })
}

/// `<svg`, with or without a declaration of XML before it.
fn is_svg(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().starts_with(b"<") && memchr::memmem::find(bytes, b"<svg").is_some()
}

/// 80 bytes of header, then the number of triangles and 50 bytes for each, with
/// zeros among them.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).unwrap_or_default();
    let body = bytes.get(84..).unwrap_or_default();
    let some = count.iter().any(|byte| *byte != 0) && body.iter().any(|byte| *byte != 0);
    some && count.last() == Some(&0) && body.contains(&0)
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
        let svg = b"<?xml version=\"1.0\"?>\n<!-- part -->\n<svg width=\"1\">";
        assert_eq!(what(svg), Some("an SVG drawing"));
        assert_eq!(
            what(b"PK\x03\x04\x14"),
            Some("a packed file, such as a project (3MF, FCStd, F3D, F3Z)")
        );
        assert_eq!(what(b"%PDF-1.7"), Some("a PDF document"));
        assert_eq!(what(b"ISO-10303-21;\nHEADER;"), Some("a STEP model"));
        assert_eq!(
            what(b"999\nmade by hand\n0\nSECTION\n"),
            Some("a DXF drawing")
        );
        let mut stl = vec![b' '; 80];
        stl.extend_from_slice(&12_u32.to_le_bytes());
        stl.extend_from_slice(&[0, 0, 128, 63].repeat(150));
        assert_eq!(what(&stl), Some("an STL model"));
        let iges = format!("{:72}S      1\n", "a plate");
        assert_eq!(what(iges.as_bytes()), Some("an IGES model"));
        let machine = b"# A mill\nschema = 1\nname = \"mill\"\n[converter]\n";
        assert_eq!(what(machine), Some("a machine file"));
        for control in [&b"[include a.cfg]\n[printer]\n"[..], b"; my mill\n[EMC]\n"] {
            let settings = Some("a file of settings (Klipper, LinuxCNC)");
            assert_eq!(what(control), settings);
        }
        for program in [&b"%\nO1\nG0 X0\n"[..], b"(BEGIN PGM)\nG1", b"0\nG1", b""] {
            assert_eq!(what(program), None);
        }
    }
}
