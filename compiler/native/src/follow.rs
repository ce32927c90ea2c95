//! Accesses through references: calls of the runtime, which checks each by the program's table of objects.

use crate::address::{Address, Kind};
use crate::function::{Function, Leads, MadeAddress};
use crate::place::class;
use crate::quiet;
use crate::runtime_call::by_pointer;
use crate::signature::clif_type;
use cranelift_codegen::ir::{self as clif, AbiParam, BlockArg, InstBuilder, InstructionData, MemFlagsData, Opcode};
use cranelift_codegen::ir::{condcodes::IntCC, types};
use staunch_ir::layout::{Shape, usize_of};
use staunch_ir::reference::{Followed, followed, view, wanted};
use staunch_ir::{ArrayId, Expr, FaultKind, Location, Place, Projection, StringType, Type};
use staunch_runtime::Repr;
use staunch_runtime::reference::{ORIGIN, Reference, Wanted};

/// A scalar or string that a reference leads to: the reference, and the distance from where it points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached {
    pub(crate) way: Way,
    pub(crate) ty: Type,
    at: Location,
    /// What is known of it where the reference has been looked up.
    kind: Kind,
}

/// How a reference is followed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) reference: clif::Value,
    /// From where the reference points to the variable that is looked up, in bytes; `None` if it points to it.
    near: Option<clif::Value>,
    /// The type of that.
    looked_up: Type,
    /// From where the reference points to what is looked at.
    pub(crate) distance: clif::Value,
    /// Where the reference leads, if it has been looked up before.
    leads: Option<Leads>,
}

impl Way {
    fn is_elsewhere(self) -> bool {
        matches!(self.leads, Some(Leads::Elsewhere))
    }
}

impl Function<'_, '_> {
    /// The words of the program's table, and the state.
    pub(crate) fn world(&mut self) -> [(AbiParam, clif::Value); 2] {
        let words = self.module.reference_table();
        let words = self.data_pointer(words);
        let state = self.start.globals.expect("a function that follows references gets the globals");
        [by_pointer(words), by_pointer(state)]
    }

    /// A scalar or string reached through a reference, except a standard block's pin, whose block is found whole.
    pub(crate) fn reached(&mut self, place: &Place) -> Option<Reached> {
        let program = self.module.program;
        let it = followed(program, place)?;
        let is_simple = program.repr(place.ty).is_some() || matches!(place.ty, Type::String(_));
        if it.pin.is_some() || !is_simple {
            return None;
        }
        Some(Reached { way: self.way(&it), ty: place.ty, at: it.at, kind: self.kind_of(&it) })
    }

    fn way(&mut self, it: &Followed<'_>) -> Way {
        let reference = self.load_place(&it.pointer);
        let (to_variable, inside) = it.way.split_at(it.subscripts());
        let (near, looked_up) = self.steps(None, it.target, to_variable);
        let (distance, _) = self.steps(near, looked_up, inside);
        let distance = distance.unwrap_or_else(|| self.ins().iconst(types::I64, 0));
        let leads = if near.is_none() { self.leads(&it.pointer, it.target) } else { None };
        Way { reference, near, looked_up, distance, leads }
    }

    /// A reference that has been looked up leads to a variable that is what it was declared to be.
    fn kind_of(&self, it: &Followed<'_>) -> Kind {
        let (mut ty, mut kind) = (it.target, Kind::Any);
        for projection in it.way {
            if let Projection::Field(field) = projection {
                kind = class(ty, *field);
            }
            ty = self.module.program.part(ty, projection).expect("verified IR: the way from a reference");
        }
        it.pin.map_or(kind, |(block, pin)| class(Type::Block(block), pin))
    }

