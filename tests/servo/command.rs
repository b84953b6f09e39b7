//! The commanded motion of a program, dense in time.

use std::io::{self, Cursor};

use gwatt::machine::Machine;
use gwatt::pipeline::{Options, SeriesSink, series};
use gwatt::power::Instant;

use super::drive::Wanted;

/// Axes that are simulated: X, Y and Z.
pub const SIMULATED: usize = 3;
/// Time after the last row: drives still follow.
const AFTER_S: f64 = 0.2;

/// What X, Y and Z are wanted to do, every `step_s`.
pub struct Command {
    pub step_s: f64,
    pub wanted: Vec<[Wanted; SIMULATED]>,
}

/// Times and speeds, m/s.
#[derive(Default)]
struct Rows(Vec<(f64, [f64; SIMULATED])>);

impl SeriesSink for Rows {
    fn row(&mut self, time_s: f64, _: u64, instant: &Instant) -> io::Result<()> {
        let speeds = [0, 1, 2].map(|axis| instant.axes[axis].velocity_mm_s * 1e-3);
        self.0.push((time_s, speeds));
        Ok(())
    }
}

impl Command {
    /// That of a program; speeds are straight between the rows of its series.
    pub fn of(machine: &Machine, program: &[u8], step_s: f64) -> Self {
        let mut rows = Rows::default();
        let options = Options::default();
        let note = series(Cursor::new(program), machine, &options, 1e-3, &mut rows);
        assert!(matches!(note, Ok(None)), "{note:?}");
        let rows = rows.0;
        let mut wanted = Vec::new();
        let mut places = [0.0; SIMULATED];
        for pair in rows.windows(2) {
            let ((from_s, from), (to_s, to)) = (pair[0], pair[1]);
            let length_s = to_s - from_s;
            if length_s <= 0.0 {
                continue;
            }
            let slopes = [0, 1, 2].map(|axis| (to[axis] - from[axis]) / length_s);
            while (wanted.len() as f64) * step_s < to_s {
                let t = wanted.len() as f64 * step_s - from_s;
                wanted.push([0, 1, 2].map(|axis| {
                    let (v, a) = (from[axis], slopes[axis]);
                    [places[axis] + v * t + 0.5 * a * t * t, v + a * t, a]
                }));
            }
            for axis in 0..SIMULATED {
                places[axis] += 0.5 * (from[axis] + to[axis]) * length_s;
            }
        }
        let rest = places.map(|place| [place, 0.0, 0.0]);
        wanted.extend(std::iter::repeat_n(rest, (AFTER_S / step_s) as usize));
        Self { step_s, wanted }
    }
}
