//! Motor-side data, worked by hand.

use gwatt::machine::{Axis, AxisId, ForcePoint};

use super::{edited, machine, near};

const X: &str = "rapid_mm_min = 36000\naccel_mm_s2 = 6000\nmass_kg = 900\n";
const B: &str = "rapid_deg_min = 18000\naccel_deg_s2 = 1150\ninertia_kg_m2 = 12\n";

fn axis(text: &str, id: AxisId) -> Axis {
    machine(text).axes[id as usize].expect("the axis")
}

#[test]
fn load_side_is_taken_as_it_is() {
    let x = axis(
        &edited(
            X,
            &format!(
                "{X}coulomb_n = 700\nviscous_n_s_m = 50\ngravity_n = -300\ncopper_w_n2 = 1e-4\njerk_mm_s3 = 60000\nefficiency = 0.9\nservo_factor_motor = 1.3\nservo_factor_regen = 1.2\nfriction_min_ratio = 0.7\n"
            ),
        ),
        AxisId::X,
    );
    near(x.rapid_mm_s, 600.0);
    near(x.accel_mm_s2, 6000.0);
    near(x.mass_kg, 900.0);
    near(x.coulomb_n, 700.0);
    near(x.viscous_n_s_m, 50.0);
    near(x.gravity_n, -300.0);
    near(x.copper_w_n2, 1e-4);
    near(x.jerk_mm_s3, 60_000.0);
    near(x.efficiency, 0.9);
    near(x.servo_factor_motor, 1.3);
    near(x.servo_factor_regen, 1.2);
    near(x.friction_min_ratio, 0.7);
    near(x.si_per_unit, 1e-3);
}

/// Lead 10 mm, 3000 rpm: 30000 mm/min = 500 mm/s; in 0.1 s: 5000 mm/s².
/// k = 2π/0.01 m = 628.3185 rad/m: J·k² = 0.001·394784.18 = 394.78418 kg,
/// T·k = 1·628.3185 N, d·k² = 0.0002·394784.18 = 78.956835 N·s/m,
/// r/k² = 2/394784.18 = 5.0660592e-6 W/N².
#[test]
fn screw_at_the_motor() {
    let motor = "max_speed_rpm = 3000\naccel_time_s = 0.1\ninertia_kg_m2 = 0.001\n\
                 friction_nm = 1\nviscous_nm_s_rad = 0.0002\ngravity_nm = -0.5\n\
                 copper_w_nm2 = 2\nlead_mm = 10\n";
    let x = axis(&edited(X, motor), AxisId::X);
    near(x.rapid_mm_s, 500.0);
    near(x.accel_mm_s2, 5000.0);
    near(x.mass_kg, 394.784_18);
    near(x.coulomb_n, 628.318_531);
    near(x.viscous_n_s_m, 78.956_835);
    near(x.gravity_n, -314.159_265);
    near(x.copper_w_n2, 5.066_059_2e-6);
}

/// The same with a belt of 2 between motor and screw: half the speed, twice
/// the force, four times the mass.
#[test]
fn screw_behind_a_gear() {
    let motor = "max_speed_rpm = 3000\naccel_time_s = 0.1\ninertia_kg_m2 = 0.001\n\
                 friction_nm = 1\nlead_mm = 10\ngear_ratio = 2\n";
    let x = axis(&edited(X, motor), AxisId::X);
    near(x.rapid_mm_s, 250.0);
    near(x.accel_mm_s2, 2500.0);
    near(x.mass_kg, 4.0 * 394.784_18);
    near(x.coulomb_n, 2.0 * 628.318_531);
}

/// Motor and load side may be mixed: each quantity in its own form.
#[test]
fn forms_may_be_mixed() {
    let mixed =
        "rapid_mm_min = 30000\naccel_time_s = 0.1\nmass_kg = 400\nfriction_nm = 1\nlead_mm = 10\n";
    let x = axis(&edited(X, mixed), AxisId::X);
    near(x.accel_mm_s2, 5000.0);
    near(x.mass_kg, 400.0);
    near(x.coulomb_n, 628.318_531);
}

