//! Commands that stand in the configuration: macros, and what runs at the start.

use super::bodies::{self, Effect};
use crate::found::{Figure, Found, highest};
use crate::ini::Item;
use crate::near::Job;
use crate::text::{Log, Place};

/// Characters of a line of names.
const LINE_MAX: usize = 90;

/// Limits that are set before any program runs.
#[derive(Default)]
pub(super) struct AtStart {
    /// mm/s.
    pub(super) velocity: Option<Figure>,
    /// mm/s².
    pub(super) accel: Option<Figure>,
}

/// What `SET_VELOCITY_LIMIT` and M204 set in `[delayed_gcode]`, which runs by itself.
pub(super) fn at_start(job: &Job, log: &mut Log) -> AtStart {
    let mut found = AtStart::default();
    let mut runs = false;
    for (_, place) in job.places() {
        let line = place.line();
        if let Some(name) = line.strip_prefix('[') {
            runs = name.to_ascii_lowercase().starts_with("delayed_gcode ");
        }
        let code = line.split(['#', ';']).next().unwrap_or(line);
        let command = code.trim_start().to_ascii_uppercase();
        let sets = command.starts_with("SET_VELOCITY_LIMIT") || command.starts_with("M204");
        if runs && sets {
            limits(&mut found, log, &place, code);
        }
    }
    found
}

fn limits(found: &mut AtStart, log: &mut Log, place: &Place<'_>, code: &str) {
    for word in code.split_whitespace().skip(1) {
        let upper = word.to_ascii_uppercase();
        let (slot, length) = if upper.starts_with("VELOCITY=") {
            (&mut found.velocity, "VELOCITY=".len())
        } else if upper.starts_with("ACCEL=") {
            (&mut found.accel, "ACCEL=".len())
        } else if upper.starts_with(['S', 'P', 'T']) && !upper.contains('=') {
            (&mut found.accel, 1)
        } else {
            continue;
        };
        let value = word.get(length..).unwrap_or("");
        match value.parse::<f64>() {
            Ok(number) if number > 0.0 && number.is_finite() => {
                let source = place.source(&format!("at the start: {word}"));
                let set = Figure::new(number, source);
                *slot = highest(slot.take().into_iter().chain([set]));
            }
            _ => log.warning(
                &place.of(word),
                format!("`{word}` runs by itself and sets a limit that is not taken over"),
                "compare it with max_velocity and max_accel, and put the highest into the machine file",
            ),
        }
    }
}

/// Macros by what they do at most.
#[derive(Default)]
struct Lists {
    anything: Vec<String>,
    moves: Vec<String>,
    nothing: Vec<String>,
    /// Words that do what the firmware's do.
    plain: Vec<String>,
    /// The profile says that they do not park.
    timelapse: bool,
    /// The list in which G28 stands, which `[homing_override]` replaces.
    homing: &'static str,
}

impl Lists {
    fn add(&mut self, name: &str, effect: Effect) {
        let own = bodies::switched_by(name);
        if name.trim_start_matches('_').starts_with("TIMELAPSE_") {
            self.timelapse |= effect.moves;
            return;
        }
        let list = if effect.anything || effect.switches & !own != 0 {
            &mut self.anything
        } else if effect.moves && !(own != 0 && bodies::waits(name)) {
            &mut self.moves
        } else if own != 0 {
            &mut self.plain
        } else {
            &mut self.nothing
        };
        list.push(name.to_owned());
    }
}

