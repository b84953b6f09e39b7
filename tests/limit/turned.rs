//! Programs into which `limit` has put exact stops or pauses: what is certified holds with the
//! knobs at any lower override.

use std::fmt::Write as _;

use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, LimitOptions, Options};

use crate::machines::machine_from;
use crate::random::Random;
use crate::runs::{self, summary_of, turned};

/// Settings of both knobs, as shares of the largest.
const SHARES: [f64; 11] = [
    0.05, 0.1, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.9, 1.0,
];

fn machine(seed: u64, controller: &str, path: &str, ratings: &str) -> Machine {
    let mut random = Random::new(seed);
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[path]\n{path}\n\
         [limits]\nmargin = 0.0\noverride_max_percent = {{ feed = 200 }}\n\
         [converter]\nbase_load_w = 30\n{ratings}\n"
    );
    for axis in ["X", "Y", "Z"] {
        let _ = write!(
            text,
            "[axes.{axis}]\nrapid_mm_min = {:.0}\naccel_mm_s2 = {:.0}\nmass_kg = {:.1}\n\
             coulomb_n = {:.1}\nefficiency = {:.2}\n",
            random.within(12000.0, 40000.0),
            random.within(1000.0, 6000.0),
            random.within(20.0, 200.0),
            random.within(5.0, 120.0),
            random.within(0.6, 0.95),
        );
    }
    machine_from(&text)
}

/// Feeds, with rapids between in pairs.
fn program(random: &mut Random) -> String {
    let mut text = "G90\n".to_owned();
    let at = |text: &mut String, random: &mut Random, head: &str, feed: &str| {
        let [x, y] = [(); 2].map(|()| random.within(-300.0, 300.0));
        let _ = writeln!(text, "{head} X{x:.3} Y{y:.3}{feed}");
    };
    let _ = writeln!(text, "G0 Z20.");
    for _ in 0..=random.below(3) {
        at(&mut text, random, "G0", "");
        let _ = writeln!(text, "G0 Z0.");
        for _ in 0..=random.below(4) {
            let feed = format!(" F{:.0}.", random.within(2000.0, 20000.0));
            at(&mut text, random, "G1", &feed);
        }
        let _ = writeln!(text, "G0 Z20.");
    }
    text + "M30\n"
}

/// What is written, if it is certified.
fn limited(machine: &Machine, program: &str, allowed: Allowed) -> Option<String> {
    let how = LimitOptions {
        allowed,
        ..LimitOptions::USUAL
    };
    let done = runs::limited(machine, &Options::default(), how, program);
    let (text, summary) = done.expect("a program");
    summary.certified.then_some(text)
}

/// Whether a program fits wherever the knobs stand.
fn holds(machine: &Machine, program: &str) {
    for feed in SHARES {
        for rapid in [feed, 1.0, 0.3] {
            let knobs = [feed * machine.limits.feed_override_max, rapid, 1.0];
            let found = summary_of(&turned(machine, knobs), program);
            assert!(
                found.fits(),
                "feed {feed}, rapid {rapid}: {:?} {:?}\n{program}",
                found.unfit.first(),
                found.over_time
            );
        }
    }
}

/// Programs with exact stops that hold, of so many.
fn stops(seed: u64, programs: usize) -> usize {
    let mut found = 0;
    for number in 0..programs {
        let seed = seed + number as u64;
        let mut random = Random::new(!seed);
        let (controller, word) = [
            ("fanuc", "G9"),
            ("haas", "G9"),
            ("siemens", "G9"),
            ("isg", "G60"),
            ("okuma", "G9"),
        ][number % 5];
        let path = "rapid = \"linear\"";
        let free = machine(seed, controller, path, "peak_power_w = 1e6");
        let text = program(&mut random);
        let peak_w = summary_of(&free, &text).peak_w * random.within(0.3, 0.95);
        let ratings = format!("peak_power_w = {:.1}", peak_w.max(60.0));
        let limited_to = machine(seed, controller, path, &ratings);
        let allowed = Allowed {
            feed: true,
            stop: true,
            ..Allowed::NOTHING
        };
        if let Some(written) = limited(&limited_to, &text, allowed) {
            holds(&limited_to, &written);
            found += usize::from(written.contains(word));
        }
    }
    found
}

/// Programs with pauses that hold, of so many.
fn pauses(seed: u64, programs: usize) -> usize {
    let mut found = 0;
    for number in 0..programs {
        let seed = seed + number as u64;
        let mut random = Random::new(!seed);
        let controller = ["iso", "fanuc", "linuxcnc", "haas"][number % 4];
        let path = "mode = \"exact-stop\"\nrapid = \"linear\"";
        let open = "peak_power_w = 1e6\nregen_power_w = 1e6\ncontinuous_power_w = 1e5\nwindow_s = 20\n\
                    brake_power_w = 5\nbrake_energy_j = 1e9";
        let free = machine(seed, controller, path, open);
        let text = program(&mut random);
        let used = summary_of(&free, &text).over_time;
        let share = random.within(0.6, 0.98);
        let [mean_w, energy_j] = if random.once_in(2) {
            [used[0].rating.value * share, 1e9]
        } else {
            [1e5, used[1].rating.value * share]
        };
        if !(mean_w.is_finite() && energy_j.is_finite() && energy_j > 1e-3) {
            continue;
        }
        let ratings = format!(
            "peak_power_w = 1e6\nregen_power_w = 1e6\ncontinuous_power_w = {mean_w:.2}\nwindow_s = 20\n\
             brake_power_w = 5\nbrake_energy_j = {energy_j:.4}"
        );
        let limited_to = machine(seed, controller, path, &ratings);
        let allowed = Allowed {
            pause: true,
            ..Allowed::NOTHING
        };
        if let Some(written) = limited(&limited_to, &text, allowed) {
            holds(&limited_to, &written);
            found += usize::from(written.contains("\nG4 "));
        }
    }
    found
}

#[test]
fn stops_hold_at_any_override() {
    assert!(stops(1, 20) >= 3);
}

#[test]
fn pauses_hold_at_any_override() {
    assert!(pauses(1, 12) >= 2);
}

/// Some minutes.
#[test]
#[ignore = "many programs; run it after changes of stops, pauses or overrides"]
fn many_stops_and_pauses_hold_at_any_override() {
    let found = [stops(1000, 500), pauses(2000, 300)];
    eprintln!("{found:?}");
    assert!(found.iter().all(|found| *found > 50), "{found:?}");
}
