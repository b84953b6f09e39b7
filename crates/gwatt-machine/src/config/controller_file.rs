//! The controller profile as it is written.

use schemars::JsonSchema;
use serde::Deserialize;

use super::look_ahead::LookAheadTable;
use super::printer_table::PrinterTable;
use super::value::{At, NotNegative, Positive};
use crate::controller::{
    ArcRule, ArcWithoutCenter, CompensationCorner, CompensationLead, PathMode, PowerOnMotion,
    RapidJoint, RapidPath, SpindleWait, TapFeed, ToolChange, TypeTwo,
};
use crate::dialect::{InverseAngles, Lathe, Point};
use crate::family::Family;
use crate::knob::{KnobTarget, KnobUnit};

/// What a controller reads, how it plans, and which words limit it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "gwatt controller profile")]
pub(crate) struct ControllerFile {
    /// Version of this format: 1.
    #[schemars(required)]
    pub(crate) schema: Option<At<u32>>,
    /// Its name.
    #[schemars(required)]
    pub(crate) name: Option<At<String>>,
    /// One line on what it stands for.
    pub(crate) description: Option<String>,
    /// How program text is read.
    #[schemars(required)]
    pub(crate) language: Option<At<LanguageTable>>,
    /// How it plans.
    #[schemars(required)]
    pub(crate) planner: Option<At<PlannerTable>>,
    /// Words that limit speed or acceleration, best first.
    pub(crate) knob: Option<Vec<At<KnobTable>>>,
}

