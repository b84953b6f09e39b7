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
        self.printer.several_tools |= by_tool && index > 0;
        let known = self.switch_load((b'M', word), on, Some(index));
        let named = [b'T', b'H', b'P']
            .iter()
            .any(|letter| value(parameters, *letter).is_some());
        let only = by_tool && !self.printer.several_tools || matches!(word as u32, 140 | 190);
        if on == Some(false) && only && !named {
            self.surely_off(word);
        }
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
                    self.loads.switch_on(1 << load);
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
        if bits == u32::MAX {
            self.printer.maybe_lit &= !(1 << load);
        }
        if self.printer.lit[load] == 0 && self.printer.maybe_lit & (1 << load) == 0 {
            self.loads.switch_off(1 << load);
        }
    }

    /// A word has switched off all that it could have switched on, in a macro too.
    fn surely_off(&mut self, word: f64) {
        for load in 0..self.machine.loads.len().min(32) {
            let nozzle = |word: f64| matches!(word as u32, 104 | 109);
            let alike = |on: &(u8, f64)| on.0 == b'M' && nozzle(on.1) == nozzle(word);
            let data = self.machine.loads.get(load).map(|data| data.on.as_slice());
            let heater = |on: &[(u8, f64)]| {
                let bed = |on: &(u8, f64)| nozzle(on.1) || matches!(on.1 as u32, 140 | 190);
                on.contains(&(b'M', word)) && on.iter().all(|on| alike(on) && bed(on))
            };
            if data.is_some_and(heater) {
                self.printer.maybe_lit &= !(1 << load);
                self.put_out(load, 0);
            }
        }
    }

    /// A macro, of which only the machine knows what it switches: every load may be on.
    pub(super) fn may_heat(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let loads = self.machine.loads.len().min(32) as u32;
        if loads == 0 {
            return note_heaters(run, span);
        }
        let all = u32::MAX.checked_shr(32 - loads).unwrap_or_default();
        self.printer.maybe_lit |= all;
        self.loads.switch_on(all);
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        let message = format!(
            "what {name} switches on only the machine knows: every [[load]] counts as on from here, \
             a nozzle or bed until its target is set to 0, others to the end"
        );
        run.report.note_once("macro-heaters", &message, span);
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
        if !on && name == b"heater_bed" {
            self.surely_off(140.0);
            self.surely_off(190.0);
        }
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

#[cfg(test)]
mod tests {
    use crate::printer::testing::execute;
    use gwatt_motion::Step;

    /// The loads under which each line moves, nozzle 1, bed 2, fan 4, and whether the note stands.
    fn loads(lines: &[&str]) -> (Vec<u32>, bool) {
        let rest = "[language]\nunknown_moves = [\"START_PRINT\"]\n\
                    [[load]]\non = [\"M104\", \"M109\"]\npower_w = 40\n\
                    [[load]]\non = [\"M140\", \"M190\"]\npower_w = 200\n\
                    [[load]]\non = \"M106\"\noff = \"M107\"\npower_w = 5\n";
        let (steps, diagnostics) = execute("klipper", rest, lines);
        let moves = steps.iter().filter_map(|step| match step {
            Step::Move(mv) => Some(mv.loads),
            Step::Action(_) => None,
        });
        let noted = diagnostics.list.iter().any(|it| it.rule == "macro-heaters");
        (moves.collect(), noted)
    }

    #[test]
    fn after_a_macro_heaters_count_as_on_until_their_target_is_0() {
        let (found, noted) = loads(&[
            "G1 X1 F60",
            "START_PRINT BED=60",
            "G1 X2",
            "M104 S0",
            "G1 X3",
            "M140 S0",
            "G1 X4",
            "M107",
            "G1 X5",
        ]);
        assert_eq!(found, [0, 7, 7, 6, 4, 4]);
        assert!(noted);
    }

    /// `M104 S0` ends the tool in use alone, `T` the one that it names.
    #[test]
    fn the_target_of_one_tool_says_nothing_of_others() {
        let (found, _) = loads(&[
            "START_PRINT",
            "M104 T0 S0",
            "G1 X1 F60",
            "T1",
            "M104 S0",
            "G1 X2",
            "TURN_OFF_HEATERS",
            "G1 X3",
        ]);
        assert_eq!(found, [7, 7, 7, 7, 4]);
    }
}
