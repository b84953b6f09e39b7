//! Families of languages, and what they differ in where programs are written and where the
//! control's words say what is drawn. How they are read is a matter of the interpreter.

use schemars::JsonSchema;
use serde::Deserialize;

/// The family of words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// ISO 6983 as most machine tools read it.
    Iso,
    /// RS274/NGC as `LinuxCNC` reads it.
    Rs274,
    /// Marlin and similar firmware: 3D printers.
    Marlin,
    /// ISG kernel, Beckhoff `TwinCAT` CNC.
    Isg,
    /// Siemens SINUMERIK 840D and its relatives.
    Siemens,
    /// Beckhoff `TwinCAT` NC I, classic dialect.
    Nci,
}

/// What a family of languages has of its own; the rest of the program asks this, never which
/// family it is.
#[derive(Debug, Clone, Copy)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate property of the language"
)]
pub struct FamilyFacts {
    /// A comment begins with `;` and reaches to the end of its line; else it is in parentheses.
    pub comment_to_line_end: bool,
    /// G1 goes to machine coordinates under G53.
    pub feeds_in_machine_coordinates: bool,
    /// What G53 does under G91 differs: controls ignore it, or take it as an increment.
    pub increments_in_machine_differ: bool,
    /// Where the plane at power-on is ZX, besides lathes with G-code systems.
    pub turning_plane: TurningPlane,
    /// Whether F is by the minute or by the revolution at power-on of a lathe, its settings say.
    pub turns_in_unknown_feed: bool,
    /// Canned cycles can be written out as single blocks.
    pub writes_out_cycles: bool,
    /// The way to a reference point is written in machine coordinates.
    pub returns_in_machine_coordinates: bool,
    /// The control keeps its reference points among the parameters of its programs.
    pub reference_in_parameters: bool,
    /// A line without a command is not read.
    pub lines_need_command: bool,
    /// G2 and G3 without a place or a centre are refused.
    pub arcs_need_words: bool,
    /// The motion word before a canned cycle is in force again after it.
    pub motion_survives_cycles: bool,
    /// G80 stays in force after a canned cycle.
    pub g80_stays: bool,
    /// On mills G99 selects in a block of a cycle that it returns to R.
    pub level_by_g99: bool,
    /// Dwells are written with a decimal point.
    pub dwell_with_point: bool,
    /// How the lower of two values is written.
    pub lower_of: LowerOf,
    /// G61.1 and back is an exact stop for one block.
    pub stops_by_exact_path: bool,
    /// G61 and G64 are an exact stop for some blocks, where no word is one for one block.
    pub stops_by_mode: bool,
    /// What of the control's data has the F of power-on; empty where that is not known.
    pub power_on_feed_data: &'static str,
    /// It is firmware of a printer: T changes the tool, and other words move nothing.
    pub printer: bool,
    /// The tool that is selected cuts, not the one that M6 has changed to.
    pub selected_tool_cuts: bool,
    /// Words with levels may be given in the machine file, and whether names are such words.
    pub level_words: LevelWords,
    /// Numbered variables that are kept where a profile does not say: first and last.
    pub kept_variables: Option<[u32; 2]>,
}

/// How the lower of two values is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LowerOf {
    /// By ABS in brackets, which may be nested this deep.
    Brackets(usize),
    /// By a function of this name, with its brackets.
    Function {
        /// Such as `MIN[`.
        open: &'static str,
        /// Such as `]`.
        close: &'static str,
    },
    /// It cannot be said.
    None,
}

/// Words with levels that a machine file may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelWords {
    /// Only those that the profile documents.
    Documented,
    /// G and M words.
    Codes,
    /// G and M words, and names such as `DYNFINISH`.
    CodesAndNames,
}

/// Where the plane at power-on is ZX.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurningPlane {
    /// Nowhere.
    Never,
    /// Where words of X are diameters (OSP lathes).
    Diameters,
    /// There, and where X and Z have no Y with them (SINUMERIK: MD20150).
    Axes,
}

const ISO: FamilyFacts = FamilyFacts {
    comment_to_line_end: false,
    feeds_in_machine_coordinates: false,
    increments_in_machine_differ: true,
    turning_plane: TurningPlane::Diameters,
    turns_in_unknown_feed: false,
    writes_out_cycles: true,
    returns_in_machine_coordinates: false,
    reference_in_parameters: false,
    lines_need_command: false,
    arcs_need_words: false,
    motion_survives_cycles: true,
    g80_stays: false,
    level_by_g99: true,
    dwell_with_point: true,
    // B-64484EN, custom macro.
    lower_of: LowerOf::Brackets(5),
    stops_by_exact_path: false,
    stops_by_mode: true,
    power_on_feed_data: "",
    printer: false,
    selected_tool_cuts: false,
    level_words: LevelWords::Codes,
    // B-63944EN, "Variables".
    kept_variables: Some([500, 999]),
};

const RS274: FamilyFacts = FamilyFacts {
    feeds_in_machine_coordinates: true,
    increments_in_machine_differ: false,
    turning_plane: TurningPlane::Never,
    reference_in_parameters: true,
    // LinuxCNC: convert_arc ("R I J K words all missing for arc"); grbl: error 26.
    arcs_need_words: true,
    motion_survives_cycles: false,
    g80_stays: true,
    level_by_g99: false,
    dwell_with_point: false,
    lower_of: LowerOf::Brackets(usize::MAX),
    stops_by_exact_path: true,
    stops_by_mode: false,
    level_words: LevelWords::Documented,
    // What the parameter file may hold besides LinuxCNC's own.
    kept_variables: Some([31, 5000]),
    ..ISO
};

/// What families without any of this have.
const PLAIN: FamilyFacts = FamilyFacts {
    increments_in_machine_differ: false,
    turning_plane: TurningPlane::Never,
    writes_out_cycles: false,
    motion_survives_cycles: false,
    level_by_g99: false,
    dwell_with_point: false,
    lower_of: LowerOf::None,
    stops_by_mode: false,
    level_words: LevelWords::Documented,
    kept_variables: None,
    ..ISO
};

const MARLIN: FamilyFacts = FamilyFacts {
    comment_to_line_end: true,
    lines_need_command: true,
    arcs_need_words: true,
    printer: true,
    ..PLAIN
};

const ISG: FamilyFacts = FamilyFacts {
    turning_plane: TurningPlane::Axes,
    lower_of: LowerOf::Function {
        open: "MIN[",
        close: "]",
    },
    ..PLAIN
};

const SIEMENS: FamilyFacts = FamilyFacts {
    turning_plane: TurningPlane::Axes,
    turns_in_unknown_feed: true,
    comment_to_line_end: true,
    writes_out_cycles: true,
    returns_in_machine_coordinates: true,
    lower_of: LowerOf::Function {
        open: "MINVAL(",
        close: ")",
    },
    power_on_feed_data: "setting data 42110",
    selected_tool_cuts: true,
    level_words: LevelWords::CodesAndNames,
    ..PLAIN
};

impl Family {
    /// What it has of its own.
    #[must_use]
    pub fn facts(self) -> &'static FamilyFacts {
        match self {
            Self::Iso => &ISO,
            Self::Rs274 => &RS274,
            Self::Marlin => &MARLIN,
            Self::Isg => &ISG,
            Self::Siemens => &SIEMENS,
            Self::Nci => &PLAIN,
        }
    }
}
