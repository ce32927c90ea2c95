//! Answers as they should be, and all others: no wrong value, and the next request is as good as the first.

use super::*;
use crate::remote::Parity;
use std::collections::VecDeque;

/// A line on which what is to be received was written down. Silence takes no time.
#[derive(Default)]
struct Script {
    sent: Vec<Vec<u8>>,
    /// For each request, the pieces that follow it; an empty one is silence.
    answers: VecDeque<Vec<Vec<u8>>>,
    received: VecDeque<Vec<u8>>,
}

impl Port for Script {
    fn send(&mut self, bytes: &[u8], _: Instant) -> io::Result<()> {
        self.sent.push(bytes.to_vec());
        self.received.extend(self.answers.pop_front().unwrap_or_default());
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], _: Instant) -> io::Result<usize> {
        let bytes = self.received.pop_front().unwrap_or_default();
        buffer[..bytes.len()].copy_from_slice(&bytes);
        Ok(bytes.len())
    }
}

fn line(baud_rate: u32, parity: Parity) -> Line {
    Line { port: "/dev/ttyS0".to_owned(), baud_rate, parity, stop_bits: 1 }
}

fn rtu() -> Rtu<Script> {
    Rtu::new(Script::default(), &line(115_200, Parity::Even))
}

fn framed(body: &[u8]) -> Vec<u8> {
    let mut frame = body.to_vec();
    close(&mut frame);
    frame
}

/// What unit 7 answers to a read of two holding registers from number 16 on, where these pieces are received.
fn read(rtu: &mut Rtu<Script>, pieces: &[&[u8]]) -> Result<Vec<u8>, Trouble> {
    ask(rtu, &[3, 0, 16, 0, 2], pieces)
}

fn ask(rtu: &mut Rtu<Script>, request: &[u8], pieces: &[&[u8]]) -> Result<Vec<u8>, Trouble> {
    rtu.port.answers.push_back(pieces.iter().map(|it| it.to_vec()).collect());
    let mut answer = Vec::new();
    rtu.exchange(7, Duration::from_millis(200), request, &mut answer).map(|()| answer)
}

const ANSWER: [u8; 6] = [3, 4, 0x12, 0x34, 0xAB, 0xCD];

fn whole() -> Vec<u8> {
    framed(&[&[7][..], &ANSWER].concat())
}

