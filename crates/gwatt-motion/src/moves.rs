//! What a program does: moves and actions, in machine coordinates.

use super::path_limits::{SpeedSteps, Square};
use gwatt_machine::{AxisSet, AxisValues, PathMode};

/// What a program block does, in the order in which it does it.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "moves are the common case and live in reused buffers"
)]
pub enum Step {
    /// A path element or a dwell.
    Move(Move),
    /// Something that moves no axis.
    Action(Action),
}

impl Step {
    /// Whether it moves an axis.
    #[must_use]
    #[inline]
    pub fn moves_axes(&self) -> bool {
        matches!(self, Self::Move(mv) if mv.moves_axes())
    }

    /// Whether it only reports what limits the moves, a word of the feed, limits that may act
    /// early or where a beam may wait: these need not stand in a limited program as they do in
    /// the original.
    #[must_use]
    pub fn is_note(&self) -> bool {
        matches!(self, Self::Action(action)
        if matches!(
            action.kind,
            ActionKind::Feed | ActionKind::EarlyLimits(_) | ActionKind::BeamMayStop
        ))
    }
}

/// The kind of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MoveKind {
    /// Rapid traverse.
    Rapid,
    /// A straight move at a feed.
    Feed,
    /// An arc or a helix at a feed.
    Arc,
    /// A straight move in step with the spindle that cuts a thread.
    Thread,
    /// A tap that goes in or out.
    Tap,
    /// A feed that ends where a probe touches.
    Probe,
    /// Waiting.
    Dwell,
    /// A run of the spindle by itself; programs have none, reports do.
    Spindle,
}

impl MoveKind {
    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rapid => "rapid",
            Self::Feed => "feed",
            Self::Arc => "arc",
            Self::Thread => "thread",
            Self::Tap => "tap",
            Self::Probe => "probe",
            Self::Dwell => "dwell",
            Self::Spindle => "spindle",
        }
    }

    /// Which knobs make it last longer: that of feeds, that of rapids.
    #[must_use]
    pub fn knobs(self) -> [bool; 2] {
        match self {
            Self::Rapid => [false, true],
            Self::Feed | Self::Arc => [true, false],
            Self::Dwell | Self::Spindle => [false, false],
            Self::Thread | Self::Tap | Self::Probe => [true, true],
        }
    }
}

/// How F is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedMode {
    /// G94: length per minute.
    PerMinute,
    /// G93: 1/F minutes for the block.
    InverseTime,
    /// G95: length per spindle revolution.
    PerRevolution,
}

/// A path element, or a dwell. Positions in mm or degrees, machine coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// Line in the program, from 1.
    pub line: u64,
    /// Block number without N, if there is one.
    pub number: Option<f64>,
    /// Which run of its line this is, from 1.
    pub run: u32,
    /// Which text its line stands in: 0 is the program itself, others are files
    /// of subprograms.
    pub text: u16,
    /// What it is.
    pub kind: MoveKind,
    /// Where it starts.
    pub start: AxisValues,
    /// Where it ends.
    pub end: AxisValues,
    /// Axes that really move; for an arc both axes of its plane.
    pub moving: AxisSet,
    /// Axes that are commanded but whose start is not known (`--start unknown`);
    /// their values in `start` mean nothing.
    pub unknown_start: AxisSet,
    /// Of these, the axes of which it is assumed where they stand: `start` has their places,
    /// and they are among `moving` where they would move from there.
    pub assumed_start: AxisSet,
    /// Geometry of an arc.
    pub arc: Option<Arc>,
    /// Path length in mm, or in degrees where only rotary axes move: the length
    /// that F speaks for. Of a rapid likewise. 0 for a dwell.
    pub length_mm: f64,
    /// Path speed that F asks for in mm/s (or degrees/s), at 100 % override, as far as
    /// the program's own limits permit it; infinite for rapids.
    pub feed_mm_s: f64,
    /// By what factor F asks for more than `feed_mm_s`, which the program's limits hold
    /// back (M203, Klipper's VELOCITY): so far an override may fall before the move is
    /// slower; 1 without such limits.
    pub feed_excess: f64,
    /// How F was meant.
    pub feed_mode: FeedMode,
    /// Acceleration limits of the axes in force, after knobs.
    pub accel_mm_s2: AxisValues,
    /// Acceleration limit along the path in force; infinite without one.
    pub path_accel_mm_s2: f64,
    /// Share of the axes' jerk limits in force, the largest of the axes that move.
    pub jerk_factor: f64,
    /// Share of the rapid speed in force, (0, 1]; above 1 where a printer's
    /// program raised the speed limits of the axes that move.
    pub rapid_factor: f64,
    /// What part of the speed a share that the control takes while it moves leaves (`LinuxCNC`'s
    /// adaptive feed), (0, 1]: `feed_mm_s` or `rapid_factor` have it.
    pub pace: f64,
    /// Duration of a dwell in s.
    pub dwell_s: f64,
    /// Switched loads that draw power during the move: bit i for `machine.loads[i]`.
    pub loads: u32,
    /// What happens at the end of this move.
    pub path_mode: PathMode,
    /// What may happen to the corner there, if the path does not stop.
    pub corner: Corner,
    /// How far the controller's own path may stray from this one.
    pub stray: Stray,
}

