//! The language of Siemens SINUMERIK 840D.
//!
//! Sources: SINUMERIK 840D sl Programming Manual "Fundamentals" and "Job
//! Planning" (2013), SINUMERIK ONE "NC programming" (12/2019), Programming
//! Manual "Cycles" (2004) for the cycles by number. Sections are named at each
//! point. Lines of plain words go the way of all languages; what is more is
//! read here, word by word, and worked out on the way.

pub(super) mod language;
mod arc;
mod axis_name;
mod block;
pub(super) mod code;
pub(super) mod codes;
mod cursor;
mod cycle;
mod cycle_arguments;
mod cycle_call;
mod cycle_moves;
mod definition;
mod expression;
mod flow_words;
mod frame;
mod frame_words;
mod terms;
mod limit_words;
mod limits;
mod names;
mod pattern;
mod polar;
mod radius;
mod radius_words;
mod reading;
mod saved;
mod saving;
mod setting;
mod smoothing;
mod spindle_speeds;
mod spindles;
mod statement;
mod system;
mod target;
mod thread;
mod value;

use std::collections::HashMap;

use self::frame::Frame;
use self::value::{Argument, Scope, Val};
use super::code::{GCode, Motion};
use super::compensation::Insert;
use super::modal::Modal;
use super::words::Words;
use crate::knob::KnobState;
use gwatt_machine::{AXES, AxisSet, AxisValues, Machine};

/// How the value of an axis is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Measure {
    /// As G90 and G91 say.
    #[default]
    Modal,
    /// AC
    Absolute,
    /// IC
    Increment,
    /// DC: the short way round.
    Direct,
    /// ACP
    Positive,
    /// ACN
    Negative,
}

/// What a block says besides its words.
#[derive(Debug, Default)]
struct Extra {
    measures: [Measure; AXES],
    /// I, J and K of AC (true) or IC.
    center_absolute: [Option<bool>; 3],
    /// I1, J1 and K1 of CIP.
    via: [Option<(Measure, f64)>; 3],
    through_point: bool,
    opening_deg: Option<f64>,
    polar_angle: Option<(Measure, f64)>,
    polar_radius: Option<(Measure, f64)>,
    /// SUPA, G53, G153.
    machine_coordinates: bool,
    /// FP of G75.
    fixed_point: Option<f64>,
    /// CYCLE832: a path mode that blends.
    blends: bool,
    /// TRAORI, TRAFOOF: the work offset is deselected, unless the block selects one.
    deselects: bool,
    /// DYNNORM and similar words: a group of levels, and which one of it; `None`: any of them.
    level: Option<(usize, Option<usize>)>,
    cycle: Option<cycle_call::Call>,
    /// CHF, CHR, RND.
    corner: Option<Insert>,
    /// It changes a limit of the axes.
    turns_limit: bool,
    spindles: spindle_speeds::Said,
}

/// What MCALL has set.
#[derive(Debug, Clone)]
struct ModalCall {
    what: Called,
    /// Programs inside one another when it was set: only blocks of that one
    /// call it.
    depth: usize,
    /// The line that has set it, with the number of its text.
    set_at: (u16, u64),
}

#[derive(Debug, Clone)]
enum Called {
    Cycle(cycle_call::Call),
    Program {
        name: String,
        arguments: Vec<Option<Argument>>,
    },
}

/// How far a pattern of holes has come whose places call a subprogram.
#[derive(Debug, Clone, Copy)]
struct PatternAt {
    depth: usize,
    next: u32,
    backwards: bool,
}

/// The pole of AP and RP, and the last of both, program coordinates.
#[derive(Debug, Clone, Copy, Default)]
struct Polar {
    pole: [f64; 3],
    angle_deg: f64,
    radius: f64,
}

/// What a control of this language keeps besides the modal state.
#[derive(Debug)]
pub(super) struct Siemens {
    r: HashMap<u32, f64>,
    globals: HashMap<String, Val>,
    /// The program that runs is the last.
    scopes: Vec<Scope>,
    /// Arguments for the program that is called next.
    pending: Vec<Option<Argument>>,
    /// The program is a subprogram with parameters, which nobody has called.
    uncalled: bool,
    /// FOR counts on: its ENDFOR was reached.
    again: bool,
    extra: Extra,
    /// The block says more than its words.
    active: bool,
    /// Blocks of plain motion need care too.
    special: bool,
    /// A subprogram has given back what the next block has to put in force.
    returned: bool,
    frame: Frame,
    /// Full turns that rotary axes have made by DC, ACP and ACN.
    turns: AxisValues,
    /// Program coordinates of axes before a frame was changed, for those that
    /// have not moved since.
    local: AxisValues,
    adrift: AxisSet,
    modal_call: Option<ModalCall>,
    pattern: Option<PatternAt>,
    /// OVR as a factor.
    feed_factor: f64,
    /// DIAMON and DIAM90: places of X are diameters.
    diameter: bool,
    /// DIAM90: increments of X are radii.
    radius_increments: bool,
    polar: Polar,
    surface_speed: bool,
    spindles: spindle_speeds::Spindles,
    /// G70: F stays in mm.
    feed_in_mm: bool,
    radius: radius::Radius,
    /// RNDM.
    rounds: Option<Insert>,
    /// I, J and K of G331.
    tap_lead: [Option<f64>; 3],
    /// -1 for a left-hand thread.
    tap_sign: f64,
    limits: limits::Limits,
    smoothing: smoothing::Smoothing,
    /// The head of a subprogram is the first of the file.
    pub(super) begins_with_subprogram: bool,
}