    /// Steps from a distance after the start of a variable, and the type of what they lead to.
    fn steps(&mut self, from: Option<clif::Value>, ty: Type, steps: &[Projection]) -> (Option<clif::Value>, Type) {
        let (mut fixed, mut ty, mut distance) = (0, ty, from);
        for projection in steps {
            let program = self.module.program;
            ty = match (projection, ty) {
                (Projection::Field(field), _) => {
                    fixed += self.module.layout.offset(ty, *field);
                    program.member(ty, *field).expect("verified IR: a member of the type")
                }
                (Projection::Index { index, at }, Type::Array(id)) => {
                    let step = self.distance(id, index, *at);
                    distance = Some(match distance {
                        Some(before) => self.ins().iadd(before, step),
                        None => step,
                    });
                    program.array(id).element
                }
                (Projection::Index { .. } | Projection::Deref { .. }, _) => {
                    unreachable!("verified IR: the way from a reference")
                }
            };
        }
        let fixed = i64::try_from(fixed).expect("verified IR: sizes are within 1 GiB");
        let distance = match distance {
            Some(step) if fixed > 0 => Some(self.ins().iadd_imm_s(step, fixed)),
            None if fixed > 0 => Some(self.ins().iconst(types::I64, fixed)),
            Some(_) | None => distance,
        };
        (distance, ty)
    }

    /// The bytes from an array's start to an element.
    fn distance(&mut self, id: ArrayId, index: &Expr, at: Location) -> clif::Value {
        let bounds = self.module.program.array(id);
        let index = self.scalar(index);
        let position = self.ins().iadd_imm_s(index, bounds.low.wrapping_neg());
        let last = bounds.high.abs_diff(bounds.low).cast_signed();
        let outside = self.ins().icmp_imm_u(IntCC::UnsignedGreaterThan, position, last);
        self.fault_if(outside, FaultKind::IndexOutOfRange, at);
        let stride = i64::try_from(self.module.layout.stride(id)).expect("verified IR: sizes are within 1 GiB");
        self.ins().imul_imm_s(position, stride)
    }

    /// Calls a function that may fault, and continues if it does not.
    pub(crate) fn checked(&mut self, symbol: &str, arguments: &[(AbiParam, clif::Value)], at: Location) {
        let kind = self.call_runtime(symbol, arguments, Some(AbiParam::new(types::I8).uext()));
        self.fault_of_kind(kind.expect("an access returns its fault"), at);
    }

    fn space(&mut self, size: u64) -> (Address, clif::Value) {
        let address = self.temporary(Shape { size, align: 8 });
        (address, self.pointer(address))
    }

    pub(crate) fn load_reached(&mut self, it: Reached) -> clif::Value {
        if let Some(Leads::To(offset)) = it.way.leads {
            let address = self.there(it.way, offset, it.kind);
            return self.load(it.ty, address);
        }
        let repr = self.module.program.repr(it.ty).expect("a scalar reached through a reference");
        let Some((pointer, slow)) = self.in_line(it) else { return self.load_by_runtime(it, repr) };
        let done = self.builder.create_block();
        self.builder.append_block_param(done, clif_type(repr));
        self.read_any();
        let value = self.ins().load(clif_type(repr), anywhere(), pointer, 0);
        self.ins().jump(done, &[BlockArg::Value(value)]);
        self.builder.switch_to_block(slow);
        let value = self.load_by_runtime(it, repr);
        self.ins().jump(done, &[BlockArg::Value(value)]);
        self.go_on_in(done);
        self.builder.block_params(done)[0]
    }

    /// What a reference leads to that has been looked up.
    fn there(&mut self, way: Way, offset: clif::Value, kind: Kind) -> Address {
        let state = self.world()[1].1;
        let variable = self.ins().iadd(state, offset);
        Address { kind, ..Address::at(self.ins().iadd(variable, way.distance)) }
    }

    /// Where a scalar lies if it is found in line, and the block for all else, which is still to be filled.
    fn in_line(&mut self, it: Reached) -> Option<(clif::Value, clif::Block)> {
        if it.way.is_elsewhere() {
            return None;
        }
        let Some((offset, slow)) = self.expected(it.way.reference, it.way.near, it.way.looked_up) else {
            return self.plain(it);
        };
        let state = self.world()[1].1;
        let offset = match it.way.near {
            // The variable's own offset has been found.
            None => self.ins().iadd(offset, it.way.distance),
            Some(near) => {
                let inside = self.ins().isub(it.way.distance, near);
                self.ins().iadd(offset, inside)
            }
        };
        Some((self.ins().iadd(state, offset), slow))
    }

