//! G40, G41, G42, G41.1 and G42.1.

use super::hold::Hold;
use super::{Compensation, State};
use crate::code::GCode;
use crate::control::{Control, Run};
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{CompensationCorner, CompensationLead, CutterCompensation};
use gwatt_syntax::source::Span;

/// Planes that can be compensated, by their normal axis: XY and ZX.
const NORMALS: [usize; 2] = [2, 1];

/// What cuts: the radius of a tool's edge, and where a lathe tool's edge lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Nose {
    /// Radius in mm; a negative one exchanges the sides.
    pub(super) radius_mm: f64,
    /// Orientation of a lathe tool, 0 to 9.
    pub(super) orientation: u8,
}

impl Nose {
    /// No radius: the path stays as it is programmed.
    pub(super) const POINT: Self = Self {
        radius_mm: 0.0,
        orientation: 0,
    };
}

impl Control<'_> {
    /// The edge of a tool by its number, without one of the tool in the
    /// spindle; nothing where it is not known.
    fn tool_nose(&self, number: Option<f64>) -> Option<Nose> {
        let number = match number {
            Some(value) if value.fract() == 0.0 && (0.0..=1e8).contains(&value) => {
                Some(value as u32)
            }
            Some(_) => return None,
            None => None,
        };
        let (radius_mm, orientation) = self.tool_edge(number)?;
        Some(Nose {
            radius_mm,
            orientation,
        })
    }

    /// Switches the compensation, and refuses what may not be written under it.
    /// Called before the other settings of a block.
    #[inline]
    pub(crate) fn compensation_words(&mut self, run: &mut Run<'_, '_>) {
        if self.compensation.is_none() && run.words.groups & GCode::CompensationOff.group() == 0 {
            return;
        }
        self.switch_compensation(run);
    }

    #[cold]
    fn switch_compensation(&mut self, run: &mut Run<'_, '_>) {
        if self.is_compensating() {
            self.refuse_before(run);
            self.choose_anew(run);
        }
        for index in 0..run.words.g.len() {
            let (code, _, span) = run.words.g[index];
            match code {
                GCode::CompensationOff => self.compensation_off(),
                GCode::CompensationOn { left, by_diameter } => {
                    self.compensation_on(left, by_diameter, span, run);
                }
                _ => {}
            }
        }
        if self.is_compensating() {
            self.refuse_behind(run);
        }
    }

    /// Whether G41 or G42 is in force and shifts the path.
    pub(crate) fn is_compensating(&self) -> bool {
        let compensation = self.compensation.as_ref();
        compensation.is_some_and(|it| it.is_on() && !it.passive)
    }

    /// What SINUMERIK may change while it is on: outside corners, and what F
    /// speaks for.
    fn choose_anew(&mut self, run: &mut Run<'_, '_>) {
        let Some(compensation) = self
            .compensation
            .as_mut()
            .filter(|_| self.rules.compensation_changes)
        else {
            return;
        };
        compensation.feed = self.choice.feed;
        compensation.style.corner = if self.choice.intersects {
            CompensationCorner::Intersection
        } else {
            CompensationCorner::Arc
        };
        let plane = compensation.plane;
        let before = compensation.flipped;
        let flipped = self.plane_is_flipped(plane, 3 - plane[0] - plane[1]);
        if flipped != before {
            if let Some(compensation) = &mut self.compensation {
                compensation.flipped = flipped;
            }
            let whole = run.whole();
            run.report
                .error("compensation", "mirroring under cutter compensation", whole)
                .help("switch the compensation off before: G40");
        }
    }

    fn compensation_off(&mut self) {
        if let Some(compensation) = &mut self.compensation {
            compensation.state = match compensation.state {
                _ if compensation.passive => State::Off,
                State::On => State::Leaving,
                State::Entry => compensation.behind_entry(),
                other => other,
            };
        }
    }

    /// The plane and the unit that hold for a compensation: what the block itself sets counts.
    fn plane_and_unit(&self, run: &Run<'_, '_>) -> ([usize; 3], f64) {
        let (mut plane, mut mm_per_unit) = (self.modal.plane, self.modal.mm_per_unit);
        for (code, ..) in &run.words.g {
            match *code {
                GCode::Plane(new) => plane = new,
                GCode::Units { mm_per_unit: new } => mm_per_unit = new,
                _ => {}
            }
        }
        (plane, mm_per_unit)
    }

    fn compensation_on(
        &mut self,
        left: bool,
        by_diameter: bool,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let Some(style) = self.compensation_style(span, run) else {
            return;
        };
        if self.is_compensating() {
            run.report
                .error("compensation", "cutter compensation is on already", span)
                .help("switch it off before: G40");
            return;
        }
        let (plane, mm_per_unit) = self.plane_and_unit(run);
        let [first, second, normal] = plane;
        let at_end = style.lead == CompensationLead::AtEnd;
        if at_end && !NORMALS.contains(&normal) {
            run.report
                .error(
                    "compensation",
                    "cutter compensation works in the planes XY and ZX only",
                    span,
                )
                .help("choose the plane before: G17 or G18");
            return;
        }
        let nose = if by_diameter {
            nose_by_words(run, mm_per_unit, normal, span)
        } else if at_end {
            self.nose_by_number(run, span)
        } else {
            self.nose_by_offset(run, span)
        };
        let Some(nose) = nose else { return };
        let nose = if self.turning.reads_rough {
            // "Tool Nose Radius Compensation", "Canned Cycles": G70 has it alone.
            Nose::POINT
        } else {
            nose
        };
        let passive = !at_end && nose.radius_mm == 0.0;
        if !passive && self.refuse_style(span, run) {
            return;
        }
        let plane = [first, second];
        let leaving = self
            .compensation
            .take()
            .filter(|before| before.state == State::Leaving);
        let (tool, straight_first) = match leaving {
            Some(before) if !at_end || before.plane != plane || nose.radius_mm == 0.0 => {
                let message = "the tool has not left the compensation before this one";
                run.report
                    .error("compensation", message, span)
                    .help("write a straight move in the plane after G40");
                return;
            }
            Some(before) => (before.hold.tool, true),
            None => (plane.map(|axis| self.position.at[axis]), false),
        };
        let flipped = self.plane_is_flipped(plane, normal);
        let left = (left == (nose.radius_mm >= 0.0)) != flipped;
        let radius_mm = nose.radius_mm.abs();
        let mut shift = nose_shift(nose.orientation, radius_mm, normal);
        if !at_end {
            // Fanuc's picture ("Direction of Imaginary Tool Nose") has +X up
            // where LinuxCNC's has it down.
            shift[1] = -shift[1];
        }
        self.compensation = Some(Box::new(Compensation {
            state: State::Entry,
            style,
            passive,
            entering: false,
            moved: false,
            idle: 0,
            feed: self.choice.feed,
            flipped,
            plane,
            side: if left { 1.0 } else { -1.0 },
            radius_mm,
            nose: shift,
            straight_first,
            hold: Hold::new(plane, tool, shift, mm_per_unit == MM_PER_INCH),
            texts: Vec::new(),
            own: Vec::new(),
        }));
    }

    /// How the control shifts paths; reported where that is not known.
    fn compensation_style(&self, span: Span, run: &mut Run<'_, '_>) -> Option<CutterCompensation> {
        let language = &self.machine.controller.language;
        if let Some(mut style) = language.compensation {
            if self.choice.intersects {
                style.corner = CompensationCorner::Intersection;
            }
            return Some(style);
        }
        if self.rules.corners_may_be_unknown {
            // Enough for a radius of 0; see `refuse_style`.
            return Some(CutterCompensation {
                corner: CompensationCorner::Line,
                lead: CompensationLead::Perpendicular,
                idle_blocks: 0,
            });
        }
        run.report
            .error(
                "unsupported-code",
                "cutter compensation, which this controller does not have",
                span,
            )
            .help("let the CAM system shift the path by the tool's radius");
        None
    }

    /// Whether a path cannot be shifted though the radius is known.
    fn refuse_style(&self, span: Span, run: &mut Run<'_, '_>) -> bool {
        let refused = if self.machine.controller.language.compensation.is_none() {
            Some("how this controller shifts a path in corners is not known")
        } else {
            self.choice.refused
        };
        let Some(message) = refused else {
            return false;
        };
        run.report
            .error("compensation", message, span)
            .help("let the CAM system shift the path by the tool's radius");
        true
    }

    /// Whether the plane is mirrored: left is then right.
    fn plane_is_flipped(&self, [first, second]: [usize; 2], normal: usize) -> bool {
        let map = self.position.frame.plane([first, second, normal]);
        self.choice.flipped != map.is_some_and(|map| map.flipped)
    }

    /// G41 and G42: the tool of D, or the one in the spindle.
    fn nose_by_number(&self, run: &mut Run<'_, '_>, span: Span) -> Option<Nose> {
        let number = run.words.take(b'D');
        if number.is_some_and(|number| number < 0.0 || number.fract() != 0.0) {
            let span = run.words.span(b'D', run.block);
            run.report
                .error("compensation", "D must be the number of a tool", span)
                .help("write a whole number; a diameter goes with G41.1 and G42.1");
            return None;
        }
        let number = number.filter(|number| *number != 0.0);
        let nose = self.tool_nose(number);
        if nose.is_none() {
            let message = number.map_or_else(
                || "the radius of the tool in the spindle is not known".to_owned(),
                |number| format!("the radius of tool {number} is not known"),
            );
            run.report
                .error("tool-radius", message, span)
                .help("give the tool table: --tool-table FILE, or write the diameter: G41.1 D…");
        }
        nose
    }
}

