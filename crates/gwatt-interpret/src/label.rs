//! Names of O-words and of subprograms.

/// The name of an O-word or of a subprogram.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Label {
    /// `o100`, `O1000`.
    Number(u32),
    /// `o<name>`, lower case without blanks.
    Name(String),
}

impl std::fmt::Display for Label {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "O{number}"),
            Self::Name(name) => write!(f, "o<{name}>"),
        }
    }
}
