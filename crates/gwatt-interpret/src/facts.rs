//! What a block is, besides what it does.

use gwatt_machine::ToolChange;
use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// The words of a block that select and change the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolWords {
    /// T, if it stands in the same block.
    pub select: Option<Span>,
    /// M6.
    pub change: Span,
    /// Whether the tool changes before the block's motion or after it.
    pub order: ToolChange,
}

impl ToolWords {
    /// These words: T, M6.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.select.into_iter().chain([self.change])
    }
}

/// Why a block with M6 keeps its words where nothing says when the tool changes.
pub const TOOL_CHANGE_UNKNOWN: &str = "it changes the tool, before or after its motion";

/// Why a block keeps its words in which the machine moves of itself.
pub const MOVES_OF_ITSELF: &str = "the machine moves axes of itself in it";

/// Why a command of a printer takes no F that moves in a way of its own.
pub const OWN_MOVES: &str = "only the firmware knows how it moves";
/// Why a printer's command keeps its words that runs a file or a macro of the machine.
pub const RUNS_A_FILE: &str = "the machine runs a file or a macro of its own for it";
/// The same where nothing is known of what a macro sets.
pub const SETS_UNKNOWN: &str = "what it sets only the machine knows";

/// Why a block with two G words of one modal group keeps its words: it is the last that counts.
pub const TWO_OF_A_GROUP: &str = "it has two G words of one group";

/// What the rewriter must know of a block besides its moves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Facts {
    /// The F word that sets the feed (not the one of a dwell).
    pub feed_word: Option<Word>,
    /// The word of the motion group, if the block has one.
    pub motion_word: Option<Word>,
    /// The block moves by the motion word in force, its own or an earlier one.
    pub uses_motion: bool,
    /// That motion obeys F.
    pub uses_feed: bool,
    /// G53: the move is in machine coordinates.
    pub machine_coordinates: bool,
    /// The reference point that it goes to: 1 is that of G28, G74 and homing; further ones are
    /// those of G30, from 2 on, and the fixed points of G75, the first of which is 2.
    pub reference: Option<u16>,
    /// It moves at rapid while a laser is lit, which is off in G0 alone.
    pub beam_is_lit: bool,
    /// Corners of feeds are rounded where those of rapids are not.
    pub feeds_are_rounded: bool,
    /// Rapids may be slower than they are counted: the program lowers them by a word of which it
    /// is not known how it acts.
    pub rapids_may_be_slower: bool,
    /// It homes the axes at a speed of the control's own, under the limits in force.
    pub homes: bool,
    /// The block carries a checksum.
    pub checksum: bool,
    /// An F in this block would be the time of its dwell.
    pub dwell_takes_feed: bool,
    /// Why none of its words may be changed, as in "it cuts a thread".
    pub fixed: Option<&'static str>,
    /// Why no F may be written into it, where the limits in force hold for its moves all the same.
    pub own_feed: Option<&'static str>,
    /// It moves before any motion word was in force: there is none to put back.
    pub no_motion_word: bool,
    /// Its moves are those of a canned cycle, and may stand as single blocks.
    pub cycle: bool,
    /// Why what its cycle does is not known exactly, though it counts no lower than it is.
    pub guessed: Option<&'static str>,
    /// First and last line, from 1, of the contour that its turning cycle is about.
    pub contour: Option<[u64; 2]>,
    /// Compensation is on, or releases moves: such blocks follow each other
    /// without anything between them.
    pub compensated: bool,
    /// It changes the tool, saves or restores the state or does more that shows it: the
    /// modal state must be the original's, and no word of the block is changed.
    pub boundary: bool,
    /// Its words that select and change the tool, where it does no more than that besides its
    /// motion: they may stand on a line of their own.
    pub tool_words: Option<ToolWords>,
    /// It selects a tool: the modal state before it must be the original's.
    pub selects_tool: bool,
    /// It announces that the next block taps rigidly (M29), and nothing may come between them:
    /// the modal state before it must be the original's.
    pub announces_tap: bool,
    /// Its word that stops or ends the program once the axes stand: the modal state before
    /// and after its motion must be the original's.
    pub stop_word: Option<Span>,
    /// One of its values is the motion word or the F in force, which must be the
    /// original's then.
    pub reads_state: bool,
    /// The block is executed: not deleted, not after the end, not empty.
    pub executed: bool,
    /// It moves straight on, and changes nothing else of the state: see
    /// [`FastPathState`](super::FastPathState).
    pub plain: bool,
    /// The block turns a knob.
    pub turns_knob: bool,
    /// The F word is not a plain number: its value is worked out.
    pub computed_feed: bool,
    /// The program does not go on at the next line: see
    /// [`Interpreter::transfer`](super::Interpreter).
    pub transfers: bool,
    /// Its part in the order of execution, once that is followed.
    pub passage: Passage,
    /// Millimetres in a program unit when the block's F is read, or would be.
    pub feed_mm_per_unit: f64,
    /// The cycle that it calls by name (SINUMERIK).
    pub called: Option<CalledCycle>,
}

impl Facts {
    /// Why it is no move by its own words alone, if it is not.
    #[must_use]
    pub fn kept(&self) -> Option<&'static str> {
        self.fixed.or(self.own_feed)
    }

    /// Whether a rapid of the block would do something else as a feed.
    #[must_use]
    pub fn rapids_stay(&self) -> bool {
        self.beam_is_lit || self.feeds_are_rounded || self.rapids_may_be_slower
    }

    /// Whether its moves are the firmware's own.
    #[must_use]
    pub fn moves_by_firmware(&self) -> bool {
        self.own_feed == Some(OWN_MOVES)
    }

    /// Whether the modal state before the block must be the original's: it shows it, keeps it, or
    /// may be where the program goes on by hand.
    #[must_use]
    pub fn looks_at_state(&self) -> bool {
        self.boundary
            || self.selects_tool
            || self.announces_tap
            || self.stop_word.is_some()
            || self.reads_state
            || self.turns_knob
    }
}

/// What a block has to do with the order of execution.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Passage {
    /// Nothing.
    #[default]
    None,
    /// It has other blocks run, and goes on after itself.
    Call,
    /// It begins or ends a subprogram, and gives no value back.
    Edge,
    /// It branches, loops, or calls a macro with values.
    Other,
}

/// A cycle that is called by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CalledCycle {
    /// How many steps of the block come before those of the cycle.
    pub own_steps: usize,
    /// It drills or bores: it makes straight moves, and does not turn the spindle.
    pub plain: bool,
    /// It is a pattern of places at each of which the cycle runs.
    pub pattern: bool,
    /// The line of MCALL that has set it, with the number of its text; `None`: it stands in
    /// the block itself.
    pub set_at: Option<(u16, u64)>,
}
