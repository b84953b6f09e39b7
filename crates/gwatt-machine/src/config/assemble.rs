//! The file's structs to the validated machine.

use super::findings::Findings;
use super::machine_file::{LimitsTable, MachineFile, PathTable};
use super::value::{At, Num, Number, PerAxis};
use super::{
    axis, converter, drive_curve, kinematics, levels, look_ahead, offsets, outputs, own_language,
    parts, path_accel, plausible, preset, response, servo, spindle, switched_load, tool,
};
use crate::MassPart;
use crate::axis::{AXES, Axis, AxisId, AxisSet};
use crate::controller::Controller;
use crate::model::{ForcePoint, Limits, Load, Machine, Path};
use crate::queue::LaserMode;
use crate::response::Responses;
use crate::units::SECONDS_PER_MINUTE;

/// Share of the peak power that is kept free if the file does not say.
const DEFAULT_MARGIN: f64 = 0.1;

/// Makes a machine; all mistakes go to the findings, and with any of them the
/// result is not to be used.
pub(crate) fn machine(
    findings: &mut Findings<'_>,
    file: &MachineFile,
    mut controller: Controller,
) -> Option<Machine> {
    look_ahead::own(findings, file.look_ahead.as_ref(), &mut controller.planner);
    let mut path = path(file.path.as_ref().map(|table| &table.value), &controller);
    if let Some(table) = &file.language {
        own_language::take(findings, table, &mut controller.language);
    }
    if let Some(table) = file.path.as_ref().map(|table| &table.value) {
        path.accel_mm_s2 = path_accel::take(findings, table, &controller);
        if let Some(time) = &table.shortest_at_feed_s {
            controller.planner.shortest_at_feed_s = time.value;
        }
        if let Some(on) = &table.laser_mode {
            laser_mode(findings, on, &mut controller);
        }
    }
    if let Some(table) = &file.outputs {
        outputs::take(findings, table, &mut controller);
    }
    let errors = errors(file);
    let AxisTables {
        mut axes,
        axis_set,
        force_curves,
        mass_parts,
        responses,
        complete,
    } = AxisTables::of(findings, file, errors);
    let limits = limits(findings, file.limits.as_ref().map(|table| &table.value));
    let converters = file.converter.as_ref().map_or_else(Vec::new, |tables| {
        converter::converters(findings, tables, axis_set, limits.margin)
    });
    servo::factors(findings, file, &mut axes, &converters);
    plausible::drives(findings, file, &axes, &converters, &force_curves);
    if controller.language.family.facts().printer {
        plausible::printer(findings, file);
    }
    let given = file
        .path
        .as_ref()
        .and_then(|table| table.value.response_time_s.as_ref());
    if given.is_none() {
        path.response_time_s = servo::response_s(&axes, RESPONSE_TIME_S);
    }
    let loads: Vec<Load> = file
        .load
        .iter()
        .flatten()
        .filter_map(|table| switched_load::load(findings, table, &converters, &controller))
        .collect();
    if let Some(tables) = &file.levels {
        levels::take(findings, tables, &axes, &loads, &mut controller);
    }
    let spindle = file
        .spindle
        .as_ref()
        .and_then(|table| spindle::spindle(findings, table, &converters, &controller));
    let tools = tool::tools(findings, file);
    let offsets = file.offsets.as_ref().map(|table| &table.value);
    let places = offsets::all(findings, offsets, axis_set, &controller);
    let kinematics = kinematics::take(findings, file, &axes, &force_curves, &converters);
    let machine = Machine {
        name: file.name.as_ref()?.value.clone(),
        kinematics,
        path,
        controller,
        axes,
        axis_set,
        converters,
        force_curves,
        mass_parts,
        responses,
        spindle,
        tools,
        loads,
        offsets: places.offsets,
        further_offsets: places.further_offsets,
        points: places.points,
        presets: preset::presets(findings, file, &axes, axis_set),
        limits,
    };
    // With an axis left out the machine would look weaker than it is.
    complete.then_some(machine)
}

/// How far masses and friction may be off.
fn errors(file: &MachineFile) -> axis::Errors<'_> {
    let table = file.limits.as_ref().map(|table| &table.value);
    table.map_or_else(axis::Errors::default, |table| axis::Errors {
        mass: table.mass_error.as_ref(),
        friction: table.friction_error.as_ref(),
    })
}

/// What the tables of the axes say.
struct AxisTables {
    axes: [Option<Axis>; AXES],
    axis_set: AxisSet,
    force_curves: Vec<(AxisId, Vec<ForcePoint>)>,
    mass_parts: Vec<(AxisId, Vec<MassPart>)>,
    responses: Responses,
    /// None is left out.
    complete: bool,
}

