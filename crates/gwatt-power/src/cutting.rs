//! What cutting takes at the spindle.
//!
//! Input: the machine's tools, the tool in the spindle, and the kind of a move.
//! Output: a power at any feed, or a force at the speed of the feed: with the
//! specific cutting force `kc`, width `ae` and depth `ap`, `P = kc·ae·ap·vf`.

use gwatt_machine::{Cutting, CuttingTool, Machine};
use gwatt_motion::MoveKind;

/// What a tool takes: power at any feed in W, and force in N.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Taken {
    pub power_w: f64,
    pub force_n: f64,
}

/// The tools of a machine, and the one in use.
#[derive(Debug, Clone)]
pub(super) struct CuttingPower {
    tools: Vec<CuttingTool>,
    other_w: f64,
    /// T alone may change the tool.
    by_select: bool,
    loaded: f64,
    now: Taken,
}

impl CuttingPower {
    pub fn new(machine: &Machine) -> Self {
        let spindle = machine.spindle.as_ref();
        let other_w = spindle.map_or(0.0, |it| it.cutting_power_w);
        let language = &machine.controller.language;
        let mut cutting = Self {
            tools: machine.tools.clone(),
            other_w,
            by_select: language.family.facts().selected_tool_cuts || language.dialect.osp,
            loaded: 0.0,
            now: Taken::default(),
        };
        cutting.load(0.0);
        cutting
    }

    /// The tool in the spindle has changed.
    pub fn load(&mut self, number: f64) {
        self.loaded = number;
        self.now = self.of(number);
    }

    /// T: where that may change the tool, the one that takes more counts.
    pub fn select(&mut self, number: f64) {
        if self.by_select {
            let (old, new) = (self.of(self.loaded), self.of(number));
            self.now = Taken {
                power_w: old.power_w.max(new.power_w),
                force_n: old.force_n.max(new.force_n),
            };
        }
    }

    fn of(&self, number: f64) -> Taken {
        let tool = self.tools.iter().find(|tool| tool.number == number);
        let (power_w, force_n) = match tool.map(|tool| tool.cutting) {
            None => (self.other_w, 0.0),
            Some(Cutting::Power(power_w)) => (power_w, 0.0),
            Some(Cutting::Force(force_n)) => (0.0, force_n),
        };
        Taken { power_w, force_n }
    }

    /// What a move of that kind takes while the spindle turns.
    pub fn of_move(&self, kind: MoveKind) -> Taken {
        if cuts(kind) {
            self.now
        } else {
            Taken::default()
        }
    }

    /// What any move takes.
    pub fn largest(&self) -> Taken {
        self.now
    }
}

/// Whether a kind of move cuts.
pub(super) fn cuts(kind: MoveKind) -> bool {
    matches!(
        kind,
        MoveKind::Feed | MoveKind::Arc | MoveKind::Thread | MoveKind::Tap
    )
}
