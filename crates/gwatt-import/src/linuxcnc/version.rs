//! What depends on the version for which an INI file is written.
//!
//! Source: LinuxCNC, `initraj.cc` and `update_ini.py`: from 2.8 on the largest speed of the path
//! is `MAX_LINEAR_VELOCITY`, before it was `MAX_VELOCITY`.

use super::config::{Config, MIN, named, section};
use crate::found::{Figure, Found, highest};
use crate::ini::first;
use crate::text::Log;

/// Which versions an INI file is for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    /// 2.8 and later: sections of joints, and of axes by their letters.
    Joints,
    /// Before that: sections of axes by numbers.
    Axes,
    /// Sections of both kinds, or of none.
    Unknown,
}

fn version(config: &Config<'_>) -> Version {
    let number = first(&config.items, "EMC", "VERSION").and_then(|it| it.value.parse::<f64>().ok());
    if number.is_some_and(|number| number >= 1.1) {
        return Version::Joints;
    }
    let (mut joints, mut axes) = (false, false);
    for item in &config.items {
        let section = item.section.to_ascii_uppercase();
        joints |= section.starts_with("JOINT_");
        if let Some(name) = section.strip_prefix("AXIS_") {
            let is_number = name.bytes().all(|byte| byte.is_ascii_digit());
            (joints, axes) = (joints || !is_number, axes || is_number);
        }
    }
    match (joints, axes) {
        (true, false) => Version::Joints,
        (false, true) => Version::Axes,
        _ => Version::Unknown,
    }
}

/// The largest speed along the path, where there is one in any version that may hold.
pub(super) fn traj_velocity(config: &Config<'_>, log: &mut Log) -> Option<Figure> {
    let traj = section("TRAJ");
    let mut of = |key| config.positive(log, &traj, key, config.linear * MIN);
    match version(config) {
        Version::Joints => of("MAX_LINEAR_VELOCITY"),
        Version::Axes => of("MAX_VELOCITY"),
        Version::Unknown => highest([of("MAX_LINEAR_VELOCITY")?, of("MAX_VELOCITY")?]),
    }
}

/// Says which limit does not hold.
pub(super) fn unread(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let of = |key| first(&config.items, "TRAJ", key);
    let (item, why, read) = match (
        version(config),
        of("MAX_VELOCITY"),
        of("MAX_LINEAR_VELOCITY"),
    ) {
        (Version::Joints, Some(item), None) => (
            item,
            "LinuxCNC 2.8 and later do not read it",
            "MAX_LINEAR_VELOCITY",
        ),
        (Version::Axes, None, Some(item)) => {
            (item, "LinuxCNC before 2.8 does not read it", "MAX_VELOCITY")
        }
        (Version::Unknown, Some(item), None) | (Version::Unknown, None, Some(item)) => (
            item,
            "some versions of LinuxCNC do not read it",
            "both MAX_LINEAR_VELOCITY and MAX_VELOCITY",
        ),
        _ => return,
    };
    let message = format!("{} of [TRAJ] does not count: {why}", item.key);
    let help = format!("where the path has a limit, write {read}");
    log.warning(&item.place, message, &help);
    found.remarks.push(format!("{}: {why}", named(item)));
}
