//! What the operator may set on the screen: overrides.
//!
//! Sources: LinuxCNC documentation, "INI Configuration", `[DISPLAY]`; the screen Axis for the
//! spindle without a limit of its own (`axis.py`). The override of rapids ends at 100 %.

use super::config::{Config, named};
use crate::found::{Figure, Found, entry, highest, shown};
use crate::ini::first;
use crate::text::Log;

/// `MAX_FEED_OVERRIDE` and `MAX_SPINDLE_OVERRIDE`, which are factors.
pub(super) fn overrides(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let mut factor = |key: &str| {
        let item = first(&config.items, "DISPLAY", key)?;
        let value = log.number(&item.place, item.value)?;
        Some(Figure::new(value, named(item)))
    };
    let feed = factor("MAX_FEED_OVERRIDE");
    let own = ["MAX_SPINDLE_OVERRIDE", "MAX_SPINDLE_0_OVERRIDE"].map(factor);
    // Without a limit of its own the spindle has that of the feed.
    let spindle = highest(own.into_iter().flatten()).or_else(|| feed.clone());
    let mut fields = Vec::new();
    let mut sources: Vec<String> = Vec::new();
    for (name, figure) in [("feed", feed), ("spindle", spindle)] {
        // A lower one does not hold at the start.
        let Some(figure) = figure.filter(|it| it.value > 1.0) else {
            continue;
        };
        fields.push(format!("{name} = {}", shown(figure.value * 100.0)));
        if !sources.contains(&figure.source) {
            sources.push(figure.source);
        }
    }
    if !fields.is_empty() {
        let field = format!("override_max_percent = {{ {} }}", fields.join(", "));
        found.limits.push(entry(field, sources.join(", ")));
    }
}
