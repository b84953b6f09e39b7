//! Why the words of a block are left as they are, and what helps.

use super::line_key::IN_A_FILE;
use crate::interpret::{Facts, MOVES_OF_ITSELF, RUNS_A_FILE, SETS_UNKNOWN, TOOL_CHANGE_UNKNOWN};
use crate::machine::{Language, Lathe, Machine, PathMode};
use crate::motion::{CYCLE, TURNING_CYCLE};

/// Why a rapid is not written as a feed, where the program can help.
pub(super) const FEEDS_ARE_ROUNDED: &str = "ADIS rounds corners of feeds more than ADISPOS those of rapids: as a feed it would leave its path";
pub(super) const RAPIDS_MAY_BE_SLOWER: &str =
    "OVRRAP may hold the rapid to less than it counts: as a feed it would be faster";
pub(super) const BEAM_IS_LIT: &str = "the laser is on: it is off in G0 and would burn along a feed";
pub(super) const FEED_MODE: &str = "neither G94 nor G95 says what F means";
pub(super) const PER_REVOLUTION: &str = "the feed in force is per revolution";
pub(super) const UNKNOWN_FEED: &str =
    "no F is in force, and the one that the control takes then is not known";
pub(super) const NO_FEED: &str = "no F is in force, and one of the blocks that count on none cannot have its \
     own";
pub(super) const REFERENCE: &str = "it moves to a reference point";
pub(super) const MACHINE_COORDINATES: &str = "G53 is for rapids";
pub(super) const WITHOUT_STOP: &str = "without its stop the corner would be rounded";
/// Of a block under compensation where it has words that would have to stand by themselves.
pub(super) const COMPENSATED: &str =
    "it is under cutter compensation, where no line may come between";
/// The same where blocks are written one by one.
pub(super) const UNDER_COMPENSATION: &str =
    "it is under cutter compensation in a program with calls, loops or blocks that may be skipped";

/// What helps where something may not be changed for this reason.
pub(super) fn help(machine: &Machine, facts: &Facts, reason: &str) -> &'static str {
    let language = &machine.controller.language;
    match reason {
        CYCLE => {
            "--allow expand writes canned cycles out as single blocks; where it taps, more \
             power or slower axes are needed"
        }
        TURNING_CYCLE if facts.cycle => {
            "--allow expand writes turning cycles out as single blocks, where they cut no thread"
        }
        REFERENCE | MACHINE_COORDINATES => return_help(language, facts, reason),
        IN_A_FILE => {
            "--with-subprograms writes the files of subprograms too, certified together with \
             all programs that are given"
        }
        UNKNOWN_FEED if !language.family.facts().power_on_feed_data.is_empty() => {
            "write F before it; or give the F of power-on, which no written one exceeds \
             (setting data 42110): power_on_feed_mm_min under [language] of the machine file"
        }
        UNKNOWN_FEED => {
            "write F before it; or give the F of power-on, which no written one exceeds: \
             power_on_feed_mm_min under [language] of the machine file"
        }
        BEAM_IS_LIT => {
            "write M5 before it, or S0 in it; a machine without a laser has laser_mode = false under [path]"
        }
        FEEDS_ARE_ROUNDED => {
            "write ADISPOS no smaller than ADIS before it, or G64, or an exact stop (G60)"
        }
        RAPIDS_MAY_BE_SLOWER => {
            "write OVRRAP=100 before it; or say in the profile that the word acts as it reads, by \
             `verified = true` of its knob"
        }
        FEED_MODE => {
            "write G94 or G95 before it; or say with which of them the machine begins: feed = \
             \"per-minute\" or \"per-revolution\" under [language] of the machine file"
        }
        PER_REVOLUTION if language.dialect.lathe == Some(Lathe::A) => {
            "program G98 (feed per minute) and F in it before the rapid"
        }
        PER_REVOLUTION => "program G94 (feed per minute) and F in it before the rapid",
        TOOL_CHANGE_UNKNOWN => {
            "the machine's builder decides which: tool_change = \"before-motion\" or \
             \"after-motion\" under [language] of the machine file"
        }
        MOVES_OF_ITSELF => {
            "write a change of the tool on a line of its own; how a word of the machine's \
             builder moves, only the machine can change"
        }
        RUNS_A_FILE => {
            "where it moves nothing, list the command under [language] of the machine file in \
             `ignored_macros`; else list it in `unknown_macros` and put its text next to the \
             program, into a file of the command's name such as G32.gcode"
        }
        SETS_UNKNOWN => {
            "put what the macro does next to the program, into a file of its name such as \
             START_PRINT.gcode"
        }
        COMPENSATED | UNDER_COMPENSATION => "lower the feed by hand",
        WITHOUT_STOP if machine.controller.name != language.name => {
            "name the control in the machine file (controller = …): --dialect reads its words, \
             while the moves are planned as the machine file says"
        }
        WITHOUT_STOP if language.g61 == PathMode::ExactStop => {
            "program an exact stop (G61) before the block in front of it, or write the \
             move as a feed by hand"
        }
        _ => "",
    }
}

/// The same for the way to a reference point, or to a place in machine coordinates.
fn return_help(language: &Language, facts: &Facts, reason: &str) -> &'static str {
    let in_parameters = language.family.facts().reference_in_parameters;
    let further = facts.reference.is_some_and(|point| point > 1);
    match (reason, in_parameters) {
        (REFERENCE, true) if further => {
            "the way is gone by a feed before it where the point is known: give the control's \
             --parameters, or G30 under [offsets] in the machine file"
        }
        (REFERENCE, false) if further => {
            "the way is gone by a feed before it where the places are known: \
             further_reference_mm of the axes, the work offset ([offsets] or --parameters) and \
             the tool's length (--tool-table)"
        }
        (REFERENCE, true) => {
            "the way is gone by a feed before it where the places are known: give the control's \
             --parameters, or G28 and the work offset under [offsets] in the machine file"
        }
        _ => {
            "the way is gone by a feed before it where the places are known: reference_mm of \
             the axes, the work offset ([offsets] or --parameters) and the tool's length \
             (--tool-table); or give the speed of the return, reference_mm_min"
        }
    }
}
