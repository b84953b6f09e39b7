//! An axis table to a load-side axis: the motor's data are converted here,
//! once.
//!
//! Screw with lead `h` (m) and `i` motor revolutions per screw revolution:
//! one metre of travel turns the motor by `k = 2π·i/h` radians, so
//! `mass = J·k²`, `force = T·k`, `viscous = d·k²`, and a loss `r·T²` is
//! `r/k²·F²`. A rotary table after a gear is the same with `k = i`.

use std::f64::consts::TAU;
use std::ops::Range;

use super::findings::Findings;
use super::machine_file::AxisTable;
use super::parts;
use super::plausible;
use super::quantity::{Given, Quantities, form};
use super::servo;
use super::value::{At, Num, Number, Part};
use crate::axis::{Axis, AxisId, AxisKind, FURTHER_REFERENCES};
use crate::units::{M_PER_MM, RAD_PER_DEG, SECONDS_PER_MINUTE};

/// Errors of all axes that give none of their own.
#[derive(Clone, Copy, Default)]
pub(crate) struct Errors<'t> {
    pub(crate) mass: Option<&'t Part>,
    pub(crate) friction: Option<&'t Part>,
}

/// Makes an axis of its table; `None` if something is missing or given twice.
pub(crate) fn axis(
    findings: &mut Findings<'_>,
    id: AxisId,
    table: &At<AxisTable>,
    errors: Errors<'_>,
) -> Option<Axis> {
    let kind = kind(id, &table.value);
    let builder = Builder {
        letter: id.letter() as char,
        quantities: Quantities::new(id.letter() as char, table.span.clone()),
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
        servo: servo::take(findings, id, &table.value),
        friction_min_ratio: value(table.value.friction_min_ratio.as_ref(), 1.0),
        mass_error: value(table.value.mass_error.as_ref().or(errors.mass), 0.0),
        friction_error: value(table.value.friction_error.as_ref().or(errors.friction), 0.0),
        ..axis
    })
}

/// The kind as given, else by the letter.
pub(super) fn kind(id: AxisId, table: &AxisTable) -> AxisKind {
    match table.kind.as_ref().map(|kind| kind.value) {
        Some(kind) => kind,
        None if matches!(id, AxisId::A | AxisId::B | AxisId::C) => AxisKind::Rotary,
        None => AxisKind::Linear,
    }
}

fn value<B>(number: Option<&Num<B>>, default: f64) -> f64 {
    number.map_or(default, |number| number.value)
}

/// The axis that is being made.
struct Builder {
    letter: char,
    quantities: Quantities,
    kind: AxisKind,
}

