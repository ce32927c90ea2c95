//! Frames as a master sends them, and all others: only a request to the unit, with its CRC, is answered.

use super::*;
use crate::attachments::points::Points;
use crate::fixture::{Bytes, map_with};
use crate::remote::Line;
use std::collections::VecDeque;

const UNIT: u8 = 7;

/// A line on which what is received was written down; an empty piece is silence. At its end, the port is gone.
#[derive(Default)]
struct Script {
    received: VecDeque<Vec<u8>>,
    sent: Vec<Vec<u8>>,
}

impl Port for Script {
    fn send(&mut self, bytes: &[u8], _: Instant) -> io::Result<()> {
        self.sent.push(bytes.to_vec());
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], _: Instant) -> io::Result<usize> {
        let bytes = self.received.pop_front().ok_or(io::ErrorKind::UnexpectedEof)?;
        buffer[..bytes.len()].copy_from_slice(&bytes);
        Ok(bytes.len())
    }
}

/// A server of a program that has ended a scan.
fn served() -> Served {
    let map = map_with(&[
        ("INT", 0, "-", "%IW3"),
        ("INT", 2, "-", "%QW2"),
        ("BOOL", 4, "-", "%IX0.0"),
        ("BOOL", 5, "-", "%QX1.1"),
        ("DINT", 8, "-", "%MD5"),
    ]);
    let served = Served::new(&Points::of(&map));
    let mut machine = Bytes::new(&map);
    machine.state[..12].copy_from_slice(&[1, 2, 3, 4, 1, 0, 0, 0, 5, 6, 7, 8]);
    served.show(0, &machine.state);
    served
}

/// Written for the tests alone.
fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0xFFFF_u16;
    for byte in bytes {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            let low = crc & 1;
            crc >>= 1;
            if low == 1 {
                crc ^= 0xA001;
            }
        }
    }
    crc
}

fn framed(unit: u8, request: &[u8]) -> Vec<u8> {
    let body = [&[unit], request].concat();
    let crc = crc(&body).to_le_bytes();
    [&body[..], &crc].concat()
}

/// What is sent where these pieces are received.
fn sent(pieces: &[&[u8]]) -> (Vec<Vec<u8>>, [u64; 3]) {
    let (served, account) = (served(), Arc::default());
    let port = Script { received: pieces.iter().map(|it| it.to_vec()).collect(), sent: Vec::new() };
    let unit = SerialUnit { line: Line::at("/dev/ttyS0"), unit: UNIT };
    let mut unit = Unit::new(port, &unit, Arc::clone(&account));
    assert_eq!(unit.serve(&served).unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
    let Account { answered, others, damaged } = &*account;
    (unit.port.sent, [answered, others, damaged].map(|it| it.load(Ordering::Relaxed)))
}

const READ: [u8; 5] = [3, 0, 2, 0, 1];
const ANSWER: [u8; 4] = [3, 2, 4, 3];

#[test]
fn a_request_is_answered_after_silence() {
    let (request, answer) = (framed(UNIT, &READ), framed(UNIT, &ANSWER));
    assert_eq!(sent(&[&request, &[]]), (vec![answer.clone()], [1, 0, 0]));
    assert_eq!(sent(&[&request]).0, Vec::<Vec<u8>>::new());
    // An adapter hands the bytes over in two parts.
    assert_eq!(sent(&[&request[..3], &[], &request[3..], &[]]), (vec![answer.clone()], [1, 0, 0]));
    assert_eq!(sent(&[&request[..1], &request[1..], &[], &[], &request, &[]]).0.len(), 2);
    // It has ended early.
    assert_eq!(sent(&[&request[..3], &[], &[], &request, &[]]), (vec![answer], [1, 0, 1]));
    assert_eq!(sent(&[&framed(UNIT, &[99]), &[]]).0, [framed(UNIT, &[99 | 0x80, 1])]);
    assert_eq!(sent(&[&framed(UNIT, &[4, 4, 0, 0, 1]), &[]]).0, [framed(UNIT, &[4 | 0x80, 2])]);
}

#[test]
fn others_are_not_answered() {
    let (request, answer) = (framed(UNIT, &READ), framed(UNIT, &ANSWER));
    let (other, reply) = (framed(8, &READ), framed(8, &[3, 2, 0, 9]));
    assert_eq!(sent(&[&other, &[], &reply, &[], &request, &[]]), (vec![answer.clone()], [1, 2, 0]));
    // All of them came while the thread waited for a processor.
    assert_eq!(sent(&[&other, &reply, &request, &[]]), (vec![answer], [1, 0, 0]));
    // The master has gone on.
    assert_eq!(sent(&[&request, &other, &[]]), (vec![], [0, 1, 0]));
    assert_eq!(sent(&[&request, &[0], &[]]), (vec![], [0, 0, 1]));
    assert_eq!(sent(&[&[0x55], &request, &[]]), (vec![], [0, 0, 1]));
    assert_eq!(sent(&[&framed(0, &READ), &[]]), (vec![], [0, 1, 0]));
}

#[test]
fn a_line_that_is_never_silent_is_no_endless_wait() {
    let noise = [0x55; 200];
    let pieces: Vec<&[u8]> = (0..40).map(|_| &noise[..]).collect();
    let (sent, [_, _, damaged]) = sent(&pieces);
    assert!(sent.is_empty() && damaged > 2, "{damaged}");
}

/// Nothing is sent before a scan has ended: the values are nobody's.
#[test]
fn a_program_that_has_not_run_is_silent() {
    let served = Served::new(&Points::default());
    let port = Script { received: [framed(UNIT, &READ), vec![]].into(), sent: Vec::new() };
    let unit = SerialUnit { line: Line::at("/dev/ttyS0"), unit: UNIT };
    let mut unit = Unit::new(port, &unit, Arc::default());
    unit.serve(&served).unwrap_err();
    assert_eq!(unit.port.sent, Vec::<Vec<u8>>::new());
}

struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }

    fn bytes(&mut self, most: usize) -> Vec<u8> {
        (0..self.below(most)).map(|_| self.byte()).collect()
    }

    /// Also of functions that there are none of, and of numbers where nothing is.
    fn request(&mut self) -> Vec<u8> {
        match self.below(8) {
            0 => [vec![24 + self.byte() % 200], self.bytes(250)].concat(),
            1 => vec![1 + self.byte() % 6, self.byte(), self.byte(), self.byte(), self.byte()],
            _ => self.known(),
        }
    }

    fn known(&mut self) -> Vec<u8> {
        let [place, count] = [16, 4].map(|it| self.below(it) as u8);
        match 1 + self.below(7) {
            1 => vec![5, 0, place, [0, 0xFF][usize::from(count % 2)], 0],
            2 => vec![6, 0, place, self.byte(), self.byte()],
            3 => vec![15, 0, place, 0, 5, 1, self.byte()],
            4 => [vec![16, 8, place, 0, 2, 4], self.bytes(1), vec![self.byte(), 1, 2, self.byte()]].concat(),
            5 => vec![23, 0, place, 0, count, 0, 2, 0, 1, 2, self.byte(), self.byte()],
            _ => vec![1 + self.byte() % 4, 0, place, 0, count],
        }
    }
}

