//! Which requests a mapping comes to, and what is wrong with others.

use super::*;
use crate::attachments::client::openplc_layout;
use crate::fixture::map_with;
use crate::remote::{Line, OnLoss, Parity, Server};
use std::time::Duration;

fn remote(variables: &[(&str, &str)], word_order: Option<WordOrder>) -> Remote {
    let time = Duration::from_millis(100);
    let variables = variables.iter().map(|(name, place)| ((*name).to_owned(), (*place).to_owned())).collect();
    let (name, server) = ("pump".to_owned(), Server::Tcp("127.0.0.1:502".to_owned()));
    Remote { name, server, unit: 1, period: time, timeout: time, on_loss: OnLoss::Hold, word_order, variables }
}

fn plant() -> Map {
    map_with(&[
        ("INT", 0, "-", "%IW0"),
        ("array:0", 2, "-", "%IW10"),
        ("DINT", 12, "-", "%ID0"),
        ("BOOL", 16, "-", "%IX0.0"),
        ("BOOL", 17, "-", "%QX0.0"),
        ("INT", 18, "-", "%QW0"),
        ("REAL", 20, "-", "%QD0"),
        ("BYTE", 24, "-", "%IB0"),
        ("INT", 26, "-", "%MW0"),
        ("INT", 28, "-", "-"),
        ("BOOL", 30, "-", "%QX0.1"),
    ])
}

fn plan(variables: &[(&str, &str)], word_order: Option<WordOrder>) -> Result<Plan, String> {
    let map = plant();
    Plan::of(&remote(variables, word_order), &map, &Points::of(&map)).map_err(|it| it.text)
}

fn shape(requests: &[Request]) -> Vec<(Table, u16, u16, usize)> {
    requests.iter().map(|it| (it.table, it.first, it.count, it.parts.len())).collect()
}

#[test]
fn numbers_that_follow_one_another_are_one_request() {
    let variables = [
        ("v1", "input-register 100"),
        ("v0", "input-register 104"),
        ("v2", "input-register 106"),
        ("%IX0.0", "discrete-input 7"),
        ("v4", "coil 3"),
        ("v10", "coil 4"),
        ("v5", "holding-register 9"),
    ];
    let plan = plan(&variables, Some(WordOrder::HighFirst)).unwrap();
    let reads = [(Table::Discrete, 7, 1, 1), (Table::Input, 100, 5, 5), (Table::Input, 106, 2, 2)];
    assert_eq!(shape(&plan.reads), reads);
    assert_eq!(shape(&plan.writes), [(Table::Coils, 3, 2, 2), (Table::Holding, 9, 1, 1)]);
    assert_eq!(plan.inputs.len(), 7);
}

#[test]
fn the_order_of_words_is_as_stated() {
    let shifts = |order| {
        let plan = plan(&[("v6", "holding-register 0")], Some(order)).unwrap();
        plan.writes[0].parts.iter().map(|it| (it.at, it.shift)).collect::<Vec<_>>()
    };
    assert_eq!(shifts(WordOrder::HighFirst), [(0, 16), (1, 0)]);
    assert_eq!(shifts(WordOrder::LowFirst), [(0, 0), (1, 16)]);
}

#[test]
fn a_bit_of_a_register_is_an_input() {
    let plan = plan(&[("v3", "holding-register 5.12"), ("v0", "holding-register 5")], None).unwrap();
    assert_eq!(shape(&plan.reads), [(Table::Holding, 5, 1, 2)]);
    assert!(plan.reads[0].parts.iter().any(|it| it.kind == Kind::Bit(12)));
}

/// No value is in two requests, of which each has at most 125 registers.
#[test]
fn long_runs_are_divided_between_values() {
    let fields: Vec<_> = (0..100).map(|at| ("DINT", 4 * at, "-", format!("%ID{at}"))).collect();
    let fields: Vec<_> = fields.iter().map(|(ty, at, flags, address)| (*ty, *at, *flags, address.as_str())).collect();
    let map = map_with(&fields);
    let variables: Vec<_> = (0..100).map(|at| (format!("v{at}"), format!("input-register {}", 2 * at))).collect();
    let variables: Vec<_> = variables.iter().map(|(name, place)| (name.as_str(), place.as_str())).collect();
    let plan = Plan::of(&remote(&variables, Some(WordOrder::LowFirst)), &map, &Points::of(&map)).unwrap();
    assert_eq!(shape(&plan.reads), [(Table::Input, 0, 124, 124), (Table::Input, 124, 76, 76)]);
}

