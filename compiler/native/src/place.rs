//! Places: where a variable, a field or an element is.

use crate::address::{Address, Class, Kind};
use crate::function::{Function, LocalSlot};
use cranelift_codegen::ir::{self as clif, InstBuilder, InstructionData, Opcode, condcodes::IntCC, types};
use cranelift_frontend::Variable;
use staunch_ir::loops::constant_position;
use staunch_ir::{Array, ArrayId, Expr, FaultKind, FieldId, Location, Place, Projection, Root, Type};

/// Where the value of a place is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PlaceValue {
    Variable(Variable),
    Memory(Address),
}

/// Of a member's storage.
pub(crate) fn class(of: Type, field: FieldId) -> Kind {
    match of {
        Type::Struct(id) => Kind::Class(Class::of_field(id, field)),
        Type::Block(id) => Kind::Class(Class::of_pin(id.info(), field.index())),
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Array(_) => Kind::Any,
    }
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
                    let address = Address { kind: class(ty, *field), ..address.plus(offset) };
                    (address, member.expect("verified IR: a member of the type"))
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

    fn element(&mut self, array: Address, id: ArrayId, index: &Expr, at: Location) -> Address {
        let (program, stride) = (self.module.program, self.module.layout.stride(id));
        if let Some(position) = constant_position(program, index, id) {
            return array.plus(position * stride);
        }
        let bounds = program.array(id);
        let needs_check = !self.known(&|known| known.is_within(index, id));
        let written = index;
        let index = self.index(written);
        if needs_check {
            // Below the lower bound the difference wraps, and is too large as well.
            let last = bounds.high.abs_diff(bounds.low).cast_signed();
            let narrow = self.narrow_index(index).filter(|_| is_of_32_bits(bounds));
            let tested = self.ins().iadd_imm_s(narrow.unwrap_or(index), bounds.low.wrapping_neg());
            let position = if narrow.is_some() { self.ins().uextend(types::I64, tested) } else { tested };
            if !self.seen.has(self.builder.current_block(), (index, id)) {
                let outside = self.ins().icmp_imm_u(IntCC::UnsignedGreaterThan, tested, last);
                self.fault_if(outside, FaultKind::IndexOutOfRange, at);
                self.seen.note(self.builder.current_block(), (index, id));
                self.note_index(written, id);
            }
            return self.element_at(array, position, stride);
        }
        // The distance is at most the length of the array.
        match self.sum(index, bounds.high.abs_diff(bounds.low)) {
            (None, index) => array.plus(index.abs_diff(bounds.low) * stride),
            (Some(index), further) => {
                let position = self.ins().iadd_imm_s(index, bounds.low.wrapping_neg());
                self.element_at(array.plus(further.unsigned_abs() * stride), position, stride)
            }
        }
    }

    /// The number of 32 bits whose sign an index has: a position that was tested at 32 bits is not extended by an instruction.
    fn narrow_index(&self, index: clif::Value) -> Option<clif::Value> {
        match self.instruction(index)? {
            InstructionData::Unary { opcode: Opcode::Sextend, arg } => {
                Some(*arg).filter(|it| self.builder.func.dfg.value_type(*it) == types::I32)
            }
            _ => None,
        }
    }

    fn element_at(&mut self, array: Address, position: clif::Value, stride: u64) -> Address {
        let stride = i64::try_from(stride).expect("verified IR: sizes are within 1 GiB");
        let distance = self.ins().imul_imm_s(position, stride);
        let base = self.ins().iadd(array.base, distance);
        Address { base, ..array }
    }
}

/// Whether a difference from the lower bound that wraps at 32 bits is beyond the last position.
fn is_of_32_bits(it: Array) -> bool {
    let [low, high] = [it.low, it.high].map(i32::try_from);
    low.is_ok() && high.is_ok() && i32::try_from(it.high.abs_diff(it.low)).is_ok()
}
