//! Random programs on random machines: what `limit` promises, compared with an
//! own reader and own formulas.

use super::reader::{Move, read};
use super::{RIG, Rig, Run, run};
use gwatt::machine::Machine;
use gwatt::pipeline::{Strategy as How, analyze};
use proptest::prelude::*;
use std::fmt::Write as _;

use crate::machines::{linear_axes, machine_from};

/// One block of a random program; numbers in hundredths of the unit.
#[derive(Debug, Clone)]
enum Block {
    /// G0 or G1 to a place, either axis or both, with or without F.
    Line {
        rapid: bool,
        x: Option<i32>,
        y: Option<i32>,
        feed: Option<u16>,
        modal: bool,
    },
    /// A half circle along X.
    Arc {
        radius: i32,
        clockwise: bool,
    },
    Dwell(u8),
    Feed(u16),
}

#[derive(Debug, Clone, Copy)]
struct Style {
    packed: bool,
    lower: bool,
    numbers: bool,
    inch: bool,
    relative: bool,
    end: usize,
    line_end: usize,
    last: bool,
    comments: bool,
}

const LINE_ENDS: [&str; 3] = ["\n", "\r\n", "\r"];
const ENDS: [&str; 3] = ["", "M30", "M2"];

fn block() -> impl Strategy<Value = Block> {
    let place = || prop::option::of(-40_000..40_000_i32);
    let feed = || prop::option::weighted(0.3, 1..30_000_u16);
    prop_oneof![
        8 => (any::<bool>(), place(), place(), feed(), any::<bool>()).prop_map(
            |(rapid, x, y, feed, modal)| Block::Line { rapid, x, y, feed, modal }
        ),
        1 => (1..20_000_i32, any::<bool>())
            .prop_map(|(radius, clockwise)| Block::Arc { radius, clockwise }),
        1 => (0..9_u8).prop_map(Block::Dwell),
        1 => (1..30_000_u16).prop_map(Block::Feed),
    ]
}

prop_compose! {
    fn style()(flags in prop::array::uniform7(any::<bool>()), end in 0..3_usize, line_end in 0..3_usize) -> Style {
        let [packed, lower, numbers, inch, relative, last, comments] = flags;
        Style { packed, lower, numbers, inch, relative, end, line_end, last, comments }
    }
}

/// The text of a program.
fn text(blocks: &[Block], style: Style) -> String {
    let mut lines = Vec::new();
    let units = if style.inch { "G20" } else { "G21" };
    let distance = if style.relative { "G91" } else { "G90" };
    // LinuxCNC reads an F next to G20 in the unit before.
    lines.push(vec![units.to_owned()]);
    lines.push(vec![distance.to_owned()]);
    lines.push(vec!["F500".to_owned()]);
    let mut motion = "";
    let mut x = 0;
    let number = |hundredths: i32| format!("{:.2}", f64::from(hundredths) / 100.0);
    for block in blocks {
        let mut words = Vec::new();
        match block {
            Block::Line {
                rapid,
                x: to_x,
                y,
                feed,
                modal,
            } => {
                let word = if *rapid { "G0" } else { "G1" };
                if !modal || word != motion {
                    words.push(word.to_owned());
                }
                motion = word;
                if let Some(to) = to_x {
                    words.push(format!("X{}", number(*to)));
                    x = if style.relative { x + to } else { *to };
                }
                words.extend(y.map(|y| format!("Y{}", number(y))));
                words.extend(feed.map(|feed| format!("F{feed}")));
            }
            Block::Arc { radius, clockwise } => {
                motion = if *clockwise { "G2" } else { "G3" };
                let end = if style.relative { 0 } else { x } + 2 * radius;
                x += 2 * radius;
                words.push(motion.to_owned());
                words.push(format!("X{}", number(end)));
                words.push(format!("I{}", number(*radius)));
            }
            Block::Dwell(seconds) => words.extend(["G4".to_owned(), format!("P{seconds}")]),
            Block::Feed(feed) => words.push(format!("F{feed}.")),
        }
        lines.push(words);
    }
    let mut program = String::new();
    lines.push(vec![ENDS[style.end].to_owned()]);
    for (index, words) in lines.iter().enumerate() {
        let mut line = words.join(if style.packed { "" } else { " " });
        if style.numbers && !line.is_empty() {
            line = format!("N{} {line}", 10 * (index + 1));
        }
        if style.lower {
            line = line.to_ascii_lowercase();
        }
        if style.comments && index % 3 == 1 {
            line.push_str(" (G0 X1 F1)");
        }
        let last = index + 1 == lines.len();
        let end = if last && !style.last {
            ""
        } else {
            LINE_ENDS[style.line_end]
        };
        write!(program, "{line}{end}").expect("memory");
    }
    program
}

