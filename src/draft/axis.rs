//! An axis as it is given: `X:rapid_mm_min=30000,table_kg=60,screw=20x800x10,…`.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::key::{Form, KEYS, Key};
use super::{DraftError, MachineKind};
use crate::machine::{Motor, MotorSeries, motor};

/// What drives an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// A screw of this diameter, length and lead, mm.
    Screw([f64; 3]),
    /// A pinion on a rack: diameter of its pitch circle and width, mm.
    Pinion([f64; 2]),
    /// A toothed belt: teeth of its pulleys, from tooth to tooth and width, mm.
    Belt([f64; 3]),
    /// A linear motor.
    Direct,
    /// The motor turns the axis, by a gear or without.
    Turning,
    /// Wheels push filament: this far a revolution, mm.
    Filament(f64),
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftAxis {
    /// Its letter.
    pub letter: char,
    /// How it moves.
    pub form: Form,
    /// What drives it.
    pub drive: Drive,
    /// Its motor, and the document that this comes from.
    pub motor: Option<(Motor, MotorSeries)>,
    /// Whether its torque limits the acceleration that is asked for.
    pub(super) torque_limits: bool,
    figures: BTreeMap<&'static str, f64>,
}

impl DraftAxis {
    /// Reads an axis: its letter, a colon, and `key=value` with commas between.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn parse(text: &str, kind: MachineKind) -> Result<Self, DraftError> {
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        let fault = |wrong: String| DraftError::Axis {
            axis: name.to_owned(),
            wrong,
        };
        let mut letters = name.trim().chars();
        let letter = match (letters.next(), letters.next()) {
            (Some(letter), None) => Some(letter),
            _ => None,
        };
        let known = letter.and_then(|letter| Some((letter, Form::of(letter)?)));
        let printer = kind == MachineKind::Printer;
        let (letter, form) = known
            .filter(|(_, form)| match form {
                Form::Slide => true,
                Form::Turn => !printer,
                Form::Extruder => printer,
            })
            .ok_or_else(|| {
                let letters = kind.letters();
                fault(format!(
                    "the letter of an axis of a {kind} is one of {letters}"
                ))
            })?;
        let mut axis = Self {
            letter,
            form,
            drive: Drive::Direct,
            motor: None,
            torque_limits: false,
            figures: BTreeMap::new(),
        };
        let mut drive = None;
        for part in rest
            .split(',')
            .map(str::trim)
            .filter(|part| !part.is_empty())
        {
            let (key, value) = part
                .split_once('=')
                .ok_or_else(|| fault(format!("`{part}` has no value: write {part}=…")))?;
            match drive_of(key, value) {
                Some(found) => {
                    let found = found.map_err(fault)?;
                    let pushes = matches!(found, Drive::Filament(_));
                    if form == Form::Turn || pushes != (form == Form::Extruder) {
                        let wrong = format!("`{key}` is no drive of this axis: leave it out");
                        return Err(fault(wrong));
                    }
                    if drive.replace(found).is_some() {
                        return Err(fault("it has two drives: keep one".to_owned()));
                    }
                }
                None if key.trim() == "motor" => axis.take_motor(value).map_err(fault)?,
                None => axis.take(key, value).map_err(fault)?,
            }
        }
        let wanted = match form {
            Form::Extruder => "it needs filament=MM, what a revolution of its wheels pushes",
            _ => {
                "it needs what drives it: screw=DIAMETERxLENGTHxLEAD, pinion=DIAMETERxWIDTH, \
                 belt=TEETHxPITCHxWIDTH (all in mm), or drive=linear-motor"
            }
        };
        let turning = Some(Drive::Turning).filter(|_| form == Form::Turn);
        axis.drive = drive.or(turning).ok_or_else(|| fault(wanted.to_owned()))?;
        axis.check(kind).map_err(fault)?;
        Ok(axis)
    }

    fn take_motor(&mut self, name: &str) -> Result<(), String> {
        let Some(found) = motor(name) else {
            return Err(format!(
                "`motor={name}`: there is no such motor in `gwatt machine motors`; give \
                 rotor_kg_m2 from its data sheet"
            ));
        };
        match self.motor.replace(found) {
            Some(_) => Err("`motor` is given twice: keep one of the two".to_owned()),
            None => Ok(()),
        }
    }

    /// Gives it this motor, unless it has one or needs none.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn with_motor(mut self, name: &str, kind: MachineKind) -> Result<Self, DraftError> {
        if self.motor.is_some() || self.drive == Drive::Direct {
            return Ok(self);
        }
        let axis = self.letter.to_string();
        let fault = |wrong: String| DraftError::Axis {
            axis: axis.clone(),
            wrong,
        };
        self.take_motor(name).map_err(fault)?;
        self.check(kind).map_err(fault)?;
        Ok(self)
    }

    fn take(&mut self, name: &str, value: &str) -> Result<(), String> {
        let mut own = KEYS.iter().filter(|key| key.forms.contains(&self.form));
        let key = own.clone().find(|key| key.name == name).ok_or_else(|| {
            let names: Vec<&str> = own.by_ref().map(|key| key.name).collect();
            let drives = match self.form {
                Form::Slide => "motor, screw, pinion, belt and drive",
                Form::Turn => "and motor",
                Form::Extruder => "motor and filament",
            };
            format!(
                "`{name}` is not known; there are {}, {drives}",
                names.join(", ")
            )
        })?;
        let number = number_of(key, value)?;
        if self.figures.insert(key.name, number).is_some() {
            return Err(format!("`{name}` is given twice: keep one of the two"));
        }
        Ok(())
    }

    fn check(&self, kind: MachineKind) -> Result<(), String> {
        for name in self.form.needed() {
            if self.get(name).is_none() {
                return Err(format!("it needs `{name}`"));
            }
        }
        let vertical = kind.is_vertical(self.letter);
        let guide = self.get("guide_friction").is_some();
        if guide && self.get("coulomb_n").is_some() {
            return Err("`guide_friction` and `coulomb_n` both say its friction: keep one".into());
        }
        if guide && vertical {
            return Err("its guides carry no weight, as it is vertical: give `coulomb_n`".into());
        }
        if self.get("counterweight_kg").is_some() && !vertical {
            return Err("a counterweight balances vertical axes alone".into());
        }
        if self.drive == Drive::Direct && self.get("gear_ratio").is_some() {
            return Err("a linear motor has no gear: leave `gear_ratio` out".into());
        }
        if self.drive == Drive::Direct && self.get("rotor_kg_m2").is_some_and(|it| it > 0.0) {
            return Err("a linear motor has no rotor: add its mass to `table_kg`".into());
        }
        if self.drive == Drive::Direct && self.motor.is_some() {
            return Err("`motor` is one that turns, but the axis has a linear motor".into());
        }
        self.check_speed()
    }

    /// Refuses a rapid that its motor cannot turn.
    fn check_speed(&self) -> Result<(), String> {
        let Some((motor, _)) = &self.motor else {
            return Ok(());
        };
        let (Some(max_rpm), Some(travel)) = (motor.max_rpm, self.travel()) else {
            return Ok(());
        };
        let rpm = self.rapid() / travel;
        if rpm <= max_rpm * (1.0 + 1e-9) {
            return Ok(());
        }
        let rapid = self.form.needed().first().copied().unwrap_or_default();
        Err(format!(
            "its rapid turns the motor at {rpm:.0} rpm, and {} has {max_rpm} at most: at most \
             {rapid}={:.0}",
            motor.name,
            (max_rpm * travel).floor()
        ))
    }

    /// Its rapid speed, mm/min or degrees/min.
    #[must_use]
    pub fn rapid(&self) -> f64 {
        let rapid = self.get("rapid_mm_min").or(self.get("rapid_deg_min"));
        rapid.unwrap_or(0.0)
    }

    /// How far a revolution of the motor moves it, mm or degrees; `None` for a linear motor.
    #[must_use]
    pub fn travel(&self) -> Option<f64> {
        let gear = self.get("gear_ratio").unwrap_or(1.0);
        let own = match self.drive {
            Drive::Screw([_, _, lead]) => lead,
            Drive::Pinion([diameter, _]) => PI * diameter,
            Drive::Belt([teeth, pitch, _]) => teeth * pitch,
            Drive::Filament(length) => length,
            Drive::Turning => 360.0,
            Drive::Direct => return None,
        };
        Some(own / gear)
    }

    /// Rotor inertia, as given or of its motor, kg·m².
    #[must_use]
    pub fn rotor_kg_m2(&self) -> Option<f64> {
        let of_motor = self.motor.as_ref().map(|(motor, _)| motor.rotor_kg_m2);
        self.get("rotor_kg_m2").or(of_motor)
    }

    /// A figure, in the unit of its name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.figures.get(name).copied()
    }

    /// What slides, kg.
    #[must_use]
    pub fn moved_kg(&self) -> f64 {
        self.get("table_kg").unwrap_or(0.0) + self.get("workpiece_kg").unwrap_or(0.0)
    }

    /// Whether something that may be left out was, and matters for it.
    pub(super) fn lacks(&self, field: &str, kind: MachineKind) -> bool {
        match field {
            "rotor inertia" => self.drive != Drive::Direct && self.rotor_kg_m2().is_none(),
            "friction" => ["guide_friction", "coulomb_n", "friction_nm"]
                .iter()
                .all(|name| self.get(name).is_none()),
            "counterweight" => {
                kind.is_vertical(self.letter) && self.get("counterweight_kg").is_none()
            }
            _ => self.get(field).is_none(),
        }
    }
}

