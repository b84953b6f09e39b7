//! Random expressions, against a plain evaluation, and random texts.

use std::fmt::Write as _;

use proptest::prelude::*;

use super::{BOTH, end, value};

/// An operand and what comes after it.
#[derive(Debug, Clone)]
struct Chain {
    first: Operand,
    rest: Vec<(&'static str, Operand)>,
}

#[derive(Debug, Clone)]
enum Operand {
    Number(i32),
    Negative(Box<Operand>),
    Brackets(Box<Chain>),
    Function(&'static str, Box<Chain>),
}

/// From what binds tightest to what binds least.
const LEVELS: [&[&str]; 5] = [
    &["**"],
    &["*", "/", "MOD"],
    &["+", "-"],
    &["EQ", "NE", "GT", "GE", "LT", "LE"],
    &["AND", "OR", "XOR"],
];

fn chain() -> impl Strategy<Value = Chain> {
    let operators: Vec<&'static str> = LEVELS.concat();
    let functions = vec!["ABS", "SQRT", "SIN", "COS", "FIX", "FUP", "ROUND", "LN"];
    let leaf = (0..4000_i32).prop_map(Operand::Number);
    let make = move |operand: BoxedStrategy<Operand>| {
        let operators = operators.clone();
        let more = (prop::sample::select(operators), operand.clone());
        (operand, prop::collection::vec(more, 0..5)).prop_map(|(first, rest)| Chain { first, rest })
    };
    let within = make.clone();
    let operand = leaf.prop_recursive(4, 40, 6, move |operand| {
        let chain = within(operand.clone());
        prop_oneof![
            operand.prop_map(|operand| Operand::Negative(Box::new(operand))),
            chain
                .clone()
                .prop_map(|chain| Operand::Brackets(Box::new(chain))),
            (prop::sample::select(functions.clone()), chain)
                .prop_map(|(name, chain)| Operand::Function(name, Box::new(chain))),
        ]
    });
    make(operand.boxed())
}

impl Chain {
    fn text(&self) -> String {
        let mut text = self.first.text();
        for (operator, operand) in &self.rest {
            let _ = write!(text, " {operator} {}", operand.text());
        }
        text
    }

    /// Level by level, each from the left; `None` where there is no value.
    fn value(&self) -> Option<f64> {
        let mut values = vec![self.first.value()?];
        let mut operators = Vec::new();
        for (operator, operand) in &self.rest {
            operators.push(*operator);
            values.push(operand.value()?);
        }
        for level in LEVELS {
            let mut at = 0;
            while at < operators.len() {
                if level.contains(&operators[at]) {
                    let right = values.remove(at + 1);
                    values[at] = apply(operators.remove(at), values[at], right)?;
                } else {
                    at += 1;
                }
            }
        }
        Some(values[0])
    }
}

impl Operand {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => format!("{}", f64::from(*number) / 100.0),
            Self::Negative(operand) => format!("-{}", operand.text()),
            Self::Brackets(chain) => format!("[{}]", chain.text()),
            Self::Function(name, chain) => format!("{name}[{}]", chain.text()),
        }
    }

    fn value(&self) -> Option<f64> {
        let value = match self {
            Self::Number(number) => f64::from(*number) / 100.0,
            Self::Negative(operand) => -operand.value()?,
            Self::Brackets(chain) => chain.value()?,
            Self::Function(name, chain) => {
                let x = chain.value()?;
                match *name {
                    "ABS" => x.abs(),
                    "SQRT" => libm::sqrt(x),
                    "SIN" => libm::sin(x.to_radians()),
                    "COS" => libm::cos(x.to_radians()),
                    "FIX" => x.floor(),
                    "FUP" => x.ceil(),
                    "ROUND" if x.abs() >= 2_147_483_647.0 => return None,
                    "ROUND" => x.signum() * (x.abs() + 0.5).floor(),
                    _ => libm::log(x),
                }
            }
        };
        value.is_finite().then_some(value)
    }
}

fn apply(operator: &str, a: f64, b: f64) -> Option<f64> {
    let truth = |yes: bool| f64::from(u8::from(yes));
    let value = match operator {
        "**" => libm::pow(a, b),
        "*" => a * b,
        "/" => a / b,
        "MOD" => {
            let rest = libm::fmod(a, b);
            if rest < 0.0 { rest + b.abs() } else { rest }
        }
        "+" => a + b,
        "-" => a - b,
        "EQ" => truth((a - b).abs() < 1e-4),
        "NE" => truth((a - b).abs() >= 1e-4),
        "GT" => truth(a > b),
        "GE" => truth(a >= b),
        "LT" => truth(a < b),
        "LE" => truth(a <= b),
        "AND" => truth(a != 0.0 && b != 0.0),
        "OR" => truth(a != 0.0 || b != 0.0),
        _ => truth((a != 0.0) != (b != 0.0)),
    };
    value.is_finite().then_some(value)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn random_expressions(chain in chain()) {
        let text = format!("[{}]", chain.text());
        match (chain.value(), value("linuxcnc", &text)) {
            (Some(expected), Ok(found)) => {
                let near = (found - expected).abs() <= 1e-9 * expected.abs().max(1e-9);
                prop_assert!(near, "{text}: {found} instead of {expected}");
            }
            (None, Err(error)) => prop_assert!(error.starts_with("2 arithmetic"), "{text}: {error}"),
            // A length that no machine has is refused for itself.
            (Some(expected), Err(_)) if expected.abs() > 1e9 => {}
            (expected, found) => prop_assert!(false, "{text}: {found:?} instead of {expected:?}"),
        }
    }

    /// Any text ends in a value or a message.
    #[test]
    fn random_texts(text in "[0-9.#\\[\\]<>=+*/ XGMOa-z()-]{0,40}") {
        for controller in BOTH {
            let _ = end(controller, &format!("{text}\n#1={text}\nX{text}\n"));
        }
    }
}
