//! Places: where a variable, a field or an element is.

use crate::address::Address;
use crate::function::{Function, LocalSlot};
use cranelift_codegen::ir::{self as clif, InstBuilder, InstructionData, Opcode, condcodes::IntCC};
use cranelift_frontend::Variable;
use staunch_ir::loops::{Known, constant_position};
use staunch_ir::{ArrayId, Expr, FaultKind, LocalId, Location, Place, Projection, Root, Type};

/// Where the value of a place is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PlaceValue {
    Variable(Variable),
    Memory(Address),
}

impl Function<'_, '_> {
    pub(crate) fn place_value(&mut self, place: &Place) -> PlaceValue {
        if let Root::Local(id) = place.root
            && place.projections.is_empty()
            && let LocalSlot::Variable(variable) = self.locals[id.index()]
        {
            return PlaceValue::Variable(variable);
        }
        PlaceValue::Memory(self.address(place))
    }

    /// The address of a place that is not a variable of the code generator's.
    pub(crate) fn address(&mut self, place: &Place) -> Address {
        if place.is_followed() {
            return self.found(place);
        }
        let mut address = self.root(place.root);
        let root_type = self.module.program.root_type(self.routine, place.root);
        let mut ty = root_type.expect("verified IR: a root that the POU has");
        for projection in &place.projections {
            (address, ty) = match projection {
                Projection::Field(field) => {
                    let member = self.module.program.member(ty, *field);
                    let offset = self.module.layout.offset(ty, *field);
                    (address.plus(offset), member.expect("verified IR: a member of the type"))
                }
                Projection::Deref { .. } => unreachable!("a place that leads through no reference"),
                Projection::Index { index, at } => {
                    let Type::Array(id) = ty else { unreachable!("verified IR: an index into an array") };
                    (self.element(address, id, index, *at), self.module.program.array(id).element)
                }
            };
        }
        address
    }

    fn root(&mut self, root: Root) -> Address {
        match root {
            Root::Instance => Address::at(self.start.instance.expect("verified IR: a POU with an instance")),
            Root::Globals => Address::at(self.start.globals.expect("a function that uses globals gets them")),
            Root::Param(id) => Address::at(self.start.params[id.index()]),
            Root::Local(id) => match self.locals[id.index()] {
                LocalSlot::Slot(slot) => self.slot_address(slot),
                LocalSlot::Variable(_) => unreachable!("an elementary local without references to it"),
            },
        }
    }

    /// The 0-based position of an index whose code is a constant, as a counter's of an unrolled loop is.
    fn known_position(&self, index: clif::Value, array: ArrayId) -> Option<u64> {
        let dfg = &self.builder.func.dfg;
        let InstructionData::UnaryImm { opcode: Opcode::Iconst, imm } = dfg.insts[dfg.value_def(index).inst()?] else {
            return None;
        };
        let (index, array) = (imm.bits(), self.module.program.array(array));
        (array.low..=array.high).contains(&index).then(|| index.abs_diff(array.low))
    }

    fn element(&mut self, array: Address, id: ArrayId, index: &Expr, at: Location) -> Address {
        let (program, stride) = (self.module.program, self.module.layout.stride(id));
        if let Some(position) = constant_position(program, index, id) {
            return array.plus(position * stride);
        }
        let bounds = program.array(id);
        let checked = |id: LocalId| self.checked[id.index()];
        let known = Known { program, loops: &self.counters, checked: &checked };
        let needs_check = !known.is_within(index, id);
        let index = self.scalar(index);
        if let Some(position) = self.known_position(index, id).filter(|_| !needs_check) {
            return array.plus(position * stride);
        }
        // Below the lower bound the difference wraps, and is too large as well.
        let position = self.ins().iadd_imm_s(index, bounds.low.wrapping_neg());
        if needs_check {
            let last = bounds.high.abs_diff(bounds.low).cast_signed();
            let outside = self.ins().icmp_imm_u(IntCC::UnsignedGreaterThan, position, last);
            self.fault_if(outside, FaultKind::IndexOutOfRange, at);
        }
        let stride = i64::try_from(stride).expect("verified IR: sizes are within 1 GiB");
        let distance = self.ins().imul_imm_s(position, stride);
        let base = self.ins().iadd(array.base, distance);
        Address { base, ..array }
    }
}
