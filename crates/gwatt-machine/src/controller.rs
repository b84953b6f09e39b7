//! Controller profiles: what a controller reads, how it plans, and which words
//! lower speed and acceleration. Profiles are data (TOML).

use super::axis::AxisSet;
use super::dialect::Dialect;
use super::knob::Knob;
use super::look_ahead::LookAhead;
use super::printer::Printer;
use super::queue::Queue;
use crate::family::Family;
use schemars::JsonSchema;
use serde::Deserialize;

/// A controller profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// Its name, such as `iso`.
    pub name: String,
    /// One line on what it stands for.
    pub description: String,
    /// How program text is read.
    pub language: Language,
    /// How it plans.
    pub planner: Planner,
    /// What words that move no axis do to the moves before them.
    pub queue: Queue,
    /// Words that limit speed or acceleration, best first.
    pub knobs: Vec<Knob>,
    /// Words that do so only where the machine file says what is wired to them.
    pub wired: Vec<Knob>,
    /// How the speed of a rapid can be lowered without such a word.
    pub rapid_knob: RapidKnob,
}

/// How program text is read.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate property of the control"
)]
pub struct Language {
    /// Name of the controller profile that it is from.
    pub name: String,
    /// The family of words.
    pub family: Family,
    /// The words that `G4` takes, with the seconds in one unit of each; if a
    /// block has several, the last in this list wins (Marlin: S over P).
    pub dwell: Vec<(u8, f64)>,
    /// The F in force at power-on, mm/s; infinite where none is known. An earlier program may
    /// have left another one.
    pub power_on_feed_mm_s: f64,
    /// The motion word in force at power-on.
    pub power_on_motion: PowerOnMotion,
    /// `true`: O words as FluidNC has them: a label may serve several branches and
    /// loops, and a break leaves nothing over.
    pub loose_o_words: bool,
    /// `true`: metric at power-on.
    pub metric: bool,
    /// `true`: that is how most machines are set; the units may be those of the program
    /// before, or a setting that the machine file does not give.
    pub units_kept: bool,
    /// `true`: absolute positions (G90) at power-on.
    pub absolute: bool,
    /// `true`: arc centres I J K are absolute (G90.1) at power-on.
    pub arc_absolute: bool,
    /// Which path modes G61, G61.1 and G64 select; 0: not known.
    pub g61: PathMode,
    /// See `g61`.
    pub g61_1: PathMode,
    /// See `g61`.
    pub g64: PathMode,
    /// Path mode at power-on.
    pub power_on_mode: PathMode,
    /// Tolerance of rounded corners at power-on in mm; 0: none.
    pub power_on_tolerance_mm: f64,
    /// The G word (number × 10) that lets its block end at rest in a mode that blends.
    pub exact_stop_word: Option<u16>,
    /// When the tool changes where M6 stands in a block that moves; `None`: not known, the
    /// builder of the machine decides.
    pub tool_change: Option<ToolChange>,
    /// Words for the spindle (M3, M4, M5, S) act before the motion of their block; else that is not
    /// known, the builder of the machine decides.
    pub spindle_before_motion: bool,
    /// The axes that M6 sends to their reference points by itself; `None`: not known, taken as
    /// none.
    pub tool_change_moves: Option<AxisSet>,
    /// Letters and numbers × 10 of words that move axes in ways that nobody describes.
    pub unknown_moves: Vec<(u8, u16)>,
    /// Whether G0 obeys F like G1.
    pub rapid_uses_feed: bool,
    /// Further G words (number × 10, rounded) without motion that are passed over.
    pub ignored_g: Vec<u16>,
    /// Further M numbers without motion that are passed over.
    pub ignored_m: Vec<u16>,
    /// Words whose levels a document of the vendor describes, such as `G187`.
    pub levels: Vec<String>,
    /// Whether `/` blocks exist (grbl and printers have none).
    pub block_delete: bool,
    /// How G41 and G42 shift the path; `None`: not known, or they do not exist.
    pub compensation: Option<CutterCompensation>,
    /// What printers differ in; of no account outside the Marlin family.
    pub printer: Printer,
    /// Whether G73 to G89 are the canned cycles of a milling control, with G98
    /// and G99 for the level that they return to.
    pub mill_cycles: bool,
    /// G83 and G87 of a lathe come out to R after each peck; else a parameter says whether.
    pub pecks_return_to_r: bool,
    /// How far G73 draws back, and how far above the last depth the rapid of
    /// G83 ends, mm; not of `Rs274`, which has it fixed.
    pub peck_clearance_mm: f64,
    /// Canned cycles repeat by L alone; else by K too.
    pub cycles_repeat_by_l: bool,
    /// G73 and G83 take I, J and K: pecks that become smaller; K next to Q returns to R.
    pub pecks_by_ijk: bool,
    /// How far the tool goes off after a pass of G71 and G72, and back after a peck of G74 and
    /// G75, where a lathe's program gives no R, mm; `None`: not known.
    pub escape_mm: Option<f64>,
    /// See `escape_mm`.
    pub groove_return_mm: Option<f64>,
    /// How G71 and G72 go from pass to pass where the contour of type II has no pocket; `None`:
    /// not known.
    pub type_2: Option<TypeTwo>,
    /// What G2 and G3 without a centre and a radius are.
    pub arc_without_center: ArcWithoutCenter,
    /// Speed at which a tap is retracted, as a multiple of its feed; `None`: not known, counted as 1.
    pub tap_return_factor: Option<f64>,
    /// What F of G74 and G84 of a mill is.
    pub tap_feed: TapFeed,
    /// D and H in a block of a canned cycle are words of the cycle, not offsets of tools.
    pub cycles_take_d_and_h: bool,
    /// G53 moves at rapid speed whatever the motion word.
    pub moves_in_machine_at_rapid: bool,
    /// How far the radii of an arc at its start and end may always differ, mm: in a
    /// program in mm, and in one in inches; `None`: not known, the least of all.
    pub arc_tolerance_mm: Option<[f64; 2]>,
    /// Numbered variables that outlast a program: first and last of each range.
    pub kept_variables: Vec<[u32; 2]>,
    /// What Fanuc, Haas and their relatives have besides.
    pub dialect: Dialect,
}

