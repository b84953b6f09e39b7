//! A quantity that a file may give in one of several forms: at the load or at
//! the motor, directly or by a time.

use std::ops::Range;

use super::findings::Findings;
use super::value::{At, Num};

/// A quantity on the load side, and where it was given.
pub(crate) struct Given {
    pub(crate) key: &'static str,
    pub(crate) value: f64,
    pub(crate) span: Range<usize>,
}

/// From the written number to the load side.
#[derive(Clone, Copy)]
enum Conversion {
    Times(f64),
    Under(f64),
    /// Only with a screw's lead, which is not given.
    NeedsLead,
}

/// A form of a quantity: its key, and its number if given.
pub(crate) struct Form {
    key: &'static str,
    number: Option<At<f64>>,
    conversion: Conversion,
}

/// A form whose number times `factor` is the load-side value; no factor:
/// the form needs a lead.
pub(crate) fn form<B>(
    key: &'static str,
    number: Option<&Num<B>>,
    factor: impl Into<Option<f64>>,
) -> Form {
    Form {
        key,
        number: number.map(Num::at),
        conversion: factor
            .into()
            .map_or(Conversion::NeedsLead, Conversion::Times),
    }
}

/// What to write for a quantity that is missing.
fn how(keys: &[&str]) -> String {
    if keys.contains(&"moved_mass_kg") {
        return "give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it \
                as `mass_kg` at the load or `inertia_kg_m2` at the motor"
            .to_owned();
    }
    if keys.contains(&"moved_inertia_kg_m2") {
        return "give `moved_inertia_kg_m2` with `rotor_kg_m2` and `gear_ratio`, or all of it as \
                `inertia_kg_m2`"
            .to_owned();
    }
    let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    format!("give {}", keys.join(" or "))
}

/// Reads the quantities of one axis.
pub(crate) struct Quantities {
    letter: char,
    header: Range<usize>,
}

impl Quantities {
    /// For the axis with this letter, whose table begins at `header`.
    pub(crate) fn new(letter: char, header: Range<usize>) -> Self {
        Self { letter, header }
    }

    /// A quantity that must be given, in one form.
    pub(crate) fn required<const N: usize>(
        &self,
        findings: &mut Findings<'_>,
        what: &str,
        forms: [Form; N],
    ) -> Option<Given> {
        let keys = forms.each_ref().map(|form| form.key);
        let Some(given) = self.one(findings, forms).ok()? else {
            self.missing(findings, what, &keys);
            return None;
        };
        // A number that is not positive as it is written is reported already.
        (given.value > 0.0).then_some(given)
    }

    /// A quantity that is 0 if it is not given.
    pub(crate) fn optional<const N: usize>(
        &self,
        findings: &mut Findings<'_>,
        forms: [Form; N],
    ) -> f64 {
        self.given(findings, forms).unwrap_or(0.0)
    }

    /// A quantity that need not be given.
    pub(crate) fn given<const N: usize>(
        &self,
        findings: &mut Findings<'_>,
        forms: [Form; N],
    ) -> Option<f64> {
        let given = self.one(findings, forms).ok()??;
        Some(given.value)
    }

    /// Acceleration as given, or the rapid speed by the time to reach it.
    pub(crate) fn acceleration<B>(
        &self,
        findings: &mut Findings<'_>,
        direct: Form,
        time: Option<&Num<B>>,
        rapid: Option<&Given>,
    ) -> Option<Given> {
        // Without a speed, which is reported already, any will do.
        let speed = rapid.map_or(1.0, |rapid| rapid.value);
        let by_time = Form {
            key: "accel_time_s",
            number: time.map(Num::at),
            conversion: Conversion::Under(speed),
        };
        self.required(findings, "an acceleration", [direct, by_time])
    }

    /// Reports that a key makes no sense without a lead.
    pub(crate) fn needs_lead(&self, findings: &mut Findings<'_>, key: &str, span: &Range<usize>) {
        let letter = self.letter;
        if !findings.is_refused(&format!("axes.{letter}.lead_mm")) {
            let message = format!("`{key}` is at the motor, but axis {letter} has no `lead_mm`");
            let help = Some("give the screw's `lead_mm`, or the quantity at the load".to_owned());
            findings.error("machine-missing", span, message, help);
        }
    }

    fn missing(&self, findings: &mut Findings<'_>, what: &str, keys: &[&str]) {
        let letter = self.letter;
        let refused = |key: &&str| findings.is_refused(&format!("axes.{letter}.{key}"));
        if !keys.iter().any(refused) {
            let help = Some(how(keys));
            let message = format!("axis {letter} needs {what}");
            findings.error("machine-missing", &self.header, message, help);
        }
    }

    /// The one form that is given; an error if there are two.
    fn one<const N: usize>(
        &self,
        findings: &mut Findings<'_>,
        forms: [Form; N],
    ) -> Result<Option<Given>, ()> {
        let mut found: Option<Given> = None;
        for form in forms {
            let Some(number) = form.number else { continue };
            if let Some(first) = &found {
                let message = format!(
                    "`{}` and `{}` give the same quantity of axis {}",
                    first.key, form.key, self.letter
                );
                let help = Some("keep one of the two".to_owned());
                findings.error("machine-twice", &number.span, message, help);
                return Err(());
            }
            let value = match form.conversion {
                Conversion::Times(factor) => number.value * factor,
                Conversion::Under(dividend) => dividend / number.value,
                Conversion::NeedsLead => {
                    self.needs_lead(findings, form.key, &number.span);
                    return Err(());
                }
            };
            found = Some(Given {
                key: form.key,
                value,
                span: number.span,
            });
        }
        Ok(found)
    }
}
