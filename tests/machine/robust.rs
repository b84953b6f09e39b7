//! No text makes the reader panic, and nothing is refused without a reason.

use gwatt::diagnostic::Severity;
use gwatt::machine::{Controller, Machine, builtin};
use proptest::prelude::*;

fn read(text: &str) {
    if let Err(errors) = Machine::from_toml("x.toml", text) {
        assert!(
            errors.iter().any(|d| d.severity == Severity::Error),
            "{text}"
        );
    } else if let Ok((machine, _)) = Machine::from_toml("x.toml", text) {
        for axis in machine.axis_set.iter() {
            let axis = machine.axes[axis].expect("an axis of the set");
            assert!(axis.mass_kg.is_finite() && axis.mass_kg > 0.0);
            assert!(axis.rapid_mm_s.is_finite() && axis.rapid_mm_s > 0.0);
            assert!(axis.accel_mm_s2.is_finite() && axis.accel_mm_s2 > 0.0);
        }
        assert!(!machine.converters.is_empty() && !machine.axis_set.is_empty());
    }
    if let Err(errors) = Controller::from_toml(text) {
        assert!(
            errors.iter().any(|d| d.severity == Severity::Error),
            "{text}"
        );
    }
}

/// A built-in file, machine or profile.
fn file() -> impl Strategy<Value = &'static str> {
    let texts: Vec<&'static str> = builtin::machines()
        .iter()
        .chain(builtin::controllers())
        .map(|file| file.text)
        .collect();
    prop::sample::select(texts)
}

/// What is put in place of a piece.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        prop::sample::select(vec![
            "=",
            "[",
            "]",
            "[[",
            "{",
            "}",
            "\"",
            "'",
            "\n",
            "0",
            "-1",
            "1e999",
            "-1e308",
            "1e-320",
            "nan",
            "inf",
            "true",
            "99999999999999999999",
            "0xffffffffffffffff",
            "1979-05-27",
            "axes",
            "converter",
            "[axes.X]\n",
            "[converter]\n",
            "[[converter]]\n",
            "axes.X = 1\n",
            "schema.x = 1\n",
            "µ",
            "\0",
        ])
        .prop_map(str::to_owned),
        ".{0,8}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn mutated_files(text in file(), edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..12, piece()), 1..4)) {
        let mut chars: Vec<char> = text.chars().collect();
        for (place, length, piece) in edits {
            let start = place.index(chars.len() + 1);
            let end = (start + length).min(chars.len());
            chars.splice(start..end, piece.chars());
        }
        read(&chars.into_iter().collect::<String>());
    }

    #[test]
    fn lines_left_out_and_doubled(text in file(), picks in prop::collection::vec(0_u8..8, 200)) {
        let mut out = String::new();
        for (line, pick) in text.lines().filter(|line| !line.starts_with('#')).zip(picks) {
            let times = match pick { 0 => 0, 1 => 2, _ => 1 };
            for _ in 0..times {
                out += line;
                out.push('\n');
            }
        }
        read(&out);
    }

    #[test]
    fn garbage(text in ".{0,60}") {
        read(&text);
    }
}

#[test]
fn deep_nesting_is_refused() {
    read(&format!("a = {}", "[".repeat(100_000)));
    read(&format!("{}x = 1", "a.".repeat(50_000)));
    read(&format!("a = {}", "{ b = ".repeat(20_000)));
}

#[test]
fn many_mistakes_are_cut_short() {
    let keys: Vec<String> = (0..40_000).map(|n| format!("k{n} = {n}")).collect();
    let keys = keys.join("\n");
    let errors = Machine::from_toml("x.toml", &keys).unwrap_err();
    assert_eq!(errors.len(), 100);
    read(&"[[load]]\n".repeat(40_000));
    read(&"[[preset]]\naxes = [\"X\"]\n".repeat(20_000));
}
