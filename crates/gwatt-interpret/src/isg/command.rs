//! Commands that begin with `#` ("Additional functions (#..)").

use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use crate::jump::Go;
use gwatt_syntax::Block;
use memchr::memmem;

/// What a command is.
enum Kind {
    /// It moves nothing and changes no path.
    Passes,
    /// It changes how speed and acceleration are built up within their limits,
    /// or lowers the limits.
    Smooths,
    /// It chooses the profile of acceleration.
    Slope,
    /// It limits speed and acceleration along the path.
    Limits,
    Refused(&'static str),
}

/// Commands by how they begin; the first that fits counts.
const COMMANDS: [(&str, Kind); 40] = [
    ("MSG", Kind::Passes),
    ("ADD", Kind::Passes),
    ("FLUSH", Kind::Smooths),
    ("SLOPE", Kind::Slope),
    ("SET SLOPE", Kind::Slope),
    ("CONTOUR MODE", Kind::Smooths),
    ("VECTOR LIMIT", Kind::Limits),
    ("LAH", Kind::Smooths),
    ("BLOCKSEARCH", Kind::Passes),
    ("BACKWARD STORAGE", Kind::Passes),
    ("CACHE", Kind::Passes),
    ("DELETE", Kind::Passes),
    ("ACS OFF", Kind::Passes),
    ("BCS OFF", Kind::Passes),
    ("ECS OFF", Kind::Passes),
    ("TRAFO OFF", Kind::Passes),
    ("CYL OFF", Kind::Passes),
    ("FACE OFF", Kind::Passes),
    ("HSC OFF", Kind::Passes),
    ("SPLINE OFF", Kind::Passes),
    ("MCS OFF", Kind::Passes),
    ("PTP OFF", Kind::Passes),
    ("CAXTRACK OFF", Kind::Passes),
    ("CS", Kind::Refused("a coordinate system of another mode")),
    ("ACS", Kind::Refused("another coordinate system")),
    ("BCS", Kind::Refused("another coordinate system")),
    ("ECS", Kind::Refused("the coordinate system of the tool")),
    ("MCS", Kind::Refused("programming in axes of the machine")),
    ("TRAFO", Kind::Refused("a kinematic transformation")),
    ("KIN", Kind::Refused("a kinematic transformation")),
    ("CYL", Kind::Refused("machining on a cylinder")),
    ("FACE", Kind::Refused("machining on a face")),
    ("SPLINE", Kind::Refused("a spline")),
    ("AKIMA", Kind::Refused("a spline")),
    (
        "MACHINE DATA",
        Kind::Refused("new data of the machine's axes"),
    ),
    ("CALL AX", Kind::Refused("an exchange of axes")),
    ("PUT AX", Kind::Refused("an exchange of axes")),
    ("SET AX", Kind::Refused("an exchange of axes")),
    ("AX", Kind::Refused("an exchange or a coupling of axes")),
    ("PTP", Kind::Refused("a move from point to point")),
];

const SMOOTHS: &str = "#CONTOUR MODE, #HSC, #OVERRIDE and similar words change speed within \
                       the limits of the axes: taken as not there";

/// "Adapt path dynamic limit values (#VECTOR LIMIT ON/OFF)", "P-CHAN-00351", "P-CHAN-00350".
const LIMITS: &str = "#VECTOR LIMIT lowers speed and acceleration along the path, in a unit and on \
                      blocks that parameters of the channel say; the limits of the axes hold under \
                      it: counted as not there";

impl Reading<'_, '_, '_> {
    /// A command.
    pub(super) fn command(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        self.cursor.at += 1;
        let name = self.command_name();
        match name.as_str() {
            "COMMENT BEGIN" => {
                self.state.comments = true;
                self.comment_goes_on();
            }
            "COMMENT END" => {}
            "VAR" => {
                self.state.declares = true;
                self.declaration()?;
            }
            "TIME" => {
                if !block.words.is_empty() {
                    let message = "#TIME after other words";
                    let help = "write it in a block of its own";
                    return Err(self.cursor.fault("dwell-time", message, help, start));
                }
                self.cursor.add_word(b'G', 4.0, start, start, block)?;
                let number = self.cursor.at;
                let value = self.number()?;
                self.cursor.add_word(b'P', value, start, number, block)?;
            }
            "ROTATION ON" => self.rotation_on(start, block)?,
            "ROTATION OFF" => self.cursor.add_word(b'G', 69.0, start, start, block)?,
            "HSC ON" => self.hsc(start)?,
            "CS DEF" => self.define_system(start)?,
            "CS ON" => self.system_on(start)?,
            "CS OFF" => self.system_off(false),
            "CS OFF ALL" => self.system_off(true),
            "OVERRIDE" => self.factors(start)?,
            "ERROR" => return Err(self.cursor.alarm("#ERROR", start)),
            _ => self.listed(&name, start)?,
        }
        Ok(None)
    }

