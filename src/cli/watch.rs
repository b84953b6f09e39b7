//! Arguments of `watch`.

use std::path::PathBuf;

use clap::Args;

use super::{HowArgs, LimitArgs, MachineArgs, ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt watch programs dnc -m mill.toml              until it is interrupted
  gwatt watch programs dnc -m mill.toml --now        what lies there, then exit
  gwatt watch programs dnc -m mill.toml --allow feed --settle 10

Next to each program that fits stand its certificate (PROGRAM.certificate.txt) and
what each move draws (PROGRAM.csv). One that does not fit, or cannot be read, is
not written: PROGRAM.refused.txt says why, and what was written of it earlier is
removed, so that nobody runs an old version.

Exit status: with --now as `gwatt limit`; else 2 if the folder cannot be read any
more, or if the machine file or other data has changed.";

/// Arguments of `watch`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct WatchArgs {
    /// The folder that programs come into; folders below it count
    #[arg(value_name = "IN")]
    pub from: PathBuf,
    /// The folder that programs that fit are written into; it is made if it is not there
    #[arg(value_name = "OUT")]
    pub into: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Deal with what lies there now, and exit
    #[arg(long)]
    pub now: bool,
    /// How long a program must stay as it is before it is read, in s: it may still be written
    #[arg(long, value_name = "S", default_value_t = 2.0, value_parser = seconds)]
    pub settle: f64,
    /// Print nothing for programs that fit
    #[arg(short, long)]
    pub quiet: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub how: HowArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}

impl WatchArgs {
    /// As `limit` takes them for each program.
    pub fn limit(&self) -> LimitArgs {
        LimitArgs {
            programs: ProgramsArgs {
                paths: Vec::new(),
                files_from: None,
                shard: None,
            },
            machine: self.machine.clone(),
            output: None,
            in_place: false,
            no_backup: false,
            with_subprograms: false,
            dry_run: false,
            quiet: self.quiet,
            report: None,
            json: None,
            html: None,
            svg: None,
            how: self.how.clone(),
            partial: false,
            reading: self.reading.clone(),
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=3600.0).contains(&seconds) => Ok(seconds),
        _ => Err("a time in s, from 0 to 3600, is wanted".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::seconds;

    #[test]
    fn times_are_checked() {
        assert_eq!(seconds("0.5"), Ok(0.5));
        for wrong in ["", "-1", "nan", "inf", "3601", "2s"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
