//! Requests and answers of a client, as "MODBUS Messaging on TCP/IP Implementation Guide V1.0b" frames them.

use super::plan::{Kind, Request};
use crate::attachments::pdu::function;
use crate::attachments::registers::Table;
use std::fmt;
use std::io::{self, Read as _, Write as _};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::{Duration, Instant};

/// Bytes before a request: its number, the protocol, which is 0, the length of what follows, and the unit.
const HEADER: usize = 7;
/// The longest frame.
const MOST: usize = 260;

/// A connection.
#[derive(Debug)]
pub(super) struct Wire {
    stream: TcpStream,
    timeout: Duration,
    number: u16,
    frame: Vec<u8>,
}

/// Why a request was not answered.
#[derive(Debug)]
pub(super) enum Trouble {
    /// The server has closed the connection before it answered.
    Closed,
    Failed(String),
    /// The server's code for what is wrong with the request, with what was asked for.
    Refused(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Closed => f.write_str("the connection was closed"),
            Self::Failed(text) | Self::Refused(text) => f.write_str(text),
        }
    }
}

fn failed(error: &io::Error) -> Trouble {
    match error.kind() {
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => Trouble::Failed("no answer in time".to_owned()),
        io::ErrorKind::UnexpectedEof
        | io::ErrorKind::ConnectionReset
        | io::ErrorKind::ConnectionAborted
        | io::ErrorKind::BrokenPipe => Trouble::Closed,
        io::ErrorKind::ConnectionRefused => Trouble::Failed("nobody listens there".to_owned()),
        _ => Trouble::Failed(error.to_string()),
    }
}

impl Wire {
    pub fn connect(server: &str, timeout: Duration) -> Result<Self, Trouble> {
        let mut last = Trouble::Failed("there is no such address".to_owned());
        for address in server.to_socket_addrs().map_err(|it| failed(&it))? {
            let connected = TcpStream::connect_timeout(&address, timeout);
            match connected.and_then(|it| it.set_nodelay(true).and(it.set_write_timeout(Some(timeout))).and(Ok(it))) {
                Ok(stream) => return Ok(Self { stream, timeout, number: 0, frame: Vec::with_capacity(MOST) }),
                Err(error) => last = failed(&error),
            }
        }
        Err(last)
    }

    /// Adds what the server has to the values that are written: each a point, bits, and which these are.
    pub fn read(&mut self, unit: u8, request: &Request, all: &mut Vec<(usize, u64, u64)>) -> Result<(), Trouble> {
        let code = match request.table {
            Table::Coils => function::READ_COILS,
            Table::Discrete => function::READ_DISCRETE_INPUTS,
            Table::Input => function::READ_INPUT_REGISTERS,
            Table::Holding => function::READ_HOLDING_REGISTERS,
        };
        self.begin(unit, code, request.first);
        self.frame.extend(request.count.to_be_bytes());
        let count = usize::from(request.count);
        let bytes = if request.table.is_bits() { count.div_ceil(8) } else { 2 * count };
        let values = match self.exchange(request)? {
            [length, values @ ..] if usize::from(*length) == bytes && values.len() == bytes => values,
            _ => return Err(Trouble::Failed("the answer has another length than was asked for".to_owned())),
        };
        let register = |at: usize| u64::from(u16::from_be_bytes([values[2 * at], values[2 * at + 1]]));
        all.extend(request.parts.iter().map(|it| match it.kind {
            Kind::Coil => (it.point, u64::from(values[it.at / 8] >> (it.at % 8) & 1), u64::MAX),
            Kind::Bit(bit) => (it.point, register(it.at) >> bit & 1, u64::MAX),
            Kind::Register => (it.point, register(it.at) << it.shift, 0xFFFF << it.shift),
        }));
        Ok(())
    }

