//! `limit` holds no whole program, whatever stands between two moves.

use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use std::sync::atomic::{AtomicUsize, Ordering};

use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, Law, LimitOptions, Options, Restart, Strategy, limit};

const HOW: LimitOptions = LimitOptions {
    strategy: Strategy::Optimal,
    law: Law::Exact,
    allowed: Allowed {
        feed: true,
        ..Allowed::NOTHING
    },
    ..LimitOptions::USUAL
};

/// Bytes that a run has read and written, and the most that lay between.
#[derive(Default)]
struct Lag {
    read: AtomicUsize,
    written: AtomicUsize,
    largest: AtomicUsize,
}

struct Reader<'a>(Cursor<&'a [u8]>, &'a Lag);
struct Writer<'a>(&'a Lag);

impl Read for Reader<'_> {
    fn read(&mut self, room: &mut [u8]) -> io::Result<usize> {
        // Small pieces show how far it is ahead.
        let room_len = room.len().min(1024);
        let count = self.0.read(&mut room[..room_len])?;
        let read = self.1.read.fetch_add(count, Ordering::Relaxed) + count;
        let lag = read.saturating_sub(self.1.written.load(Ordering::Relaxed));
        self.1.largest.fetch_max(lag, Ordering::Relaxed);
        Ok(count)
    }
}

impl Seek for Reader<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = self.0.seek(to)?;
        self.1.read.store(at as usize, Ordering::Relaxed);
        Ok(at)
    }
}

impl Write for Writer<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.written.fetch_add(bytes.len(), Ordering::Relaxed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Restart for Writer<'_> {
    fn restart(&mut self) -> io::Result<()> {
        self.0.written.store(0, Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn lines_are_written_before_the_next_move_is_known() {
    for name in ["linuxcnc-mill", "vmc", "three-axis", "printer"] {
        let (machine, _) = Machine::load(name).expect("an embedded machine");
        for idle in ["\n", "(remark)\n", "F600\n", "M8\n", "X20\n"] {
            let idle = idle.repeat(240_000 / idle.len());
            let program =
                format!("G21\nG90\nG94\nG0 X0 Y0\nG1 X20 F900\n{idle}X21\nG0 X30\n{idle}X31\n");
            let lag = Lag::default();
            let input = Reader(Cursor::new(program.as_bytes()), &lag);
            let options = Options::default();
            limit(input, &machine, &options, HOW, Writer(&lag), None).expect("a program");
            let lag = lag.largest.into_inner();
            assert!(lag < 150_000, "{name}: {lag} bytes of {:?}", &idle[..8]);
        }
    }
}
