//! Requests and answers, one by one and at random.

use super::*;
use crate::Machine as _;
use crate::allocations::allocations;
use crate::attachments::exchange::Exchange;
use crate::attachments::points::Points;
use crate::attachments::registers::place;
use crate::fixture::{Bytes, map_with};
use crate::map::Map;

/// A program with a few points, and one client.
struct Plant {
    points: Points,
    machine: Bytes,
    exchange: Exchange,
    registers: Registers,
    request: u64,
}

fn map() -> Map {
    map_with(&[
        ("BOOL", 0, "-", "%IX0.1"),
        ("array:1", 1, "-", "%QX1.0"),
        ("INT", 4, "-", "%IW3"),
        ("array:0", 6, "-", "%QW5"),
        ("INT", 14, "-", "%MW0"),
        ("DINT", 16, "-", "%MD1"),
        ("LINT", 24, "-", "%ML2"),
    ])
}

impl Plant {
    fn new() -> Self {
        let map = map();
        let points = Points::of(&map);
        assert!(points.all.iter().all(|it| place(it).is_some()));
        let (exchange, registers) = (Exchange::new(points.all.len()), Registers::new(&points.all));
        Self { machine: Bytes::new(&map), points, exchange, registers, request: 0 }
    }

    /// A scan in which the program does nothing.
    fn scan(&mut self) {
        if let Some(request) = self.exchange.take(&self.points.all, &mut self.machine) {
            self.request = request;
        }
        self.exchange.show(self.request, |at| self.points.all[at].read(self.machine.state()));
    }

    fn ask(&mut self, request: &[u8]) -> Vec<u8> {
        let mut text = Vec::new();
        self.registers.update(&self.exchange);
        answer(request, &mut self.registers, &mut text);
        self.registers.hand_over(&self.exchange);
        text
    }
}

#[test]
fn each_table_is_read_where_its_variables_are() {
    let mut plant = Plant::new();
    plant.machine.state[0] = 1;
    plant.machine.state[2] = 1;
    plant.machine.write(4, &0x1234_i16.to_ne_bytes());
    plant.machine.write(8, &(-2_i16).to_ne_bytes());
    plant.machine.write(16, &0x0102_0304_i32.to_ne_bytes());
    plant.machine.write(24, &0x0102_0304_0506_0708_i64.to_ne_bytes());
    plant.scan();
    assert_eq!(plant.ask(&[2, 0, 0, 0, 8]), [2, 1, 0b10]);
    assert_eq!(plant.ask(&[1, 0, 0, 0, 11]), [1, 2, 0, 0b10]);
    assert_eq!(plant.ask(&[4, 0, 3, 0, 2]), [4, 4, 0x12, 0x34, 0, 0]);
    assert_eq!(plant.ask(&[3, 0, 6, 0, 1]), [3, 2, 0xFF, 0xFE]);
    assert_eq!(plant.ask(&[3, 8, 2, 0, 2]), [3, 4, 1, 2, 3, 4]);
    assert_eq!(plant.ask(&[3, 16, 8, 0, 4]), [3, 8, 1, 2, 3, 4, 5, 6, 7, 8]);
}

#[test]
fn what_is_written_is_in_the_next_scan_and_seen_at_once() {
    let mut plant = Plant::new();
    plant.scan();
    assert_eq!(plant.ask(&[5, 0, 9, 0xFF, 0]), [5, 0, 9, 0xFF, 0]);
    assert_eq!(plant.ask(&[16, 8, 2, 0, 2, 4, 1, 2, 3, 4]), [16, 8, 2, 0, 2]);
    assert_eq!((plant.machine.state[2], plant.ask(&[1, 0, 9, 0, 1])), (0, vec![1, 1, 1]));
    // A scan that began before leaves it as it was written.
    plant.exchange.show(0, |_| 0);
    assert_eq!(plant.ask(&[3, 8, 2, 0, 2]), [3, 4, 1, 2, 3, 4]);
    plant.scan();
    assert_eq!((plant.machine.state[2], &plant.machine.state[16..20]), (1, &0x0102_0304_i32.to_ne_bytes()[..]));
    // One half of a number.
    plant.ask(&[6, 8, 3, 0xAA, 0xBB]);
    plant.machine.write(16, &0x7777_7777_i32.to_ne_bytes());
    plant.scan();
    assert_eq!(plant.machine.state[16..20], 0x7777_AABB_i32.to_ne_bytes());
    assert_eq!(plant.ask(&[23, 8, 2, 0, 1, 4, 0, 0, 1, 2, 0, 5]), [23, 2, 0x77, 0x77]);
    assert_eq!(plant.ask(&[23, 4, 0, 0, 1, 4, 0, 0, 1, 2, 0, 6]), [23, 2, 0, 6]);
    assert_eq!(plant.ask(&[15, 0, 8, 0, 2, 1, 0b01]), [15, 0, 8, 0, 2]);
    plant.scan();
    assert_eq!((plant.machine.state[1..3].to_vec(), plant.machine.state[14]), (vec![1, 0], 6));
}

#[test]
fn what_no_variable_has_is_kept() {
    let mut plant = Plant::new();
    plant.scan();
    assert_eq!(plant.ask(&[3, 0, 100, 0, 1]), [3, 2, 0, 0]);
    plant.ask(&[6, 0, 100, 1, 2]);
    plant.scan();
    assert_eq!(plant.ask(&[3, 0, 100, 0, 1]), [3, 2, 1, 2]);
}

