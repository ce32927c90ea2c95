//! Requests of Modbus RTU and their answers.
//!
//! No number connects an answer with its request. So what comes before a request is sent is dropped, the line is silent then, and an
//! answer counts only if its unit, function, length and CRC are those that are expected; one to a write repeats what was written, too.

use super::trouble::Trouble;
use crate::attachments::line::{MOST, PAUSE, Port, Timing, close, is_whole};
use crate::attachments::pdu::function;
use crate::remote::Line;
use std::io;
use std::time::{Duration, Instant};

#[derive(Debug)]
pub(super) struct Rtu<P> {
    port: P,
    timing: Timing,
    /// When the last byte was on the line.
    last: Instant,
    frame: Vec<u8>,
}

/// What is expected of an answer.
struct Expected<'r> {
    unit: u8,
    request: &'r [u8],
    /// Of the frame.
    length: usize,
}

/// What the bytes so far are.
enum Seen {
    /// They may be the beginning of the answer.
    Part,
    /// A frame of the answer's length, which begins as it does.
    Whole(usize),
    /// Nothing that begins as the answer does.
    Other,
}

fn gone(_: io::Error) -> Trouble {
    Trouble::Closed
}

fn unanswered(text: impl Into<String>) -> Trouble {
    Trouble::Unanswered(text.into())
}

fn damaged(text: impl Into<String>) -> Trouble {
    Trouble::Damaged(text.into())
}

impl<P: Port> Rtu<P> {
    pub fn new(port: P, line: &Line) -> Self {
        Self { port, timing: Timing::of(line), last: Instant::now(), frame: Vec::with_capacity(2 * MOST) }
    }

    /// Sends a request to a unit, and appends its answer. The timeout is the unit's: what the bytes take on the line is added.
    pub fn exchange(
        &mut self,
        unit: u8,
        timeout: Duration,
        request: &[u8],
        answer: &mut Vec<u8>,
    ) -> Result<(), Trouble> {
        let Timing { character, silence } = self.timing;
        self.settle(self.last + silence, silence, Instant::now() + timeout)?;
        self.frame.clear();
        self.frame.push(unit);
        self.frame.extend(request);
        close(&mut self.frame);
        let expected = Expected { unit, request, length: 1 + answer_length(request) + 2 };
        let on_line = character * (self.frame.len() + expected.length) as u32;
        let deadline = Instant::now() + timeout + on_line;
        self.port.send(&self.frame, deadline).map_err(gone)?;
        let received = self.answer(&expected, deadline);
        self.last = Instant::now();
        let length = match received {
            Ok(it) => it,
            Err(Trouble::Closed) => return Err(Trouble::Closed),
            Err(trouble) => {
                // The answer may still come: the next request is made when its time is over, so that it is not taken for that one's.
                self.settle(deadline.max(self.last + PAUSE), PAUSE, deadline + timeout)?;
                return Err(trouble);
            }
        };
        answer.extend(&self.frame[1..length - 2]);
        Ok(())
    }

    /// Drops what comes until then, and longer, until the line has been silent.
    fn settle(&mut self, until: Instant, silence: Duration, limit: Instant) -> Result<(), Trouble> {
        let mut dropped = [0; MOST];
        while self.port.receive(&mut dropped, until.max(self.last + silence)).map_err(gone)? > 0 {
            self.last = Instant::now();
            if self.last > limit {
                return Err(unanswered("the line is never silent"));
            }
        }
        Ok(())
    }

    /// Receives the answer, and returns how long its frame is.
    fn answer(&mut self, expected: &Expected<'_>, deadline: Instant) -> Result<usize, Trouble> {
        self.frame.clear();
        let mut stranger = None;
        loop {
            if !self.more(deadline)? {
                return Err(match (self.frame.len(), stranger) {
                    (0, None) => unanswered("no answer in time"),
                    (0, Some(other)) => unanswered(format!("no answer in time, but one of unit {other}")),
                    (length, _) => damaged(format!("the answer ends after {length} of {} bytes", expected.length)),
                });
            }
            match expected.see(&self.frame) {
                Seen::Part => {}
                Seen::Whole(length) => return expected.check(&self.frame, length),
                Seen::Other => {
                    while self.frame.len() < MOST && self.more(deadline)? {}
                    // Another unit may be late with its answer: the right one is still on its way (2.4.1).
                    stranger = Some(expected.stranger(&self.frame)?);
                    self.frame.clear();
                }
            }
        }
    }

    /// Adds bytes to the frame. One that has begun is over after a pause.
    fn more(&mut self, deadline: Instant) -> Result<bool, Trouble> {
        let mut bytes = [0; MOST];
        let until = if self.frame.is_empty() { deadline } else { deadline.min(Instant::now() + PAUSE) };
        let count = self.port.receive(&mut bytes, until).map_err(gone)?;
        self.frame.extend(&bytes[..count]);
        Ok(count > 0)
    }
}

impl Expected<'_> {
    fn see(&self, frame: &[u8]) -> Seen {
        let code = self.request[0];
        let length = match frame {
            [unit] if *unit == self.unit => return Seen::Part,
            [unit, it, ..] if *unit == self.unit && *it == code => self.length,
            // The unit, the function, what is wrong, and the CRC.
            [unit, it, ..] if *unit == self.unit && *it == code | function::WRONG => 5,
            _ => return Seen::Other,
        };
        if frame.len() < length { Seen::Part } else { Seen::Whole(length) }
    }

    /// Whether a frame that is long enough is the answer: then, its length.
    fn check(&self, frame: &[u8], length: usize) -> Result<usize, Trouble> {
        // Zeros after a frame do not change that its CRC is right: the shorter one is tried first.
        if frame.len() > length {
            return Err(match is_whole(frame) && !is_whole(&frame[..length]) {
                true => unanswered("the answer has another length than was asked for"),
                false => damaged("there are bytes after the answer"),
            });
        }
        if !is_whole(frame) {
            return Err(damaged("the CRC of the answer is wrong"));
        }
        let body = &frame[2..length - 2];
        let is_expected = match frame[1] {
            it if it != self.request[0] => true,
            function::READ_COILS
            | function::READ_DISCRETE_INPUTS
            | function::READ_HOLDING_REGISTERS
            | function::READ_INPUT_REGISTERS => usize::from(body[0]) == body.len() - 1,
            // A write is answered by its place, and its value or count.
            _ => *body == self.request[1..5],
        };
        if is_expected { Ok(length) } else { Err(unanswered("the answer does not fit the request")) }
    }

    /// The unit whose frame this is, if it is another one.
    fn stranger(&self, frame: &[u8]) -> Result<u8, Trouble> {
        match is_whole(frame) {
            true if frame[0] != self.unit => Ok(frame[0]),
            true => Err(unanswered(format!("the answer is for function {}, not {}", frame[1], self.request[0]))),
            false => Err(damaged("bytes on the line do not form a frame")),
        }
    }
}

/// Bytes of the answer that is expected, with its function.
fn answer_length(request: &[u8]) -> usize {
    let count = || usize::from(u16::from_be_bytes([request[3], request[4]]));
    match request[0] {
        function::READ_COILS | function::READ_DISCRETE_INPUTS => 2 + count().div_ceil(8),
        function::READ_HOLDING_REGISTERS | function::READ_INPUT_REGISTERS => 2 + 2 * count(),
        _ => 5,
    }
}

#[cfg(test)]
mod tests;