impl Compensation {
    /// G40 before any move: as if there had been nothing, unless the tool is
    /// still next to the path of a compensation before.
    fn behind_entry(&self) -> State {
        if self.straight_first {
            State::Leaving
        } else {
            State::Off
        }
    }
}

/// G41.1 and G42.1: the diameter of D, and on a lathe the orientation of L.
fn nose_by_words(
    run: &mut Run<'_, '_>,
    mm_per_unit: f64,
    normal: usize,
    span: Span,
) -> Option<Nose> {
    let orientation = run.words.take(b'L').unwrap_or(0.0);
    let Some(diameter) = run.words.take(b'D') else {
        run.report
            .error(
                "tool-radius",
                "G41.1 and G42.1 need the diameter of the tool",
                span,
            )
            .help("write it: D…");
        return None;
    };
    let at = run.words.span(b'L', run.block);
    if orientation != 0.0 && normal != 1 {
        run.report
            .error("compensation", "an orientation without G18", at)
            .help("L goes with the plane of a lathe: G18");
        return None;
    }
    if !(0.0..=9.0).contains(&orientation) || orientation.fract() != 0.0 {
        run.report
            .error("compensation", "L must be the orientation of the tool", at)
            .help("write a whole number from 0 to 9");
        return None;
    }
    Some(Nose {
        radius_mm: diameter * mm_per_unit / 2.0,
        orientation: orientation as u8,
    })
}

/// From the centre of a lathe tool's edge to its controlled point, (Z, X).
/// Orientations by the picture in the manual, "Lathe User Information", "Tool
/// Orientations"; nothing in other planes.
fn nose_shift(orientation: u8, radius_mm: f64, normal: usize) -> [f64; 2] {
    if normal != 1 {
        return [0.0; 2];
    }
    let (z, x) = match orientation {
        1 => (1.0, -1.0),
        2 => (-1.0, -1.0),
        3 => (-1.0, 1.0),
        4 => (1.0, 1.0),
        5 => (1.0, 0.0),
        6 => (0.0, -1.0),
        7 => (-1.0, 0.0),
        8 => (0.0, 1.0),
        _ => (0.0, 0.0),
    };
    [z * radius_mm, x * radius_mm]
}
