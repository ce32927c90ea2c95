//! Independent work on as many threads as there are processors, with results in the order of the work.

use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Of each thread, as of the command's own: what is nested is worked on by recursion.
const STACK: usize = 256 << 20;

/// More threads would wait for memory.
const MOST: usize = 8;

/// The results of `work` for each item. The caller's thread works, too, and does all where no other can be had.
pub fn each<I: Send, T: Send>(items: Vec<I>, work: impl Fn(I) -> T + Sync) -> Vec<T> {
    let count = items.len();
    let waiting = Mutex::new(items.into_iter().enumerate());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let take = || std::iter::from_fn(next).map(|(at, item)| (at, work(item))).collect::<Vec<_>>();
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(MOST).min(count);
    let mut done = thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK).spawn_scoped(scope, take).ok();
        let others: Vec<_> = (1..threads).filter_map(start).collect();
        let mut done = take();
        for it in others {
            match it.join() {
                Ok(more) => done.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    done.sort_by_key(|it| it.0);
    done.into_iter().map(|it| it.1).collect()
}

#[cfg(test)]
mod tests {
    use super::each;

    #[test]
    fn results_are_in_the_order_of_the_work() {
        for count in [0, 1, 2, 1000] {
            assert_eq!(each((0..count).collect(), |it: u32| it * it), (0..count).map(|it| it * it).collect::<Vec<_>>());
        }
    }
}
