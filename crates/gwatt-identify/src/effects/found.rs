//! All that a recording shows besides mass and friction: effects, and a limit of the force.

use super::super::equations::Equations;
use super::super::friction::{Friction, Solved};
use super::effect::{Effect, Saturation};
use super::saturation::{beyond, cut_off};
use super::search::{described, find, left_share};
use super::shape::Shape;

/// Where more of the force is left than this, a limit of the drive is looked for.
const LEFT: f64 = 0.05;
/// What a limit leaves is such a share of what is left without it, at most.
const BETTER: f64 = 0.6;

/// What was found.
pub struct Found {
    /// Equations with what was found.
    pub all: Vec<Equations>,
    /// Their solution.
    pub solved: Solved,
    /// The effects.
    pub effects: Vec<Effect>,
    /// What they are made of, for the equations of other recordings.
    pub shapes: Vec<Shape>,
    /// A limit of the force.
    pub saturation: Option<Saturation>,
    /// False where the force stands at a value so often that the rest shows no mass.
    pub is_known: bool,
}

/// Looks for effects, and for a limit of the force that explains more than they do.
pub fn found(all: &[Equations], asked: Option<Friction>, solved: &Solved) -> Found {
    if let Some(stands) = cut_off(all, asked, solved) {
        let is_known = stands.elsewhere.is_some();
        let elsewhere = stands.elsewhere;
        let (all, solved) = elsewhere.unwrap_or_else(|| (all.to_vec(), solved.clone()));
        return Found {
            saturation: Some(stands.saturation),
            is_known,
            ..with_effects(all, asked, solved)
        };
    }
    let plain = with_effects(all.to_vec(), asked, solved.clone());
    let left = left_share(&plain.all, &plain.solved);
    if left <= LEFT {
        return plain;
    }
    let Some((limit, solved, all)) = beyond(all, asked, solved) else {
        return plain;
    };
    let held = with_effects(all, asked, solved);
    if left_share(&held.all, &held.solved) > BETTER * left {
        return plain;
    }
    Found {
        saturation: Some(limit),
        ..held
    }
}

fn with_effects(all: Vec<Equations>, asked: Option<Friction>, solved: Solved) -> Found {
    match find(&all, asked, &solved) {
        Some(settled) => Found {
            effects: described(&settled),
            all: settled.all,
            solved: settled.solved,
            shapes: settled.shapes,
            saturation: None,
            is_known: true,
        },
        None => Found {
            all,
            solved,
            effects: Vec::new(),
            shapes: Vec::new(),
            saturation: None,
            is_known: true,
        },
    }
}
