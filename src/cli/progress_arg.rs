//! How progress is shown.

use clap::ValueEnum;

/// `--progress`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ProgressArg {
    /// A bar on a terminal where work lasts longer than a second; lines for LinuxCNC where it
    /// asks for them (`AXIS_PROGRESS_BAR`)
    Auto,
    /// A bar from the beginning, if standard error is a terminal
    Always,
    /// Nothing
    Never,
    /// Lines `FILTER_PROGRESS=NN` on standard error, in percent
    Linuxcnc,
}
