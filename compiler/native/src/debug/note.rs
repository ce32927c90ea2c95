//! While a routine's code is made: which statement an instruction belongs to, and what a debugger finds in the frame.

use super::noted::Place;
use crate::address::Address;
use crate::function::{Function, LocalSlot};
use cranelift_codegen::ir::{InstBuilder, SourceLoc, StackSlot, Value, types};
use staunch_ir::layout::Shape;
use staunch_ir::{Location, Mode};

/// A pointer in the frame.
const WORD: Shape = Shape { size: 8, align: 8 };

impl Function<'_, '_> {
    /// Keeps in the frame what leads to the variables, and says where all of them are.
    pub(crate) fn note_start(&mut self) {
        if self.noted.is_none() {
            return;
        }
        self.note_place(self.routine.location, false);
        let instance = self.start.instance.map(|it| self.kept(it));
        let modes = self.routine.params.iter().map(|it| it.mode);
        let pointers: Vec<_> = modes.zip(self.start.params.clone()).collect();
        let kept = |(mode, value)| (mode == Mode::Reference).then(|| self.kept(value));
        let params = pointers.into_iter().map(kept).collect();
        let locals = self.locals.iter().map(|it| match it {
            LocalSlot::Slot(slot) => *slot,
            LocalSlot::Variable(_) => unreachable!("all locals are in the frame of code for debugging"),
        });
        let locals = locals.collect();
        if let Some(noted) = &mut self.noted {
            (noted.instance, noted.params, noted.locals) = (instance, params, locals);
        }
    }

    fn kept(&mut self, pointer: Value) -> StackSlot {
        let slot = self.slot(WORD);
        let target = self.slot_address(slot);
        self.store(pointer, target);
        slot
    }

    /// What is emitted next belongs to the statement or condition at a place.
    pub(crate) fn note_statement(&mut self, at: Location) {
        self.note_place(at, true);
    }

    /// What is emitted next ends the function.
    pub(crate) fn note_end(&mut self) {
        let last = self.routine.body.last().map_or(self.routine.location, |it| it.at);
        self.note_place(last, false);
    }

    fn note_place(&mut self, at: Location, is_statement: bool) {
        let Some(noted) = &mut self.noted else { return };
        let number = u32::try_from(noted.places.len()).expect("a program has fewer statements");
        noted.places.push(Place { at, is_statement });
        self.builder.set_srcloc(SourceLoc::new(number));
    }

    /// Gives a jump an instruction at which a debugger can stop: a jump alone may become a part of what leads to it.
    pub(crate) fn note_jump(&mut self) {
        let Some(known) = self.noted.as_ref().map(|it| it.jumps) else { return };
        let slot = known.unwrap_or_else(|| self.slot(WORD));
        if let Some(noted) = &mut self.noted {
            noted.jumps = Some(slot);
        }
        let target: Address = self.slot_address(slot);
        let any = self.ins().iconst(types::I8, 0);
        self.store(any, target);
    }
}