/// At the table: 18000 degrees/min = 300 degrees/s.
#[test]
fn rotary_at_the_table() {
    let b = axis(
        &edited(
            B,
            &format!("{B}friction_nm = 40\ncopper_w_n2 = 0.01\njerk_deg_s3 = 9000\n"),
        ),
        AxisId::B,
    );
    near(b.rapid_mm_s, 300.0);
    near(b.accel_mm_s2, 1150.0);
    near(b.mass_kg, 12.0);
    near(b.coulomb_n, 40.0);
    near(b.copper_w_n2, 0.01);
    near(b.jerk_mm_s3, 9000.0);
    near(b.si_per_unit, std::f64::consts::PI / 180.0);
}

/// 3000 rpm through 50: 60 rpm = 360 degrees/s; in 0.2 s: 1800 degrees/s².
/// J·i² = 0.002·2500 = 5 kg·m², T·i = 0.8·50 = 40 N·m,
/// d·i² = 0.001·2500 = 2.5 N·m·s/rad, r/i² = 25/2500 = 0.01.
#[test]
fn rotary_behind_a_gear() {
    let motor = "max_speed_rpm = 3000\naccel_time_s = 0.2\ninertia_kg_m2 = 0.002\n\
                 friction_nm = 0.8\nviscous_nm_s_rad = 0.001\ngravity_nm = 0.1\n\
                 copper_w_nm2 = 25\ngear_ratio = 50\n";
    let b = axis(&edited(B, motor), AxisId::B);
    near(b.rapid_mm_s, 360.0);
    near(b.accel_mm_s2, 1800.0);
    near(b.mass_kg, 5.0);
    near(b.coulomb_n, 40.0);
    near(b.viscous_n_s_m, 2.5);
    near(b.gravity_n, 5.0);
    near(b.copper_w_n2, 0.01);
}

/// Without a gear the speed in rpm is the table's: 50 rpm = 300 degrees/s.
#[test]
fn rotary_speed_of_the_table() {
    let b = axis(
        &edited("rapid_deg_min = 18000", "max_speed_rpm = 50"),
        AxisId::B,
    );
    near(b.rapid_mm_s, 300.0);
}

#[test]
fn kind_follows_the_letter() {
    let text = edited("kind = \"linear\"\n", "").replace("kind = \"rotary\"\n", "");
    assert_eq!(machine(&text).axes, machine(super::BASE).axes);
}

/// Lead 10 mm: 3000 rpm are 500 mm/s, and 2 N·m are 2·628.3185 N. A table after
/// a gear of 90 turns with 3000/90 rpm = 200 degrees/s, with 90 times the torque.
#[test]
fn torque_curves_at_the_motor() {
    let curve = "torque_curve = [{ rpm = 0, torque_nm = 3 }, { rpm = 3000, torque_nm = 2 }]\n";
    let last = |text: &str| -> ForcePoint {
        let machine = machine(text);
        assert_eq!(machine.force_curves.len(), 1);
        machine.force_curves[0].1[1]
    };
    let motor = format!(
        "max_speed_rpm = 3000\naccel_time_s = 0.1\ninertia_kg_m2 = 0.001\nlead_mm = 10\n{curve}"
    );
    let x = last(&edited(X, &motor));
    near(x.speed_mm_s, 500.0);
    near(x.force_n, 1256.637);
    let motor = format!(
        "max_speed_rpm = 3000\naccel_time_s = 0.2\ninertia_kg_m2 = 0.002\ngear_ratio = 90\n{curve}"
    );
    let b = last(&edited(B, &motor));
    near(b.speed_mm_s, 200.0);
    near(b.force_n, 180.0);
    let x = machine(&edited(
        X,
        &format!(
            "{X}force_curve = [{{ speed_mm_min = 0, force_n = 9 }}, {{ speed_mm_min = 36000, force_n = 5 }}]\n"
        ),
    ));
    let point = x.force_curves[0].1[1];
    assert_eq!((point.speed_mm_s, point.force_n), (600.0, 5.0));
}
