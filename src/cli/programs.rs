//! Which programs a command reads, where it takes many.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

/// Which programs.
#[derive(Debug, Clone, Args)]
pub struct ProgramsArgs {
    /// The programs; - for standard input. A folder stands for all programs below it, a
    /// pattern (`*`, `**`, `?`) for what it matches
    #[arg(required_unless_present = "files_from", value_name = "PROGRAM")]
    pub paths: Vec<PathBuf>,
    /// Take more programs from this list, a name a line or each ended by a NUL byte; - for
    /// standard input
    #[arg(long, value_name = "FILE", help_heading = "Many programs")]
    pub files_from: Option<PathBuf>,
    /// Take the I-th of N shares of the programs, so that N runs do them all: such as 2/8
    #[arg(long, value_name = "I/N", help_heading = "Many programs")]
    pub shard: Option<Shard>,
}

/// One of so many shares, from 1 on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which one.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(index, count)| {
            let [index, count] = [index, count].map(|number| number.parse().ok());
            Some((index?, count?))
        });
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err("a share is such as 1/4, 2/4, 3/4 or 4/4".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_one_of_so_many() {
        assert_eq!("2/8".parse(), Ok(Shard { index: 2, count: 8 }));
        for wrong in ["", "/", "0/4", "5/4", "1", "1/0", "-1/4", "1/4/2", "a/b"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
