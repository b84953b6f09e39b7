//! An axis table to a load-side axis: the motor's data are converted here,
//! once.
//!
//! Screw with lead `h` (m) and `i` motor revolutions per screw revolution:
//! one metre of travel turns the motor by `k = 2π·i/h` radians, so
//! `mass = J·k²`, `force = T·k`, `viscous = d·k²`, and a loss `r·T²` is
//! `r/k²·F²`. A rotary table behind a gear is the same with `k = i`.

use std::f64::consts::TAU;
use std::ops::Range;

use super::findings::Findings;
use super::machine_file::{AxisTable, KindName};
use super::plausible;
use super::value::{At, Num};
use crate::machine::axis::{Axis, AxisId, AxisKind};
use crate::units::{M_PER_MM, RAD_PER_DEG, SECONDS_PER_MINUTE};

/// Makes an axis of its table; `None` if something is missing or given twice.
pub(crate) fn axis(findings: &mut Findings<'_>, id: AxisId, table: &At<AxisTable>) -> Option<Axis> {
    let kind = kind(id, &table.value);
    let builder = Builder {
        letter: id.letter() as char,
        header: table.span.clone(),
        kind,
    };
    builder.only_fields_of_kind(findings, &table.value);
    let axis = match kind {
        AxisKind::Linear => builder.linear(findings, &table.value),
        AxisKind::Rotary => builder.rotary(findings, &table.value),
    }?;
    Some(Axis {
        efficiency: value(table.value.efficiency.as_ref(), 1.0),
        servo_factor_motor: value(table.value.servo_factor_motor.as_ref(), 1.0),
        servo_factor_regen: value(table.value.servo_factor_regen.as_ref(), 1.0),
        friction_min_ratio: value(table.value.friction_min_ratio.as_ref(), 1.0),
        ..axis
    })
}

/// The kind as given, else by the letter.
fn kind(id: AxisId, table: &AxisTable) -> AxisKind {
    match table.kind.as_ref().map(|kind| kind.value) {
        Some(KindName::Rotary) => AxisKind::Rotary,
        None if matches!(id, AxisId::A | AxisId::B | AxisId::C) => AxisKind::Rotary,
        Some(KindName::Linear) | None => AxisKind::Linear,
    }
}

fn value<B>(number: Option<&Num<B>>, default: f64) -> f64 {
    number.map_or(default, |number| number.value)
}

/// A quantity in the form in which it was given.
struct Given {
    key: &'static str,
    value: f64,
    span: Range<usize>,
}

/// A form of a quantity: its key, its value if given, and the factor to the
/// load side; without a factor this form needs a lead.
struct Form {
    key: &'static str,
    number: Option<At<f64>>,
    factor: Option<f64>,
}

fn form<B>(key: &'static str, number: Option<&Num<B>>, factor: impl Into<Option<f64>>) -> Form {
    Form {
        key,
        number: number.map(Num::at),
        factor: factor.into(),
    }
}

struct Builder {
    letter: char,
    header: Range<usize>,
    kind: AxisKind,
}

impl Builder {
    fn linear(&self, findings: &mut Findings<'_>, table: &AxisTable) -> Option<Axis> {
        let lead_mm = table.lead_mm.as_ref().map(|lead| lead.value);
        let gear = value(table.gear_ratio.as_ref(), 1.0);
        if lead_mm.is_none()
            && let Some(gear) = &table.gear_ratio
        {
            self.needs_lead(findings, "gear_ratio", &gear.span);
        }
        let rad_per_m = lead_mm.map(|lead| TAU * gear / (lead * M_PER_MM));
        let squared = rad_per_m.map(|k| k * k);
        let mm_s_per_rpm = lead_mm.map(|lead| lead / SECONDS_PER_MINUTE / gear);
        let rapid = self.required(
            findings,
            "a rapid speed",
            [
                form(
                    "rapid_mm_min",
                    table.rapid_mm_min.as_ref(),
                    1.0 / SECONDS_PER_MINUTE,
                ),
                form("max_speed_rpm", table.max_speed_rpm.as_ref(), mm_s_per_rpm),
            ],
        );
        let accel = self.acceleration(
            findings,
            form("accel_mm_s2", table.accel_mm_s2.as_ref(), 1.0),
            table,
            rapid.as_ref(),
        );
        let mass = self.required(
            findings,
            "a mass or an inertia",
            [
                form("mass_kg", table.mass_kg.as_ref(), 1.0),
                form("inertia_kg_m2", table.inertia_kg_m2.as_ref(), squared),
            ],
        );
        let coulomb_n = self.optional(
            findings,
            [
                form("coulomb_n", table.coulomb_n.as_ref(), 1.0),
                form("friction_nm", table.friction_nm.as_ref(), rad_per_m),
            ],
        );
        let viscous_n_s_m = self.optional(
            findings,
            [
                form("viscous_n_s_m", table.viscous_n_s_m.as_ref(), 1.0),
                form("viscous_nm_s_rad", table.viscous_nm_s_rad.as_ref(), squared),
            ],
        );
        let gravity_n = self.optional(
            findings,
            [
                form("gravity_n", table.gravity_n.as_ref(), 1.0),
                form("gravity_nm", table.gravity_nm.as_ref(), rad_per_m),
            ],
        );
        let copper_w_n2 = self.optional(
            findings,
            [
                form("copper_w_n2", table.copper_w_n2.as_ref(), 1.0),
                form(
                    "copper_w_nm2",
                    table.copper_w_nm2.as_ref(),
                    squared.map(f64::recip),
                ),
            ],
        );
        let (rapid, accel, mass) = (rapid?, accel?, mass?);
        plausible::linear(findings, table, accel.as_ref(), mass.as_ref());
        Some(Axis {
            rapid_mm_s: rapid.value,
            accel_mm_s2: accel.value,
            jerk_mm_s3: value(table.jerk_mm_s3.as_ref(), 0.0),
            mass_kg: mass.value,
            coulomb_n,
            viscous_n_s_m,
            gravity_n,
            copper_w_n2,
            si_per_unit: M_PER_MM,
            ..self.blank()
        })
    }

