//! A program between lines that are memory of the test, and what is wrong with lines.

use super::group::Group;
use super::lines::Lines;
use super::*;
use crate::allocations::allocations;
use crate::fixture::{Bytes, map_with};
use crate::pin::{Bias, Pin, PinLine};
use crate::remote::{OnLoss, Remote, Server};
use std::collections::BTreeMap;
use std::io;
use std::sync::Mutex;
use std::time::Instant;

/// The levels of a chip's lines, by their numbers, as the program sees them: TRUE is active.
#[derive(Clone, Default)]
struct Fake(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    levels: BTreeMap<u32, bool>,
    requests: Vec<Group>,
    /// Bits and which these are.
    guards: Vec<(u64, u64)>,
    is_broken: bool,
}

struct FakeLines(Fake, Vec<u32>);

impl Fake {
    fn set(&self, line: u32, level: bool) {
        self.0.lock().unwrap().levels.insert(line, level);
    }

    fn level(&self, line: u32) -> bool {
        self.0.lock().unwrap().levels.get(&line).copied().unwrap_or(false)
    }
}

impl Chips for Fake {
    fn open(&self, group: &Group) -> Result<Box<dyn Lines>, String> {
        let number = |line: &PinLine| match line {
            PinLine::Number(number) => *number,
            PinLine::Name(name) => name.trim_start_matches("GPIO").parse().unwrap(),
        };
        let lines: Vec<u32> = group.lines.iter().map(|it| number(&it.line)).collect();
        if lines.contains(&999) {
            return Err("line 999 is used by \"other\": end that, or use another line".to_owned());
        }
        if group.is_output {
            lines.iter().zip(&group.lines).for_each(|(line, it)| self.set(*line, it.initial));
        }
        self.0.lock().unwrap().requests.push(group.clone());
        Ok(Box::new(FakeLines(self.clone(), lines)))
    }
}

impl Lines for FakeLines {
    fn read(&mut self) -> io::Result<u64> {
        if self.0.0.lock().unwrap().is_broken {
            return Err(io::Error::other("it was unplugged"));
        }
        Ok(self.1.iter().enumerate().fold(0, |bits, (at, line)| bits | u64::from(self.0.level(*line)) << at))
    }

    fn write(&mut self, bits: u64) -> io::Result<()> {
        self.1.iter().enumerate().for_each(|(at, line)| self.0.set(*line, bits >> at & 1 == 1));
        Ok(())
    }

    fn guard(&self, bits: u64, mask: u64) -> bool {
        self.0.0.lock().unwrap().guards.push((bits, mask));
        true
    }
}

fn pin(variable: &str, line: u32) -> Pin {
    let (variable, chip, line) = (variable.to_owned(), "gpiochip0".to_owned(), PinLine::Number(line));
    Pin { variable, chip, line, active_low: false, bias: Bias::AsIs, debounce: None, safe: None }
}

/// Its inputs are v0, v1 and v6, its outputs v2 to v4.
fn map(pins: Vec<Pin>) -> Map {
    let mut map = map_with(&[
        ("BOOL", 0, "-", "%IX0.0"),
        ("BOOL", 1, "-", "%IX0.1"),
        ("BOOL", 2, "-", "%QX0.0"),
        ("BOOL", 3, "-", "%QX0.1"),
        ("BOOL", 4, "-", "%QX0.2"),
        ("INT", 6, "-", "%IW10"),
        ("BOOL", 8, "-", "%MX0.0"),
        ("array:0", 10, "-", "%QW20"),
        ("BOOL", 20, "-", "-"),
    ]);
    map.pins = pins;
    map
}

#[track_caller]
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let limit = Instant::now() + Duration::from_secs(30);
    while !holds() {
        assert!(Instant::now() < limit, "never: {what}");
        thread::sleep(Duration::from_millis(1));
    }
}