#[track_caller]
fn is_damaged(asked: Result<Vec<u8>, Trouble>, expected: &str) {
    match asked {
        Err(Trouble::Damaged(text)) => assert!(text.contains(expected), "{text}"),
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn is_unanswered(asked: Result<Vec<u8>, Trouble>, expected: &str) {
    match asked {
        Err(Trouble::Unanswered(text)) => assert!(text.contains(expected), "{text}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_request_has_an_answer() {
    let mut rtu = rtu();
    assert_eq!(read(&mut rtu, &[&whole()]).unwrap(), ANSWER);
    assert_eq!(rtu.port.sent, [framed(&[7, 3, 0, 16, 0, 2])]);
    // In pieces, and with what the server refuses.
    let frame = whole();
    assert_eq!(read(&mut rtu, &[&frame[..1], &frame[1..4], &frame[4..]]).unwrap(), ANSWER);
    assert_eq!(read(&mut rtu, &[&framed(&[7, 0x83, 2])]).unwrap(), [0x83, 2]);
    assert_eq!(ask(&mut rtu, &[5, 0, 9, 0xFF, 0], &[&framed(&[7, 5, 0, 9, 0xFF, 0])]).unwrap(), [5, 0, 9, 0xFF, 0]);
    let coils = [15, 0, 9, 0, 3, 1, 0b101];
    assert_eq!(ask(&mut rtu, &coils, &[&framed(&[7, 15, 0, 9, 0, 3])]).unwrap(), [15, 0, 9, 0, 3]);
    assert_eq!(ask(&mut rtu, &[1, 0, 9, 0, 9], &[&framed(&[7, 1, 2, 0xFF, 1])]).unwrap(), [1, 2, 0xFF, 1]);
}

#[test]
fn a_damaged_answer_is_no_value() {
    let mut rtu = rtu();
    let frame = whole();
    for at in 0..8 * frame.len() {
        let mut wrong = frame.clone();
        wrong[at / 8] ^= 1 << (at % 8);
        assert!(matches!(read(&mut rtu, &[&wrong]), Err(Trouble::Damaged(_))), "bit {at}");
    }
    for end in 1..frame.len() {
        is_damaged(read(&mut rtu, &[&frame[..end]]), if end == 1 { "1 of 9 bytes" } else { " of 9 bytes" });
    }
    is_damaged(read(&mut rtu, &[&[0xFF], &frame]), "not form a frame");
    is_damaged(read(&mut rtu, &[&[&frame[..], &[0]].concat()]), "bytes after the answer");
    is_damaged(read(&mut rtu, &[&[0x55; 200], &[0x55; 200], &frame]), "not form a frame");
    assert_eq!(read(&mut rtu, &[&frame]).unwrap(), ANSWER);
}

#[test]
fn an_answer_of_others_is_no_value() {
    let mut rtu = rtu();
    let other = framed(&[&[8][..], &ANSWER].concat());
    is_unanswered(read(&mut rtu, &[&other]), "one of unit 8");
    // One that is late does not take the place of the right one.
    assert_eq!(read(&mut rtu, &[&other, &[], &whole()]).unwrap(), ANSWER);
    is_unanswered(read(&mut rtu, &[&framed(&[7, 4, 4, 0, 1, 0, 2])]), "function 4, not 3");
    is_unanswered(read(&mut rtu, &[&framed(&[7, 3, 6, 0, 1, 0, 2, 0, 3])]), "another length");
    is_unanswered(read(&mut rtu, &[&framed(&[7, 3, 3, 0, 1, 0, 2])]), "does not fit the request");
    is_unanswered(ask(&mut rtu, &[6, 0, 9, 0, 5], &[&framed(&[7, 6, 0, 8, 0, 5])]), "does not fit the request");
    is_unanswered(read(&mut rtu, &[]), "no answer in time");
}

#[test]
fn what_comes_before_a_request_is_dropped() {
    let mut rtu = rtu();
    is_unanswered(read(&mut rtu, &[]), "no answer in time");
    rtu.port.received.extend([framed(&[7, 3, 4, 9, 9, 9, 9]), vec![1, 2, 3]]);
    assert_eq!(read(&mut rtu, &[&whole()]).unwrap(), ANSWER);
}

/// Where noise comes before an answer, the answer is not taken for that of the next request.
#[test]
fn an_answer_after_noise_is_dropped() {
    let mut rtu = rtu();
    is_damaged(read(&mut rtu, &[&[1, 2, 3], &[], &framed(&[7, 3, 4, 9, 9, 9, 9])]), "not form a frame");
    assert!(rtu.port.received.is_empty());
    assert_eq!(read(&mut rtu, &[&whole()]).unwrap(), ANSWER);
}

#[test]
fn a_line_that_is_never_silent_is_no_endless_wait() {
    struct Noise;
    impl Port for Noise {
        fn send(&mut self, _: &[u8], _: Instant) -> io::Result<()> {
            Ok(())
        }

        fn receive(&mut self, buffer: &mut [u8], _: Instant) -> io::Result<usize> {
            buffer[0] = 0;
            Ok(1)
        }
    }
    let mut rtu = Rtu::new(Noise, &line(9600, Parity::None));
    let asked = rtu.exchange(1, Duration::from_millis(5), &[3, 0, 0, 0, 1], &mut Vec::new());
    is_unanswered(asked.map(|()| Vec::new()), "never silent");
}

#[test]
fn silence_is_as_long_as_the_specification_says() {
    let silence = |rate, parity| Rtu::new(Script::default(), &line(rate, parity)).timing.silence.as_micros();
    // 11 bits, and 10 without parity.
    assert_eq!(silence(9600, Parity::Even), 4010);
    assert_eq!(silence(9600, Parity::None), 3645);
    assert_eq!((silence(19200, Parity::Odd), silence(38400, Parity::Odd)), (2005, 1750));
}