    fn rotary(&self, findings: &mut Findings<'_>, table: &AxisTable) -> Option<Axis> {
        let gear = value(table.gear_ratio.as_ref(), 1.0);
        let squared = gear * gear;
        let rapid = self.required(
            findings,
            "a rapid speed",
            [
                form(
                    "rapid_deg_min",
                    table.rapid_deg_min.as_ref(),
                    1.0 / SECONDS_PER_MINUTE,
                ),
                form(
                    "max_speed_rpm",
                    table.max_speed_rpm.as_ref(),
                    360.0 / SECONDS_PER_MINUTE / gear,
                ),
            ],
        );
        let accel = self.acceleration(
            findings,
            form("accel_deg_s2", table.accel_deg_s2.as_ref(), 1.0),
            table,
            rapid.as_ref(),
        );
        let inertia = self.required(
            findings,
            "an inertia",
            [form("inertia_kg_m2", table.inertia_kg_m2.as_ref(), squared)],
        );
        let coulomb_n = self.optional(
            findings,
            [form("friction_nm", table.friction_nm.as_ref(), gear)],
        );
        let viscous_n_s_m = self.optional(
            findings,
            [form(
                "viscous_nm_s_rad",
                table.viscous_nm_s_rad.as_ref(),
                squared,
            )],
        );
        let gravity_n = self.optional(
            findings,
            [form("gravity_nm", table.gravity_nm.as_ref(), gear)],
        );
        let copper_w_n2 = self.optional(
            findings,
            [
                form("copper_w_nm2", table.copper_w_nm2.as_ref(), squared.recip()),
                form("copper_w_n2", table.copper_w_n2.as_ref(), squared.recip()),
            ],
        );
        let (rapid, accel, inertia) = (rapid?, accel?, inertia?);
        plausible::rotary(findings, table, accel.as_ref(), inertia.as_ref());
        Some(Axis {
            rapid_mm_s: rapid.value,
            accel_mm_s2: accel.value,
            jerk_mm_s3: value(table.jerk_deg_s3.as_ref(), 0.0),
            mass_kg: inertia.value,
            coulomb_n,
            viscous_n_s_m,
            gravity_n,
            copper_w_n2,
            si_per_unit: RAD_PER_DEG,
            ..self.blank()
        })
    }

    /// An axis with the defaults.
    fn blank(&self) -> Axis {
        Axis {
            kind: self.kind,
            rapid_mm_s: 0.0,
            accel_mm_s2: 0.0,
            jerk_mm_s3: 0.0,
            mass_kg: 0.0,
            coulomb_n: 0.0,
            viscous_n_s_m: 0.0,
            gravity_n: 0.0,
            efficiency: 1.0,
            copper_w_n2: 0.0,
            servo_factor_motor: 1.0,
            servo_factor_regen: 1.0,
            friction_min_ratio: 1.0,
            si_per_unit: 1.0,
        }
    }

    /// Acceleration as given, or the rapid speed by the time to reach it.
    fn acceleration(
        &self,
        findings: &mut Findings<'_>,
        direct: Form,
        table: &AxisTable,
        rapid: Option<&Given>,
    ) -> Option<Given> {
        let time = table.accel_time_s.as_ref();
        // Without a speed, which is reported already, any factor will do.
        let speed = rapid.map_or(1.0, |rapid| rapid.value);
        let inverse = time.map(|time| At {
            value: time.value.recip(),
            span: time.span.clone(),
        });
        let by_time = Form {
            key: "accel_time_s",
            number: inverse,
            factor: Some(speed),
        };
        self.required(findings, "an acceleration", [direct, by_time])
    }

