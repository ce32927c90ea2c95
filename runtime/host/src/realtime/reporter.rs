//! Prints figures while the program runs, in a thread of its own: the scans do not wait for it.

use super::figures::Figures;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Thread;

/// What is to be printed, and whether it is new.
struct Wanted {
    figures: Figures,
    is_new: bool,
}

pub(super) struct Reporter {
    wanted: Arc<Mutex<Wanted>>,
    thread: Thread,
}

impl Reporter {
    /// `line` makes what is printed on standard error.
    pub fn start(figures: &Figures, line: fn(&Figures) -> String) -> std::io::Result<Self> {
        let wanted = Arc::new(Mutex::new(Wanted { figures: figures.clone(), is_new: false }));
        let own = wanted.clone();
        let name = "report".to_owned();
        let thread = std::thread::Builder::new().name(name).spawn(move || {
            loop {
                std::thread::park();
                let mut wanted = own.lock().unwrap_or_else(PoisonError::into_inner);
                if std::mem::take(&mut wanted.is_new) {
                    crate::error::tell(line(&wanted.figures).trim_end());
                }
            }
        })?;
        Ok(Self { wanted, thread: thread.thread().clone() })
    }

    /// Has the figures printed. `false` while others are being printed: nothing is waited for.
    pub fn print(&self, figures: &Figures) -> bool {
        let Ok(mut wanted) = self.wanted.try_lock() else { return false };
        wanted.figures.copy_from(figures);
        wanted.is_new = true;
        drop(wanted);
        self.thread.unpark();
        true
    }
}