/// The motion word in force before a program has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PowerOnMotion {
    /// None: the control refuses a place without one.
    None,
    /// G0.
    Rapid,
    /// G1.
    Feed,
    /// A setting of the control decides between G0 and G1: moves before any motion word count as
    /// rapids, the fastest of both.
    Unknown,
}

/// When the tool changes where M6 stands in a block that moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToolChange {
    /// Before the axes move.
    BeforeMotion,
    /// Once the axes stand where the block ends.
    AfterMotion,
}

impl Language {
    /// Whether G61 puts blocks in exact stop and G64 ends that, on a control that has no word
    /// for one block.
    #[must_use]
    pub fn stops_by_mode(&self) -> bool {
        self.family.facts().stops_by_mode
            && self.exact_stop_word.is_none()
            && self.g61 == PathMode::ExactStop
            && self.g64 == PathMode::LookAhead
    }

    /// The word for exact stop in one block, such as `G9`.
    #[must_use]
    pub fn stop_word(&self) -> Option<String> {
        let number = self.exact_stop_word?;
        Some(format!("G{}", f64::from(number) / 10.0))
    }

    /// A dwell of at least `wanted_s`, in tenths of a second, as a block, and its time, s.
    #[must_use]
    pub fn dwell_block(&self, wanted_s: f64) -> Option<(String, f64)> {
        let (letter, unit_s) = *self.dwell.first()?;
        let tenths = (wanted_s * 10.0 - 1e-9).ceil().max(1.0);
        // In tenths of the unit it is the decimal number that will be read.
        let value = (tenths / (unit_s * 10.0) * 1e6).round() / 1e6;
        // Numbers without a point may be in another unit.
        let point = if self.dialect.adapts() && value.fract() == 0.0 {
            "."
        } else {
            ""
        };
        let words = format!("G4 {}{value}{point}", char::from(letter));
        Some((words, value * unit_s))
    }

    /// The shortest dwell as a block, and how long it lasts, s. Where the letter counts
    /// whole units, one of them, since it is not known that a dwell of no time stops.
    #[must_use]
    pub fn shortest_dwell(&self) -> (String, f64) {
        if let Some((letter, unit_s)) = self.dialect.dwell_whole.first() {
            return (format!("G4 {}1", char::from(*letter)), *unit_s);
        }
        let letter = self.dwell.first();
        let letter = letter.map_or('P', |(letter, _)| char::from(*letter));
        (format!("G4 {letter}0"), 0.0)
    }
}

/// What an arc without a centre and a radius is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArcWithoutCenter {
    /// An alarm.
    Refused,
    /// A straight line to its end, at F.
    Line,
    /// A line or an alarm, as a parameter of the control says: it counts as a line.
    LineOrAlarm,
}

/// What F of a tap is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TapFeed {
    /// A feed as any other: per minute under G94.
    PerMinute,
    /// The way in one turn of the spindle, whatever the feed mode.
    Pitch,
    /// One of them, as a parameter of the control says: the faster counts.
    Unknown,
}

/// How the tool goes after a pass of G71 and G72 whose contour begins with both axes (type II)
/// and has no pocket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TypeTwo {
    /// Off the contour at 45 degrees, as in type I.
    #[serde(rename = "as-type-1")]
    AsTypeOne,
    /// Along the contour up to the pass before, and straight out of the cut.
    AlongContour,
}

