//! Random machines, as TOML, over everything that a machine file may say about
//! motion and power.

use std::fmt::Write as _;

use super::random::Random;
use super::switches::{ALL_CORNERS, CURVES_WITH_JERK, CURVES_WITH_MANY_POINTS, SPINDLE_BASE_LOAD};

/// A machine and what programs for it may have.
#[derive(Debug, Clone)]
pub struct Described {
    pub toml: String,
    /// Letters of its axes.
    pub axes: Vec<char>,
    /// Whether its programs may have arcs: how jerk limits and force curves act
    /// on them is each controller's own rule.
    pub arcs: bool,
    /// The largest spindle speed; 0 without a spindle.
    pub max_rpm: f64,
    pub loads: bool,
}

/// How the axes' motion is limited.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    Plain,
    Jerk,
    Curve,
    Both,
}

/// A machine under an exact-stop controller.
pub fn any(random: &mut Random) -> Described {
    of("iso", random, true)
}

/// A machine under `controller`; with force curves only where asked for.
pub fn of(controller: &str, random: &mut Random, curves: bool) -> Described {
    let mut axes = vec!['X', 'Y', 'Z'];
    let printer = ["marlin", "reprap", "klipper"].contains(&controller);
    for letter in ['A', 'C'] {
        if !printer && random.once_in(3) {
            axes.push(letter);
        }
    }
    let motion = match random.below(6) {
        0 => Motion::Jerk,
        1 if curves => Motion::Curve,
        2 if curves && CURVES_WITH_JERK => Motion::Both,
        _ => Motion::Plain,
    };
    let several = random.once_in(4);
    let mut toml = format!("schema = 1\nname = \"random\"\ncontroller = \"{controller}\"\n");
    if random.once_in(3) && controller == "iso" {
        toml += "[path]\nrapid = \"independent\"\n";
    }
    let margin = if random.once_in(2) {
        0.0
    } else {
        random.within(0.0, 0.3)
    };
    let spindle = random.once_in(3);
    let loads = random.once_in(3);
    let names: &[&str] = if several { &["left", "right"] } else { &[""] };
    for (which, name) in names.iter().enumerate() {
        let fed: Vec<char> = axes
            .iter()
            .copied()
            .enumerate()
            .filter(|(index, _)| !several || index % 2 == which)
            .map(|(_, letter)| letter)
            .collect();
        converter(random, &mut toml, name, &fed);
    }
    let curved = axes[random.below(axes.len())];
    for letter in &axes {
        axis(random, &mut toml, *letter, motion, *letter == curved);
    }
    let fed_by = if several {
        "converter = \"right\"\n"
    } else {
        ""
    };
    if loads {
        for (on, off) in [("M8", "M9"), ("M7", "M9")] {
            let power_w = random.scale(5.0, 1500.0);
            let _ = writeln!(
                toml,
                "[[load]]\non = \"{on}\"\noff = \"{off}\"\npower_w = {power_w:?}\n{fed_by}"
            );
        }
    }
    let mut max_rpm = 0.0;
    if spindle {
        max_rpm = random.scale(500.0, 20_000.0).round();
        let _ = writeln!(
            toml,
            "[spindle]\ninertia_kg_m2 = {:?}\nfriction_nm = {:?}\nmax_rpm = {max_rpm:?}\n\
             accel_time_s = {:?}\nefficiency = {:?}\nwait = false\n{fed_by}",
            random.scale(1e-3, 0.3),
            random.within(0.0, 2.0),
            random.scale(0.2, 4.0),
            random.within(0.7, 1.0),
        );
        if random.once_in(2) {
            let _ = writeln!(toml, "base_rpm = {:?}", max_rpm * random.within(0.2, 0.9));
        }
        if SPINDLE_BASE_LOAD {
            let _ = writeln!(toml, "base_load_w = {:?}", random.within(0.0, 300.0));
        }
    }
    let _ = writeln!(toml, "[limits]\nmargin = {margin:?}");
    if !spindle && random.once_in(2) {
        let feed = random.within(100.0, 200.0);
        let rapid = random.within(50.0, 100.0);
        let _ = writeln!(
            toml,
            "override_max_percent = {{ feed = {feed:?}, rapid = {rapid:?} }}"
        );
    }
    let arcs = motion == Motion::Plain;
    Described {
        toml,
        axes,
        arcs,
        max_rpm,
        loads,
    }
}

fn converter(random: &mut Random, toml: &mut String, name: &str, axes: &[char]) {
    let peak_w = random.scale(2e3, 1e5);
    let regen_w = random.scale(500.0, 1e5);
    let _ = writeln!(
        toml,
        "[[converter]]\npeak_power_w = {peak_w:?}\nregen_power_w = {regen_w:?}"
    );
    if !name.is_empty() {
        let _ = writeln!(toml, "name = \"{name}\"\naxes = {axes:?}");
    }
    if random.once_in(2) {
        let _ = writeln!(toml, "base_load_w = {:?}", random.within(0.0, 400.0));
    }
    let _ = writeln!(toml, "credit_regen = {}", random.once_in(2));
    if random.once_in(3) {
        let continuous_w = peak_w * random.within(0.05, 0.9);
        let _ = writeln!(
            toml,
            "continuous_power_w = {continuous_w:?}\nwindow_s = {:?}\n\
             overload = [{{ power_w = {peak_w:?}, seconds = 0.2, every_s = {:?} }}]",
            random.scale(0.5, 60.0),
            random.scale(0.5, 20.0),
        );
    }
    if random.once_in(3) {
        let _ = writeln!(
            toml,
            "capacitance_f = {:?}\nbus_nominal_v = 560\nbus_min_v = 480\nbus_max_v = 760\n\
             brake_power_w = {:?}\nbrake_energy_j = 5000",
            random.scale(1e-3, 0.1),
            random.scale(10.0, 2000.0),
        );
    }
}

