//! What gwatt makes of a program.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};

use gwatt::interpret::{Move, MoveKind, ParameterFile, ToolTable};
use gwatt::machine::{ALL_AXES, Machine};
use gwatt::pipeline::{Failure, Options, Reading, moves};

use super::event::{AXES, Event, Kind};

/// Nine axes under LinuxCNC, none of them slow.
pub fn machine() -> Machine {
    let mut text = String::from(
        "schema = 1\nname = \"conformance\"\ncontroller = \"linuxcnc\"\n[converter]\npeak_power_w = 1e9\n",
    );
    for axis in ["X", "Y", "Z", "U", "V", "W"] {
        let _ = write!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 1e5\naccel_mm_s2 = 1e4\nmass_kg = 10\n"
        );
    }
    for axis in ["A", "B", "C"] {
        let _ = write!(
            text,
            "[axes.{axis}]\nkind = \"rotary\"\nrapid_deg_min = 1e5\naccel_deg_s2 = 1e4\ninertia_kg_m2 = 1\n"
        );
    }
    let machine = Machine::from_toml("conformance.toml", &text);
    machine.expect("a machine").0
}

/// Its moves, or the rule and the sentence of the first error.
pub fn run(
    program: &Path,
    subs: &[PathBuf],
    table: Option<&Path>,
    machine: &Machine,
) -> Result<Vec<Event>, (String, String)> {
    let tools = table.map(|table| {
        let bytes = std::fs::read(table).expect("a tool table");
        ToolTable::parse(&bytes).expect("a tool table").into()
    });
    let reading = Reading {
        tools,
        // What the other one starts with.
        parameters: Some(ParameterFile::default().into()),
        sub_paths: subs.to_vec().into(),
        ..Reading::default()
    };
    let options = Options {
        reading,
        ..Options::default()
    };
    let input = File::open(program).expect("a program");
    let mut events = Vec::new();
    let result = moves(input, machine, &options, &mut |mv, _| {
        events.push(event(mv));
        Ok(())
    });
    match result {
        Ok(_) => Ok(events),
        Err(Failure::Refused { diagnostics, .. }) => {
            let error = diagnostics
                .iter()
                .find(|found| found.severity == gwatt::diagnostic::Severity::Error)
                .expect("an error");
            let place = error.line;
            Err((error.rule.to_owned(), format!("{place}: {}", error.message)))
        }
        Err(other) => panic!("{}: {other}", program.display()),
    }
}

fn event(mv: &Move) -> Event {
    let kind = match mv.kind {
        MoveKind::Rapid => Kind::Rapid,
        MoveKind::Feed | MoveKind::Thread | MoveKind::Tap | MoveKind::Probe => Kind::Feed,
        MoveKind::Arc => Kind::Arc,
        MoveKind::Dwell | MoveKind::Spindle => Kind::Dwell,
    };
    let place = |letter: u8| {
        let axis = ALL_AXES.iter().position(|axis| axis.letter() == letter);
        axis.expect("an axis")
    };
    let mut event = Event::new(kind, AXES.map(|letter| mv.end[place(letter)]));
    event.seconds = mv.dwell_s;
    // The spindle leads threads: rs274 prints their F, which does not count.
    let leads = matches!(mv.kind, MoveKind::Thread | MoveKind::Tap);
    event.feed = (mv.feed_mm_s.is_finite() && !leads).then_some(mv.feed_mm_s * 60.0);
    if let Some(arc) = &mv.arc {
        let axis = |axis: usize| {
            let letter = ALL_AXES[axis].letter();
            AXES.iter()
                .position(|known| *known == letter)
                .expect("an axis")
        };
        event.plane = arc.plane.map(axis);
        event.center = arc.center;
        let turns = arc.sweep_rad.abs() / std::f64::consts::TAU;
        // A full turn may be a hair more.
        let whole = (turns - 1e-4 / (1.0 + arc.radius_mm)).ceil().max(1.0);
        event.turns = whole as i64 * if arc.sweep_rad < 0.0 { -1 } else { 1 };
    }
    event
}
