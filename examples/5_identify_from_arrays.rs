//! Finds mass and friction of an axis in arrays of force and speed.
//!
//! `cargo run --example 5_identify_from_arrays`

use std::error::Error;
use std::f64::consts::TAU;

use gwatt::identify::rigid::{Friction, fit};
use gwatt::identify::{Kind, Quantity, Recording, Signal};

const PERIOD_S: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    // An axis of 200 kg with 300 N/(m/s) and 80 N of friction, moved to and fro.
    let (mass_kg, viscous, coulomb_n) = (200.0, 300.0, 80.0);
    let (mut force, mut speed) = (Vec::new(), Vec::new());
    for sample in 0..8000 {
        let t = f64::from(sample) * PERIOD_S;
        let v = 0.3 * libm::sin(TAU * 0.5 * t) + 0.1 * libm::sin(TAU * 1.7 * t);
        let a =
            0.3 * TAU * 0.5 * libm::cos(TAU * 0.5 * t) + 0.1 * TAU * 1.7 * libm::cos(TAU * 1.7 * t);
        speed.push(v);
        force.push(mass_kg * a + viscous * v + coulomb_n * v.signum());
    }
    let signal = |name: &str, quantity, values| Signal {
        name: name.to_owned(),
        quantity,
        kind: Kind::Linear,
        values,
    };
    let recording = Recording {
        period_s: PERIOD_S,
        signals: vec![
            signal("force", Quantity::Force, force),
            signal("speed", Quantity::Velocity, speed),
        ],
        ignored: Vec::new(),
        notes: Vec::new(),
    };
    let axis = fit(&recording, Friction::Symmetric, None)?;
    println!("mass {:.2} ± {:.2} kg", axis.mass.value, axis.mass.std);
    if let (Some(viscous), Some(coulomb)) = (axis.viscous, axis.coulomb) {
        println!("viscous friction {:.1} N/(m/s)", viscous.value);
        println!("Coulomb friction {:.1} N", coulomb.value);
    }
    Ok(())
}