    /// The load-side value of a quantity that must be given, in one form.
    fn required<const N: usize>(
        &self,
        findings: &mut Findings<'_>,
        what: &str,
        forms: [Form; N],
    ) -> Option<Given> {
        let keys = forms.each_ref().map(|form| form.key);
        let given = self.one(findings, forms);
        if let Ok(None) = &given {
            let letter = self.letter;
            let refused = keys
                .iter()
                .any(|key| findings.is_refused(&format!("axes.{letter}.{key}")));
            if !refused {
                let help = format!("give {}", keys.map(|key| format!("`{key}`")).join(" or "));
                let message = format!("axis {letter} needs {what}");
                findings.error("machine-missing", &self.header, message, Some(help));
            }
        }
        let given = given.ok().flatten()?;
        if given.value.is_finite() && given.value > 0.0 {
            return Some(given);
        }
        // A value that was out of range is reported already.
        if !findings.has_errors() {
            let message = format!("`{}` is too large or too small to compute with", given.key);
            findings.error("machine-range", &given.span, message, None);
        }
        None
    }

    /// The load-side value of a quantity, 0 if it is not given.
    fn optional<const N: usize>(&self, findings: &mut Findings<'_>, forms: [Form; N]) -> f64 {
        let Ok(Some(given)) = self.one(findings, forms) else {
            return 0.0;
        };
        if !given.value.is_finite() {
            let message = format!("`{}` is too large to compute with", given.key);
            findings.error("machine-range", &given.span, message, None);
        }
        given.value
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
            let Some(factor) = form.factor else {
                self.needs_lead(findings, form.key, &number.span);
                return Err(());
            };
            found = Some(Given {
                key: form.key,
                value: number.value * factor,
                span: number.span,
            });
        }
        Ok(found)
    }

    fn needs_lead(&self, findings: &mut Findings<'_>, key: &str, span: &Range<usize>) {
        if findings.is_refused(&format!("axes.{}.lead_mm", self.letter)) {
            return;
        }
        let message = format!(
            "`{key}` is at the motor, but axis {} has no `lead_mm`",
            self.letter
        );
        let help = Some("give the screw's `lead_mm`, or the quantity at the load".to_owned());
        findings.error("machine-missing", span, message, help);
    }

    /// Reports fields of the other kind.
    fn only_fields_of_kind(&self, findings: &mut Findings<'_>, table: &AxisTable) {
        fn span<B>(number: Option<&Num<B>>) -> Option<Range<usize>> {
            number.map(|number| number.span.clone())
        }
        let t = table;
        let (others, this, other) = match self.kind {
            AxisKind::Linear => (
                vec![
                    (
                        "rapid_deg_min",
                        span(t.rapid_deg_min.as_ref()),
                        "rapid_mm_min",
                    ),
                    ("accel_deg_s2", span(t.accel_deg_s2.as_ref()), "accel_mm_s2"),
                    ("jerk_deg_s3", span(t.jerk_deg_s3.as_ref()), "jerk_mm_s3"),
                ],
                "linear",
                "rotary",
            ),
            AxisKind::Rotary => (
                vec![
                    (
                        "rapid_mm_min",
                        span(t.rapid_mm_min.as_ref()),
                        "rapid_deg_min",
                    ),
                    ("accel_mm_s2", span(t.accel_mm_s2.as_ref()), "accel_deg_s2"),
                    ("jerk_mm_s3", span(t.jerk_mm_s3.as_ref()), "jerk_deg_s3"),
                    ("mass_kg", span(t.mass_kg.as_ref()), "inertia_kg_m2"),
                    ("coulomb_n", span(t.coulomb_n.as_ref()), "friction_nm"),
                    (
                        "viscous_n_s_m",
                        span(t.viscous_n_s_m.as_ref()),
                        "viscous_nm_s_rad",
                    ),
                    ("gravity_n", span(t.gravity_n.as_ref()), "gravity_nm"),
                    ("lead_mm", span(t.lead_mm.as_ref()), "gear_ratio"),
                ],
                "rotary",
                "linear",
            ),
        };
        for (key, span, instead) in others {
            let Some(span) = span else { continue };
            let letter = self.letter;
            let message = format!("`{key}` belongs to a {other} axis, but axis {letter} is {this}");
            let help = Some(format!("give `{instead}`, or set kind = \"{other}\""));
            findings.error("machine-kind", &span, message, help);
            // What was meant is there, in the wrong unit.
            findings.refuse(format!("axes.{letter}.{instead}"));
        }
    }
}

impl Given {
    /// Key, value and place, for plausibility checks.
    fn as_ref(&self) -> plausible::Given<'_> {
        plausible::Given {
            key: self.key,
            value: self.value,
            span: &self.span,
        }
    }
}
