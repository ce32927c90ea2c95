//! Inputs and outputs of a running program: what connects the variables at addresses (`%IX0.0`) with the world outside.
//!
//! An attachment works around each scan: [`before`](Attachment::before) writes inputs into the state,
//! [`after`](Attachment::after) shows the state's outputs outside. Between the two the program works on a state that nobody else sees, so the
//! image is frozen, and what is shown is of one whole scan. Both run in the scan's thread: they copy bytes, and neither allocate nor wait.
//! Whoever talks to a network does so in a thread of its own (`exchange` has what the two threads share).

mod attachment;
mod client;
pub(crate) mod emergency;
mod exchange;
mod gpio;
mod image;
mod line;
mod options;
mod pdu;
mod points;
mod registers;
mod rtu_server;
mod safe;
mod served;
mod server;
mod shared_memory;

#[cfg(target_os = "linux")]
mod mapping;
#[cfg(not(target_os = "linux"))]
#[path = "attachments/no_mapping.rs"]
mod mapping;

pub(crate) use attachment::Ended;
pub use client::{Mistake, check_remotes, openplc_layout};
pub use gpio::check_pins;
pub use options::{AtEnd, Connection, Io, SerialUnit, is_address_and_port};
pub use safe::check_safe;

use crate::map::Map;
use crate::{Error, Machine};
use attachment::Attachment;
use client::Client;
use gpio::Gpio;
use rtu_server::RtuServer;
use server::Modbus;
use shared_memory::SharedMemory;

/// All attachments of a run, in their order.
pub(crate) struct Attachments(Vec<Box<dyn Attachment>>);

impl Attachments {
    /// Connects a program, whose state is that before the first scan. `quiet` keeps notes back.
    pub fn start(map: &Map, io: &Io, state: &[u8], quiet: bool) -> Result<Self, Error> {
        if io.connections.len() > Connection::MOST {
            return Err(Error::Usage(format!("--io: a run has up to {} connections", Connection::MOST)));
        }
        check_safe(map).map_err(|(at, text)| Error::Usage(format!("safe: {}: {text}", map.safe[at].0)))?;
        let points = safe::points_of(map);
        let mut all: Vec<Box<dyn Attachment>> = Vec::new();
        for connection in &io.connections {
            all.push(match connection {
                Connection::SharedMemory(name) => Box::new(SharedMemory::start(name, &points, io.at_end, state)?),
                Connection::Modbus(address) => Box::new(Modbus::start(address, &points, io.at_end, quiet)?),
                Connection::ModbusRtu(unit) => Box::new(RtuServer::start(unit, &points, io.at_end, quiet)?),
            });
            let without = match connection {
                Connection::SharedMemory(_) => points.without_place(|_| true),
                Connection::Modbus(_) | Connection::ModbusRtu(_) => {
                    points.without_place(|it| registers::place(it).is_some())
                }
            };
            if let Some(names) = without.filter(|_| !quiet) {
                crate::error::tell(format_args!("note: {connection} has no place for {names}"));
            }
        }
        for client in Client::start_all(map, &points, io.at_end, quiet)? {
            all.push(Box::new(client));
        }
        if let Some(gpio) = Gpio::start(map, &points, io.at_end)? {
            all.push(Box::new(gpio));
        }
        Ok(Self(all))
    }

    /// An error where something is lost that the run must not continue without.
    pub fn before(&mut self, machine: &mut dyn Machine) -> Result<(), Error> {
        self.0.iter_mut().for_each(|it| it.before(machine));
        self.0.iter().find_map(|it| it.lost()).map_or(Ok(()), Err)
    }

    pub fn after(&mut self, state: &[u8]) {
        self.0.iter_mut().for_each(|it| it.after(state));
    }

    pub fn end(&mut self, ended: Ended) {
        self.0.iter_mut().for_each(|it| it.end(ended));
    }
}

/// What fuzzers hold a Modbus server to: each request has an answer of its function, that fits into a frame; and a frame ends where it is whole.
#[cfg(fuzzing)]
pub(crate) fn answered(map: &Map, bytes: &[u8]) {
    let points = points::Points::of(map);
    let exchange = exchange::Exchange::new(points.all.len());
    let mut registers = registers::Registers::new(&points.all);
    let mut rest = bytes;
    while let Some((length, after)) = rest.split_first() {
        let (request, after) = after.split_at(usize::from(*length).min(after.len()));
        rest = after;
        let mut answer = Vec::new();
        registers.update(&exchange);
        pdu::answer(request, &mut registers, &mut answer);
        registers.hand_over(&exchange);
        let function = request.first().copied().unwrap_or(0);
        assert!(answer.len() <= 253 && (answer[0] == function || answer[0] == function | 0x80));
        let end = line::first_whole(request);
        assert!(end.is_none_or(|it| line::is_whole(&request[..it])));
    }
}
