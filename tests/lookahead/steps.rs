//! Steps of speed at the joints of polylines: what they draw and feed back.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::io::{self, Cursor};

use super::glide::{judged, judged_for};
use super::machine;
use crate::random::Dice;
use gwatt::machine::{AXES, CornerRule, LookAhead, Machine};
use gwatt::pipeline::{Options, SeriesSink, series};
use gwatt::power::{Instant, Want};

use crate::machines::machine_from;
use crate::near::assert_near;

/// Corners are passed at any speed.
const FREE: LookAhead = LookAhead {
    blocks_at_most: None,
    corner: CornerRule::SpeedStep {
        step_mm_s: [f64::INFINITY; AXES],
        same_kind_only: false,
    },
    blocks: None,
    path_accel_mm_s2: f64::INFINITY,
    min_cruise_ratio: 0.0,
    chords: None,
};

/// Three axes of 100 kg and 1000 mm/s² that pass corners at any speed.
fn free(response_s: f64) -> Machine {
    let mut machine = machine("grbl", 1000.0, 1000.0);
    machine.controller.planner.look_ahead = Some(FREE);
    machine.path.response_time_s = response_s;
    machine
}

/// The largest power that is drawn and fed back, W, and the energy, J.
fn totals(machine: &Machine, program: &str) -> [f64; 3] {
    let judged = judged_for(machine, program, Want::ALL);
    judged.iter().fold([0.0; 3], |sums, (_, judged)| {
        let demand = &judged.demand;
        [
            sums[0].max(demand.peak_w),
            sums[1].max(demand.regen_w),
            sums[2] + demand.energy_j,
        ]
    })
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert_near(found, expected, 1e-9 * expected.abs().max(1.0));
}

const CORNER: &str = "G21 G90 G64\nG1 X100 F6000\nG1 Y100\nM2\n";

/// At 100 mm/s Y has 100 kg·(0.1 m/s / 10 ms) · 0.1 m/s at the end of the mean, X feeds
/// as much back at its beginning; the path itself takes 100 kg · 1 m/s² · 0.1 m/s.
#[test]
fn a_corner_by_hand() {
    let [drawn_w, fed_back_w, energy_j] = totals(&free(0.01), CORNER);
    near(drawn_w, 100.0);
    near(fed_back_w, 100.0);
    // Up to the speed in X, and in Y: ½·100 kg·(0.1 m/s)² each.
    near(energy_j, 1.0);
    let [drawn_w, fed_back_w, _] = totals(&free(0.02), CORNER);
    near(drawn_w, 50.0);
    near(fed_back_w, 50.0);
}

/// Back and forth: X comes to rest in the middle of the mean.
#[test]
fn a_reversal_by_hand() {
    let program = "G21 G90 G64\nG1 X100 F6000\nG1 X0\nM2\n";
    let [drawn_w, fed_back_w, energy_j] = totals(&free(0.01), program);
    near(drawn_w, 200.0);
    near(fed_back_w, 200.0);
    near(energy_j, 1.0);
}

#[test]
fn both_sides_of_a_corner_are_charged() {
    let judged = judged(&free(0.01), CORNER, f64::NEG_INFINITY, true);
    let peaks: Vec<f64> = judged.iter().map(|(_, it)| it.demand.peak_w).collect();
    near(peaks[0], 100.0);
    near(peaks[1], 100.0);
}

#[test]
fn a_straight_joint_asks_for_nothing() {
    let whole = totals(&free(0.01), "G21 G90 G64\nG1 X30 Y40 F6000\nM2\n");
    let parts = "G21 G90 G64\nG1 X9 Y12 F6000\nG1 X18 Y24\nG1 X30 Y40\nM2\n";
    let parts = totals(&free(0.01), parts);
    for (whole, parts) in whole.into_iter().zip(parts) {
        near(parts, whole);
    }
}

