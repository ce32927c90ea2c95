//! Independent work on as many threads as there are processors, with results in the order of the work.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Of each thread, as of the command's own: nested text is read by recursion.
const STACK: usize = 256 << 20;

/// More threads would wait for memory.
const MOST: usize = 8;

/// The results of `work` for each number below `count`. The caller's thread works, too, and does all where no other can be had.
pub(crate) fn each<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let take = || {
        let numbers = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|it| *it < count));
        numbers.map(|it| (it, work(it))).collect::<Vec<_>>()
    };
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
            assert_eq!(each(count, |it| it * it), (0..count).map(|it| it * it).collect::<Vec<_>>());
        }
    }
}
