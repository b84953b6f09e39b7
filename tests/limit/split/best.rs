//! Where the shortest piece costs more than half a point, no choice of pieces costs less.
//!
//! 500 kg, 5 m/s² and 0.5 m/s without friction. In a piece of one acceleration the power is
//! largest at its end, P = m·a·v, so that the soonest pieces over a grid of speeds are a
//! shortest path: pieces that speed up, then one that brakes with 5 m/s², which feeds back.

use super::{HOW, limited};

use crate::machines::machine_from;

const MASS_KG: f64 = 500.0;
const ACCEL_M_S2: f64 = 5.0;
const SPEED_M_S: f64 = 0.5;
const GRID: usize = 240;

/// The time of a block in pieces that the control can use, or with as many as one likes;
/// `usable` of the duration in s, the way in m and the speed at the end in m/s.
fn soonest_s(way_m: f64, power_w: f64, usable: fn(f64, f64, f64) -> bool) -> f64 {
    let tops = (1..=100).map(|step| SPEED_M_S * f64::from(step) / 100.0);
    let lasts_s = tops.filter_map(|top| {
        let speed = |step: usize| top * step as f64 / GRID as f64;
        // Time beyond that of its way at the top speed, and the way itself.
        let mut soonest = vec![(0.0, 0.0)];
        for end in 1..=GRID {
            let pieces = (0..end).filter_map(|start| {
                let (from, to) = (speed(start), speed(end));
                let accel = ACCEL_M_S2.min(power_w / (MASS_KG * to));
                let (lasts_s, piece_m) =
                    ((to - from) / accel, (to * to - from * from) / (2.0 * accel));
                let (late_s, gone_m): (f64, f64) = soonest[start];
                usable(lasts_s, piece_m, to)
                    .then_some((late_s + lasts_s - piece_m / top, gone_m + piece_m))
            });
            let best = pieces.min_by(|a, b| a.0.total_cmp(&b.0));
            soonest.push(best.unwrap_or((f64::INFINITY, f64::INFINITY)));
        }
        let (late_s, gone_m) = soonest[GRID];
        let left_m = way_m - gone_m - top * top / (2.0 * ACCEL_M_S2);
        (left_m >= 0.0)
            .then(|| late_s + (way_m - top * top / (2.0 * ACCEL_M_S2)) / top + top / ACCEL_M_S2)
    });
    lasts_s.fold(f64::INFINITY, f64::min)
}

/// Points that a block loses against the physics, and those that the best pieces lose.
fn points(
    controller: &str,
    way_mm: f64,
    share: f64,
    usable: fn(f64, f64, f64) -> bool,
) -> [f64; 2] {
    let way_m = way_mm / 1000.0;
    let top = SPEED_M_S.min((ACCEL_M_S2 * way_m).sqrt());
    let power_w = share * MASS_KG * ACCEL_M_S2 * top;
    let text = format!(
        "schema = 1\nname = \"one\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = {power_w:?}\n[limits]\nmargin = 0\n[axes.X]\nkind = \"linear\"\n\
         rapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n"
    );
    let machine = machine_from(&text);
    let program = match controller {
        "isg" => format!("G0 X{way_mm}\nM30\n"),
        _ => format!("G0 X{way_mm} F200000\n"),
    };
    let (_, rows) = limited(&machine, HOW, &program);
    let lasts_s = rows[0].duration_after_s.expect("a block that is lowered");
    let free_s = soonest_s(way_m, f64::INFINITY, |_, _, _| true);
    let physical_s = soonest_s(way_m, power_w, |_, _, _| true);
    let best_s = soonest_s(way_m, power_w, usable);
    [lasts_s, best_s].map(|time_s| 100.0 * (time_s - physical_s) / free_s)
}

/// The ISG kernel's pieces last 5 ms. Marlin's are as long as their way at the speed at their
/// end lasts 20 ms, where the queue runs short of blocks: at most as fast is as good there.
#[test]
fn no_choice_of_pieces_loses_less() {
    let isg = |lasts_s: f64, _: f64, _: f64| lasts_s >= 0.005;
    let marlin = |_: f64, way_m: f64, to: f64| way_m >= 0.02 * to;
    for way_mm in [20.0, 40.0, 70.0] {
        for share in [0.9, 0.7, 0.5, 0.35] {
            let [lost, best] = points("isg", way_mm, share, isg);
            assert!(lost < best + 0.05, "isg {way_mm} {share}: {lost} {best}");
            let [lost, best] = points("marlin", way_mm, share, marlin);
            assert!(lost < best + 0.3, "marlin {way_mm} {share}: {lost} {best}");
        }
    }
    let [_, best] = points("isg", 20.0, 0.35, isg);
    assert!((0.55..0.65).contains(&best), "{best}");
}
