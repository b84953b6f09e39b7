//! The edit of a program as a unified diff.
//!
//! Small programs are compared by the `similar` crate, which finds the least
//! difference. Large ones are compared in one pass with flat memory: gwatt only
//! changes lines and inserts some, so the texts never drift apart by more than
//! the lines last inserted, and a short look ahead finds where they meet again.
//! Lines end with LF here, so that `patch` can apply the result.

use std::collections::VecDeque;
use std::io::{self, BufRead, Write};

use similar::TextDiff;

/// Lines of context around a change.
const CONTEXT: usize = 3;
/// Largest program that is compared as a whole, in bytes.
const WHOLE_MAX_BYTES: u64 = 128 << 10;
/// How many lines are looked ahead for a place where the texts meet again.
const LOOK_AHEAD: usize = 16;
/// Lines of a hunk before it is closed, so that memory stays flat.
const HUNK_LINES_MAX: usize = 10_000;

/// Writes what turns `old` into `new`; `bytes` is the size of `old`.
///
/// # Errors
/// Those of reading and writing.
pub fn unified_diff(
    program: &str,
    bytes: u64,
    old: impl BufRead,
    new: impl BufRead,
    mut out: impl Write,
) -> io::Result<()> {
    let path = program.trim_start_matches('/');
    let names = (format!("a/{path}"), format!("b/{path}"));
    if bytes <= WHOLE_MAX_BYTES {
        whole(&names, old, new, &mut out)?;
    } else {
        let mut hunks = Hunks::new(names, out);
        compare_texts(old, new, &mut hunks)?;
        out = hunks.finish()?;
    }
    out.flush()
}

fn whole(
    names: &(String, String),
    mut old: impl BufRead,
    mut new: impl BufRead,
    out: impl Write,
) -> io::Result<()> {
    let (mut before, mut after) = (Vec::new(), Vec::new());
    old.read_to_end(&mut before)?;
    new.read_to_end(&mut after)?;
    let before: Vec<&[u8]> = before.split_inclusive(|&byte| byte == b'\n').collect();
    let after: Vec<&[u8]> = after.split_inclusive(|&byte| byte == b'\n').collect();
    TextDiff::configure()
        .newline_terminated(true)
        .diff_slices(&before, &after)
        .unified_diff()
        .context_radius(CONTEXT)
        .header(&names.0, &names.1)
        .to_writer(out)
}

/// Lines of a text with a look ahead.
struct Lines<R> {
    input: R,
    ahead: VecDeque<Vec<u8>>,
}

impl<R: BufRead> Lines<R> {
    fn new(input: R) -> Self {
        Self {
            input,
            ahead: VecDeque::new(),
        }
    }

    /// The line `index` lines ahead, 0 for the next.
    fn peek(&mut self, index: usize) -> io::Result<Option<&[u8]>> {
        while self.ahead.len() <= index {
            let mut line = Vec::new();
            if self.input.read_until(b'\n', &mut line)? == 0 {
                return Ok(None);
            }
            self.ahead.push_back(line);
        }
        Ok(self.ahead.get(index).map(Vec::as_slice))
    }

    fn next(&mut self) -> io::Result<Option<Vec<u8>>> {
        self.peek(0)?;
        Ok(self.ahead.pop_front())
    }
}

/// What takes the lines of two texts as they are compared.
pub(super) trait Differences {
    /// Takes a line that both texts have.
    fn keep(&mut self, line: Vec<u8>) -> io::Result<()>;

    /// Takes a line that only the old (`-`) or the new (`+`) text has.
    fn change(&mut self, sign: u8, line: Vec<u8>) -> io::Result<()>;
}

/// Compares two texts in one pass.
pub(super) fn compare_texts(
    old: impl BufRead,
    new: impl BufRead,
    differences: &mut impl Differences,
) -> io::Result<()> {
    compare(&mut Lines::new(old), &mut Lines::new(new), differences)
}

fn compare(
    old: &mut Lines<impl BufRead>,
    new: &mut Lines<impl BufRead>,
    hunks: &mut impl Differences,
) -> io::Result<()> {
    loop {
        match (old.peek(0)?, new.peek(0)?) {
            (None, None) => return Ok(()),
            (Some(before), Some(after)) if before == after => {
                old.next()?;
                if let Some(line) = new.next()? {
                    hunks.keep(line)?;
                }
            }
            _ => {
                let (removed, added) = meeting_point(old, new)?;
                for _ in 0..removed {
                    if let Some(line) = old.next()? {
                        hunks.change(b'-', line)?;
                    }
                }
                for _ in 0..added {
                    if let Some(line) = new.next()? {
                        hunks.change(b'+', line)?;
                    }
                }
            }
        }
    }
}

/// How many lines of both texts to pass until they agree again. As no line is
/// ever dropped, the new text passes at least as many as the old one.
fn meeting_point(
    old: &mut Lines<impl BufRead>,
    new: &mut Lines<impl BufRead>,
) -> io::Result<(usize, usize)> {
    for added in 1..=LOOK_AHEAD {
        for removed in 0..=added {
            let Some(before) = old.peek(removed)? else {
                break;
            };
            if new.peek(added)? == Some(before) {
                return Ok((removed, added));
            }
        }
    }
    // Far apart: one line became another.
    Ok((1, 1))
}

