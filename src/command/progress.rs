//! How far long work is: a bar on a terminal, or lines for LinuxCNC's `[FILTER]`.
//!
//! Readers of programs add what they have read to a counter; a thread looks at it ten times a
//! second and draws. What is said meanwhile goes through [`around`], so that lines and the bar
//! do not mix.

use std::io::{self, IsTerminal, Write as _};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use gwatt::pipeline::LineCount;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::interrupt;
use crate::cli::ProgressArg;

/// Work that is shorter than this shows nothing.
const SHORT: Duration = Duration::from_secs(1);
/// How often the progress is looked at.
const TICK: Duration = Duration::from_millis(100);
/// How a bar looks.
const BAR: &str = "{spinner} {msg} [{bar:30}] {percent:>3} %  {elapsed}";
/// Set by the user interfaces of LinuxCNC while a filter runs.
const LINUXCNC_ASKS: &str = "AXIS_PROGRESS_BAR";

/// The bar that is on the screen.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

fn shown() -> MutexGuard<'static, Option<ProgressBar>> {
    SHOWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes to the terminal while no bar is in the way.
pub fn around<T>(write: impl FnOnce() -> T) -> T {
    match &*shown() {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Takes the bar off the screen, as the run is ended.
fn clear() {
    // What holds it for long writes to a reader that waits: then there is no bar to see.
    if let Ok(bar) = SHOWN.try_lock()
        && let Some(bar) = &*bar
    {
        bar.finish_and_clear();
    }
}

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Not at all.
    Nothing,
    /// A bar, after so long.
    Bar(Duration),
    /// `FILTER_PROGRESS=NN`.
    Filter,
}

impl Shape {
    /// What is asked for; with `auto` what the other end of standard error can show.
    pub fn of(asked: ProgressArg) -> Self {
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        match asked {
            ProgressArg::Linuxcnc => Self::Filter,
            ProgressArg::Always => Self::Bar(Duration::ZERO),
            ProgressArg::Auto if std::env::var_os(LINUXCNC_ASKS).is_some() => Self::Filter,
            ProgressArg::Auto if io::stderr().is_terminal() && !dumb => Self::Bar(SHORT),
            ProgressArg::Auto | ProgressArg::Never => Self::Nothing,
        }
    }

    /// The same with `-q`: what was not asked for by name is not shown.
    pub fn quiet(self, quiet: bool) -> Self {
        match self {
            Self::Bar(after) if quiet && !after.is_zero() => Self::Nothing,
            other => other,
        }
    }
}

/// What is done, as a share of what is to be done.
#[derive(Debug)]
enum Work {
    /// Bytes of programs that are read, several times each, as a rule so often.
    Bytes { name: String, passes: u64 },
    /// Lines of programs that are limited together: how many a pass has is known after the
    /// first one.
    Lines {
        name: String,
        count: LineCount,
        passes: u64,
    },
    /// Programs.
    Programs,
}

#[derive(Debug)]
struct State {
    work: Work,
    done: Meter,
    total: u64,
}

impl State {
    /// In percent, never less than before.
    fn percent(&self) -> u64 {
        let (done, total, passes) = match &self.work {
            Work::Bytes { passes, .. } => (self.done.get(), self.total, *passes),
            Work::Lines { count, passes, .. } => match count.in_a_pass() {
                0 => return 0,
                pass => (count.done(), pass, *passes),
            },
            Work::Programs => (self.done.get(), self.total, 1),
        };
        let all = total.saturating_mul(passes).max(1);
        // The end is said by the run that has come to it.
        (done.saturating_mul(100) / all).min(99)
    }

    /// What stands before the bar, how much of it is full, and of how much.
    fn line(&self) -> (String, u64, u64) {
        let (done, total) = (self.done.get(), self.total.max(1));
        match &self.work {
            Work::Bytes { name, .. } => in_passes(name, done, total),
            Work::Lines { name, count, .. } => match (count.done(), count.in_a_pass()) {
                (done, 0) => (format!("{name}, {done} lines"), 0, 1),
                (done, total) => in_passes(name, done, total),
            },
            Work::Programs => (format!("{done} of {total} programs"), done, total),
        }
    }
}

/// What is said of the pass that `done` is in, where each has `total`.
fn in_passes(name: &str, done: u64, total: u64) -> (String, u64, u64) {
    let pass = done.saturating_sub(1) / total + 1;
    (
        format!("{name}, pass {pass}"),
        done - (pass - 1) * total,
        total,
    )
}

/// Counts what is done.
#[derive(Debug, Clone, Default)]
pub struct Meter(Arc<AtomicU64>);

impl Meter {
    /// So much more is done.
    pub fn add(&self, done: u64) {
        self.0.fetch_add(done, Relaxed);
    }

    fn get(&self) -> u64 {
        self.0.load(Relaxed)
    }
}

/// Progress that is shown; dropped, it leaves the screen as it was.
#[derive(Debug)]
pub struct Progress {
    meter: Meter,
    stop: Arc<(Mutex<bool>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

impl Progress {
    /// Of reading programs of so many bytes in all, as a rule in so many passes.
    pub fn of_bytes(shape: Shape, name: &str, total: u64, passes: u64) -> Self {
        let name = name.to_owned();
        Self::of(shape, Work::Bytes { name, passes }, total)
    }

    /// Of programs that are limited together, whose lines are counted, as a rule in so many
    /// passes.
    pub fn of_lines(shape: Shape, name: &str, count: LineCount, passes: u64) -> Self {
        let name = name.to_owned();
        let work = Work::Lines {
            name,
            count,
            passes,
        };
        Self::of(shape, work, 1)
    }

    /// Of so many programs.
    pub fn of_programs(shape: Shape, total: usize) -> Self {
        Self::of(shape, Work::Programs, total as u64)
    }

    fn of(shape: Shape, work: Work, total: u64) -> Self {
        let meter = Meter::default();
        let stop = Arc::new((Mutex::new(false), Condvar::new()));
        let mut progress = Self {
            meter: meter.clone(),
            stop: Arc::clone(&stop),
            thread: None,
        };
        let state = State {
            work,
            done: meter,
            total,
        };
        // Without a thread nothing is shown, which does no harm.
        progress.thread = match shape {
            Shape::Nothing => None,
            _ if total == 0 => None,
            Shape::Bar(after) => thread::Builder::new()
                .spawn(move || draw(&state, after, &stop))
                .ok(),
            Shape::Filter => thread::Builder::new()
                .spawn(move || report(&state, &stop))
                .ok(),
        };
        progress
    }

    /// What counts.
    pub fn meter(&self) -> Meter {
        self.meter.clone()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        let (stopped, wake) = &*self.stop;
        *stopped.lock().unwrap_or_else(PoisonError::into_inner) = true;
        wake.notify_all();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Waits for a tick, or less where the work ends; true while it goes on.
fn goes_on(stop: &(Mutex<bool>, Condvar), wait: Duration) -> bool {
    let stopped = stop.0.lock().unwrap_or_else(PoisonError::into_inner);
    let waited = stop
        .1
        .wait_timeout_while(stopped, wait, |stopped| !*stopped);
    !*waited.unwrap_or_else(PoisonError::into_inner).0
}

fn draw(state: &State, after: Duration, stop: &(Mutex<bool>, Condvar)) {
    let begin = Instant::now();
    if !after.is_zero() && !goes_on(stop, after) {
        return;
    }
    let bar = ProgressBar::with_draw_target(Some(state.total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template(BAR).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style.progress_chars("=> "));
    let bar = bar.with_elapsed(begin.elapsed());
    interrupt::before_the_end(clear);
    *shown() = Some(bar);
    loop {
        if let Some(bar) = &*shown() {
            let (message, done, total) = state.line();
            bar.set_message(message);
            bar.set_length(total);
            bar.set_position(done);
            bar.tick();
        }
        if !goes_on(stop, TICK) {
            break;
        }
    }
    if let Some(bar) = shown().take() {
        bar.finish_and_clear();
    }
}

/// As LinuxCNC reads it: a line each, whole numbers. Those that stay the same are not repeated.
fn report(state: &State, stop: &(Mutex<bool>, Condvar)) {
    let say = |percent: u64| {
        let _ = writeln!(io::stderr(), "FILTER_PROGRESS={percent}");
    };
    let mut last = 0;
    say(last);
    while goes_on(stop, TICK) {
        let percent = state.percent();
        if percent > last {
            last = percent;
            say(percent);
        }
    }
    say(100);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(work: Work, total: u64, done: u64) -> State {
        let meter = Meter::default();
        meter.add(done);
        State {
            work,
            done: meter,
            total,
        }
    }

    fn bytes() -> Work {
        Work::Bytes {
            name: "a.nc".to_owned(),
            passes: 4,
        }
    }

    #[test]
    fn passes_are_counted_and_the_end_is_left_to_the_run() {
        let line = |done| state(bytes(), 1000, done).line();
        assert_eq!(line(0), ("a.nc, pass 1".to_owned(), 0, 1000));
        assert_eq!(line(1000), ("a.nc, pass 1".to_owned(), 1000, 1000));
        assert_eq!(line(1001), ("a.nc, pass 2".to_owned(), 1, 1000));
        let percent = |done| state(bytes(), 1000, done).percent();
        assert_eq!(
            [0, 1000, 3999, 4000, 90_000].map(percent),
            [0, 25, 99, 99, 99]
        );
        assert_eq!(state(bytes(), 1000, u64::MAX).percent(), 99);
    }

    #[test]
    fn programs_are_counted() {
        let state = state(Work::Programs, 8, 2);
        assert_eq!(state.line(), ("2 of 8 programs".to_owned(), 2, 8));
        assert_eq!(state.percent(), 25);
    }

    #[test]
    fn a_pass_of_unknown_length_has_no_share() {
        let work = Work::Lines {
            name: "2 programs".to_owned(),
            count: LineCount::default(),
            passes: 5,
        };
        let state = state(work, 1, 0);
        assert_eq!(state.line(), ("2 programs, 0 lines".to_owned(), 0, 1));
        assert_eq!(state.percent(), 0);
    }

    #[test]
    fn quiet_runs_show_what_was_asked_for_alone() {
        let bar = Shape::Bar(SHORT);
        assert_eq!(bar.quiet(true), Shape::Nothing);
        assert_eq!(bar.quiet(false), bar);
        let asked = Shape::Bar(Duration::ZERO);
        assert_eq!(asked.quiet(true), asked);
        assert_eq!(Shape::Filter.quiet(true), Shape::Filter);
    }
}
