//! Schedules of drives as they come from files.

use std::io::Read;

use anyhow::{Result, bail, ensure};
use gwatt::pipeline::Failure;

use super::input::Program;
use super::terminal::Terminal;

/// Largest schedule that is read.
const SCHEDULE_BYTES_MAX: u64 = 64 << 20;

/// The bytes of a schedule.
pub(super) fn read_schedule(input: &Program, terminal: Terminal) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = input.open().and_then(|file| {
        let mut file = file.take(SCHEDULE_BYTES_MAX + 1);
        file.read_to_end(&mut bytes).map_err(Failure::Input)
    });
    if let Err(failure) = read {
        terminal.failure(&input.name, &failure);
        bail!(super::Shown);
    }
    ensure!(
        bytes.len() as u64 <= SCHEDULE_BYTES_MAX,
        "{} is larger than a schedule can be",
        input.name
    );
    Ok(bytes)
}