/// Programs call macros, whose commands stand in the configuration: those in place of words too.
pub(super) fn named(job: &Job, items: &[Item<'_>], found: &mut Found, log: &mut Log) {
    let mut lists = Lists::default();
    let bodies = bodies::read(job);
    for body in bodies.iter().filter(|body| usable(&body.name)) {
        lists.add(&body.name, body.effect);
    }
    let homing = bodies.iter().find(|body| body.name.is_empty());
    if let Some(homing) = homing.filter(|_| bodies.iter().all(|body| body.name != "G28")) {
        let effect = Effect {
            moves: true,
            ..homing.effect
        };
        lists.add("G28", effect);
        let (list, what) = if lists.moves.last().is_some_and(|name| name == "G28") {
            ("unknown_moves", "and leaves feed and modes as they are")
        } else {
            (
                "unknown_macros",
                "and may leave another feed and other modes",
            )
        };
        lists.homing = list;
        let message = format!(
            "commands in place of G28: it counts with every axis at its full speed, {what}"
        );
        let help = format!("G28 stands in `{list}` under [language]");
        log.warning(&homing.place, message, &help);
    }
    write(&lists, found);
    let mut delayed: Vec<String> = Vec::new();
    for item in items {
        if let Some(name) = item.section.strip_prefix("delayed_gcode ") {
            let name = name.trim().to_ascii_uppercase();
            if usable(&name) && !delayed.contains(&name) {
                delayed.push(name);
            }
        }
    }
    let delayed = delayed.join(", ");
    if !delayed.is_empty() {
        found.remarks.push(format!(
            "Commands that run by themselves ([delayed_gcode] {delayed}): limits of speed and \
             acceleration in them count, macros and moves in them do not"
        ));
    }
}

fn write(lists: &Lists, found: &mut Found) {
    let fields = [
        ("unknown_macros", &lists.anything, "[gcode_macro]"),
        (
            "unknown_moves",
            &lists.moves,
            "[gcode_macro] that leave feed and modes as they are",
        ),
        (
            "ignored_macros",
            &lists.nothing,
            "[gcode_macro] that move nothing and set nothing",
        ),
    ];
    for (field, names, source) in fields {
        let source = match (field == lists.homing, names.len()) {
            (_, 0) => continue,
            (true, 1) => "[homing_override]".to_owned(),
            (true, _) => format!("{source}, [homing_override]"),
            (false, _) => source.to_owned(),
        };
        found.language(array(field, names), source);
    }
    if !lists.anything.is_empty() {
        found.remarks.push(
            "What macros do: a program may call them, and they count as anything. A file NAME.gcode \
             with the commands that one comes to, in the program's folder or one given by --sub-path, \
             says it; what moves nothing and sets nothing goes into `ignored_macros`, what leaves feed \
             and modes as they are into `unknown_moves`"
                .to_owned(),
        );
    }
    if !lists.plain.is_empty() {
        found.remarks.push(format!(
            "Macros in place of words that switch the same heaters and fans ({}): these count as the \
             firmware's own",
            lists.plain.join(", ")
        ));
    }
    if lists.timelapse {
        found.remarks.push(
            "Macros of timelapse: they count as moving nothing, as they come. Where parking is on, \
             list TIMELAPSE_TAKE_FRAME in `unknown_macros`"
                .to_owned(),
        );
    }
}

/// Whether it is a name by which a program can call a macro: of words with a point too, such as
/// `M73.1`.
fn usable(name: &str) -> bool {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let digits = name.strip_prefix(['G', 'M', 'T']).unwrap_or("");
    let (whole, part) = digits.split_once('.').unwrap_or((digits, "0"));
    let number = |digits: &str| {
        (1..=4).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    let word = number(whole) && number(part);
    word || !name.is_empty() && name.len() <= 60 && name.bytes().all(plain)
}

/// An array of names, on lines of its own where it is long.
fn array(field: &str, names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let line = format!("{field} = [{}]", quoted.join(", "));
    if line.len() <= LINE_MAX {
        return line;
    }
    let mut out = format!("{field} = [\n   ");
    let mut width = 3;
    for name in quoted {
        if width + name.len() + 2 > LINE_MAX {
            out.push_str("\n   ");
            width = 3;
        }
        width += name.len() + 2;
        out.push(' ');
        out.push_str(&name);
        out.push(',');
    }
    out + "\n]"
}
