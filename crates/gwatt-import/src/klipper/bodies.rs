//! What macros do at most, read from their commands. Both branches of a template count.
//!
//! Source: Klipper documentation, "Commands templates"; how lines are cut,
//! `klippy/configfile.py` and `klippy/gcode.py`.

use gwatt_machine::{Command, Controller, builtin_controller};

use crate::near::Job;
use crate::text::Place;

/// What commands do at most.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Effect {
    /// Anything: moves, heaters, limits, and another feed and other modes.
    pub(super) anything: bool,
    /// Moves or stops that leave feed and modes as they are.
    pub(super) moves: bool,
    /// Heaters and fans that are switched, a bit for each of [`SWITCHES`].
    pub(super) switches: u8,
}

impl Effect {
    const ANYTHING: Self = Self {
        anything: true,
        moves: true,
        switches: 0,
    };

    const MOVES: Self = Self {
        anything: false,
        moves: true,
        switches: 0,
    };

    fn and(self, other: Self) -> Self {
        Self {
            anything: self.anything || other.anything,
            moves: self.moves || other.moves,
            switches: self.switches | other.switches,
        }
    }
}

/// Words that switch the same heater or fan.
const SWITCHES: [&[&str]; 3] = [&["M104", "M109"], &["M140", "M190"], &["M106", "M107"]];

/// Words that wait until something is reached.
const WAITS: [&str; 4] = ["G4", "M400", "M109", "M190"];

/// Commands of which programs get a note: what they set is not counted.
const NOTED: [&str; 6] = [
    "M375",
    "M420",
    "M566",
    "M572",
    "M900",
    "SET_PRESSURE_ADVANCE",
];

/// What a word switches, as bits.
pub(super) fn switched_by(name: &str) -> u8 {
    let bits = SWITCHES.iter().zip([1, 2, 4]);
    bits.filter(|(words, _)| words.contains(&name))
        .fold(0, |all, (_, bit)| all | bit)
}

/// Whether it waits of itself.
pub(super) fn waits(name: &str) -> bool {
    WAITS.contains(&name)
}

/// Commands that stand in the configuration.
pub(super) struct Body<'t> {
    /// In capitals; empty for `[homing_override]`, which no command calls.
    pub(super) name: String,
    /// Where its section begins.
    pub(super) place: Place<'t>,
    rename: Option<String>,
    text: Option<String>,
    pub(super) effect: Effect,
}

/// The macros, and `[homing_override]`, with what they do.
pub(super) fn read(job: &Job) -> Vec<Body<'_>> {
    let mut bodies = collect(job);
    let profile = builtin_controller("klipper");
    let lines: Vec<Option<Vec<String>>> = bodies
        .iter()
        .map(|body| body.text.as_deref().and_then(commands))
        .collect();
    // What they call may call them: again until nothing is added.
    loop {
        let next: Vec<Effect> = lines
            .iter()
            .map(|lines| match lines {
                None => Effect::ANYTHING,
                Some(lines) => lines.iter().fold(Effect::default(), |all, line| {
                    all.and(of_line(line, &bodies, profile.as_ref()))
                }),
            })
            .collect();
        let mut changed = false;
        for (body, next) in bodies.iter_mut().zip(next) {
            changed |= body.effect != next;
            body.effect = next;
        }
        if !changed {
            return bodies;
        }
    }
}

fn collect(job: &Job) -> Vec<Body<'_>> {
    let mut bodies: Vec<Body<'_>> = Vec::new();
    let mut current: Option<usize> = None;
    let mut key: Option<String> = None;
    let mut last_piece = 0;
    for (piece, place) in job.places() {
        if piece != last_piece {
            (current, key, last_piece) = (None, None, piece);
        }
        let code = without_comment(place.line());
        let trimmed = code.trim();
        if trimmed.is_empty() {
            continue;
        }
        if code.starts_with([' ', '\t'])
            && let Some(key) = &key
        {
            add(&mut bodies, current, key, code);
        } else if let Some(section) = trimmed.strip_prefix('[') {
            let section = section.split(']').next().unwrap_or("").trim();
            key = None;
            current = name(section).map(|name| {
                let known = bodies.iter().position(|body| body.name == name);
                known.unwrap_or_else(|| {
                    bodies.push(Body {
                        name,
                        place: place.of(trimmed),
                        rename: None,
                        text: None,
                        effect: Effect::default(),
                    });
                    bodies.len() - 1
                })
            });
        } else if let Some((name, value)) = trimmed.split_once([':', '=']) {
            let name = name.trim().to_ascii_lowercase();
            add(&mut bodies, current, &name, value.trim());
            key = Some(name);
        }
    }
    bodies
}

/// Klipper drops what follows `#`, and `;` after a blank.
fn without_comment(line: &str) -> &str {
    let code = line.split('#').next().unwrap_or("");
    let end = code.match_indices(';').map(|(at, _)| at).find(|at| {
        code.get(..*at)
            .is_some_and(|it| it.is_empty() || it.ends_with([' ', '\t']))
    });
    end.and_then(|end| code.get(..end)).unwrap_or(code)
}

