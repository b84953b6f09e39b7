//! Identification from the outside: simulated axes of which all is known.

mod coverage;
mod effects;
mod sweep;
mod simulated;
mod sticking;
mod units;
