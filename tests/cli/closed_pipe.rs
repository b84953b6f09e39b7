//! A reader that goes away, as `head` does: the verdict stays what it is.

use super::{Ran, Shop};

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    let shop = Shop::new();
    for (arguments, code) in [
        (&["limit", "steep.ngc"][..], 0),
        (&["check", "gentle.ngc"], 0),
        (&["check", "steep.ngc"], 1),
        (&["check", "steep.ngc", "--format", "jsonl"], 1),
        (&["check", "nowhere.ngc", "steep.ngc"], 2),
        (&["report", "steep.ngc"], 0),
        (&["report", "steep.ngc", "--fail"], 1),
        (&["machine", "schema"], 0),
    ] {
        let arguments = [&["--color", "never"], arguments].concat();
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let ran = Ran::from(shop.command(&arguments).stdout(writer).output().unwrap());
        assert_eq!(ran.code, code, "{arguments:?}: {}", ran.stderr);
        assert!(!ran.stderr.contains("cannot write"), "{}", ran.stderr);
    }
}
