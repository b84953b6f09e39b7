//! What can be lowered is written, though not all moves fit then.

use crate::shop::Shop;

const PROGRAM: &str =
    "G21 G90\nG0 X400. Y300.\nG84 X0. Y0. Z-90. R-60. F1000.\nG80\nG0 X400.\nM30\n";

#[test]
fn what_can_be_lowered_is_written_on_request() {
    let shop = Shop::mill(
        "fanuc",
        "peak_power_w = 400",
        "[path]\nrapid = \"linear\"",
        "",
    );
    shop.refused(PROGRAM, "");
    let (code, _, errors) = shop.run("limit a.nc --partial -o out.nc");
    assert_eq!(code, 1, "{errors}");
    // The ways down to R and back up are too fast for 400 W, and part of the cycle.
    assert!(
        errors.contains("a.nc: not certified: 2 moves still over the limit; peak "),
        "{errors}"
    );
    assert!(errors.contains("error[untouchable]"), "{errors}");
    assert!(errors.contains("  line 3  rapid Z "), "{errors}");
    let text = shop.get("out.nc");
    assert!(text.contains("G1 X400. Y300. F"), "{text}");
    assert!(text.contains("G84 X0. Y0. Z-90. R-60. F1000.\n"), "{text}");
    // What remains is what `check` finds.
    let (code, out, errors) = shop.run("check out.nc");
    assert_eq!(code, 1, "{errors}");
    assert!(out.contains("does not fit: 2 moves of "), "{out}");
}

/// Where all fits, nothing is different.
#[test]
fn a_program_that_fits_is_certified_with_it_too() {
    let shop = Shop::mill("iso", "peak_power_w = 400", "", "");
    shop.put("a.nc", "G21 G90 G61\nG0 X400. Y300.\nM30\n");
    let [plain, partly] = ["", " --partial"].map(|option| {
        let (code, _, errors) = shop.run(&format!("limit a.nc{option} -o out.nc"));
        (code, errors, shop.get("out.nc"))
    });
    assert_eq!(plain, partly);
    assert_eq!(plain.0, 0, "{}", plain.1);
}

/// A dwell of gwatt's own that does not fit, since the spindle brakes meanwhile, is named too.
#[test]
fn what_was_put_in_and_does_not_fit_is_named() {
    let spindle = "[spindle]\ninertia_kg_m2 = 0.02\nfriction_nm = 0.3\nmax_rpm = 8000\n\
                   base_rpm = 1500\naccel_time_s = 2.5\nwait = true\npeak_power_w = 1000\n\
                   [path]\nrapid = \"linear\"";
    let shop = Shop::mill(
        "fanuc",
        "peak_power_w = 2700\nregen_power_w = 2700",
        spindle,
        "",
    );
    shop.put(
        "a.nc",
        "G21 G90 G94\nG97 S3000 M3\nG1 X132.6 Z-78.7 F1000\nG97 S1500 M3\nG0 X500. Y400. Z0\n\
         G0 X0\nM5\nM30\n",
    );
    let (code, _, errors) = shop.run("limit a.nc --partial -o out.nc");
    assert_eq!(code, 1, "{errors}");
    assert_eq!(shop.get("out.nc").matches("G4 P1\n").count(), 1);
    let (_, out, _) = shop.run("check out.nc");
    let count = |text: &str, what| text.matches(what).count();
    for kind in ["  dwell ", "  spindle ", "  rapid ", "  feed "] {
        assert_eq!(
            count(&errors, kind),
            count(&out, kind),
            "{kind}: {errors}{out}"
        );
    }
    assert_eq!(count(&out, "  dwell "), 1, "{out}");
}