#[test]
fn what_is_refused_has_changed_nothing() {
    let mut plant = Plant::new();
    plant.scan();
    let [function, address, value] = [1, 2, 3];
    let mut refused = |request: &[u8], exception: u8| {
        assert_eq!(plant.ask(request), [request[0] | 0x80, exception], "{request:?}");
    };
    refused(&[7], function);
    refused(&[0x2B, 14, 1, 0], function);
    refused(&[0x81, 0, 0, 0, 1], function);
    for (table, count) in [(1, 2001_u16), (2, 2001), (3, 126), (4, 126)] {
        let [high, low] = count.to_be_bytes();
        refused(&[table, 0, 0, high, low], value);
        refused(&[table, 0, 0, 0, 0], value);
        refused(&[table, 0, 0, 0], value);
        refused(&[table, 0, 0, 0, 1, 0], value);
        refused(&[table, 0xFF, 0xFF, 0, 1], address);
    }
    refused(&[1, 0x1F, 0xFF, 0, 2], address);
    refused(&[4, 3, 0xFF, 0, 2], address);
    refused(&[3, 0x1F, 0xFF, 0, 2], address);
    refused(&[5, 0, 9, 0, 1], value);
    refused(&[5, 0x20, 0, 0, 0], address);
    refused(&[6, 0x20, 0, 0, 0], address);
    refused(&[15, 0, 0, 0, 9, 1, 0], value);
    refused(&[16, 0, 0, 0, 2, 4, 0, 0, 0], value);
    refused(&[16, 0x1F, 0xFF, 0, 2, 4, 1, 1, 1, 1], address);
    refused(&[23, 0, 0, 0, 126, 0, 0, 0, 1, 2, 0, 1], value);
    let mut long = vec![16, 0, 0, 0, 124, 248];
    long.resize(6 + 248, 9);
    refused(&long, value);
    assert_eq!(plant.ask(&[3, 0x1F, 0xFF, 0, 1]), [3, 2, 0, 0]);
    assert!(plant.exchange.take(&plant.points.all, &mut plant.machine).is_none());
}

/// Whether an answer is one to this request.
fn is_well_formed(request: &[u8], answer: &[u8]) -> bool {
    let count = |at: usize| usize::from(u16::from_be_bytes([request[at], request[at + 1]]));
    match answer {
        [function, exception] if function & 0x80 != 0 => *function == request[0] | 0x80 && (1..=3).contains(exception),
        [function @ (1 | 2), size, rest @ ..] => {
            *function == request[0] && rest.len() == usize::from(*size) && rest.len() == count(3).div_ceil(8)
        }
        [function @ (3 | 4 | 23), size, rest @ ..] => {
            *function == request[0] && rest.len() == usize::from(*size) && rest.len() == 2 * count(3)
        }
        [5 | 6 | 15 | 16, rest @ ..] => answer[0] == request[0] && *rest == request[1..5],
        _ => false,
    }
}

/// Numbers at random, below a bound.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.below(256) as u8).collect()
    }

    /// Most are nearly right: a known function, low numbers, and a length that fits.
    fn request(&mut self) -> Vec<u8> {
        let length = 1 + self.below(253) as usize;
        if self.below(8) == 0 {
            return self.bytes(length);
        }
        let [function, high, low, count, words] = [9, 40, 256, 130, 124].map(|bound| self.below(bound) as u8);
        let function = [1, 2, 3, 4, 5, 6, 15, 16, 23][usize::from(function)];
        let values = self.bytes(2 * usize::from(words));
        let long = self.below(9) as u8 / 8;
        let head = match function {
            5 => return vec![5, high, low, 0xFF * (count % 2), self.below(8) as u8 / 7],
            15 => vec![15, high, low, 0, words.min(15) * 16, words.min(15) * 2],
            16 => vec![16, high, low, 0, words, words * 2],
            23 => vec![23, high, low, 0, count, low % 32, high, 0, words, words * 2],
            other => return vec![other, high, low, long, count],
        };
        let end = usize::from(head[head.len() - 1]).min(values.len());
        [head, values[..end].to_vec()].concat()
    }
}

#[test]
fn any_bytes_have_an_answer_that_is_well_formed() {
    let (mut plant, mut random) = (Plant::new(), Random(1));
    let mut kinds = [0; 2];
    for _ in 0..if cfg!(miri) { 50 } else { 20_000 } {
        let request = random.request();
        let answer = plant.ask(&request);
        assert!(answer.len() <= 253 && is_well_formed(&request, &answer), "{request:?}: {answer:?}");
        kinds[usize::from(answer[0] & 0x80 == 0)] += 1;
        if random.below(4) == 0 {
            plant.scan();
        }
    }
    assert!(cfg!(miri) || kinds.iter().all(|it| *it > 2000), "{kinds:?}");
}

#[test]
fn a_scan_allocates_nothing() {
    let mut plant = Plant::new();
    plant.scan();
    plant.ask(&[16, 8, 2, 0, 2, 4, 1, 2, 3, 4]);
    plant.ask(&[5, 0, 9, 0xFF, 0]);
    assert_eq!(allocations(|| plant.scan()), 0);
    assert_eq!((plant.machine.state[2], plant.machine.state[16]), (1, 4));
}
