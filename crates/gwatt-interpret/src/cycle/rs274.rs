//! G73 to G89 as `LinuxCNC` has them ("Canned Cycles" and the following
//! sections of its G-code reference; the order of moves, and what happens where
//! the text is silent, as its interpreter 2.9 shows).

mod words;

use crate::control::{Control, Run};
use crate::letters::{AXIS_LETTERS, POLAR, bit};
use crate::special::Turning;
use gwatt_machine::{ALL_AXES, AXES, AxisSet, AxisValues, PathMode};
use gwatt_motion::CYCLE as FIXED;
use gwatt_motion::{ActionKind, Corner, FeedMode, MoveKind};

/// Distance that a peck keeps off the last depth: 0.010 inch.
const PECK_CLEARANCE_INCH: f64 = 0.010;

/// One hole: levels of the drilling axis in program units, and `clear_mm` and
/// `r_mm` in machine coordinates.
struct Hole {
    number: u16,
    r: f64,
    bottom: f64,
    r_mm: f64,
    clear_mm: f64,
    dwell_s: f64,
    peck: f64,
    /// Shift in the plane and top of the counterbore of G87.
    shift_mm: [f64; 2],
    middle: f64,
}

/// How an incremental polar target goes on when a cycle is repeated: about the
/// origin, by the same angle, and by the same length away from it.
struct PolarStep {
    origin: [f64; 2],
    length_mm: f64,
    angle_rad: f64,
}

impl PolarStep {
    /// The step from one place to another, machine coordinates.
    fn new(origin: &AxisValues, from: &AxisValues, to: &AxisValues) -> Self {
        let origin = [origin[0], origin[1]];
        let [from, to] = [from, to].map(|place| Self::polar(origin, place));
        Self {
            origin,
            length_mm: to[0] - from[0],
            angle_rad: to[1] - from[1],
        }
    }

    /// Distance from the origin, and angle.
    fn polar(origin: [f64; 2], place: &AxisValues) -> [f64; 2] {
        let [x, y] = [place[0] - origin[0], place[1] - origin[1]];
        [libm::hypot(x, y), libm::atan2(y, x)]
    }

    fn step(&self, place: &mut AxisValues) {
        let [length_mm, angle_rad] = Self::polar(self.origin, place);
        let (sin, cos) = libm::sincos(angle_rad + self.angle_rad);
        let length_mm = length_mm + self.length_mm;
        place[0] = self.origin[0] + length_mm * cos;
        place[1] = self.origin[1] + length_mm * sin;
    }
}

/// How the holes of a block are reached.
struct HoleWay {
    repeats: u64,
    /// From one to the next, mm, if not on a circle.
    step: [f64; 2],
    circle: Option<PolarStep>,
    unknown: AxisSet,
    /// The level before the first.
    now_mm: f64,
}

