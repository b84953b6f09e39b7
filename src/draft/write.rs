//! The machine file of a draft.

use std::fmt::Write as _;

use super::axis::{DraftAxis, Drive};
use super::{Draft, DraftLoad, DraftSpindle, Form, MachineKind};

/// Acceleration of gravity, m/s² (standard gravity, CGPM 1901).
const GRAVITY_M_S2: f64 = 9.80665;
/// Where comments next to fields begin.
const COLUMN: usize = 29;
/// Filament from the wheels to the nozzle, kg: not more than a gram.
const FILAMENT_KG: f64 = 0.001;

impl Draft {
    /// The text of the machine file. `sums` are lines that say what the axes come to, from an
    /// earlier text that was read back.
    #[must_use]
    pub fn machine_file(&self, sums: &str) -> String {
        let mut out = String::new();
        let name = one_line(&self.name);
        let _ = writeln!(out, "# {name}, made by `gwatt machine new`");
        if !sums.is_empty() {
            out.push_str("#\n# What the axes come to:\n#\n");
            for line in sums.lines() {
                let _ = writeln!(out, "# {line}");
            }
        }
        let left_out = self.left_out();
        if !left_out.is_empty() {
            out.push_str("#\n# Not given:\n");
            for sentence in &left_out {
                wrapped(&mut out, sentence);
            }
        }
        let quoted = name.replace('\\', "\\\\").replace('"', "\\\"");
        let _ = writeln!(out, "schema = 1\nname = \"{quoted}\"");
        let controller = self.controller.as_deref();
        let controller = controller.unwrap_or(self.kind.usual_controller());
        let _ = writeln!(out, "controller = \"{controller}\"");

        out.push_str("\n[converter]\n");
        line(
            &mut out,
            "peak_power_w",
            self.supply_w,
            "what it delivers at most",
        );
        if let Some(watts) = self.feeds_back_w {
            line(&mut out, "regen_power_w", watts, "what it takes back");
        }
        if let Some(watts) = self.base_load_w {
            line(&mut out, "base_load_w", watts, "what always runs");
        }
        for axis in &self.axes {
            axis_table(&mut out, axis, self.kind);
        }
        if let Some(spindle) = &self.spindle {
            spindle_table(&mut out, spindle);
        }
        for load in &self.loads {
            load_table(&mut out, load);
        }
        out.push_str("\n[limits]\n");
        line(
            &mut out,
            "margin",
            0.1,
            "share of the peak power that is kept free",
        );
        out
    }
}

fn axis_table(out: &mut String, axis: &DraftAxis, kind: MachineKind) {
    out.push('\n');
    motor(out, axis);
    let linear = if axis.form == Form::Turn {
        "rotary"
    } else {
        "linear"
    };
    let _ = writeln!(out, "[axes.{}]\nkind = \"{linear}\"", axis.letter);
    let mut field = |name: &str, value: Option<f64>, comment: &str| {
        if let Some(value) = value {
            line(out, name, value, comment);
        }
    };
    for name in [
        "rapid_mm_min",
        "rapid_deg_min",
        "accel_mm_s2",
        "accel_deg_s2",
        "jerk_mm_s3",
        "jerk_deg_s3",
    ] {
        field(name, axis.get(name), "");
    }
    let (name, moved, comment) = moved(axis);
    field(name, Some(moved), &comment);
    let rotor = axis.rotor_kg_m2().unwrap_or(0.0);
    field("rotor_kg_m2", Some(rotor), whose_rotor(axis));
    field("gear_ratio", axis.get("gear_ratio"), "");
    let drive = match axis.drive.map_numbers(shown) {
        Shown::Screw([diameter, length, lead]) => format!(
            "screw = {{ diameter_mm = {diameter}, length_mm = {length}, lead_mm = {lead} }}\n"
        ),
        Shown::Pinion([diameter, width]) => {
            format!("pinion = {{ diameter_mm = {diameter}, width_mm = {width} }}\n")
        }
        Shown::Belt([teeth, pitch, width]) => {
            format!("pulley = {{ teeth = {teeth}, pitch_mm = {pitch}, width_mm = {width} }}\n")
        }
        Shown::Filament(length) => {
            format!(
                "{:COLUMN$}# filament per revolution of its wheels\n",
                format!("lead_mm = {length}")
            )
        }
        Shown::Direct => String::new(),
    };
    out.push_str(&drive);
    let mut field = |name: &str, value: Option<f64>, comment: &str| {
        if let Some(value) = value {
            line(out, name, value, comment);
        }
    };
    field("coulomb_n", axis.get("coulomb_n"), "");
    field("friction_nm", axis.get("friction_nm"), "");
    let moved = rounded(axis.moved_kg());
    if let Some(share) = axis.get("guide_friction") {
        let force = share * moved * GRAVITY_M_S2;
        let comment = format!(
            "{} x {} kg x {GRAVITY_M_S2} m/s2",
            shown(share),
            shown(moved)
        );
        field("coulomb_n", Some(rounded(force)), &comment);
    }
    if kind.is_vertical(axis.letter) {
        let balanced = axis.get("counterweight_kg");
        let weight = (moved - balanced.unwrap_or(0.0)) * GRAVITY_M_S2;
        let comment = match balanced {
            Some(balanced) => format!(
                "({} kg - {} kg) x {GRAVITY_M_S2} m/s2",
                shown(moved),
                shown(balanced)
            ),
            None => format!("{} kg x {GRAVITY_M_S2} m/s2", shown(moved)),
        };
        field("gravity_n", Some(rounded(weight)), &comment);
    }
    field("efficiency", axis.get("efficiency"), "");
    torque(out, axis);
}

