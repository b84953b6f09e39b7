//! Pairs the moves that two machines make of one program.

use std::collections::VecDeque;
use std::io;
use std::mem;
use std::sync::mpsc::{Receiver, SyncSender};
use std::vec;

use gwatt::interpret::MoveKind;
use gwatt::pipeline::{Row, RowSink};

/// Moves that go through the channel at once.
const BATCH: usize = 1024;
/// Moves within which the next one is looked for that both machines make.
const REACH: usize = 64;

/// Sends rows to the other end of a channel.
pub struct SentRows {
    batch: Vec<Row>,
    sender: SyncSender<Vec<Row>>,
}

impl SentRows {
    /// Rows for the other end of this channel.
    pub fn new(sender: SyncSender<Vec<Row>>) -> Self {
        let batch = Vec::with_capacity(BATCH);
        Self { batch, sender }
    }

    /// Sends what is still held back.
    pub fn send(&mut self) -> io::Result<()> {
        let batch = mem::replace(&mut self.batch, Vec::with_capacity(BATCH));
        self.sender.send(batch).map_err(io::Error::other)
    }
}

impl RowSink for SentRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        self.batch.push(row.clone());
        if self.batch.len() == BATCH {
            self.send()?;
        }
        Ok(())
    }
}

/// The rows of one machine, of which some are looked at before it is their turn.
struct Queue {
    rows: vec::IntoIter<Row>,
    from: Receiver<Vec<Row>>,
    seen: VecDeque<Row>,
}

impl Queue {
    fn new(from: Receiver<Vec<Row>>) -> Self {
        Self {
            rows: Vec::new().into_iter(),
            from,
            seen: VecDeque::new(),
        }
    }

    /// The row at a place from the next one on.
    fn at(&mut self, place: usize) -> Option<&Row> {
        while self.seen.len() <= place {
            let row = loop {
                match self.rows.next() {
                    Some(row) => break row,
                    // The other end is closed once all are sent.
                    None => self.rows = self.from.recv().ok()?.into_iter(),
                }
            };
            self.seen.push_back(row);
        }
        self.seen.get(place)
    }

    /// Takes the next row.
    fn next(&mut self) -> Option<Row> {
        self.at(0)?;
        self.seen.pop_front()
    }
}

/// Whether two rows are about the same move: the same run of the same line, and both moves of
/// axes or both waits for the spindle, since these differ from machine to machine.
fn same(a: &Row, b: &Row) -> bool {
    let waits = |row: &Row| row.kind == MoveKind::Spindle;
    a.line == b.line && a.run == b.run && waits(a) == waits(b) && a.file == b.file
}

/// Takes pairs of rows, each row once and in the order of its machine; where one machine makes
/// moves that the other does not make they come alone. Both ends are read to their ends, so
/// that no thread waits for ever.
pub fn pair(
    first: Receiver<Vec<Row>>,
    second: Receiver<Vec<Row>>,
    mut take: impl FnMut(Option<&Row>, Option<&Row>),
) {
    let (mut first, mut second) = (Queue::new(first), Queue::new(second));
    while first.at(0).is_some() && second.at(0).is_some() {
        // With nothing in reach both go on by one.
        let alone = apart(&mut first, &mut second).unwrap_or([1, 1]);
        for _ in 0..alone[0] {
            take(first.next().as_ref(), None);
        }
        for _ in 0..alone[1] {
            take(None, second.next().as_ref());
        }
        if alone == [0, 0] {
            take(first.next().as_ref(), second.next().as_ref());
        }
    }
    while let Some(row) = first.next() {
        take(Some(&row), None);
    }
    while let Some(row) = second.next() {
        take(None, Some(&row));
    }
}

