//! Variables ("User Task": common variables, local variables, system variables).

use super::block::Reading;
use super::terms::TERMS;
use crate::expression::{Cursor, Grammar, Ident, Names, Outcome, Terms, keep};

/// System variables that move nothing: drawings, barriers of chuck and tail
/// stock, monitoring of load, outputs and messages.
const PASSIVE: [&str; 9] = [
    "VGR", "VCHK", "VTSL", "VTSD", "VWKR", "VLMON", "VUACM", "VDOUT", "VTMNO",
];

const TOOL_SPINDLE: &str = "what the tool's own spindle (SB) draws is not counted; feeds per \
     revolution count at the faster of both spindles";

/// Whether an address of two letters of some model has this name ("Extended address
/// characters"): places of a second saddle, chamfers, turns, offsets.
fn is_reserved(name: &str) -> bool {
    const OTHERS: [&str; 13] = [
        "BC", "BR", "QA", "CL", "CP", "CQ", "CR", "SX", "SY", "SZ", "TL", "TD", "TS",
    ];
    match name.as_bytes() {
        [first, b'A' | b'B'] if b"ADFIKLRSTUWXZ".contains(first) => true,
        _ => OTHERS.contains(&name),
    }
}

/// What a name stands for.
enum Name {
    Common(Ident),
    Local(Ident),
    System(Ident),
}

impl<'t> Names<'t> for Reading<'_, 't> {
    fn terms(&self) -> &'static Terms {
        &TERMS
    }

    fn cursor(&mut self) -> &mut Cursor<'t> {
        &mut self.cursor
    }

    fn variable(&mut self) -> Outcome<Option<f64>> {
        let start = self.cursor.at;
        let Some(found) = self.variable_name()? else {
            return Ok(None);
        };
        let (kept, name) = match found {
            Name::Common(name) => (Some(&self.state.common), name),
            Name::Local(name) => (self.state.levels.last(), name),
            Name::System(name) => (None, name),
        };
        let value = kept.and_then(|kept| kept.get(&name)).copied();
        let Some(value) = value else {
            let message = format!(
                "{name} has no value in this program: what it holds, only the control knows"
            );
            let help = "assign it before it is used";
            return Err(self.cursor.fault("unknown-value", message, help, start));
        };
        self.uses.reads(name, &self.cursor, start)?;
        Ok(Some(value))
    }
}

impl Reading<'_, '_> {
    /// Takes the name of a variable with its index.
    fn variable_name(&mut self) -> Outcome<Option<Name>> {
        let name = self.cursor.name();
        let letters = name.bytes().take_while(u8::is_ascii_alphabetic).count();
        if letters == 0 {
            return Ok(None);
        }
        self.cursor.at += name.len();
        let number = name.get(letters..).unwrap_or_default();
        let common = matches!(name.get(..letters), Some("V" | "VC" | "VS"));
        if !name.starts_with('V') {
            if letters < 2 {
                self.cursor.at -= name.len();
                return Ok(None);
            }
            return Ok(Some(Name::Local(name)));
        }
        let mut full = name.clone();
        if (number.is_empty() || !common) && self.cursor.peek() == Some(b'[') {
            self.cursor.at += 1;
            let start = self.cursor.at;
            let index = self.number()?;
            self.cursor.expect(b']')?;
            if index.fract() != 0.0 || !(0.0..=1e6).contains(&index) {
                let message = format!("{index} is no index");
                let help = "indices are whole numbers";
                return Err(self.cursor.fault("array-index", message, help, start));
            }
            full = if common {
                Ident::of(format_args!("{name}{index}"))
            } else {
                Ident::of(format_args!("{name}[{index}]"))
            };
        }
        Ok(Some(if common {
            Name::Common(full)
        } else {
            Name::System(full)
        }))
    }

    /// `V1=…`, `VC1=…`, `NAME=…`, where a name of at least two letters or a V
    /// begins and `=` stands after it; false otherwise.
    pub(super) fn assignment(&mut self) -> Outcome<bool> {
        let start = self.cursor.at;
        let Some(name) = self.variable_name()? else {
            return Ok(false);
        };
        if !self.cursor.assigns() {
            self.cursor.at = start;
            return Ok(false);
        }
        if matches!(&name, Name::Local(name) if name.as_str() == "HP") {
            let message = "HP, a home position (G20, G21), which is not followed";
            let help = "write the way there as a rapid";
            return Err(self.cursor.fault("unsupported-word", message, help, start));
        }
        if matches!(&name, Name::Local(name) if name.as_str() == "SB") {
            // "M-tool": feeds per revolution may follow it, or the workpiece's spindle.
            self.cursor.at += 1;
            self.state.tool_rpm = self.number()?.abs();
            self.notes
                .push(("other-spindle", TOOL_SPINDLE, self.cursor.span(start)));
            return Ok(true);
        }
        if matches!(&name, Name::Local(name) if name.as_str() == "FA") {
            let message = "FA, the feed of the way out of a bore, which is not followed";
            let help = "write the cycle out as single blocks";
            return Err(self.cursor.fault("unsupported-word", message, help, start));
        }
        if let Name::Local(name) = &name
            && is_reserved(name)
        {
            self.reserved.get_or_insert((name.clone(), start));
        }
        let (text, local) = match name {
            Name::Common(name) => (name, false),
            Name::Local(name) => (name, true),
            Name::System(name) => {
                if !PASSIVE.iter().any(|front| name.starts_with(front)) {
                    let message = format!("{name} belongs to the control, and may change offsets");
                    let help = "take it out, or write what it does in words";
                    return Err(self.cursor.fault("unsupported-word", message, help, start));
                }
                self.cursor.at += 1;
                if self.cursor.peek() == Some(b'\'') {
                    self.cursor.pass_over_rest();
                } else {
                    self.number()?;
                }
                return Ok(true);
            }
        };
        self.uses.assigns(&text, &self.cursor, start)?;
        self.cursor.at += 1;
        let value = self.number()?;
        self.set(&text, local, value, start)?;
        self.uses.assigned(text);
        Ok(true)
    }

    fn set(&mut self, name: &Ident, local: bool, value: f64, start: usize) -> Outcome<()> {
        let kept = if local {
            self.state.levels.last_mut()
        } else {
            Some(&mut self.state.common)
        };
        let Some(kept) = kept else { return Ok(()) };
        keep(kept, name, value, &self.cursor, start)
    }
}
