//! Response correction: axes that answer alike, so that the path is not
//! distorted.
//!
//! ```text
//! recordings ─flexible→ models ─dips→ zeros ─design→ filters ─discretize→ biquads
//!                         └──────────delays──────────┴─mismatch→ before and after
//! ```

mod axis;
mod biquad;
mod correction;
mod delay;
mod dip;
mod discretize;
mod effort;
mod held;
mod low_pass;
mod mismatch;
mod parameters;
mod tuned;

pub use axis::{AxisResponse, Excited, Zero, excited, of_recording};
pub use biquad::{Biquad, Cascade, response};
pub use correction::{Correction, Filter, Wish, design};
pub use delay::{Advice, DELAY_TOLERANCE_S, Gain, advice, delays_agree};
pub use dip::{Dip, dips};
pub use discretize::Discretization;
pub use effort::Effort;
pub use low_pass::LowPass;
pub use mismatch::{Mismatch, Pair, mismatch};
pub use parameters::Parameters;
pub use tuned::Tuned;
