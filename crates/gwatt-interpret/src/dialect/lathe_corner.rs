//! Chamfers and rounded corners of lathes, whose words have no comma.

use crate::code::Motion;
use crate::control::{Control, Run};
use crate::letters::bit;
use gwatt_machine::AxisId;

impl Control<'_> {
    /// R, C, I and K of a feed along X or Z alone: the corner to the next move is rounded, or cut
    /// off. C is one where the machine has no such axis. The next move says to which side, so
    /// that signs say nothing more (B-64604EN-1, "Chamfering and Corner R").
    pub(crate) fn lathe_corner(&mut self, run: &mut Run<'_, '_>) {
        if self.dialect().lathe.is_none() || self.modal.motion != Motion::Linear {
            return;
        }
        let [x, z, c] = [AxisId::X, AxisId::Z, AxisId::C].map(|axis| axis as usize);
        let unused = |letter: u8| run.words.unused & bit(letter) != 0;
        let along = [unused(b'X'), unused(b'Z')];
        let letter = match along {
            [true, true] | [false, false] => return,
            [along_x, _] => {
                let chamfer = if along_x { b'K' } else { b'I' };
                let turned_off = !self.machine.axis_set.contains(c);
                let mut letters = [b'R', chamfer, b'C'].into_iter();
                letters.find(|letter| unused(*letter) && (*letter != b'C' || turned_off))
            }
        };
        let plane = self.modal.plane;
        let turning = plane[..2].contains(&x) && plane[..2].contains(&z);
        let Some(letter) = letter.filter(|_| turning) else {
            return;
        };
        let Some(mut word) = run.words.word(letter, run.block) else {
            return;
        };
        run.words.take(letter);
        word.value = word.value.abs();
        word.letter = if letter == b'R' { b'R' } else { b'C' };
        self.fanuc_corner(&word, &mut run.report);
    }
}
