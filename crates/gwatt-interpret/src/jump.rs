//! Where a program goes on, when that is not the next line.

use super::expression::Value;
use super::facts::Passage;
use super::label::Label;
use super::lathe_cycle::LatheCycle;
use super::parameters::LOCALS;
use super::statement::keyword::Keyword;
use super::turning::Contour;
use gwatt_syntax::source::Span;

/// What a block says about the order of execution.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Transfer {
    /// An O-word of RS274/NGC.
    Structure { label: Label, verb: Verb },
    /// M98, M97, G65: a subprogram, and back.
    Call(Call),
    /// G66: the same after each block that moves; `None` for G67.
    ModalCall(Option<Call>),
    /// M99, with the block that the caller goes on at.
    Return { block: Option<u64> },
    /// GOTO a block number.
    Goto(u64),
    /// `WHILE [ … ] DO n`: whether the condition holds.
    Loop { number: u8, holds: bool },
    /// `END n`.
    EndLoop(u8),
    /// A word of SINUMERIK.
    Siemens(Siemens),
    /// A word of the ISG kernel or of OSP.
    Go(Go),
    /// A macro of a printer, in a file of its own.
    Macro(String),
    /// A turning cycle about a contour that stands elsewhere in the program.
    Contour(Box<Contour>),
    /// The same for `LinuxCNC`, where it stands in a subroutine.
    LatheCycle(Box<LatheCycle>),
}

impl Transfer {
    /// What that makes of its block.
    pub(super) fn passage(&self) -> Passage {
        match self {
            Self::Structure { verb, .. } => match verb {
                Verb::Sub | Verb::EndSub(None) | Verb::Return(None) => Passage::Edge,
                Verb::Call(_) => Passage::Call,
                _ => Passage::Other,
            },
            Self::Call(call) if call.arguments.is_none() => Passage::Call,
            Self::Siemens(Siemens::Repeat { .. } | Siemens::Call { again: false, .. })
            | Self::Go(Go::Local(_) | Go::File(_) | Go::Call { .. }) => Passage::Call,
            Self::Return { block: None }
            | Self::Siemens(Siemens::Return)
            | Self::Go(Go::Return) => Passage::Edge,
            // A block that only ends or begins something.
            Self::Siemens(Siemens::Next) | Self::Go(Go::Next) => Passage::None,
            _ => Passage::Other,
        }
    }
}

/// What a block of SINUMERIK says about the order of execution.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Siemens {
    /// At the next line, as for a word that only ends or begins something.
    Next,
    /// GOTO and similar words.
    Jump {
        to: String,
        direction: Direction,
        /// GOTOC: without a destination the program goes on.
        quiet: bool,
    },
    If(bool),
    Else,
    /// WHILE and FOR: whether the loop runs.
    While(bool),
    /// ENDWHILE, ENDFOR, ENDLOOP.
    Back,
    Until(bool),
    /// REPEAT and REPEATB with labels.
    Repeat {
        from: String,
        to: Option<String>,
        block: bool,
        times: u64,
    },
    Call {
        name: String,
        times: u64,
        /// It goes back to the line itself, which has more places to go to.
        again: bool,
    },
    /// RET, M17.
    Return,
}

/// What a block of the ISG kernel or of OSP says about the order of execution.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Go {
    /// At the next line.
    Next,
    /// Local subprograms stand before the main program: after them.
    Main,
    /// The program ends.
    End,
    /// $IF, or an $ELSEIF that decides.
    If(bool),
    /// $ELSE and $ELSEIF after a branch that was taken.
    BehindIf,
    /// $WHILE and $FOR: whether the loop runs.
    Loop(bool),
    /// $ENDWHILE, $ENDFOR.
    Back,
    /// $ENDDO, $UNTIL: whether it runs again.
    Again(bool),
    /// $SWITCH, or a $CASE that does not fit: the next one compares.
    Switch(f64),
    Break,
    Continue,
    /// A label as it is written: `N100`, `[NAME]`.
    Jump(String),
    /// A subprogram of the same file.
    Local(String),
    /// A subprogram in a file of its own.
    File(String),
    /// MODIN and MODOUT: a subprogram of OSP after each block that moves.
    Modal(Option<String>),
    /// A subprogram of OSP, wherever it stands.
    Call {
        name: String,
        times: u64,
    },
    Return,
}

/// Where a label is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    Forwards,
    Backwards,
    /// Forwards, then backwards.
    Both,
    /// The beginning of the program.
    Start,
}

/// What an O-word does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Verb {
    Sub,
    EndSub(Option<f64>),
    Return(Option<f64>),
    Call(Box<[Value; LOCALS]>),
    If(bool),
    /// Its condition counts only where the branches before were not taken.
    ElseIf(Span),
    Else,
    EndIf,
    While(bool),
    EndWhile,
    Do,
    Repeat(f64),
    EndRepeat,
    Break,
    Continue,
}

impl Verb {
    /// The word it was read from.
    pub(super) fn keyword(&self) -> Keyword {
        match self {
            Self::Sub => Keyword::Sub,
            Self::EndSub(_) => Keyword::EndSub,
            Self::Return(_) => Keyword::Return,
            Self::Call(_) => Keyword::Call,
            Self::If(_) => Keyword::If,
            Self::ElseIf(_) => Keyword::ElseIf,
            Self::Else => Keyword::Else,
            Self::EndIf => Keyword::EndIf,
            Self::While(_) => Keyword::While,
            Self::EndWhile => Keyword::EndWhile,
            Self::Do => Keyword::Do,
            Self::Repeat(_) => Keyword::Repeat,
            Self::EndRepeat => Keyword::EndRepeat,
            Self::Break => Keyword::Break,
            Self::Continue => Keyword::Continue,
        }
    }
}

/// A call of a subprogram.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Call {
    pub(crate) target: Target,
    pub(crate) times: u64,
    /// The block that it begins at (M98 Q); `None`: at its head.
    pub(crate) block: Option<u64>,
    /// Values for #1 to #33; `None`: the variables stay those of the caller.
    pub(crate) arguments: Option<Box<[Value; LOCALS]>>,
}

/// What is called.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Target {
    /// A program.
    Program(Label),
    /// A number of more than four digits: that program, or repetitions before
    /// the four digits of its number (the short form of M98).
    Short(u64),
    /// A block of the same program (M97).
    Block(u64),
    /// The same program.
    Here,
}