#[test]
fn mistakes_say_what_to_write() {
    let cases = [
        (("v0", "register 3"), "input-register and holding-register"),
        (("v0", "input-register 65536"), "from 0 to 65535"),
        (("v0", "coil 3.1"), "not a place at a server"),
        (("v1", "input-register 65533"), "ends after number 65535"),
        (("v0", "coil 3"), "more bits than one"),
        (("v3", "input-register 3"), "name one, as in \"input-register 3.0\""),
        (("v4", "holding-register 3.1"), "cannot be written alone"),
        (("v5", "input-register 3"), "outputs are a coil or a holding-register"),
        (("v4", "discrete-input 3"), "outputs are a coil or a holding-register"),
        (("v2", "input-register 3"), "word-order = \"high-first\""),
        (("v7", "input-register 3"), "use an address with W"),
        (("v8", "holding-register 3"), "%M is neither read nor written"),
        (("v9", "holding-register 3"), "declare it as `AT %IW0`"),
        (("w0", "holding-register 3"), "w0"),
    ];
    for (variable, expected) in cases {
        let text = plan(&[variable], None).unwrap_err();
        assert!(text.contains(expected), "{variable:?}: {text}");
    }
    let text = plan(&[("v5", "holding-register 3"), ("v6", "holding-register 2")], Some(WordOrder::LowFirst));
    assert!(text.unwrap_err().contains("another variable is written to holding-register 2"));
}

#[test]
fn the_map_carries_it() {
    let before = remote(&[("v0", "input-register 3"), ("v5", "coil 0")], Some(WordOrder::LowFirst));
    let text = format!("map\t1\nmachine\t64\t8\n{}\n", before.lines().join("\n"));
    assert_eq!(Map::parse(&text).unwrap().remotes, std::slice::from_ref(&before));
    let twice = [before, remote(&[("%IW0", "coil 0")], None)];
    let wrong = |all: &[Remote]| check_remotes(all, &plant()).unwrap_err();
    assert_eq!(wrong(&twice).0, 0);
    let inputs = |name| remote(&[(name, "input-register 3")], None);
    let (number, mistake) = wrong(&[inputs("v0"), inputs("%IW0")]);
    assert!(number == 1 && mistake.text.contains("another connection"), "{mistake:?}");
}

#[test]
fn the_map_carries_a_serial_line() {
    let mut before = remote(&[("v0", "input-register 3")], None);
    let port = "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0".to_owned();
    before.server = Server::Serial(Line { port, baud_rate: 9600, parity: Parity::Odd, stop_bits: 2 });
    let text = format!("map\t1\nmachine\t64\t8\n{}\n", before.lines().join("\n"));
    assert_eq!(Map::parse(&text).unwrap().remotes, [before]);
}

#[test]
fn a_layout_of_openplc_has_what_no_entry_names() {
    let own = [remote(&[("v4", "coil 30")], None), remote(&[("%IW0", "input-register 3")], None)];
    let found = openplc_layout(&plant(), &own);
    let expected = [
        ("%IW10", "input-register 10"),
        ("%IX0.0", "discrete-input 0"),
        ("%QW0", "holding-register 0"),
        ("%QX0.1", "coil 1"),
    ];
    assert_eq!(found, expected.map(|(name, place)| (name.to_owned(), place.to_owned())));
}

/// Each is one value; the bits of an input that are also another one's are read with that.
#[test]
fn a_layout_of_openplc_has_each_bit_once() {
    let map = map_with(&[
        ("WORD", 0, "-", "%IW1"),
        ("bit:3", 0, "view", "%IX2.3"),
        ("WORD", 2, "-", "%QW1"),
        ("bit:3", 2, "view", "%QX2.3"),
        ("BOOL", 4, "-", "%IX1023.7"),
    ]);
    let places: Vec<_> = openplc_layout(&map, &[]).into_iter().map(|it| it.1).collect();
    assert_eq!(places, ["input-register 1", "holding-register 1", "coil 19", "discrete-input 8191"]);
}
