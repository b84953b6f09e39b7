//! Slices of arcs and blends: raised chords of the power.

use super::super::arc_circle::Circle;
use super::super::arc_piece::{Piece, Sample};
use super::super::blend;
use super::super::quadrants::Pieces;
use super::super::search::Bounded;
use super::slice::Slice;
use super::{Flow, Tracer};
use gwatt_machine::AxisSet;
use gwatt_motion::{Arc, Move};
use gwatt_plan::{Blend, Phase, Profile};

/// Halvings of a piece between two quadrants.
const DEPTH: u32 = 12;
/// Turns of a cruise that are traced one by one.
const TURNS: f64 = 512.0;

impl Tracer<'_> {
    /// All axes along an arc or a helix.
    pub(super) fn arc(
        &self,
        mv: &Move,
        arc: &Arc,
        profile: &Profile,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        let circle = Circle::new(self.model, self.converter, mv, arc, idle_w);
        let reversed = circle.reversed();
        for phase in &profile.phases {
            for part in phase.parts() {
                if part.duration_s <= 0.0 {
                    continue;
                }
                let back = part.velocity_mm_s + part.end_velocity_mm_s < 0.0;
                if self.raised && back {
                    self.raised_back(mv, &part, out);
                } else if back {
                    self.turning(&reversed, &part.mirrored(), out);
                } else if self.raised {
                    self.raised_turn(mv, &circle, &part, out);
                } else {
                    self.turning(&circle, &part, out);
                }
            }
        }
    }

    /// The axes of a blend; `lead` is the line before it.
    pub(super) fn blend(
        &self,
        lead: &Move,
        blend: &Blend,
        profile: &Profile,
        out: &mut impl FnMut(Slice),
    ) {
        let active = blend::active(self.converter, blend);
        let idle_w = self.idle_w(lead, active);
        let circle = blend::circle(self.model, self.converter, blend, idle_w);
        let leading = self.directions(lead);
        let on_lead = AxisSet(lead.moving.0 & self.converter.axes.0);
        let cuts = blend::cuts(blend);
        for phase in &profile.phases {
            for piece in blend::pieces(phase, &cuts) {
                let on_line = piece.position_mm + 0.5 * piece.length_mm() < blend.lead_mm;
                if on_line && self.raised {
                    let idle_w = self.idle_w(lead, on_lead);
                    self.raised_phase(&leading, &piece, idle_w, out);
                } else if on_line {
                    let idle_w = self.idle_w(lead, on_lead);
                    self.straight_phase(&leading, &piece, idle_w, out);
                } else if self.raised {
                    self.raised_blend(lead, (blend, &circle), &piece, out);
                } else if piece.duration_s > 0.0 {
                    self.chords(&circle, &piece, (0.0, piece.duration_s), out);
                }
            }
        }
    }

    /// A phase on a circle, quadrant by quadrant in the order of time.
    pub(super) fn turning(&self, circle: &Circle<'_>, phase: &Phase, out: &mut impl FnMut(Slice)) {
        let mut pieces: Vec<(f64, f64, bool)> = Pieces::new(circle, phase).collect();
        pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
        let turn_s = circle.turn_s(phase);
        if !(phase.is_cruise() && turn_s < phase.duration_s) {
            for &(from, to, rest) in &pieces {
                self.quadrant(circle, phase, (from, to, rest), out);
            }
            return;
        }
        // A cruise repeats after each turn.
        let turns = libm::floor(phase.duration_s / turn_s);
        let mut left_s = phase.duration_s;
        if turns <= TURNS {
            let mut turn = Vec::new();
            for &piece in &pieces {
                self.quadrant(circle, phase, piece, &mut |slice| turn.push(slice));
            }
            for _ in 0..turns as u32 {
                for slice in &turn {
                    out(*slice);
                    left_s -= slice.duration_s;
                }
            }
            for slice in turn {
                if left_s <= 0.0 {
                    return;
                }
                let share = slice.at(left_s.min(slice.duration_s));
                out(slice.part(slice.from, share));
                left_s -= slice.duration_s;
            }
        }
        if left_s > 0.0 {
            self.quadrant(
                circle,
                phase,
                (0.0, left_s.min(turn_s), true),
                &mut |slice| {
                    out(Slice::constant(left_s, slice.power_w(0.0)));
                },
            );
        }
    }

    /// A piece between two quadrants; with `rest` what is left of the phase,
    /// which has too many.
    fn quadrant(
        &self,
        circle: &Circle<'_>,
        phase: &Phase,
        (from, to, rest): (f64, f64, bool),
        out: &mut impl FnMut(Slice),
    ) {
        if rest {
            let reach = circle.reach(phase, from, to);
            let power_w = circle.envelope(&reach, self.flow.side());
            out(Slice::constant(to - from, power_w));
        } else {
            self.chords(circle, phase, (from, to), out);
        }
    }

    /// Raised chords between two instants between which no axis turns back.
    pub(super) fn chords(
        &self,
        circle: &Circle<'_>,
        phase: &Phase,
        (from, to): (f64, f64),
        out: &mut impl FnMut(Slice),
    ) {
        if circle.axes.is_empty() {
            return self.at_rest(to - from, circle.idle_w, out);
        }
        let side = self.flow.side();
        let reach = circle.reach(phase, from, to);
        let piece = Piece::new(circle, phase, side, (from, to), &reach);
        let (first, last) = (piece.sample(from), piece.sample(to));
        self.chord(&piece, &first, &last, DEPTH, out);
    }

    fn chord(
        &self,
        piece: &Piece<'_>,
        first: &Sample,
        last: &Sample,
        depth: u32,
        out: &mut impl FnMut(Slice),
    ) {
        // Of what is fed back nobody asks for more than that it is none.
        let floor_w = match self.flow {
            Flow::Drawn => f64::NEG_INFINITY,
            Flow::FedBack => 0.0,
        };
        let value = |sample: &Sample| piece.value(sample).1.max(floor_w);
        let (t0, t1) = (piece.value(first).0, piece.value(last).0);
        let (start, end, bend) = piece.chord(first, last);
        let [start, end] = [start + bend, end + bend].map(|power| power.max(floor_w));
        let middle = 0.5 * (t0 + t1);
        let half = piece.sample(middle);
        // Where an axis turns from driving to braking the power has a kink below
        // the chord: no more than twice as deep as in the middle.
        let below = (0.5 * (start + end) - value(&half)).max(0.0);
        let excess = (start - value(first)).max(end - value(last)) + 2.0 * below;
        if excess <= self.tolerance_w || depth == 0 || middle <= t0 || middle >= t1 {
            out(Slice::linear(t1 - t0, start, end));
            return;
        }
        self.chord(piece, first, &half, depth - 1, out);
        self.chord(piece, &half, last, depth - 1, out);
    }
}