    /// The words of a command, before brackets and values.
    fn command_name(&mut self) -> String {
        let mut name = String::new();
        for _ in 0..4 {
            let word = self.cursor.name();
            let value = word.starts_with('P') && word.get(1..2).is_some_and(|it| it < ":");
            if word.is_empty() || value || self.cursor.byte(1) == b'.' {
                break;
            }
            self.cursor.at += word.len();
            if !name.is_empty() {
                name.push(' ');
            }
            name.push_str(&word);
            if word == "TIME" {
                break;
            }
        }
        name
    }

    fn listed(&mut self, name: &str, start: usize) -> Outcome<()> {
        let fits = |front: &str| {
            name.strip_prefix(front)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
        };
        let found = COMMANDS.iter().find(|(front, _)| fits(front));
        match found.map(|(_, kind)| kind) {
            Some(Kind::Passes) => {}
            Some(Kind::Slope) => self.slope(),
            Some(Kind::Smooths) => self.note("smoothing", SMOOTHS, start),
            Some(Kind::Limits) => self.note("limit-not-lowered", LIMITS, start),
            Some(Kind::Refused(reason)) => {
                return Err(self.cursor.refused(&format!("#{name}"), reason, start));
            }
            None => {
                let reason = "a command of this control";
                return Err(self.cursor.refused(&format!("#{name}"), reason, start));
            }
        }
        // The texts of messages hold any bytes.
        self.cursor.pass_over_rest();
        Ok(())
    }

    /// `#SLOPE [TYPE=STEP]`: without a limit of jerk; so is what is not known.
    fn slope(&mut self) {
        let rest = self.cursor.text.get(self.cursor.at..).unwrap_or_default();
        let rest = rest.to_ascii_uppercase();
        let has_jerk = [&b"TRAPEZ"[..], b"SIN"]
            .iter()
            .any(|it| memmem::find(&rest, it).is_some());
        self.state.jerk_factor = Some(if has_jerk { 1.0 } else { f64::INFINITY });
    }

    /// `#HSC ON [OPMODE=1 CONTERROR=0.1]`: polynomials at corners; with 2 splines
    /// through the points, which leave the programmed path.
    fn hsc(&mut self, start: usize) -> Outcome<()> {
        let values = self.named_values(["OPMODE", "CONTERROR"])?;
        if values.first().copied().flatten().unwrap_or(1.0) != 1.0 {
            return Err(self.cursor.refused("#HSC ON [OPMODE=2]", "a spline", start));
        }
        self.note("smoothing", SMOOTHS, start);
        Ok(())
    }

    /// `#OVERRIDE [FEED_FACT=60 RAPID_FACT=50]`.
    fn factors(&mut self, start: usize) -> Outcome<()> {
        let values = self.named_values(["FEED_FACT", "RAPID_FACT"])?;
        if values.iter().flatten().any(|value| *value > 100.0) {
            let message = "#OVERRIDE with more than 100 percent";
            let help = "write higher feeds, or give the machine file the override: \
                        override_max_percent";
            return Err(self.cursor.fault("unsupported-word", message, help, start));
        }
        self.note("smoothing", SMOOTHS, start);
        Ok(())
    }

    /// `[NAME=1 OTHER=2]`, in any order; also `NAME1` ("<expr>" of old manuals).
    pub(super) fn named_values<const N: usize>(
        &mut self,
        names: [&str; N],
    ) -> Outcome<[Option<f64>; N]> {
        let mut values = [None; N];
        if !self.cursor.take(b'[') {
            return Ok(values);
        }
        while !self.cursor.take(b']') {
            let start = self.cursor.at;
            let word = self.cursor.name();
            let bare = word.trim_end_matches(|digit: char| digit.is_ascii_digit());
            let whole = names.iter().position(|name| word == *name);
            let place = whole.or_else(|| names.iter().position(|name| *name == bare));
            self.cursor.at += if whole.is_some() {
                word.len()
            } else {
                bare.len()
            };
            let Some(slot) = place.and_then(|place| values.get_mut(place)) else {
                self.cursor.at = self.cursor.at.max(start + 1);
                let message = "a name that this command does not have";
                let help = "see the manual for its names; they stand as NAME=value";
                return Err(self.cursor.fault("syntax", message, help, start));
            };
            self.cursor.take(b'=');
            *slot = Some(self.number()?);
            self.cursor.take(b',');
        }
        Ok(values)
    }

    /// Inside `#COMMENT BEGIN … #COMMENT END`.
    pub(super) fn comment_goes_on(&mut self) {
        let rest = self.cursor.text.get(self.cursor.at..).unwrap_or_default();
        let rest = rest.to_ascii_uppercase();
        let end = memmem::find(&rest, b"#COMMENT END");
        self.state.comments = end.is_none();
        self.cursor.pass_over_rest();
    }
}