/// Two steps of 30 degrees, further apart than the response and less than twice: the
/// mean from one to the other counts.
#[test]
fn a_mean_may_last_longer() {
    let (v, apart_s) = (0.1, 0.011);
    let heading = |degrees: f64| libm::sincos(degrees * PI / 180.0);
    let ([s1, c1], [s2, c2]) = (
        <[f64; 2]>::from(heading(30.0)),
        <[f64; 2]>::from(heading(60.0)),
    );
    let length = v * apart_s * 1e3;
    let [x, y] = [100.0 + length * c1, length * s1];
    let program = format!(
        "G21 G90 G64\nG1 X100 F6000\nG1 X{x:.9} Y{y:.9}\nG1 X{:.9} Y{:.9}\nM2\n",
        x + 100.0 * c2,
        y + 100.0 * s2
    );
    let [drawn_w, ..] = totals(&free(0.01), &program);
    // Y over 11 ms; and by the second step alone over 10 ms, as fast as it is then.
    let longer_w = 100.0 * (v * s2 / apart_s) * (v * s1);
    let own_w = 100.0 * (v * (s2 - s1) / 0.01) * (v * s2);
    assert!(longer_w > 1.1 * own_w);
    assert!(
        (drawn_w / longer_w - 1.0).abs() < 1e-5,
        "{drawn_w} {longer_w}"
    );
}

/// The printer's bed weighs six times its head.
fn printer() -> Machine {
    let text = include_str!("../../machine-configs/printer.toml");
    machine_from(text)
}

/// A circle with a radius of 30 mm at 500 mm/s, as chords of so many degrees.
fn circle(degrees: f64) -> String {
    let mut program = "G21\nG90\nG92 X0 Y100\nG1 X100 Y100 F30000\n".to_owned();
    let count = 360.0 / degrees;
    let mut turned = 0.0;
    while turned < count {
        turned += 1.0;
        let (sin, cos) = libm::sincos(turned * degrees / 360.0 * TAU);
        let (x, y) = (100.0 + 30.0 * sin, 130.0 - 30.0 * cos);
        let _ = writeln!(program, "G1 X{x:.4} Y{y:.4}");
    }
    program
}

/// A polyline is a curve to the drives, and an arc the polyline that the firmware makes of it:
/// 89.3 W as a curve, and 10 ms take in six of its joints in place of 5.01.
#[test]
fn a_circle_of_chords_is_a_circle() {
    let arc = "G21\nG90\nG92 X0 Y100\nG1 X100 Y100 F30000\nG3 X100 Y100 I0 J30\n";
    let [arc_w, arc_regen_w, arc_j] = totals(&printer(), arc);
    assert!((arc_w - 99.3).abs() < 0.05, "{arc_w}");
    // Speed rises and falls within shorter chords.
    for degrees in [2.0, 3.0] {
        let [chords_w, regen_w, chords_j] = totals(&printer(), &circle(degrees));
        assert!((1.0..1.05).contains(&(chords_w / arc_w)), "{chords_w}");
        // Means over the drives' response are below an arc's shortest peaks.
        assert!((0.88..1.6).contains(&(regen_w / arc_regen_w)), "{regen_w}");
        // What brakes is not taken off the friction.
        assert!(
            (0.99..1.15).contains(&(chords_j / arc_j)),
            "{chords_j} {arc_j}"
        );
    }
}

/// A machine of X, Y and Z under a controller.
struct Axes {
    machine: Machine,
    mass_kg: [f64; 3],
    coulomb_n: [f64; 3],
    efficiency: f64,
}

impl Axes {
    fn any(random: &mut Dice, controller: &str) -> Self {
        let mass_kg = [(); 3].map(|()| libm::pow(10.0, random.within(0.0, 2.0)));
        let coulomb_n = [(); 3].map(|()| random.within(0.0, 20.0));
        let efficiency = random.within(0.6, 1.0);
        let mut text = format!(
            "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
             peak_power_w = 1e6\nregen_power_w = 1e6\n"
        );
        for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            let _ = write!(
                text,
                "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = 30000\n\
                 accel_mm_s2 = {:?}\nmass_kg = {:?}\ncoulomb_n = {:?}\nefficiency = {efficiency:?}\n",
                random.within(500.0, 10_000.0),
                mass_kg[axis],
                coulomb_n[axis]
            );
        }
        let machine = machine_from(&text);
        Self {
            machine,
            mass_kg,
            coulomb_n,
            efficiency,
        }
    }

    /// What is drawn and fed back at these speeds and accelerations, m/s and m/s².
    fn power_w(&self, motion: &[[f64; 2]; 3]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (axis, [v, a]) in motion.iter().enumerate() {
            let power = v * self.mass_kg[axis] * a + v.abs() * self.coulomb_n[axis];
            sums[0] += power.max(0.0) / self.efficiency;
            sums[1] += (-power).max(0.0) * self.efficiency;
        }
        sums
    }
}

