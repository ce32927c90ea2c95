//! The symbols link under their names, the list is complete, and what they do is what the
//! runtime's safe functions do.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::HashMap;

use staunch_runtime::{
    BLOCKS, BlockInfo, Context, Direction, FaultKind, Repr, Text, Value, for_each_op, for_each_text_op, with_repr,
};

fn symbols() -> HashMap<&'static str, *const u8> {
    let mut symbols = HashMap::new();
    staunch_runtime_abi::for_each_symbol(&mut |name, address| {
        assert!(symbols.insert(name, address).is_none(), "{name} comes twice");
    });
    symbols
}

unsafe extern "C" {
    safe fn staunch_add_i16(a: i16, b: i16) -> i16;
    safe fn staunch_shl_u8(value: u8, count: i64) -> u8;
    safe fn staunch_lt_u16(a: u16, b: u16) -> bool;
    safe fn staunch_sel_f64(g: bool, in0: f64, in1: f64) -> f64;
    safe fn staunch_convert_f32_i32(value: f32) -> i32;
    safe fn staunch_trunc_f64_i8(value: f64) -> i8;
    fn staunch_div_i32(a: i32, b: i32, out: *mut i32) -> u8;
    fn staunch_in_range_u8(min: u8, value: u8, max: u8, out: *mut u8) -> u8;
    fn staunch_text_find(text: *const u8, pattern: *const u8) -> i16;
    fn staunch_text_concat(a: *const u8, b: *const u8, out: *mut u8, capacity: u16);
    fn staunch_text_mid(text: *const u8, count: i64, position: i64, out: *mut u8, capacity: u16);
    fn staunch_text_copy(from: *const u8, out: *mut u8, capacity: u16);
    fn staunch_text_append(from: *const u8, out: *mut u8, capacity: u16);
    fn staunch_text_clear(out: *mut u8, before: u16);
}

#[test]
fn operations_link_by_name() {
    assert_eq!(staunch_add_i16(i16::MAX, 1), i16::MIN);
    assert_eq!(staunch_shl_u8(1, 8), 0);
    assert!(!staunch_lt_u16(0x8000, 1));
    assert_eq!(staunch_sel_f64(true, 1.0, 2.0), 2.0);
    assert_eq!((staunch_convert_f32_i32(2.5), staunch_trunc_f64_i8(-300.0)), (2, -128));
}

#[test]
fn a_fault_leaves_the_result_alone() {
    let (mut quotient, mut ranged) = (77, 77);
    // SAFETY: the out pointers come from live variables.
    unsafe {
        assert_eq!(staunch_div_i32(1, 0, &mut quotient), FaultKind::DivideByZero as u8);
        assert_eq!(quotient, 77);
        assert_eq!(staunch_div_i32(7, -2, &mut quotient), 0);
        assert_eq!(staunch_in_range_u8(1, 9, 3, &mut ranged), FaultKind::SubrangeViolated as u8);
    }
    assert_eq!((quotient, ranged), (-3, 77));
}

#[test]
fn strings_pass_by_header() {
    let (a, b) = (Text::<8>::new(b"ABC"), Text::<3>::new(b"DE"));
    let mut out = Text::<4>::new(b"=");
    let (from_a, from_b) = ((&raw const a).cast(), (&raw const b).cast());
    let to: *mut u8 = (&raw mut out).cast();
    // SAFETY: the pointers are those of live strings, with the capacity of `out`.
    unsafe {
        assert_eq!(staunch_text_find(from_a, from_b), 0);
        staunch_text_concat(from_a, from_b, to, 4);
        assert_eq!(out, Text::new(b"=ABC"));
        to.cast::<u16>().write(0);
        staunch_text_mid(from_a, 9, 2, to, 4);
        staunch_text_clear(to, 4);
        assert_eq!(out, Text::new(b"BC"));
        staunch_text_append(from_b, to, 4);
        assert_eq!(out, Text::new(b"BCDE"));
        staunch_text_copy(from_a, to, 4);
        assert_eq!(out, Text::new(b"ABC"));
        staunch_text_copy(to, to, 4);
        assert_eq!(out, Text::new(b"ABC"));
    }
}

