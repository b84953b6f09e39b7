//! What a configuration in C defines, outside of comments.

use crate::expression;
use crate::found::{Figure, highest};
use crate::near::Job;
use crate::text::{Log, Place};

/// Names refer to each other no deeper than this.
const DEPTH: u32 = 16;

/// A `#define` that is in force.
pub(super) struct Define<'t> {
    name: &'t str,
    pub(super) value: &'t str,
    pub(super) whole: &'t str,
    pub(super) place: Place<'t>,
    /// It stands between `#if` and `#endif`.
    pub(super) in_branch: bool,
}

impl Define<'_> {
    pub(super) fn source(&self) -> String {
        self.place
            .source(self.whole.trim_start_matches("#define").trim())
    }
}

/// All defines.
pub(super) struct Defines<'t> {
    pub(super) list: Vec<Define<'t>>,
    /// Names that stand there commented out.
    pub(super) off: Vec<&'t str>,
}

impl<'t> Defines<'t> {
    pub(super) fn new(job: &'t Job) -> Self {
        let mut found = Self {
            list: Vec::new(),
            off: Vec::new(),
        };
        let mut comments = Comments::default();
        let (mut branches, mut guard) = (0_u32, None);
        for (_, place) in job.places() {
            let line = comments.outside(place.line()).trim();
            if let Some(rest) = line.strip_prefix("//") {
                let rest = rest.trim_start().strip_prefix("#define ");
                found
                    .off
                    .extend(rest.and_then(|rest| rest.split_whitespace().next()));
                continue;
            }
            let code = line.get(..code_end(line)).unwrap_or(line).trim_end();
            let Some(rest) = code.strip_prefix("#define") else {
                if code.starts_with("#if") {
                    branches += 1;
                    guard = code.strip_prefix("#ifndef").map(str::trim);
                } else if code.starts_with("#endif") {
                    branches = branches.saturating_sub(1);
                }
                continue;
            };
            let Some(rest) = rest.strip_prefix([' ', '\t']).map(str::trim_start) else {
                continue;
            };
            let (name, value) = rest.split_once([' ', '\t']).unwrap_or((rest, ""));
            let value = value.trim();
            // The file's own guard against being included twice is no branch.
            if guard.take() == Some(name) && value.is_empty() && found.list.is_empty() {
                branches = branches.saturating_sub(1);
            }
            found.list.push(Define {
                name,
                value,
                whole: code,
                place: place.of(if value.is_empty() { name } else { value }),
                in_branch: branches > 0,
            });
        }
        found
    }

    pub(super) fn all<'d>(&'d self, name: &'d str) -> impl Iterator<Item = &'d Define<'t>> {
        self.list.iter().filter(move |define| define.name == name)
    }

    pub(super) fn is_on(&self, name: &str) -> bool {
        self.all(name)
            .next()
            .is_some_and(|it| it.value != "false" && it.value != "0")
    }

    /// The value of an expression.
    fn eval(&self, text: &str, depth: u32) -> Option<f64> {
        if depth > DEPTH {
            return None;
        }
        let name = |name: &str, depth: u32| {
            let values = self.all(name).filter_map(|it| self.eval(it.value, depth));
            values.fold(None, |best: Option<f64>, value| {
                Some(best.map_or(value, |best| best.max(value)))
            })
        };
        expression::value(text, &name, depth)
    }

    /// The value of a name that has one alone, in whichever branch.
    pub(super) fn only(&self, name: &str, depth: u32) -> Option<f64> {
        if depth > DEPTH {
            return None;
        }
        let of_name = |name: &str, depth: u32| self.only(name, depth);
        let mut values = self
            .all(name)
            .map(|it| expression::value(it.value, &of_name, depth));
        let first = values.next()??;
        values.all(|value| value == Some(first)).then_some(first)
    }

    /// The highest value of a name; reports one that cannot be read.
    pub(super) fn figure(&self, log: &mut Log, name: &str) -> Option<Figure> {
        let mut list = Vec::new();
        for define in self.all(name) {
            match self.eval(define.value, 0) {
                Some(value) => list.push(Figure::new(value, define.source())),
                None => unreadable(log, define),
            }
        }
        highest(list)
    }

    /// The entries of lists in braces; several where several branches have one.
    pub(super) fn lists(&self, log: &mut Log, name: &str) -> Vec<(Vec<f64>, String)> {
        let read = |inner: &str| {
            let entries = inner.split(',').map(|entry| self.eval(entry, 0));
            entries.collect::<Option<Vec<f64>>>()
        };
        let mut lists = Vec::new();
        for define in self.all(name) {
            let inner = define
                .value
                .strip_prefix('{')
                .and_then(|it| it.strip_suffix('}'));
            match inner.and_then(read) {
                Some(values) => lists.push((values, define.source())),
                None => unreadable(log, define),
            }
        }
        lists
    }
}

/// Comments over several lines.
#[derive(Default)]
struct Comments {
    open: bool,
}

impl Comments {
    /// A line from where no comment of an earlier line is open; empty where it ends in one.
    fn outside<'l>(&mut self, line: &'l str) -> &'l str {
        let mut rest = line;
        loop {
            if self.open {
                let Some((_, after)) = rest.split_once("*/") else {
                    return "";
                };
                (rest, self.open) = (after, false);
            }
            let Some(after) = rest.trim_start().strip_prefix("/*") else {
                break;
            };
            (rest, self.open) = (after, true);
        }
        let from = rest;
        while let Some(after) = rest.get(code_end(rest)..) {
            let Some(comment) = after.strip_prefix("/*") else {
                break;
            };
            let Some((_, after)) = comment.split_once("*/") else {
                self.open = true;
                break;
            };
            rest = after;
        }
        from
    }
}

/// Where the first comment of a line begins, outside of texts.
fn code_end(line: &str) -> usize {
    let bytes = line.as_bytes();
    let mut quoted = false;
    let mut at = 0;
    while let Some(byte) = bytes.get(at) {
        match (byte, bytes.get(at + 1)) {
            (b'\\', _) if quoted => at += 1,
            // The character '"'.
            (b'\'', Some(b'"')) if !quoted => at += 2,
            (b'"', _) => quoted = !quoted,
            (b'/', Some(b'/' | b'*')) if !quoted => return at,
            _ => {}
        }
        at += 1;
    }
    line.len()
}

fn unreadable(log: &mut Log, define: &Define<'_>) {
    let message = format!("`{}` cannot be read", define.value);
    log.error(
        &define.place,
        message,
        "write it as a number, or a sum of numbers, and import again",
    );
}
