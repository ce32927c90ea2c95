//! Every instruction and prescan of the standard blocks, inline or called, does what the runtime's
//! own step does to every member.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_ir::*;
use staunch_runtime::{BLOCKS, BlockInfo, Context};
use support::*;

/// Repeatable and good enough: xorshift.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.next() % u64::try_from(limit).unwrap()).unwrap()
    }

    /// Often an edge, else any bits.
    fn value(&mut self, repr: Repr) -> Value {
        let edges = edges(repr);
        if repr == Repr::Bool || !self.next().is_multiple_of(4) {
            return edges[self.below(edges.len())];
        }
        Value::read(repr, &self.next().to_ne_bytes())
    }
}

/// The block is field 0; the inputs are the fields after it.
fn program_of(id: BlockId, instruction: usize, is_prescan: bool) -> Program {
    let info = id.info();
    let reprs = inputs(info, instruction);
    let mut fields = vec![zero("block", Type::Block(id))];
    fields.extend(reprs.iter().map(|repr| zero("input", elementary(*repr))));
    let block = || member(StructId(0), 0, Type::Block(id));
    let input = |(at, repr): (usize, &Repr)| load(member(StructId(0), at + 1, elementary(*repr)));
    let kind = if is_prescan {
        StatementKind::PrescanBlock { block: block(), instruction }
    } else {
        let inputs = reprs.iter().enumerate().map(input).collect();
        StatementKind::CallBlock { block: block(), instruction, inputs }
    };
    let main = Routine { body: vec![stmt(kind)], ..routine(RoutineKind::Body, "Main", Some(StructId(0))) };
    program(Vec::new(), vec![structure("Main", fields)], vec![main])
}

fn inputs(info: &BlockInfo, instruction: usize) -> Vec<Repr> {
    if info.instructions[instruction].takes_rung {
        return vec![Repr::Bool];
    }
    info.inputs().map(|pin| pin.repr()).collect()
}

fn drive(id: BlockId, instruction: usize, is_prescan: bool, random: &mut Random) {
    let info = id.info();
    let program = program_of(id, instruction, is_prescan);
    let mut native = Native::new(&program);
    let start = native.offset(&program, 0, 0);
    let mut expected = vec![0; info.size];
    for turn in 0..3000 {
        // Now and then from anywhere; mostly on from where it is.
        if turn % 7 == 0 {
            for pin in info.pins {
                random.value(pin.repr()).write(&mut expected[pin.offset..]);
            }
            native.write(start, &expected);
        }
        let cx = Context::new(i64::from(turn) * 1_000_000, random.next().is_multiple_of(5));
        let values: Vec<_> = inputs(info, instruction).into_iter().map(|repr| random.value(repr)).collect();
        for (at, value) in values.iter().enumerate() {
            let offset = native.offset(&program, 0, at + 1);
            native.write_value(offset, *value);
        }
        let before = expected.clone();
        native.scan(0, &cx).unwrap();
        run(info, instruction, is_prescan, &mut expected, &cx, &values);
        for pin in info.pins {
            let found = Value::read(pin.repr(), &native.state()[start + pin.offset..]);
            let wanted = Value::read(pin.repr(), &expected[pin.offset..]);
            assert_eq!(found, wanted, "{info:?}.{} after {values:?} from {before:?}", pin.name);
        }
    }
}

fn run(info: &BlockInfo, instruction: usize, is_prescan: bool, bytes: &mut [u8], cx: &Context, values: &[Value]) {
    let instruction = &info.instructions[instruction];
    if is_prescan {
        return (instruction.prescan.unwrap().run)(bytes);
    }
    if instruction.takes_rung {
        return (instruction.run)(bytes, cx, values[0] == Value::Bool(true));
    }
    for (pin, value) in info.inputs().zip(values) {
        value.write(&mut bytes[pin.offset..]);
    }
    (instruction.run)(bytes, cx, true);
}

/// Every second block from `first` on: the two halves are tests, so that they run at once.
fn drive_half(first: usize) {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    for number in (first..BLOCKS.len()).step_by(2) {
        let id = BlockId::next(number);
        for (at, instruction) in id.info().instructions.iter().enumerate() {
            drive(id, at, false, &mut random);
            if instruction.prescan.is_some() {
                drive(id, at, true, &mut random);
            }
        }
    }
}

#[test]
fn every_instruction_of_every_even_block() {
    drive_half(0);
}

#[test]
fn every_instruction_of_every_odd_block() {
    drive_half(1);
}
