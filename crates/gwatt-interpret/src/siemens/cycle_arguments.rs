//! The arguments of cycles that came later, or that say how others are meant ("Programming cycles
//! externally", tables of parameters): each is followed, or as if it were left out, or refused, so
//! that no cycle passes over any.

use super::cycle_call::{Call, Kind};

/// The values of an argument that are followed, next to 0.
#[derive(Debug, Clone, Copy)]
enum Takes {
    /// It is read, or says nothing about moves: any.
    Any,
    /// None.
    Nothing,
    /// Which axis drills: 3 is the third geometry axis, Z.
    Axis,
    /// The plane, 1 to 3: the one in force.
    Plane,
    /// Depths as they are given; dwells in seconds.
    Mode,
    /// The same of a tap: absolute depth, direction of the thread, speed of the spindle.
    TapMode,
    /// In which unit the pitch is: mm, threads per inch, inch.
    Unit,
    /// Exact stop, feed forward and ramps as before; the spindle may stay in position control.
    Technology,
    /// With which signal a tap follows the spindle: 1 would take F.
    Encoder,
    /// How a circle is divided.
    Division,
}

type Later = (&'static str, Takes);

const AXIS: Later = ("_AXN", Takes::Axis);
const GEOMETRY: Later = ("_GMODE", Takes::Nothing);
const PLANE: Later = ("_DMODE", Takes::Plane);
const MODE: Later = ("_AMODE", Takes::Mode);

const DRILL: [Later; 3] = [GEOMETRY, PLANE, MODE];
const DEEP: [Later; 8] = [
    AXIS,
    ("_MDEP", Takes::Any),
    ("_VRT", Takes::Any),
    ("_DTD", Takes::Nothing),
    ("_DIS1", Takes::Any),
    GEOMETRY,
    PLANE,
    MODE,
];
const UNIT: Later = ("_PITA", Takes::Unit);
const TAP_MODE: Later = ("_AMODE", Takes::TapMode);
/// The thread of a tap by name, on the control's screens.
const THREAD: [Later; 3] = [
    ("_PITM", Takes::Nothing),
    ("_PTAB", Takes::Nothing),
    ("_PTABA", Takes::Nothing),
];
/// `_DAM` and `_VRT` are of pecks, which `_VARI` has to choose.
const TAP: [Later; 12] = [
    AXIS,
    UNIT,
    ("_TECHNO", Takes::Technology),
    ("_VARI", Takes::Nothing),
    ("_DAM", Takes::Any),
    ("_VRT", Takes::Any),
    THREAD[0],
    THREAD[1],
    THREAD[2],
    GEOMETRY,
    PLANE,
    TAP_MODE,
];
const FLOATING_TAP: [Later; 12] = [
    ("ENC", Takes::Encoder),
    ("MPIT", Takes::Any),
    ("PIT", Takes::Any),
    AXIS,
    UNIT,
    ("_TECHNO", Takes::Nothing),
    THREAD[0],
    THREAD[1],
    THREAD[2],
    GEOMETRY,
    PLANE,
    TAP_MODE,
];
const ROW: [Later; 5] = [
    ("_VARI", Takes::Nothing),
    ("_UMODE", Takes::Nothing),
    ("_HIDE", Takes::Nothing),
    ("_NSP", Takes::Nothing),
    PLANE,
];
const CIRCLE: [Later; 5] = [("_VARI", Takes::Division), ROW[1], ROW[2], ROW[3], PLANE];

impl Kind {
    /// Whether a text at a place, from 1, says nothing about moves: texts of the control's
    /// screens (`_PITM`, `_PTAB`, `_PTABA`), and an empty one.
    pub(super) fn passes_text(self, place: usize, text: &str) -> bool {
        let screens = match self {
            Self::Tap => (19..=21).contains(&place),
            Self::FloatingTap => (15..=17).contains(&place),
            _ => false,
        };
        screens || text.is_empty()
    }
}

impl Call {
    /// The place of the first of the arguments that are looked at here, and all of them.
    fn later(&self) -> (usize, &'static [Later]) {
        match self.kind {
            Kind::Deep => (13, &DEEP),
            Kind::Bore if self.feeds => (9, &DRILL),
            Kind::Drill | Kind::Bore => (7, &DRILL),
            Kind::Tap => (13, &TAP),
            Kind::FloatingTap => (9, &FLOATING_TAP),
            Kind::BoreAside => (12, &DRILL),
            Kind::Row => (7, &ROW),
            Kind::Circle => (7, &CIRCLE),
        }
    }

    /// What is not followed of the arguments: the place of the first one, and its name.
    pub(super) fn not_followed(&self, plane: [usize; 3]) -> Option<String> {
        let (first, later) = self.later();
        for place in first..=self.values.len() {
            let value = self.value(place).unwrap_or(0.0);
            let named = later.get(place - first);
            let takes = named.map_or(Takes::Nothing, |(_, takes)| *takes);
            if value != 0.0 && !self.follows(takes, value, plane) {
                let name = named.map_or(String::new(), |(name, _)| format!(" ({name})"));
                return Some(format!("argument {place} of the cycle{name}"));
            }
        }
        None
    }

    /// Whether such a value is followed.
    fn follows(&self, takes: Takes, value: f64, plane: [usize; 3]) -> bool {
        // An absolute depth is that of DP.
        let absolute = self.value(5).is_none_or(|below| below == 0.0);
        match takes {
            Takes::Any => true,
            Takes::Nothing => false,
            Takes::Axis => value == 3.0 && plane[2] == 2,
            Takes::Plane => {
                let own = match plane {
                    [0, 1, _] => 1.0,
                    [2, 0, _] => 2.0,
                    _ => 3.0,
                };
                value == own
            }
            Takes::Mode => value == 10.0 || absolute && [2.0, 12.0].contains(&value),
            Takes::TapMode => {
                let depth = value % 10.0;
                let rest = value - depth;
                let follows = [0.0, 1e3, 2e3, 1e6, 1_001e3, 1_002e3].contains(&rest);
                follows && (depth == 0.0 || absolute && depth == 2.0)
            }
            Takes::Unit => [1.0, 2.0, 3.0].contains(&value),
            Takes::Technology => value == 1000.0,
            Takes::Encoder => [11.0, 20.0].contains(&value),
            // 1: the whole circle, 2: by INDA; where that is what INDA says anyway.
            Takes::Division => {
                let [step, count] = [5, 6].map(|place| self.value(place).unwrap_or(0.0));
                let whole = step == 0.0 || (step * count - 360.0).abs() < 1e-9;
                value == 1000.0 && whole || value == 2000.0 && step != 0.0
            }
        }
    }
}
