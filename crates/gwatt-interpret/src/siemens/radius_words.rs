//! Words of cutter radius compensation.

use super::code::Code;
use super::reading::Reading;
use super::value::{Kind, Val};
use super::{Siemens, frame_words};
use crate::code::GCode;
use crate::compensation::{Choice, ContourFeed};
use crate::control::{Control, Run};
use crate::expression::{Grammar, Outcome};

/// Edges of tools that a program may describe.
const EDGES_MAX: usize = 10_000;

impl Reading<'_, '_, '_> {
    /// NORM, KONT and similar words, CFC and similar words, DISC.
    pub(super) fn radius_word(&mut self, name: &str, start: usize) -> Outcome<()> {
        if name == "DISC" {
            self.state.radius.rounded = self.value_behind(name, start)? != 0.0;
        }
        let radius = &mut self.state.radius;
        match name {
            "NORM" => radius.kont = false,
            "CFC" => radius.feed = ContourFeed::Contour,
            "CFTCP" => radius.feed = ContourFeed::Center,
            "CFIN" => radius.feed = ContourFeed::Inside,
            "DISC" => {}
            _ => radius.kont = true,
        }
        Ok(())
    }

    /// `$TC_DP6[t, d] = …`, and its wear.
    pub(super) fn set_radius(&mut self, wear: bool, start: usize) -> Outcome<()> {
        let index = self.index()?;
        self.cursor.expect(b'=')?;
        let Ok(Val::Number(value)) = Kind::Real.convert(self.expression()?) else {
            let message = "the radius of a tool is a number";
            let help = "write it in mm";
            return Err(self.cursor.fault("assignment", message, help, start));
        };
        let [tool, edge, _] = index.map(|index| u32::try_from(index).unwrap_or(0));
        let set = &mut self.state.radius.set;
        if set.len() >= EDGES_MAX && !set.contains_key(&(tool, edge)) {
            let message = "the program describes more than 10000 edges of tools";
            let help = "give them in a tool table";
            return Err(self.cursor.fault("assignment", message, help, start));
        }
        set.entry((tool, edge)).or_default()[usize::from(wear)] = value;
        Ok(())
    }
}

impl Control<'_> {
    /// Takes D, G450 and G451, and what is in force for G41 and G42.
    pub(super) fn choose_radius(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        for (code, ..) in &run.words.g {
            if let GCode::Siemens(Code::Intersects(on)) = code {
                state.radius.intersects = *on;
            }
        }
        let span = run.words.span(b'D', run.block);
        if let Some(edge) = run.words.take(b'D') {
            if edge > 0.0 {
                run.report
                    .note_once("no-tool-table", frame_words::NO_TOOLS, span);
            }
            self.choice.number = Some(edge as u32);
        }
        let tool = Some(self.tools.loaded).filter(|tool| *tool != 0);
        let key = (
            tool.unwrap_or(self.tools.selected),
            self.choice.number.unwrap_or(1),
        );
        let set = state.radius.set.get(&key);
        self.choice = Choice {
            number: self.choice.number,
            radius_mm: set.map(|[radius, wear]| radius + wear),
            intersects: state.radius.intersects,
            feed: state.radius.feed,
            flipped: state
                .frame
                .plane(self.modal.plane)
                .is_some_and(|(_, flipped)| flipped),
            refused: state.radius.refused(),
        };
    }
}
