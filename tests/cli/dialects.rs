//! Which controller a program is for, and programs of several files.

use super::{Ran, Shop};

/// Asserts that `check` refused a program, with this message.
#[track_caller]
fn refused(ran: &Ran, message: &str) {
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains(message), "{}", ran.stderr);
}

#[test]
fn a_bare_g28_moves_all_axes_of_a_haas_lathe() {
    let shop = Shop::new();
    shop.put("turn.nc", "%\nO1\nG97 S500 M3\nG0 X40. Z5.\nG28\nM30\n%\n");
    let check = |dialect| shop.run(&["check", "turn.nc", "-m", "lathe", "--dialect", dialect]);
    refused(&check("fanuc-lathe"), "a reference point without axes");
    let read = check("haas-lathe");
    assert!(read.code < 2, "{}", read.stderr);
}

#[test]
fn subprograms_are_found_in_any_spelling_of_their_number() {
    let shop = Shop::new();
    shop.put("main.nc", "%\nO1\nG0 X1.\nM98 P9001\nM30\n%\n");
    let check = || shop.run(&["check", "main.nc", "-m", "vmc", "--dialect", "haas"]);
    let message = "O9001.nc, 9001.ngc or another spelling of the number";
    refused(&check(), message);
    shop.put("O09001.Eia", "O9001\nG0 Y2.\nM99\n");
    let read = check();
    assert!(read.code < 2, "{}", read.stderr);
}
