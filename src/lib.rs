//! gwatt fits CNC part programs to the converter that all drives of a machine
//! share.
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
