//! Canned cycles of the programs of a set, written in another way where they keep it from
//! fitting. Those in files of subprograms stay as they are.

use super::discover::Found;
use super::rounds::Job;
use super::{SetFailure, SetSummary};
use crate::pipeline::expand::{LineWays, NOT_WRITTEN_OUT, Way, expand, explain, in_fixed_blocks};
use crate::pipeline::{Options, RestartRows, Summary};

/// Limits a set as it stands, or else with the cycles of its programs written in another way.
pub(super) fn limit(
    job: &Job<'_>,
    ways_through: &[Vec<Options>],
    found: &Found,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<SetSummary, SetFailure> {
    let mut set = job.limit(rows)?;
    let mut originals: Vec<Summary> = set.programs.iter().map(|it| it.before.clone()).collect();
    let mut wanted: Vec<LineWays> = vec![LineWays::default(); originals.len()];
    for way in [Way::Placed, Way::WrittenOut] {
        if set.certified() || way == Way::WrittenOut && !job.how.allowed.expand {
            break;
        }
        let mut next = Job::new(job.programs, job.machine, job.how, ways_through, found);
        for (number, (summary, wanted)) in set.programs.iter().zip(&mut wanted).enumerate() {
            if found.calls(number) {
                // Only its own run would be compared with the original.
                continue;
            }
            let all = summary.reasons.len() >= Summary::KEPT;
            if !summary.certified && in_fixed_blocks(summary) {
                wanted.extend(&summary.reasons, way);
            }
            if wanted.is_empty() {
                continue;
            }
            let (Some(program), Some(ways), Some(before)) = (
                job.programs.get(number),
                ways_through.get(number),
                originals.get_mut(number),
            ) else {
                continue;
            };
            wanted.set_all(all.then_some(way));
            let (expanded, notes) =
                expand(&program.text, job.machine, ways, wanted).map_err(SetFailure::of(number))?;
            before.notes.retain(|note| note.rule != NOT_WRITTEN_OUT);
            before.notes.extend(notes);
            if let Some(place) = next.expanded.get_mut(number) {
                *place = expanded;
            }
        }
        if next.expanded.iter().any(Option::is_some) {
            set = next.limit(rows)?;
        }
    }
    for (summary, before) in set.programs.iter_mut().zip(originals) {
        summary.before = before;
        explain(&mut summary.reasons, &summary.before.notes, job.how.allowed);
    }
    Ok(set)
}
