//! The moves of a program, one by one.

use std::io::{Cursor, Read, Seek};
use std::vec;

use super::executor::Executor;
use super::{Failure, Options};
use crate::interpret::{Move, Step};
use crate::machine::Machine;

/// The moves that a program commands, in the order in which they are made, dwells included.
/// A program with an error ends with it, after the moves before it.
///
/// ```
/// use gwatt::pipeline::{Moves, Options};
///
/// # fn main() -> Result<(), gwatt::Error> {
/// let (machine, _) = gwatt::Machine::load("three-axis")?;
/// let moves = Moves::of("G21 G90\nG0 X100\nG1 X150 F600\nM30\n", &machine, &Options::default());
/// let mut length_mm = 0.0;
/// for mv in moves {
///     length_mm += mv?.length_mm;
/// }
/// assert_eq!(length_mm, 150.0);
/// # Ok(())
/// # }
/// ```
pub struct Moves<'m, R> {
    /// `None`: it has been read to its end.
    front: Option<Executor<'m, R>>,
    line: vec::IntoIter<Step>,
}

impl<'m, 'p> Moves<'m, Cursor<&'p [u8]>> {
    /// Those of a program that is at hand.
    #[must_use]
    pub fn of(
        program: &'p (impl AsRef<[u8]> + ?Sized),
        machine: &'m Machine,
        options: &Options,
    ) -> Self {
        Self::read(Cursor::new(program.as_ref()), machine, options)
    }
}

impl<'m, R: Read + Seek> Moves<'m, R> {
    /// Those of a program that is read as they are asked for.
    #[must_use]
    pub fn read(input: R, machine: &'m Machine, options: &Options) -> Self {
        Self {
            front: Some(Executor::new(input, machine, options)),
            line: Vec::new().into_iter(),
        }
    }
}

impl<R: Read + Seek> Iterator for Moves<'_, R> {
    type Item = Result<Move, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            for step in self.line.by_ref() {
                if let Step::Move(mv) = step {
                    return Some(Ok(mv));
                }
            }
            match self.front.as_mut()?.next_line() {
                Ok(Some(line)) => self.line = std::mem::take(line.steps).into_iter(),
                Ok(None) => return self.front.take()?.finish().err().map(Err),
                Err(failure) => {
                    self.front = None;
                    return Some(Err(failure));
                }
            }
        }
    }
}
