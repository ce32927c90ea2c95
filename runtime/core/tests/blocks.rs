//! The blocks other than the counters, call by call, and that `call` is inputs and a step.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use staunch_runtime::time::ms;
use staunch_runtime::{
    BLOCKS, Block, BlockInfo, Context, Direction, Pin, PinRole, cscape, iec, logix, openplc, openplc4, s7,
};

/// Runs a timer at each (time, IN, PT) in milliseconds and gives its (Q, ET).
macro_rules! timed {
    ($timer:ty, $calls:expr) => {{
        let mut timer = <$timer>::new();
        $calls.map(|(now, in_, pt)| {
            timer.call(in_, ms(pt), &Context::at(ms(now)));
            (timer.q, timer.et / ms(1))
        })
    }};
}

#[test]
fn ton_delays_the_rise() {
    let calls = [(5, true, 10), (14, true, 10), (15, true, 10), (99, true, 10), (100, false, 10), (101, true, 10)];
    let expected = [(false, 0), (false, 9), (true, 10), (true, 10), (false, 0), (false, 0)];
    assert_eq!(timed!(iec::Ton, calls), expected);
}

#[test]
fn ton_reads_its_delay_until_it_expires() {
    let calls = [(0, true, 10), (8, true, 5), (9, true, 50), (99, true, 7), (100, true, 7)];
    assert_eq!(timed!(iec::Ton, calls), [(false, 0), (true, 5), (true, 5), (true, 5), (true, 5)]);
    assert_eq!(timed!(iec::Ton, [(0, true, 0), (1, false, 0)]), [(true, 0), (false, 0)]);
    assert_eq!(timed!(iec::Ton, [(0, true, -1), (1, false, 0)]), [(true, 0), (false, 0)]);
    assert_eq!(timed!(iec::Ton, [(0, true, 9), (4, true, 2), (5, true, 9)]), [(false, 0), (true, 2), (true, 2)]);
    assert_eq!(timed!(iec::Ton, [(0, true, 9), (4, true, 20), (9, true, 20)]), [(false, 0), (false, 4), (false, 9)]);
}

#[test]
fn tof_delays_the_fall() {
    let falls = [(0, false, 10), (1, true, 10), (20, false, 10), (29, false, 10)];
    assert_eq!(timed!(iec::Tof, falls), [(false, 0), (true, 0), (true, 0), (true, 9)]);
    let calls = [(1, true, 10), (20, false, 10), (30, false, 10), (99, false, 10), (100, true, 10)];
    let expected = [(true, 0), (true, 0), (false, 10), (false, 10), (true, 0)];
    assert_eq!(timed!(iec::Tof, calls), expected);
    assert_eq!(timed!(iec::Tof, [(0, true, 0), (1, false, 0)]), [(true, 0), (false, 0)]);
    let interrupted =
        [(0, true, 10), (5, false, 10), (10, true, 10), (12, false, 10), (21, false, 10), (22, false, 10)];
    assert_eq!(timed!(iec::Tof, interrupted), [(true, 0), (true, 0), (true, 0), (true, 0), (true, 9), (false, 10)]);
}

#[test]
fn tp_pulses_once_for_each_rise() {
    let held = [(5, true, 10), (14, true, 10), (15, true, 10), (99, true, 10), (100, false, 10), (101, true, 10)];
    let expected = [(true, 0), (true, 9), (false, 10), (false, 10), (false, 0), (true, 0)];
    assert_eq!(timed!(iec::Tp, held), expected);
    let short =
        [(0, true, 10), (1, false, 10), (5, true, 10), (6, false, 10), (10, true, 10), (11, true, 10), (12, false, 10)];
    let expected = [(true, 0), (true, 1), (true, 5), (true, 6), (false, 10), (false, 10), (false, 0)];
    assert_eq!(timed!(iec::Tp, short), expected);
    assert_eq!(timed!(iec::Tp, [(0, true, 0), (1, true, 5), (2, false, 5)]), [(false, 0), (false, 0), (false, 0)]);
}

