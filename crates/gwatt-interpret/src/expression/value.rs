//! Values, and where those of parameters come from.

use gwatt_syntax::source::Span;

/// A value; `None` is Fanuc's null, a variable that was never given one.
pub(crate) type Value = Option<f64>;

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
}

/// Why a text has no value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub(crate) rule: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
    pub(crate) span: Span,
}

impl Fault {
    pub(crate) fn new(
        rule: &'static str,
        message: impl Into<String>,
        help: &'static str,
        span: Span,
    ) -> Self {
        Self {
            rule,
            message: message.into(),
            help,
            span,
        }
    }
}