/// How G41 and G42 shift the path by the radius of the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CutterCompensation {
    /// How the tool gets round outside corners.
    pub corner: CompensationCorner,
    /// Where the first move ends, and the last begins.
    pub lead: CompensationLead,
    /// Blocks without motion in the plane, one after the other, beyond which
    /// the control no longer sees the next corner.
    pub idle_blocks: u32,
}

/// How the tool's centre gets round an outside corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CompensationCorner {
    /// By an arc about the corner.
    Arc,
    /// Straight on, to where the shifted tangents meet; in a sharp corner (the
    /// path bends by more than 90°) only as far as the radius, then straight
    /// across (Fanuc).
    Line,
    /// Straight on, to where the shifted lines meet; by an arc where the path
    /// bends by more than 100° (SINUMERIK G451). Programs select it, profiles do not.
    #[serde(skip)]
    Intersection,
}

/// Where the move that switches the compensation on ends, and where the one
/// that switches it off begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CompensationLead {
    /// Next to its own end; then round the corner like any other (LinuxCNC).
    #[serde(alias = "beside")]
    AtEnd,
    /// Next to the start of the next move (Fanuc's type A, SINUMERIK NORM).
    Perpendicular,
    /// As Perpendicular, but round outside corners like any other (Fanuc's type B).
    Corner,
}

/// What happens at the joint of two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathMode {
    /// Every block ends at rest.
    ExactStop,
    /// Blocks are run through or blended.
    LookAhead,
}

/// How rapids run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RapidPath {
    /// A straight line: all axes start and arrive together.
    Linear,
    /// Each axis runs its own ramp.
    Independent,
}

/// How the controller plans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planner {
    /// How rapids run, if the machine does not say.
    pub rapid: RapidPath,
    /// How acceleration is shared on arcs.
    pub arc_rule: ArcRule,
    /// What happens at the ends of rapids in a mode that blends.
    pub rapid_joint: RapidJoint,
    /// Whether the [shortest dwell](Language::shortest_dwell) ends the move before it at
    /// rest, so that a rapid may be written as a feed between two of them.
    pub dwell_stops: bool,
    /// What waits for the spindle's speed, if the machine does not say.
    pub spindle_wait: SpindleWait,
    /// The shortest time that a block may last for the control to keep its speed, s.
    pub shortest_block_s: f64,
    /// The shortest time that the path of a block may take at its F for the control to
    /// keep that, s.
    pub shortest_at_feed_s: f64,
    /// How corners are run through; `None`: not modelled.
    pub look_ahead: Option<LookAhead>,
}

/// What waits until the spindle has its speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpindleWait {
    /// It is not known whether anything does: the profile does not say.
    #[serde(skip)]
    Unknown,
    /// Nothing.
    Nothing,
    /// Moves that cut; rapids do not.
    Feeds,
    /// Whatever comes next.
    Blocks,
}

/// Whether rapids are blended with their neighbours where the path mode blends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RapidJoint {
    /// A rapid starts from rest and ends at rest.
    Stop,
    /// Rapids blend among each other; between rapid and feed there is a stop.
    Rapids,
    /// Rapids blend like any other move.
    All,
}

/// How acceleration is shared between turning and speeding up on an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ArcRule {
    /// Tangential and centripetal each at most `a_min/√2`, `a_min` the smallest
    /// limit of the moving axes.
    Shared,
    /// `LinuxCNC` 2.9: speed at most `√(0.866·a·r)`, tangential acceleration
    /// `a·√(1 − (v²/(r·a))²)` at that speed, `a` the smaller limit of the plane.
    LinuxCnc,
}

/// How a rapid's speed can be lowered besides `knobs`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RapidKnob {
    /// Not at all.
    None,
    /// By writing it as a feed: `G1 F…`.
    G1,
}

impl Controller {
    /// Whether a feed that stands for a rapid is stopped by words alone, for its block and for
    /// the block before it: rapids begin and end at rest, and no dwell is known to stop the
    /// axes.
    #[must_use]
    pub fn stops_by_word(&self) -> bool {
        self.may_stop_by_word() && !self.planner.dwell_stops
    }

    /// The same where a dwell would stop them too.
    #[must_use]
    pub fn may_stop_by_word(&self) -> bool {
        self.planner.rapid_joint == RapidJoint::Stop
            && (self.language.exact_stop_word.is_some() || self.language.stops_by_mode())
    }

    /// The confirmed knob that takes a value for each axis and else does what the one
    /// with this index does; that one itself where it takes such values.
    #[must_use]
    pub fn knob_by_axis(&self, index: usize) -> Option<usize> {
        let like = self.knobs.get(index)?;
        self.knobs.iter().position(|knob| {
            knob.verified
                && knob.target == like.target
                && knob.unit == like.unit
                && knob.is_by_axis()
        })
    }
}
