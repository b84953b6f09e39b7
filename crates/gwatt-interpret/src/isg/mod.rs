//! The language of the ISG kernel, as Beckhoff's `TwinCAT` CNC has it.
//!
//! Source: TF5200 `TwinCAT` 3 CNC, programming manual; sections are named at each
//! point. Lines of plain words go the way of all languages; what is more is
//! read here, word by word, and becomes plain words.

pub(super) mod language;
mod block;
mod command;
mod cycle;
mod flow_words;
mod ramp;
mod rotation;
mod system;
mod systems;
mod terms;
mod variable;
mod word;

pub(super) use block::is_local;

use std::collections::HashMap;

use super::expression::Kept;
use gwatt_syntax::Block;

/// What a control of this language keeps besides the modal state.
#[derive(Debug, Default)]
pub(super) struct Isg {
    /// P parameters, V.P. and V.S. by their names with indices.
    globals: Kept,
    /// V.L. and V.CYC. of the programs that run, seen in those that they call; and
    /// @P, seen in their cycle only.
    levels: Vec<Kept>,
    /// @P of the cycle that is called next.
    arguments: Kept,
    /// Between #VAR and #ENDVAR.
    declares: bool,
    /// What #SLOPE has just made of the limits of jerk.
    jerk_factor: Option<f64>,
    /// Between #COMMENT BEGIN and #COMMENT END.
    comments: bool,
    /// What the line that is executed next has to do with where it is
    /// reached from.
    pub(super) pending: Pending,
    /// End and step of loops that count, by text, line and level.
    counts: HashMap<(u16, u64, usize), (f64, f64)>,
    /// #CS.
    systems: systems::Systems,
    /// Between `%L` and the main program.
    begun: bool,
}

/// Why a line is executed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Pending {
    #[default]
    Nothing,
    /// $ELSEIF decides: no branch before it was taken.
    Decide,
    /// $CASE compares with the value of its $SWITCH.
    Compare(f64),
    /// $FOR counts on.
    Count,
}

impl Isg {
    pub(super) fn new() -> Self {
        Self {
            levels: vec![HashMap::new()],
            ..Self::default()
        }
    }

    /// Whether a line must be read here, though the scanner took it for plain
    /// words.
    pub(super) fn is_beyond_words(&self, block: &Block) -> bool {
        let special = |letter: u8, value: f64| match letter {
            b'L' | b'P' | b'=' | b'@' => true,
            b'G' => value == 4.0 || is_ramp(value) || is_weight(value),
            b'M' => [2.0, 17.0, 29.0, 30.0].contains(&value),
            _ => false,
        };
        self.declares
            || self.comments
            || block.tape
            || block
                .words
                .iter()
                .any(|word| special(word.letter, word.value))
    }

    /// A subprogram begins.
    pub(super) fn enter(&mut self) {
        self.levels.push(std::mem::take(&mut self.arguments));
    }

    /// A subprogram has ended.
    pub(super) fn leave(&mut self) {
        if self.levels.len() > 1 {
            self.levels.pop();
        }
        let depth = self.levels.len();
        self.counts.retain(|(_, _, level), _| *level <= depth);
    }

    fn is_called(&self) -> bool {
        self.levels.len() > 1
    }
}

/// Whether axes next to a G word have weights and switches as values: "Influence on the look-ahead
/// functionality (G115/G116/G117)", "Feedforward control (G135/G136/G137)".
fn is_weight(number: f64) -> bool {
    [115.0, 116.0, 117.0, 135.0, 136.0, 137.0].contains(&number)
}

/// Whether a G word weights ramp times: see [`ramp`].
fn is_ramp(number: f64) -> bool {
    [132.0, 133.0, 134.0, 233.0].contains(&number)
}
