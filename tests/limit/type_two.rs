//! G71 and G72 of lathes whose contour begins with X and Z, stock removal of type II: what the
//! control does from pass to pass, and how that is written out.

use super::lathe::{READ, limited};
use crate::shop::Shop;

/// What the machine file says of contours that begin with X and Z, and a way out that is the
/// cycle's own return.
#[test]
fn a_contour_without_a_pocket_goes_as_in_type_one() {
    let begin = "G21 G99 G54 T0300\nG97 S500 M3\nG0 X60. Z3.\n";
    let contour = "N10 G0 X30. Z3.\nG1 Z-60.\nX60. Z-70.\nN20 G0 Z3.\nG0 X66. Z4.\n";
    let program = format!("{begin}G71 P10 Q20 D8. R1. F0.3\n{contour}");
    let known = Shop::lathe("fanuc-lathe", 400.0, "[language]\ntype_2 = \"as-type-1\"");
    // The same passes as those of type I.
    let one = limited(
        &Shop::lathe("fanuc-lathe", 400.0, ""),
        &program.replace("N10 G0 X30. Z3.", "N10 G0 X30."),
    );
    let two = limited(&known, &program);
    assert_eq!(two.replace(" Z3.)", ")"), one.replace(" Z3.)", ")"));
    // One with a pocket stays.
    let pocket = program.replace("G1 Z-60.", "G1 Z-20.\nX20. Z-40.\nX30. Z-60.");
    let unused = Shop::lathe("fanuc-lathe", 400.0, "[language]\ntype_2 = \"as-type-1\"");
    let errors = unused.refused(&pocket, READ);
    assert!(errors.contains("(type II)"), "{errors}");
    // Why it stays is said once at its line, though many of its moves do not fit.
    let errors = Shop::lathe("fanuc-lathe", 400.0, "").refused(&program, READ);
    assert_eq!(errors.matches("error[untouchable]").count(), 1, "{errors}");
    let help = "= help: it is not written out as single blocks: the first block of the contour";
    assert!(errors.contains(help), "{errors}");
    assert!(
        errors.contains("U8. R1.") || errors.contains(" moves)"),
        "{errors}"
    );
}

/// Haas' lathes go along the contour after each pass: parts of arcs are written out as well, in
/// inches too, where a digit is coarser.
#[test]
fn passes_along_the_contour_are_written_out() {
    let shop = Shop::lathe("haas-lathe", 400.0, "[language]\nescape_mm = 1");
    for (units, begin, contour) in [
        (
            "G21",
            "X60. Z3.",
            "N10 G0 X20. Z3.\nG1 Z-10.\nX30.\nG3 X40. Z-15. R5.\nG1 Z-30.\nG2 X50. Z-35. R5.\nN20 G1 X60.",
        ),
        (
            "G20",
            "X2.4 Z.1",
            "N10 G0 X.8 Z.1\nG1 Z-.4\nX1.2\nG3 X1.6 Z-.6 R.2\nG1 Z-1.2\nG2 X2. Z-1.4 R.2\nN20 G1 X2.4",
        ),
        // A crossing may be found at the end of an arc, with nothing left of it.
        (
            "G20",
            "X3. Z.1",
            "N10 G0 X-.06 Z.1\nG1 Z0.\nX.8\nX.9 Z-.05\nZ-1.9\nX1.24\nG3 X1.6 Z-2.08 R.18\nG1 Z-2.8\nX2.1\nN20 X3.",
        ),
    ] {
        let depth = if units == "G20" { "D.04" } else { "D1.8" };
        let program = format!(
            "{units} G99 G54 T0300\nG97 S500 M3\nG0 {begin}\nG71 P10 Q20 {depth} F0.01\n{contour}\nM30\n"
        );
        let text = limited(&shop, &program);
        assert!(text.contains("(G71 written out)"), "{text}");
        let arcs = text
            .lines()
            .filter(|line| line.starts_with("G2 ") || line.starts_with("G3 "));
        // One each at the end, and parts of them before.
        assert!(arcs.count() > 4, "{text}");
    }
}
