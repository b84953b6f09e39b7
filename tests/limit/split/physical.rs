//! What pieces lose against the physics: points are hundredths of the time without a limit.

use super::reference::Axes;
use super::{HOW, limited};
use crate::random::Random;
use crate::runs::rows_of;
use gwatt::machine::Machine;
use std::fmt::Write as _;

use crate::machines::machine_from;

const SHARES: [f64; 4] = [0.9, 0.7, 0.5, 0.35];

/// What blocks lose at most at each of the shares.
type Most = [f64; 4];
const HALF: Most = [0.5; 4];

/// A control, and how its programs begin a block and end.
#[derive(Clone, Copy)]
struct Control {
    name: &'static str,
    /// Words after the first block, and lines between blocks that let the axes stand.
    feed: &'static str,
    between: &'static str,
    end: &'static str,
}

const ISG: Control = Control {
    name: "isg",
    feed: "",
    between: "G4 X0.1\n",
    end: "M30\n",
};
const NCI: Control = Control {
    name: "twincat-nci",
    ..ISG
};
const REPRAP: Control = Control {
    name: "reprap",
    feed: " F200000",
    between: "",
    end: "",
};
const KLIPPER: Control = Control {
    name: "klipper",
    ..REPRAP
};
const MARLIN: Control = Control {
    name: "marlin",
    ..REPRAP
};

impl Control {
    fn machine(&self, axes: &Axes, limit_w: f64) -> Machine {
        let text = format!(
            "schema = 1\nname = \"any\"\ncontroller = \"{}\"\n[converter]\n\
             peak_power_w = {limit_w:?}\n[limits]\nmargin = 0\n{}",
            self.name,
            axes.text()
        );
        machine_from(&text)
    }

    fn axes(&self, random: &mut Random) -> Axes {
        Axes::any(random, self.name == "klipper")
    }

    /// Random blocks of one to three axes by themselves, from rest to rest.
    #[track_caller]
    fn loses_alone(&self, seed: u64, ways_mm: [f64; 2], most: Most, change: fn(&mut Machine)) {
        let mut random = Random(seed);
        let mut split = 0;
        for _ in 0..8 {
            let axes = self.axes(&mut random);
            let count = random.within(1.0, 3.999) as usize;
            let mut way_mm = [0.0; 3];
            let mut block = String::from("G0");
            for (letter, way_mm) in ["X", "Y", "Z"].iter().zip(&mut way_mm).take(count) {
                *way_mm = random.way_mm(ways_mm);
                let _ = write!(block, " {letter}{way_mm}");
            }
            let line = axes.line(way_mm);
            let free_s = line.soonest_s(f64::INFINITY);
            for (share, most) in SHARES.iter().zip(most) {
                let limit_w = share * line.peak_w();
                let mut machine = self.machine(&axes, limit_w);
                change(&mut machine);
                let program = format!("{block}{}\n{}", self.feed, self.end);
                let (text, rows) = limited(&machine, HOW, &program);
                let lasts_s = rows[0].duration_after_s.unwrap();
                let physical_s = line.soonest_s(limit_w);
                assert!(
                    lasts_s > physical_s * (1.0 - 1e-4),
                    "{lasts_s} {physical_s}"
                );
                let points = 100.0 * (lasts_s - physical_s) / free_s;
                let name = self.name;
                assert!(points < most, "{name} {share} {points} {free_s}\n{text}");
                split += usize::from(rows[0].action == "split");
                // The block is the last of its line, and nothing else is changed.
                let whole = format!("{block}{}\n", self.feed);
                assert!(text.contains(&whole), "{text}");
                for row in rows_of(&machine, &text) {
                    assert!(row.peak_w <= limit_w * (1.0 + 1e-9), "{}", row.peak_w);
                }
            }
        }
        assert!(split > 24, "{} {split}", self.name);
    }