fn start(fake: &Fake, at_end: AtEnd) -> (Gpio, Bytes) {
    let mut button = pin("v0", 17);
    (button.active_low, button.bias, button.debounce) = (true, Bias::PullUp, Some(Duration::from_millis(5)));
    let named = Pin { line: PinLine::Name("GPIO18".to_owned()), ..pin("%IX0.1", 0) };
    let safe = Pin { safe: Some(true), ..pin("v3", 28) };
    let map = map(vec![button, pin("v2", 27), named, safe, pin("%QX0.2", 29)]);
    let points = Points::of(&map);
    (Gpio::start_at(fake, &map, &points, at_end).unwrap(), Bytes::new(&map))
}

#[test]
fn inputs_are_read_and_outputs_written() {
    let fake = Fake::default();
    fake.set(18, true);
    let (mut gpio, mut machine) = start(&fake, AtEnd::Zero);
    // Before the first scan, outputs have their safe values.
    assert_eq!([27, 28, 29].map(|it| fake.level(it)), [false, true, false]);
    until("an input is TRUE", || {
        gpio.before(&mut machine);
        machine.state[1] == 1
    });
    assert_eq!(machine.state[0], 0);
    fake.set(17, true);
    until("the other one follows", || {
        gpio.before(&mut machine);
        machine.state[0] == 1
    });
    assert_eq!([27, 28].map(|it| fake.level(it)), [false, true], "no scan has ended");
    machine.state[2..5].copy_from_slice(&[1, 0, 1]);
    gpio.after(&machine.state);
    until("outputs follow", || [27, 28, 29].map(|it| fake.level(it)) == [true, false, true]);
    // With the settings that were asked for; lines of the same settings together.
    let requests = fake.0.lock().unwrap().requests.clone();
    let shape: Vec<_> = requests.iter().map(|it| (it.is_output, it.active_low, it.bias, it.lines.len())).collect();
    assert_eq!(shape, [(false, true, Bias::PullUp, 1), (true, false, Bias::AsIs, 3), (false, false, Bias::AsIs, 1)]);
    assert_eq!(requests[0].debounce, Some(Duration::from_millis(5)));
    gpio.end(Ended::Well);
    assert_eq!([27, 28, 29].map(|it| fake.level(it)), [false, true, false]);
    // The same where a scan does not end.
    assert_eq!(fake.0.lock().unwrap().guards, [(0b010, 0b111)]);
}

#[test]
fn outputs_stay_where_that_is_asked_for() {
    let fake = Fake::default();
    let (mut gpio, mut machine) = start(&fake, AtEnd::Hold);
    machine.state[2..5].copy_from_slice(&[1, 0, 1]);
    gpio.after(&machine.state);
    gpio.end(Ended::Fault);
    // A stated value counts more.
    assert_eq!([27, 28, 29].map(|it| fake.level(it)), [true, true, true]);
    assert_eq!(fake.0.lock().unwrap().guards, [(0b010, 0b010)]);
}

#[test]
fn a_chip_that_fails_ends_the_run() {
    let fake = Fake::default();
    let (gpio, _) = start(&fake, AtEnd::Zero);
    assert!(gpio.lost().is_none());
    fake.0.lock().unwrap().is_broken = true;
    until("it is lost", || gpio.lost().is_some());
    assert_eq!(gpio.lost().unwrap().to_string(), "connection: gpio gpiochip0: it was unplugged");
}

#[test]
fn a_scan_does_not_allocate() {
    let fake = Fake::default();
    let (mut gpio, mut machine) = start(&fake, AtEnd::Zero);
    fake.set(17, false);
    gpio.after(&machine.state);
    let count = allocations(|| {
        for scan in 0..2000_u32 {
            fake.set(17, scan % 2 == 0);
            gpio.before(&mut machine);
            machine.state[2] = (scan / 3 % 2) as u8;
            gpio.after(&machine.state);
        }
    });
    assert_eq!(count, 0);
}

fn wrong(pins: Vec<Pin>, remotes: &[Remote]) -> (usize, String) {
    let map = map(pins);
    check_pins(&map.pins, remotes, &map).unwrap_err()
}

