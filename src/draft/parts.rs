//! The spindle and loads, as they are given: `max_rpm=8000,inertia_kg_m2=0.02,accel_time_s=2.5`,
//! `M8/M9=750`.

use super::{DraftError, MachineKind};

/// Figures of a spindle, and whether each is needed.
const SPINDLE: [(&str, bool); 8] = [
    ("max_rpm", true),
    ("inertia_kg_m2", true),
    ("accel_time_s", true),
    ("base_rpm", false),
    ("friction_nm", false),
    ("peak_power_w", false),
    ("efficiency", false),
    ("base_load_w", false),
];

/// A spindle.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftSpindle {
    /// Names and figures, in the machine file's units.
    pub figures: Vec<(&'static str, f64)>,
}

/// Something that words of a program switch on and off.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftLoad {
    /// The words that switch it on.
    pub on: Vec<String>,
    /// The word that switches it off; `None` for heaters and fans of printers, which the value
    /// 0 switches off.
    pub off: Option<String>,
    /// What it draws, W.
    pub power_w: f64,
}

impl DraftSpindle {
    /// Reads `key=value` with commas between.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn parse(text: &str) -> Result<Self, DraftError> {
        let fault = |wrong: String| DraftError::Part(format!("spindle: {wrong}"));
        let mut figures: Vec<(&'static str, f64)> = Vec::new();
        for part in text.split(',').map(str::trim).filter(|it| !it.is_empty()) {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            let name = name.trim();
            let known = SPINDLE.iter().find(|(key, _)| *key == name);
            let Some((name, _)) = known else {
                let names = SPINDLE.map(|(key, _)| key).join(", ");
                return Err(fault(format!("`{name}` is not known; there are {names}")));
            };
            if figures.iter().any(|(other, _)| other == name) {
                return Err(fault(format!(
                    "`{name}` is given twice: keep one of the two"
                )));
            }
            let number = value.trim().parse::<f64>().ok();
            let Some(number) = number.filter(|it| *it > 0.0 && *it <= 1e9) else {
                return Err(fault(format!(
                    "`{part}`: write {name}= and a number above 0"
                )));
            };
            figures.push((name, number));
        }
        for (name, needed) in SPINDLE {
            if needed && figures.iter().all(|(other, _)| *other != name) {
                return Err(fault(format!("it needs `{name}`")));
            }
        }
        Ok(Self { figures })
    }
}

impl DraftLoad {
    /// Reads `ON/OFF=W`; on printers `ON=W` too.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn parse(text: &str, kind: MachineKind) -> Result<Self, DraftError> {
        let printer = kind == MachineKind::Printer;
        let form = if printer {
            "M104=40 for a nozzle, M140=220 for a bed"
        } else {
            "M8/M9=750: the words that switch it on and off, and its power in W"
        };
        let fault = || DraftError::Part(format!("load `{text}`: write it as {form}"));
        let (words, power) = text.split_once('=').ok_or_else(fault)?;
        let power_w = power.trim().parse::<f64>().ok();
        let power_w = power_w.filter(|it| *it > 0.0 && *it <= 1e9);
        let mut words = words
            .split('/')
            .map(|word| word.trim().to_ascii_uppercase());
        let (Some(on), off, None, Some(power_w)) =
            (words.next(), words.next(), words.next(), power_w)
        else {
            return Err(fault());
        };
        let is_word = |word: &String| {
            let digits = word.strip_prefix('M').unwrap_or_default();
            !digits.is_empty() && digits.len() <= 5 && digits.bytes().all(|it| it.is_ascii_digit())
        };
        if !is_word(&on)
            || off.as_ref().is_some_and(|off| !is_word(off))
            || off.is_none() && !printer
        {
            return Err(fault());
        }
        // The word that waits for the target heats as the other does.
        let both = match on.as_str() {
            "M104" | "M109" if printer => vec!["M104".to_owned(), "M109".to_owned()],
            "M140" | "M190" if printer => vec!["M140".to_owned(), "M190".to_owned()],
            _ => vec![on],
        };
        Ok(Self {
            on: both,
            off,
            power_w,
        })
    }
}
