//! gwatt rewrites CNC part programs so that all axes together never draw more than the
//! converter that they share delivers.
//!
//! [`check()`], [`report()`], [`limit()`] and [`Moves`] are where to begin: see [`program`].
//!
//! This is the whole of it in one place: what stands in crates of its own is
//! re-exported here. Crates and modules stand in the order of the data flow; each
//! imports only from those above it, and a test enforces it:
//!
//! ```text
//! bytes ─syntax→ blocks ─interpret→ moves ─plan→ profiles ─power→ demand ─limit→ adjustments ─rewrite→ bytes
//! TOML  ─machine→ Machine ─────────────────┴──────┴────────────────┘            └→ analysed again: certificate
//! CSV   ─identify→ masses, friction, transfer functions → TOML
//! settings of controls ─import→ TOML
//! ```
pub use gwatt_identify as identify;
pub use gwatt_import as import;
pub use gwatt_interpret as interpret;
pub use gwatt_limit as limit;
pub use gwatt_machine as machine;
pub use gwatt_machine::units;
pub use gwatt_motion as motion;
pub use gwatt_plan as plan;
pub use gwatt_power as power;
pub use gwatt_syntax as syntax;
pub use gwatt_syntax::{diagnostic, edit, source};

pub mod rules;
pub mod draft;
pub mod rewrite;
pub mod pipeline;
pub mod dialect;
pub mod contour;
pub mod verify;
pub mod report;
pub mod program;

pub use machine::Machine;
pub use pipeline::Moves;
pub use program::{Error, Limit, Limited, Report, check, check_as, limit, report, report_as};