    /// Writes the values of points. One coil or register is written by the function that every server has.
    pub fn write(&mut self, unit: u8, request: &Request, values: &[u64]) -> Result<(), Trouble> {
        let mut registers = vec![0u16; usize::from(request.count)];
        for it in &request.parts {
            registers[it.at] = (values[it.point] >> it.shift) as u16;
        }
        match (request.table.is_bits(), registers.as_slice()) {
            (true, [one]) => {
                self.begin(unit, function::WRITE_COIL, request.first);
                self.frame.extend(if *one == 0 { [0, 0] } else { [0xFF, 0] });
            }
            (false, [one]) => {
                self.begin(unit, function::WRITE_REGISTER, request.first);
                self.frame.extend(one.to_be_bytes());
            }
            (true, coils) => {
                self.begin(unit, function::WRITE_COILS, request.first);
                self.frame.extend(request.count.to_be_bytes());
                self.frame.push(coils.len().div_ceil(8) as u8);
                let byte = |it: &[u16]| it.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit != 0));
                self.frame.extend(coils.chunks(8).map(byte));
            }
            (false, registers) => {
                self.begin(unit, function::WRITE_REGISTERS, request.first);
                self.frame.extend(request.count.to_be_bytes());
                self.frame.push((2 * registers.len()) as u8);
                self.frame.extend(registers.iter().flat_map(|it| it.to_be_bytes()));
            }
        }
        self.exchange(request).map(drop)
    }

    fn begin(&mut self, unit: u8, code: u8, first: u16) {
        self.number = self.number.wrapping_add(1);
        self.frame.clear();
        self.frame.extend(self.number.to_be_bytes());
        self.frame.extend([0, 0, 0, 0, unit, code]);
        self.frame.extend(first.to_be_bytes());
    }

    /// Sends the request, and returns what follows the function in its answer.
    fn exchange(&mut self, request: &Request) -> Result<&[u8], Trouble> {
        let length = (self.frame.len() - HEADER + 1) as u16;
        self.frame[4..6].copy_from_slice(&length.to_be_bytes());
        let (head, code) = ([self.frame[0], self.frame[1], 0, 0], self.frame[HEADER]);
        let unit = self.frame[HEADER - 1];
        self.stream.write_all(&self.frame).map_err(|it| failed(&it))?;
        let deadline = Instant::now() + self.timeout;
        self.fill(0, HEADER + 1, deadline)?;
        let length = usize::from(u16::from_be_bytes([self.frame[4], self.frame[5]]));
        if self.frame[..4] != head || self.frame[HEADER - 1] != unit || !(3..=MOST - HEADER + 1).contains(&length) {
            return Err(Trouble::Failed("the answer is no answer to the request".to_owned()));
        }
        let end = HEADER - 1 + length;
        self.fill(HEADER + 1, end, deadline)?;
        let rest = &self.frame[HEADER + 1..end];
        match self.frame[HEADER] {
            it if it == code => Ok(rest),
            it if it == code | function::WRONG => Err(Trouble::Refused(refusal(request, rest[0]))),
            _ => Err(Trouble::Failed("the answer is no answer to the request".to_owned())),
        }
    }

    /// Reads the bytes of the frame from `start` to `end`.
    fn fill(&mut self, start: usize, end: usize, deadline: Instant) -> Result<(), Trouble> {
        self.frame.resize(end, 0);
        let mut at = start;
        while at < end {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(failed(&io::ErrorKind::TimedOut.into()));
            }
            self.stream.set_read_timeout(Some(left)).map_err(|it| failed(&it))?;
            match self.stream.read(&mut self.frame[at..end]) {
                Ok(0) => return Err(Trouble::Closed),
                Ok(count) => at += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(failed(&error)),
            }
        }
        Ok(())
    }
}

/// What a server says, in the words of "MODBUS Application Protocol Specification V1.1b3", 7.
fn refusal(request: &Request, code: u8) -> String {
    let meaning = match code {
        1 => "illegal function",
        2 => "illegal data address",
        3 => "illegal data value",
        4 => "server device failure",
        5 => "acknowledge",
        6 => "server device busy",
        10 => "gateway path unavailable",
        11 => "gateway target device failed to respond",
        _ => "an unknown code",
    };
    let last = request.first.saturating_add(request.count - 1);
    format!("the server refuses {} {} to {last}: {meaning} ({code})", request.table.name(), request.first)
}