#[test]
fn edges_at_the_first_call() {
    let mut rise = iec::RTrig::new();
    assert_eq!(
        [true, true, false, true].map(|clk| {
            rise.call(clk);
            rise.q
        }),
        [true, false, false, true]
    );
    let mut fall = iec::FTrig::new();
    assert_eq!(
        [false, true, false, false].map(|clk| {
            fall.call(clk);
            fall.q
        }),
        [false, false, true, false]
    );
}

#[test]
fn one_input_of_a_bistable_dominates() {
    const INPUTS: [(bool, bool); 5] = [(false, false), (true, false), (false, false), (true, true), (false, true)];
    let mut sr = iec::Sr::new();
    assert_eq!(
        INPUTS.map(|(s1, r)| {
            sr.call(s1, r);
            sr.q1
        }),
        [false, true, true, true, false]
    );
    let mut rs = iec::Rs::new();
    assert_eq!(
        INPUTS.map(|(s, r1)| {
            rs.call(s, r1);
            rs.q1
        }),
        [false, true, true, false, false]
    );
}

#[test]
fn a_disabled_fbd_counter_does_nothing() {
    let mut counter =
        logix::FbdCounter { enable_in: true, cu_enable: true, enable_out: true, ..logix::FbdCounter::new() };
    counter.enable_in = false;
    counter.ctud();
    assert_eq!(counter, logix::FbdCounter { cu_enable: true, ..logix::FbdCounter::new() });
    counter.enable_in = true;
    counter.ctud();
    assert_eq!((counter.enable_out, counter.acc), (true, 1));
}

#[test]
fn a_rung_goes_through_its_instruction() {
    let mut counter = logix::Counter::new();
    for rung in [false, true] {
        assert_eq!([counter.ctu(rung), counter.ctd(rung), counter.res(rung)], [rung; 3]);
    }
}

/// `call` with these inputs, and the same inputs set one by one before a step, from many states.
macro_rules! call_is_inputs_and_step {
    ($block:ty: $($input:ident: $kind:ident),*) => {{
        let mut random = Random(7);
        let (mut called, mut stepped) = (<$block>::new(), <$block>::new());
        for _ in 0..1000 {
            $(let $input = random.$kind() as _;)*
            called.call($($input),*);
            $(stepped.$input = $input;)*
            stepped.step(&Context::default());
            assert_eq!(called, stepped);
        }
        // And it survives a way through bytes.
        let mut bytes = [0; size_of::<$block>()];
        called.store(&mut bytes);
        assert_eq!(<$block>::load(&bytes), called);
    }};
}

struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.0 >> 16
    }

    fn bit(&mut self) -> bool {
        self.next() % 2 == 1
    }

    fn number(&mut self) -> u8 {
        (self.next() % 8) as u8
    }
}