/// X and Y with masses and friction, and nothing that makes power curved.
#[derive(Debug, Clone, Copy)]
struct Drives {
    mass: [f64; 2],
    coulomb: [f64; 2],
    rapid_mm_min: [f64; 2],
    accel: [f64; 2],
    peak_w: f64,
}

prop_compose! {
    fn drives()(
        mass in prop::array::uniform2(20.0..900.0),
        coulomb in prop::array::uniform2(0.0..800.0),
        rapid in prop::array::uniform2(6000..48_000),
        accel in prop::array::uniform2(500..9800),
        share in 0.1..1.2_f64,
    ) -> Drives {
        let rapid_mm_min = rapid.map(f64::from);
        let accel = accel.map(f64::from);
        let full: f64 = (0..2)
            .map(|n| rapid_mm_min[n] / 6e4 * (mass[n] * accel[n] / 1e3 + coulomb[n]))
            .sum();
        Drives { mass, coulomb, rapid_mm_min, accel, peak_w: full * share }
    }
}

impl Drives {
    fn machine(&self, controller: &str) -> Machine {
        let axis = |n: usize, letter| {
            linear_axes(
                letter,
                [self.rapid_mm_min[n], self.accel[n], self.mass[n]],
                &format!("coulomb_n = {:?}", self.coulomb[n]),
            )
        };
        machine_from(&format!(
            "schema = 1\nname = \"random\"\ncontroller = \"{controller}\"\n[converter]\n\
             peak_power_w = {:?}\n[path]\nmode = \"exact-stop\"\n[limits]\nmargin = 0\n{}{}",
            self.peak_w,
            axis(0, "X"),
            axis(1, "Y")
        ))
    }

    /// `J = Σ m u²`, `D = Σ Fc |u|` in SI, and the caps of speed and
    /// acceleration in m/s and m/s² along a straight path.
    fn path(&self, mv: &Move) -> (f64, f64, f64, f64) {
        let (mut j, mut d, mut v, mut a) = (0.0, 0.0, f64::INFINITY, f64::INFINITY);
        for n in 0..2 {
            let u = (mv.end[n] - mv.start[n]).abs() / mv.length();
            j += self.mass[n] * u * u;
            d += self.coulomb[n] * u;
            v = v.min(self.rapid_mm_min[n] / 6e4 / u);
            a = a.min(self.accel[n] / 1e3 / u);
        }
        (j, d, v, a)
    }

    /// Peak in W and time in s of a straight move with its feed.
    fn judge(&self, mv: &Move) -> (f64, f64) {
        let (j, d, v, a) = self.path(mv);
        let v = mv.feed.map_or(v, |feed| v.min(feed / 6e4));
        let length = mv.length() / 1e3;
        let top = v.min((a * length).sqrt());
        (top * (j * a + d), length / top + top / a)
    }
}