/// How program text is read.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LanguageTable {
    /// The family of words.
    #[schemars(required)]
    pub(crate) family: Option<Family>,
    /// The words that G4 takes; if a block has several, the last one here wins.
    #[schemars(required)]
    pub(crate) dwell: Option<Vec<At<DwellTable>>>,
    /// The motion word in force at power-on; default "none".
    pub(crate) power_on_motion: Option<PowerOnMotion>,
    /// O words as FluidNC has them: a label may serve several branches and loops,
    /// and a break leaves nothing over; default false.
    pub(crate) loose_o_words: Option<bool>,
    /// Unit at power-on; default mm.
    pub(crate) units: Option<UnitsName>,
    /// Distance mode at power-on; default absolute.
    pub(crate) distance: Option<DistanceName>,
    /// Arc centres at power-on; default incremental.
    pub(crate) arc_centre: Option<DistanceName>,
    /// Path mode at power-on.
    #[schemars(required)]
    pub(crate) power_on: Option<PathMode>,
    /// The tolerance of rounded corners at power-on, as P of G64 gives it; default
    /// 0: none.
    pub(crate) power_on_tolerance_mm: Option<NotNegative>,
    /// What G61 selects; default: as at power-on.
    pub(crate) g61: Option<PathMode>,
    /// What G61.1 selects; default: as at power-on.
    #[serde(rename = "g61_1")]
    pub(crate) g61_1: Option<PathMode>,
    /// What G64 selects; default: as at power-on.
    pub(crate) g64: Option<PathMode>,
    /// The G word that lets its block end at rest in a mode that blends, such as `G9`;
    /// default: there is none.
    pub(crate) exact_stop_word: Option<At<String>>,
    /// Whether G0 obeys F like G1; default false.
    pub(crate) rapid_uses_feed: Option<bool>,
    /// Further G and M words that certainly move nothing and are passed over.
    pub(crate) ignored: Option<Vec<At<String>>>,
    /// Words that select accelerations, as a document of the vendor has it, such as `G187`
    /// or `DYNFINISH`; what each makes of them, the machine file says ([[levels]]).
    pub(crate) levels: Option<Vec<String>>,
    /// Whether `/` blocks exist; default true.
    pub(crate) block_delete: Option<bool>,
    /// How G41 and G42 shift the path by the tool's radius; default: not known,
    /// they are refused.
    pub(crate) cutter_compensation: Option<CompensationTable>,
    /// What 3D printers differ in; only with family = "marlin".
    pub(crate) printer: Option<At<PrinterTable>>,
    /// Whether G73 to G89, G98 and G99 are those of a milling control; default
    /// false.
    pub(crate) mill_cycles: Option<bool>,
    /// How far G73 and G83 stay off the last depth, in mm; default 1. A
    /// parameter of the control.
    pub(crate) peck_clearance_mm: Option<Positive>,
    /// Whether canned cycles repeat by L alone; default false: by K too.
    pub(crate) cycles_repeat_by_l: Option<bool>,
    /// Whether G73 and G83 take I, J and K, a first peck that becomes smaller down to a least
    /// one, and K next to Q, a depth after which G73 returns to R; default false.
    pub(crate) pecks_by_ijk: Option<bool>,
    /// What F of G74 and G84 of a mill is: as any feed (per minute under G94), the pitch, or one
    /// of them as a parameter of the control says; default: as any feed.
    pub(crate) tap_feed: Option<TapFeed>,
    /// What ATAN\[…\]/\[…\] and ASIN\[…\] of macros give; default: signed.
    pub(crate) inverse_angles: Option<InverseAngles>,
    /// Whether D and H in a block of a canned cycle are words of the cycle, not offsets of
    /// tools; default false.
    pub(crate) cycles_take_d_and_h: Option<bool>,
    /// Whether G83 and G87 of a lathe come out to R after each peck; default: a parameter
    /// of the control says so.
    pub(crate) pecks_return_to_r: Option<bool>,
    /// How G71 and G72 of a lathe go from pass to pass where the first block of the contour
    /// names X and Z (type II) and the contour has no pocket; default: not known.
    pub(crate) type_2: Option<TypeTwo>,
    /// What a block with axes under G2 or G3 is that has neither a centre nor a radius;
    /// default: it is refused.
    pub(crate) arc_without_center: Option<ArcWithoutCenter>,
    /// Whether G53 moves at rapid speed whatever the motion word; default false.
    pub(crate) moves_in_machine_at_rapid: Option<bool>,
    /// How far an arc's end may always be off its circle, in mm: in a program in mm, and
    /// in one in inches; where it is at most 0.1 % of the radius, a hundred times as far.
    /// Default 0.005 and 0.0127, and 0.5 at most.
    pub(crate) arc_tolerance_mm: Option<[Positive; 2]>,
    /// Numbered variables that the control keeps from one program to the next: first
    /// and last of each range; default 500 to 999, with family = "rs274" 31 to 5000.
    pub(crate) kept_variables: Option<Vec<[u32; 2]>>,
    /// Whether the units that hold at the start are those of the last program, or a setting
    /// of the control: a program that names none may mean others; default false.
    pub(crate) units_kept: Option<bool>,
    /// What a number without a decimal point means; default: what it says,
    /// without a note.
    pub(crate) decimal_point: Option<Point>,
    /// The G codes of a lathe; default: not a lathe.
    pub(crate) lathe: Option<Lathe>,
    /// Whether words of X are diameters; default false.
    pub(crate) diameter: Option<bool>,
    /// Whether the words are those of Okuma's OSP; default false.
    pub(crate) osp: Option<bool>,
    /// Whether M words from M10 on that are not known move no axis, which is
    /// then said once; default false: they are refused.
    pub(crate) other_m: Option<bool>,
    /// Whether `;` ends a block, so that words after it are another one, which is refused;
    /// default false: a comment begins there.
    pub(crate) semicolon_ends_block: Option<bool>,
    /// The F in force at power-on, in mm/min: where the first moves come before any F, none
    /// above it is written for them. Default: none is known.
    pub(crate) power_on_feed_mm_min: Option<Positive>,
    /// What F means at power-on; default per minute.
    pub(crate) feed: Option<FeedName>,
    /// When the tool changes where M6 stands in a block that moves; default: not known.
    pub(crate) tool_change: Option<ToolChange>,
    /// Whether words for the spindle (M3, M4, M5, S) act before the motion of their block; default
    /// false: not known, so that both orders count.
    pub(crate) spindle_before_motion: Option<bool>,
    /// The axes that M6 sends to their reference points by itself; default: not known.
    pub(crate) tool_change_moves: Option<Vec<At<String>>>,
    /// M97 P calls a block of the same program, as on a Haas; default false.
    pub(crate) m97_calls: Option<bool>,
    /// M16 changes the tool as M6 does, as on a Haas; default false.
    pub(crate) m16_changes_tool: Option<bool>,
    /// J of G84 says how many times as fast a tap comes out, as on a Haas; default false.
    pub(crate) taps_return_by_j: Option<bool>,
    /// The group of G54 to G59, by which macros read the one in force: 14 for #4014 (Fanuc), 12
    /// for #4012 (Haas, Mitsubishi); default: not known.
    pub(crate) work_offset_group: Option<u8>,
    /// G12 and G13 mill circular pockets, as on a Haas; default false.
    pub(crate) circular_pocket: Option<bool>,
    /// Whether G81 to G89 of a lathe all drill along Z, from the place R, as on a Haas; default
    /// false: G83 to G85 along Z and G87 to G89 along X, R being a distance.
    pub(crate) holes_along_z: Option<bool>,
    /// Whether G87 of a mill bores and stops, and the operator takes the tool out; default false:
    /// it bores from below.
    pub(crate) bores_by_hand: Option<bool>,
    /// Whether G28 without axes moves all of them; default false.
    pub(crate) g28_all: Option<bool>,
    /// The word of M98 that names the block to begin at, of the program that is called, or
    /// of its own without P; default: there is none.
    pub(crate) call_block: Option<CallBlockName>,
    /// Whether of several G words of one modal group in a block the last counts; default
    /// false: such a block is refused.
    pub(crate) last_g_counts: Option<bool>,
}

