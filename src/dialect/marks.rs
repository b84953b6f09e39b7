//! The marks: what speaks for which controllers, and how much.

use super::line::Line;

/// Something that one or several controllers have and others do not.
pub(super) struct Mark {
    /// As in "… in line 3".
    pub(super) what: &'static str,
    /// The profiles that it speaks for.
    pub(super) profiles: &'static [&'static str],
    /// How much: 1 for a hint, 10 for what nobody else has.
    pub(super) points: u32,
    /// Whether a line has it.
    pub(super) seen: fn(&Line) -> bool,
}

/// The ending of a file's name.
#[derive(Debug)]
pub(super) struct Ending {
    pub(super) letters: &'static str,
    pub(super) profiles: &'static [&'static str],
    pub(super) points: u32,
}

const fn mark(
    what: &'static str,
    profiles: &'static [&'static str],
    points: u32,
    seen: fn(&Line) -> bool,
) -> Mark {
    Mark {
        what,
        profiles,
        points,
        seen,
    }
}

const fn ending(letters: &'static str, profiles: &'static [&'static str], points: u32) -> Ending {
    Ending {
        letters,
        profiles,
        points,
    }
}

/// Endings that only one maker's programs have; `.nc`, `.tap` and `.gcode` say nothing.
pub(super) const ENDINGS: [Ending; 5] = [
    ending("mpf", SIEMENS, 8),
    ending("spf", SIEMENS, 8),
    ending("min", OKUMAS, 8),
    ending("ngc", RS274, 4),
    ending("g", REPRAP, 4),
];

const SIEMENS: &[&str] = &["siemens"];
const ISG: &[&str] = &["isg"];
const NCI: &[&str] = &["twincat-nci"];
const LINUXCNC: &[&str] = &["linuxcnc"];
const GRBL: &[&str] = &["grbl"];
const RS274: &[&str] = &["linuxcnc", "grbl"];
const OKUMA: &[&str] = &["okuma"];
const OKUMAS: &[&str] = &["okuma", "okuma-lathe"];
const REPRAP: &[&str] = &["reprap"];
const PRINTERS: &[&str] = &["marlin", "reprap", "klipper"];
const HAAS: &[&str] = &["haas", "haas-lathe"];
const MILLS: &[&str] = &["fanuc", "haas", "mitsubishi", "mazak", "syntec"];
const LATHES: &[&str] = &["fanuc-lathe", "fanuc-lathe-b", "haas-lathe"];
const LATHES_A: &[&str] = &["fanuc-lathe", "haas-lathe", "okuma-lathe"];
const FANUCS: &[&str] = &[
    "fanuc",
    "haas",
    "fanuc-lathe",
    "fanuc-lathe-b",
    "haas-lathe",
    "mitsubishi",
    "mazak",
    "syntec",
];
const FANUCS_AND_LINUXCNC: &[&str] = &[
    "fanuc",
    "haas",
    "fanuc-lathe",
    "fanuc-lathe-b",
    "haas-lathe",
    "mitsubishi",
    "mazak",
    "syntec",
    "linuxcnc",
];
const MILLS_AND_LINUXCNC: &[&str] = &["fanuc", "haas", "mitsubishi", "mazak", "syntec", "linuxcnc"];
const NOT_LATHES: &[&str] = &[
    "iso",
    "linuxcnc",
    "grbl",
    "isg",
    "siemens",
    "fanuc",
    "haas",
    "mitsubishi",
    "mazak",
    "syntec",
    "okuma",
    "marlin",
    "reprap",
    "klipper",
];
const ASSIGNING: &[&str] = &["siemens", "isg", "okuma", "okuma-lathe"];

/// Words that only SINUMERIK has.
const SIEMENS_WORDS: &[&str] = &[
    "TRANS",
    "ATRANS",
    "AROT",
    "AMIRROR",
    "ASCALE",
    "GOTOF",
    "GOTOB",
    "MCALL",
    "STOPRE",
    "SUPA",
    "TRAORI",
    "TRAFOOF",
    "TRANSMIT",
    "TRACYL",
    "DIAMON",
    "DIAMOF",
    "WORKPIECE",
    "EXTERN",
    "PROC",
    "ENDPROC",
    "DYNNORM",
    "DYNROUGH",
    "DYNFINISH",
    "FFWON",
    "FFWOF",
    "BRISK",
    "CFTCP",
    "CFC",
    "KONT",
    "CUTCONRAD",
    "COMPCAD",
    "COMPOF",
    "ORIWKS",
    "ORIMKS",
    "UPATH",
    "ENDLOOP",
    "SETAL",
    "DISPLOF",
    "SBLOF",
    "WAITM",
    "ORIAXES",
];
/// Flow of LinuxCNC's O words.
const O_WORDS: &[&str] = &[
    "SUB",
    "ENDSUB",
    "CALL",
    "IF",
    "ELSEIF",
    "ELSE",
    "ENDIF",
    "WHILE",
    "ENDWHILE",
    "DO",
    "REPEAT",
    "ENDREPEAT",
    "RETURN",
    "BREAK",
    "CONTINUE",
];
/// Commands that begin so are Klipper's.
const KLIPPER: &[&str] = &[
    "SET_VELOCITY_LIMIT",
    "SET_PRESSURE_ADVANCE",
    "SET_GCODE_OFFSET",
    "SET_PIN",
    "SET_FAN_SPEED",
    "SET_HEATER_TEMPERATURE",
    "SET_PRINT_STATS_INFO",
    "START_PRINT",
    "END_PRINT",
    "PRINT_START",
    "PRINT_END",
    "EXCLUDE_OBJECT",
    "BED_MESH_",
    "SAVE_GCODE_STATE",
    "RESTORE_GCODE_STATE",
    "TIMELAPSE_",
    "QUAD_GANTRY_LEVEL",
    "Z_TILT_ADJUST",
    "TURN_OFF_HEATERS",
    "TEMPERATURE_WAIT",
];
/// Lines that begin so are RepRapFirmware's.
const REPRAP_COMMANDS: &[&str] = &[
    "VAR ",
    "GLOBAL ",
    "SET VAR.",
    "SET GLOBAL.",
    "ABORT \"",
    "ECHO \"",
];
const ISG_FLOW: &[&str] = &[
    "$IF",
    "$ELSE",
    "$ENDIF",
    "$FOR",
    "$ENDFOR",
    "$WHILE",
    "$ENDWHILE",
    "$SWITCH",
    "$CASE",
    "$DO",
    "$REPEAT",
    "$GOTO",
];
const SLICERS: &[&str] = &[
    "PRUSASLICER",
    "ORCASLICER",
    "SUPERSLICER",
    "SLIC3R",
    "CURA",
    "SIMPLIFY3D",
];

/// All marks.
pub(super) const MARKS: [Mark; 68] = [
    // TwinCAT NC I
    mark("DynOvr", NCI, 10, |line| line.code().starts_with("DYNOVR")),
    mark("#set param", NCI, 10, |line| {
        line.code().starts_with("#SET PARAM")
    }),
    // SINUMERIK
    mark("%_N_", SIEMENS, 10, |line| line.raw().starts_with("%_N_")),
    mark(";$PATH=", SIEMENS, 10, |line| {
        line.raw().starts_with(";$PATH=")
    }),
    mark("DEF with a type", SIEMENS, 10, |line| {
        line.code().starts_with("DEF ")
            && line.named(&["REAL", "INT", "BOOL", "STRING", "AXIS", "CHAR", "FRAME"])
    }),
    mark("MSG(", SIEMENS, 10, |line| {
        line.raw().starts_with("MSG(") || line.raw().starts_with("MSG (")
    }),
    mark("a system variable ($P_, $A, $TC_)", SIEMENS, 10, |line| {
        ["$P_", "$AA_", "$AC_", "$A_", "$TC_", "$MC_", "$MN_", "$MA_"]
            .iter()
            .any(|start| line.code().contains(start))
    }),
    mark("a word of SINUMERIK", SIEMENS, 5, |line| {
        line.named(SIEMENS_WORDS)
    }),
    mark("CYCLE, POCKET or HOLES", SIEMENS, 6, |line| {
        line.raw().contains('(')
            && line.named_then(&["CYCLE", "POCKET", "HOLES", "SLOT", "LONGHOLE"], |byte| {
                byte.is_ascii_digit()
            })
    }),
    mark("CR=, AR= or TURN=", SIEMENS, 6, |line| {
        line.named_then(
            &["CR", "AR", "TURN", "RND", "RNDM", "CHF", "CHR", "RP", "AP"],
            |byte| byte == b'=',
        )
    }),
    mark("R parameters", SIEMENS, 4, |line| line.assigns(b"R", true)),
    mark("G codes from G450 on", SIEMENS, 4, |line| {
        line.at_least(b'G', 450)
    }),
    mark("an address with =", ASSIGNING, 2, |line| {
        line.assigns(b"XYZFABC", false)
    }),
    // ISG kernel
    mark("$IF or another $ word of flow", ISG, 10, |line| {
        let word = line
            .code()
            .split([' ', '[', '('])
            .next()
            .unwrap_or_default();
        ISG_FLOW.contains(&word)
    }),
    mark("a # word", ISG, 8, |line| {
        let mut hashes = line.code().split('#').skip(1);
        hashes.any(|rest| {
            let letters = rest.bytes().take_while(u8::is_ascii_uppercase).count();
            letters >= 2
        })
    }),
    mark("V. variables", ISG, 8, |line| {
        ["V.P.", "V.L.", "V.S.", "V.E.", "V.G.", "V.A."]
            .iter()
            .any(|name| line.code().contains(name))
    }),
    mark("P parameters", ISG, 4, |line| line.assigns(b"P", true)),
    // LinuxCNC, grbl
    mark("O-words", LINUXCNC, 8, |line| {
        line.code().starts_with('O') && !line.code().starts_with("O<") && line.named(O_WORDS)
    }),
    mark("O<names>", LINUXCNC, 8, |line| {
        line.code().starts_with("O<")
    }),
    mark("#<names>", LINUXCNC, 6, |line| line.code().contains("#<")),
    mark("(DEBUG, or another active comment", LINUXCNC, 5, |line| {
        [
            "(DEBUG,",
            "(PRINT,",
            "(LOG,",
            "(LOGOPEN,",
            "(AXIS,",
            "(PROBEOPEN",
        ]
        .iter()
        .any(|start| line.raw().contains(start))
    }),
    mark("G64 with P", LINUXCNC, 3, |line| {
        line.g(&[640]) && line.has_letter(b'P')
    }),
    mark("G5.2 or G5.3", LINUXCNC, 4, |line| line.g(&[52, 53])),
    mark("G41.1 or G42.1", LINUXCNC, 4, |line| line.g(&[411, 421])),
    mark("G33.1", LINUXCNC, 4, |line| line.g(&[331])),
    mark("G43.1 or a probe G38", RS274, 2, |line| {
        line.g(&[431, 382, 383, 384, 385])
    }),
    mark("M62 to M68 with P or E", LINUXCNC, 4, |line| {
        line.m(&[62, 63, 64, 65, 66, 67, 68]) && (line.has_letter(b'P') || line.has_letter(b'E'))
    }),
    mark("a $ command of grbl", GRBL, 10, |line| {
        let command = line.code();
        let setting = command
            .strip_prefix('$')
            .is_some_and(|rest| rest.starts_with(|first: char| first.is_ascii_digit()));
        ["$H", "$X", "$C", "$G", "$I", "$$", "$#"].contains(&command)
            || command.starts_with("$J=")
            || (setting && command.contains('='))
    }),
    // Okuma
    mark("$NAME.MIN%", OKUMAS, 10, |line| {
        line.raw().contains(".MIN%")
    }),
    mark("VC variables", OKUMAS, 8, |line| {
        line.named_then(&["VC"], |byte| byte.is_ascii_digit())
    }),
    mark("MODIN, MODOUT or RTS", OKUMAS, 8, |line| {
        line.named(&["MODIN", "MODOUT", "RTS"])
    }),
    mark("CALL O", OKUMAS, 6, |line| {
        line.code().starts_with("CALL O")
    }),
    mark("GOTO N", OKUMAS, 5, |line| line.code().contains("GOTO N")),
    mark("SB=", OKUMAS, 4, |line| {
        line.named_then(&["SB"], |byte| byte == b'=')
    }),
    mark("G15 or G16 with H", OKUMA, 5, |line| {
        line.g(&[150, 160]) && line.has_letter(b'H')
    }),
    // 3D printers
    mark("M104 or another heater", PRINTERS, 8, |line| {
        line.m(&[104, 109, 140, 190]) && !line.named(&["IF"])
    }),
    mark("M82 or M83", PRINTERS, 5, |line| line.m(&[82, 83])),
    mark("E words", PRINTERS, 5, |line| {
        (line.g(&[0, 10]) && line.has_letter(b'E')) || (line.g(&[920]) && line.has_letter(b'E'))
    }),
    mark("M106 or M107", PRINTERS, 3, |line| line.m(&[106, 107])),
    mark("M117", PRINTERS, 3, |line| line.m(&[117])),
    mark("layers of a slicer", PRINTERS, 3, |line| {
        ["LAYER:", "LAYER_CHANGE", "TYPE:", "LAYER_COUNT:"]
            .iter()
            .any(|start| line.raw().starts_with(';') && line.comment().starts_with(start))
    }),
    mark("the name of a slicer", PRINTERS, 3, |line| {
        line.raw().starts_with(';')
            && line.comment().contains("GENERATED")
            && SLICERS.iter().any(|name| line.comment().contains(name))
    }),
    mark("flavor Marlin", &["marlin"], 5, |line| {
        flavor(line, "MARLIN")
    }),
    mark("flavor Klipper", &["klipper"], 5, |line| {
        flavor(line, "KLIPPER")
    }),
    mark("flavor RepRapFirmware", REPRAP, 5, |line| {
        flavor(line, "REPRAP") && !is_sprinter(line)
    }),
    mark("flavor RepRap/Sprinter", &["marlin"], 5, is_sprinter),
    mark("a command of Klipper", &["klipper"], 8, |line| {
        KLIPPER.iter().any(|start| line.raw().starts_with(start))
    }),
    mark("M420 or M900", &["marlin"], 4, |line| line.m(&[420, 900])),
    mark(
        "a variable or a command of RepRapFirmware",
        REPRAP,
        8,
        |line| {
            let starts = |start: &&str| line.code().starts_with(*start);
            let parts = ["MOVE.AXES[", "SENSORS.PROBES[", "STATE.STATUS", "{VAR."];
            REPRAP_COMMANDS.iter().any(starts)
                || parts.iter().any(|part| line.code().contains(part))
        },
    ),
    mark("G1 with H and axes", REPRAP, 3, |line| {
        line.g(&[10])
            && line.has_letter(b'H')
            && !line.g(&[430, 440])
            && b"XYZU".iter().any(|letter| line.has_letter(*letter))
    }),
    mark("M98 with a file's name", REPRAP, 8, |line| {
        line.m(&[98]) && line.raw().contains('"')
    }),
    // Prusa's firmware has M572 and M593 too, with other arguments.
    mark(
        "M566, M572 with D, or M593 with a name",
        REPRAP,
        5,
        |line| {
            line.m(&[566])
                || line.m(&[572]) && line.has_letter(b'D')
                || line.m(&[593]) && line.raw().contains('"')
        },
    ),
    mark("M862 of Prusa", &["marlin"], 6, |line| {
        line.raw().starts_with("M862.")
    }),
    // Fanuc and relatives
    mark("%", FANUCS_AND_LINUXCNC, 1, |line| line.raw() == "%"),
    mark("a program number", FANUCS, 3, |line| line.only(b'O')),
    mark("numbered variables", FANUCS_AND_LINUXCNC, 2, |line| {
        let mut hashes = line.code().split('#').skip(1);
        hashes.any(|rest| rest.starts_with(|first: char| first.is_ascii_digit()))
    }),
    mark("IF or WHILE of macro B", FANUCS, 6, |line| {
        line.code().starts_with(['I', 'W'])
            && line.code().contains('#')
            && line.named(&["GOTO", "THEN", "DO"])
    }),
    mark("G65 with P", FANUCS, 4, |line| {
        line.g(&[650, 660]) && line.has_letter(b'P')
    }),
    mark("M98 with P", FANUCS_AND_LINUXCNC, 2, |line| {
        line.m(&[98]) && line.has_letter(b'P') && !line.raw().contains('"')
    }),
    mark("G54.1 with P", MILLS, 3, |line| {
        line.g(&[541]) && line.has_letter(b'P')
    }),
    mark("G43 with H", MILLS_AND_LINUXCNC, 1, |line| {
        line.g(&[430]) && line.has_letter(b'H')
    }),
    mark("G103, G154, G187 or M97", HAAS, 4, |line| {
        line.g(&[1030, 1540, 1870]) || (line.m(&[97]) && line.has_letter(b'P'))
    }),
    mark(
        "G28 without axes",
        &["haas", "haas-lathe", "marlin", "reprap", "klipper"],
        1,
        |line| line.g(&[280]) && !b"XYZUVWABCH".iter().any(|letter| line.has_letter(*letter)),
    ),
    mark("G96 or G97 with S", LATHES, 4, |line| {
        line.g(&[960, 970]) && line.has_letter(b'S')
    }),
    mark("G50 with S", LATHES_A, 4, |line| {
        line.g(&[500]) && line.has_letter(b'S')
    }),
    mark("G92 with S", &["fanuc-lathe-b"], 4, |line| {
        line.g(&[920]) && line.has_letter(b'S') && !line.has_letter(b'Y')
    }),
    mark(
        "a turning cycle (G70 to G73 with P and Q)",
        LATHES,
        5,
        |line| line.g(&[700, 710, 720, 730]) && line.has_letter(b'P') && line.has_letter(b'Q'),
    ),
    mark("Y words", NOT_LATHES, 1, |line| line.has_letter(b'Y')),
];

/// What slicers write about the firmware: `;FLAVOR:Marlin`, `; gcode_flavor = klipper`.
fn flavor(line: &Line, name: &str) -> bool {
    let comment = line.comment().trim_start();
    let value = comment
        .strip_prefix("FLAVOR:")
        .or_else(|| comment.strip_prefix("GCODE_FLAVOR ="));
    line.raw().starts_with(';') && value.is_some_and(|value| value.trim_start().starts_with(name))
}

/// `Slic3r`'s and `PrusaSlicer`'s `reprap` is RepRap/Sprinter, which Marlin comes from; Cura's is
/// `RepRapFirmware`.
fn is_sprinter(line: &Line) -> bool {
    let value = line.comment().trim().strip_prefix("GCODE_FLAVOR =");
    line.raw().starts_with(';') && value.is_some_and(|value| value.trim() == "REPRAP")
}