impl Builder {
    fn linear(&self, findings: &mut Findings<'_>, table: &AxisTable) -> Option<Axis> {
        let lead_mm = parts::lead_mm(table);
        let gear = value(table.gear_ratio.as_ref(), 1.0);
        if lead_mm.is_none()
            && let Some(gear) = &table.gear_ratio
        {
            self.quantities
                .needs_lead(findings, "gear_ratio", &gear.span);
        }
        let rad_per_m = lead_mm.map(|lead| TAU * gear / (lead * M_PER_MM));
        let squared = rad_per_m.map(|k| k * k);
        let mm_s_per_rpm = lead_mm.map(|lead| lead / SECONDS_PER_MINUTE / gear);
        let rapid = self.quantities.required(
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
        let accel = self.quantities.acceleration(
            findings,
            form("accel_mm_s2", table.accel_mm_s2.as_ref(), 1.0),
            table.accel_time_s.as_ref(),
            rapid.as_ref(),
        );
        let mass = self.quantities.required(
            findings,
            "a mass or an inertia",
            [
                form("mass_kg", table.mass_kg.as_ref(), 1.0),
                form("inertia_kg_m2", table.inertia_kg_m2.as_ref(), squared),
                form("moved_mass_kg", table.moved_mass_kg.as_ref(), 1.0),
            ],
        );
        let mass = self.with_parts(findings, table, mass);
        let [coulomb_n, viscous_n_s_m, gravity_n, copper_w_n2] =
            self.resistances(findings, table, rad_per_m);
        let (reference_mm_s, reference_mm) = self.reference(findings, table);
        warn_unused_lead(findings, table);
        let (rapid, accel, mass) = (rapid?, accel?, mass?);
        plausible::linear(findings, table, &accel, &mass);
        Some(Axis {
            rapid_mm_s: rapid.value,
            max_feed_mm_s: value(table.max_feed_mm_min.as_ref(), f64::INFINITY)
                / SECONDS_PER_MINUTE,
            reference_mm_s: reference_mm_s.unwrap_or(f64::INFINITY),
            reference_mm,
            further_reference_mm: self.further(findings, table.further_reference_mm.as_ref()),
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

    /// Coulomb and viscous friction, weight, and what the motor's copper takes; `rad_per_m`: what
    /// the motor turns by.
    fn resistances(
        &self,
        findings: &mut Findings<'_>,
        table: &AxisTable,
        rad_per_m: Option<f64>,
    ) -> [f64; 4] {
        let squared = rad_per_m.map(|k| k * k);
        let coulomb_n = self.quantities.optional(
            findings,
            [
                form("coulomb_n", table.coulomb_n.as_ref(), 1.0),
                form("friction_nm", table.friction_nm.as_ref(), rad_per_m),
            ],
        );
        let viscous_n_s_m = self.quantities.optional(
            findings,
            [
                form("viscous_n_s_m", table.viscous_n_s_m.as_ref(), 1.0),
                form("viscous_nm_s_rad", table.viscous_nm_s_rad.as_ref(), squared),
            ],
        );
        let gravity_n = self.quantities.optional(
            findings,
            [
                form("gravity_n", table.gravity_n.as_ref(), 1.0),
                form("gravity_nm", table.gravity_nm.as_ref(), rad_per_m),
            ],
        );
        let copper_w_n2 = self.quantities.optional(
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
        [coulomb_n, viscous_n_s_m, gravity_n, copper_w_n2]
    }

    /// The mass with that of the parts that turn.
    fn with_parts(
        &self,
        findings: &mut Findings<'_>,
        table: &AxisTable,
        given: Option<Given>,
    ) -> Option<Given> {
        parts::check(findings, self.letter, self.kind, table);
        if let Some(rotor) = table.rotor_kg_m2.as_ref().filter(|rotor| rotor.value > 0.0)
            && self.kind == AxisKind::Linear
            && parts::lead_mm(table).is_none()
            && table.screw.is_none()
        {
            self.quantities
                .needs_lead(findings, "rotor_kg_m2", &rotor.span);
        }
        let turning = parts::list(self.kind, table);
        let turning: f64 = turning.iter().map(|part| part.mass_kg).sum();
        let mut given = given?;
        given.value += turning;
        Some(given)
    }

    /// Speed on the way to the reference point, mm/s, and its place, mm.
    fn reference(
        &self,
        findings: &mut Findings<'_>,
        table: &AxisTable,
    ) -> (Option<f64>, Option<f64>) {
        let reference_mm_s = self.quantities.given(
            findings,
            [
                form(
                    "reference_mm_min",
                    table.reference_mm_min.as_ref(),
                    1.0 / SECONDS_PER_MINUTE,
                ),
                form(
                    "home_mm_min",
                    table.home_mm_min.as_ref(),
                    1.0 / SECONDS_PER_MINUTE,
                ),
            ],
        );
        let reference_mm = self.quantities.given(
            findings,
            [
                form("reference_mm", table.reference_mm.as_ref(), 1.0),
                form("home_mm", table.home_mm.as_ref(), 1.0),
            ],
        );
        (reference_mm_s, reference_mm)
    }

    /// The places of further reference points, in order.
    fn further(
        &self,
        findings: &mut Findings<'_>,
        given: Option<&At<Vec<Number>>>,
    ) -> [Option<f64>; FURTHER_REFERENCES] {
        let mut places = [None; FURTHER_REFERENCES];
        let Some(given) = given else { return places };
        if given.value.len() > places.len() {
            let message = format!(
                "axis {} has {FURTHER_REFERENCES} further reference points at most",
                self.letter
            );
            findings.error("machine-range", &given.span, message, None);
        }
        for (place, number) in places.iter_mut().zip(&given.value) {
            *place = Some(number.value);
        }
        places
    }

    fn rotary(&self, findings: &mut Findings<'_>, table: &AxisTable) -> Option<Axis> {
        let gear = value(table.gear_ratio.as_ref(), 1.0);
        let squared = gear * gear;
        let rapid = self.quantities.required(
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
        let accel = self.quantities.acceleration(
            findings,
            form("accel_deg_s2", table.accel_deg_s2.as_ref(), 1.0),
            table.accel_time_s.as_ref(),
            rapid.as_ref(),
        );
        let inertia = self.quantities.required(
            findings,
            "an inertia",
            [
                form("inertia_kg_m2", table.inertia_kg_m2.as_ref(), squared),
                form(
                    "moved_inertia_kg_m2",
                    table.moved_inertia_kg_m2.as_ref(),
                    1.0,
                ),
            ],
        );
        let inertia = self.with_parts(findings, table, inertia);
        let coulomb_n = self.quantities.optional(
            findings,
            [form("friction_nm", table.friction_nm.as_ref(), gear)],
        );
        let viscous_n_s_m = self.quantities.optional(
            findings,
            [form(
                "viscous_nm_s_rad",
                table.viscous_nm_s_rad.as_ref(),
                squared,
            )],
        );
        let gravity_n = self.quantities.optional(
            findings,
            [form("gravity_nm", table.gravity_nm.as_ref(), gear)],
        );
        let copper_w_n2 = self.quantities.optional(
            findings,
            [
                form("copper_w_nm2", table.copper_w_nm2.as_ref(), squared.recip()),
                form("copper_w_n2", table.copper_w_n2.as_ref(), squared.recip()),
            ],
        );
        let (rapid, accel, inertia) = (rapid?, accel?, inertia?);
        plausible::rotary(findings, table, &accel, &inertia);
        Some(Axis {
            rapid_mm_s: rapid.value,
            max_feed_mm_s: value(table.max_feed_deg_min.as_ref(), f64::INFINITY)
                / SECONDS_PER_MINUTE,
            accel_mm_s2: accel.value,
            jerk_mm_s3: value(table.jerk_deg_s3.as_ref(), 0.0),
            reference_mm_s: value(table.reference_deg_min.as_ref(), f64::INFINITY)
                / SECONDS_PER_MINUTE,
            reference_mm: table.reference_deg.as_ref().map(|number| number.value),
            further_reference_mm: self.further(findings, table.further_reference_deg.as_ref()),
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
            max_feed_mm_s: f64::INFINITY,
            reference_mm_s: f64::INFINITY,
            reference_mm: None,
            further_reference_mm: [None; FURTHER_REFERENCES],
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
            servo: None,
            friction_min_ratio: 1.0,
            mass_error: 0.0,
            friction_error: 0.0,
            si_per_unit: 1.0,
        }
    }

    /// Reports fields of the other kind.
    fn only_fields_of_kind(&self, findings: &mut Findings<'_>, table: &AxisTable) {
        let (others, this, other) = match self.kind {
            AxisKind::Linear => (of_rotary_axes(table), "linear", "rotary"),
            AxisKind::Rotary => (of_linear_axes(table), "rotary", "linear"),
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

/// A field of the other kind of axis: its name, where it stands, and what to give instead.
type Foreign = (&'static str, Option<Range<usize>>, &'static str);

fn span<B>(number: Option<&Num<B>>) -> Option<Range<usize>> {
    number.map(|number| number.span.clone())
}

fn place<T>(table: Option<&At<T>>) -> Option<Range<usize>> {
    table.map(|table| table.span.clone())
}

/// What only rotary axes have.
fn of_rotary_axes(t: &AxisTable) -> Vec<Foreign> {
    let [rapid, accel, jerk] = [
        span(t.rapid_deg_min.as_ref()),
        span(t.accel_deg_s2.as_ref()),
        span(t.jerk_deg_s3.as_ref()),
    ];
    let [reference_speed, reference, inertia] = [
        span(t.reference_deg_min.as_ref()),
        span(t.reference_deg.as_ref()),
        span(t.moved_inertia_kg_m2.as_ref()),
    ];
    vec![
        ("rapid_deg_min", rapid, "rapid_mm_min"),
        ("accel_deg_s2", accel, "accel_mm_s2"),
        ("jerk_deg_s3", jerk, "jerk_mm_s3"),
        ("reference_deg_min", reference_speed, "reference_mm_min"),
        ("reference_deg", reference, "reference_mm"),
        (
            "further_reference_deg",
            place(t.further_reference_deg.as_ref()),
            "further_reference_mm",
        ),
        (
            "max_feed_deg_min",
            span(t.max_feed_deg_min.as_ref()),
            "max_feed_mm_min",
        ),
        ("moved_inertia_kg_m2", inertia, "moved_mass_kg"),
    ]
}

/// What only linear axes have.
fn of_linear_axes(t: &AxisTable) -> Vec<Foreign> {
    let [rapid, reference_speed, home_speed] = [
        span(t.rapid_mm_min.as_ref()),
        span(t.reference_mm_min.as_ref()),
        span(t.home_mm_min.as_ref()),
    ];
    let reference = span(t.reference_mm.as_ref());
    let viscous = span(t.viscous_n_s_m.as_ref());
    let moved = span(t.moved_mass_kg.as_ref());
    vec![
        ("rapid_mm_min", rapid, "rapid_deg_min"),
        ("reference_mm_min", reference_speed, "reference_deg_min"),
        ("reference_mm", reference, "reference_deg"),
        (
            "further_reference_mm",
            place(t.further_reference_mm.as_ref()),
            "further_reference_deg",
        ),
        (
            "max_feed_mm_min",
            span(t.max_feed_mm_min.as_ref()),
            "max_feed_deg_min",
        ),
        ("home_mm_min", home_speed, "reference_deg_min"),
        ("home_mm", span(t.home_mm.as_ref()), "reference_deg"),
        ("accel_mm_s2", span(t.accel_mm_s2.as_ref()), "accel_deg_s2"),
        ("jerk_mm_s3", span(t.jerk_mm_s3.as_ref()), "jerk_deg_s3"),
        ("mass_kg", span(t.mass_kg.as_ref()), "inertia_kg_m2"),
        ("coulomb_n", span(t.coulomb_n.as_ref()), "friction_nm"),
        ("viscous_n_s_m", viscous, "viscous_nm_s_rad"),
        ("gravity_n", span(t.gravity_n.as_ref()), "gravity_nm"),
        ("lead_mm", span(t.lead_mm.as_ref()), "gear_ratio"),
        ("moved_mass_kg", moved, "moved_inertia_kg_m2"),
        ("screw", place(t.screw.as_ref()), "gear_ratio"),
        ("pulley", place(t.pulley.as_ref()), "gear_ratio"),
        ("pinion", place(t.pinion.as_ref()), "gear_ratio"),
    ]
}

/// A lead matters only if something is given at the motor.
fn warn_unused_lead(findings: &mut Findings<'_>, table: &AxisTable) {
    let at_motor = table.max_speed_rpm.is_some()
        || table.inertia_kg_m2.is_some()
        || table.friction_nm.is_some()
        || table.viscous_nm_s_rad.is_some()
        || table.gravity_nm.is_some()
        || table.copper_w_nm2.is_some()
        || table.rotor_kg_m2.is_some()
        || table.screw.is_some()
        || table.torque_curve.is_some();
    if let Some(lead) = table.lead_mm.as_ref().filter(|_| !at_motor) {
        let message = "`lead_mm` has no effect: nothing is given at the motor";
        findings.warning("machine-unit", &lead.span, message, None);
    }
}