/// A number that this figure can have.
fn number_of(key: &Key, value: &str) -> Result<f64, String> {
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| format!("`{}={value}`: this is no number", key.name))?;
    let most = match key.name {
        "efficiency" | "guide_friction" => 1.0,
        _ => 1e9,
    };
    let fits =
        number.is_finite() && number <= most && (number > 0.0 || key.may_be_zero && number == 0.0);
    if fits {
        return Ok(number);
    }
    let least = if key.may_be_zero { "from 0" } else { "above 0" };
    Err(format!(
        "`{}={value}`: the {} is {least} to {most}",
        key.name, key.what
    ))
}

/// What drives an axis, if the key says that.
fn drive_of(key: &str, value: &str) -> Option<Result<Drive, String>> {
    fn sizes<const N: usize>(key: &str, value: &str, form: &str) -> Result<[f64; N], String> {
        let wrong = || format!("`{key}={value}`: write {key}={form}, each above 0");
        let numbers: Vec<f64> = value
            .split('x')
            .map(|part| part.trim().parse().ok())
            .collect::<Option<_>>()
            .ok_or_else(wrong)?;
        let fits = numbers.iter().all(|it| *it > 0.0 && *it <= 1e6);
        numbers.try_into().ok().filter(|_| fits).ok_or_else(wrong)
    }
    Some(match key.trim() {
        "screw" => sizes(key, value, "DIAMETERxLENGTHxLEAD in mm").map(Drive::Screw),
        "pinion" => sizes(key, value, "DIAMETERxWIDTH in mm").map(Drive::Pinion),
        "belt" => sizes(key, value, "TEETHxPITCHxWIDTH, the last two in mm").map(Drive::Belt),
        "filament" => sizes(key, value, "MM, what a revolution of its wheels pushes")
            .map(|[length]: [f64; 1]| Drive::Filament(length)),
        "drive" if value.trim() == "linear-motor" => Ok(Drive::Direct),
        "drive" => Err(format!("`drive={value}`: there is drive=linear-motor")),
        _ => return None,
    })
}
