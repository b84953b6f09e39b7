//! Whatever the bytes are, the pieces joined are the bytes.
#![no_main]

use gwatt::syntax::Program;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    assert_eq!(Program::parse(bytes).bytes(), bytes);
});
