//! The turns that the loops of a scan take. While a loop runs, what is left of them is a variable; the
//! context gets it back where others may look: at the loop's end, at RETURN, and around calls that take turns. In a program that
//! handles faults the context alone has it.
//! A loop whose bounds say how many it has takes them all before the first one, or none where they are few.

use crate::address::Class;
use crate::function::{Few, Flow, Function};
use cranelift_codegen::ir as clif;
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, condcodes::IntCC, types};
use staunch_ir::{Block, FaultKind, Location, Repr, StatementKind, visit};
use staunch_runtime::Context;

/// The values that a loop's counter has, of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) first: clif::Value,
    pub(crate) last: clif::Value,
    pub(crate) repr: Repr,
    pub(crate) step: Size,
    /// Whether `last` is none of them.
    pub(crate) is_before: bool,
    /// Whether the loop's first test has found that there is a turn.
    pub(crate) is_tested: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Size {
    Constant(i128),
    Variable(clif::Value),
}

impl Way {
    /// Ways of constant steps that are shorter than this have few turns.
    fn most_of_few(&self) -> Option<u64> {
        let Size::Constant(step) = self.step else { return None };
        let size = u64::try_from(step.unsigned_abs()).unwrap_or(u64::MAX);
        Some(size.saturating_mul(Context::FREE_TURNS).saturating_add(u64::from(self.is_before)))
    }

    /// Whether 64 bits hold the way between any two values.
    fn is_narrow(&self) -> bool {
        self.repr.size() < 8
    }
}