#[test]
fn a_call_is_inputs_and_a_step() {
    call_is_inputs_and_step!(iec::Ctu<i16>: cu: bit, r: bit, pv: number);
    call_is_inputs_and_step!(iec::Ctd<i64>: cd: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(iec::Ctud<u32>: cu: bit, cd: bit, r: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(cscape::Ctu: cu: bit, reset: bit, pv: number);
    call_is_inputs_and_step!(cscape::Ctd: cd: bit, load: bit, pv: number);
    call_is_inputs_and_step!(openplc::Ctu<u16>: cu: bit, r: bit, pv: number);
    call_is_inputs_and_step!(openplc::Ctd<i32>: cd: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(openplc::Ctud<i64>: cu: bit, cd: bit, r: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(openplc4::Ctd<u16>: cd: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(openplc4::Ctud<i32>: cu: bit, cd: bit, r: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(openplc4::CtudRising<u64>: cu: bit, cd: bit, r: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(s7::Ctu<i8>: cu: bit, r: bit, pv: number);
    call_is_inputs_and_step!(s7::CtdLdEdge<u8>: cd: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(s7::CtudLdEdge<i16>: cu: bit, cd: bit, r: bit, ld: bit, pv: number);
    call_is_inputs_and_step!(iec::RTrig: clk: bit);
    call_is_inputs_and_step!(iec::FTrig: clk: bit);
    call_is_inputs_and_step!(iec::Sr: s1: bit, r: bit);
    call_is_inputs_and_step!(iec::Rs: s: bit, r1: bit);
}

#[test]
fn every_counter_has_the_pins_that_counters_share() {
    for block in BLOCKS.iter().filter(|it| it.is_counter()) {
        let has = |role| block.pin_for(role).is_some();
        assert!(has(PinRole::Preset) && has(PinRole::Done), "{block:?}");
        assert!(has(PinRole::Up) || has(PinRole::Down), "{block:?}");
        let roles: Vec<_> = block.pins.iter().filter_map(|it| it.role).collect();
        assert!(roles.iter().all(|role| roles.iter().filter(|it| *it == role).count() == 1), "{block:?}: {roles:?}");
    }
}

#[test]
fn what_stands_for_a_block_is_pinned_as_it_is() {
    // What a memory holds may differ, and then has another name, so that no retained one is taken for it.
    let seen = |pin: &Pin| (pin.direction != Direction::Memory).then_some(pin.name);
    let pins = |it: &BlockInfo| it.pins.iter().map(|pin| (seen(pin), pin.ty, pin.offset)).collect::<Vec<_>>();
    let named = |family, name: &str| BLOCKS.iter().find(|it| it.family == family && it.name == name).expect("a block");
    for block in BLOCKS {
        let of = block.facts.option.map(|it| it.of).or(block.facts.kept.map(|it| it.plain));
        if let Some(of) = of {
            assert_eq!(pins(block), pins(named(block.family, of)), "{block:?}");
        }
    }
}

#[test]
fn time_that_a_test_lets_pass_goes_on_and_never_back() {
    let cx = Context::at(5);
    let mut block = iec::AdvanceTime::default();
    block.call(7, &cx);
    assert_eq!((cx.now(), block.in_), (12, 7));
    block.step(&cx);
    assert_eq!(cx.now(), 19);
    block.call(-3, &cx);
    assert_eq!(cx.now(), 19);
}

#[test]
fn a_task_is_due_once_from_each_multiple_of_its_interval_on() {
    let due = |interval, times: &[i64]| {
        let mut task = iec::TaskTurn::default();
        let mut at = |now| {
            task.call(false, interval, &Context::at(now));
            task.q
        };
        times.iter().map(|now| at(*now)).collect::<Vec<_>>()
    };
    assert_eq!(due(10, &[0, 0, 9, 10, 10, 35, 39, 40]), [true, false, false, true, false, true, false, true]);
    assert_eq!(due(1, &[0, 0, 1, 2, 2]), [true, false, true, true, false]);
    // An interval of none counts as the shortest.
    assert_eq!(due(0, &[0, 0, 1]), [true, false, true]);
    // Time that starts anew.
    assert_eq!(due(10, &[100, 3, 9, 10]), [true, true, false, true]);
}

#[test]
fn a_scan_tells_whether_it_is_the_first_and_how_far_the_next_one_is() {
    let told = |cx: Context| {
        let mut block = iec::ScanInfo::default();
        block.call(&cx);
        let called = (block.first, block.cycle);
        block = iec::ScanInfo::default();
        block.step(&cx);
        assert_eq!(called, (block.first, block.cycle));
        called
    };
    assert_eq!([told(Context::first(5)), told(Context::at(5))], [(true, 0), (false, 0)]);
    assert_eq!([told(Context::first(5).with_cycle(7)), told(Context::at(5).with_cycle(9))], [(true, 7), (false, 9)]);
    assert_eq!(Context::at(5).with_cycle(7).with_turns(3).cycle, 7);
}