fn axis(random: &mut Random, toml: &mut String, letter: char, motion: Motion, curved: bool) {
    let turns = "ABC".contains(letter);
    let (unit, u) = if turns {
        ("deg", 0.017_453_292_519_943_295)
    } else {
        ("mm", 1e-3)
    };
    let speed = random.scale(40.0, 900.0);
    let accel = random.scale(300.0, 9000.0);
    let mass = if turns {
        random.scale(0.05, 20.0)
    } else {
        random.scale(1.0, 800.0)
    };
    let force = mass * accel * u;
    let _ = writeln!(toml, "[axes.{letter}]\naccel_{unit}_s2 = {accel:?}");
    let coulomb = if random.once_in(3) {
        0.0
    } else {
        force * random.within(0.0, 0.6)
    };
    let viscous = if random.once_in(2) {
        0.0
    } else {
        force / (speed * u) * random.within(0.0, 0.4)
    };
    let gravity = if random.once_in(2) {
        0.0
    } else {
        force * random.within(-0.8, 0.8)
    };
    let copper = if random.once_in(2) {
        0.0
    } else {
        random.within(0.0, 0.3) * speed * u / force
    };
    // The same axis by the data of its motor.
    let at_motor = !turns && random.once_in(4);
    let lead_mm = random.scale(5.0, 40.0).round();
    let gear = if random.once_in(2) { 1.0 } else { 2.0 };
    let k = if at_motor {
        std::f64::consts::TAU * gear / (1e-3 * lead_mm)
    } else {
        1.0
    };
    if at_motor {
        let _ = writeln!(
            toml,
            "lead_mm = {lead_mm:?}\ngear_ratio = {gear:?}\nmax_speed_rpm = {:?}\n\
             inertia_kg_m2 = {:?}\nfriction_nm = {:?}\nviscous_nm_s_rad = {:?}\n\
             gravity_nm = {:?}\ncopper_w_nm2 = {:?}",
            speed * 60.0 / lead_mm * gear,
            mass / (k * k),
            coulomb / k,
            viscous / (k * k),
            gravity / k,
            copper * k * k,
        );
    } else {
        let names = if turns {
            [
                "inertia_kg_m2",
                "friction_nm",
                "viscous_nm_s_rad",
                "gravity_nm",
                "copper_w_nm2",
            ]
        } else {
            [
                "mass_kg",
                "coulomb_n",
                "viscous_n_s_m",
                "gravity_n",
                "copper_w_n2",
            ]
        };
        for (name, value) in names.iter().zip([mass, coulomb, viscous, gravity, copper]) {
            let _ = writeln!(toml, "{name} = {value:?}");
        }
        let _ = writeln!(toml, "rapid_{unit}_min = {:?}", speed * 60.0);
    }
    if random.once_in(2) {
        let _ = writeln!(toml, "efficiency = {:?}", random.within(0.6, 1.0));
    }
    let factors = random.once_in(3);
    if factors && (copper == 0.0 || ALL_CORNERS) {
        let (motor, regen) = (random.within(1.0, 1.4), random.within(1.0, 1.4));
        let warm = random.within(0.4, 1.0);
        let _ = writeln!(
            toml,
            "servo_factor_motor = {motor:?}\nservo_factor_regen = {regen:?}\n\
             friction_min_ratio = {warm:?}"
        );
    }
    if motion == Motion::Jerk || motion == Motion::Both {
        let _ = writeln!(
            toml,
            "jerk_{unit}_s3 = {:?}",
            accel * random.scale(5.0, 400.0)
        );
    }
    if curved && (motion == Motion::Curve || motion == Motion::Both) {
        let drag = coulomb + viscous * speed * u + gravity.abs();
        let points = if CURVES_WITH_MANY_POINTS {
            2 + random.below(4)
        } else {
            2
        };
        let mut most = random.within(0.6, 1.4);
        let point = |i: usize, share: f64| {
            let v = speed * 1.001 * i as f64 / (points - 1) as f64;
            let force = drag + force * share;
            if at_motor || turns {
                // One revolution of the motor: the lead by the gear, or 360 degrees.
                let per_turn = if turns { 360.0 } else { lead_mm / gear };
                let rpm = v / per_turn * 60.0;
                format!("{{ rpm = {rpm:?}, torque_nm = {:?} }}", force / k)
            } else {
                format!("{{ speed_mm_min = {:?}, force_n = {force:?} }}", v * 60.0)
            }
        };
        let list: Vec<String> = (0..points)
            .map(|i| {
                let own = point(i, most);
                most *= random.within(0.4, 1.0);
                own
            })
            .collect();
        let key = if at_motor || turns {
            "torque_curve"
        } else {
            "force_curve"
        };
        let _ = writeln!(toml, "{key} = [{}]", list.join(", "));
    }
}
