//! Heaters and fans: loads that a word switches by its value.
//!
//! Sources: Marlin M104, M109, M140, M190 (S, R: temperature, T: tool), M106
//! and M107 (S: speed, P: fan); `RepRapFirmware` M568 and G10 (S, R, P);
//! Klipper, "G-Codes", `[heaters]`, `[fan_generic]`.

use super::line::{Parameters, Text, value};
use crate::control::{Control, Run};
use gwatt_syntax::source::Span;

/// Number under which a fan or heater with a name is kept.
const NAMED: u32 = 31;

/// Words that heat.
const HEATERS: [f64; 7] = [104.0, 109.0, 140.0, 190.0, 141.0, 191.0, 568.0];

impl Control<'_> {
    /// Switches the loads that an M word switches.
    pub(super) fn switch_printer_loads(
        &mut self,
        run: &mut Run<'_, '_>,
        word: f64,
        parameters: &Parameters,
        span: Span,
    ) {
        let by_tool = matches!(word as u32, 104 | 109);
        let index = match word as u32 {
            104 | 109 | 221 => value(parameters, b'T').unwrap_or(f64::from(self.printer.tool)),
            140 | 190 | 141 | 191 => value(parameters, b'H').unwrap_or(0.0),
            _ => value(parameters, b'P').unwrap_or(0.0),
        };
        let index = (index.clamp(0.0, f64::from(NAMED)) as u32).min(NAMED);
        let amount = [b'S', b'R']
            .into_iter()
            .filter_map(|letter| value(parameters, letter))
            .reduce(f64::max);
        let fan = word == 106.0;
        let on = match amount {
            Some(amount) => Some(amount > 0.0),
            // `M106` alone is full speed; `M104` alone changes nothing.
            None if fan => Some(true),
            None if HEATERS.contains(&word) => None,
            None => Some(true),
        };
        let known = self.switch_load((b'M', word), on, Some(index));
        let off_word = word == 107.0 || by_tool;
        for load in 0..self.machine.loads.len().min(32) {
            let Some(data) = self.machine.loads.get(load) else {
                continue;
            };
            if data.off.contains(&(b'M', word)) {
                let bits = if off_word { 1 << index } else { u32::MAX };
                self.put_out(load, bits);
            }
        }
        let heats = fan || HEATERS.contains(&word) || word == 303.0;
        if heats && !known && on != Some(false) {
            note_heaters(run, span);
        }
    }

    /// Switches the loads that list `word` under `on`; false if there are none.
    /// Without a number, all of them at once.
    pub(super) fn switch_load(
        &mut self,
        word: (u8, f64),
        on: Option<bool>,
        index: Option<u32>,
    ) -> bool {
        let mut known = false;
        for load in 0..self.machine.loads.len().min(32) {
            let Some(data) = self.machine.loads.get(load) else {
                continue;
            };
            if !data.on.contains(&word) {
                continue;
            }
            known = true;
            let bits = index.map_or(u32::MAX, |index| 1 << index.min(NAMED));
            match on {
                Some(true) => {
                    self.printer.lit[load] |= bits;
                    self.loads |= 1 << load;
                    self.loads_off &= !(1 << load);
                }
                Some(false) => self.put_out(load, bits),
                None => {}
            }
        }
        known
    }

    /// Takes heaters or fans off a load; it is off after the block's moves
    /// when none is left.
    fn put_out(&mut self, load: usize, bits: u32) {
        self.printer.lit[load] &= !bits;
        if self.printer.lit[load] == 0 {
            self.loads_off |= 1 << load;
        }
    }

    /// `SET_HEATER_TEMPERATURE HEATER=name TARGET=t`.
    pub(super) fn set_heater(
        &mut self,
        run: &mut Run<'_, '_>,
        text: Text<'_>,
        at: usize,
        span: Span,
    ) {
        let name = text
            .argument(at, "HEATER")
            .unwrap_or_default()
            .to_ascii_lowercase();
        let target = text.number_argument(at, "TARGET");
        let on = match target {
            Ok(target) => target.is_some_and(|target| target > 0.0),
            Err(_) => true,
        };
        let number = name
            .strip_prefix(b"extruder")
            .and_then(|digits| std::str::from_utf8(digits).ok()?.parse::<u32>().ok());
        let (words, index) = match (name.as_slice(), number) {
            (b"extruder", _) => ([104.0, 109.0], 0),
            (b"heater_bed", _) => ([140.0, 190.0], 0),
            (_, Some(number)) => ([104.0, 109.0], number.min(NAMED)),
            _ => ([141.0, 191.0], NAMED),
        };
        let known = words.map(|word| self.switch_load((b'M', word), Some(on), Some(index)));
        if on && known == [false; 2] {
            note_heaters(run, span);
        }
    }

    /// `SET_FAN_SPEED FAN=name SPEED=s`: which of several fans it is is not known, so
    /// none is ever taken for switched off.
    pub(super) fn set_fan(&mut self, run: &mut Run<'_, '_>, text: Text<'_>, at: usize, span: Span) {
        let on = text.number_argument(at, "SPEED") != Ok(Some(0.0));
        if on && !self.switch_load((b'M', 106.0), Some(true), Some(NAMED)) {
            note_heaters(run, span);
        }
    }

    /// `TURN_OFF_HEATERS`.
    pub(super) fn turn_off_heaters(&mut self) {
        for word in HEATERS {
            self.switch_load((b'M', word), Some(false), None);
        }
    }
}

fn note_heaters(run: &mut Run<'_, '_>, span: Span) {
    let message = "heaters and fans without a [[load]] in the machine file are not counted";
    run.report.note_once("heaters", message, span);
}
