//! Work on several threads, with its results in the order of the work.

use crate::STACK;
use std::sync::mpsc;
use std::thread;

/// How many threads work where nobody asks for a number.
pub fn processors() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// What one thread of `of` does: every `of`th piece from `thread` on.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    pub thread: usize,
    pub of: usize,
}

impl Share {
    pub fn has(self, piece: usize) -> bool {
        piece % self.of == self.thread
    }
}

/// Does `pieces` pieces of work on at most `threads` threads, each of which has a worker of its own, and hands
/// the results to `each` in the order of the pieces, as soon as those before are done.
pub fn in_order<W, R: Send>(
    threads: usize,
    pieces: usize,
    worker: impl Fn(Share) -> Result<W, String> + Sync,
    work: impl Fn(&mut W, usize) -> Result<R, String> + Sync,
    mut each: impl FnMut(usize, R) -> Result<(), String>,
) -> Result<(), String> {
    let of = threads.clamp(1, pieces.max(1));
    let (worker, work) = (&worker, &work);
    thread::scope(|scope| {
        let mut shares = Vec::new();
        for thread in 0..of {
            let (done, results) = mpsc::channel();
            let share = Share { thread, of };
            let run = move || {
                let mut worker = match worker(share) {
                    Ok(worker) => worker,
                    Err(error) => return drop(done.send(Err(error))),
                };
                for piece in (thread..pieces).step_by(of) {
                    // Nobody listens where the results before this one ended the work.
                    if done.send(work(&mut worker, piece)).is_err() {
                        return;
                    }
                }
            };
            let started = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, run);
            started.map_err(|error| format!("cannot start a thread: {error}"))?;
            shares.push(results);
        }
        for piece in 0..pieces {
            let result = shares[piece % of].recv().map_err(|_| "a thread ended early".to_owned())?;
            each(piece, result?)?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whoever_is_first() {
        for threads in [1, 3, 8, 100] {
            let mut seen = Vec::new();
            let work = |_: &mut (), piece: usize| {
                thread::sleep(std::time::Duration::from_micros(u64::try_from(40 - piece).unwrap_or(0) * 20));
                Ok(piece * piece)
            };
            let each = |piece, result| {
                seen.push((piece, result));
                Ok(())
            };
            assert_eq!(in_order(threads, 40, |_| Ok(()), work, each), Ok(()));
            assert_eq!(seen, (0..40).map(|it| (it, it * it)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_error_in_order_ends_the_work() {
        let work = |_: &mut (), piece: usize| if piece >= 5 { Err(format!("{piece}")) } else { Ok(()) };
        let mut seen = 0;
        let each = |_, ()| {
            seen += 1;
            Ok(())
        };
        assert_eq!(in_order(4, 40, |_| Ok(()), work, each), Err("5".to_owned()));
        assert_eq!(seen, 5);
        assert_eq!(
            in_order(4, 40, |_| Err::<(), _>("no worker".to_owned()), work, |_, ()| Ok(())),
            Err("no worker".to_owned())
        );
    }
}
