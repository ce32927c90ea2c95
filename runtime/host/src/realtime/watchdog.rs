//! Sees from a thread of its own whether scans still end, and says so to those who watch the process: systemd, a device.

use super::system::{take_priority, time};
use std::fs::File;
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Devices expect a sign of life within a minute, some within ten seconds.
const DEVICE_LIMIT: Duration = Duration::from_secs(4);
const SHORTEST: Duration = Duration::from_millis(1);
/// The exit code of a fault.
const FAULT: i32 = 3;

#[derive(Default)]
struct Shared {
    /// Whole scans so far.
    scans: AtomicU64,
    is_done: AtomicBool,
}

pub(super) struct Watchdog {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Watch {
    shared: Arc<Shared>,
    /// How long no scan may end before the process does.
    limit: Option<Duration>,
    device: Option<File>,
    manager: Option<Manager>,
    period: Duration,
}

impl Watchdog {
    /// `None` where nobody watches.
    pub fn start(limit: Option<Duration>, device: Option<&Path>, priority: Option<u8>) -> io::Result<Option<Self>> {
        let device = device.map(|it| File::options().write(true).open(it)).transpose()?;
        let manager = Manager::find();
        let limits = [limit, device.as_ref().map(|_| DEVICE_LIMIT), manager.as_ref().and_then(|it| it.limit)];
        let Some(shortest) = limits.into_iter().flatten().min() else {
            // This answers those that only wait for its start.
            manager.iter().for_each(|it| it.tell("READY=1"));
            return Ok(None);
        };
        let shared = Arc::new(Shared::default());
        let period = (shortest / 4).max(SHORTEST);
        let watch = Watch { shared: shared.clone(), limit, device, manager, period };
        let thread = std::thread::Builder::new().name("watchdog".to_owned()).spawn(move || {
            let higher = priority.map(|it| it.saturating_add(1));
            if let Some(Err(error)) = higher.map(take_priority) {
                warn(higher.unwrap_or_default(), &error);
            }
            watch.run();
        })?;
        Ok(Some(Self { shared, thread: Some(thread) }))
    }

    /// A whole scan has ended.
    #[inline]
    pub fn pet(&self) {
        self.shared.scans.fetch_add(1, Ordering::Relaxed);
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.shared.is_done.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            let _ = thread.join();
        }
    }
}

impl Watch {
    fn run(mut self) {
        self.tell("READY=1");
        let (mut seen, mut since) = (0, time());
        while !self.shared.is_done.load(Ordering::Relaxed) {
            std::thread::park_timeout(self.period);
            let scans = self.shared.scans.load(Ordering::Relaxed);
            if scans != seen {
                (seen, since) = (scans, time());
                self.tell("WATCHDOG=1");
                let _ = self.device.as_mut().map(|it| it.write_all(b"1"));
            } else if let Some(limit) = self.limit.filter(|it| time() - since > *it) {
                end(limit);
            }
        }
        self.tell("STOPPING=1");
        // A device that reads this does not restart the machine when it is closed.
        let _ = self.device.as_mut().map(|it| it.write_all(b"V"));
    }

    fn tell(&self, state: &str) {
        self.manager.iter().for_each(|it| it.tell(state));
    }
}

/// The scans' own priority was taken, so a limit is one too low for this thread.
fn warn(priority: u8, error: &io::Error) {
    let text = format!(
        "warning: watchdog: it has no priority above that of the scans, so it cannot end a program whose scan does not: {error}\nhelp: allow priority {priority} as well: `ulimit -r {priority}`, or `LimitRTPRIO={priority}` in a unit of systemd\n"
    );
    let _ = io::stderr().write_all(text.as_bytes());
}

/// The scans may hold any lock: nothing is waited for, and nothing runs at the end.
fn end(limit: Duration) -> ! {
    unsafe extern "C" {
        fn _exit(code: i32) -> !;
    }
    let text = format!("error: watchdog: no scan has ended for {}\n", crate::spoken::rounded(limit));
    crate::attachments::emergency::stop();
    let _ = io::stderr().write_all(text.as_bytes());
    // SAFETY: it takes any number.
    unsafe { _exit(FAULT) }
}

/// A service manager that wants to know how the process is: the protocol of `sd_notify(3)`.
struct Manager {
    #[cfg(target_os = "linux")]
    socket: std::os::unix::net::UnixDatagram,
    /// How long it waits for a sign of life.
    limit: Option<Duration>,
}

#[cfg(target_os = "linux")]
impl Manager {
    fn find() -> Option<Self> {
        use std::os::linux::net::SocketAddrExt as _;
        use std::os::unix::ffi::OsStrExt as _;
        use std::os::unix::net::{SocketAddr, UnixDatagram};
        let name = std::env::var_os("NOTIFY_SOCKET")?;
        let address = match name.as_bytes() {
            [b'@', rest @ ..] => SocketAddr::from_abstract_name(rest).ok()?,
            _ => SocketAddr::from_pathname(&name).ok()?,
        };
        let socket = UnixDatagram::unbound().ok()?;
        socket.connect_addr(&address).ok()?;
        let number = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
        let is_own = number("WATCHDOG_PID").is_none_or(|it| it == u64::from(std::process::id()));
        let limit = number("WATCHDOG_USEC").filter(|it| is_own && *it > 0).map(Duration::from_micros);
        Some(Self { socket, limit })
    }

    fn tell(&self, state: &str) {
        let _ = self.socket.send(state.as_bytes());
    }
}

#[cfg(not(target_os = "linux"))]
impl Manager {
    fn find() -> Option<Self> {
        None
    }

    fn tell(&self, _: &str) {}
}
