//! Runs cases side by side, each on one thread, and hands their outcomes over in the order of the list.

use crate::command::stages;
use crate::command::stress::case::{Effort, StressCase};
use crate::error::Result;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Instant;

/// What came of a case.
#[derive(Debug, Clone)]
pub struct StressOutcome {
    /// The case.
    pub case: &'static StressCase,
    /// Its numbers, one for each criterion; or why there are none.
    pub numbers: std::result::Result<Vec<f64>, String>,
    /// How long it took.
    pub seconds: f64,
}

impl StressOutcome {
    /// Every criterion is met.
    #[must_use]
    pub fn passed(&self) -> bool {
        let met = |numbers: &Vec<f64>| {
            numbers.len() == self.case.criteria.len()
                && self.case.criteria.iter().zip(numbers).all(|(criterion, number)| criterion.allowed.holds(*number))
        };
        self.numbers.as_ref().is_ok_and(met)
    }
}

/// Runs them; `done` hears of each as soon as all before it are done, too.
///
/// # Errors
/// Threads cannot be had.
pub fn run(
    cases: &[&'static StressCase],
    effort: Effort,
    threads: usize,
    mut done: impl FnMut(&StressOutcome),
) -> Result<Vec<StressOutcome>> {
    let pools = (0..threads.clamp(1, cases.len().max(1))).map(|_| stages::threads(Some(1)));
    let pools: Vec<_> = pools.collect::<Result<_>>()?;
    let (next, (sender, receiver)) = (AtomicUsize::new(0), mpsc::channel());
    std::thread::scope(|scope| {
        for pool in &pools {
            let (next, sender) = (&next, sender.clone());
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(number) else { break };
                    let outcome = pool.install(|| outcome(case, effort));
                    if sender.send((number, outcome)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let (mut early, mut in_order) = (BTreeMap::new(), Vec::new());
        for (number, outcome) in receiver {
            early.insert(number, outcome);
            while let Some(outcome) = early.remove(&in_order.len()) {
                done(&outcome);
                in_order.push(outcome);
            }
        }
        Ok(in_order)
    })
}

/// Measures one case. A panic of the program is a failure of the case.
fn outcome(case: &'static StressCase, effort: Effort) -> StressOutcome {
    let begun = Instant::now();
    let found = catch_unwind(AssertUnwindSafe(|| (case.measure)(effort).map_err(|reason| reason.to_string())));
    let numbers = found.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned());
        Err(format!("the program panicked: {text}"))
    });
    StressOutcome { case, numbers, seconds: begun.elapsed().as_secs_f64() }
}
