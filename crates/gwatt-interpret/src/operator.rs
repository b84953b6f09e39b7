//! Operators between two values, and what they come to. How they are written and
//! how tight they bind, each language says for itself.

/// An operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
    Power,
    Times,
    Divide,
    Modulo,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterEqual,
    Less,
    LessEqual,
    And,
    Or,
    ExclusiveOr,
    /// On the bits of whole numbers.
    BitAnd,
    BitOr,
    BitExclusiveOr,
}

/// What languages say differently of the same operators.
#[derive(Debug)]
pub(super) struct Rules {
    /// How far two values may differ and yet be equal; 0: not at all.
    pub(super) tolerance: f64,
    /// Whether a value is true.
    pub(super) holds: fn(f64) -> bool,
    /// The rest of a division by what is not 0.
    pub(super) rest: fn(f64, f64) -> f64,
    /// The bits of a number, or what is wrong with it.
    pub(super) bits: fn(f64) -> Result<i64, &'static str>,
}

impl Operator {
    /// The result, or what is wrong.
    pub(super) fn apply(self, a: f64, b: f64, rules: &Rules) -> Result<f64, &'static str> {
        let truth = |holds: bool| f64::from(u8::from(holds));
        let same = || a == b || (a - b).abs() < rules.tolerance;
        let holds = rules.holds;
        let bits = |join: fn(i64, i64) -> i64| {
            let (a, b) = ((rules.bits)(a)?, (rules.bits)(b)?);
            Ok(join(a, b) as f64)
        };
        Ok(match self {
            Self::Power if a < 0.0 && b.fract() != 0.0 => {
                return Err("a negative number to a power that is not whole");
            }
            Self::Power => libm::pow(a, b),
            Self::Times => a * b,
            Self::Divide | Self::Modulo if b == 0.0 => return Err("a division by zero"),
            Self::Divide => a / b,
            Self::Modulo => (rules.rest)(a, b),
            Self::Plus => a + b,
            Self::Minus => a - b,
            Self::Equal => truth(same()),
            Self::NotEqual => truth(!same()),
            Self::Greater => truth(a > b),
            Self::GreaterEqual => truth(a >= b),
            Self::Less => truth(a < b),
            Self::LessEqual => truth(a <= b),
            Self::And => truth(holds(a) && holds(b)),
            Self::Or => truth(holds(a) || holds(b)),
            Self::ExclusiveOr => truth(holds(a) != holds(b)),
            Self::BitAnd => return bits(|a, b| a & b),
            Self::BitOr => return bits(|a, b| a | b),
            Self::BitExclusiveOr => return bits(|a, b| a ^ b),
        })
    }
}
