//! Random programs of pointers: in each scan one operation, whatever it does. What they must do follows from
//! `docs/references.md` alone.

use std::fmt::Write;

/// How many programs are also compiled as generated Rust.
pub const PRINTED: u64 = 4;
/// Operations of each, and scans.
pub const OPERATIONS: usize = 150;

/// Pointers, with the sizes of what they point to; a BOOL's is 0.
pub const POINTERS: [(&str, u32); 8] =
    [("bp0", 1), ("bp1", 1), ("wp0", 2), ("wp1", 2), ("dp", 4), ("lp", 8), ("op", 0), ("bp2", 1)];

/// What is pointed to: the text after ADR, the variable of the program that it is in, and the way from there.
pub const TARGETS: [(&str, &str); 16] = [
    ("bytes", "bytes"),
    ("bytes[3]", "bytes"),
    ("words", "words"),
    ("words[6]", "words"),
    ("number", "number"),
    ("frame", "frame"),
    ("frame.word", "frame"),
    ("frame.long", "frame"),
    ("frame.truth", "frame"),
    ("text", "text"),
    ("flag", "flag"),
    ("colour", "colour"),
    ("motor", "motor"),
    ("links", "links"),
    ("frames[1].long", "frames"),
    ("small", "small"),
];

#[derive(Clone, Copy, Debug)]
pub enum Operation {
    Address { pointer: usize, target: usize },
    Move { to: usize, from: usize, by: i64 },
    Null { pointer: usize },
    Load { pointer: usize },
    Store { pointer: usize, value: u64 },
    Copy { to: usize, from: usize, count: u32 },
    Fill { to: usize, value: u8, count: u32 },
    Compare { a: usize, b: usize, count: u32 },
}

/// The operations of a program.
pub fn operations(seed: u64) -> Vec<Operation> {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    // Most pointers point to something before they are used.
    let first = (0..POINTERS.len()).map(|pointer| Operation::Address { pointer, target: pointer });
    let mut all: Vec<_> = first.collect();
    all.extend((0..OPERATIONS - POINTERS.len()).map(|_| operation(&mut random)));
    all
}

fn operation(random: &mut Random) -> Operation {
    let pointer = random.below(POINTERS.len());
    let other = random.below(POINTERS.len());
    let count = [1, 2, 3, 4, 8, 12, 25, 60][random.below(8)];
    match random.below(20) {
        0..5 => Operation::Address { pointer, target: random.below(TARGETS.len()) },
        5..9 => {
            let by = [-70_000, -9, -4, -2, -1, 1, 1, 2, 3, 4, 4, 8, 17, 1 << 33][random.below(14)];
            Operation::Move { to: pointer, from: other, by }
        }
        9 if random.below(4) == 0 => Operation::Null { pointer },
        9..13 => Operation::Load { pointer },
        13..17 => {
            let value = if random.below(3) == 0 { 0 } else { random.next() };
            Operation::Store { pointer, value }
        }
        17 => Operation::Fill { to: pointer, value: [0, 1, 65, 200][random.below(4)], count },
        18 => Operation::Copy { to: pointer, from: other, count },
        _ => Operation::Compare { a: pointer, b: other, count },
    }
}

/// The value that a store writes, cut to what its pointer points to.
pub fn cut(value: u64, size: u32) -> u64 {
    match size {
        0 => value & 1,
        8 => value,
        size => value & ((1 << (8 * size)) - 1),
    }
}

/// The name of a program among the generated modules.
pub fn module(seed: u64) -> String {
    format!("pointers_{seed}")
}

pub fn program(seed: u64) -> String {
    let mut text = String::from(
        "TYPE Colour : (Red, Green, Blue); END_TYPE\n\
         TYPE Frame : STRUCT byte_ : BYTE; word : WORD; long : DINT; truth : BOOL; colour : Colour; small : INT(-9..9); \
         name : STRING[4]; tail : ARRAY[0..2] OF WORD; END_STRUCT END_TYPE\n\
         FUNCTION_BLOCK Motor\nVAR_INPUT speed : INT; END_VAR\nVAR count : DINT; timer : TON; link : POINTER TO BYTE; END_VAR\n\
         count := count + speed;\nEND_FUNCTION_BLOCK\n\
         PROGRAM Main\nVAR\n\
         bytes : ARRAY[0..15] OF BYTE; flag : BOOL; words : ARRAY[0..7] OF WORD; number : DINT; frame : Frame;\n\
         text : STRING[6]; colour : Colour; motor : Motor; links : ARRAY[0..1] OF POINTER TO INT; frames : ARRAY[0..1] OF Frame;\n\
         small : INT(0..5); step : INT; got : LWORD; truth : BOOL; done : UDINT; order : DINT; n : UDINT;\n\
         bp0, bp1, bp2 : POINTER TO BYTE; wp0, wp1 : POINTER TO WORD; dp : POINTER TO DWORD; lp : POINTER TO LWORD;\n\
         op : POINTER TO BOOL;\nEND_VAR\nstep := step + 1;\nCASE step OF\n",
    );
    for (number, operation) in (1..).zip(operations(seed)) {
        let _ = writeln!(text, "{number}: {}", statement(operation));
    }
    text.push_str("END_CASE\nEND_PROGRAM\n");
    text
}

fn statement(operation: Operation) -> String {
    let name = |at: usize| POINTERS[at].0;
    match operation {
        Operation::Address { pointer, target } => format!("{} := ADR({});", name(pointer), TARGETS[target].0),
        Operation::Move { to, from, by } => format!("{} := {} + ({by});", name(to), name(from)),
        Operation::Null { pointer } => format!("{} := NULL;", name(pointer)),
        Operation::Load { pointer } => match POINTERS[pointer].1 {
            0 => format!("truth := {}^;", name(pointer)),
            _ => format!("got := {}^;", name(pointer)),
        },
        Operation::Store { pointer, value } => match POINTERS[pointer].1 {
            0 => format!("{}^ := {};", name(pointer), if value & 1 == 1 { "TRUE" } else { "FALSE" }),
            size => format!("{}^ := 16#{:X};", name(pointer), cut(value, size)),
        },
        Operation::Copy { to, from, count } => format!("done := MEMCPY({}, {}, {count});", name(to), name(from)),
        Operation::Fill { to, value, count } => {
            format!("n := {count}; done := MEMSET({}, {value}, n);", name(to))
        }
        Operation::Compare { a, b, count } => {
            format!("n := {count}; order := MEMCMP({}, {}, n);", name(a), name(b))
        }
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        usize::try_from((self.next() >> 8) % u64::try_from(limit).expect("a small limit")).expect("below a usize")
    }
}
