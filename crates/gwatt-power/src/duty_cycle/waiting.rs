//! Moves that wait until it is known what the spindle draws next to them.

use super::rating::Place;
use super::span::Span;
use super::spindle_load::{Level, Levels};
use super::terms::Models;
use super::{Buffered, Track};
use crate::model::PowerModel;
use std::collections::VecDeque;

/// Moves whose spindle is not known yet.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    /// Which converter feeds the spindle.
    pub converter: usize,
    pub moves: VecDeque<Waits>,
    /// Room that is used again.
    pub spare: Vec<Buffered>,
}

/// A move whose spindle is not known yet.
#[derive(Debug)]
pub(super) struct Waits {
    pub place: Place,
    pub slices: Buffered,
    /// Powers by track, for a time that is not known.
    pub lasting: Option<(Vec<[f64; 3]>, Span)>,
}

impl Waiting {
    pub fn room(&mut self) -> Buffered {
        self.spare.pop().unwrap_or_default()
    }

    /// Hands the next move to the tracks, with the spindle in it.
    pub fn emit(
        &mut self,
        model: &PowerModel,
        models: &Models,
        levels: &[Level],
        tracks: &mut [Track],
    ) {
        let Some(mut waits) = self.moves.pop_front() else {
            return;
        };
        let converter = self.converter;
        for (index, track) in tracks.iter_mut().enumerate() {
            let mut spindle = Levels::new(levels, track, converter);
            let own = track.model(model, models);
            track.take_kept(index, own, &mut waits.slices, &mut spindle, waits.place);
            if let Some((powers, span)) = &waits.lasting
                && let Some(powers) = powers.get(index)
            {
                let [more_w, lasting_w] = [spindle.largest_w(), spindle.lasting_w()];
                let [drawn_w, fed_back_w, rest_w] = *powers;
                let powers = [drawn_w + more_w, fed_back_w + more_w, rest_w + lasting_w];
                track.span(powers, *span, waits.place);
            }
        }
        waits.slices.clear();
        self.spare.push(waits.slices);
    }
}
