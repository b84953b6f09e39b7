//! What kind of file it is, seen from its lines.

use crate::text::Text;
use crate::{fanuc, grbl, reprap, siemens, words};

/// Kinds of settings that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// LinuxCNC's INI file.
    LinuxCnc,
    /// What grbl and grblHAL print for `$$`.
    Grbl,
    /// FluidNC's `config.yaml`.
    FluidNc,
    /// What Marlin prints for `M503`.
    Marlin,
    /// Marlin's `Configuration.h`.
    MarlinConfig,
    /// Klipper's `printer.cfg`.
    Klipper,
    /// `config.g` of `RepRapFirmware`.
    RepRap,
    /// Fanuc's parameter file.
    Fanuc,
    /// SINUMERIK's machine data.
    Siemens,
}

/// All kinds, with their names.
pub const FORMATS: [(Format, &str); 9] = [
    (Format::LinuxCnc, "linuxcnc"),
    (Format::Grbl, "grbl"),
    (Format::FluidNc, "fluidnc"),
    (Format::Marlin, "marlin"),
    (Format::MarlinConfig, "marlin-config"),
    (Format::Klipper, "klipper"),
    (Format::RepRap, "reprap"),
    (Format::Fanuc, "fanuc"),
    (Format::Siemens, "siemens"),
];

impl Format {
    /// Its name, as `--format` takes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        let found = FORMATS.iter().find(|(format, _)| *format == self);
        found.map_or("", |(_, name)| name)
    }

    /// The kind of that name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        let found = FORMATS.iter().find(|(_, other)| *other == name);
        found.map(|(format, _)| *format)
    }

    /// The kind that the lines have; `None` where none of them says it, or several do.
    pub(crate) fn find(texts: &[Text]) -> Option<Self> {
        let mut marks = [0_usize; FORMATS.len()];
        for line in texts.iter().flat_map(|text| &text.lines) {
            for format in of_line(line) {
                if let Some(mark) = marks.get_mut(format as usize) {
                    *mark += 1;
                }
            }
        }
        // Comments of Klipper's samples have lines of `Configuration.h`, whose own lines never
        // are sections.
        let mut lines = texts.iter().flat_map(|text| &text.lines);
        if lines.any(|line| line.starts_with("[printer]") || line.starts_with("[stepper_"))
            && let Some(defines) = marks.get_mut(Format::MarlinConfig as usize)
        {
            *defines = 0;
        }
        let most = marks.iter().copied().max().filter(|most| *most > 0)?;
        let mut best = FORMATS
            .iter()
            .filter(|(format, _)| marks.get(*format as usize) == Some(&most));
        let (found, _) = best.next()?;
        best.next().is_none().then_some(*found)
    }
}

/// What a line is a mark of.
fn of_line(line: &str) -> Vec<Format> {
    let trimmed = line.trim();
    let mut marks = Vec::new();
    if siemens::data_line(line).is_some() {
        marks.push(Format::Siemens);
    } else if fanuc::parameter_line(trimmed) {
        marks.push(Format::Fanuc);
    } else if grbl::setting(trimmed).is_some() {
        marks.push(Format::Grbl);
    } else if marlin_define(trimmed) {
        marks.push(Format::MarlinConfig);
    } else if trimmed.starts_with("#INCLUDE ") {
        marks.push(Format::LinuxCnc);
    } else if let Some(section) = trimmed.strip_prefix('[') {
        let section = section.to_ascii_uppercase();
        let linuxcnc = [
            "EMC]",
            "TRAJ]",
            "KINS]",
            "HAL]",
            "EMCMOT]",
            "EMCIO]",
            "RS274NGC]",
            "AXIS_",
            "JOINT_",
        ];
        let klipper = [
            "STEPPER_",
            "PRINTER]",
            "EXTRUDER",
            "MCU",
            "INCLUDE ",
            "GCODE_MACRO ",
            "TMC2",
        ];
        if linuxcnc.iter().any(|name| section.starts_with(name)) {
            marks.push(Format::LinuxCnc);
        } else if klipper.iter().any(|name| section.starts_with(name)) {
            marks.push(Format::Klipper);
        }
    } else if [
        "max_rate_mm_per_min:",
        "acceleration_mm_per_sec2:",
        "max_travel_mm:",
        "junction_deviation_mm:",
    ]
    .iter()
    .any(|name| trimmed.starts_with(name))
    {
        marks.push(Format::FluidNc);
    } else {
        printer(trimmed, &mut marks);
    }
    marks
}

/// Names that Marlin defines; other files have such lines in comments.
fn marlin_define(line: &str) -> bool {
    let line = line.strip_prefix("//").unwrap_or(line).trim_start();
    let name = line.strip_prefix("#define ").unwrap_or("").trim_start();
    let names = [
        "DEFAULT_",
        "HOMING_",
        "BLOCK_BUFFER_",
        "CONFIGURATION_",
        "X_",
        "Y_",
        "Z_",
        "MOTHERBOARD",
        "EXTRUDERS",
    ];
    names.iter().any(|start| name.starts_with(start))
}

/// Marlin and RepRapFirmware share most commands.
fn printer(line: &str, marks: &mut Vec<Format>) {
    let command = line.trim_start_matches(|c: char| !matches!(c, 'M' | 'm'));
    let code: String = command
        .chars()
        .take_while(char::is_ascii_alphanumeric)
        .collect();
    let code = code.to_ascii_uppercase();
    // Limits of axes, drivers and microstepping have words in both: they are no marks.
    let only_reprap = [
        "M584", "M566", "M574", "M669", "M667", "M550", "M563", "M950",
    ];
    let only_marlin = ["M205", "M145", "M149", "M200", "M603", "M851"];
    let units = line.contains("units/s") || line.contains("echo:");
    if units || only_marlin.contains(&code.as_str()) && words::is_command(line) {
        marks.push(Format::Marlin);
    } else if reprap::include(line).is_some()
        || line.starts_with(['M', 'm']) && only_reprap.contains(&code.as_str())
    {
        marks.push(Format::RepRap);
    } else if matches!(code.as_str(), "M203" | "M201" | "M204") && words::is_command(line) {
        // Of both: what else stands there decides.
        marks.extend([Format::Marlin, Format::RepRap]);
    }
}