#[test]
fn mistakes_are_named() {
    let debounce = Some(Duration::from_millis(1));
    for (pins, expected) in [
        (vec![pin("none", 1)], "none"),
        (vec![pin("v5", 1)], "a line is one bit: use a BOOL, at %IX or %QX"),
        (vec![pin("v6", 1)], "%M is neither read nor written"),
        (vec![pin("v7", 1)], "it has 4 values, and a line is one"),
        (vec![pin("v8", 1)], "only variables at addresses are connected"),
        (vec![pin("v0", 1), pin("v1", 1)], "line 1 of gpiochip0 has another variable, too"),
        (vec![pin("v0", 1), pin("%IX0.0", 2)], "it has another line, too"),
        (vec![pin("v2", 1), pin("v2", 2)], "it has another line, too"),
        (vec![Pin { safe: Some(false), ..pin("v0", 1) }], "it is an input, and `safe` is for outputs"),
        (vec![Pin { debounce, ..pin("v2", 1) }], "it is an output, and `debounce` is for inputs"),
    ] {
        let last = pins.len() - 1;
        let (number, text) = wrong(pins, &[]);
        assert!(number == last && text.contains(expected), "{number}: {text}");
    }
    let (time, server) = (Duration::from_millis(100), Server::Tcp("127.0.0.1:502".to_owned()));
    let variables = vec![("v1".to_owned(), "discrete-input 3".to_owned())];
    let (name, word_order) = ("pump".to_owned(), None);
    let pump =
        Remote { name, server, unit: 1, period: time, timeout: time, on_loss: OnLoss::Hold, word_order, variables };
    assert_eq!(
        wrong(vec![pin("v0", 1), pin("v1", 2)], &[pump]),
        (1, "a Modbus server writes the same input".to_owned())
    );
    // What the kernel refuses is an error at the start.
    let map = map(vec![pin("v0", 999)]);
    let refused = Gpio::start_at(&Fake::default(), &map, &Points::of(&map), AtEnd::Zero).unwrap_err();
    assert!(refused.to_string().contains("gpio: gpiochip0: line 999 is used by \"other\""), "{refused}");
}

#[test]
fn the_map_carries_lines() {
    let mut all =
        vec![pin("v0", 17), Pin { line: PinLine::Name("GPIO 18".to_owned()), safe: Some(false), ..pin("v2", 0) }];
    (all[0].active_low, all[0].bias, all[0].debounce) = (true, Bias::Disabled, Some(Duration::from_micros(1500)));
    let records: Vec<String> = all.iter().map(Pin::record).collect();
    let text = format!("map\t1\nmachine\t64\t8\n{}\n", records.join("\n"));
    assert_eq!(Map::parse(&text).unwrap().pins, all);
}

/// More lines than one request may have.
#[test]
fn many_lines_are_several_requests() {
    let fields: Vec<_> = (0..130).map(|at| ("BOOL", at, "-", format!("%QX{}.{}", at / 8, at % 8))).collect();
    let fields: Vec<_> = fields.iter().map(|(ty, at, flags, address)| (*ty, *at, *flags, address.as_str())).collect();
    let mut map = map_with(&fields);
    map.pins = (0..130).map(|at| pin(&format!("v{at}"), at)).collect();
    let (fake, points) = (Fake::default(), Points::of(&map));
    let mut gpio = Gpio::start_at(&fake, &map, &points, AtEnd::Zero).unwrap();
    assert_eq!(fake.0.lock().unwrap().requests.iter().map(|it| it.lines.len()).collect::<Vec<_>>(), [64, 64, 2]);
    let mut machine = Bytes::new(&map);
    machine.state = vec![1; 130];
    gpio.after(&machine.state);
    until("all are written", || (0..130).all(|it| fake.level(it)));
    gpio.end(Ended::Well);
    assert!((0..130).all(|it| !fake.level(it)));
}
