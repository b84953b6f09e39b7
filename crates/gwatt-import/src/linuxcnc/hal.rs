//! HAL files: what they set for step generators and encoders.

use super::kinematics_module::by_name;
use crate::found::Found;
use crate::text::{File, Log, Text};

/// Pins whose values say something of a drive.
const PINS: [(&str, &str); 6] = [
    ("position-scale", "steps or counts per unit"),
    ("scale", "counts per unit"),
    ("maxvel", "largest speed, units per second"),
    ("maxaccel", "largest acceleration, units per second squared"),
    ("max-vel", "largest speed, units per second"),
    (
        "max-accel",
        "largest acceleration, units per second squared",
    ),
];

/// Comments by joint.
pub(crate) struct Hal {
    notes: Vec<(usize, String)>,
}

impl Hal {
    /// Reads `setp` lines of numbers; others name values of the INI file.
    pub(crate) fn new<'f>(files: impl Iterator<Item = &'f File>, log: &mut Log) -> Self {
        let mut notes = Vec::new();
        for file in files {
            let text = match Text::new(file) {
                Ok(text) => text,
                Err(refused) => {
                    log.list.push(*refused);
                    continue;
                }
            };
            for (number, line) in text.lines.iter().enumerate() {
                if let Some((joint, what)) = note(line) {
                    let name = file.name.rsplit(['/', '\\']).next().unwrap_or(&file.name);
                    notes.push((joint, format!("HAL, {what} ({name} line {})", number + 1)));
                }
            }
        }
        Self { notes }
    }

    /// What is known of a joint.
    pub(crate) fn of(&self, joint: usize) -> impl Iterator<Item = String> {
        let notes = self.notes.iter().filter(move |(of, _)| *of == joint);
        notes.map(|(_, note)| note.clone())
    }
}

/// `setp hm2_7i96s.0.stepgen.02.maxaccel 750`: the generator's number is the joint's.
fn note(line: &str) -> Option<(usize, String)> {
    let mut words = line.split('#').next()?.split_whitespace();
    if words.next()? != "setp" {
        return None;
    }
    let (pin, value) = (words.next()?, words.next()?);
    let value: f64 = value.trim_start_matches('=').parse().ok()?;
    let (before, name) = pin.rsplit_once('.')?;
    let (_, what) = PINS.iter().find(|(pin, _)| *pin == name)?;
    let (kind, number) = before.rsplit_once('.')?;
    let kind = kind.rsplit('.').next()?;
    matches!(kind, "stepgen" | "encoder").then_some(())?;
    Some((number.parse().ok()?, format!("{what}: {value}")))
}

/// A module of kinematics that a file loads.
pub(super) struct Module {
    pub(super) name: String,
    text: Text,
    line: usize,
}

impl Module {
    /// What it makes of the machine.
    pub(super) fn take(&self, found: &mut Found, log: &mut Log) {
        let place = self.text.place(self.line);
        let whole = place.line();
        let start = whole.find(&self.name).unwrap_or(0);
        let name = whole.get(start..start + self.name.len()).unwrap_or(whole);
        by_name(&self.name, whole.trim(), &place.of(name), found, log);
    }
}

/// The modules of kinematics that files of HAL load, each once: their names end in `kins`.
pub(super) fn modules(files: &[File]) -> Vec<Module> {
    let mut modules: Vec<Module> = Vec::new();
    let in_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    for file in files {
        let Ok(text) = Text::new(file) else { continue };
        let mut loaded = Vec::new();
        for (number, line) in text.lines.iter().enumerate() {
            let code = line.split('#').next().unwrap_or(line);
            // Python: `rt.loadRT('lineardeltakins')`.
            if !code.to_ascii_lowercase().contains("loadrt") {
                continue;
            }
            let names = code.split(|c| !in_name(c));
            let kins = names.filter(|name| name.ends_with("kins") && *name != "kins");
            loaded.extend(kins.map(|name| (number, name.to_owned())));
        }
        for (line, name) in loaded {
            if modules.iter().all(|known| known.name != name)
                && let Ok(text) = Text::new(file)
            {
                modules.push(Module { name, text, line });
            }
        }
    }
    modules
}
