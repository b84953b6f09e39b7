//! The contour of a turning cycle, read line by line.

use super::piece::{Corner, Piece, Round};
use super::{LatheCycle, X, Z};
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::execute::Interpreter;
use crate::facts::Facts;
use crate::jump::Transfer;
use crate::report::{Diagnostics, Report};
use crate::vector::{Vector, add, left, length, scale, sub};
use gwatt_machine::{ALL_AXES, AxisValues};
use gwatt_syntax::Block;

/// What has been read of a contour.
#[derive(Debug)]
pub(crate) struct Reader {
    motion: Motion,
    /// Z and X, program units.
    at: Vector,
    pub(super) pieces: Vec<Piece>,
    /// Where the axes really stand, and which run of which line it is.
    home: AxisValues,
    run: (u32, u16),
}

impl Interpreter<'_> {
    /// Begins to read the contour of a cycle.
    pub(crate) fn begin_contour(&self, cycle: &LatheCycle) -> Reader {
        Reader {
            // The cycle begins with a rapid to its start.
            motion: Motion::Rapid,
            at: cycle.start,
            pieces: Vec::new(),
            home: self.control.position.at,
            run: (self.control.run, self.control.text),
        }
    }

    /// Reads a line of a contour, and gives where it goes on. What is wrong is
    /// reported.
    pub(crate) fn contour_line(
        &mut self,
        reader: &mut Reader,
        line: u64,
        text: &[u8],
        block: &mut Block,
        diagnostics: &mut Diagnostics,
    ) -> Option<Transfer> {
        let control = &mut self.control;
        let mut report = Report {
            diagnostics,
            line,
            text,
        };
        if control.block_delete.passes(block.delete_level) || block.tape {
            return None;
        }
        let errors = report.diagnostics.errors;
        if !block.issues.is_empty() {
            control.macro_words(block, &mut report);
            if report.diagnostics.errors != errors {
                return None;
            }
            if let Some(transfer) = control.transfer.take() {
                return Some(transfer);
            }
        }
        self.words
            .fill(block, &control.machine.controller, &mut report);
        if report.diagnostics.errors != errors {
            return None;
        }
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts: &mut Facts::default(),
            steps: &mut Vec::new(),
            report,
        };
        if let Err(message) = control.contour_words(reader, &mut run) {
            let whole = run.whole();
            run.report
                .error("lathe-cycle", message, whole)
                .help("write G0 to G3 with X and Z into the contour of a cycle");
        }
        None
    }

    /// The contour has been read, or given up.
    pub(crate) fn end_contour(&mut self, reader: &Reader) {
        self.control.position.at = reader.home;
        (self.control.run, self.control.text) = reader.run;
    }
}

impl Control<'_> {
    /// The words of one line of a contour.
    fn contour_words(
        &mut self,
        reader: &mut Reader,
        run: &mut Run<'_, '_>,
    ) -> Result<(), &'static str> {
        let unit = self.modal.mm_per_unit;
        for (code, ..) in &run.words.g {
            match code {
                GCode::Motion(Motion::Special(_)) | GCode::LatheCycle(_) => {
                    return Err("the contour of a cycle with another cycle");
                }
                GCode::Motion(motion) => reader.motion = *motion,
                _ => {}
            }
        }
        let from = reader.at;
        let mut to = from;
        let words = [(Z, b'W'), (X, b'U')];
        for (place, (axis, by)) in to.iter_mut().zip(words) {
            let given = run.words.take(ALL_AXES[axis].letter());
            if let Some(value) = run.words.take(by) {
                if given.is_some() || !self.modal.absolute {
                    return Err("U and W go with G90, and without X and Z");
                }
                *place += self.length_mm(axis, value) / unit;
            } else if let Some(value) = given {
                let value = self.length_mm(axis, value) / unit;
                *place = if self.modal.absolute {
                    value
                } else {
                    *place + value
                };
            }
        }
        if to == from {
            return Ok(());
        }
        reader.at = to;
        for (axis, value) in [(Z, to[0]), (X, to[1])] {
            // What the contour reads of its place.
            self.position.at[axis] = self.position.absolute(axis, value * unit);
        }
        let mut piece = Piece::line(from, to);
        match reader.motion {
            Motion::Rapid | Motion::Linear => {}
            Motion::ArcCw | Motion::ArcCcw => {
                let ccw = reader.motion == Motion::ArcCcw;
                let center = self.contour_center(from, to, ccw, run)?;
                piece.round = Some(Round { center, ccw });
            }
            _ => return Ok(()),
        }
        reader.pieces.push(piece);
        let corner = match (run.words.take(b'A'), run.words.take(b'C')) {
            (Some(_), Some(_)) => return Err("A and C at one corner"),
            (Some(size), None) => Corner::Fillet(size),
            (None, Some(size)) => Corner::Chamfer(size),
            (None, None) => return Ok(()),
        };
        reader.pieces.push(Piece::corner(to, corner));
        Ok(())
    }

    /// The centre of an arc of a contour.
    fn contour_center(
        &self,
        from: Vector,
        to: Vector,
        ccw: bool,
        run: &mut Run<'_, '_>,
    ) -> Result<Vector, &'static str> {
        let x = run.words.take(b'I');
        let z = run.words.take(b'K');
        if let Some(radius) = run.words.take(b'R') {
            if x.is_some() || z.is_some() {
                return Err("an arc with R and with a centre");
            }
            let chord = sub(to, from);
            let square = length(chord) * length(chord);
            let height = ((radius * radius - square / 4.0) / square).sqrt();
            if !height.is_finite() {
                return Err("R of an arc does not reach its end");
            }
            let side = if ccw { height } else { -height };
            let middle = scale(add(from, to), 0.5);
            return Ok(add(middle, scale(left(chord), side)));
        }
        if x.is_none() && z.is_none() {
            return Err("an arc without a centre (I, K) or R");
        }
        let center = [z.unwrap_or(0.0), x.unwrap_or(0.0)];
        Ok(if self.modal.arc_absolute {
            center
        } else {
            add(from, center)
        })
    }
}
