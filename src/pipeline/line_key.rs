//! Which line of which text.

/// Why a line of a subprogram's file is not changed.
pub(super) const IN_A_FILE: &str =
    "it stands in a file of subprograms, which other programs may call";

/// A line: which text it stands in (0 is the program itself, others are files of
/// subprograms), and its number from 1.
pub(super) type LineKey = (u16, u64);