/// A row of curves with corners between.
fn curvy(random: &mut Dice, lines: usize) -> String {
    let (mut x, mut y) = (random.within(1.0, 60.0), 0.0);
    let mut feed = random.within(4000.0, 30_000.0);
    let mut program = format!("G21\nG90\nG1 X{x:.4} F{feed:.0}\n");
    let (mut heading, mut radius, mut chord) =
        (0.0, 20.0, libm::pow(10.0, random.within(-0.7, 0.4)));
    let corners = random.unit();
    for _ in 0..lines {
        if random.unit() < 0.03 {
            radius = libm::pow(10.0, random.within(0.5, 1.8)) * (random.unit() - 0.5).signum();
        }
        if random.unit() < 0.03 * corners {
            heading += random.within(-2.0, 2.0);
            chord = libm::pow(10.0, random.within(-0.7, 0.8));
        }
        if random.unit() < 0.02 {
            feed = random.within(4000.0, 30_000.0);
        }
        heading += chord / radius;
        let (sin, cos) = libm::sincos(heading);
        (x, y) = (x + chord * cos, y + chord * sin);
        let _ = writeln!(program, "G1 X{x:.4} Y{y:.4} F{feed:.0}");
    }
    program
}

/// Time, and speed and place of the axes.
type Row = (f64, [[f64; 2]; 3]);

#[derive(Default)]
struct Rows(Vec<Row>);

impl SeriesSink for Rows {
    fn row(&mut self, time_s: f64, _: u64, instant: &Instant) -> io::Result<()> {
        let before = self.0.last().copied();
        let (last_s, last) = before.unwrap_or((time_s, [[0.0; 2]; 3]));
        let mut motion = [[0.0; 2]; 3];
        for (axis, [v, x]) in motion.iter_mut().enumerate() {
            *v = instant.axes[axis].velocity_mm_s * 1e-3;
            *x = last[axis][1] + 0.5 * (*v + last[axis][0]) * (time_s - last_s);
        }
        self.0.push((time_s, motion));
        Ok(())
    }
}

impl Rows {
    /// Speed and place of the axes just before or just after an instant.
    fn at(&self, t: f64, after: bool) -> [[f64; 2]; 3] {
        let rows = &self.0;
        let index = if after {
            rows.partition_point(|row| row.0 <= t)
        } else {
            rows.partition_point(|row| row.0 < t)
        };
        let next = rows.get(index);
        let last = index.checked_sub(1).and_then(|index| rows.get(index));
        let (Some((from_s, from)), Some((to_s, to))) = (last, next) else {
            let nearest = last.or(next).expect("a row");
            return nearest.1.map(|[_, x]| [0.0, x]);
        };
        let share = (t - from_s) / (to_s - from_s);
        [0, 1, 2].map(|axis| {
            let [v, x] = from[axis];
            let now = v + (to[axis][0] - v) * share;
            [now, x + 0.5 * (v + now) * (t - from_s)]
        })
    }

    /// The largest power of the means over a time.
    fn smoothed_w(&self, axes: &Axes, over_s: f64) -> [f64; 2] {
        let starts = self.0.iter().map(|row| row.0);
        let ends = self.0.iter().map(|row| row.0 + over_s);
        let mut most = [0.0_f64; 2];
        for t in starts.chain(ends) {
            for after in [false, true] {
                let [from, to] = [self.at(t - over_s, after), self.at(t, after)];
                let mean = [0, 1, 2].map(|axis| {
                    let change = |i: usize| (to[axis][i] - from[axis][i]) / over_s;
                    [change(1), change(0)]
                });
                let power = axes.power_w(&mean);
                most = [most[0].max(power[0]), most[1].max(power[1])];
            }
        }
        most
    }
}

