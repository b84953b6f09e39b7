//! What G28 does besides homing.
//!
//! Source: Klipper documentation, "Configuration reference", `[safe_z_home]` and
//! `[homing_override]`; defaults from `klippy/extras/safe_z_home.py`.

use gwatt_machine::AxisId;

use super::config::{Config, MIN};
use crate::found::{Figure, Found, highest};
use crate::ini::last;
use crate::text::Log;

const SECTION: &str = "safe_z_home";

/// `[safe_z_home]`: Z is lifted, X and Y go together to where Z homes, and maybe back.
pub(super) fn safe_z(config: &Config<'_, '_>, found: &mut Found, log: &mut Log) {
    if !config.has(SECTION) {
        return;
    }
    let lifts = last(config.items, SECTION, "z_hop").is_some();
    let speed = config.positive(log, SECTION, "speed");
    let speed = speed.map(|it| it.named("[safe_z_home] "));
    let speed = speed.unwrap_or(Figure::new(50.0, "speed of [safe_z_home] is 50 by default"));
    for id in [AxisId::X, AxisId::Y] {
        raise(found, id, speed.clone());
    }
    if lifts {
        let hop = config.positive(log, SECTION, "z_hop_speed");
        let hop = hop.map(|it| it.named("[safe_z_home] "));
        let hop = hop.unwrap_or(Figure::new(15.0, "z_hop_speed is 15 by default"));
        raise(found, AxisId::Z, hop);
    }
    let groups = if lifts {
        r#"[["Z"], ["X", "Y"]]"#
    } else {
        r#"[["X", "Y"]]"#
    };
    found.language(format!("home_moves = {groups}"), "[safe_z_home]");
}

/// The speed of homing is at least this one, mm/s.
fn raise(found: &mut Found, id: AxisId, speed: Figure) {
    let axis = found.axis(id);
    let all = axis.reference_speed.take().into_iter();
    axis.reference_speed = highest(all.chain([speed.times(MIN)]));
}