/// What holds for every certified program.
fn holds(drives: &Drives, machine: &Machine, how: Run, before: &str, after: &str) {
    let (old, new) = (read(before), read(after));
    assert_eq!(old.len(), new.len());
    let (mut time, mut best) = (0.0, 0.0);
    for (old, new) in old.iter().zip(&new) {
        assert_eq!(old.path(), new.path());
        if new.dwell.is_some() || new.arc.is_some() || new.length() < 1e-6 {
            let rises = new
                .feed
                .zip(old.feed)
                .is_some_and(|(new, old)| new > old * (1.0 + 1e-9));
            assert!(!rises, "{old:?} {new:?}");
            continue;
        }
        let (j, d, v, a) = drives.path(old);
        let was = old.feed.map_or(v, |feed| v.min(feed / 6e4));
        let is = new.feed.map_or(v, |feed| v.min(feed / 6e4));
        assert!(is <= was * (1.0 + 1e-9), "{old:?} {new:?}");
        if drives.judge(old).0 <= drives.peak_w * (1.0 - 1e-9) {
            assert_eq!(old.feed.is_none(), new.feed.is_none());
            assert!((is - was).abs() <= 1e-9 * was, "{old:?} {new:?}");
        }
        let (peak, seconds) = drives.judge(new);
        assert!(peak <= drives.peak_w * (1.0 + 1e-6), "{peak} {new:?}");
        // The exact speed: v = min(cap, √(a·L), limit/(J·a + D)).
        let length = old.length() / 1e3;
        let speed = was
            .min((a * length).sqrt())
            .min(drives.peak_w / (j * a + d));
        time += seconds;
        best += length / speed + speed / a;
    }
    assert!(time <= best * 1.001, "{time} s instead of {best} s");
    let options = super::options(how);
    let summary = analyze(std::io::Cursor::new(after), machine, &options, None).expect("a program");
    assert!(summary.fits());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn by_speed(
        blocks in prop::collection::vec(block(), 1..40),
        style in style(),
        drives in drives(),
        controller in prop::sample::select(vec!["iso", "linuxcnc"]),
    ) {
        let machine = drives.machine(controller);
        let program = text(&blocks, style);
        let how = Rig { ..RIG }.strategy(How::Speed).options;
        let (limited, summary) = run(&machine, how, program.as_bytes()).expect("a program");
        prop_assert!(summary.certified, "{:?}\n{}", summary.reasons, program);
        let limited = String::from_utf8(limited).expect("text");
        holds(&drives, &machine, how, &program, &limited);
        // The same again, and in two threads.
        let (again, summary) = run(&machine, how, limited.as_bytes()).expect("a program");
        prop_assert_eq!((again, summary.edited_lines), (limited.clone().into_bytes(), 0));
        let threads = Run { threads: 2, ..how };
        let (threaded, _) = run(&machine, threads, program.as_bytes()).expect("a program");
        prop_assert_eq!(threaded, limited.into_bytes());
    }

    /// Whatever is asked for: no program is delivered that does not fit, and
    /// no reason is a fault of the program that writes.
    #[test]
    fn by_everything(
        blocks in prop::collection::vec(block(), 1..30),
        style in style(),
        drives in drives(),
        controller in prop::sample::select(vec!["iso", "isg", "marlin", "linuxcnc", "grbl"]),
        strategy in prop::sample::select(vec![How::Optimal, How::Speed]),
        flags in prop::array::uniform3(any::<bool>()),
    ) {
        let [allow_feed, robust, patent] = flags;
        let machine = drives.machine(controller);
        let mut program = text(&blocks, style);
        if controller == "marlin" {
            // Words in parentheses are refused there.
            program = program.replace(" (G0 X1 F1)", "");
        }
        if controller == "isg" {
            // Dwells are named by X there, units by other words.
            program = program.to_ascii_uppercase().replace("G20", "G71").replace("G21", "G71");
            program = program.replace("G4 P", "G4 X").replace("G4P", "G4X").replace("G71", "G90");
            program = program.replace("G90 G91", "G91").replace("G90G91", "G91");
            program = program.replace("G90 G90", "G90").replace("G90G90", "G90");
        }
        let law = if patent && strategy == How::Speed {
            gwatt::pipeline::Law::Patent
        } else {
            gwatt::pipeline::Law::Exact
        };
        let how = Run { strategy, law, allow_feed, robust, ..RIG.options };
        let (limited, summary) = run(&machine, how, program.as_bytes()).expect("a program");
        let faults = ["changed-motion", "changed-sequence", "went-up", "changed-feed", "unreadable-output", "edit"];
        for reason in &summary.reasons {
            prop_assert!(!faults.contains(&reason.rule), "{reason:?}\n{program}");
        }
        if summary.certified {
            let options = super::options(how);
            let after = analyze(std::io::Cursor::new(&limited), &machine, &options, None).expect("a program");
            prop_assert!(after.fits());
            prop_assert_eq!(after.moves, summary.before.moves);
        }
    }
}
