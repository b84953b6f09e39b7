//! Identification from the outside: simulated axes of which all is known.

mod cells;
mod coverage;
mod disturbed;
mod effects;
mod lateness;
mod miswritten;
mod overlaid;
mod presets;
mod rubbing;
mod shaken;
mod simulated;
mod sticking;
mod sweep;
mod swinging;
mod tuned;
mod units;
mod written_times;
