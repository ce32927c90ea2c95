//! Frames of "MODBUS Messaging on TCP/IP Implementation Guide V1.0b".

use super::trouble::Trouble;
use std::io::{self, Read as _, Write as _};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::{Duration, Instant};

/// Bytes before a request: its number, the protocol, which is 0, the length of what follows, and the unit.
const HEADER: usize = 7;
/// The longest frame.
const MOST: usize = 260;

#[derive(Debug)]
pub(super) struct Tcp {
    stream: TcpStream,
    timeout: Duration,
    number: u16,
    frame: Vec<u8>,
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

impl Tcp {
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

    pub fn exchange(&mut self, unit: u8, request: &[u8], answer: &mut Vec<u8>) -> Result<(), Trouble> {
        self.number = self.number.wrapping_add(1);
        let ([high, low], length) = (self.number.to_be_bytes(), (request.len() + 1) as u16);
        let head = [high, low, 0, 0];
        self.frame.clear();
        self.frame.extend(head);
        self.frame.extend(length.to_be_bytes());
        self.frame.push(unit);
        self.frame.extend(request);
        self.stream.write_all(&self.frame).map_err(|it| failed(&it))?;
        let deadline = Instant::now() + self.timeout;
        self.fill(0, HEADER + 1, deadline)?;
        let length = usize::from(u16::from_be_bytes([self.frame[4], self.frame[5]]));
        if self.frame[..4] != head || self.frame[HEADER - 1] != unit || !(3..=MOST - HEADER + 1).contains(&length) {
            return Err(Trouble::Failed("the answer does not fit the request".to_owned()));
        }
        let end = HEADER - 1 + length;
        self.fill(HEADER + 1, end, deadline)?;
        answer.extend(&self.frame[HEADER..end]);
        Ok(())
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
