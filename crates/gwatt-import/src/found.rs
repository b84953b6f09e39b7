//! What an importer finds: values in gwatt's units, each with its source.

use gwatt_machine::{AXES, AxisId};

/// A number with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    pub(crate) value: f64,
    pub(crate) source: String,
}

impl Figure {
    pub(crate) fn new(value: f64, source: impl Into<String>) -> Self {
        Self {
            value,
            source: source.into(),
        }
    }

    /// In another unit.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            ..self
        }
    }

    /// With words before its source.
    pub(crate) fn named(self, prefix: &str) -> Self {
        Self {
            source: format!("{prefix}{}", self.source),
            ..self
        }
    }
}

/// What is said of it.
const HIGHEST: &str = ", the highest";

/// The highest of several values that may hold.
pub(crate) fn highest(figures: impl IntoIterator<Item = Figure>) -> Option<Figure> {
    let all: Vec<Figure> = figures.into_iter().collect();
    let mut best: Option<&Figure> = None;
    for figure in &all {
        if best.is_none_or(|best| figure.value > best.value) {
            best = Some(figure);
        }
    }
    let best = best?;
    let lower = all.iter().any(|other| other.value < best.value);
    let marked = best.source.ends_with(HIGHEST);
    let mark = if lower && !marked { HIGHEST } else { "" };
    Some(Figure::new(best.value, format!("{}{mark}", best.source)))
}

/// An axis as far as the file describes it; rotary ones in degrees.
#[derive(Debug, Clone, Default)]
pub(crate) struct FoundAxis {
    pub(crate) rotary: bool,
    /// Per minute.
    pub(crate) rapid: Option<Figure>,
    /// Per second squared.
    pub(crate) accel: Option<Figure>,
    /// Time from rest to the rapid speed, s, where the file has no acceleration.
    pub(crate) accel_time_s: Option<Figure>,
    /// Per minute.
    pub(crate) reference_speed: Option<Figure>,
    pub(crate) reference: Option<Figure>,
    /// Places of further reference points, in order.
    pub(crate) further_references: Vec<Figure>,
    /// How far the acceleration exceeds the setting.
    pub(crate) servo_factor: Option<Figure>,
    /// Lines of comment above the table.
    pub(crate) comments: Vec<String>,
    /// Fields that are written as comments, since they may not hold: field and why.
    pub(crate) maybe: Vec<Entry>,
    /// What the file says of the drive: added to what is asked for.
    pub(crate) drive: Vec<String>,
    pub(crate) motors: usize,
}

impl FoundAxis {
    /// Says how far the axis goes; `unit` stands after the numbers.
    pub(crate) fn travel(&mut self, min: &Figure, max: &Figure, unit: &str) {
        let [from, to] = [min, max].map(|it| shown(it.value));
        let travel = format!(
            "Travel: {from} to {to}{unit}: {}, {}",
            min.source, max.source
        );
        self.comments.push(travel);
    }
}

/// A field as it is written, with its source.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub(crate) field: String,
    pub(crate) source: String,
}

/// What asks for masses look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Build {
    Screws,
    Belts,
}

/// A machine as far as the file describes it.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub(crate) controller: &'static str,
    pub(crate) name: String,
    pub(crate) build: Build,
    pub(crate) axes: [Option<FoundAxis>; AXES],
    pub(crate) path: Vec<Entry>,
    pub(crate) language: Vec<Entry>,
    pub(crate) look_ahead: Vec<Entry>,
    /// Name and fields of the rule for corners.
    pub(crate) corner: Option<(&'static str, Vec<Entry>)>,
    /// Whole tables that stand after the axes.
    pub(crate) tables: Vec<String>,
    /// What the file has and gwatt does not count, as comments.
    pub(crate) remarks: Vec<String>,
    pub(crate) spindle_rpm: Option<Figure>,
    /// Fields of `[limits]` besides the margin.
    pub(crate) limits: Vec<Entry>,
    /// Two motors move two axes together.
    pub(crate) core: bool,
    /// What machine files call that.
    pub(crate) kinematics: Option<&'static str>,
}

impl Found {
    pub(crate) fn new(controller: &'static str, name: &str, build: Build) -> Self {
        Self {
            controller,
            name: name.to_owned(),
            build,
            axes: Default::default(),
            path: Vec::new(),
            language: Vec::new(),
            look_ahead: Vec::new(),
            corner: None,
            tables: Vec::new(),
            remarks: Vec::new(),
            spindle_rpm: None,
            limits: Vec::new(),
            core: false,
            kinematics: None,
        }
    }

    /// The axis, which then exists.
    pub(crate) fn axis(&mut self, id: AxisId) -> &mut FoundAxis {
        let rotary = matches!(id, AxisId::A | AxisId::B | AxisId::C);
        self.axes[id as usize].get_or_insert_with(|| FoundAxis {
            rotary,
            ..FoundAxis::default()
        })
    }

    /// The axis if it exists.
    pub(crate) fn known(&mut self, id: AxisId) -> Option<&mut FoundAxis> {
        self.axes[id as usize].as_mut()
    }

    /// Adds a field of `[path]`.
    pub(crate) fn path(&mut self, field: impl Into<String>, source: impl Into<String>) {
        self.path.push(entry(field, source));
    }

    /// Adds a field of `[language]`.
    pub(crate) fn language(&mut self, field: impl Into<String>, source: impl Into<String>) {
        self.language.push(entry(field, source));
    }

    /// Adds a field of `[look_ahead]`.
    pub(crate) fn look_ahead(&mut self, field: impl Into<String>, source: impl Into<String>) {
        self.look_ahead.push(entry(field, source));
    }
}

/// A field with its source.
pub(crate) fn entry(field: impl Into<String>, source: impl Into<String>) -> Entry {
    Entry {
        field: field.into(),
        source: source.into(),
    }
}

/// A number as it is written: no more digits than it has.
pub(crate) fn shown(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    // TOML has no whole numbers beyond 64 bits.
    if rounded.abs() >= 1e15 || (rounded != 0.0 && rounded.abs() < 1e-9) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}