    fn load_by_runtime(&mut self, it: Reached, repr: Repr) -> clif::Value {
        let space = self.space(quiet::SPACE).0;
        self.access("staunch_reference_load", it, repr, space);
        self.load_as(clif_type(repr), space)
    }

    pub(crate) fn store_reached(&mut self, it: Reached, value: clif::Value) {
        if let Some(Leads::To(offset)) = it.way.leads {
            let address = self.there(it.way, offset, it.kind);
            return self.store(value, address);
        }
        let repr = self.module.program.repr(it.ty).expect("a scalar reached through a reference");
        let Some((pointer, slow)) = self.in_line(it) else { return self.store_by_runtime(it, repr, value) };
        let done = self.builder.create_block();
        self.ins().store(anywhere(), value, pointer, 0);
        self.ins().jump(done, &[]);
        self.builder.switch_to_block(slow);
        self.store_by_runtime(it, repr, value);
        self.ins().jump(done, &[]);
        self.go_on_in(done);
    }

    fn store_by_runtime(&mut self, it: Reached, repr: Repr, value: clif::Value) {
        let space = self.space(quiet::SPACE).0;
        self.store(value, space);
        self.access("staunch_reference_store", it, repr, space);
    }

    fn access(&mut self, symbol: &'static str, it: Reached, repr: Repr, space: Address) {
        let numbers = vec![view(self.module.program, it.ty).code(), repr.size()];
        self.access_away((symbol, numbers), [it.way.reference, it.way.distance], space, it.at);
    }

    /// A copy, in the frame, of a string reached through a reference.
    pub(crate) fn load_reached_text(&mut self, it: Reached, ty: StringType) -> Address {
        let shape = self.module.layout.shape(it.ty);
        let (space, out) = self.space(shape.size);
        self.set_length(space, 0);
        let [words, state] = self.world();
        let limit = self.integer(types::I16, i128::from(ty.capacity));
        let [reference, distance] = [it.way.reference, it.way.distance].map(|value| (AbiParam::new(types::I64), value));
        let arguments = [words, state, reference, distance, by_pointer(out), self.by_repr(Repr::U16, limit)];
        let symbol = if ty.wide { "staunch_reference_load_wide_text" } else { "staunch_reference_load_text" };
        self.checked(symbol, &arguments, it.at);
        space
    }

    /// Writes a string through a reference, from a copy: it may be in the same memory.
    pub(crate) fn store_reached_text(&mut self, it: Reached, value: &Expr) {
        let shape = self.module.layout.shape(value.ty);
        let (space, from) = self.space(shape.size);
        self.write_copy(value, space);
        let [words, state] = self.world();
        let [reference, distance] = [it.way.reference, it.way.distance].map(|value| (AbiParam::new(types::I64), value));
        let arguments = [words, state, reference, distance, by_pointer(from)];
        let wide = value.ty.string_type().is_some_and(|it| it.wide);
        let symbol = if wide { "staunch_reference_store_wide_text" } else { "staunch_reference_store_text" };
        self.checked(symbol, &arguments, it.at);
    }