/// How many rows of each stand before the next two that are the same; the fewest.
fn apart(first: &mut Queue, second: &mut Queue) -> Option<[usize; 2]> {
    for sum in 0..=2 * REACH {
        for own in sum.saturating_sub(REACH)..=sum.min(REACH) {
            let other = sum - own;
            let (Some(a), Some(b)) = (first.at(own), second.at(other)) else {
                continue;
            };
            if same(a, b) {
                return Some([own, other]);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::sync::mpsc::sync_channel;
    use std::thread;

    use gwatt::machine::Machine;
    use gwatt::pipeline;

    use super::*;

    struct Kept(Vec<Row>);

    impl RowSink for Kept {
        fn row(&mut self, row: &Row) -> io::Result<()> {
            self.0.push(row.clone());
            Ok(())
        }
    }

    /// A row of some move, with another line, run and kind.
    fn rows(places: &[(u64, u32, MoveKind)]) -> Vec<Row> {
        let (machine, _) = Machine::load("three-axis").unwrap();
        let mut kept = Kept(Vec::new());
        let options = pipeline::Options::default();
        let program = Cursor::new("G21 G90\nG0 X1\nM30\n");
        pipeline::analyze(program, &machine, &options, Some(&mut kept)).unwrap();
        let row = |&(line, run, kind): &(u64, u32, MoveKind)| Row {
            line,
            run,
            kind,
            ..kept.0[0].clone()
        };
        places.iter().map(row).collect()
    }

    /// Lines of pairs; 0 stands for no such move.
    fn paired(first: &[(u64, u32, MoveKind)], second: &[(u64, u32, MoveKind)]) -> Vec<[u64; 2]> {
        let (first_sender, first_rows) = sync_channel(1);
        let (second_sender, second_rows) = sync_channel(1);
        let mut list = Vec::new();
        thread::scope(|scope| {
            for (rows, sender) in [(rows(first), first_sender), (rows(second), second_sender)] {
                scope.spawn(move || {
                    let mut sent = SentRows::new(sender);
                    for row in &rows {
                        sent.row(row).unwrap();
                    }
                    sent.send().unwrap();
                });
            }
            pair(first_rows, second_rows, |first, second| {
                list.push([first, second].map(|row| row.map_or(0, |row| row.line)));
            });
        });
        list
    }

    const FEED: MoveKind = MoveKind::Feed;

    #[test]
    fn moves_of_one_machine_alone_do_not_shift_the_others() {
        let wait = (2, 1, MoveKind::Spindle);
        let first = [(1, 1, FEED), wait, (2, 1, FEED), (4, 1, FEED)];
        let second = [(1, 1, FEED), (2, 1, FEED), (2, 1, FEED), (3, 1, FEED)];
        assert_eq!(
            paired(&first, &second),
            [[1, 1], [2, 0], [2, 2], [4, 0], [0, 2], [0, 3]]
        );
    }

    /// Runs of a loop, of which the second machine makes one move more in the first.
    #[test]
    fn runs_of_a_loop_stay_together() {
        let run = |run: u32| [(5, run, FEED), (6, run, FEED)];
        let first: Vec<_> = (1..=3).flat_map(run).collect();
        let mut second = first.clone();
        second.insert(1, (9, 1, FEED));
        let pairs = paired(&first, &second);
        assert_eq!(pairs[1], [0, 9]);
        assert_eq!(pairs.iter().filter(|[a, b]| a == b).count(), 6);
    }

    /// Nothing in common, beyond the reach and beyond a batch: each row once.
    #[test]
    fn each_row_comes_once() {
        let first: Vec<_> = (1..=3000).map(|line| (line, 1, FEED)).collect();
        let second: Vec<_> = (1..=1500).map(|line| (line, 2, FEED)).collect();
        let pairs = paired(&first, &second);
        assert_eq!(pairs.len(), 4500);
        for side in [0, 1] {
            let lines: Vec<u64> = pairs
                .iter()
                .map(|pair| pair[side])
                .filter(|it| *it > 0)
                .collect();
            assert!(lines.is_sorted());
            assert_eq!(lines.len(), [3000, 1500][side]);
        }
        assert_eq!(paired(&[], &[(1, 1, FEED)]), [[0, 1]]);
    }
}