impl<'p> Function<'_, 'p> {
    /// Before a loop, whose blocks may take turns. Returns whether it is the outermost that does.
    pub(crate) fn open_turns(&mut self, blocks: &[&Block]) -> bool {
        // A fault would leave them in a variable that is gone.
        let kept = !self.module.handles_faults;
        let opens = kept && self.turns.is_none() && blocks.iter().any(|it| has_turns(it));
        if opens {
            let variable = self.builder.declare_var(types::I64);
            self.turns = Some(variable);
            self.reload_turns();
        }
        opens
    }

    pub(crate) fn close_turns(&mut self, opened: bool, flow: Flow) -> Flow {
        if opened {
            if flow == Flow::Continues {
                self.spill_turns();
            }
            self.turns = None;
        }
        flow
    }

    /// Tells the context how many turns are left.
    pub(crate) fn spill_turns(&mut self) {
        let Some(variable) = self.turns else { return };
        let (context, offset) = self.turns_place();
        let left = self.builder.use_var(variable);
        let flags = self.of_turns();
        self.ins().store(flags, left, context, offset);
    }

    pub(crate) fn reload_turns(&mut self) {
        let Some(variable) = self.turns else { return };
        let (context, offset) = self.turns_place();
        let flags = self.of_turns();
        let left = self.ins().load(types::I64, flags, context, offset);
        self.builder.def_var(variable, left);
    }

    fn of_turns(&mut self) -> MemFlagsData {
        self.class_flags(Class::TURNS)
    }

    fn turns_place(&self) -> (clif::Value, i32) {
        let context = self.start.context.expect("a function that takes turns gets the context");
        (context, i32::try_from(Context::TURNS_OFFSET).expect("a context is small"))
    }

    /// Takes one of the scan's turns.
    pub(crate) fn take_turn(&mut self, at: Location) {
        if let Some(taken) = self.loops.last_mut().and_then(|it| it.taken.as_mut()) {
            *taken += 1;
            return;
        }
        let taken = match self.loops.last().map_or(Few::No, |it| it.few) {
            Few::No => None,
            Few::Yes => return,
            Few::Taken(it) => Some(it),
        };
        let left = self.turns_left();
        if let Some(taken) = taken {
            let is_short = self.ins().icmp(IntCC::UnsignedLessThan, left, taken);
            self.fault_if(is_short, FaultKind::LoopBudget, at);
            let rest = self.ins().isub(left, taken);
            return self.set_turns_left(rest);
        }
        // The rest is what is tested, so that it is found here, and not in a block of its own at the turn's end.
        let rest = self.ins().iadd_imm_s(left, -1);
        let was_none = self.ins().icmp_imm_s(IntCC::Equal, rest, -1);
        self.fault_if(was_none, FaultKind::LoopBudget, at);
        self.set_turns_left(rest);
    }

    /// Takes all turns before the first one, if there is any.
    pub(crate) fn take_ahead(&mut self, way: &Way, is_of_many: bool, at: Location) {
        let [take, go] = [(); 2].map(|()| self.builder.create_block());
        let is_free = if is_of_many { self.is_few(way) } else { self.is_past_last(way) };
        if is_of_many {
            self.builder.set_cold_block(take);
        }
        self.ins().brif(is_free, go, &[], take, &[]);
        self.go_on_in(take);
        let length = self.length(way);
        let further = self.further(way, length);
        let left = self.turns_left();
        let is_short = self.ins().icmp(IntCC::UnsignedGreaterThanOrEqual, further, left);
        self.fault_if(is_short, FaultKind::LoopBudget, at);
        let rest = self.ins().isub(left, further);
        let rest = self.ins().iadd_imm_s(rest, -1);
        self.set_turns_left(rest);
        self.ins().jump(go, &[]);
        self.go_on_in(go);
    }

    /// Whether the loop need not take its turns.
    pub(crate) fn is_few(&mut self, way: &Way) -> clif::Value {
        let length = self.length(way);
        let is_few = match way.most_of_few() {
            // 64 bits hold the way between narrower values, with its sign: it is below zero if no turn runs.
            Some(few) if way.is_narrow() => {
                let few = self.integer(types::I64, few.into());
                return self.ins().icmp(IntCC::SignedLessThan, length, few);
            }
            Some(few) => {
                let few = self.integer(types::I64, few.into());
                self.ins().icmp(IntCC::UnsignedLessThan, length, few)
            }
            None => {
                let further = self.further(way, length);
                let few = self.integer(types::I64, Context::FREE_TURNS.into());
                self.ins().icmp(IntCC::UnsignedLessThan, further, few)
            }
        };
        if way.is_tested {
            return is_few;
        }
        let past = self.is_past_last(way);
        self.ins().bor(past, is_few)
    }

    /// Whether the loop has turns, but few, for a way for which two instructions decide it.
    pub(crate) fn is_few_and_some(&mut self, way: &Way) -> Option<clif::Value> {
        let few = way.most_of_few().filter(|_| way.is_narrow())?;
        let length = self.length(way);
        // A way without a turn is below zero, which is large as an unsigned number.
        let before = u64::from(way.is_before);
        let length = if way.is_before { self.ins().iadd_imm_s(length, -1) } else { length };
        let few = self.integer(types::I64, (few - before).into());
        Some(self.ins().icmp(IntCC::UnsignedLessThan, length, few))
    }

    /// From the first value to the last.
    fn length(&mut self, way: &Way) -> clif::Value {
        let (up, down) = (self.ins().isub(way.last, way.first), self.ins().isub(way.first, way.last));
        self.by_direction(way, up, down)
    }

    fn is_past_last(&mut self, way: &Way) -> clif::Value {
        let (above, below) = if way.repr == Repr::U64 {
            (IntCC::UnsignedGreaterThan, IntCC::UnsignedLessThan)
        } else {
            (IntCC::SignedGreaterThan, IntCC::SignedLessThan)
        };
        let (up, down) = (self.ins().icmp(above, way.first, way.last), self.ins().icmp(below, way.first, way.last));
        let is_past = self.by_direction(way, up, down);
        if !way.is_before {
            return is_past;
        }
        let is_last = self.ins().icmp(IntCC::Equal, way.first, way.last);
        self.ins().bor(is_past, is_last)
    }

    fn by_direction(&mut self, way: &Way, up: clif::Value, down: clif::Value) -> clif::Value {
        match way.step {
            Size::Constant(step) if step > 0 => up,
            Size::Constant(_) => down,
            Size::Variable(_) if !way.repr.is_signed() => up,
            Size::Variable(step) => {
                let is_down = self.ins().icmp_imm_s(IntCC::SignedLessThan, step, 0);
                self.ins().select(is_down, down, up)
            }
        }
    }

    /// How many turns come after the first one, of which there is one.
    fn further(&mut self, way: &Way, length: clif::Value) -> clif::Value {
        let length = if way.is_before { self.ins().iadd_imm_s(length, -1) } else { length };
        let size = match way.step {
            Size::Constant(1 | -1) => return length,
            Size::Constant(step) => {
                let size = i128::try_from(step.unsigned_abs()).expect("verified IR: a step is of the counter's type");
                self.integer(types::I64, size)
            }
            Size::Variable(step) => {
                let opposite = self.ins().ineg(step);
                self.by_direction(way, step, opposite)
            }
        };
        self.ins().udiv(length, size)
    }

    fn turns_left(&mut self) -> clif::Value {
        if let Some(variable) = self.turns {
            return self.builder.use_var(variable);
        }
        let (context, offset) = self.turns_place();
        let flags = self.of_turns();
        self.ins().load(types::I64, flags, context, offset)
    }

    fn set_turns_left(&mut self, left: clif::Value) {
        if let Some(variable) = self.turns {
            return self.builder.def_var(variable, left);
        }
        let (context, offset) = self.turns_place();
        let flags = self.of_turns();
        self.ins().store(flags, left, context, offset);
    }

    /// RETURN leaves all loops.
    pub(crate) fn return_from_loops(&mut self) -> Flow {
        let taken = self.loops.iter().filter_map(|it| it.taken).sum();
        self.subtract_turns(taken);
        self.spill_turns();
        self.go(self.exit)
    }
}

fn has_turns(block: &Block) -> bool {
    let mut found = false;
    visit::statements(block, &mut |it| found |= matches!(it.kind, StatementKind::Turn));
    found
}
