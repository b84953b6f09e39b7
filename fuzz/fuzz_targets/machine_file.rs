//! A machine file gives a machine with sane values, or says why not.
#![no_main]

use gwatt::machine::Machine;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Machine::from_toml("fuzz.toml", text) {
        Ok((machine, _)) => {
            assert!(!machine.converters.is_empty());
            for axis in machine.axes.iter().flatten() {
                assert!(axis.rapid_mm_s > 0.0 && axis.rapid_mm_s.is_finite());
                assert!(axis.accel_mm_s2 > 0.0 && axis.accel_mm_s2.is_finite());
                assert!(axis.mass_kg > 0.0 && axis.mass_kg.is_finite());
                assert!(axis.efficiency > 0.0 && axis.efficiency <= 1.0);
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty(), "no reason is given");
            for error in errors {
                let _ = error.render("fuzz.toml", false);
            }
        }
    }
});
