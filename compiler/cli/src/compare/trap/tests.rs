use super::*;

const IDLE: Pins =
    Pins { up: false, down: false, reset: false, load: false, preset: 5, count: 0, done: false, empty: false };
const IEC: Kind = Kind { family: Family::Iec, lane: Lane::I16 };
const CSCAPE: Kind = Kind { family: Family::Cscape, lane: Lane::I16 };
const CODESYS: Kind = Kind { family: Family::Codesys, lane: Lane::U16 };
const LOGIX: Kind = Kind { family: Family::Logix, lane: Lane::I32 };

fn case(to: Kind, before: Option<Pins>, now: [Pins; 2]) -> Case {
    let before = before.map(|it| [it, it]);
    Case { kinds: [IEC, to], before, now, restarted: false, feeds_itself: false, counts_down: false }
}

fn number(case: Case) -> Option<usize> {
    classify(&case).map(Trap::number)
}

fn count(pins: Pins, count: i128) -> Pins {
    Pins { count, ..pins }
}

#[test]
fn each_difference_has_its_trap() {
    let up = Pins { up: true, ..IDLE };
    let down = Pins { down: true, ..IDLE };
    let held = Some(count(up, 1));
    assert_eq!(number(case(CSCAPE, held, [count(up, 1), count(up, 2)])), Some(1));
    assert_eq!(number(case(CSCAPE, Some(count(IDLE, 5)), [count(up, 6), count(up, 5)])), Some(2));
    assert_eq!(number(case(CODESYS, Some(IDLE), [count(down, -1), down])), Some(3));
    assert_eq!(number(case(LOGIX, None, [count(up, 1), up])), Some(5));
    let reset = Some(Pins { reset: true, ..up });
    assert_eq!(number(case(LOGIX, reset, [up, count(up, 1)])), Some(6));
    assert_eq!(number(case(CODESYS, Some(count(IDLE, 32767)), [count(up, 32767), count(up, 32768)])), Some(8));
    let last = i128::from(i32::MAX);
    let wide = Kind { lane: Lane::I32, ..IEC };
    let wraps = case(LOGIX, Some(count(IDLE, last)), [count(up, last), count(up, -last - 1)]);
    assert_eq!(number(Case { kinds: [wide, LOGIX], ..wraps }), Some(7));
    let loaded = Pins { load: true, ..IDLE };
    assert_eq!(
        number(case(CODESYS, Some(IDLE), [Pins { preset: -1, ..loaded }, Pins { preset: 65535, ..loaded }])),
        Some(8)
    );
    let full = Pins { preset: 3, count: 5, ..IDLE };
    assert_eq!(number(case(CSCAPE, Some(full), [Pins { done: true, ..full }, full])), Some(10));
}

#[test]
fn what_happened_before_decides() {
    let up = Pins { up: true, ..IDLE };
    let after_reset = case(CSCAPE, Some(Pins { reset: true, ..up }), [up, count(up, 1)]);
    assert_eq!(number(after_reset), Some(6));
    assert_eq!(number(Case { feeds_itself: true, ..after_reset }), Some(12));
    let kept = case(LOGIX, Some(count(IDLE, 1)), [IDLE, count(IDLE, 1)]);
    assert_eq!(number(Case { restarted: true, ..kept }), Some(11));
    let done = Pins { done: true, ..IDLE };
    assert_eq!(number(Case { counts_down: true, ..case(LOGIX, None, [done, IDLE]) }), Some(4));
}

#[test]
fn every_trap_says_what_to_do() {
    for number in 1..=12 {
        let trap = Trap::numbered(number);
        assert_eq!(trap.number(), number);
        assert!(trap.sentence().ends_with('.') && trap.advice().ends_with('.'), "{number}");
    }
}
