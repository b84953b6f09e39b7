//! Operators, and what they come to. How they are written and how tight they bind, each language
//! says for itself (`terms.rs`).

/// An operator between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Power,
    Times,
    Divide,
    /// A division without its rest.
    Whole,
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
    /// Of texts.
    Chain,
}

impl Operator {
    pub(crate) fn compares(self) -> bool {
        matches!(
            self,
            Self::Equal
                | Self::NotEqual
                | Self::Greater
                | Self::GreaterEqual
                | Self::Less
                | Self::LessEqual
        )
    }

    /// The result, or what is wrong.
    pub(super) fn apply(self, a: f64, b: f64, rules: &Rules) -> Result<f64, &'static str> {
        let holds = rules.holds;
        let bits = |join: fn(i64, i64) -> i64| -> Result<f64, &'static str> {
            let (a, b) = ((rules.bits)(a)?, (rules.bits)(b)?);
            Ok(join(a, b) as f64)
        };
        finite(match self {
            Self::Power => power(a, b)?,
            Self::Times => a * b,
            Self::Divide | Self::Whole | Self::Modulo if b == 0.0 => {
                return Err("a division by zero");
            }
            Self::Divide => a / b,
            Self::Whole => (a / b).trunc(),
            Self::Modulo => (rules.rest)(a, b),
            Self::Plus => a + b,
            Self::Minus => a - b,
            Self::Equal => truth((rules.same)(a, b)),
            Self::NotEqual => truth(!(rules.same)(a, b)),
            Self::Greater => truth((rules.less)(b, a)),
            Self::GreaterEqual => truth(!(rules.less)(a, b)),
            Self::Less => truth((rules.less)(a, b)),
            Self::LessEqual => truth(!(rules.less)(b, a)),
            Self::And => truth(holds(a) && holds(b)),
            Self::Or => truth(holds(a) || holds(b)),
            Self::ExclusiveOr => truth(holds(a) != holds(b)),
            Self::BitAnd => bits(|a, b| a & b)?,
            Self::BitOr => bits(|a, b| a | b)?,
            Self::BitExclusiveOr => bits(|a, b| a ^ b)?,
            // Between texts alone.
            Self::Chain => f64::NAN,
        })
    }
}

/// An operator before a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Prefix {
    Minus,
    Not,
    BitNot,
}

/// What languages say differently of the same operators.
#[derive(Debug)]
pub(crate) struct Rules {
    /// Whether two values are equal.
    pub(crate) same: fn(f64, f64) -> bool,
    /// Whether the first value is less.
    pub(crate) less: fn(f64, f64) -> bool,
    /// Whether a value is true.
    pub(crate) holds: fn(f64) -> bool,
    /// The rest of a division by what is not 0.
    pub(crate) rest: fn(f64, f64) -> f64,
    /// The bits of a number, or what is wrong with it.
    pub(crate) bits: fn(f64) -> Result<i64, &'static str>,
}

/// The largest number that logic on bits takes.
pub(crate) const BITS_MAX: f64 = 4_294_967_295.0;
pub(crate) const NO_BITS: &str = "a logical operation on a number of more than 32 bits";

impl Prefix {
    pub(super) fn apply(self, x: f64, rules: &Rules) -> f64 {
        match self {
            Self::Minus => -x,
            Self::Not => truth(!(rules.holds)(x)),
            Self::BitNot => !(x as i64) as f64,
        }
    }
}

/// 1 or 0.
pub(crate) fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

pub(super) fn power(a: f64, b: f64) -> Result<f64, &'static str> {
    if a < 0.0 && b.fract() != 0.0 {
        return Err("a negative number to a power that is not whole");
    }
    Ok(libm::pow(a, b))
}

pub(super) fn finite(value: f64) -> Result<f64, &'static str> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err("a result beyond all numbers")
    }
}