/// No mean over 10 to 40 ms of the planned speeds exceeds the reported peaks. Gives the
/// reported peaks by the largest of plan and means, and in how many programs the plan
/// alone would have been too low.
fn compare(seed: u64, programs: usize, lines: usize) -> (Vec<f64>, usize) {
    let mut random = Dice(seed);
    let (mut ratios, mut low) = (Vec::new(), 0);
    for number in 0..programs {
        let controller = ["grbl", "marlin", "reprap", "klipper"][number % 4];
        let axes = Axes::any(&mut random, controller);
        let program = curvy(&mut random, lines);
        let [drawn_w, fed_back_w, _] = totals(&axes.machine, &program);
        let mut rows = Rows::default();
        let options = Options::default();
        series(
            Cursor::new(&program),
            &axes.machine,
            &options,
            1e3,
            &mut rows,
        )
        .expect("a series");
        let mut planned = axes.machine.clone();
        planned.path.response_time_s = 1e9;
        let [own_w, own_regen_w, _] = totals(&planned, &program);
        let mut most = [own_w, own_regen_w];
        for over_ms in [10.0, 12.5, 15.0, 20.0, 30.0, 40.0] {
            let smoothed = rows.smoothed_w(&axes, over_ms * 1e-3);
            for (smoothed, reported) in smoothed.into_iter().zip([drawn_w, fed_back_w]) {
                assert!(
                    smoothed <= reported * (1.0 + 1e-6) + 1e-9,
                    "{controller} {number}, {over_ms} ms: {smoothed} {reported} in\n{program}"
                );
            }
            most = [most[0].max(smoothed[0]), most[1].max(smoothed[1])];
        }
        low += usize::from(most[0] > own_w * (1.0 + 1e-6) || most[1] > own_regen_w * (1.0 + 1e-6));
        ratios.push(drawn_w / most[0]);
    }
    ratios.sort_by(f64::total_cmp);
    (ratios, low)
}

#[test]
fn no_mean_of_the_planned_speeds_exceeds_the_peak() {
    let (ratios, low) = compare(3, 24, 80);
    assert!(low >= 4, "{low}");
    // Close in the median, and nowhere far off.
    assert!(ratios[ratios.len() / 2] < 1.02, "{ratios:?}");
    assert!(ratios[ratios.len() - 1] < 1.3, "{ratios:?}");
}

#[test]
#[ignore = "200 programs: some minutes"]
fn no_mean_of_many_planned_speeds_exceeds_the_peak() {
    let (ratios, low) = compare(1, 200, 200);
    println!("median {}, worst {}", ratios[100], ratios[199]);
    assert!(low >= 20, "{low}");
}

/// Steps that matter are found the same way where the planner is not asked.
#[test]
fn steps_are_found_where_the_motion_glides() {
    let mut program = "G21 G90\nG1 X1 F3000\n".to_owned();
    for step in 0..400 {
        let (sin, cos) = libm::sincos(0.05 * f64::from(step));
        let _ = writeln!(
            program,
            "G1 X{:.5} Y{:.5}",
            1.0 + 10.0 * sin,
            10.0 - 10.0 * cos
        );
    }
    let machine = machine("grbl", 500.0, 2000.0);
    let exact = judged(&machine, &program, f64::NEG_INFINITY, true);
    let mut raised = 0;
    for floor_w in [0.0, 1.0, 2.0, 3.0] {
        let quick = judged(&machine, &program, floor_w, false);
        for ((_, quick), (_, exact)) in quick.iter().zip(&exact) {
            let most = |peak_w: f64| peak_w.max(floor_w);
            near(most(quick.demand.peak_w), most(exact.demand.peak_w));
            near(most(quick.demand.regen_w), most(exact.demand.regen_w));
            raised += usize::from(quick.accel_mm_s2 == 0.0 && quick.demand.peak_w > floor_w);
        }
    }
    assert!(raised > 0, "{raised}");
}
