//! Progress of a run on standard error: a bar on a terminal, a line for each finished stage elsewhere.

use crate::output::{Failure, remark};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Redrawing of the bar.
const TICK: Duration = Duration::from_millis(100);

pub(crate) struct Progress {
    quiet: bool,
    bar: ProgressBar,
    start: Instant,
    stages: u64,
}

impl Progress {
    pub(crate) fn new(stages: u64, quiet: bool) -> Self {
        let target = if quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(stages), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:28} {pos}/{len}  {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(TICK);
        Self {
            quiet,
            bar,
            start: Instant::now(),
            stages,
        }
    }

    /// Does the work of a stage, and says what it took.
    pub(crate) fn stage<T>(
        &mut self,
        name: &str,
        work: impl FnOnce(&Self) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let start = Instant::now();
        self.now(name);
        let done = match work(self) {
            Ok(done) => done,
            Err(error) => {
                self.bar.finish_and_clear();
                return Err(error);
            }
        };
        self.bar.inc(1);
        if !self.quiet {
            let line = format!(
                "[{}/{}] {name:<24} {:>8.3} s",
                self.bar.position(),
                self.stages,
                start.elapsed().as_secs_f64()
            );
            // The bar stays below the lines.
            self.bar.suspend(|| remark(&line));
        }
        Ok(done)
    }

    /// What is being done.
    pub(crate) fn now(&self, name: &str) {
        self.bar.set_message(name.to_owned());
    }

    /// Takes the bar away; what all stages took together \[s\].
    pub(crate) fn finish(&self) -> f64 {
        self.bar.finish_and_clear();
        self.start.elapsed().as_secs_f64()
    }
}
