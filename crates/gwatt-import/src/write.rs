//! What was found as the text of a machine file.

use std::fmt::Write as _;

use gwatt_machine::{ALL_AXES, AxisId};

use crate::found::{Build, Entry, Figure, Found, FoundAxis, shown};
use crate::kinematics::pair;

/// Where comments next to fields begin.
const COLUMN: usize = 29;

/// The text of the machine file.
pub(crate) fn machine_file(found: &Found, files: &[String]) -> String {
    let mut out = String::new();
    head(&mut out, found, files);
    converter(&mut out, found);
    table(&mut out, "path", &found.path);
    table(&mut out, "language", &found.language);
    table(&mut out, "look_ahead", &found.look_ahead);
    if let Some((rule, fields)) = &found.corner {
        table(&mut out, &format!("look_ahead.{rule}"), fields);
    }
    for (id, axis) in ALL_AXES.into_iter().zip(&found.axes) {
        if let Some(axis) = axis {
            axis_table(&mut out, id, axis, found);
        }
    }
    for table in &found.tables {
        let _ = write!(out, "\n{table}");
    }
    heaters(&mut out, found);
    spindle(&mut out, found);
    out.push_str("\n[limits]\n");
    line(
        &mut out,
        "margin = 0.1",
        "share of the peak power that is kept free",
    );
    for entry in &found.limits {
        line(&mut out, &entry.field, &entry.source);
    }
    out
}

fn head(out: &mut String, found: &Found, files: &[String]) {
    let name = one_line(&found.name);
    let _ = writeln!(out, "# {name}, from {}", one_line(&files.join(", ")));
    out.push_str(
        "#\n# Every value has its source next to it. What that file cannot know is asked for below:\n\
         # peak power of the supply, masses and friction. `gwatt machine check` names what is\n\
         # still missing.\n#\n",
    );
    out.push_str(match found.build {
        Build::Screws => {
            "# For example an axis that moves 60 kg by a screw of 20 x 800 mm with a lead of 10 mm and\n\
             # a rotor of 1.2 kg cm2 (data sheet of the motor; 1 kg cm2 is 0.0001 kg m2):\n\
             #\n\
             #     moved_mass_kg = 60\n\
             #     rotor_kg_m2 = 0.00012\n\
             #     screw = { diameter_mm = 20, length_mm = 800, lead_mm = 10 }\n\
             #     coulomb_n = 100\n\
             #     efficiency = 0.85\n\
             #\n\
             # That is 60 kg + 47.4 kg of the rotor + 38.9 kg of the screw: 146 kg. At 30000 mm/min\n\
             # and 3000 mm/s2 it draws 0.5 m/s x (146.3 kg x 3 m/s2 + 100 N) / 0.85 = 317 W.\n"
        }
        Build::Belts => {
            "# For example an axis that moves 0.5 kg by a belt over pulleys of 20 teeth with 2 mm from\n\
             # tooth to tooth, 16 mm wide, and a rotor of 54 g cm2 (1 g cm2 is 0.0000001 kg m2):\n\
             #\n\
             #     moved_mass_kg = 0.5\n\
             #     rotor_kg_m2 = 0.0000054\n\
             #     pulley = { teeth = 20, pitch_mm = 2, width_mm = 16 }\n\
             #     coulomb_n = 3\n\
             #     efficiency = 0.5\n\
             #\n\
             # That is 0.5 kg + 0.133 kg of the rotor + 0.016 kg of the pulleys: 0.649 kg. At 0.3 m/s\n\
             # and 5 m/s2 it draws 0.3 m/s x (0.649 kg x 5 m/s2 + 3 N) / 0.5 = 3.75 W.\n"
        }
    });
    if !found.remarks.is_empty() {
        out.push_str("#\n# Not taken over:\n");
        for remark in &found.remarks {
            wrapped(out, "# * ", "#   ", remark);
        }
    }
    let _ = writeln!(out, "schema = 1\nname = {}", quoted(&name));
    let _ = writeln!(out, "controller = \"{}\"", found.controller);
    if let Some(kinematics) = found.kinematics {
        let _ = writeln!(out, "kinematics = \"{kinematics}\"");
    }
}