    /// Four random lines with corners between them. What corners cost is in both times, with
    /// the limit and without.
    #[track_caller]
    fn loses_together(&self, seed: u64, most: Most) {
        let mut random = Random(seed);
        for _ in 0..6 {
            let axes = self.axes(&mut random);
            let (mut place, mut lines) = ([0.0_f64; 3], Vec::new());
            let mut program = String::new();
            for number in 0..4 {
                let before = place;
                let count = random.within(1.0, 2.999) as usize;
                // The next axis comes in with each line: all corners are sharp.
                let moving = (number..number + count).map(|axis| axis % 3);
                program.push_str("G0");
                for axis in moving {
                    let way_mm = random.way_mm([60.0, 600.0]);
                    let sign = if place[axis] < 300.0 { 1.0 } else { -1.0 };
                    place[axis] = ((place[axis] + sign * way_mm) * 1e3).round() / 1e3;
                    let _ = write!(program, " {}{}", ["X", "Y", "Z"][axis], place[axis]);
                }
                let feed = if number == 0 { self.feed } else { "" };
                let _ = write!(program, "{feed}\n{}", self.between);
                lines.push(axes.line(std::array::from_fn(|axis| place[axis] - before[axis])));
            }
            program.push_str(self.end);
            let peaks = lines.iter().map(super::reference::Line::peak_w);
            let peak_w = peaks.fold(0.0, f64::max);
            let soonest_s =
                |limit_w: f64| -> f64 { lines.iter().map(|line| line.soonest_s(limit_w)).sum() };
            for (share, most) in SHARES.iter().zip(most) {
                let limit_w = share * peak_w;
                let machine = self.machine(&axes, limit_w);
                let (text, rows) = limited(&machine, HOW, &program);
                let free_s: f64 = rows.iter().map(|row| row.duration_s).sum();
                let after = rows
                    .iter()
                    .map(|row| row.duration_after_s.unwrap_or(row.duration_s));
                let longer_s = after.sum::<f64>() - free_s;
                let physical_s = soonest_s(limit_w) - soonest_s(f64::INFINITY);
                let points = 100.0 * (longer_s - physical_s) / free_s;
                let name = self.name;
                assert!(points < most, "{name} {share} {points} {free_s}\n{text}");
            }
        }
    }
}

/// Random machines with one to three axes, friction and losses, at 90, 70, 50 and 35 % of
/// what the block draws: within half a point of the time that the physics permits, and at
/// no time more than the converter has.
#[test]
fn pieces_lose_less_than_half_a_point() {
    for control in [ISG, NCI, REPRAP, KLIPPER] {
        control.loses_alone(7, [30.0, 900.0], HALF, |_| ());
    }
}

/// No piece lasts less than 5 ms: where a block lasts for 0.2 s that costs more than half a
/// point at 35 %.
#[test]
fn short_blocks_lose_what_the_shortest_piece_costs() {
    let most = [0.5, 0.5, 0.5, 0.7];
    for control in [ISG, NCI, REPRAP, KLIPPER] {
        control.loses_alone(21, [40.0, 200.0], most, |_| ());
    }
}

/// Marlin's pieces last 20 ms at their own speed where one that it runs at a lower F would
/// not be caught up with. Without that rule they lose what others do.
#[test]
fn marlin_loses_what_its_short_queue_costs() {
    MARLIN.loses_alone(7, [30.0, 900.0], [0.5, 0.5, 0.5, 1.4], |_| ());
    MARLIN.loses_alone(21, [40.0, 200.0], [0.3, 0.7, 1.4, 5.1], |_| ());
    let full = |machine: &mut Machine| machine.controller.planner.shortest_at_feed_s = 0.0;
    MARLIN.loses_alone(7, [30.0, 900.0], [0.5, 0.5, 0.5, 0.6], full);
}

#[test]
fn pieces_of_several_lines_lose_no_more() {
    for control in [ISG, REPRAP, MARLIN] {
        control.loses_together(3, HALF);
    }
    // Next to others a line may reach more than the half of its hill that the reference has.
    KLIPPER.loses_together(3, [0.5, 0.5, 0.5, 0.9]);
}
