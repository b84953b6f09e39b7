//! Variables that the control keeps, with the values that the one who runs the program
//! gives them: `#500=1.5`, `#<_depth>=2`, `R1=3`, `VC1=4`, `GRIND_FEED=5`.

mod control;

use crate::rules::{KeptVariables, rules_of};
use std::fmt;
use std::str::FromStr;

use gwatt_machine::Language;

/// Largest number of a variable, and of an R parameter.
const NUMBER_MAX: u32 = 999_999;

/// The number of T in force (B-63944EN, "Modal Information").
const TOOL_OF_FANUC: u32 = 4120;

/// A variable and its value before the program runs.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenVariable {
    name: Given,
    value: f64,
}

/// What it is called.
#[derive(Debug, Clone, PartialEq)]
enum Given {
    /// `#500`.
    Number(u32),
    /// `#<_depth>`: a global name.
    Named(String),
    /// `R1`.
    R(u32),
    /// `V1`, `VC1`, `VS1`.
    Common(String),
    /// A global name of SINUMERIK, in upper case.
    Global(String),
}

impl fmt::Display for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "#{number}"),
            Self::Named(name) => write!(f, "#<{name}>"),
            Self::R(number) => write!(f, "R{number}"),
            Self::Common(name) | Self::Global(name) => f.write_str(name),
        }
    }
}

impl fmt::Display for GivenVariable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.value)
    }
}

impl FromStr for GivenVariable {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("`{text}` is no variable with its value: write #500=1.5 or R1=2");
        let (name, value) = text.split_once('=').ok_or_else(form)?;
        let value: f64 = value.trim().parse().map_err(|_| form())?;
        if !value.is_finite() {
            return Err(form());
        }
        let name: String = name.split_whitespace().collect();
        let number = |digits: &str| -> Option<u32> {
            let plain = !digits.is_empty() && digits.bytes().all(|it| it.is_ascii_digit());
            let number = plain.then(|| digits.parse().ok()).flatten()?;
            (number <= NUMBER_MAX).then_some(number)
        };
        let upper = name.to_ascii_uppercase();
        let given = if let Some(inner) = name.strip_prefix("#<") {
            let inner = inner.strip_suffix('>').ok_or_else(form)?;
            if !inner.starts_with('_') {
                return Err(format!(
                    "#<{inner}> belongs to a subroutine; a name that begins with `_` is kept"
                ));
            }
            Given::Named(inner.to_ascii_lowercase())
        } else if let Some(digits) = name.strip_prefix('#') {
            Given::Number(number(digits).filter(|own| *own > 0).ok_or_else(form)?)
        } else if let Some(digits) = upper.strip_prefix('R') {
            match number(digits) {
                Some(number) => Given::R(number),
                None if is_name(&upper) => Given::Global(upper),
                None => return Err(form()),
            }
        } else {
            let digits = upper.trim_start_matches(|it: char| it.is_ascii_uppercase());
            let front = &upper[..upper.len() - digits.len()];
            if matches!(front, "V" | "VC" | "VS") && number(digits).is_some() {
                Given::Common(upper)
            } else if is_name(&upper) {
                Given::Global(upper)
            } else {
                return Err(form());
            }
        };
        Ok(Self { name: given, value })
    }
}

/// Whether a text is a name as SINUMERIK has them: two letters or underscores first, then digits
/// too ("Rules for names").
fn is_name(upper: &str) -> bool {
    let letter = |byte: &u8| byte.is_ascii_uppercase() || *byte == b'_';
    let (first, rest) = upper.as_bytes().split_at(upper.len().min(2));
    let part = |byte: &u8| letter(byte) || byte.is_ascii_digit();
    first.len() == 2 && first.iter().all(letter) && rest.iter().all(part)
}

impl GivenVariable {
    /// A numbered one: its number and value.
    pub(super) fn number(&self) -> Option<(u32, f64)> {
        match self.name {
            Given::Number(number) => Some((number, self.value)),
            _ => None,
        }
    }

    /// Whether a language has such a variable, and keeps it.
    #[must_use]
    pub fn suits(&self, language: &Language) -> bool {
        match (&self.name, rules_of(language).kept) {
            // The place of --start, and what follows from the tool.
            (Given::Number(5401..=5413 | 5420..=5428), KeptVariables::NumbersAndNames) => false,
            (Given::Number(_), KeptVariables::Numbers | KeptVariables::NumbersAndNames)
            | (Given::Named(_), KeptVariables::NumbersAndNames)
            | (Given::R(_) | Given::Common(_) | Given::Global(_), KeptVariables::R)
            | (Given::Common(_), KeptVariables::Common) => true,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_given() {
        for (text, shown) in [
            ("#500=1.5", "#500=1.5"),
            ("# 31 = -2", "#31=-2"),
            ("#<_Depth>=3", "#<_depth>=3"),
            ("r1=4", "R1=4"),
            ("vc12=0.5", "VC12=0.5"),
            ("_feed2=5", "_FEED2=5"),
            ("Rough=6", "ROUGH=6"),
        ] {
            assert_eq!(text.parse::<GivenVariable>().unwrap().to_string(), shown);
        }
        for (text, part) in [
            ("", "no variable with its value"),
            ("#500", "no variable with its value"),
            ("#500=", "no variable with its value"),
            ("#500=inf", "no variable with its value"),
            ("#0=1", "no variable with its value"),
            ("#x=1", "no variable with its value"),
            ("X=1", "no variable with its value"),
            ("X1=1", "no variable with its value"),
            ("R=1", "no variable with its value"),
            ("#<depth>=1", "belongs to a subroutine"),
        ] {
            let found = text.parse::<GivenVariable>().unwrap_err();
            assert!(found.contains(part), "{text}: {found}");
        }
    }
}
