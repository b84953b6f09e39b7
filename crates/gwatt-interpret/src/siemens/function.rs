//! Functions ("Flexible NC programming", "Arithmetic operations"): angles in
//! degrees.

/// A function by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Acos,
    Asin,
    Atan2,
    Bound,
    Cos,
    Exp,
    Ln,
    MaxVal,
    MinVal,
    Pot,
    Round,
    RoundUp,
    Sin,
    Sqrt,
    Tan,
    Trunc,
}

impl Function {
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "ABS" => Self::Abs,
            "ACOS" => Self::Acos,
            "ASIN" => Self::Asin,
            "ATAN2" => Self::Atan2,
            "BOUND" => Self::Bound,
            "COS" => Self::Cos,
            "EXP" => Self::Exp,
            "LN" => Self::Ln,
            "MAXVAL" => Self::MaxVal,
            "MINVAL" => Self::MinVal,
            "POT" => Self::Pot,
            "ROUND" => Self::Round,
            "ROUNDUP" => Self::RoundUp,
            "SIN" => Self::Sin,
            "SQRT" => Self::Sqrt,
            "TAN" => Self::Tan,
            "TRUNC" => Self::Trunc,
            _ => return None,
        })
    }

    /// How many values it takes.
    pub(super) fn values(self) -> usize {
        match self {
            Self::Bound => 3,
            Self::Atan2 | Self::MaxVal | Self::MinVal => 2,
            _ => 1,
        }
    }

    /// The value, or what is wrong.
    pub(super) fn apply(self, [x, y, z]: [f64; 3]) -> Result<f64, &'static str> {
        Ok(match self {
            Self::Abs => x.abs(),
            Self::Acos if x.abs() > 1.0 => return Err("ACOS of a number beyond -1 and 1"),
            Self::Acos => libm::acos(x).to_degrees(),
            Self::Asin if x.abs() > 1.0 => return Err("ASIN of a number beyond -1 and 1"),
            Self::Asin => libm::asin(x).to_degrees(),
            // The angle of the sum of two vectors at right angles: the second
            // argument is the one that the angle is measured from.
            Self::Atan2 => libm::atan2(x, y).to_degrees(),
            // Bounds, then the value.
            Self::Bound => z.clamp(x.min(y), x.max(y)),
            Self::Cos => libm::cos(x.to_radians()),
            Self::Exp => libm::exp(x),
            Self::Ln if x <= 0.0 => return Err("LN of a number that is not positive"),
            Self::Ln => libm::log(x),
            Self::MaxVal => x.max(y),
            Self::MinVal => x.min(y),
            Self::Pot => x * x,
            Self::Round => (x + 0.5).floor(),
            Self::RoundUp => x.ceil(),
            Self::Sin => libm::sin(x.to_radians()),
            Self::Sqrt if x < 0.0 => return Err("SQRT of a negative number"),
            Self::Sqrt => x.sqrt(),
            Self::Tan => libm::tan(x.to_radians()),
            // "Precision correction on comparison errors (TRUNC)".
            Self::Trunc => (x * (1.0 + 1e-12)).trunc(),
        })
    }
}
