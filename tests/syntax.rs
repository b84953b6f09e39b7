//! Reading of programs: nothing is lost, and both readers agree.

use std::io::Read;
use std::path::{Path, PathBuf};

use gwatt::source::{LineReader, lines};
use gwatt::syntax::{Block, Piece, PieceKind, Program, parse_line, scan_line};
use proptest::prelude::*;

/// A bit of a line: what programs hold, and what they should not.
fn bit() -> impl Strategy<Value = Vec<u8>> {
    let text = prop_oneof![
        8 => "[GXYZFSTMIJKNAR][-+]?[0-9]{1,4}(\\.[0-9]{0,5})?",
        4 => "[A-Za-z=*@^][ \t]{0,2}[-+.]?[ \t]{0,2}[0-9]{0,3}\\.?[0-9]{0,3}",
        1 => "[XE][-+]?[0-9]{15,24}\\.?[0-9]{0,24}",
        1 => "X[1-9][0-9]{307,312}",
        4 => "[ \t]{1,3}",
        2 => "\\([^)\r\n]{0,8}\\)",
        1 => ";[ -~]{0,8}",
        1 => "[nN][0-9]{1,5}",
        1 => "/[0-9]?",
        1 => "[oO][0-9<#\\[]{0,3} ?(sub|IF|endwhile|call)?",
        1 => "[#\\[\\]<>=+*/-]{1,4}",
        1 => "[A-Z_]{2,6}[0-9]{0,2}",
        1 => "[%(;\"$!?&]",
        3 => "(\n|\r|\r\n)",
    ];
    prop_oneof![
        12 => text.prop_map(String::into_bytes),
        1 => prop::collection::vec(any::<u8>(), 1..4),
        1 => Just(b"\xEF\xBB\xBF".to_vec()),
    ]
}

/// Bytes that look like a program from afar.
fn program_like() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(bit(), 0..40).prop_map(|bits| bits.concat())
}

fn assert_lossless(bytes: &[u8]) {
    let program = Program::parse(bytes);
    assert_eq!(program.bytes(), bytes);
    for line in &program.lines {
        let mut at = 0;
        for piece in &line.pieces {
            assert_eq!(piece.span.start, at, "a gap in {:?}", line.text);
            assert!(!piece.span.is_empty());
            at = piece.span.end;
        }
        assert_eq!(at as usize, line.text.len());
        let unknown = line.pieces.iter().any(|p| p.kind == PieceKind::Unknown);
        assert_eq!(unknown, !line.block.issues.is_empty());
    }
}

/// What both readers make of a line must be the same to the last bit.
fn assert_readers_agree(line: &[u8], first: bool) {
    let (mut pieces, mut parsed, mut scanned) = <(Vec<Piece>, Block, Block)>::default();
    parse_line(line, first, &mut pieces, &mut parsed);
    scan_line(line, first, &mut scanned);
    assert_eq!(scanned, parsed, "{:?}", String::from_utf8_lossy(line));
    let bits = |block: &Block| {
        let words = block.words.iter().chain(&block.number);
        words.map(|word| word.value.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&scanned), bits(&parsed));
}

fn assert_all_readers_agree(bytes: &[u8]) {
    for (index, line) in lines(bytes).enumerate() {
        assert_readers_agree(line, index == 0);
    }
    assert_readers_agree(bytes, true);
}

/// A reader that gives a few bytes at a time.
struct Chunks<'a> {
    bytes: &'a [u8],
    sizes: std::iter::Cycle<std::slice::Iter<'a, usize>>,
}

impl Read for Chunks<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let size = self.sizes.next().copied().unwrap_or(1);
        let count = size.min(buffer.len()).min(self.bytes.len());
        buffer[..count].copy_from_slice(&self.bytes[..count]);
        self.bytes = &self.bytes[count..];
        Ok(count)
    }
}

