//! Values of RS274/NGC and Fanuc, and where those of parameters come from.

use std::borrow::Cow;

use super::macro_terms::{MACRO_B, RS274};
use super::operator::{Operator, truth};
use super::terms::Terms;
use gwatt_machine::InverseAngles;

/// A value; `None` is Fanuc's null, a variable that was never given one.
pub(crate) type Value = Option<f64>;

/// Names one parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Name<'t> {
    Number(u32),
    Text(Cow<'t, str>),
}

impl std::fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "#{number}"),
            Self::Text(name) => write!(f, "#<{name}>"),
        }
    }
}

/// Why a variable that outlasts a program is unknown.
pub(crate) const KEPT: &str = "what the control has kept from before";

/// Why a variable that a probe sets is unknown.
pub(crate) const PROBED: &str = "the result of probing";

/// Why the number of the tool is unknown.
pub(crate) const TOOL: &str = "the tool at the start";

/// Why a variable is unknown to which such a value was given.
pub(super) const FROM_KEPT: &str = "a variable that the control keeps";

/// What is assigned: a value, or why it is not known.
pub(crate) type Held = Result<Value, &'static str>;

/// Why what is worked out from something unknown is itself unknown.
pub(crate) fn passed_on(reason: &'static str) -> &'static str {
    if reason == KEPT { FROM_KEPT } else { reason }
}

/// What can be done about a value that is unknown for this reason.
pub(crate) fn remedy(reason: &'static str) -> &'static str {
    match reason {
        KEPT => "give it by --set '#NUMBER=VALUE', give all by --parameters, or assign it before",
        FROM_KEPT => "give that variable by --set '#NUMBER=VALUE', or all by --parameters",
        PROBED => {
            "--probe hit and --probe miss each follow one way, --probe both all of them; where a \
             probe touches stays unknown"
        }
        TOOL => {
            "give its number by --set: '#5400=NUMBER', of Fanuc and its relatives '#4120=NUMBER'"
        }
        _ => "give it a value in the program, or take what depends on it out",
    }
}

/// What is known of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Read {
    Value(Value),
    /// It depends on something that only the machine knows, named here.
    Unknown(&'static str),
    /// There is no such parameter.
    Missing,
}

impl From<Held> for Read {
    fn from(held: Held) -> Self {
        match held {
            Ok(value) => Self::Value(value),
            Err(reason) => Self::Unknown(reason),
        }
    }
}

/// The parameters that expressions may use.
pub(crate) trait Variables {
    /// `#number`.
    fn numbered(&self, number: u32) -> Read;
    /// `#<name>`, lower case without blanks.
    fn named(&self, name: &str) -> Read;
    /// Fanuc's rules for null, precedence and rounding; else those of RS274/NGC.
    fn fanuc(&self) -> bool;
    /// What inverse functions of Fanuc's macros give, and whether the machine file says so.
    fn inverse_angles(&self) -> (InverseAngles, bool);
}

/// The tables of the language that these parameters belong to.
pub(super) fn terms_of(variables: &impl Variables) -> &'static Terms {
    if variables.fanuc() { &MACRO_B } else { &RS274 }
}

/// The result of an operator, or what is wrong.
pub(super) fn infix(
    operator: Operator,
    left: Value,
    right: Value,
    variables: &impl Variables,
) -> Result<f64, &'static str> {
    // Fanuc: null equals null only, and is 0 everywhere else.
    if variables.fanuc() && (left.is_none() || right.is_none()) {
        match operator {
            Operator::Equal => return Ok(truth(left == right)),
            Operator::NotEqual => return Ok(truth(left != right)),
            _ => {}
        }
    }
    terms_of(variables).infix(operator, left.unwrap_or(0.0), right.unwrap_or(0.0))
}
