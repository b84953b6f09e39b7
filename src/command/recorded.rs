//! Recordings as `identify` reads them.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use gwatt::identify::merge::force_per_torque;
use gwatt::identify::{MappedColumn, Outcome, Preset, ReadAs, Recording};

use super::input::is_dash;
use crate::cli::IdentifyArgs;

/// How the recordings of a run are read.
pub struct RecordingReader {
    read_as: ReadAs,
    /// N per N·m, where what turns is referred to a slide.
    force_per_torque: Option<f64>,
    reverse: bool,
}

impl RecordingReader {
    /// As the options have it, for an axis.
    ///
    /// # Errors
    ///
    /// Values out of their range.
    pub fn new(args: &IdentifyArgs, axis: char) -> Result<Self> {
        let ratio = args
            .lead_mm
            .map(|lead_mm| force_per_torque(lead_mm, args.gear_ratio));
        ensure!(
            ratio.is_none_or(|ratio| ratio.is_finite() && ratio > 0.0),
            "--lead-mm and --gear-ratio must be positive"
        );
        if let Some(hz) = args.rate_hz {
            ensure!(hz.is_finite() && hz > 0.0, "--rate-hz {hz} is not positive");
        }
        let map = args.map.iter().map(|text| text.parse());
        Ok(Self {
            read_as: ReadAs {
                axis: Some(axis),
                map: map.collect::<Outcome<Vec<MappedColumn>>>()?,
                rate_hz: args.rate_hz,
                preset: args.preset.and_then(|preset| Preset::named(preset.name())),
            },
            force_per_torque: ratio,
            reverse: args.reverse,
        })
    }

    /// Reads a recording.
    ///
    /// # Errors
    ///
    /// When it cannot be read or used; its name stands before the reason.
    pub fn open(&self, path: &Path) -> Result<Recording> {
        let name = path.display();
        let read = if is_dash(path) {
            Recording::read_as(io::stdin().lock(), &self.read_as)
        } else {
            let file =
                File::open(path).with_context(|| format!("{name}: cannot read the recording"))?;
            Recording::read_as(BufReader::new(file), &self.read_as)
        };
        let mut recording = read.with_context(|| name.to_string())?;
        if let Some(ratio) = self.force_per_torque {
            recording
                .refer_to_slide(ratio)
                .with_context(|| name.to_string())?;
        }
        if self.reverse {
            recording.reverse();
        }
        Ok(recording)
    }
}
