//! Machines on which two motors move two axes together.

use insta::assert_snapshot;

use super::findings;
use gwatt::machine::Machine;
use gwatt::power::Certificate;

/// Two like axes of 0.5 kg with 4 N of friction at 0.8, 300 mm/s, 3000 mm/s².
fn core(more: &str) -> String {
    let axes = ["X", "Y"].map(|axis| {
        format!(
            "[axes.{axis}]\nrapid_mm_min = 18000\naccel_mm_s2 = 3000\nmass_kg = 0.5\n\
             coulomb_n = 4\nefficiency = 0.8\n"
        )
    });
    format!(
        "schema = 1\nname = \"core\"\ncontroller = \"marlin\"\n{more}\
         [converter]\npeak_power_w = 1000\n{}{}",
        axes[0], axes[1]
    )
}

/// What the motors draw on a circle at constant speed, W, at its worst place: forces and
/// speeds of the axes, and from them `(P + max(|P|, |C|))/2` by the efficiency of a motor.
fn circle_w(radius_m: f64, speed_m_s: f64) -> f64 {
    let at = |degrees: u32| {
        let angle = f64::from(degrees).to_radians();
        let [v_x, v_y] = [-speed_m_s * libm::sin(angle), speed_m_s * libm::cos(angle)];
        let inward = 0.5 * speed_m_s * speed_m_s / radius_m;
        let f_x = -inward * libm::cos(angle) + 4.0 * v_x.signum();
        let f_y = -inward * libm::sin(angle) + 4.0 * v_y.signum();
        let [own, crossed] = [v_x * f_x + v_y * f_y, v_x * f_y + v_y * f_x];
        f64::midpoint(own, own.abs().max(crossed.abs())) / 0.8
    };
    (0..360).map(at).fold(0.0, f64::max)
}

#[test]
fn the_robust_bound_covers_motors_that_share_axes() {
    let peak = |kinematics: &str| {
        let (machine, _) = Machine::from_toml("core.toml", &core(kinematics)).unwrap();
        // 0.1 m/s on a radius of 5 mm takes 2 m/s².
        let program = "G1 X5 F6000\nG2 X5 Y0 I-5 J0\n";
        let summary = gwatt::check(program, &machine).unwrap();
        (summary.peak_w, summary.certificate)
    };
    let motors_w = circle_w(0.005, 0.1);
    let (axes_w, planned) = peak("");
    assert_eq!(planned, Some(Certificate::Planned));
    let (bound_w, certificate) = peak("kinematics = \"corexy\"\n");
    assert_eq!(certificate, Some(Certificate::Robust));
    assert!(
        bound_w >= motors_w && bound_w >= axes_w,
        "{bound_w} {motors_w} {axes_w}"
    );
}

#[test]
fn axes_that_share_motors_have_to_be_alike() {
    let core = |kinematics: &str| core(&format!("kinematics = \"{kinematics}\"\n"));
    assert_snapshot!(findings(&core("corexy")), @"");
    assert_snapshot!(findings(&core("cartesian")), @"");
    assert_snapshot!(findings(&core("corexz")), @r#"
    line 4, error machine-kinematics: the axes X and Z share their motors / describe both of them
      | kinematics = "corexz"
      |              ^^^^^^^^
    "#);
    assert_snapshot!(findings(&core("delta")), @r#"
    line 4, error machine-value: `kinematics` must be "cartesian", "corexy" or "corexz", not "delta"
      | kinematics = "delta"
      |              ^^^^^^^
    "#);
    let heavier = core("corexy").replacen("mass_kg = 0.5", "mass_kg = 0.6", 1);
    assert_snapshot!(findings(&heavier), @r#"
    line 4, error machine-kinematics: X and Y share their motors, but their mass differs / give both the larger figure, and each the rotors of both motors: what the motors draw is then covered by what the axes draw at most
      | kinematics = "corexy"
      |              ^^^^^^^^
    "#);
    let curve = "torque_curve = [{ rpm = 0, torque_nm = 1 }, { rpm = 3000, torque_nm = 1 }]\nlead_mm = 40\n";
    let stronger = core("corexy").replacen("[axes.Y]\n", &format!("[axes.Y]\n{curve}"), 1);
    assert_snapshot!(findings(&stronger), @r#"
    line 4, error machine-kinematics: X and Y share their motors, but their torque or force curve differs / give both the larger figure, and each the rotors of both motors: what the motors draw is then covered by what the axes draw at most
      | kinematics = "corexy"
      |              ^^^^^^^^
    "#);
    let feeding = core("corexy").replace(
        "peak_power_w = 1000",
        "peak_power_w = 1000\nregen_power_w = 100",
    );
    assert_snapshot!(findings(&feeding), @r#"
    line 4, error machine-kinematics: what motors feed back that move two axes together is not known: `regen_power_w` cannot be checked / leave `regen_power_w` out
      | kinematics = "corexy"
      |              ^^^^^^^^
    "#);
}
