//! Names in the text of a block, and of variables.

use std::borrow::Borrow;
use std::fmt::{self, Write as _};
use std::hash::{Hash, Hasher};
use std::ops::Deref;

use arrayvec::ArrayString;

/// Letters of a name that is kept without allocation.
const SHORT: usize = 31;

/// A name: as it stands in a text, in upper case, unless its case counts.
#[derive(Clone)]
pub(crate) enum Ident {
    Short(ArrayString<SHORT>),
    Long(String),
}

impl Ident {
    /// The name that `letters` are, which are ASCII.
    pub(crate) fn new(letters: &[u8]) -> Self {
        let mut name = ArrayString::new();
        for letter in letters {
            if name.try_push(letter.to_ascii_uppercase() as char).is_err() {
                let long = String::from_utf8_lossy(letters);
                return Self::Long(long.to_ascii_uppercase());
            }
        }
        Self::Short(name)
    }

    /// A name that is put together.
    pub(crate) fn of(parts: fmt::Arguments<'_>) -> Self {
        let mut name = ArrayString::new();
        match name.write_fmt(parts) {
            Ok(()) => Self::Short(name),
            Err(fmt::Error) => Self::Long(parts.to_string()),
        }
    }

    pub(crate) fn as_str(&self) -> &str {
        self
    }
}

impl Deref for Ident {
    type Target = str;

    fn deref(&self) -> &str {
        match self {
            Self::Short(name) => name,
            Self::Long(name) => name,
        }
    }
}

impl Borrow<str> for Ident {
    fn borrow(&self) -> &str {
        self
    }
}

impl Hash for Ident {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.as_str().hash(state);
    }
}

impl PartialEq for Ident {
    fn eq(&self, other: &Self) -> bool {
        self.as_str() == other.as_str()
    }
}

impl Eq for Ident {}

impl From<Ident> for String {
    fn from(name: Ident) -> Self {
        match name {
            Ident::Short(name) => name.to_string(),
            Ident::Long(name) => name,
        }
    }
}

impl PartialEq<&str> for Ident {
    fn eq(&self, other: &&str) -> bool {
        self.as_str() == *other
    }
}

impl fmt::Display for Ident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

impl fmt::Debug for Ident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.as_str(), f)
    }
}