/// The word of M98 that names a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub(crate) enum CallBlockName {
    Q,
    H,
}

/// How G41 and G42 shift the path.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CompensationTable {
    /// How the tool gets round outside corners.
    #[schemars(required)]
    pub(crate) corner: Option<CompensationCorner>,
    /// Where the first move ends and the last begins.
    #[schemars(required)]
    pub(crate) lead: Option<CompensationLead>,
    /// Blocks without motion in the plane, one after the other, that the
    /// control looks beyond; default 1.
    pub(crate) idle_blocks: Option<u32>,
}

/// What F means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FeedName {
    PerMinute,
    PerRevolution,
}

/// A word of G4.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DwellTable {
    /// Its letter.
    #[schemars(required)]
    pub(crate) letter: Option<At<String>>,
    /// Seconds in one unit of it.
    #[schemars(required)]
    pub(crate) unit_s: Option<Positive>,
    /// Seconds in one unit of a number without a decimal point; default the same.
    pub(crate) whole_unit_s: Option<Positive>,
}

/// Unit of lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum UnitsName {
    Mm,
    Inch,
}

/// Distance mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DistanceName {
    Absolute,
    Incremental,
}

/// How the controller plans.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlannerTable {
    /// How rapids run, if the machine does not say.
    #[schemars(required)]
    pub(crate) rapid: Option<RapidPath>,
    /// How acceleration is shared on arcs; default shared.
    pub(crate) arc_rule: Option<ArcRule>,
    /// What happens at the ends of rapids where the path mode blends; default
    /// "all", which is the safe one.
    pub(crate) rapid_joint: Option<RapidJoint>,
    /// Whether the shortest dwell (of no time, or of one whole unit where whole numbers
    /// have a unit of their own) ends the move before it at rest: where feeds blend and
    /// rapids stop, a rapid may then be written as a feed between two such dwells;
    /// default false.
    pub(crate) dwell_stops: Option<bool>,
    /// Whether a rapid may be written as a feed to lower its speed; default none.
    /// With "g1-where-linear" only on a machine whose file says that its rapids
    /// are linear.
    pub(crate) rapid_knob: Option<At<RapidKnobName>>,
    /// Words before which the motion has stopped, such as `M8`, `S` for all
    /// words of a letter, `MSG` for an active comment, or on printers a command such as
    /// `SET_TMC_*`; words of no list may stop it or not.
    pub(crate) stops: Option<Vec<At<String>>>,
    /// The same for words that do nothing where what they say is in force.
    pub(crate) stops_on_change: Option<Vec<At<String>>>,
    /// Words that act while the axes move on; lines before and after them are not
    /// put together where the controller does that.
    pub(crate) passes: Option<Vec<At<String>>>,
    /// The same where such lines may be put together.
    pub(crate) joins: Option<Vec<At<String>>>,
    /// Whether the control has a mode in which S in a block that moves acts with the motion and
    /// stops nothing (grbl's $32), which `[path] laser_mode` of the machine file switches;
    /// default false.
    pub(crate) has_laser_mode: Option<bool>,
    /// What waits for the spindle's speed; default: not known, so that both
    /// cases are counted.
    pub(crate) spindle_wait: Option<SpindleWait>,
    /// The shortest time that a block may last for the control to keep its speed;
    /// default 0.005.
    pub(crate) shortest_block_s: Option<Positive>,
    /// The shortest time that the path of a block may take at its F for the control to
    /// keep that; default 0: any.
    pub(crate) shortest_at_feed_s: Option<NotNegative>,
    /// How corners are run through; default: not modelled.
    pub(crate) look_ahead: Option<At<LookAheadTable>>,
}