/// How far the path that a controller takes may stray from the move that stands for it: a
/// spiral from a circle, an arc in a tilted plane from its chords. A move whose path is far
/// from it is bounded and not planned; else what may differ is added to what it draws.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stray {
    /// The largest distance between the unit vectors of both directions; 0: it is the
    /// path.
    pub direction: f64,
    /// The share by which the controller may exceed the axes' accelerations.
    pub accel: f64,
    /// The move is a chord of it: the controller does not stop at its ends.
    pub in_chords: bool,
}

/// From this distance of directions on a path is far from the move.
const FAR_DIRECTION: f64 = 0.1;
/// The same for the share of accelerations.
const FAR_ACCEL: f64 = 0.2;

impl Stray {
    /// The path is the controller's.
    pub const NONE: Self = Self {
        direction: 0.0,
        accel: 0.0,
        in_chords: false,
    };

    /// Whether the path is so far from this one that the move is bounded and not planned.
    #[must_use]
    #[inline]
    pub fn is_far(self) -> bool {
        self.in_chords || self.direction > FAR_DIRECTION || self.accel > FAR_ACCEL
    }

    /// Whether the path is another one.
    #[must_use]
    #[inline]
    pub fn strays(self) -> bool {
        self != Self::NONE
    }
}

impl Move {
    /// Whether any axis moves.
    #[must_use]
    #[inline]
    pub fn moves_axes(&self) -> bool {
        let stands = self.moving.is_empty() && self.unknown_start.is_empty();
        !(stands || self.kind == MoveKind::Dwell)
    }
}

/// How a corner may be taken without a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Corner {
    /// G61: on the programmed path.
    Exact,
    /// G64: as the controller does it.
    Round {
        /// P of `LinuxCNC`, mm; 0: none was given.
        tolerance_mm: f64,
        /// Q of `LinuxCNC`, within which lines are put together, mm; 0: none are.
        join_mm: f64,
    },
    /// Rounded by limits that the program has set.
    Square(Square),
    /// Taken with steps of speed that the program has set (M205, M566).
    Steps(SpeedSteps),
    /// Passed within a distance that the program has set (M205 J), mm.
    Deviation(f64),
}

impl Corner {
    /// What the program has set for corners and hills of Klipper's look-ahead, if it has.
    #[must_use]
    pub fn square(self) -> Option<Square> {
        match self {
            Self::Square(square) => Some(square),
            _ => None,
        }
    }

    /// Whether the program has set it by a value.
    #[must_use]
    pub fn is_set(self) -> bool {
        matches!(self, Self::Square(_) | Self::Steps(_) | Self::Deviation(_))
    }
}

