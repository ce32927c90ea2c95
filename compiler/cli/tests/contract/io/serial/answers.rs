//! Answers that no unit should give: the test is the unit.

use super::super::modbus::{COILS, Client, INPUT};
use super::super::until;
use super::{Line, PLANT, framed, run, unanswered};
use crate::{Folder, has};
use std::time::Duration;

/// What the next request is answered with.
enum Reply {
    At(Duration, Vec<u8>),
    Nothing,
}

const AT_ONCE: Duration = Duration::ZERO;
/// Of the program's entry: longer than a busy machine keeps the test from answering.
const TIMEOUT: Duration = Duration::from_millis(1500);

/// Waits for a request to read input register 3 of unit 3, and answers it.
fn serve(line: &mut Line, reply: &Reply) {
    let mut request: Vec<u8> = Vec::new();
    until("the program asks", || {
        request.extend(line.receive());
        request.len() >= 8 && request.len().is_multiple_of(8)
    });
    // The program has asked again, if the test was late.
    assert!(request.chunks(8).all(|it| it == framed(&[3, 4, 0, 3, 0, 1])), "{request:?}");
    if let Reply::At(delay, bytes) = reply {
        std::thread::sleep(*delay);
        line.send(bytes);
    }
}

#[test]
fn wrong_answers_are_no_values() {
    let folder = Folder::with("io_serial_answers", &[("main.st", PLANT)]);
    let port = folder.0.join("a").display().to_string();
    folder.write(
        "staunch.toml",
        format!(
            "[[modbus]]\nport = \"{port}\"\nunit = 3\nperiod = \"5ms\"\ntimeout = \"{}ms\"\n[modbus.map]\n\
             level = \"input-register 3\"\n",
            TIMEOUT.as_millis()
        ),
    );
    folder.staunch("build main.st -o plant -q").out(0);
    let Some(mut line) = Line::start(&folder) else { return };
    let plant = run(&folder);
    let mut client = Client::of(&plant);
    // 1234, and 999, which the program must never see.
    // A right one comes so late that it does not hide a wrong one before it.
    let right = || Reply::At(TIMEOUT / 5, framed(&[3, 4, 2, 0x04, 0xD2]));
    let wrong = framed(&[3, 4, 2, 0x03, 0xE7]);
    let mut with_other_crc = wrong.clone();
    with_other_crc[6] ^= 1;
    let replies = [
        Reply::At(AT_ONCE, with_other_crc),
        Reply::At(AT_ONCE, wrong[..6].to_vec()),
        Reply::At(AT_ONCE, [&wrong[..], &[0x55]].concat()),
        Reply::At(AT_ONCE, framed(&[4, 4, 2, 0x03, 0xE7])),
        Reply::At(AT_ONCE, framed(&[3, 3, 2, 0x03, 0xE7])),
        Reply::At(AT_ONCE, framed(&[3, 4, 4, 0x03, 0xE7, 0x03, 0xE7])),
        Reply::At(TIMEOUT + TIMEOUT / 2, wrong),
        Reply::Nothing,
    ];
    let count = replies.len();
    for reply in &replies {
        serve(&mut line, reply);
        serve(&mut line, &right());
    }
    until("the value arrives", || {
        serve(&mut line, &right());
        client.words(INPUT, 10, 1) == [1234]
    });
    assert!(!client.bit(COILS, 72), "a value that nobody sent as an answer");
    plant.signal("-TERM");
    let said = plant.ended(0);
    has(&said, &["no answer in time, but one of unit 4"]);
    assert!(unanswered(&said) >= count, "{said}");
}
