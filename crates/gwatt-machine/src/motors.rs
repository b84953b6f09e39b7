//! Motors of which a document gives the rotor's inertia: the files of `machine-configs/motors/`,
//! one a document.

use serde::Deserialize;

use crate::builtin::motor_files;

/// How a motor is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MotorKind {
    /// With an encoder; its torque can be exceeded for a moment.
    Servo,
    /// By steps.
    Stepper,
}

/// A motor as its document has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Motor {
    /// The name to call it by.
    pub name: String,
    /// Servo or stepper.
    pub kind: MotorKind,
    /// Who makes it.
    pub maker: String,
    /// Inertia of the rotor in kg·m², without brake and coupling.
    pub rotor_kg_m2: f64,
    /// Torque that it bears for ever in N·m; of a stepper that at standstill.
    pub continuous_nm: f64,
    /// Torque for a moment; `None` where there is no more.
    pub peak_nm: Option<f64>,
    /// The speed of its rating.
    pub rated_rpm: Option<f64>,
    /// The largest speed; `None` where the document says none.
    pub max_rpm: Option<f64>,
}

impl Motor {
    /// The largest torque at any speed, N·m.
    #[must_use]
    pub fn most_nm(&self) -> f64 {
        self.peak_nm.unwrap_or(self.continuous_nm)
    }
}

/// Motors that stand in one document.
#[derive(Debug, Clone, PartialEq)]
pub struct MotorSeries {
    /// One line on them: the file's first comment.
    pub description: &'static str,
    /// The document.
    pub document: String,
    /// Where it was found.
    pub url: String,
    /// The motors.
    pub motors: Vec<Motor>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: u32,
    maker: String,
    kind: MotorKind,
    document: String,
    url: String,
    motor: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    rotor_kg_m2: f64,
    continuous_nm: f64,
    peak_nm: Option<f64>,
    rated_rpm: Option<f64>,
    max_rpm: Option<f64>,
}

/// All motors that are built in, by the document that they come from.
#[must_use]
pub fn motors() -> Vec<MotorSeries> {
    let series = |file: &crate::builtin::Builtin| series(file.text, file.description);
    motor_files().iter().filter_map(series).collect()
}

/// A motor by its name, in capitals or not, and its document.
#[must_use]
pub fn motor(name: &str) -> Option<(Motor, MotorSeries)> {
    let is_meant = |motor: &&Motor| motor.name.eq_ignore_ascii_case(name.trim());
    motors().into_iter().find_map(|series| {
        let found = series.motors.iter().find(is_meant).cloned();
        found.map(|motor| (motor, series))
    })
}

/// The motors of a file; `None` where it is not one.
fn series(text: &str, description: &'static str) -> Option<MotorSeries> {
    let file: File = toml::from_str(text)
        .ok()
        .filter(|it: &File| it.schema == 1)?;
    let motors = file.motor.into_iter().map(|entry| Motor {
        name: entry.name,
        kind: file.kind,
        maker: file.maker.clone(),
        rotor_kg_m2: entry.rotor_kg_m2,
        continuous_nm: entry.continuous_nm,
        peak_nm: entry.peak_nm,
        rated_rpm: entry.rated_rpm,
        max_rpm: entry.max_rpm,
    });
    Some(MotorSeries {
        description,
        document: file.document,
        url: file.url,
        motors: motors.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_read_and_has_its_document() {
        let all = motors();
        assert_eq!(all.len(), motor_files().len());
        let mut names: Vec<&str> = Vec::new();
        for series in &all {
            assert!(!series.document.is_empty() && series.url.starts_with("http"));
            assert!(!series.description.is_empty() && !series.motors.is_empty());
            for motor in &series.motors {
                let figures = [motor.rotor_kg_m2, motor.continuous_nm, motor.most_nm()];
                assert!(
                    figures.iter().all(|it| it.is_finite() && *it > 0.0),
                    "{motor:?}"
                );
                assert!(motor.most_nm() >= motor.continuous_nm, "{motor:?}");
                assert!(motor.rated_rpm <= motor.max_rpm, "{motor:?}");
                names.push(&motor.name);
            }
        }
        names.sort_unstable();
        let count = names.len();
        names.dedup();
        assert_eq!(names.len(), count, "a name stands twice");
        assert!(count >= 6);
    }

    /// The document's own check: rated power rate = torque² / inertia, for which it gives
    /// 33.1 kW/s and 35.9 kW/s.
    #[test]
    fn power_rates_are_those_of_the_document() {
        for (name, kw_s) in [("sgm7j-04a", 33.1), ("SGM7J-08A", 35.9), ("hg-kn43", 43.2)] {
            let (motor, _) = motor(name).unwrap();
            let found = motor.continuous_nm * motor.continuous_nm / motor.rotor_kg_m2 / 1e3;
            // The torque of the last one has two digits.
            assert!((found / kw_s - 1.0).abs() < 0.05, "{name}: {found} kW/s");
        }
        assert!(motor("sgm7j").is_none());
    }
}