    /// Where a variable reached through a reference is, to be passed on whole.
    pub(crate) fn found(&mut self, place: &Place) -> Address {
        let program = self.module.program;
        let it = followed(program, place).expect("a place that leads through a reference");
        let way = self.way(&it);
        let pin = it.pin.map_or(0, |(block, pin)| self.module.layout.offset(Type::Block(block), pin));
        if let Some(Leads::To(offset)) = way.leads {
            return self.there(way, offset, self.kind_of(&it)).plus(pin);
        }
        let (reference, distance) = (way.reference, way.distance);
        let wanted = wanted(program, it.ty);
        let done = match (self.found_in_line(way), wanted) {
            (Some(done), _) => Some(done),
            (None, Wanted::Exact(id)) if !way.is_elsewhere() => self.whole(reference, distance, (id, it.ty)),
            (None, Wanted::Exact(_) | Wanted::Repr(_) | Wanted::Text(_)) => None,
        };
        let space = self.space(quiet::SPACE).0;
        let state = self.world()[1];
        self.access_away(("staunch_reference_find", vec![wanted.code()]), [reference, distance], space, it.at);
        let mut offset = self.load_as(types::I64, space);
        if let Some(done) = done {
            self.ins().jump(done, &[BlockArg::Value(offset)]);
            self.go_on_in(done);
            offset = self.builder.block_params(done)[0];
        }
        let base = self.ins().iadd(state.1, offset);
        Address::at(base).plus(pin)
    }

    /// Goes to the block that is returned, with the offset of what is where it is expected.
    fn found_in_line(&mut self, way: Way) -> Option<clif::Block> {
        if way.is_elsewhere() {
            return None;
        }
        let (offset, slow) = self.expected(way.reference, way.near, way.looked_up)?;
        let done = self.builder.create_block();
        self.builder.append_block_param(done, types::I64);
        let inside = match way.near {
            None => way.distance,
            Some(near) => self.ins().isub(way.distance, near),
        };
        let offset = self.ins().iadd(offset, inside);
        self.ins().jump(done, &[BlockArg::Value(offset)]);
        self.builder.switch_to_block(slow);
        Some(done)
    }

    /// The reference to a place.
    pub(crate) fn reference_to(&mut self, place: &Place) -> clif::Value {
        if let Some(it) = followed(self.module.program, place) {
            let way = self.way(&it);
            return self.advanced(way.reference, way.distance);
        }
        let address = self.address(place);
        let pointer = self.pointer(address);
        let [words, state] = self.world();
        let offset = match self.distance_from(state.1, pointer) {
            Some(distance) => distance,
            None => self.ins().isub(pointer, state.1),
        };
        if let Some(object) = self.module.targets().object_of(self.routine, place) {
            let first = Reference { object, address: ORIGIN }.bits();
            let reference = self.ins().iadd_imm_s(offset, first.cast_signed());
            self.made = Some(MadeAddress { reference, offset, ty: place.ty });
            return reference;
        }
        let size = usize_of(self.module.layout.size(place.ty));
        let size = i64::try_from(size).expect("verified IR: sizes are within 1 GiB");
        let size = self.ins().iconst(types::I64, size);
        let arguments = [words, (AbiParam::new(types::I64), offset), (AbiParam::new(types::I64), size)];
        let bits = self.call_runtime("staunch_reference_address", &arguments, Some(AbiParam::new(types::I64)));
        bits.expect("an address is returned")
    }

    /// What was added to `start` for a pointer, if that is seen.
    fn distance_from(&mut self, start: clif::Value, pointer: clif::Value) -> Option<clif::Value> {
        let Some(InstructionData::Binary { opcode: Opcode::Iadd, args: [a, b] }) = self.instruction(pointer).copied()
        else {
            return None;
        };
        match (a == start, b == start) {
            (true, _) => Some(b),
            (_, true) => Some(a),
            (false, false) => {
                let first = self.distance_from(start, a)?;
                Some(self.ins().iadd(first, b))
            }
        }
    }

    /// As `ops::advance` does it.
    pub(crate) fn advanced(&mut self, reference: clif::Value, distance: clif::Value) -> clif::Value {
        let moved = self.ins().iadd(reference, distance);
        let low = self.ins().ireduce(types::I32, moved);
        let low = self.ins().uextend(types::I64, low);
        let high = self.code(!u64::from(u32::MAX));
        let high = self.ins().band(reference, high);
        self.ins().bor(low, high)
    }
}

/// A number reached through a reference may be at any address: all targets read and write it there.
fn anywhere() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}