impl Default for Corner {
    fn default() -> Self {
        Self::Round {
            tolerance_mm: 0.0,
            join_mm: 0.0,
        }
    }
}

/// An arc or a helix.
///
/// In its plane the path is `center + radius·(cos θ, sin θ)` with θ from
/// `start_angle_rad` over `sweep_rad` (positive: counter-clockwise, seen from
/// the third axis); the other axes move in proportion to θ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Axes of the plane, first and second (XY, ZX or YZ).
    pub plane: [usize; 2],
    /// Centre in the plane, machine coordinates, mm.
    pub center: [f64; 2],
    /// Radius in mm; the smaller one where start and end differ a little.
    pub radius_mm: f64,
    /// Angle of the start.
    pub start_angle_rad: f64,
    /// Signed angle from start to end, full turns included.
    pub sweep_rad: f64,
}

/// Something a program does without moving an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Action {
    /// Line in the program, from 1.
    pub line: u64,
    /// What happens.
    pub kind: ActionKind,
    /// Its number: the speed of `Spindle`, the tool of `ToolChange`, the M
    /// number of the others.
    pub value: f64,
}

/// What is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EarlyLimits {
    /// The acceleration of axes (M201).
    AxisAccel,
    /// The acceleration along the path (M204).
    PathAccel,
    /// The speed of axes (M203).
    Speed,
    /// The feed (M220).
    Feed,
    /// The lengths of filament (M221).
    Filament,
    /// The steps of speed at the corners of all moves that wait (M566); its number is the largest,
    /// mm/s.
    Corners,
}

/// The kinds of actions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ActionKind {
    /// S: the speed is set.
    SpindleSpeed,
    /// The same in a block that moves, where the control may have a laser mode.
    SpeedInMotion,
    /// M3, M4, M5.
    Spindle,
    /// T: a tool is chosen.
    ToolSelect,
    /// M6.
    ToolChange,
    /// M6 in a block that moves, where it is not known whether the tool changes before or
    /// after the motion: it stands at either place.
    ToolChangeInMotion,
    /// M7, M8, M9.
    Coolant,
    /// M0, M1, M60.
    Stop,
    /// M2, M30.
    End,
    /// The firmware waits until the axes stand, as it does between the moves of homing.
    Rest,
    /// Another M word (its number), or a named command of a printer (0) that does not stop the
    /// axes.
    Other,
    /// A printer's command at which the axes may stop or not.
    MayStop,
    /// The same where a beam of constant power may wait for the axes, which depends on which moves
    /// are rapids (grbl's laser mode).
    BeamMayStop,
    /// Limits change, perhaps for the last move before already: the factor by which they rise at
    /// most for its axes.
    EarlyLimits(EarlyLimits),
    /// G61, G61.1, G64 (value 61, 61.1, 64).
    PathMode,
    /// The feed mode (the G number), or without a motion a new feed (0): only where
    /// lines may be put together, which they are not over it. A limited program may
    /// have others.
    Feed,
    /// Offsets or lengths change: G54, G92, G43 … (the G number); only where
    /// the look-ahead is modelled, which may end at it.
    Offset,
    /// The speed that S asks for, 1/min, as soon as it is not a surface speed;
    /// like the following only where the machine has a spindle.
    SpindleRpm,
    /// Under G96 the speed of the surface, mm/s; 0: no longer. Before it, the
    /// largest speed of the spindle and the place of its axis are given.
    SurfaceSpeed,
    /// The largest spindle speed under G96, 1/min.
    SpindleClamp,
    /// X of the spindle's axis in machine coordinates, mm; not a number where it
    /// is not known.
    SpindleCenter,
    /// A tap comes in which the spindle is in step with an axis: from rest to this speed, 1/min,
    /// below 0 the other way round, and to rest again. 0: it is over, and the spindle stands or
    /// turns as before. Like the others only where the machine has a spindle.
    TapSpeed,
    /// The tool in the spindle.
    ToolLoaded,
    /// A comment that acts: its place in [`gwatt_machine::MESSAGES`]; under the
    /// same condition.
    Message,
}