/// Gathers changes and their context to hunks.
struct Hunks<W> {
    out: W,
    names: Option<(String, String)>,
    before: VecDeque<Vec<u8>>,
    body: Vec<(u8, Vec<u8>)>,
    /// Unchanged lines at the end of `body`.
    kept: usize,
    old_line: usize,
    new_line: usize,
}

impl<W: Write> Hunks<W> {
    fn new(names: (String, String), out: W) -> Self {
        Self {
            out,
            names: Some(names),
            before: VecDeque::new(),
            body: Vec::new(),
            kept: 0,
            old_line: 0,
            new_line: 0,
        }
    }

    /// Writes the hunk with at most `context` unchanged lines at its end; what
    /// is left of them leads the next one.
    fn close(&mut self, context: usize) -> io::Result<()> {
        let left = self.kept.saturating_sub(context);
        let rest = self.body.split_off(self.body.len() - left);
        let count = |sign| self.body.iter().filter(|line| line.0 != sign).count();
        let (old_count, new_count) = (count(b'+'), count(b'-'));
        let start = |line: usize, count| (line - left - count) + usize::from(count > 0);
        let (old_start, new_start) = (
            start(self.old_line, old_count),
            start(self.new_line, new_count),
        );
        if let Some((before, after)) = self.names.take() {
            writeln!(self.out, "--- {before}\n+++ {after}")?;
        }
        writeln!(
            self.out,
            "@@ -{old_start},{old_count} +{new_start},{new_count} @@"
        )?;
        for (sign, line) in self.body.drain(..) {
            self.out.write_all(&[sign])?;
            self.out.write_all(&line)?;
            if line.last() != Some(&b'\n') {
                self.out.write_all(b"\n\\ No newline at end of file\n")?;
            }
        }
        let skipped = rest.len().saturating_sub(CONTEXT);
        self.before
            .extend(rest.into_iter().skip(skipped).map(|(_, line)| line));
        self.kept = 0;
        Ok(())
    }

    fn finish(mut self) -> io::Result<W> {
        if !self.body.is_empty() {
            self.close(CONTEXT)?;
        }
        Ok(self.out)
    }
}

impl<W: Write> Differences for Hunks<W> {
    fn keep(&mut self, line: Vec<u8>) -> io::Result<()> {
        self.old_line += 1;
        self.new_line += 1;
        if self.body.is_empty() {
            self.before.push_back(line);
            if self.before.len() > CONTEXT {
                self.before.pop_front();
            }
            return Ok(());
        }
        self.body.push((b' ', line));
        self.kept += 1;
        // Twice the context: what belongs to this hunk, and to the next one.
        if self.kept > 2 * CONTEXT {
            self.close(CONTEXT)?;
        }
        Ok(())
    }

    fn change(&mut self, sign: u8, line: Vec<u8>) -> io::Result<()> {
        if self.body.len() >= HUNK_LINES_MAX {
            self.close(0)?;
        }
        if self.body.is_empty() {
            self.body
                .extend(self.before.drain(..).map(|line| (b' ', line)));
        }
        match sign {
            b'-' => self.old_line += 1,
            _ => self.new_line += 1,
        }
        self.kept = 0;
        self.body.push((sign, line));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn streamed(old: &str, new: &str) -> io::Result<String> {
        let mut hunks = Hunks::new(("a/p".into(), "b/p".into()), Vec::new());
        compare(
            &mut Lines::new(old.as_bytes()),
            &mut Lines::new(new.as_bytes()),
            &mut hunks,
        )?;
        Ok(String::from_utf8_lossy(&hunks.finish()?).into_owned())
    }

    #[test]
    fn both_ways_show_the_same_edit() -> io::Result<()> {
        let old: Vec<String> = (0..40).map(|n| format!("G1 X{n}\n")).collect();
        let old = old.concat();
        let new = old
            .replace("X7\n", "X7 F50\n")
            .replace("X8\n", "F100\nG1 X8\n")
            .replace("X30\n", "X30 F9\n")
            .replace("X39\n", "X39 F100");
        let mut whole = Vec::new();
        unified_diff("p", 0, old.as_bytes(), new.as_bytes(), &mut whole)?;
        let whole = String::from_utf8_lossy(&whole).into_owned();
        assert_eq!(streamed(&old, &new)?, whole);
        insta::assert_snapshot!(whole, @"
        --- a/p
        +++ b/p
        @@ -5,7 +5,8 @@
         G1 X4
         G1 X5
         G1 X6
        -G1 X7
        +G1 X7 F50
        +G1 F100
         G1 X8
         G1 X9
         G1 X10
        @@ -28,7 +29,7 @@
         G1 X27
         G1 X28
         G1 X29
        -G1 X30
        +G1 X30 F9
         G1 X31
         G1 X32
         G1 X33
        @@ -37,4 +38,4 @@
         G1 X36
         G1 X37
         G1 X38
        -G1 X39
        +G1 X39 F100
        \\ No newline at end of file
        ");
        Ok(())
    }

    #[test]
    fn nothing_is_said_of_equal_texts() -> io::Result<()> {
        assert_eq!(streamed("G0\nG1", "G0\nG1")?, "");
        Ok(())
    }
}
