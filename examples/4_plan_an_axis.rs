//! Plans one move of an axis, and prints position, speed and acceleration over time.
//!
//! `cargo run --example 4_plan_an_axis`

use gwatt::pipeline::Options;
use gwatt::plan::{Overrides, Trajectory, plan};
use gwatt::{Error, Machine, Moves};

const SAMPLES: u32 = 20;

fn main() -> Result<(), Error> {
    let (machine, _warnings) = Machine::load("three-axis")?;
    for mv in Moves::of("G21 G90 G0 X400\nM30\n", &machine, &Options::default()) {
        let mv = mv?;
        let [largest, _] = Overrides::of(&machine);
        let plan = plan(&machine, &mv, largest);
        println!("{:.1} mm in {:.3} s", mv.length_mm, plan.duration_s);
        let Trajectory::Path(profile) = plan.trajectory else {
            continue;
        };
        for sample in 0..=SAMPLES {
            let t = plan.duration_s * f64::from(sample) / f64::from(SAMPLES);
            let Some(state) = profile.state_at(t) else {
                continue;
            };
            println!(
                "{t:7.3} s {:8.2} mm {:8.2} mm/s {:9.1} mm/s²",
                state.position_mm, state.velocity_mm_s, state.accel_mm_s2
            );
        }
    }
    Ok(())
}
