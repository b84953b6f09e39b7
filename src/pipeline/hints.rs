//! What `check` says of moves that do not fit is what `limit` does.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek};

use super::limiting::limit;
use super::{Allowed, Failure, Law, LimitOptions, Options, Strategy, Summary};
use crate::diagnostic::Diagnostic;
use crate::machine::Machine;

/// What helps where a cycle has to be written out.
const EXPAND: &str = "`limit --allow expand` writes the canned cycle out and lowers its moves";

/// Lets the limiter decide about a program that does not fit: where it could not lower a
/// move, its own reason stands in the place of the advice in `summary`.
///
/// # Errors
/// See [`Failure`].
pub fn take_hints<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    summary: &mut Summary,
) -> Result<(), Failure> {
    if summary.unfit_count == 0 {
        return Ok(());
    }
    let mut reasons = |allow_expand| -> Result<BTreeMap<u64, Diagnostic>, Failure> {
        input.rewind().map_err(Failure::Input)?;
        let how = LimitOptions {
            strategy: Strategy::Optimal,
            law: Law::Exact,
            allowed: Allowed {
                feed: true,
                expand: allow_expand,
                ..Allowed::NOTHING
            },
        };
        let limited = limit(&mut input, machine, options, how, io::sink(), None)?;
        let mut reasons = BTreeMap::new();
        for reason in limited.reasons {
            reasons.entry(reason.line).or_insert(reason);
        }
        Ok(reasons)
    };
    let as_it_stands = reasons(false)?;
    if as_it_stands.is_empty() {
        return Ok(());
    }
    let written_out = reasons(true)?;
    for unfit in summary.unfit.iter_mut().chain(&mut summary.worst) {
        let Some(reason) = as_it_stands
            .get(&unfit.line)
            .filter(|_| unfit.file.is_empty())
        else {
            continue;
        };
        unfit.help = match (written_out.get(&unfit.line), &reason.help) {
            (None, _) => EXPAND.to_owned(),
            (Some(_), Some(help)) => format!("{}: {help}", reason.message),
            (Some(_), None) => reason.message.clone(),
        };
    }
    Ok(())
}