/// How a rapid's speed can be lowered besides the knobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RapidKnobName {
    None,
    G1,
    // Only on a machine whose file says that its rapids are straight.
    G1WhereLinear,
}

/// A word that limits speed or acceleration until it is taken back.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct KnobTable {
    /// The word, such as `G131`; with `argument = "value"` all that stands before the
    /// value, such as `SET_VELOCITY_LIMIT ACCEL=`.
    #[schemars(required)]
    pub(crate) word: Option<At<String>>,
    /// What it acts on.
    #[schemars(required)]
    pub(crate) target: Option<KnobTarget>,
    /// What stands after it: `= value`, a value per axis, the same with the axis in brackets
    /// (`ACC[X]=70`), the path's value after a letter, or right after the word, or the number
    /// of an analog output ([outputs] of the machine file) with its value.
    #[schemars(required)]
    pub(crate) argument: Option<At<ArgumentName>>,
    /// Letters of the value, for `argument = "path"`.
    pub(crate) letters: Option<At<Vec<At<String>>>>,
    /// Unit of the value.
    #[schemars(required)]
    pub(crate) unit: Option<KnobUnit>,
    /// Smallest step of a value that is written.
    #[schemars(required)]
    pub(crate) step: Option<Positive>,
    /// Smallest value that is accepted.
    #[schemars(required)]
    pub(crate) min: Option<Positive>,
    /// Whether a document confirms it; default false: used on request only.
    pub(crate) verified: Option<bool>,
    /// Whether it acts between two moves that run into each other, without a stop, so
    /// that a block may be written as several of one line; default false.
    pub(crate) between_moves: Option<bool>,
    /// Whether it acts on the limits of jerk too, in the same share; default false.
    pub(crate) with_jerk: Option<At<bool>>,
    /// A line before the word that is read only once the move before it is in the queue,
    /// where the word would act on that move too; default: it acts on later moves alone.
    pub(crate) barrier: Option<String>,
    /// A line after the word, for which the axes stand and before which it does not act;
    /// default: it acts by itself.
    pub(crate) wait: Option<String>,
}

/// What stands after a knob's word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ArgumentName {
    Assign,
    Axes,
    Index,
    Dynamics,
    Path,
    Output,
    Value,
}