/// The name of a section with commands.
fn name(section: &str) -> Option<String> {
    if section == "homing_override" {
        return Some(String::new());
    }
    let name = section.strip_prefix("gcode_macro ")?.trim();
    (!name.is_empty()).then(|| name.to_ascii_uppercase())
}

/// Adds a line of a value. Where a macro stands twice, both count.
fn add(bodies: &mut [Body<'_>], current: Option<usize>, key: &str, line: &str) {
    let Some(body) = current.and_then(|at| bodies.get_mut(at)) else {
        return;
    };
    match key {
        "gcode" => {
            let text = body.text.get_or_insert_default();
            text.push_str(line);
            text.push('\n');
        }
        "rename_existing" => body.rename = Some(line.trim().to_ascii_uppercase()),
        _ => {}
    }
}

/// The commands of a template, without its tags; `None` where one has no end.
fn commands(text: &str) -> Option<Vec<String>> {
    let mut plain = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("{%").into_iter().chain(rest.find("{#")).min() {
        let (before, tag) = rest.split_at_checked(at)?;
        let end = if tag.starts_with("{%") { "%}" } else { "#}" };
        plain.push_str(before);
        plain.push('\n');
        let (_, after) = tag.split_once(end)?;
        rest = after;
    }
    plain.push_str(rest);
    let lines = plain
        .lines()
        .map(|line| line.split(';').next().unwrap_or("").trim());
    Some(
        lines
            .filter(|line| !line.is_empty())
            .map(str::to_owned)
            .collect(),
    )
}

/// What a command does.
fn of_line(line: &str, bodies: &[Body<'_>], profile: Option<&Controller>) -> Effect {
    if let Some(expression) = line.strip_prefix('{') {
        // `{action_respond_info("…")}`: nothing that moves.
        let inner = expression.strip_suffix('}').unwrap_or("{").trim_start();
        let acts = inner.starts_with("action_") && !inner.contains(['{', '}']);
        return if acts {
            Effect::default()
        } else {
            Effect::ANYTHING
        };
    }
    let word = line.split_whitespace().next().unwrap_or("");
    let upper = word.to_ascii_uppercase();
    let letters = upper.trim_start_matches(|c: char| c.is_ascii_uppercase() || c == '_');
    let rest = letters.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let name = upper.strip_suffix(rest).unwrap_or("");
    if letters.len() == upper.len() || word.contains('{') {
        return Effect::ANYTHING;
    }
    let original = bodies
        .iter()
        .find(|body| body.rename.as_deref() == Some(name));
    if let Some(body) = original {
        return firmware(&body.name, line, bodies, profile);
    }
    match bodies.iter().find(|body| body.name == name) {
        Some(body) => body.effect,
        None => firmware(name, line, bodies, profile),
    }
}

/// What the firmware itself does at a command.
fn firmware(name: &str, line: &str, bodies: &[Body<'_>], profile: Option<&Controller>) -> Effect {
    let Some(profile) = profile else {
        return Effect::ANYTHING;
    };
    let switches = match name {
        "SET_HEATER_TEMPERATURE" => heater(line),
        _ => switched_by(name),
    };
    let quiet = Effect {
        switches,
        moves: waits(name),
        anything: NOTED.contains(&name) || name == "BED_MESH_PROFILE",
    };
    if quiet != Effect::default() {
        return quiet;
    }
    if name == "G28" {
        let own = bodies.iter().find(|body| body.name.is_empty());
        return Effect::MOVES.and(own.map_or(Effect::default(), |body| body.effect));
    }
    let language = &profile.language;
    let printer = &language.printer;
    let code = code(name);
    let listed = |list: &[Command]| {
        let mut list = list.iter();
        list.any(|one| match code {
            Some((letter, number)) => one.is_code(letter, number),
            None => one.is_macro(name.as_bytes()),
        })
    };
    let passed = match code {
        Some((b'G', number)) => language.ignored_g.contains(&number),
        Some((b'M', number)) => language.ignored_m.contains(&(number / 10)),
        _ => false,
    };
    if passed || listed(&printer.ignored_macros) {
        Effect::default()
    } else if listed(&printer.unknown_moves) {
        Effect::MOVES
    } else {
        Effect::ANYTHING
    }
}

/// The heater that `SET_HEATER_TEMPERATURE` names; of another one nothing is known: all bits.
fn heater(line: &str) -> u8 {
    let upper = line.to_ascii_uppercase();
    let mut names = upper
        .split_whitespace()
        .filter_map(|word| word.strip_prefix("HEATER="));
    match names.next() {
        Some("EXTRUDER") => switched_by("M104"),
        Some("HEATER_BED") => switched_by("M140"),
        _ => u8::MAX,
    }
}

/// Letter and number × 10 of a word such as `G28` or `M73.1`.
fn code(name: &str) -> Option<(u8, u16)> {
    let (letter, digits) = name.split_at_checked(1)?;
    let plain = digits.starts_with(|c: char| c.is_ascii_digit());
    let number: f64 = digits.parse().ok().filter(|_| plain)?;
    let tenfold = number * 10.0;
    let exact = (tenfold - tenfold.round()).abs() < 1e-6;
    let number = format!("{tenfold:.0}").parse().ok()?;
    exact.then_some((*letter.as_bytes().first()?, number))
}