impl Control<'_> {
    /// A block of a canned cycle.
    pub(crate) fn rs274_cycle(&mut self, number: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        run.facts.cycle = true;
        if !self.cycle_axes_fit(run) || !self.rs274_permits(number, run) {
            return;
        }
        let [first, second, normal] = self.modal.plane;
        let same = self.special.active == number;
        let series = self.special.active != 0;
        let Some(mut hole) = self.rs274_words(number, same, series, run) else {
            return;
        };
        let mut place = self.believed();
        let Some(unknown) = self.targets(run, false, &mut place) else {
            return;
        };
        // The interpreter takes no L with G74.
        let repeats = match number {
            740 => Some(1),
            _ => run.repeats(b'L'),
        };
        let Some(repeats) = repeats else {
            return;
        };
        if repeats == 0 {
            return run.cycle_value(b'L', "a canned cycle cannot be repeated 0 times");
        }
        // A feed that is missing is reported once.
        if self
            .feed_speed(run, &self.position.at, None, 1.0, true)
            .is_none()
        {
            return;
        }
        let from = self.believed();
        let step = if self.modal.absolute {
            [0.0; 2]
        } else {
            [first, second].map(|axis| place[axis] - from[axis])
        };
        let polar = run.words.present & POLAR != 0 && !self.modal.absolute;
        let circle = polar.then(|| {
            let origin = self.position.frame.machine(&[0.0; AXES]);
            PolarStep::new(&origin, &from, &place)
        });
        let initial_mm = self.initial_level(normal, !series);
        let mut now_mm = from[normal];
        let mut over_mm = initial_mm;
        if initial_mm < hole.r_mm {
            let mut up = self.believed();
            up[normal] = hole.r_mm;
            self.part(run, MoveKind::Rapid, &up);
            over_mm = hole.r_mm;
            now_mm = hole.r_mm;
        }
        // The holes run under G61, whatever is in force.
        let before = (self.modal.path_mode, self.modal.corner);
        self.modal.corner = Corner::Exact;
        if self.machine.path.mode != Some(PathMode::ExactStop) {
            self.modal.path_mode = self.machine.controller.language.g61;
        }
        if !self.special.to_initial {
            over_mm = hole.r_mm;
        }
        hole.clear_mm = over_mm;
        let way = HoleWay {
            repeats,
            step,
            circle,
            unknown,
            now_mm,
        };
        self.rs274_holes(&hole, place, &way, run);
        (self.modal.path_mode, self.modal.corner) = before;
        self.special.active = number;
    }

    /// The holes of a block, one after the other.
    fn rs274_holes(
        &mut self,
        hole: &Hole,
        mut place: AxisValues,
        way: &HoleWay,
        run: &mut Run<'_, '_>,
    ) {
        let [first, second, normal] = self.modal.plane;
        let mut now_mm = way.now_mm;
        for repeat in 0..way.repeats {
            let before = run.steps.len();
            if repeat > 0 {
                if let Some(circle) = &way.circle {
                    circle.step(&mut place);
                } else {
                    place[first] += way.step[0];
                    place[second] += way.step[1];
                }
            }
            place[normal] = if now_mm > hole.r_mm {
                now_mm
            } else {
                hole.clear_mm
            };
            self.go(run, MoveKind::Rapid, &place, way.unknown, None);
            if place[normal] != hole.r_mm {
                place[normal] = hole.r_mm;
                self.part(run, MoveKind::Rapid, &place);
            }
            if !self.rs274_hole(hole, &mut place, run) {
                break;
            }
            now_mm = hole.clear_mm;
            if repeat > 0 && !self.count_repeated(before, run) {
                break;
            }
        }
    }

    /// What forbids a cycle.
    fn rs274_permits(&self, number: u16, run: &mut Run<'_, '_>) -> bool {
        let whole = run.whole();
        if self.feed_mode_is(FeedMode::InverseTime) {
            run.report
                .error("cycle-g93", "a canned cycle under G93", whole)
                .help("write G94 before it");
            return false;
        }
        let own = self
            .modal
            .plane
            .iter()
            .fold(0, |letters, axis| letters | bit(ALL_AXES[*axis].letter()));
        if run.words.unused & AXIS_LETTERS & !own != 0 {
            run.report
                .error(
                    "cycle-axes",
                    "another axis than X, Y and Z in the block of a canned cycle",
                    whole,
                )
                .help("move it in a block of its own");
            return false;
        }
        let turning = self.special.spindle;
        let wrong = match number {
            740 => turning != Turning::CounterClockwise,
            840 => turning != Turning::Clockwise,
            860..=880 => turning == Turning::Stopped,
            _ => false,
        };
        if wrong {
            run.report
                .error(
                    "cycle-spindle",
                    format!("the spindle does not turn as G{} needs it", number / 10),
                    whole,
                )
                .help("write M3 before it, or M4 for G74");
        }
        !wrong
    }

    /// The moves at one place, which `place` holds at the level R; false when
    /// they are too many.
    fn rs274_hole(&mut self, hole: &Hole, place: &mut AxisValues, run: &mut Run<'_, '_>) -> bool {
        use MoveKind::{Feed, Rapid, Tap};
        let normal = self.modal.plane[2];
        let bottom_mm = self.level(normal, hole.bottom);
        let mut to = |control: &mut Self, run: &mut Run<'_, '_>, kind, level_mm| {
            place[normal] = level_mm;
            control.part(run, kind, place);
        };
        let turning = self.special.spindle;
        match hole.number {
            730 | 830 => {
                let off = PECK_CLEARANCE_INCH * gwatt_machine::units::MM_PER_INCH
                    / self.modal.mm_per_unit;
                let mut depth = hole.r - hole.peck;
                // In program units, so that it rounds as the control does.
                while depth > hole.bottom {
                    if !run.within_limits() {
                        return false;
                    }
                    let depth_mm = self.level(normal, depth);
                    to(self, run, Feed, depth_mm);
                    if hole.number == 830 {
                        to(self, run, Rapid, hole.r_mm);
                    }
                    let back_mm = self.level(normal, depth + off);
                    to(self, run, Rapid, back_mm);
                    let next = depth - hole.peck;
                    if next >= depth {
                        run.cycle_value(b'Q', "Q is too small for this depth");
                        return false;
                    }
                    depth = next;
                }
                to(self, run, Feed, bottom_mm);
                to(self, run, Rapid, hole.clear_mm);
            }
            740 | 840 => {
                let into = self.rs274_tap_end(place, bottom_mm, run);
                self.part(run, Tap, &into);
                run.spin(Turning::Stopped);
                run.spin(turning.reversed());
                self.dwell(run, hole.dwell_s);
                let out = self.rs274_tap_end(place, hole.clear_mm, run);
                self.part(run, Tap, &out);
                place[normal] = hole.clear_mm;
                if *place != out {
                    self.special.left = Some(*place);
                }
                run.spin(Turning::Stopped);
                run.spin(turning);
            }
            850 => {
                to(self, run, Feed, bottom_mm);
                to(self, run, Feed, hole.r_mm);
                to(self, run, Rapid, hole.clear_mm);
            }
            870 => self.rs274_back_bore(hole, place, run),
            _ => {
                to(self, run, Feed, bottom_mm);
                if hole.number != 810 {
                    self.dwell(run, hole.dwell_s);
                }
                match hole.number {
                    860 => {
                        run.spin(Turning::Stopped);
                        to(self, run, Rapid, hole.clear_mm);
                        run.spin(turning);
                    }
                    880 => {
                        run.spin(Turning::Stopped);
                        run.act(ActionKind::Stop, 0.0);
                        run.spin(turning);
                        // The operator retracts; the control counts on it.
                        place[normal] = hole.clear_mm;
                        self.special.left = Some(*place);
                    }
                    890 => to(self, run, Feed, hole.clear_mm),
                    _ => to(self, run, Rapid, hole.clear_mm),
                }
            }
        }
        run.within_limits()
    }

    /// Where a tap goes for a level of the drilling axis. Outside of G17 the
    /// interpreter 2.9 takes the coordinates for those of other axes; its own
    /// tests (`g84/g19`) have it so.
    fn rs274_tap_end(
        &self,
        place: &AxisValues,
        level_mm: f64,
        run: &mut Run<'_, '_>,
    ) -> AxisValues {
        let [first, second, normal] = self.modal.plane;
        let mut end = *place;
        end[normal] = level_mm;
        if normal == 2 {
            return end;
        }
        let whole = run.whole();
        let message = "LinuxCNC 2.9 takes the axes of G74 and G84 for others in G18 and G19: \
                       the moves are what it makes of them";
        run.report.note_once("mixed-axes", message, whole);
        let number = |axis: usize| end[axis] - self.position.absolute(axis, 0.0);
        let [aa, bb, cc] = [number(first), number(second), number(normal)];
        let mixed = if normal == 0 {
            [bb, cc, aa]
        } else {
            [cc, aa, bb]
        };
        for (axis, value) in mixed.into_iter().enumerate() {
            end[axis] = self.position.absolute(axis, value);
        }
        end
    }

    /// G87: through the hole next to its axis, then a counterbore from below.
    fn rs274_back_bore(&mut self, hole: &Hole, place: &mut AxisValues, run: &mut Run<'_, '_>) {
        use MoveKind::{Feed, Rapid};
        let [first, second, normal] = self.modal.plane;
        let bottom_mm = self.level(normal, hole.bottom);
        let middle_mm = self.level(normal, hole.middle);
        let turning = self.special.spindle;
        let mut shifted = *place;
        shifted[first] += hole.shift_mm[0];
        shifted[second] += hole.shift_mm[1];
        self.part(run, Rapid, &shifted);
        run.spin(Turning::Stopped);
        shifted[normal] = bottom_mm;
        self.part(run, Rapid, &shifted);
        place[normal] = bottom_mm;
        self.part(run, Rapid, place);
        run.spin(turning);
        place[normal] = middle_mm;
        self.part(run, Feed, place);
        place[normal] = bottom_mm;
        self.part(run, Feed, place);
        run.spin(Turning::Stopped);
        self.part(run, Rapid, &shifted);
        shifted[normal] = hole.clear_mm;
        self.part(run, Rapid, &shifted);
        place[normal] = hole.clear_mm;
        self.part(run, Rapid, place);
        run.spin(turning);
    }
}
