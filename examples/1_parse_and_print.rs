//! Splits a program into blocks and words without losing a byte, and prints both.
//!
//! `cargo run --example 1_parse_and_print [PROGRAM]`

use std::error::Error;
use std::io::{Write, stdout};

use gwatt::source::lines;
use gwatt::syntax::{Block, scan_line};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1);
    let program = std::fs::read(path.as_deref().unwrap_or("examples/pocket.ngc"))?;
    let mut out = stdout().lock();
    let mut block = Block::default();
    let mut printed = 0;
    for (index, line) in lines(&program).enumerate() {
        scan_line(line, index == 0, &mut block);
        // The line as it is, to the last byte.
        out.write_all(line)?;
        printed += line.len();
        for word in &block.words {
            let letter = char::from(word.letter);
            let text = String::from_utf8_lossy(word.number.of(line));
            writeln!(out, "    {letter} = {} (written {text})", word.value)?;
        }
    }
    assert_eq!(printed, program.len());
    Ok(())
}
