//! What the scan's thread and the thread of the requests share, of one server.

use crate::attachments::exchange::Exchange;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often a thread that waits looks whether the run is over.
pub(super) const NAP: Duration = Duration::from_millis(50);

#[derive(Debug)]
pub(super) struct Shared {
    pub exchange: Exchange,
    pub is_over: AtomicBool,
    /// The server does not answer, and that ends the run.
    pub is_fatal: AtomicBool,
    pub account: Mutex<Account>,
}

/// What became of the requests.
#[derive(Clone, Debug, Default)]
pub(super) struct Account {
    pub answered: u64,
    pub failed: u64,
    /// Why the last one was not answered.
    pub trouble: String,
}

impl Shared {
    /// Of a server with so many variables.
    pub fn new(points: usize) -> Self {
        Self {
            exchange: Exchange::new(points),
            is_over: AtomicBool::new(false),
            is_fatal: AtomicBool::new(false),
            account: Mutex::new(Account::default()),
        }
    }

    pub fn account(&self) -> MutexGuard<'_, Account> {
        self.account.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }
}