impl Siemens {
    /// Gives an R parameter the value that the control has kept.
    pub(super) fn keep(&mut self, number: u32, value: f64) {
        self.r.insert(number, value);
    }

    /// The same of a global variable.
    pub(super) fn keep_global(&mut self, name: &str, value: f64) {
        self.globals.insert(name.to_owned(), Val::Number(value));
    }

    pub(super) fn new() -> Self {
        Self {
            r: HashMap::new(),
            globals: HashMap::new(),
            scopes: vec![Scope::default()],
            pending: Vec::new(),
            uncalled: false,
            again: false,
            extra: Extra::default(),
            active: false,
            special: true,
            returned: false,
            frame: Frame::default(),
            turns: [0.0; AXES],
            local: [0.0; AXES],
            adrift: AxisSet::default(),
            modal_call: None,
            pattern: None,
            feed_factor: 1.0,
            diameter: false,
            radius_increments: false,
            polar: Polar::default(),
            surface_speed: false,
            spindles: spindle_speeds::Spindles::default(),
            feed_in_mm: false,
            radius: radius::Radius::default(),
            rounds: None,
            tap_lead: [None; 3],
            tap_sign: 1.0,
            limits: limits::Limits::new(),
            smoothing: smoothing::Smoothing::default(),
            begins_with_subprogram: false,
        }
    }

    /// Whether the block must be executed though it has no words.
    pub(super) fn is_active(&self) -> bool {
        self.active
    }

    /// Whether the words of a block are plain motion here too.
    pub(super) fn is_plain_motion(&self, words: &Words) -> bool {
        let thread = |code: &GCode| matches!(code, GCode::Motion(Motion::Special(_)));
        !self.active
            && !self.special
            && words.present & super::letters::bit(b'R') == 0
            && !words.g.iter().any(|(code, ..)| thread(code))
    }

    /// A new block begins.
    pub(super) fn begin_block(&mut self) {
        if self.active {
            self.active = false;
            self.extra = Extra::default();
        }
    }

    /// ENDFOR goes back to its FOR.
    pub(super) fn count_on(&mut self) {
        self.again = true;
    }

    /// A subprogram begins.
    pub(super) fn enter(&mut self) {
        let arguments = std::mem::take(&mut self.pending);
        self.scopes.push(Scope {
            arguments,
            ..Scope::default()
        });
    }

    /// A subprogram has ended: VAR parameters give their values back, and SAVE
    /// its state.
    pub(super) fn leave(
        &mut self,
        modal: &mut Modal,
        knobs: &mut KnobState,
        machine: &Machine,
    ) -> bool {
        let Some(scope) = self.scopes.pop() else {
            return false;
        };
        if let Some(call) = &self.modal_call
            && call.depth > self.scopes.len()
        {
            self.modal_call = None;
        }
        for (own, callers) in &scope.given_back {
            let Some(own) = scope.variables.get(own) else {
                continue;
            };
            let caller = self.scopes.last_mut();
            let array = caller.and_then(|caller| caller.variables.get_mut(callers));
            match (array, own.values.as_slice()) {
                (Some(array), [_, _, ..]) if array.values.len() == own.values.len() => {
                    array.values.clone_from(&own.values);
                }
                (_, [value, ..]) => {
                    let _ = self.set_variable(callers, [0; 3], value.clone());
                }
                _ => {}
            }
        }
        self.pending = scope.arguments;
        let Some(saved) = scope.saved else {
            return false;
        };
        modal.motion = saved.modal.motion;
        modal.plane = saved.modal.plane;
        modal.absolute = saved.modal.absolute;
        modal.mm_per_unit = saved.modal.mm_per_unit;
        modal.path_mode = saved.modal.path_mode;
        if modal.feed_mode != saved.modal.feed_mode {
            modal.feed_mode = saved.modal.feed_mode;
            modal.feed = None;
        }
        modal.feed_mode_word = saved.modal.feed_mode_word;
        self.frame = saved.frame;
        self.restore(&saved.modes);
        knobs.select_all(machine, saved.levels);
        true
    }

    /// Whether the program is a subprogram with parameters, which nobody has called.
    pub(super) fn is_uncalled(&self) -> bool {
        self.uncalled
    }

    /// Whether a call follows each block that moves (MCALL).
    pub(super) fn calls_after_moves(&self) -> bool {
        self.modal_call.is_some()
    }

    /// Whether words of X are diameters (DIAMON, DIAM90).
    pub(super) fn in_diameters(&self) -> bool {
        self.diameter
    }

    /// Whether the program that runs was called by another.
    pub(super) fn is_called(&self) -> bool {
        self.scopes.len() > 1
    }
}
