//! Functions of one to three values. Which names they have, each language says for itself; angles
//! are in degrees.

use super::operator::{finite, power};

/// Where the integers of LinuxCNC end.
const ROUND_MAX: f64 = 2_147_483_647.0;

/// A function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Acos,
    Acot,
    /// Of y and x.
    Angle,
    /// From 0 to 360 degrees.
    AngleFromZero,
    Asin,
    /// From 270 by 0 to 90 degrees.
    AsinFromZero,
    Atan,
    /// Two bounds, then the value.
    Bound,
    Ceil,
    Cos,
    Cot,
    /// Whether a parameter has a value: it takes a name.
    Exists,
    Exp,
    Floor,
    Fract,
    Ln,
    /// Ln and the logarithm to the base of 10 on the ISG kernel.
    Log,
    Log10,
    Max,
    Min,
    Modulo,
    /// Away from zero.
    Outward,
    Power,
    PowerOfTen,
    Round,
    /// To the last decimal of an address (Fanuc: its least input increment), of which metric
    /// programs have three for lengths, and those in inches four.
    RoundThousandth,
    RoundTenThousandth,
    /// Of a feed, whose last decimal depends on the control: never down.
    RoundFeed,
    /// By way of an integer, beyond which LinuxCNC gives nonsense.
    RoundInteger,
    /// Halves go up, of negative numbers too.
    RoundUp,
    Sin,
    Sqrt,
    Square,
    Tan,
    Trunc,
    /// SINUMERIK, "Precision correction on comparison errors (TRUNC)".
    TruncCorrected,
}

/// An angle in degrees, those below 0 a turn higher.
fn from_zero(angle: f64) -> f64 {
    if angle < 0.0 { angle + 360.0 } else { angle }
}

impl Function {
    /// How many values it takes.
    pub(crate) fn values(self) -> usize {
        match self {
            Self::Bound => 3,
            Self::Angle
            | Self::AngleFromZero
            | Self::Max
            | Self::Min
            | Self::Modulo
            | Self::Power => 2,
            _ => 1,
        }
    }

    /// What it comes to, or what is wrong.
    pub(crate) fn apply(self, [x, y, z]: [f64; 3]) -> Result<f64, &'static str> {
        finite(match self {
            Self::Abs => x.abs(),
            Self::Acos if x.abs() > 1.0 => return Err("ACOS of a number beyond -1 and 1"),
            Self::Acos => libm::acos(x).to_degrees(),
            // Which half the control takes for negative numbers is not documented.
            Self::Acot if x <= 0.0 => return Err("ACOT of a number that is not positive"),
            Self::Acot => libm::atan(1.0 / x).to_degrees(),
            Self::Angle => libm::atan2(x, y).to_degrees(),
            Self::AngleFromZero => from_zero(libm::atan2(x, y).to_degrees()),
            Self::Asin | Self::AsinFromZero if x.abs() > 1.0 => {
                return Err("ASIN of a number beyond -1 and 1");
            }
            Self::Asin => libm::asin(x).to_degrees(),
            Self::AsinFromZero => from_zero(libm::asin(x).to_degrees()),
            Self::Atan => libm::atan(x).to_degrees(),
            Self::Bound => z.clamp(x.min(y), x.max(y)),
            Self::Outward if x < 0.0 => x.floor(),
            Self::Ceil | Self::Outward => x.ceil(),
            Self::Cos => libm::cos(x.to_radians()),
            Self::Cot => 1.0 / libm::tan(x.to_radians()),
            Self::Exists => return Err("a function of another form"),
            Self::Exp => libm::exp(x),
            Self::Floor => x.floor(),
            Self::Fract => x.fract(),
            Self::Ln if x <= 0.0 => return Err("LN of a number that is not positive"),
            Self::Log | Self::Log10 if x <= 0.0 => {
                return Err("the logarithm of a number that is not positive");
            }
            Self::Ln | Self::Log => libm::log(x),
            Self::Log10 => libm::log10(x),
            Self::Max => x.max(y),
            Self::Min => x.min(y),
            Self::Modulo if y == 0.0 => return Err("a division by zero"),
            Self::Modulo => libm::fmod(x, y),
            Self::Power => power(x, y)?,
            Self::PowerOfTen => libm::pow(10.0, x),
            Self::RoundInteger if x.abs() >= ROUND_MAX => {
                return Err("ROUND of a number beyond 2147483647");
            }
            Self::Round | Self::RoundInteger => x.round(),
            Self::RoundThousandth => (x * 1e3).round() / 1e3,
            Self::RoundTenThousandth => (x * 1e4).round() / 1e4,
            Self::RoundFeed => x.max(x.round()),
            Self::RoundUp => (x + 0.5).floor(),
            Self::Sin => libm::sin(x.to_radians()),
            Self::Sqrt if x < 0.0 => return Err("SQRT of a negative number"),
            Self::Sqrt => x.sqrt(),
            Self::Square => x * x,
            Self::Tan => libm::tan(x.to_radians()),
            Self::Trunc => x.trunc(),
            Self::TruncCorrected => (x * (1.0 + 1e-12)).trunc(),
        })
    }
}
