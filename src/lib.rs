//! gwatt rewrites CNC part programs so that all axes together never draw more than the
//! converter that they share delivers.
//!
//! [`check`], [`report`], [`limit`] and [`Moves`] are where to begin: see [`program`].
//!
//! The modules stand in the order of the data flow; each imports only from
//! those above it, and a test enforces it:
//!
//! ```text
//! bytes ─syntax→ blocks ─interpret→ moves ─plan→ profiles ─power→ demand ─limit→ adjustments ─rewrite→ bytes
//! TOML  ─machine→ Machine ─────────────────┴──────┴────────────────┘            └→ analysed again: certificate
//! CSV   ─identify→ masses, friction, transfer functions → TOML
//! ```
pub mod units;
pub mod source;
pub mod edit;
pub mod diagnostic;
pub mod syntax;
pub mod machine;
pub mod interpret;
pub mod plan;
pub mod power;
pub mod limit;
pub mod rewrite;
pub mod pipeline;
pub mod dialect;
pub mod identify;
pub mod report;
pub mod program;

pub use machine::Machine;
pub use pipeline::Moves;
pub use program::{Error, Limit, Limited, Report, check, check_as, limit, report, report_as};
