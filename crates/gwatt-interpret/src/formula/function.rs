//! Functions with their values in square brackets; angles in degrees.
//!
//! ISG: TF5200 "Arithmetic expressions", "Overview of all available calculation
//! operations". OSP: "Arithmetic Operation Function" (User Task 2).

use super::style::Style;

/// A function by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Acos,
    Acot,
    Asin,
    Atan,
    Atan2,
    Cos,
    Cot,
    PowerOfTen,
    Exp,
    Fract,
    Int,
    Ln,
    Log,
    Max,
    Min,
    Modulo,
    Round,
    Sin,
    Sqrt,
    Square,
    Tan,
    Up,
}

impl Function {
    pub(super) fn named(name: &str, style: Style) -> Option<Self> {
        Some(match (name, style) {
            ("ABS", _) => Self::Abs,
            ("SIN", _) => Self::Sin,
            ("COS", _) => Self::Cos,
            ("TAN", _) => Self::Tan,
            ("SQRT", _) => Self::Sqrt,
            ("ROUND", _) => Self::Round,
            ("ATAN", _) => Self::Atan,
            ("ATAN2", Style::Osp) => Self::Atan2,
            ("ASIN", Style::Isg) => Self::Asin,
            ("ACOS", Style::Isg) => Self::Acos,
            ("COT", Style::Isg) => Self::Cot,
            ("ACOT", Style::Isg) => Self::Acot,
            ("SQR", Style::Isg) => Self::Square,
            ("EXP", Style::Isg) => Self::Exp,
            ("LN", Style::Isg) => Self::Ln,
            ("DEXP", Style::Isg) => Self::PowerOfTen,
            ("LOG", Style::Isg) => Self::Log,
            ("INT", Style::Isg) | ("FIX", Style::Osp) => Self::Int,
            ("FRACT", Style::Isg) => Self::Fract,
            ("MIN", Style::Isg) => Self::Min,
            ("MAX", Style::Isg) => Self::Max,
            ("FUP", Style::Osp) => Self::Up,
            ("MOD", Style::Osp) => Self::Modulo,
            _ => return None,
        })
    }

    /// Values that names stand for.
    pub(super) fn constant(name: &str, style: Style) -> Option<f64> {
        match (name, style) {
            ("PI", Style::Isg) => Some(std::f64::consts::PI),
            ("TRUE", Style::Isg) => Some(1.0),
            ("FALSE", Style::Isg) => Some(0.0),
            _ => None,
        }
    }

    /// The value for one or two values, or what is wrong.
    pub(super) fn apply(self, x: f64, y: Option<f64>) -> Result<f64, &'static str> {
        let two = matches!(self, Self::Atan2 | Self::Max | Self::Min | Self::Modulo);
        let y = match y {
            Some(_) if !two => return Err("a second value for a function of one"),
            None if two => return Err("a function that takes two values, as in MOD[7,3]"),
            y => y.unwrap_or_default(),
        };
        Ok(match self {
            Self::Abs => x.abs(),
            Self::Acos if x.abs() > 1.0 => return Err("ACOS of a number beyond -1 and 1"),
            Self::Acos => libm::acos(x).to_degrees(),
            Self::Asin if x.abs() > 1.0 => return Err("ASIN of a number beyond -1 and 1"),
            Self::Asin => libm::asin(x).to_degrees(),
            Self::Atan => libm::atan(x).to_degrees(),
            Self::Atan2 => libm::atan2(x, y).to_degrees(),
            // Which half the control takes for negative numbers is not documented.
            Self::Acot if x <= 0.0 => return Err("ACOT of a number that is not positive"),
            Self::Acot => libm::atan(1.0 / x).to_degrees(),
            Self::Cos => libm::cos(x.to_radians()),
            Self::Cot => 1.0 / libm::tan(x.to_radians()),
            Self::PowerOfTen => libm::pow(10.0, x),
            Self::Exp => libm::exp(x),
            Self::Fract => x.fract(),
            Self::Int => x.trunc(),
            Self::Ln | Self::Log if x <= 0.0 => {
                return Err("the logarithm of a number that is not positive");
            }
            Self::Ln => libm::log(x),
            Self::Log => libm::log10(x),
            Self::Max => x.max(y),
            Self::Min => x.min(y),
            Self::Modulo if y == 0.0 => return Err("a division by zero"),
            Self::Modulo => libm::fmod(x, y),
            Self::Round => x.round(),
            Self::Sin => libm::sin(x.to_radians()),
            Self::Sqrt if x < 0.0 => return Err("SQRT of a negative number"),
            Self::Sqrt => x.sqrt(),
            Self::Square => x * x,
            Self::Tan => libm::tan(x.to_radians()),
            Self::Up if x < 0.0 => x.floor(),
            Self::Up => x.ceil(),
        })
    }
}
