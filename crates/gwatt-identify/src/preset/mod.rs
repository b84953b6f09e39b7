//! Recordings in the layouts of makers: what is where in them, as data.
//!
//! A layout becomes a table with times in seconds and one column for each signal, which is
//! read as any other. What a maker gives one unit only is known by its name; what differs
//! from drive to drive, such as a torque, a map has to give.

mod channels;
mod labelled;
mod records;
mod table;
mod written;

use std::io::Read;

use super::column::{Meaning, Quantity, quantity_of, unit_of};
use super::column_map::MappedColumn;
use super::error::{IdentifyError, Outcome};
use super::header_name::suffix_of;
use super::layout::text_of;

pub(crate) use written::Written;

/// How a file is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// A line of names that are always the same, and lines of numbers.
    Table { names: &'static str },
    /// The period in the first line, after and before these words; in each line the name of
    /// each signal in front of its value.
    Labelled {
        before: &'static str,
        after: &'static str,
    },
    /// Lines about each channel, which may have times of its own.
    Channels,
    /// Elements of XML, one for each sample.
    Records,
}

/// A signal whose unit a maker fixes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Known {
    /// How its name ends; `{axis}` stands for the letter of the axis.
    ends: &'static str,
    quantity: &'static str,
    unit: &'static str,
}

/// A layout of one maker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Its name.
    pub name: &'static str,
    /// What writes it.
    pub title: &'static str,
    form: Form,
    known: &'static [Known],
}

const fn known(ends: &'static str, quantity: &'static str, unit: &'static str) -> Known {
    Known {
        ends,
        quantity,
        unit,
    }
}

/// All of them.
const PRESETS: [Preset; 4] = [
    // LinuxCNC, src/hal/utils/scope_files.c; names of pins by the manual page motion(9).
    Preset {
        name: "halscope",
        title: "LinuxCNC's Halscope",
        form: Form::Labelled {
            before: "Sampling period is ",
            after: " ns",
        },
        known: &[
            known(".motor-pos-fb", "position", "mm"),
            known(".motor-pos-cmd", "command", "mm"),
        ],
    },
    // Beckhoff Infosys, TE13xx, Export in csv; files of CagtayFabry/pytcs, tests/data; names of
    // the axis' variables by NCTOPLC_AXIS_REF.
    Preset {
        name: "twincat-scope",
        title: "Beckhoff's TwinCAT Scope",
        form: Form::Channels,
        known: &[
            known("ActPos", "position", "mm"),
            known("ActVelo", "velocity", "mm/s"),
            known("ActAcc", "acceleration", "mm/s2"),
            known("SetPos", "command", "mm"),
        ],
    },
    // eliasrhoden/Trace-Tools, tracetools/tracetools.py.
    Preset {
        name: "sinumerik",
        title: "the trace of SINUMERIK Operate",
        form: Form::Records,
        known: &[],
    },
    // Klipper, klippy/extras/adxl345.py, and docs/Measuring_Resonances.md for the unit.
    Preset {
        name: "klipper",
        title: "Klipper's accelerometers",
        form: Form::Table {
            names: "#time,accel_x,accel_y,accel_z",
        },
        known: &[known("accel_{axis}", "acceleration", "mm/s2")],
    },
];

impl Preset {
    /// All presets.
    #[must_use]
    pub fn all() -> &'static [Self] {
        &PRESETS
    }

    /// The one of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        PRESETS.into_iter().find(|preset| preset.name == name)
    }

    /// The table that is in a file of this layout.
    pub(crate) fn open(&self, mut input: impl Read) -> Outcome<Written> {
        let mut bytes = Vec::new();
        input.read_to_end(&mut bytes).map_err(|error| {
            IdentifyError::new(
                format!("the file cannot be read: {error}"),
                "check that it is a file, and that it may be read",
            )
        })?;
        let text = text_of(&bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        match self.form {
            Form::Table { names } => table::read(text, names),
            Form::Labelled { before, after } => labelled::read(text, before, after),
            Form::Channels => channels::read(text),
            Form::Records => records::read(text),
        }
        .map_err(|foreign| foreign.of(self.title))
    }

    /// The columns that are known by their names, but for quantities that a map gives.
    pub(crate) fn columns(
        &self,
        names: &[String],
        axis: Option<char>,
        map: &[MappedColumn],
    ) -> Outcome<Vec<MappedColumn>> {
        let mut out: Vec<MappedColumn> = Vec::new();
        let letter = axis.map(|axis| axis.to_ascii_lowercase().to_string());
        let letter = letter.unwrap_or_default();
        for (at, name) in names.iter().enumerate() {
            let plain = name.split(" [").next().unwrap_or_default();
            let is_ours = |known: &&Known| {
                let ends = known.ends.replace("{axis}", &letter);
                let front = plain.strip_suffix(ends.as_str());
                front.is_some_and(|front| front.is_empty() || !is_word_end(front, &ends))
            };
            let Some(meaning) = self.known.iter().find(is_ours).and_then(Known::meaning) else {
                continue;
            };
            let is_same = |other: &MappedColumn| other.meaning.quantity == meaning.quantity;
            if map.iter().any(is_same) {
                continue;
            }
            if let Some(other) = out.iter().find(|other| is_same(other)) {
                let first = other.index(names).ok().and_then(|at| names.get(at));
                return Err(IdentifyError::new(
                    format!(
                        "{} and {name} are the same quantity",
                        first.map_or("", String::as_str)
                    ),
                    "give the one of the axis by --map, such as --map \"position=NAME*1mm\"",
                ));
            }
            out.push(MappedColumn {
                column: format!("#{}", at + 1),
                meaning,
            });
        }
        Ok(out)
    }
}

/// Whether a name goes on as a word in front of what it ends with.
fn is_word_end(front: &str, ends: &str) -> bool {
    let is_word = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    is_word(front.chars().last()) && is_word(ends.chars().next())
}

impl Known {
    fn meaning(&self) -> Option<Meaning> {
        let quantity: Quantity = quantity_of(self.quantity)?;
        let (kind, to_si) = unit_of(quantity, &suffix_of(self.unit))?;
        Some(Meaning {
            quantity,
            kind,
            to_si,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_signal_that_is_known_has_a_unit() {
        for preset in Preset::all() {
            assert_eq!(Preset::named(preset.name), Some(*preset));
            for known in preset.known {
                assert!(known.meaning().is_some(), "{} {}", preset.name, known.ends);
            }
        }
    }

    #[test]
    fn a_name_ends_with_a_whole_word() {
        assert!(!is_word_end("MAIN.Axis1.NcToPlc.", "ActPos"));
        assert!(is_word_end("X", "ActPos"));
        assert!(!is_word_end("joint.0", ".motor-pos-fb"));
    }
}
