//! Commands that change accelerations and jerk: `DynOvr=0.4`, `#set paramPathDynamics( … )#`.

use super::dynamics::PATH_AXES;
use crate::control::Control;
use crate::expression::Fault;
use crate::own_state::OwnState;
use gwatt_machine::AxisKind;
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// A block that is more than plain words.
    pub(super) fn nci_command(&mut self, text: &[u8], block: &mut Block) -> Result<(), Fault> {
        let start = front(text);
        let rest = text.get(start..).unwrap_or_default();
        let whole = Span::new(start, start + rest.trim_ascii_end().len());
        if let Some(value) = after(rest, b"DynOvr") {
            self.dynamic_override(value, whole)?;
        } else if let Some(values) = after(rest, b"#set") {
            self.dynamics(values.trim_ascii_start(), whole)?;
        } else if after(rest, b"#MSG").is_none() {
            let shown = gwatt_syntax::diagnostic::excerpt(rest.trim_ascii_end(), 40);
            let message =
                format!("`{shown}` is more than plain words, which gwatt does not follow");
            let help =
                "R parameters, jumps, loops, subprograms and auxiliary axes of NC I are not read";
            return Err(Fault::new("unsupported-word", message, help, whole));
        }
        block.words.clear();
        block.issues.clear();
        self.begun = true;
        Ok(())
    }

    /// "Dynamic Override": accelerations and jerk of all axes from the next block on, without
    /// a stop; the block before still brakes with the values that it had.
    fn dynamic_override(&mut self, value: &[u8], span: Span) -> Result<(), Fault> {
        let number = value.trim_ascii_start().strip_prefix(b"=");
        let number = number.map(|number| without_comment(number).trim_ascii());
        let share = number.and_then(parse);
        let Some(share) = share.filter(|share| *share > 0.0 && *share <= 1.0) else {
            let message = "DynOvr is a number from above 0 to 1, alone in its block";
            let help = "write DynOvr=0.5; R parameters are not followed";
            return Err(Fault::new("knob-value", message, help, span));
        };
        if let OwnState::Nci(nci) = &mut self.own {
            nci.dynamics.turn(share);
        }
        Ok(())
    }

    /// "Altering the Motion Dynamics": `paramPathDynamics( acc; dec; jerk )#` and the older
    /// `paramGroupDynamics( 1, acc, dec, jerk )#` for X, Y and Z, `paramAxisDynamics( axis; acc;
    /// dec; jerk )#` for one, in mm/s² and mm/s³. What is above the machine's own values is
    /// refused.
    fn dynamics(&mut self, text: &[u8], span: Span) -> Result<(), Fault> {
        let help = "write #set paramPathDynamics( acc; dec; jerk )# or #set paramAxisDynamics( axis; \
                    acc; dec; jerk )#, with numbers";
        let fault = |message: &str| Err(Fault::new("knob-value", message, help, span));
        let named = |name: &[u8]| after(text, name).map(numbers);
        let all = 0..PATH_AXES;
        let (axes, limits) = if let Some(values) = named(b"paramPathDynamics") {
            (all, values)
        } else if let Some(values) = named(b"paramAxisDynamics") {
            let number = values.as_ref().and_then(|values| values.first());
            let Some(axis) = number.map_or(Some(0), |number| axis_number(*number)) else {
                return fault("the number of an axis is a whole number from 0 to 7");
            };
            (axis..axis + 1, values.map(without_first))
        } else if let Some(values) = named(b"paramGroupDynamics") {
            if values.as_ref().is_some_and(|it| it.first() != Some(&1.0)) {
                return fault("the group of NC I's path axes is 1");
            }
            (all, values.map(without_first))
        } else {
            return fault("a parameter of the control that gwatt does not follow");
        };
        let Some(limits) = limits else {
            return fault("the values of this command are not plain numbers");
        };
        let [accel, brake, jerk] = limits[..] else {
            return fault("this command has another number of values");
        };
        // Auxiliary axes, from 3 on, are not those of the machine file.
        for axis in axes.filter(|axis| *axis < PATH_AXES) {
            let Some(data) = self.machine.axes[axis] else {
                continue;
            };
            let higher = accel.max(brake) > data.accel_mm_s2
                || data.jerk_mm_s3 > 0.0 && jerk > data.jerk_mm_s3;
            if higher || data.kind == AxisKind::Rotary {
                let help = "give the machine file the higher values, or take the command out";
                let message = "accelerations or a jerk above those of the machine file";
                return Err(Fault::new("knob-value", message, help, span));
            }
            if limits.iter().any(|limit| *limit <= 0.0) {
                return fault("a limit of motion that is not above 0");
            }
            if let OwnState::Nci(nci) = &mut self.own {
                // One acceleration is planned with: the higher counts.
                nci.dynamics.set(axis, &data, accel.max(brake), jerk);
            }
        }
        Ok(())
    }
}

/// Where a block begins after block delete and its number.
fn front(text: &[u8]) -> usize {
    let blanks = |at: usize| {
        let rest = text.get(at..).unwrap_or_default();
        at + rest.len() - rest.trim_ascii_start().len()
    };
    let digits = |at: usize| {
        let rest = text.get(at..).unwrap_or_default();
        at + rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    let mut at = blanks(0);
    for _ in 0..2 {
        match text.get(at) {
            Some(b'/') => at = blanks(digits(at + 1)),
            Some(b'N' | b'n') if text.get(at + 1).is_some_and(u8::is_ascii_digit) => {
                at = blanks(digits(at + 1));
            }
            _ => {}
        }
    }
    at
}

/// What comes after a name, in whatever case.
fn after<'t>(text: &'t [u8], name: &[u8]) -> Option<&'t [u8]> {
    let (front, rest) = text.split_at_checked(name.len())?;
    let ends = !rest.first().is_some_and(u8::is_ascii_alphanumeric);
    (front.eq_ignore_ascii_case(name) && ends).then_some(rest)
}

/// A value without the comment after it.
fn without_comment(text: &[u8]) -> &[u8] {
    let comment = text.iter().position(|byte| *byte == b'(');
    text.get(..comment.unwrap_or(text.len())).unwrap_or(text)
}

fn parse(text: &[u8]) -> Option<f64> {
    let plain = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'+' | b'-');
    let text = std::str::from_utf8(text).ok()?;
    let value = text.parse::<f64>().ok()?;
    (text.bytes().all(|byte| plain(&byte)) && value.is_finite()).then_some(value)
}

/// The values of `( a; b; c )#`.
fn numbers(text: &[u8]) -> Option<Vec<f64>> {
    let text = text.trim_ascii().strip_prefix(b"(")?;
    let close = text.iter().position(|byte| *byte == b')')?;
    let (inside, rest) = text.split_at_checked(close)?;
    let rest = rest.get(1..)?.trim_ascii_start().strip_prefix(b"#")?;
    if !without_comment(rest).trim_ascii().is_empty() {
        return None;
    }
    let values = inside.split(|byte| matches!(byte, b';' | b','));
    values.map(|value| parse(value.trim_ascii())).collect()
}

/// X is 0, Q5 is 7.
fn axis_number(number: f64) -> Option<usize> {
    (0..8_u8)
        .find(|axis| f64::from(*axis) == number)
        .map(usize::from)
}

fn without_first(mut values: Vec<f64>) -> Vec<f64> {
    if !values.is_empty() {
        values.remove(0);
    }
    values
}