/// What moves next to the rotor: the field, its figure, and what it is made of.
fn moved(axis: &DraftAxis) -> (&'static str, f64, String) {
    let [table, workpiece] = match axis.form {
        Form::Slide => ["table_kg", "workpiece_kg"],
        Form::Turn => ["table_kg_m2", "workpiece_kg_m2"],
        Form::Extruder => {
            let what = "the filament, which weighs next to nothing".to_owned();
            return ("moved_mass_kg", FILAMENT_KG, what);
        }
    };
    let own = axis.get(table).unwrap_or(0.0);
    // A weight on a chain is accelerated too; a cylinder of gas is not, and counts higher.
    let parts = [
        ("workpiece", axis.get(workpiece)),
        ("counterweight", axis.get("counterweight_kg")),
    ];
    let mut comment = String::new();
    let mut sum = own;
    for (name, part) in parts {
        if let Some(part) = part {
            if comment.is_empty() {
                let _ = write!(comment, "table {}", shown(own));
            }
            let _ = write!(comment, " + {name} {}", shown(part));
            sum += part;
        }
    }
    let field = match axis.form {
        Form::Turn => "moved_inertia_kg_m2",
        _ => "moved_mass_kg",
    };
    (field, rounded(sum), comment)
}

fn spindle_table(out: &mut String, spindle: &DraftSpindle) {
    out.push_str("\n[spindle]\n");
    for (name, value) in &spindle.figures {
        line(out, name, *value, "");
    }
}

fn load_table(out: &mut String, load: &DraftLoad) {
    let quoted: Vec<String> = load.on.iter().map(|word| format!("\"{word}\"")).collect();
    let _ = match quoted.as_slice() {
        [one] => writeln!(out, "\n[[load]]\non = {one}"),
        _ => writeln!(out, "\n[[load]]\non = [{}]", quoted.join(", ")),
    };
    if let Some(off) = &load.off {
        let _ = writeln!(out, "off = \"{off}\"");
    }
    line(out, "power_w", load.power_w, "");
}

/// What is said of its rotor.
fn whose_rotor(axis: &DraftAxis) -> &'static str {
    match (axis.drive, axis.get("rotor_kg_m2"), &axis.motor) {
        (Drive::Direct, _, _) => "a linear motor has no rotor",
        (_, None, Some(_)) => "of the motor; coupling and brake come on top",
        (_, None, None) => "not given",
        _ => "",
    }
}

/// What is known of its motor.
fn motor(out: &mut String, axis: &DraftAxis) {
    let Some((motor, series)) = &axis.motor else {
        return;
    };
    let _ = write!(
        out,
        "# Motor {} ({}): {} N m",
        motor.name, motor.maker, motor.continuous_nm
    );
    if let Some(peak) = motor.peak_nm {
        let _ = write!(out, ", for a moment {peak} N m");
    }
    if let Some(rpm) = motor.max_rpm {
        let _ = write!(out, ", up to {rpm} rpm");
    }
    let _ = writeln!(out, ". From: {}", one_line(&series.document));
    let _ = writeln!(out, "# {}", one_line(&series.url));
}

/// The torque of its motor, where the acceleration that is asked for needs more.
fn torque(out: &mut String, axis: &DraftAxis) {
    let (Some((motor, _)), Some(travel), true) = (&axis.motor, axis.travel(), axis.torque_limits)
    else {
        return;
    };
    let rapid_rpm = axis.rapid() / travel;
    let end_rpm = motor.max_rpm.unwrap_or(rapid_rpm).max(rapid_rpm).ceil();
    let most = shown(motor.most_nm());
    let curve = format!(
        "torque_curve = [{{ rpm = 0, torque_nm = {most} }}, {{ rpm = {}, torque_nm = {most} }}]",
        shown(end_rpm)
    );
    let _ = writeln!(
        out,
        "# Less at speed, which its document shows as a picture: powers count higher without.\n{curve}"
    );
}

/// The numbers of a drive as they are written.
enum Shown {
    Screw([String; 3]),
    Pinion([String; 2]),
    Belt([String; 3]),
    Filament(String),
    Direct,
}

impl Drive {
    fn map_numbers(self, show: impl Fn(f64) -> String) -> Shown {
        match self {
            Self::Screw(sizes) => Shown::Screw(sizes.map(show)),
            Self::Pinion(sizes) => Shown::Pinion(sizes.map(show)),
            Self::Belt(sizes) => Shown::Belt(sizes.map(show)),
            Self::Filament(length) => Shown::Filament(show(length)),
            Self::Direct | Self::Turning => Shown::Direct,
        }
    }
}

/// A number as TOML has it.
fn shown(value: f64) -> String {
    format!("{value}")
}

/// A figure that was worked out, to six digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// A field with a comment next to it.
fn line(out: &mut String, name: &str, value: f64, comment: &str) {
    let field = format!("{name} = {}", shown(value));
    if comment.is_empty() {
        let _ = writeln!(out, "{field}");
    } else {
        let _ = writeln!(out, "{field:COLUMN$}# {comment}");
    }
}

/// Without line ends and control characters, which no comment may hold.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// An entry of a list in comments.
fn wrapped(out: &mut String, text: &str) {
    let mut row = String::from("# *");
    for word in text.split_whitespace() {
        if row.len() + word.len() > 96 {
            let _ = writeln!(out, "{row}");
            row.clear();
            row.push_str("#  ");
        }
        row.push(' ');
        row.push_str(word);
    }
    let _ = writeln!(out, "{row}");
}
