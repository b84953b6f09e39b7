//! Machines and controller profiles that are built in: the files of
//! `machine-configs/`, embedded.

use super::controller::Controller;

/// The machine that is used when none is named.
pub const DEFAULT_MACHINE: &str = "three-axis";
/// The controller profile that is used when neither machine nor option says.
pub const DEFAULT_CONTROLLER: &str = "iso";

/// A file that is built in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// The name to call it by.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
    /// One line on what it stands for: the file's first comment.
    pub description: &'static str,
}

macro_rules! builtins {
    ($folder:literal: $($name:literal),* $(,)?) => {
        &[$({
            const TEXT: &str = include_str!(concat!(
                env!("MACHINE_CONFIGS"), "/", $folder, $name, ".toml"
            ));
            Builtin { name: $name, text: TEXT, description: first_comment(TEXT) }
        }),*]
    };
}

const MACHINES: &[Builtin] = builtins!("":
    "three-axis",
    "vmc",
    "linear-gantry",
    "five-axis",
    "lathe",
    "router-48v",
    "linuxcnc-mill",
    "printer",
);

const CONTROLLERS: &[Builtin] = builtins!("controllers/":
    "iso",
    "linuxcnc",
    "grbl",
    "isg",
    "twincat-nci",
    "siemens",
    "marlin",
    "reprap",
    "klipper",
    "fanuc",
    "haas",
    "fanuc-lathe",
    "fanuc-lathe-b",
    "haas-lathe",
    "mitsubishi",
    "mazak",
    "syntec",
    "okuma",
    "okuma-lathe",
);

const MOTORS: &[Builtin] = builtins!("motors/":
    "yaskawa-sgm7j",
    "yaskawa-sgmsh",
    "mitsubishi-hg-kn",
    "beckhoff-as1000",
    "sanyo-ss242",
);

/// Files of motors, one a document: see [`crate::motors()`].
pub(crate) fn motor_files() -> &'static [Builtin] {
    MOTORS
}

/// All built-in machines, the default first.
#[must_use]
pub fn machines() -> &'static [Builtin] {
    MACHINES
}

/// All built-in controller profiles, the default first.
#[must_use]
pub fn controllers() -> &'static [Builtin] {
    CONTROLLERS
}

/// A built-in controller profile; `None` if there is none of this name.
#[must_use]
pub fn builtin_controller(name: &str) -> Option<Controller> {
    let profile = controllers().iter().find(|profile| profile.name == name)?;
    // A test loads every built-in file, so the second `None` does not occur.
    Controller::from_toml(profile.text)
        .ok()
        .map(|(controller, _)| controller)
}

/// The first line without its `#`, for a list; empty if it is no comment.
const fn first_comment(text: &'static str) -> &'static str {
    let bytes = text.as_bytes();
    if bytes.len() < 2 || bytes[0] != b'#' || bytes[1] != b' ' {
        return "";
    }
    let mut end = 2;
    while end < bytes.len() && bytes[end] != b'\n' {
        end += 1;
    }
    text.split_at(2).1.split_at(end - 2).0
}