/// The rows of the operation table, each as often as its `T` has reprs.
macro_rules! count_operations {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident
        [$class:ident as $reprs:ident] $outcome:ident $($extensible:ident)?;)*) => {
        0 $(+ Repr::ALL.iter().filter(|it| with_repr!($reprs **it, T => size_of::<T>() > 0, false)).count())*
    };
}

/// The rows of the texts' table, twice those that are there for each unit.
macro_rules! count_text_operations {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident [$units:ident] $($extensible:ident)?;)*) => {
        0 $(+ count_text_operations!(@ $units))*
    };
    (@ each) => { 2 };
    (@ one) => { 1 };
}

#[test]
fn every_symbol_is_listed() {
    let symbols = symbols();
    // Pairs of reprs.
    let conversions = 11 * 11 + 2 * 8;
    // The functions of texts, and a copy for each unit.
    let strings = for_each_text_op!(count_text_operations) + 6;
    let references = 9;
    let instructions = BLOCKS.iter().flat_map(|block| block.instructions);
    let blocks: usize = instructions.map(|it| 1 + usize::from(it.prescan.is_some())).sum();
    assert_eq!(symbols.len(), for_each_op!(count_operations) + conversions + strings + blocks + references);
    assert!(symbols.values().all(|address| !address.is_null()));
}

/// An instance, aligned for any block.
struct Instance([u64; 16]);

impl Instance {
    fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: the words are initialised, and any byte may be part of one.
        unsafe { core::slice::from_raw_parts_mut(self.0.as_mut_ptr().cast(), size_of_val(&self.0)) }
    }
}

#[test]
fn instructions_do_what_the_interpreter_does() {
    let symbols = symbols();
    for block in BLOCKS {
        let mut random = 1;
        let (mut native, mut interpreted) = (Instance([0; 16]), Instance([0; 16]));
        // Miri is slow, and looks at how memory is used: few scans show that.
        for scan in 0..if cfg!(miri) { 2 } else { 500 } {
            let now = Context::at(scan * 3);
            for instruction in block.instructions {
                set_inputs(block, &mut random, native.bytes(), interpreted.bytes());
                let rung = next(&mut random) % 2 == 1;
                if let Some(prescan) = instruction.prescan.filter(|_| scan % 100 == 0) {
                    // SAFETY: a prescan has this signature, and the instance suits its block.
                    let shim: extern "C" fn(*mut u8) = unsafe { core::mem::transmute(symbols[prescan.symbol]) };
                    shim(native.bytes().as_mut_ptr());
                    (prescan.run)(interpreted.bytes());
                }
                // SAFETY: an instruction has this signature, and the instance suits its block.
                let shim: extern "C" fn(*mut u8, *const Context, bool) =
                    unsafe { core::mem::transmute(symbols[instruction.symbol]) };
                shim(native.bytes().as_mut_ptr(), &now, rung);
                (instruction.run)(interpreted.bytes(), &now, rung);
                for pin in block.pins {
                    let read = |instance: &mut Instance| Value::read(pin.repr(), &instance.bytes()[pin.offset..]);
                    assert_eq!(read(&mut native), read(&mut interpreted), "{block:?}.{}", pin.name);
                }
            }
        }
    }
}

/// Random bits and presets for what a caller sets; a count is left to the counting.
fn set_inputs(block: &BlockInfo, random: &mut u32, native: &mut [u8], interpreted: &mut [u8]) {
    let is_set = |direction| matches!(direction, Direction::Input | Direction::Member);
    for pin in block.pins.iter().filter(|pin| is_set(pin.direction) && pin.name != "ACC") {
        let value = pin.repr().integer(i128::from(next(random) % 2)).unwrap();
        value.write(&mut native[pin.offset..]);
        value.write(&mut interpreted[pin.offset..]);
    }
}

fn next(random: &mut u32) -> u32 {
    *random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    *random >> 16
}
