//! Random machines, as TOML, over everything that a machine file may say about
//! motion and power.

use std::fmt::Write as _;

use super::axes::{self, Motion};
use crate::random::Random;

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
        2 if curves => Motion::Both,
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
        axes::write(random, &mut toml, *letter, motion, *letter == curved);
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
        let _ = writeln!(toml, "base_load_w = {:?}", random.within(0.0, 300.0));
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
