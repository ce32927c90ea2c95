//! Which trap a difference is put down to.

use super::super::advice::{Counting, Form, Rules};
use super::*;
use staunch_frontend::Dialect;

const IDLE: Pins =
    Pins { up: false, down: false, reset: false, load: false, preset: 5, count: 0, done: false, empty: false };
const IEC: Kind = Kind { family: Family::Iec, repr: Repr::I16, stops: false, falls: false, loads_once: false };
const CSCAPE: Kind = Kind { family: Family::Cscape, repr: Repr::I16, stops: true, falls: false, loads_once: false };
const CODESYS: Kind = Kind { family: Family::Codesys, repr: Repr::U16, stops: false, falls: false, loads_once: false };
const LOGIX: Kind = Kind { family: Family::Logix, repr: Repr::I32, stops: false, falls: false, loads_once: false };

fn case(to: Kind, before: Pins, now: [Pins; 2]) -> Case {
    let kinds = [IEC, to];
    let (first, restarted, counts_down, has_down) = (false, false, false, false);
    let (feeds_itself, guards_itself, kept_alike) = (false, false, false);
    Case {
        kinds,
        before: [before; 2],
        now,
        first,
        restarted,
        kept_alike,
        feeds_itself,
        guards_itself,
        counts_down,
        has_down,
    }
}

fn number(case: Case) -> Option<usize> {
    classify(&case).map(Pitfall::number)
}

fn count(pins: Pins, count: i128) -> Pins {
    Pins { count, ..pins }
}

#[test]
fn each_difference_has_its_pitfall() {
    let up = Pins { up: true, ..IDLE };
    let down = Pins { down: true, ..IDLE };
    assert_eq!(number(case(CSCAPE, count(up, 1), [count(up, 1), count(up, 2)])), Some(1));
    assert_eq!(number(case(CSCAPE, count(IDLE, 5), [count(up, 6), count(up, 5)])), Some(2));
    assert_eq!(number(case(CODESYS, IDLE, [count(down, -1), down])), Some(3));
    assert_eq!(number(Case { first: true, ..case(LOGIX, IDLE, [count(up, 1), up]) }), Some(5));
    let reset = Pins { reset: true, ..up };
    assert_eq!(number(case(LOGIX, reset, [up, count(up, 1)])), Some(6));
    assert_eq!(number(case(CODESYS, count(IDLE, 32767), [count(up, 32767), count(up, 32768)])), Some(8));
    let last = i128::from(i32::MAX);
    let wide = Kind { repr: Repr::I32, ..IEC };
    let wraps = case(LOGIX, count(IDLE, last), [count(up, last), count(up, -last - 1)]);
    assert_eq!(number(Case { kinds: [wide, LOGIX], ..wraps }), Some(7));
    let loaded = Pins { load: true, ..IDLE };
    assert_eq!(number(case(CODESYS, IDLE, [Pins { preset: -1, ..loaded }, Pins { preset: 65535, ..loaded }])), Some(8));
    let full = Pins { preset: 3, count: 5, ..IDLE };
    assert_eq!(number(case(CSCAPE, full, [Pins { done: true, ..full }, full])), Some(10));
}

#[test]
fn what_happened_before_decides() {
    let up = Pins { up: true, ..IDLE };
    let after_reset = case(CSCAPE, Pins { reset: true, ..up }, [up, count(up, 1)]);
    assert_eq!(number(after_reset), Some(6));
    assert_eq!(number(Case { feeds_itself: true, ..after_reset }), Some(12));
    let down = Pins { down: true, ..IDLE };
    let guarded =
        Case { before: [count(down, 3), count(IDLE, 3)], ..case(CODESYS, IDLE, [count(down, 3), count(down, 2)]) };
    assert_eq!(number(Case { guards_itself: true, ..guarded }), Some(14));
    let kept = case(LOGIX, count(IDLE, 1), [IDLE, count(IDLE, 1)]);
    assert_eq!(number(Case { restarted: true, ..kept }), Some(11));
    // Where both keep it, the event is not the cause.
    let below = case(CODESYS, IDLE, [count(down, -1), down]);
    assert_eq!(number(Case { restarted: true, kept_alike: true, ..below }), Some(3));
    let openplc = Kind { family: Family::Openplc, stops: true, ..IEC };
    assert_eq!(number(case(openplc, count(IDLE, 5), [count(up, 6), count(up, 5)])), Some(15));
    let later = Kind { family: Family::Openplc4, stops: true, falls: true, ..IEC };
    assert_eq!(number(case(later, count(IDLE, 5), [count(down, 4), count(down, 5)])), Some(17));
    let rising = Kind { falls: false, ..later };
    let both = Pins { down: true, ..up };
    let s7 = Kind { family: Family::S7, loads_once: true, ..IEC };
    let load = Pins { load: true, ..IDLE };
    assert_eq!(number(case(s7, count(load, 5), [count(load, 6), count(load, 5)])), Some(20));
    assert_eq!(number(case(s7, IDLE, [count(load, 6), count(load, 5)])), None);
    assert_eq!(number(case(rising, count(IDLE, 5), [count(both, 5), count(both, 4)])), Some(18));
    let done = Pins { done: true, ..IDLE };
    assert_eq!(number(Case { counts_down: true, ..case(LOGIX, IDLE, [done, IDLE]) }), Some(4));
    assert_eq!(number(case(LOGIX, IDLE, [done, IDLE])), Some(13));
}

#[test]
fn what_the_rules_rule_out_has_a_reason() {
    // Both systems go below 0: no pitfall 3, however the counts came to differ.
    let down = Pins { down: true, ..IDLE };
    assert_eq!(number(case(LOGIX, IDLE, [count(down, -1), down])), None);
}

/// A counter that calls give all of its inputs.
fn counting(form: Form) -> Counting {
    let (least, greatest) = (i128::from(i16::MIN), i128::from(i16::MAX));
    let rules = Rules { family: Family::Iec, least, greatest, stops: false, falls: false, loads_once: false };
    Counting { form, rises: false, rules: Some(rules), is_partial: false }
}

#[test]
fn every_pitfall_says_what_to_do() {
    for (pitfall, number) in Pitfall::all().zip(1..) {
        assert_eq!(pitfall.number(), number);
        let advice = pitfall.advice(Dialect::Iec, Dialect::Cscape, counting(Form::Up));
        let sentence = pitfall.sentence([Dialect::Iec, Dialect::Cscape]);
        assert!(sentence.ends_with('.') && !sentence.contains(['[', ']', '|']) && advice.ends_with('.'), "{number}");
        let reset = pitfall.advice(Dialect::Iec, Dialect::Codesys, counting(Form::Up));
        let both = pitfall.advice(Dialect::Iec, Dialect::Logix, counting(Form::UpDown));
        assert!(!both.contains("CTU(") && !both.contains("CTD("), "a CTUD is no CTU: {both}");
        assert!(!reset.contains("R := ") || reset.contains("RESET := "), "{reset}");
    }
}