/// What the bytes between two silences are to be: what they are, and the request that is carried out.
type Case = (Vec<u8>, Seen, Option<Vec<u8>>);

fn case(random: &mut Random) -> Case {
    let request = random.request();
    let (own, foreign) = (framed(UNIT, &request), framed(8 + random.byte() % 200, &request));
    match random.below(8) {
        0 => (random.bytes(300), Seen::Damaged, None),
        1 => {
            let mut bytes = own;
            let bit = random.below(8 * bytes.len());
            bytes[bit / 8] ^= 1 << (bit % 8);
            (bytes, Seen::Damaged, None)
        }
        2 => (foreign, Seen::Other, None),
        3 => {
            let is_write = [5, 6, 15, 16].contains(&request[0]);
            (framed(0, &request), Seen::Broadcast, is_write.then_some(request))
        }
        4 => {
            let own = framed(UNIT, &random.known());
            (own[..random.below(own.len())].to_vec(), Seen::Damaged, None)
        }
        // In a long frame, the CRC is now and then right before its end.
        5 => {
            let other = framed(8, &random.known());
            ([other, own].concat(), Seen::Request, Some(request))
        }
        6 => {
            let own = framed(UNIT, &random.known());
            ([own, foreign].concat(), Seen::Other, None)
        }
        _ => (own, Seen::Request, Some(request)),
    }
}

/// A second server carries out what is expected to be: both then have the same values.
#[test]
fn a_hundred_thousand_frames_have_the_answers_that_they_should() {
    let [served, twin] = [(); 2].map(|()| served());
    let mut random = Random(2026);
    let (mut answer, mut answered) = (Vec::new(), 0);
    for number in 0..100_000 {
        let (bytes, expected, request) = case(&mut random);
        let seen = see(&bytes, UNIT, &served, &mut answer);
        assert_eq!(seen, expected, "{number}: {bytes:?}");
        let mut body = vec![UNIT];
        if let Some(request) = &request {
            twin.answer(request, &mut body);
        }
        let due = if seen == Seen::Request { framed(UNIT, &body[1..]) } else { Vec::new() };
        assert_eq!(answer, due, "{number}: {bytes:?}");
        assert!(answer.len() <= MOST, "{number}: {bytes:?}");
        answered += usize::from(!answer.is_empty());
        if number % 1000 == 0 {
            for read in [[3, 0, 0, 0, 20], [3, 8, 0, 0, 40], [1, 0, 0, 0, 40]] {
                let [mut one, mut other] = [Vec::new(), Vec::new()];
                served.answer(&read, &mut one);
                twin.answer(&read, &mut other);
                assert_eq!(one, other, "{number}");
            }
        }
    }
    assert!((20_000..40_000).contains(&answered), "{answered}");
}
