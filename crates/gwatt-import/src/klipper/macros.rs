//! Commands that stand in the configuration: macros, and what runs at the start.

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

/// Programs call macros, whose commands stand in the configuration.
pub(super) fn named(items: &[Item<'_>], found: &mut Found) {
    let list = |kind: &str| {
        let mut names: Vec<String> = Vec::new();
        for item in items {
            if let Some(name) = item.section.strip_prefix(kind) {
                let name = name.trim().to_ascii_uppercase();
                if usable(&name) && !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names
    };
    let (words, macros): (Vec<_>, Vec<_>) = list("gcode_macro ")
        .into_iter()
        .partition(|name| is_word(name));
    if !macros.is_empty() {
        found.language(array("unknown_macros", &macros), "[gcode_macro]");
        found.remarks.push(
            "What macros do: a program may call them, and they count as anything. A file NAME.gcode \
             with the commands that one comes to, in the program's folder or one given by --sub-path, \
             says it; what moves nothing and sets nothing goes into `ignored_macros`, what leaves feed \
             and modes as they are into `unknown_moves`"
                .to_owned(),
        );
    }
    if !words.is_empty() {
        found.remarks.push(format!(
            "Macros in place of words ({}): these count as the firmware's own",
            words.join(", ")
        ));
    }
    let delayed = list("delayed_gcode ").join(", ");
    if !delayed.is_empty() {
        found.remarks.push(format!(
            "Commands that run by themselves ([delayed_gcode] {delayed}): limits of speed and \
             acceleration in them count, macros and moves in them do not"
        ));
    }
}

/// Whether it is a name by which a program can call a macro.
fn usable(name: &str) -> bool {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    !name.is_empty() && name.len() <= 60 && name.bytes().all(plain)
}

/// Whether it is written as a word: `G28`, `M109`, `T0`.
fn is_word(name: &str) -> bool {
    let digits = name.strip_prefix(['G', 'M', 'T']).unwrap_or("");
    digits.starts_with(|first: char| first.is_ascii_digit())
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
