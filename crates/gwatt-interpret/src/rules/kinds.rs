//! What languages differ in, as plain facts: the kernel asks these, and never which language it
//! has before it.

use crate::code::GCode;

/// The facts of a language.
#[derive(Debug, Clone, Copy)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate property of the language"
)]
pub(crate) struct LanguageRules {
    /// What a G word (number × 10) stands for; `None`: the language has no such word.
    pub g_code: fn(u16) -> Option<GCode>,
    /// What a G word that is refused would be, for its message.
    pub refused_g: fn(u16) -> &'static str,
    /// M words (number × 10) that switch overrides and outputs, or save the modal state.
    pub is_state_word: fn(u16) -> bool,
    /// `@` and `^` are words: polar coordinates.
    pub polar_words: bool,
    /// Plain words mean the same whatever was read before.
    pub fixed_meaning: bool,
    /// Other M words are switches of the machine's builder, which move no axis; M17 ends.
    pub free_m_words: bool,
    /// M82 and M83 select how the extruder's positions are given.
    pub extruder_modes: bool,
    /// `(abort, …)` and `(msg, …)` are more than comments.
    pub comments_act: bool,
    /// Words in parentheses may be no comment.
    pub words_in_parentheses: bool,
    /// A line may end with a checksum.
    pub checksums: bool,
    /// `%` names a program, of which a file may have several; else it opens and ends the tape.
    pub percent_names_programs: bool,
    pub macros: Macros,
    /// Variables that outlast a program.
    pub kept: KeptVariables,

    /// F is read in the unit in force before its block; not by grbl, which shares these rules.
    pub feed_in_old_unit: bool,
    /// F under G93 is the time of a block in s, and modal, not a share of a minute.
    pub block_time_in_seconds: bool,
    /// Without any F feed moves run nevertheless: what is noted then.
    pub without_feed: Option<&'static str>,
    /// G4 may have no time or two.
    pub lenient_dwell: bool,

    /// Offsets and reference points are parameters of the program.
    pub places_in_parameters: bool,
    /// G52 shifts as G92 does.
    pub g52_is_g92: bool,
    /// The values of G92 are the offset itself, not where the axes stand.
    pub g92_gives_offset: bool,
    pub bare_g92: BareG92,
    pub clamp: SpindleClamp,
    /// Only distances count, not where the axes stand.
    pub relative_places: bool,
    /// A turn or a scale leaves axes away from their programmed places until they are named.
    pub leaves_axes_adrift: bool,
    /// Another plane ends a turn, and is not selected by the word that does.
    pub plane_ends_turn: bool,
    /// Places of the machine are refused in turned coordinates.
    pub no_turned_machine_places: bool,
    /// G28 is a rapid and no homing.
    pub returns_are_rapids: bool,
    /// G28 names its axes.
    pub returns_name_axes: bool,
    /// Ways to places of the machine suspend frames.
    pub returns_suspend_frames: bool,

    /// A tool must be in the table.
    pub tools_are_listed: bool,
    /// The last digits of a lathe's T select an offset.
    pub t_selects_offset: bool,
    /// The word of an arc's radius on lathes.
    pub lathe_radius: u8,
    pub tool_lengths: ToolLengths,
    /// D is an edge of the tool, which has its radius.
    pub tool_edges: bool,
    /// Numbers of offsets that no code of their block uses stay for later.
    pub offset_numbers_stay: bool,
    /// Hardly any other word may stand in a block under compensation.
    pub strict_compensation: bool,
    /// Outside corners, and what F speaks for, may change under compensation.
    pub compensation_changes: bool,
    /// How compensation rounds corners may be unknown where the radius is 0.
    pub corners_may_be_unknown: bool,
    /// A chamfer has the feed of the move after it; else which one is not documented.
    pub chamfer_has_next_feed: bool,

    pub cycles: CycleWords,
    /// M52 to M54 select where cycles return to.
    pub cycle_levels_by_m: bool,
    /// Seconds in one of P of a cycle, written without a point.
    pub whole_cycle_dwell_s: f64,
    /// G10 L2 R tilts arcs out of their plane.
    pub turns_tilt_arcs: bool,
    /// P of an arc is how many turns it begins.
    pub arc_turns: bool,
    /// I, J or K outside of the plane of an arc is passed over.
    pub stray_centres: bool,
    /// The word for the radius of an arc.
    pub radius_word: &'static str,
}

/// How variables, expressions and the order of execution are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Macros {
    /// `#5`, `#<name>` and O words (RS274/NGC).
    OWords,
    /// `#5`, IF, WHILE and G65 (Fanuc's custom macro B).
    MacroB,
    /// In a way of its own, or not at all.
    Own,
}

/// Variables that outlast a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum KeptVariables {
    /// `#500`, and names that begin with `_`.
    NumbersAndNames,
    /// `#500`.
    Numbers,
    /// `R1`.
    R,
    /// `V1`, `VC1`, `VS1`.
    Common,
    None,
}

/// What G92 without axes is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BareG92 {
    Refused,
    /// With S the clamp of the spindle.
    Clamp,
    /// It speaks for all axes.
    AllAxes,
}

/// Where lengths of tools are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ToolLengths {
    /// The tool table, by the tool or by H.
    Table,
    /// Offsets, by H.
    Offsets,
    /// Not from words of the program.
    Elsewhere,
}

/// Whose canned cycles there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CycleWords {
    Rs274,
    /// Fanuc's, which its relatives have too.
    Fanuc,
    None,
}

/// What bounds the spindle's speed under G96.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SpindleClamp {
    /// D in the block of G96, which has its S too.
    D,
    /// S next to G92, or to G50.
    G92,
}
