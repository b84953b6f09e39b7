//! Blocks that let the taps after them be rigid (M29 of Fanuc's controls).

use crate::pipeline::executor::Line;
use crate::rewrite::Placed;
use crate::syntax::Word;

/// Tapping cycles, times ten.
pub(super) const TAPS: [u16; 2] = [740, 840];

/// A block that lets the taps after it be rigid, until another motion word ends that. It
/// stands directly before the tap.
#[derive(Debug, Clone)]
pub(super) struct Rigid {
    /// Its line.
    pub(super) line: u64,
    text: Vec<u8>,
    /// The same without its number.
    again: Vec<u8>,
    /// Nothing has come after it.
    pub(super) last: bool,
}

impl Rigid {
    /// A block that does no more than that.
    fn of(line: &Line<'_, '_>) -> Option<Self> {
        let block = &line.block;
        let own = |word: &Word| is_rigid(word) || word.letter == b'S';
        let alone = block.issues.is_empty() && block.words.iter().all(own);
        let number = block.number.map_or(0, |word| word.span.end as usize);
        let again = line.text.get(number..)?.trim_ascii_start().to_vec();
        (alone && block.delete_level == 0 && again.ends_with(b"\n")).then(|| Self {
            line: line.key.1,
            text: line.text.to_vec(),
            again,
            last: true,
        })
    }

    /// A tap's block with its way before the word that lets it be rigid. The second result is
    /// what the line of that word becomes, where the tap is the first after it.
    pub(super) fn place(&self, placed: Placed) -> (Vec<u8>, Option<Vec<u8>>) {
        if self.last && !placed.way.is_empty() {
            let before = [placed.way, self.text.clone()].concat();
            return (placed.block, Some(before));
        }
        (placed.around(&self.again), None)
    }
}

/// Whether the taps that come next are rigid.
#[derive(Default)]
pub(super) struct Tapping {
    rigid: bool,
    by: Option<Rigid>,
}

impl Tapping {
    /// A block of no cycle; `ends`: the cycle has ended before it.
    pub(super) fn pass(&mut self, line: &Line<'_, '_>, ends: bool) {
        self.rigid &= !ends;
        if line.block.words.iter().any(is_rigid) {
            self.rigid = true;
            self.by = Rigid::of(line);
        } else if let Some(by) = self.by.as_mut().filter(|_| line.facts.executed) {
            by.last = false;
        }
    }

    /// Whether taps before the next one are rigid by the same word, so that they change together.
    pub(super) fn goes_on(&self) -> bool {
        self.rigid && !self.by.as_ref().is_some_and(|by| by.last)
    }

    /// A block of a cycle: what lets it be rigid.
    ///
    /// # Errors
    /// It is rigid, and no block can let it be that again.
    pub(super) fn block(
        &mut self,
        line: &Line<'_, '_>,
        taps: bool,
    ) -> Result<Option<Rigid>, &'static str> {
        if line.block.words.iter().any(is_rigid) {
            (self.rigid, self.by) = (true, None);
        }
        if !(self.rigid && taps) {
            return Ok(None);
        }
        let by = self.by.clone().ok_or(NO_LINE)?;
        if let Some(known) = &mut self.by {
            known.last = false;
        }
        Ok(Some(by))
    }
}

/// Whether a word announces rigid tapping, in which nothing may come between it and the taps.
fn is_rigid(word: &Word) -> bool {
    word.letter == b'M' && word.value == 29.0
}

/// Why such a tap stays as it is.
const NO_LINE: &str = "another motion word ends its rigid tapping, and M29 does not stand on a line \
     of its own before it";
