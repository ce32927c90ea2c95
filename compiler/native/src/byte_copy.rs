//! A loop that copies bytes through references: one call of the runtime takes the place of all its turns.

use crate::control::{Control, Known};
use crate::function::{Flow, Function};
use crate::place::PlaceValue;
use cranelift_codegen::ir::{self as clif, AbiParam, InstBuilder, types};
use staunch_ir::byte_copy::{ByteCopy, byte_copy};
use staunch_ir::{For, Location, Place, Taking};

impl<'p> Function<'_, 'p> {
    /// The loop as a call, where it is a copy.
    pub(crate) fn copied(&mut self, it: &'p For, at: Location) -> Option<Flow> {
        let copy = byte_copy(it).filter(|_| !matches!(it.taking, Taking::EachOfMany))?;
        let running = self.start_for(it, at);
        let control = Control::Count(running);
        let [start, after] = [(); 2].map(|()| self.builder.create_block());
        self.further_turn(&control, start, after);
        self.go_on_in(start);
        if let Taking::Ahead(at) | Taking::AheadOfMany(at) = it.taking {
            let way = self.way_of(&Known::For(running), true);
            self.take_ahead(&way, it.taking.is_of_many(), at);
        }
        let count = self.last(&running);
        self.copy_behind(&copy, count);
        let end = self.ins().iadd_imm_s(count, 1);
        self.set_counter(&running, end, true);
        self.ins().jump(after, &[]);
        self.go_on_in(after);
        self.set_late(&running);
        Some(Flow::Continues)
    }

    /// The bytes, and the references after them.
    fn copy_behind(&mut self, copy: &ByteCopy<'_>, count: clif::Value) {
        let by = self.scalar(copy.by);
        let pointers = [copy.to, copy.from].map(|it| self.load_place(it));
        let number = |value| (AbiParam::new(types::I64), value);
        let [words, state] = self.world();
        let arguments = [words, state, number(pointers[0]), number(pointers[1]), number(count), number(by)];
        self.checked("staunch_reference_copy", &arguments, copy.at);
        let way = self.ins().imul(count, by);
        for (place, pointer) in [copy.to, copy.from].into_iter().zip(pointers) {
            let moved = self.advanced(pointer, way);
            self.set_local(place, moved);
        }
    }

    fn set_local(&mut self, place: &Place, value: clif::Value) {
        match self.place_value(place) {
            PlaceValue::Variable(variable) => self.builder.def_var(variable, value),
            PlaceValue::Memory(address) => self.store(value, address),
        }
    }
}
