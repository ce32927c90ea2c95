//! A Modbus TCP server around a scan: a thread takes connections, and each has a thread of its own, which answers from what the last scan
//! has left. They were started before the scans, so they have no priority, and the scans do not wait for them.

use super::attachment::{Attachment, Ended};
use super::options::AtEnd;
use super::points::Points;
use super::served::Served;
use crate::{Error, Machine};
use std::io::{self, Read as _, Write as _};
use std::net::{Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Connections at a time. For one more, that which has asked for nothing for the longest time is closed.
const MOST_CLIENTS: usize = 8;
/// How long the rest of a request, or the taking of an answer, may take.
const PATIENCE: Duration = Duration::from_secs(5);
/// How often a thread that waits looks whether the run is over.
const NAP: Duration = Duration::from_millis(500);
/// A connection that cannot be taken, as when the process has too many files, is tried again after this.
const AFTER_ERROR: Duration = Duration::from_millis(100);
/// Bytes before a request: a number that the answer repeats, the protocol, which is 0, the length of what follows, and the unit.
const HEADER: usize = 7;
/// Bytes of a client's thread, which a run with a priority has locked.
const STACK: usize = 128 << 10;
/// What the length counts: the unit and the request.
const LENGTHS: std::ops::RangeInclusive<usize> = 2..=254;

#[derive(Debug)]
pub(super) struct Modbus {
    shared: Arc<Shared>,
    at_end: AtEnd,
    address: SocketAddr,
    /// The last request that a scan has seen.
    request: u64,
}

#[derive(Debug)]
struct Shared {
    served: Served,
    clients: Mutex<Vec<Client>>,
}

#[derive(Debug)]
struct Client {
    number: u64,
    stream: TcpStream,
    last: Instant,
}

impl Modbus {
    /// Listens at an address and port; of port 0, the system picks one.
    pub fn start(address: &str, points: &Points, at_end: AtEnd, quiet: bool) -> Result<Self, Error> {
        let refused = |error: io::Error| Error::Usage(refusal(address, &error));
        let listener = TcpListener::bind(address).map_err(refused)?;
        let bound = listener.local_addr().map_err(refused)?;
        // Nobody knows the port otherwise.
        if !quiet || address.ends_with(":0") {
            crate::error::tell(format_args!("note: modbus: listening on {bound}"));
        }
        let shared = Arc::new(Shared { served: Served::new(points), clients: Mutex::new(Vec::new()) });
        let own = Arc::clone(&shared);
        let started = thread::Builder::new().name("modbus".to_owned()).spawn(move || take_clients(&listener, &own));
        started.map_err(refused)?;
        Ok(Self { shared, at_end, address: bound, request: 0 })
    }
}

fn refusal(address: &str, error: &io::Error) -> String {
    let help = match error.kind() {
        io::ErrorKind::PermissionDenied => {
            let name = std::env::current_exe().map_or_else(|_| "FILE".to_owned(), |it| it.display().to_string());
            format!(
                "\n  help: ports below 1024 need a permission: sudo setcap cap_net_bind_service+ep {name}\n  \
                 help: or write another port, as modbus:127.0.0.1:1502"
            )
        }
        io::ErrorKind::AddrInUse => "\n  help: another program listens there: end it, or write another port".to_owned(),
        io::ErrorKind::AddrNotAvailable => {
            "\n  help: the address must be one of this machine: 127.0.0.1 for programs on it, 0.0.0.0 for all"
                .to_owned()
        }
        _ => String::new(),
    };
    format!("cannot listen on {address} (--io modbus): {error}{help}")
}

impl Attachment for Modbus {
    fn before(&mut self, machine: &mut dyn Machine) {
        if let Some(request) = self.shared.served.take(machine) {
            self.request = request;
        }
    }

    fn after(&mut self, state: &[u8]) {
        self.shared.served.show(self.request, state);
    }

    fn end(&mut self, _: Ended) {
        self.shared.served.show_end(self.request, self.at_end);
        self.shared.served.end();
        for client in self.shared.clients().drain(..) {
            let _ = client.stream.shutdown(Shutdown::Both);
        }
        // The thread that takes connections wakes up and ends.
        let mut own = self.address;
        match own {
            SocketAddr::V4(it) if it.ip().is_unspecified() => own.set_ip(Ipv4Addr::LOCALHOST.into()),
            SocketAddr::V6(it) if it.ip().is_unspecified() => own.set_ip(Ipv6Addr::LOCALHOST.into()),
            SocketAddr::V4(_) | SocketAddr::V6(_) => {}
        }
        let _ = TcpStream::connect_timeout(&own, NAP);
    }
}

impl Shared {
    fn clients(&self) -> MutexGuard<'_, Vec<Client>> {
        self.clients.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Room for one more.
    fn enter(&self, number: u64, stream: TcpStream) {
        let mut clients = self.clients();
        if clients.len() >= MOST_CLIENTS {
            let idle = clients.iter().enumerate().min_by_key(|(_, it)| it.last).map(|(at, _)| at);
            let idle = idle.map(|at| clients.swap_remove(at));
            let _ = idle.map(|it| it.stream.shutdown(Shutdown::Both));
        }
        clients.push(Client { number, stream, last: Instant::now() });
    }

    fn leave(&self, number: u64) {
        self.clients().retain(|it| it.number != number);
    }

    /// The answer to a request, both with the header.
    fn answer(&self, number: u64, request: &[u8], answer: &mut Vec<u8>) {
        if let Some(client) = self.clients().iter_mut().find(|it| it.number == number) {
            client.last = Instant::now();
        }
        answer.clear();
        answer.extend_from_slice(&request[..HEADER]);
        self.served.answer(&request[HEADER..], answer);
        let length = (answer.len() - HEADER + 1) as u16;
        answer[4..6].copy_from_slice(&length.to_be_bytes());
    }
}

fn take_clients(listener: &TcpListener, shared: &Arc<Shared>) {
    for number in 0.. {
        let taken = listener.accept();
        if shared.served.is_over() {
            return;
        }
        match taken.and_then(|(stream, _)| Ok((stream.try_clone()?, stream))) {
            Ok((own, stream)) => {
                shared.enter(number, own);
                if begin(shared, number, stream).is_err() {
                    shared.leave(number);
                }
            }
            Err(_) => thread::sleep(AFTER_ERROR),
        }
    }
}

/// A thread for a client.
fn begin(shared: &Arc<Shared>, number: u64, stream: TcpStream) -> io::Result<()> {
    let own = Arc::clone(shared);
    let serving = move || {
        // How it ended is the client's affair.
        let _ = serve(&own, number, stream);
        own.leave(number);
    };
    thread::Builder::new().name("modbus client".to_owned()).stack_size(STACK).spawn(serving).map(drop)
}

/// Answers a client until it disconnects, or sends something that is not a frame.
fn serve(shared: &Shared, number: u64, mut stream: TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(NAP))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let (mut request, mut answer) = ([0; HEADER - 1 + *LENGTHS.end()], Vec::with_capacity(HEADER - 1 + *LENGTHS.end()));
    loop {
        let began = read(shared, &mut stream, &mut request[..1], None)?;
        read(shared, &mut stream, &mut request[1..HEADER], Some(began))?;
        let length = usize::from(u16::from_be_bytes([request[4], request[5]]));
        if request[2..4] != [0, 0] || !LENGTHS.contains(&length) {
            return Ok(());
        }
        let end = HEADER - 1 + length;
        read(shared, &mut stream, &mut request[HEADER..end], Some(began))?;
        while !shared.served.is_shown() && !shared.served.is_over() {
            thread::sleep(Duration::from_millis(1));
        }
        shared.answer(number, &request[..end], &mut answer);
        stream.write_all(&answer)?;
    }
}

/// Fills the buffer, and says when that was. A frame that has begun has to end soon; before one, it may wait.
fn read(shared: &Shared, stream: &mut TcpStream, buffer: &mut [u8], began: Option<Instant>) -> io::Result<Instant> {
    let mut filled = 0;
    while filled < buffer.len() {
        match stream.read(&mut buffer[filled..]) {
            Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => filled += count,
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => {}
                _ => return Err(error),
            },
        }
        if shared.served.is_over() || began.is_some_and(|it| it.elapsed() > PATIENCE) {
            return Err(io::ErrorKind::TimedOut.into());
        }
    }
    Ok(Instant::now())
}
