//! A reader that goes away, as `head` does.

use super::{Ran, Shop};

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    let shop = Shop::new();
    for arguments in [
        &["limit", "steep.ngc"][..],
        &["check", "gentle.ngc"],
        &["report", "steep.ngc"],
        &["machine", "schema"],
    ] {
        let arguments = [&["--color", "never"], arguments].concat();
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let ran = Ran::from(shop.command(&arguments).stdout(writer).output().unwrap());
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert!(!ran.stderr.contains("cannot write"), "{}", ran.stderr);
    }
}