impl AxisTables {
    fn of(findings: &mut Findings<'_>, file: &MachineFile, errors: axis::Errors<'_>) -> Self {
        let mut found = Self {
            axes: [None; AXES],
            axis_set: AxisSet::default(),
            force_curves: Vec::new(),
            mass_parts: Vec::new(),
            responses: Responses::default(),
            complete: true,
        };
        for (id, table) in file.axes.iter().flat_map(|axes| axes.value.iter()) {
            let axis = axis::axis(findings, id, table, errors);
            found.axis_set.insert(id as usize);
            let curve = drive_curve::force(findings, id, &table.value, axis.as_ref());
            found.force_curves.extend(curve.map(|curve| (id, curve)));
            response::take(findings, id, &table.value, &mut found.responses);
            if let Some(axis) = &axis {
                let parts = parts::all(axis.kind, &table.value, axis.mass_kg);
                let parts = (!parts.is_empty()).then_some((id, parts));
                found.mass_parts.extend(parts);
            }
            found.complete &= axis.is_some();
            found.axes[id as usize] = axis;
        }
        if let Some(table) = file.axes.as_ref().filter(|_| found.axis_set.is_empty())
            && !findings.refused_in("axes")
        {
            let message = "the machine has no axes";
            findings.error("machine-missing", &table.span, message, None);
        }
        found
    }
}

/// Drives that follow a step of speed more quickly are rare.
const RESPONSE_TIME_S: f64 = 0.01;

fn path(table: Option<&PathTable>, controller: &Controller) -> Path {
    Path {
        mode: table.and_then(|table| table.mode),
        rapid: table
            .and_then(|table| table.rapid)
            .unwrap_or(controller.planner.rapid),
        response_time_s: value(
            table.and_then(|table| table.response_time_s.as_ref()),
            RESPONSE_TIME_S,
        ),
        max_feed_mm_s: value(
            table.and_then(|table| table.max_feed_mm_min.as_ref()),
            f64::INFINITY,
        ) / SECONDS_PER_MINUTE,
        accel_mm_s2: [f64::INFINITY; 3],
        clearance_mm: clearance(table.and_then(|table| table.clearance.as_ref())),
    }
}

/// Whether the laser mode is on, where there is one.
fn laser_mode(findings: &mut Findings<'_>, on: &At<bool>, controller: &mut Controller) {
    let mode = &mut controller.queue.laser_mode;
    if *mode == LaserMode::Off {
        let message = format!("controller \"{}\" has no laser mode", controller.name);
        let help = "leave `laser_mode` out; grbl has one".to_owned();
        return findings.error("machine-word", &on.span, message, Some(help));
    }
    *mode = if on.value {
        LaserMode::On
    } else {
        LaserMode::Off
    };
}

/// Clearances by axis.
fn clearance(given: Option<&PerAxis<Number>>) -> [Option<f64>; AXES] {
    let mut clearance_mm = [None; AXES];
    for (axis, number) in given.iter().flat_map(|given| given.iter()) {
        clearance_mm[axis as usize] = Some(number.value);
    }
    clearance_mm
}

fn value<B>(number: Option<&Num<B>>, default: f64) -> f64 {
    number.map_or(default, |number| number.value)
}

fn limits(findings: &mut Findings<'_>, table: Option<&LimitsTable>) -> Limits {
    let overrides = table.and_then(|table| table.override_max_percent.as_ref());
    if let Some(overrides) = overrides {
        plausible::overrides(findings, overrides);
    }
    if let Some(margin) = table.and_then(|table| table.margin.as_ref()) {
        plausible::margin(findings, margin);
    }
    let floor = table.and_then(|table| table.min_feed_mm_min.as_ref());
    let ratio = table.and_then(|table| table.min_feed_ratio.as_ref());
    Limits {
        margin: value(
            table.and_then(|table| table.margin.as_ref()),
            DEFAULT_MARGIN,
        ),
        feed_override_max: value(overrides.and_then(|o| o.feed.as_ref()), 100.0) / 100.0,
        rapid_override_max: value(overrides.and_then(|o| o.rapid.as_ref()), 100.0) / 100.0,
        spindle_override_max: value(overrides.and_then(|o| o.spindle.as_ref()), 100.0) / 100.0,
        override_at: None,
        override_from: None,
        min_feed_mm_s: value(floor, 0.0) / SECONDS_PER_MINUTE,
        min_feed_ratio: value(ratio, 0.0),
    }
}
