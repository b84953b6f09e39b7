//! Functions of one value.

/// Where the integers of LinuxCNC end.
const ROUND_MAX: f64 = 2_147_483_647.0;

/// A function by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Acos,
    Asin,
    Atan,
    Cos,
    Exists,
    Exp,
    Fix,
    Fup,
    Ln,
    Power,
    Round,
    Sin,
    Sqrt,
    Tan,
}

/// Which language has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    Both,
    Rs274,
    /// Fanuc custom macro B.
    Macro,
}

/// A name that another begins with stands after it.
const NAMES: [(&[u8], Function, Of); 20] = [
    (b"ABS", Function::Abs, Of::Both),
    (b"ACOS", Function::Acos, Of::Both),
    (b"ACS", Function::Acos, Of::Macro),
    (b"ASIN", Function::Asin, Of::Both),
    (b"ASN", Function::Asin, Of::Macro),
    (b"ATAN", Function::Atan, Of::Both),
    (b"ATN", Function::Atan, Of::Macro),
    (b"COS", Function::Cos, Of::Both),
    (b"EXISTS", Function::Exists, Of::Rs274),
    (b"EXP", Function::Exp, Of::Both),
    (b"FIX", Function::Fix, Of::Both),
    (b"FUP", Function::Fup, Of::Both),
    (b"LN", Function::Ln, Of::Both),
    (b"POW", Function::Power, Of::Macro),
    (b"ROUND", Function::Round, Of::Both),
    (b"SIN", Function::Sin, Of::Both),
    (b"SQRT", Function::Sqrt, Of::Both),
    (b"SQR", Function::Sqrt, Of::Macro),
    (b"TAN", Function::Tan, Of::Both),
    (b"RND", Function::Round, Of::Macro),
];

impl Function {
    /// The function whose name `text` begins with, and the name's length.
    /// `text` has no blanks.
    pub(super) fn read(text: &[u8], fanuc: bool) -> Option<(Self, usize)> {
        let other = if fanuc { Of::Rs274 } else { Of::Macro };
        NAMES
            .iter()
            .filter(|(_, _, of)| *of != other)
            .find(|(name, _, _)| text.starts_with(name))
            .map(|(name, function, _)| (*function, name.len()))
    }

    /// The value for `x`, or what is wrong. Angles in degrees.
    pub(super) fn apply(self, x: f64, fanuc: bool) -> Result<f64, &'static str> {
        Ok(match self {
            Self::Abs => x.abs(),
            Self::Acos if x.abs() > 1.0 => return Err("ACOS of a number beyond -1 and 1"),
            Self::Acos => libm::acos(x).to_degrees(),
            Self::Asin if x.abs() > 1.0 => return Err("ASIN of a number beyond -1 and 1"),
            Self::Asin => libm::asin(x).to_degrees(),
            Self::Atan => libm::atan(x).to_degrees(),
            Self::Cos => libm::cos(x.to_radians()),
            Self::Exp => libm::exp(x),
            // RS274/NGC: down and up; Fanuc: to zero and away from it.
            Self::Fix if fanuc => x.trunc(),
            Self::Fix => x.floor(),
            Self::Fup if fanuc && x < 0.0 => x.floor(),
            Self::Fup => x.ceil(),
            Self::Ln if x <= 0.0 => return Err("LN of a number that is not positive"),
            Self::Ln => libm::log(x),
            // LinuxCNC rounds by way of an integer, beyond which it gives nonsense.
            Self::Round if !fanuc && x.abs() >= ROUND_MAX => {
                return Err("ROUND of a number beyond 2147483647");
            }
            Self::Round => x.round(),
            Self::Sin => libm::sin(x.to_radians()),
            Self::Sqrt if x < 0.0 => return Err("SQRT of a negative number"),
            Self::Sqrt => x.sqrt(),
            Self::Tan => libm::tan(x.to_radians()),
            Self::Exists | Self::Power => return Err("a function of another form"),
        })
    }
}
