//! Functions of one value.

/// A function by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
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

const NAMES: [(&[u8], Function); 20] = [
    (b"ABS", Function::Abs),
    (b"ACOS", Function::Acos),
    (b"ACS", Function::Acos),
    (b"ASIN", Function::Asin),
    (b"ASN", Function::Asin),
    (b"ATAN", Function::Atan),
    (b"ATN", Function::Atan),
    (b"COS", Function::Cos),
    (b"EXISTS", Function::Exists),
    (b"EXP", Function::Exp),
    (b"FIX", Function::Fix),
    (b"FUP", Function::Fup),
    (b"LN", Function::Ln),
    (b"POW", Function::Power),
    (b"ROUND", Function::Round),
    (b"SIN", Function::Sin),
    (b"SQRT", Function::Sqrt),
    (b"SQR", Function::Sqrt),
    (b"TAN", Function::Tan),
    (b"RND", Function::Round),
];

impl Function {
    /// The function whose name `text` begins with, and the name's length.
    pub(super) fn read(text: &[u8]) -> Option<(Self, usize)> {
        let begins = |name: &[u8]| {
            text.get(..name.len())
                .is_some_and(|front| front.eq_ignore_ascii_case(name))
        };
        NAMES
            .iter()
            .find(|(name, _)| begins(name))
            .map(|(name, function)| (*function, name.len()))
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
            Self::Round => x.round(),
            Self::Sin => libm::sin(x.to_radians()),
            Self::Sqrt if x < 0.0 => return Err("SQRT of a negative number"),
            Self::Sqrt => x.sqrt(),
            Self::Tan => libm::tan(x.to_radians()),
            Self::Exists | Self::Power => return Err("a function of another form"),
        })
    }
}