fn converter(out: &mut String, found: &Found) {
    out.push_str("\n[converter]\n");
    asked(
        out,
        "peak_power_w = ",
        "what the supply of the drives delivers at most, in W",
    );
    asked(
        out,
        "regen_power_w = ",
        "what it takes back; left out: not checked",
    );
    asked(
        out,
        "base_load_w = ",
        match found.build {
            Build::Screws => "control, fans, pumps that always run",
            Build::Belts => "electronics, fans; heaters are [[load]]",
        },
    );
}

fn table(out: &mut String, name: &str, fields: &[Entry]) {
    if fields.is_empty() {
        return;
    }
    let _ = writeln!(out, "\n[{name}]");
    for entry in fields {
        line(out, &entry.field, &entry.source);
    }
}

fn axis_table(out: &mut String, id: AxisId, axis: &FoundAxis, found: &Found) {
    out.push('\n');
    for comment in &axis.comments {
        wrapped(out, "# ", "# ", comment);
    }
    let _ = writeln!(out, "[axes.{}]", id.letter() as char);
    let (kind, length) = if axis.rotary {
        ("rotary", "deg")
    } else {
        ("linear", "mm")
    };
    let _ = writeln!(out, "kind = \"{kind}\"");
    let rapid = field(out, &format!("rapid_{length}_min"), axis.rapid.as_ref());
    field(
        out,
        &format!("reference_{length}_min"),
        axis.reference_speed.as_ref(),
    );
    field(out, &format!("reference_{length}"), axis.reference.as_ref());
    if let (Some(first), Some(last)) = (
        axis.further_references.first(),
        axis.further_references.last(),
    ) {
        let places = axis.further_references.iter().map(|it| shown(it.value));
        let places: Vec<String> = places.collect();
        let source = match places.len() {
            1 => first.source.clone(),
            _ => format!("{} to {}", first.source, last.source),
        };
        let places = places.join(", ");
        line(
            out,
            &format!("further_reference_{length} = [{places}]"),
            &source,
        );
    }
    let accel = field(out, &format!("accel_{length}_s2"), axis.accel.as_ref())
        || field(out, "accel_time_s", axis.accel_time_s.as_ref());
    field(out, "servo_factor_motor", axis.servo_factor.as_ref());
    field(out, "servo_factor_regen", axis.servo_factor.as_ref());
    if !rapid {
        asked(out, &format!("rapid_{length}_min = "), "not in the file");
    }
    if !accel {
        asked(out, &format!("accel_{length}_s2 = "), "not in the file");
    }
    for entry in &axis.maybe {
        line(out, &format!("# {}", entry.field), &entry.source);
    }
    for hint in &axis.drive {
        wrapped(out, "# ", "# ", hint);
    }
    drive(out, id, axis, found);
}

/// A field with its source; whether the file has it.
fn field(out: &mut String, key: &str, figure: Option<&Figure>) -> bool {
    if let Some(figure) = figure {
        let text = format!("{key} = {}", shown(figure.value));
        line(out, &text, &figure.source);
    }
    figure.is_some()
}

