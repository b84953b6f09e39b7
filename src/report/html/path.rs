//! The way of the tool in space, in bounded memory.
//!
//! Points lie in cells of a grid, and lines between the same two cells are one, with the
//! larger power. Where there are too many, lines that follow each other become one as long as
//! that stays within a cell's side of the way ([`joined`]); where that is not enough the cells
//! double. So what is drawn is nowhere farther from the way than that and half a cell's
//! diagonal, for any length of program.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::block::{Block, Passing};
use super::cell::{Cell, Line};
use super::joined::joined;
use crate::interpret::Arc;
use crate::pipeline::Route;

/// Lines that are kept.
pub(super) const LINES_MAX: usize = 10_000;
/// Lines that are left when room was made.
const ROOM: usize = 8_000;
/// The first cells, mm.
const CELL_MM: f64 = 1e-3;
/// Chords of one arc.
const CHORDS_MAX: f64 = 256.0;
/// How far a chord may be from its arc at first, mm.
const SAGITTA_MM: f64 = 5e-3;
/// How far later, by a cell's side.
const SAGITTA: f64 = 0.25;
/// Half the diagonal of a cell, by its side.
const HALF_DIAGONAL: f64 = 0.866_025_403_784_438_6;

/// The lines of a way.
#[derive(Debug)]
pub(super) struct Path {
    pub list: Vec<Line>,
    places: HashMap<[Cell; 2], usize>,
    /// How often the cells have doubled.
    doubled: u32,
    /// The largest distance of a chord from its arc, mm.
    sagitta_mm: f64,
    /// Moves that are not drawn, since their start is not known.
    pub unknown: u64,
}

impl Default for Path {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            places: HashMap::new(),
            doubled: 0,
            sagitta_mm: 0.0,
            unknown: 0,
        }
    }
}

impl Path {
    /// Side of a cell, mm.
    pub fn cell_mm(&self) -> f64 {
        CELL_MM * libm::exp2(f64::from(self.doubled))
    }

    /// How far what is drawn may be from the way, mm.
    pub fn error_mm(&self) -> f64 {
        let apart_mm = self.list.iter().map(|line| line.apart_mm);
        HALF_DIAGONAL * self.cell_mm() + apart_mm.fold(0.0, f64::max) + self.sagitta_mm
    }

    /// Takes the next row.
    pub fn add(&mut self, next: Passing<'_>) {
        let row = next.row;
        let Some(route) = &row.route else {
            self.unknown += u64::from(!row.axes.is_empty());
            return;
        };
        let xyz = |values: &[f64]| std::array::from_fn(|axis| values[axis]);
        let mut from: [f64; 3] = xyz(&route.start);
        let Some(arc) = &route.arc else {
            let to = xyz(&route.end);
            // What turns alone moves nothing in space.
            if from != to {
                self.line(next, [from, to]);
            }
            return;
        };
        let chords = self.chords(arc);
        for chord in 1..=chords as u32 {
            let to = point(route, arc, f64::from(chord) / chords);
            self.line(next, [from, to]);
            from = to;
        }
    }

    /// How many chords an arc gets.
    fn chords(&mut self, arc: &Arc) -> f64 {
        let (radius_mm, sweep) = (arc.radius_mm.abs(), arc.sweep_rad.abs());
        let allowed_mm = SAGITTA_MM.max(SAGITTA * self.cell_mm());
        let step = 2.0 * libm::acos((1.0 - allowed_mm / radius_mm).clamp(-1.0, 1.0));
        let chords = libm::ceil(sweep / step).clamp(1.0, CHORDS_MAX);
        let chords = if chords.is_nan() { 1.0 } else { chords };
        let half = (0.5 * sweep / chords).min(std::f64::consts::PI);
        let sagitta_mm = radius_mm * (1.0 - libm::cos(half));
        self.sagitta_mm = self.sagitta_mm.max(sagitta_mm);
        chords
    }

    fn line(&mut self, next: Passing<'_>, ends: [[f64; 3]; 2]) {
        let shift = self.doubled;
        let ends = ends.map(|point| point.map(|at| (libm::floor(at / CELL_MM) as i64) >> shift));
        if ends[0] == ends[1] {
            // It goes with the line that it lies at the end of.
            if let Some(last) = self.list.last_mut() {
                last.raise_row(next);
            }
            return;
        }
        match self.places.entry(key(ends)) {
            Entry::Occupied(place) => {
                if let Some(own) = self.list.get_mut(*place.get()) {
                    own.raise_row(next);
                }
            }
            Entry::Vacant(place) => {
                place.insert(self.list.len());
                let lead = next.keep();
                let apart_mm = 0.0;
                self.list.push(Line {
                    ends,
                    apart_mm,
                    lead,
                });
                if self.list.len() > LINES_MAX {
                    self.shrink();
                }
            }
        }
    }

    /// Makes room: fewer lines, and larger cells where that is not enough.
    fn shrink(&mut self) {
        loop {
            let lines = std::mem::take(&mut self.list);
            let joined = joined(lines, self.cell_mm());
            self.fill(joined);
            if self.list.len() <= ROOM {
                return;
            }
            self.doubled += 1;
            let mut lines = std::mem::take(&mut self.list);
            for line in &mut lines {
                line.ends = line.ends.map(|cell| cell.map(|at| at >> 1));
            }
            self.fill(lines);
        }
    }

    /// Takes these lines, of which some may be the same, or none.
    fn fill(&mut self, lines: Vec<Line>) {
        self.places.clear();
        let mut kept: Vec<Line> = Vec::with_capacity(LINES_MAX + 1);
        for line in lines {
            let same = if line.ends[0] == line.ends[1] {
                kept.last_mut()
            } else {
                match self.places.entry(key(line.ends)) {
                    Entry::Occupied(place) => kept.get_mut(*place.get()),
                    Entry::Vacant(place) => {
                        place.insert(kept.len());
                        kept.push(line);
                        continue;
                    }
                }
            };
            if let Some(same) = same {
                same.apart_mm = same.apart_mm.max(line.apart_mm);
                same.raise(line.lead);
            }
        }
        self.list = kept;
    }
}

impl Line {
    fn raise_row(&mut self, next: Passing<'_>) {
        if next.weight() > self.lead.passing().weight() {
            self.lead.replace(next);
        }
    }

    /// Takes what another row asks for.
    pub fn raise(&mut self, other: Block) {
        if other.passing().weight() > self.lead.passing().weight() {
            self.lead = other;
        }
    }
}

/// The same for both directions.
fn key([a, b]: [Cell; 2]) -> [Cell; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

/// Where an arc is after a share of it.
fn point(route: &Route, arc: &Arc, share: f64) -> [f64; 3] {
    let angle = arc.start_angle_rad + arc.sweep_rad * share;
    let (sin, cos) = libm::sincos(angle);
    std::array::from_fn(|axis| match arc.plane.iter().position(|own| *own == axis) {
        _ if share >= 1.0 => route.end[axis],
        Some(which) => arc.center[which] + arc.radius_mm * [cos, sin][which],
        None => route.start[axis] + (route.end[axis] - route.start[axis]) * share,
    })
}
