//! A unit on a serial line: which bytes are a request to it, and what it sends.
//!
//! Silence divides frames. The line also has requests to other units and their answers. Where the thread was late, and several frames have
//! come without a silence that it saw, each ends where its CRC is right; only one that ends the bytes is answered, because the master does not
//! wait for the answer to another one any more.

use crate::attachments::line::{LEAST, MOST, PAUSE, Port, Timing, close, first_whole, is_whole};
use crate::attachments::options::SerialUnit;
use crate::attachments::pdu::function;
use crate::attachments::served::Served;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How often a unit that waits looks whether the run is over.
const NAP: Duration = Duration::from_millis(50);
/// How long the line may take an answer, in addition to the time of its bytes.
const PATIENCE: Duration = Duration::from_millis(500);
/// More bytes without a silence are noise.
const MOST_TOGETHER: usize = 4 * MOST;
/// Frames that may come together before one that is answered.
const MOST_OTHERS: u8 = 8;
/// Bytes of a CRC.
const CRC: usize = 2;
/// The unit of a request to all units, which none answers.
const BROADCAST: u8 = 0;

/// What became of the frames.
#[derive(Debug, Default)]
pub(super) struct Account {
    pub answered: AtomicU64,
    pub others: AtomicU64,
    pub damaged: AtomicU64,
}

/// What a unit makes of the bytes between two silences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// A request, whose answer is to be sent.
    Request,
    /// A request to all units, which is not answered.
    Broadcast,
    /// A frame of another unit.
    Other,
    /// No frame.
    Damaged,
}

#[derive(Debug)]
pub(super) struct Unit<P> {
    port: P,
    timing: Timing,
    number: u8,
    /// What has come since the last silence.
    bytes: Vec<u8>,
    answer: Vec<u8>,
    account: Arc<Account>,
}

impl<P: Port> Unit<P> {
    pub fn new(port: P, unit: &SerialUnit, account: Arc<Account>) -> Self {
        let (bytes, answer) = (Vec::with_capacity(MOST_TOGETHER + MOST), Vec::with_capacity(MOST));
        Self { port, timing: Timing::of(&unit.line), number: unit.unit, bytes, answer, account }
    }

    /// Answers requests until the run is over. An error is one of the port.
    pub fn serve(&mut self, served: &Served) -> io::Result<()> {
        while !served.is_over() {
            self.receive()?;
            // Before the first scan has ended, nothing has been decided.
            if self.bytes.is_empty() || !served.is_shown() {
                continue;
            }
            let seen = see(&self.bytes, self.number, served, &mut self.answer);
            let counted = match seen {
                Seen::Request => &self.account.answered,
                Seen::Broadcast | Seen::Other => &self.account.others,
                Seen::Damaged => &self.account.damaged,
            };
            counted.fetch_add(1, Ordering::Relaxed);
            if seen == Seen::Request {
                let on_line = self.timing.character * self.answer.len() as u32;
                self.port.send(&self.answer, Instant::now() + on_line + PATIENCE)?;
            }
        }
        Ok(())
    }

    /// Takes bytes until the line is silent. A request that has begun may have a longer pause.
    fn receive(&mut self) -> io::Result<()> {
        self.bytes.clear();
        let (mut last, mut may_pause) = (Instant::now(), false);
        loop {
            let patience = match (self.bytes.is_empty(), may_pause) {
                (true, _) => NAP,
                (false, true) => PAUSE,
                (false, false) => self.timing.silence,
            };
            let mut bytes = [0; MOST];
            let count = self.port.receive(&mut bytes, last + patience)?;
            if count > 0 {
                self.bytes.extend(&bytes[..count]);
                (last, may_pause) = (Instant::now(), false);
                if self.bytes.len() > MOST_TOGETHER {
                    return Ok(());
                }
            } else if may_pause || !is_begun(&self.bytes, self.number) {
                return Ok(());
            } else {
                may_pause = true;
            }
        }
    }
}

/// Whether bytes are the beginning of a request to the unit.
fn is_begun(bytes: &[u8], unit: u8) -> bool {
    is_own(bytes, unit) && length(bytes).is_some_and(|it| bytes.len() < it)
}

/// How long the frame of a request is, as far as its beginning shows; `None` for a function that no request has.
fn length(frame: &[u8]) -> Option<usize> {
    const HEAD: usize = 6;
    let counted = |at: usize| at + 1 + frame.get(at).map_or(0, |it| usize::from(*it)) + 2;
    match frame.get(1) {
        None => Some(LEAST),
        Some(1..=6) => Some(HEAD + 2),
        Some(&(function::WRITE_COILS | function::WRITE_REGISTERS)) => Some(counted(HEAD)),
        Some(&function::WRITE_AND_READ_REGISTERS) => Some(counted(HEAD + 4)),
        Some(_) => None,
    }
}

/// Carries out the request that the bytes between two silences end with, if it is one to the unit or to all. Its answer is a frame.
pub(super) fn see(bytes: &[u8], unit: u8, served: &Served, answer: &mut Vec<u8>) -> Seen {
    answer.clear();
    let frame = last_frame(bytes, unit, MOST_OTHERS);
    let Some((to, request)) = frame.and_then(|it| Some((*it.first()?, it.get(1..it.len() - CRC)?))) else {
        return Seen::Damaged;
    };
    match to {
        BROADCAST => {
            if request.first().is_some_and(|it| is_write(*it)) {
                served.answer(request, answer);
                answer.clear();
            }
            Seen::Broadcast
        }
        it if it == unit => {
            answer.push(unit);
            served.answer(request, answer);
            close(answer);
            Seen::Request
        }
        _ => Seen::Other,
    }
}

/// Whether a request to all units may have the function: nobody answers it.
fn is_write(code: u8) -> bool {
    matches!(code, function::WRITE_COIL | function::WRITE_REGISTER | function::WRITE_COILS | function::WRITE_REGISTERS)
}

/// The frame that ends the bytes, which has a few others before it.
fn last_frame(bytes: &[u8], unit: u8, others: u8) -> Option<&[u8]> {
    if is_frame(bytes, unit) {
        return Some(bytes);
    }
    let (end, others) = (first_whole(bytes)?, others.checked_sub(1)?);
    // Where the last bytes of a CRC are 0, the frame seems to end before them.
    let zeros = bytes[end..].iter().take(CRC).take_while(|it| **it == 0).count();
    (end..=end + zeros).find_map(|end| last_frame(bytes.get(end..)?, unit, others))
}

/// Whether bytes are a frame. A request to the unit is as long as it should be: zeros after a frame do not change that its CRC is right.
fn is_frame(bytes: &[u8], unit: u8) -> bool {
    is_whole(bytes) && (!is_own(bytes, unit) || length(bytes).is_none_or(|it| it == bytes.len()))
}

fn is_own(bytes: &[u8], unit: u8) -> bool {
    bytes.first().is_some_and(|it| [BROADCAST, unit].contains(it))
}

#[cfg(test)]
mod tests;