/// What the file cannot know.
fn drive(out: &mut String, id: AxisId, axis: &FoundAxis, found: &Found) {
    let build = found.build;
    let shared = pair(found.kinematics.unwrap_or_default());
    let rotor = if found.core && shared.contains(&id) {
        let [first, second] = shared.map(|id| char::from(id.letter()));
        format!("rotors of both motors, for {first} as for {second}")
    } else if axis.motors > 1 {
        format!("rotors of all {} motors together", axis.motors)
    } else {
        "rotor, with coupling and brake".to_owned()
    };
    if axis.rotary {
        asked(
            out,
            "moved_inertia_kg_m2 = ",
            "table and workpiece, about the axis",
        );
        asked(out, "rotor_kg_m2 = ", &rotor);
        asked(
            out,
            "gear_ratio = ",
            "motor revolutions per table revolution",
        );
        asked(
            out,
            "friction_nm = ",
            "at the motor; without it none counts",
        );
        asked(
            out,
            "efficiency = ",
            "mechanical by electrical power; without it 1",
        );
        return;
    }
    let belt = build == Build::Belts && id != AxisId::Z && id != AxisId::E;
    let what = match (build, id) {
        (_, AxisId::E) => "what the filament sees: gears and wheels",
        (Build::Belts, AxisId::Y) => "what slides: bed with the print, or gantry",
        (Build::Belts, _) => "what slides: toolhead, or bed with the print",
        (Build::Screws, _) => "what slides: table, workpiece, spindle head",
    };
    asked(out, "moved_mass_kg = ", what);
    asked(out, "rotor_kg_m2 = ", &rotor);
    match (belt, id) {
        (_, AxisId::E) => asked(out, "lead_mm = ", "filament per revolution of the motor"),
        (true, _) => asked(out, "pulley = { teeth = , pitch_mm = , width_mm = }", ""),
        (false, _) => asked(
            out,
            "screw = { diameter_mm = , length_mm = , lead_mm = }",
            "or pulley, pinion",
        ),
    }
    asked(out, "coulomb_n = ", "friction; without it none counts");
    if found.kinematics == Some("corexz") && shared.contains(&id) {
        let what = "weight of Z that nothing balances, for X as for Z";
        asked(out, "gravity_n = ", what);
    } else if id == AxisId::Z {
        asked(out, "gravity_n = ", "weight that nothing balances");
    }
    asked(
        out,
        "efficiency = ",
        "mechanical by electrical power; without it 1",
    );
}

/// Loads of a printer that programs switch.
fn heaters(out: &mut String, found: &Found) {
    if found.build != Build::Belts {
        return;
    }
    out.push_str(
        "\n# Heaters draw most of a printer's power. They count once their power is known: volts\n\
         # squared by ohms, or what the label says. A target of 0 switches them off.\n",
    );
    for (words, what) in [
        (r#"["M104", "M109"]"#, "heater of the nozzle"),
        (r#"["M140", "M190"]"#, "heater of the bed"),
    ] {
        out.push_str("# [[load]]\n");
        line(out, &format!("# on = {words}"), what);
        asked(out, "power_w = ", "such as 40 for a nozzle, 220 for a bed");
    }
}

fn spindle(out: &mut String, found: &Found) {
    let Some(rpm) = &found.spindle_rpm else {
        return;
    };
    out.push_str(
        "\n# Counts once its inertia is known; without a [spindle] its power counts as none.\n",
    );
    out.push_str("# [spindle]\n");
    line(
        out,
        &format!("# max_rpm = {}", shown(rpm.value)),
        &rpm.source,
    );
    asked(out, "inertia_kg_m2 = ", "rotor, chuck and tool");
    asked(out, "accel_time_s = ", "from rest to that speed");
}

/// A field with a comment next to it.
fn line(out: &mut String, field: &str, comment: &str) {
    let pad = COLUMN.saturating_sub(field.chars().count()).max(1);
    let _ = writeln!(out, "{field}{:pad$}# {}", "", one_line(comment));
}

/// A field that is to be filled in.
fn asked(out: &mut String, field: &str, comment: &str) {
    let field = format!("# {field}");
    if comment.is_empty() {
        let _ = writeln!(out, "{field}");
    } else {
        line(out, &field, comment);
    }
}

/// A comment of several lines.
fn wrapped(out: &mut String, first: &str, next: &str, text: &str) {
    let mut prefix = first;
    let mut row = String::new();
    for word in text.split_whitespace() {
        if !row.is_empty() && row.len() + word.len() > 90 {
            let _ = writeln!(out, "{prefix}{row}");
            prefix = next;
            row.clear();
        }
        if !row.is_empty() {
            row.push(' ');
        }
        row.push_str(word);
    }
    let _ = writeln!(out, "{prefix}{row}");
}

/// Without line ends and control characters, which no comment may hold.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        if matches!(c, '"' | '\\') {
            out.push('\\');
        }
        out.push(c);
    }
    out.push('"');
    out
}
