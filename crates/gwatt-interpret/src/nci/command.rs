//! Commands that change accelerations: `DynOvr=0.4`, `#set paramPathDynamics( … )#`.

use crate::execute::Control;
use crate::expression::Fault;
use crate::report::Report;
use gwatt_machine::AxisKind;
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

const NOT_LOWERED: &str =
    "#set param…Dynamics below the machine's own accelerations is counted as not there";

const JERK: &str = "DynOvr lowers the jerk too: counted as not lowered";

impl Control<'_> {
    /// A block that is more than plain words.
    pub(super) fn nci_command(
        &mut self,
        text: &[u8],
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> Result<(), Fault> {
        let start = front(text);
        let rest = text.get(start..).unwrap_or_default();
        let whole = Span::new(start, start + rest.trim_ascii_end().len());
        if let Some(value) = after(rest, b"DynOvr") {
            self.dynamic_override(value, whole, report)?;
        } else if let Some(values) = after(rest, b"#set") {
            self.dynamics(values.trim_ascii_start(), whole, report)?;
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

    /// "Dynamic Override": the accelerations of all axes from the next block on, without a
    /// stop; the block before still brakes with the values that it had.
    fn dynamic_override(
        &mut self,
        value: &[u8],
        span: Span,
        report: &mut Report<'_, '_>,
    ) -> Result<(), Fault> {
        let number = value.trim_ascii_start().strip_prefix(b"=");
        let number = number.map(|number| without_comment(number).trim_ascii());
        let share = number.and_then(parse);
        let Some(share) = share.filter(|share| *share > 0.0 && *share <= 1.0) else {
            let message = "DynOvr is a number from above 0 to 1, alone in its block";
            let help = "write DynOvr=0.5; R parameters are not followed";
            return Err(Fault::new("knob-value", message, help, span));
        };
        if share < 1.0 && self.has_jerk() {
            report.note_once("limit-not-lowered", JERK, span);
        }
        if let Some(nci) = &mut self.nci {
            nci.turned = Some(share);
        }
        Ok(())
    }

    /// "Altering the Motion Dynamics": `paramPathDynamics( acc; dec; jerk )#` for X, Y and Z,
    /// `paramAxisDynamics( axis; acc; dec; jerk )#` for one, in mm/s² and mm/s³. What is
    /// above the machine's own values is refused, what is below counts as not there.
    fn dynamics(&self, text: &[u8], span: Span, report: &mut Report<'_, '_>) -> Result<(), Fault> {
        let help = "write #set paramPathDynamics( acc; dec; jerk )# or #set paramAxisDynamics( axis; \
                    acc; dec; jerk )#, with numbers";
        let fault = |message: &str| Err(Fault::new("knob-value", message, help, span));
        let of_axis = after(text, b"paramAxisDynamics");
        let Some(values) = of_axis.or_else(|| after(text, b"paramPathDynamics")) else {
            return fault("a parameter of the control that gwatt does not follow");
        };
        let Some(values) = numbers(values) else {
            return fault("the values of this command are not plain numbers");
        };
        let (axes, limits) = match values.as_slice() {
            [axis, limits @ ..] if of_axis.is_some() => {
                (*axis as usize..*axis as usize + 1, limits)
            }
            limits => (0..3, limits),
        };
        let [accel, brake, jerk] = limits else {
            return fault("this command has another number of values");
        };
        // Auxiliary axes, from 3 on, are not those of the machine file.
        for data in axes
            .filter(|axis| *axis < 3)
            .filter_map(|axis| self.machine.axes[axis])
        {
            let higher = accel.max(*brake) > data.accel_mm_s2
                || data.jerk_mm_s3 > 0.0 && *jerk > data.jerk_mm_s3;
            if higher || data.kind == AxisKind::Rotary {
                let help = "give the machine file the higher values, or take the command out";
                let message = "accelerations or a jerk above those of the machine file";
                return Err(Fault::new("knob-value", message, help, span));
            }
        }
        if limits.iter().any(|limit| *limit <= 0.0) {
            return fault("a limit of motion that is not above 0");
        }
        report.note_once("limit-not-lowered", NOT_LOWERED, span);
        Ok(())
    }

    fn has_jerk(&self) -> bool {
        let mut axes = self.machine.axes.iter().flatten();
        axes.any(|axis| axis.jerk_mm_s3 > 0.0)
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
    let values = inside.split(|byte| *byte == b';');
    values.map(|value| parse(value.trim_ascii())).collect()
}