/// The lines of `bytes`, found by looking at one byte after the other.
fn naive_lines(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut lines = vec![Vec::new()];
    for (index, &byte) in bytes.iter().enumerate() {
        lines.last_mut().unwrap().push(byte);
        // Up to eight CRs are one line end together with an LF after them.
        let crs = bytes[index..].iter().take_while(|it| **it == b'\r').count();
        let split = byte == b'\r' && crs <= 8 && bytes.get(index + crs) == Some(&b'\n');
        if matches!(byte, b'\r' | b'\n') && !split {
            lines.push(Vec::new());
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

fn read_lines(reader: impl Read) -> Vec<Vec<u8>> {
    let mut reader = LineReader::new(reader);
    let mut lines = Vec::new();
    while let Some((number, line)) = reader.next_line().unwrap() {
        lines.push(line.to_vec());
        assert_eq!(number, lines.len() as u64);
    }
    lines
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn any_bytes_come_back(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        assert_lossless(&bytes);
        assert_all_readers_agree(&bytes);
    }

    #[test]
    fn programs_come_back(bytes in program_like()) {
        assert_lossless(&bytes);
        assert_all_readers_agree(&bytes);
    }

    #[test]
    fn numbers_are_rounded_as_by_the_standard_library(
        number in prop_oneof![
            "[-+]?[0-9]{1,17}\\.[0-9]{0,3}",
            "[-+]?[0-9]{1,5}(\\.[0-9]{0,24})?",
            "[-+]?\\.[0-9]{1,40}",
            "[-+]?0{0,30}[0-9]{1,330}\\.?",
            any::<f64>().prop_filter("finite", |v| v.is_finite()).prop_map(|v| v.to_string()),
        ]
    ) {
        let expected: f64 = number.parse().unwrap();
        let line = format!("X{number}");
        let mut block = Block::default();
        scan_line(line.as_bytes(), false, &mut block);
        let found: Vec<u64> = block.words.iter().map(|word| word.value.to_bits()).collect();
        let expected = expected.is_finite().then(|| expected.to_bits());
        prop_assert_eq!(found, expected.into_iter().collect::<Vec<_>>());
        assert_readers_agree(line.as_bytes(), false);
    }

    #[test]
    fn a_line_may_end_anywhere_in_a_number(text in "[XYZ0-9.+ -]{0,20}", end in "\r?\n?") {
        assert_readers_agree(format!("{text}{end}").as_bytes(), false);
    }

    #[test]
    fn lines_do_not_depend_on_how_they_arrive(
        text in "[ab\r\n]{0,60}",
        sizes in prop::collection::vec(1_usize..9, 1..6),
    ) {
        let expected = naive_lines(text.as_bytes());
        let chunks = Chunks { bytes: text.as_bytes(), sizes: sizes.iter().cycle() };
        prop_assert_eq!(read_lines(chunks), expected.clone());
        let split: Vec<Vec<u8>> = lines(text.as_bytes()).map(<[u8]>::to_vec).collect();
        prop_assert_eq!(split, expected);
    }
}

/// Every line of five of these bytes: what is rare at random is among them.
#[test]
fn readers_agree_on_all_short_lines() {
    let alphabet = b"NXO1.-/ ();%#";
    let count = alphabet.len();
    for number in 0..count.pow(5) {
        let digit = |place: u32| alphabet[number / count.pow(place) % count];
        let line = [digit(4), digit(3), digit(2), digit(1), digit(0)];
        assert_readers_agree(&line, false);
    }
}

#[test]
fn lines_cross_the_ends_of_the_buffer() {
    // Longer than the buffer of the reader, with line ends at every offset.
    let mut text = Vec::new();
    for length in 0..1500_usize {
        text.resize(text.len() + length % 700, b'x');
        let ends: [&[u8]; 3] = [b"\n", b"\r", b"\r\n"];
        text.extend_from_slice(ends[length % 3]);
    }
    text.resize(text.len() + 700_000, b'y');
    for size in [1_000_003, 262_144, 4096, 4093] {
        let sizes = [size];
        let chunks = Chunks {
            bytes: &text,
            sizes: sizes.iter().cycle(),
        };
        assert_eq!(read_lines(chunks), naive_lines(&text));
    }
}

/// All files below `directory`.
fn files(directory: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(directory).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

/// Real programs lie next to the project, not in it.
#[test]
fn real_programs_come_back() {
    let sibling = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared");
    let shared = std::env::var("GWATT_SHARED").unwrap_or_else(|_| sibling.to_owned());
    let mut found = Vec::new();
    files(&Path::new(&shared).join("corpus"), &mut found);
    if found.is_empty() {
        crate::evidence::cannot_run("the programs of others are not there");
        return;
    }
    crate::evidence::runs();
    for path in found {
        let bytes = std::fs::read(&path).unwrap();
        assert_lossless(&bytes);
        assert_all_readers_agree(&bytes);
        if !bytes.contains(&0) {
            assert_eq!(
                read_lines(&bytes[..]),
                naive_lines(&bytes),
                "{}",
                path.display()
            );
        }
    }
}
