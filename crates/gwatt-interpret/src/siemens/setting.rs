//! Names that set something, and addresses of several letters.

use super::frame::Frame;
use super::reading::Reading;
use crate::compensation::Insert;
use crate::expression::{Grammar, Outcome};
use crate::level_words::named;
use gwatt_syntax::Block;

impl Reading<'_, '_, '_> {
    /// Takes what belongs to a name that sets something; false for others.
    pub(super) fn setting(&mut self, name: &str, start: usize, block: &mut Block) -> Outcome<bool> {
        match name {
            "DEF" => self.definition()?,
            "PROC" => self.procedure()?,
            // Its parameters are read where it is called.
            "EXTERN" => self.cursor.pass_over_rest(),
            // "Deselection of frames (G53, G153, SUPA, G500)".
            "SUPA" => self.extra().machine_coordinates = true,
            // "Channel-specific diameter/radius programming (DIAMON, DIAM90, DIAMOF,
            // DIAMCYCOF)": under DIAM90 increments are radii, places of X diameters.
            "DIAMON" | "DIAM90" | "DIAMOF" | "DIAMCYCOF" => {
                self.state.diameter = matches!(name, "DIAMON" | "DIAM90");
                self.state.radius_increments = name == "DIAM90";
            }
            "TRANS" | "ATRANS" | "ROT" | "AROT" | "SCALE" | "ASCALE" | "MIRROR" | "AMIRROR" => {
                self.frame_word(name, start)?;
            }
            // "Circular interpolation via intermediate and end point (CIP)".
            "CIP" => self.extra().through_point = true,
            // "Circular interpolation with radius", "with opening angle",
            // "Helical interpolation (TURN)".
            "CR" => {
                let value = self.value_behind(name, start)?;
                self.push_as(b'R', value, start, block);
            }
            "AR" => {
                let value = self.value_behind(name, start)?;
                self.extra().opening_deg = Some(value);
            }
            // "Fixed point approach (G75)".
            "FP" => {
                let value = self.value_behind(name, start)?;
                self.extra().fixed_point = Some(value);
            }
            "TURN" => {
                let value = self.value_behind(name, start)?;
                self.push_as(b'P', value + 1.0, start, block);
            }
            // "Travel commands with polar coordinates (AP, RP)".
            "AP" | "RP" => {
                self.equals(name, start)?;
                let value = Some(self.measured()?);
                if name == "AP" {
                    self.extra().polar_angle = value;
                } else {
                    self.extra().polar_radius = value;
                }
            }
            "NORM" | "KONT" | "KONTC" | "KONTT" | "CFC" | "CFTCP" | "CFIN" | "DISC" => {
                self.radius_word(name, start)?;
            }
            // "Chamfer, rounding (CHF, CHR, RND, RNDM)".
            "CHF" | "CHR" | "RND" | "RNDM" => self.corner_word(name, start)?,
            "OVR" => self.feed_override(start)?,
            "ACC" | "OVRRAP" | "OVRA" | "VELOLIM" | "ACCLIMA" | "VELOLIMA" | "JERKLIM"
            | "JERKLIMA" => self.limit(name, start)?,
            // "Acceleration response (BRISK, SOFT, DRIVE)": of the path. The forms with an A are for
            // positioning axes.
            "BRISK" | "SOFT" | "DRIVE" => {
                self.state.limits.brisk = name != "SOFT";
                self.extra().turns_limit = true;
            }
            // "Continuous-path mode (G641 …)": where a corner is rounded, of feeds and of rapids.
            "ADIS" => self.state.smoothing.of_feeds = self.value_behind(name, start)?,
            "ADISPOS" => self.state.smoothing.of_rapids = self.value_behind(name, start)?,
            // "Three, four and five axis transformation (TRAORI)".
            "TRAORI" => {
                self.cursor.pass_over_parentheses()?;
                self.deselect_frames();
                let message = "TRAORI: the axes are taken as they are programmed; \
                               what the transformation adds to them is not counted";
                self.note("transformation", message, start);
            }
            "TRAFOOF" => self.deselect_frames(),
            "CYCLE832" => self.high_speed_settings()?,
            "CYCLE800" => {
                self.cursor.expect(b'(')?;
                if self.cursor.peek() != Some(b')') {
                    self.cursor.pass_over_rest();
                    let reason = "a swivelled plane, which turns axes as the machine is built";
                    return Err(self.cursor.refused(name, reason, start));
                }
                self.cursor.at += 1;
            }
            _ => return self.spindle_word(name, start),
        }
        Ok(true)
    }

    /// "Constraints when selecting a transformation": the frame in force is deselected, as by
    /// G500.
    fn deselect_frames(&mut self) {
        let at = &self.control.position.at;
        self.state.change_frame(Frame::default(), at);
        self.extra().deselects = true;
    }

    fn corner_word(&mut self, name: &str, start: usize) -> Outcome<()> {
        let value = self.value_behind(name, start)?;
        if value < 0.0 || self.extra().corner.is_some() && name != "RNDM" {
            let message = "a block takes one chamfer or rounding, from 0 on";
            let help = "write one of them";
            return Err(self.cursor.fault("corner-word", message, help, start));
        }
        let length_mm = value * self.control.modal.mm_per_unit;
        let round = |modal| Insert::Round {
            radius_mm: length_mm,
            modal,
        };
        let insert = match name {
            "CHF" => Insert::Chamfer(length_mm),
            "CHR" => Insert::Legs(length_mm),
            "RND" => round(false),
            _ => {
                self.state.rounds = (value > 0.0).then(|| round(true));
                return Ok(());
            }
        };
        if value > 0.0 {
            self.extra().corner = Some(insert);
        }
        Ok(())
    }

    fn equals(&mut self, name: &str, start: usize) -> Outcome<()> {
        if self.cursor.take(b'=') {
            return Ok(());
        }
        let message = format!("{name} has no value");
        let help = "write `=` and the value after it";
        Err(self.cursor.fault("syntax", message, help, start))
    }

    pub(super) fn value_behind(&mut self, name: &str, start: usize) -> Outcome<f64> {
        self.equals(name, start)?;
        self.number()
    }

    /// "Programmable feedrate override (OVR)": 0 to 200 % of path feeds, not of
    /// rapids, modal.
    fn feed_override(&mut self, start: usize) -> Outcome<()> {
        let percent = self.value_behind("OVR", start)?;
        if percent > 0.0 && percent <= 200.0 {
            self.state.feed_factor = percent / 100.0;
            return Ok(());
        }
        let message = format!("OVR of {percent} %");
        let help = "write a value above 0 and up to 200";
        Err(self.cursor.fault("override", message, help, start))
    }

    /// CYCLE832 ("High Speed Settings") chooses a path mode that blends.
    fn high_speed_settings(&mut self) -> Outcome<()> {
        let start = self.cursor.at;
        self.cursor.pass_over_parentheses()?;
        self.extra().blends = true;
        if let Some((group, _)) = named(self.control.machine, "DYNNORM") {
            self.extra().level = Some((group, None));
            let message = "CYCLE832 chooses a dynamic mode by a program of the machine's builder: \
                           the highest accelerations of all modes count from here on";
            self.note("level-unclear", message, start);
        }
        Ok(())
    }

    /// A dynamic mode, where the machine file has accelerations for them ("Dynamic
    /// response"); false for other names.
    pub(super) fn level(&mut self, name: &str, start: usize) -> Outcome<bool> {
        let Some((group, level)) = named(self.control.machine, name) else {
            if name.starts_with("DYN") && name != "DYNNORM" {
                let message = "dynamic modes (DYNROUGH and similar ones) have accelerations of their \
                               own: those of the machine file have to be the highest of all that \
                               the program selects, or each mode's stands under [[levels]]";
                self.note("dynamic-mode", message, start);
            }
            return Ok(false);
        };
        if level.is_none() {
            let message = format!("what {name} makes of the accelerations is not known");
            let help = "give it under [[levels]] of the machine file";
            return Err(self.cursor.fault("level-unknown", message, help, start));
        }
        self.extra().level = Some((group, level));
        Ok(true)
    }
}
