//! Why a certificate does not hold.

use crate::diagnostic::Diagnostic;
use crate::interpret::Move;
use crate::limit::{Obstacle, Place};
use crate::pipeline::Summary;
use crate::source::{Span, split_line_end};

/// Rules of what must not be: a written program of which one of these is said is not the
/// original made slower.
const FAULTS: [&str; 5] = [
    "changed-sequence",
    "unreadable-output",
    "went-up",
    "changed-feed",
    "edit",
];

/// Why the certificate does not hold: the first reasons in full.
#[derive(Debug, Default)]
pub(in crate::pipeline) struct Reasons {
    pub(in crate::pipeline) list: Vec<Diagnostic>,
    pub(in crate::pipeline) count: u64,
    /// One of [`FAULTS`] is among them, in the list or not.
    faulty: bool,
    /// Names of the files of subprograms, by number less 1.
    files: Vec<String>,
}

impl Reasons {
    /// Whether nothing is said but that moves still draw too much.
    pub(in crate::pipeline) fn only_power(&self) -> bool {
        !self.faulty
    }

    /// Learns the names of files of subprograms.
    pub(in crate::pipeline) fn learn_files(&mut self, names: &[String]) {
        let known = self.files.len();
        self.files.extend(names.iter().skip(known).cloned());
    }

    /// Takes those of the certificate too.
    pub(in crate::pipeline) fn extend(&mut self, other: Self) {
        self.count += other.count;
        self.faulty |= other.faulty;
        self.list.extend(other.list);
    }

    /// With those found on another way through the program, each line once.
    pub(in crate::pipeline) fn join(&mut self, other: Self) {
        self.count += other.count - other.list.len() as u64;
        self.faulty |= other.faulty;
        for reason in other.list {
            let mut known = self.list.iter();
            let same = |it: &Diagnostic| {
                (&it.file, it.line, it.rule) == (&reason.file, reason.line, reason.rule)
            };
            if !known.any(same) {
                self.count += 1;
                self.list.push(reason);
            }
        }
        self.list.truncate(Summary::KEPT);
    }

    /// A move that does not fit and cannot be helped.
    pub(in crate::pipeline) fn refuse(&mut self, mv: &Move, obstacle: &Obstacle, text: &[u8]) {
        let Obstacle {
            rule,
            message,
            help,
        } = obstacle;
        self.push((mv.text, mv.line), rule, message.clone(), help, text);
    }

    pub(in crate::pipeline) fn push(
        &mut self,
        (file, line): Place,
        rule: &'static str,
        message: String,
        help: &str,
        text: &[u8],
    ) {
        self.count += 1;
        self.faulty |= FAULTS.contains(&rule);
        if self.list.len() < Summary::KEPT {
            let span = Span::new(0, split_line_end(text).0.len());
            let mut reason = Diagnostic::error(rule, message).at(line, span, text);
            if !help.is_empty() {
                reason = reason.help(help);
            }
            let name = usize::from(file).checked_sub(1);
            reason.file = name.and_then(|name| self.files.get(name)).cloned();
            self.list.push(reason);
        }
    }
}

impl Reasons {
    /// Names the file of the last one.
    pub(super) fn in_file(&mut self, file: Option<&String>) {
        if let Some(last) = self.list.last_mut() {
            last.file = file.cloned();
        }
    }
}

pub(super) const BUG: &str = "nothing was written; this is a fault of gwatt, please report it";
