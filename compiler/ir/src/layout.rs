//! Where everything lies: sizes, alignments and offsets as `repr(C)` gives them on every target,
//! and the bytes that a program starts with.
//!
//! A program's whole state is one block, `Machine { globals, instance 0, instance 1, … }`.

use crate::{Array, ArrayId, BlockId, Const, FieldId, Local, Location, Program, StructId, Type};
use staunch_runtime::Repr;

/// The greatest size of a type, and of a program's whole state, in bytes: 1 GiB.
pub const MAX_SIZE: u64 = 1 << 30;

/// Size and alignment, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub size: u64,
    pub align: u64,
}

/// A type, or the whole state, needs more than [`MAX_SIZE`] bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// `None` when no single type is to blame, but the sum.
    pub ty: Option<Type>,
    /// The field, structure or routine where it was noticed.
    pub at: Option<Location>,
}

/// The program's state as a whole.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Machine {
    pub size: u64,
    pub align: u64,
    /// Offset of the globals.
    pub globals: u64,
    /// Offset of each of the program's instances.
    pub instances: Vec<u64>,
}

/// The layout of every type of a program.
#[derive(Clone, Debug)]
pub struct Layout {
    enums: Vec<Repr>,
    arrays: Vec<Option<Shape>>,
    elements: Vec<Type>,
    structs: Vec<StructLayout>,
    pub machine: Machine,
}

#[derive(Clone, Debug)]
struct StructLayout {
    shape: Shape,
    offsets: Vec<u64>,
}

/// Members laid one after the other, each at its own alignment.
#[derive(Clone, Debug)]
struct Sequence {
    size: u64,
    align: u64,
}

/// The variables that live for one call of a routine, as the interpreter keeps them.
#[derive(Clone, Debug)]
pub struct FrameLayout {
    pub size: u64,
    /// Offset of each local.
    pub offsets: Vec<u64>,
}

impl Layout {
    /// # Panics
    /// If the program needs more than [`MAX_SIZE`] bytes, which verified IR excludes.
    pub fn new(program: &Program) -> Self {
        Self::try_new(program).expect("verified IR: sizes are within the limit")
    }

    /// The layout of a program whose ids are sound.
    pub fn try_new(program: &Program) -> Result<Self, TooLarge> {
        let mut layout = Self::try_types(program)?;
        for routine in &program.routines {
            let at = Some(routine.location);
            layout.try_frame(&routine.locals).map_err(|ty| TooLarge { ty, at })?;
        }
        layout.machine = layout.lay_machine(program)?;
        Ok(layout)
    }

    /// The layout of a program's types alone, with an empty `machine`. It relies on the order
    /// of structures and arrays (a part is before what it is a part of) and on no routine.
    pub fn try_types(program: &Program) -> Result<Self, TooLarge> {
        let mut layout = Self {
            enums: program.enums.iter().map(|it| it.base.repr()).collect(),
            arrays: vec![None; program.arrays.len()],
            elements: program.arrays.iter().map(|array| array.element).collect(),
            structs: Vec::with_capacity(program.structs.len()),
            machine: Machine::default(),
        };
        for structure in &program.structs {
            let of_struct = layout.lay_struct(program, structure)?;
            layout.structs.push(of_struct);
        }
        for id in 0..program.arrays.len() {
            layout.measure(program, Type::Array(ArrayId::next(id)), None)?;
        }
        Ok(layout)
    }

    fn lay_struct(&mut self, program: &Program, structure: &crate::Struct) -> Result<StructLayout, TooLarge> {
        let mut sequence = Sequence { align: structure.align, ..Sequence::new() };
        let mut offsets = Vec::with_capacity(structure.fields.len());
        for field in &structure.fields {
            let shape = self.measure(program, field.ty, Some(field.location))?;
            let too_large = TooLarge { ty: None, at: Some(field.location) };
            offsets.push(sequence.push(shape).ok_or(too_large)?);
        }
        let shape = sequence.shape().ok_or(TooLarge { ty: None, at: Some(structure.location) })?;
        Ok(StructLayout { shape, offsets })
    }

    /// The shape of `ty`; an array met for the first time is measured and remembered.
    fn measure(&mut self, program: &Program, ty: Type, at: Option<Location>) -> Result<Shape, TooLarge> {
        let Type::Array(id) = ty else { return Ok(self.shape(ty)) };
        if let Some(known) = self.arrays[id.index()] {
            return Ok(known);
        }
        let array = program.array(id);
        let element = self.measure(program, array.element, at)?;
        let shape = array_shape(array, element).ok_or(TooLarge { ty: Some(ty), at })?;
        self.arrays[id.index()] = Some(shape);
        Ok(shape)
    }

    fn lay_machine(&self, program: &Program) -> Result<Machine, TooLarge> {
        let too_large = TooLarge { ty: None, at: None };
        let mut sequence = Sequence::new();
        let globals = sequence.push(self.shape(Type::Struct(program.globals))).ok_or(too_large)?;
        let mut instances = Vec::with_capacity(program.instances.len());
        for instance in &program.instances {
            let shape = self.shape(Type::Struct(state_of(program, instance)));
            instances.push(sequence.push(shape).ok_or(too_large)?);
        }
        let Shape { size, align } = sequence.shape().ok_or(too_large)?;
        Ok(Machine { size, align, globals, instances })
    }

    pub fn shape(&self, ty: Type) -> Shape {
        match ty {
            Type::Elementary(it) | Type::Subrange(it, _) => repr_shape(it.repr()),
            Type::String(it) => Shape { size: it.size().into(), align: 2 },
            Type::Enum(id) => repr_shape(self.enums[id.index()]),
            Type::Array(id) => self.arrays[id.index()].expect("every array has been measured"),
            Type::Struct(id) => self.structs[id.index()].shape,
            Type::Block(id) => block_shape(id),
            Type::Reference(_) => repr_shape(Repr::U64),
        }
    }

    /// Size in bytes.
    pub fn size(&self, ty: Type) -> u64 {
        self.shape(ty).size
    }

    /// Alignment in bytes.
    pub fn align(&self, ty: Type) -> u64 {
        self.shape(ty).align
    }

    /// Bytes from one element of an array to the next.
    pub fn stride(&self, array: ArrayId) -> u64 {
        self.size(self.elements[array.index()])
    }

    /// Offset of a field in its structure.
    pub fn field(&self, structure: StructId, field: FieldId) -> u64 {
        self.structs[structure.index()].offsets[field.index()]
    }

    /// Offset of a structure's field or a standard block's pin in a value of type `ty`.
    pub fn offset(&self, ty: Type, field: FieldId) -> u64 {
        match ty {
            Type::Struct(id) => self.field(id, field),
            Type::Block(id) => pin_offset(id, field),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => {
                unreachable!("verified IR: only structures and blocks have fields")
            }
        }
    }

    /// The layout of a routine's locals, one after the other.
    pub fn frame(&self, locals: &[Local]) -> FrameLayout {
        self.try_frame(locals).expect("verified IR: sizes are within the limit")
    }

    fn try_frame(&self, locals: &[Local]) -> Result<FrameLayout, Option<Type>> {
        let mut sequence = Sequence::new();
        let offsets = locals.iter().map(|local| sequence.push(self.shape(local.ty)).ok_or(Some(local.ty)));
        let offsets = offsets.collect::<Result<_, _>>()?;
        Ok(FrameLayout { size: sequence.size, offsets })
    }

    /// The bytes of the whole machine before its first scan; all-zero padding.
    pub fn image(&self, program: &Program) -> Vec<u8> {
        let mut bytes = vec![0; usize_of(self.machine.size)];
        self.write_initial(program, program.globals, &mut bytes[usize_of(self.machine.globals)..]);
        for (instance, offset) in program.instances.iter().zip(&self.machine.instances) {
            self.write_initial(program, state_of(program, instance), &mut bytes[usize_of(*offset)..]);
        }
        bytes
    }

    /// Writes the initial value of every field of a structure.
    pub fn write_initial(&self, program: &Program, structure: StructId, bytes: &mut [u8]) {
        let layout = &self.structs[structure.index()];
        for (field, offset) in program.structure(structure).fields.iter().zip(&layout.offsets) {
            self.write_const(program, field.ty, &field.initial, &mut bytes[usize_of(*offset)..]);
        }
    }

    /// Writes a constant of type `ty` to the start of `bytes`, in the host's byte order.
    ///
    /// # Panics
    /// If `value` is not of type `ty` or `bytes` is too short.
    pub fn write_const(&self, program: &Program, ty: Type, value: &Const, bytes: &mut [u8]) {
        let bytes = &mut bytes[..usize_of(self.size(ty))];
        match value {
            Const::Zero => bytes.fill(0),
            Const::Scalar(value) => value.write(bytes),
            Const::Text(text) => text.write(bytes),
            Const::Array(runs) => self.write_array(program, ty, runs, bytes),
            Const::Struct(values) => self.write_members(program, ty, values, bytes),
        }
    }

    fn write_array(&self, program: &Program, ty: Type, runs: &[(u64, Const)], bytes: &mut [u8]) {
        let Type::Array(id) = ty else { unreachable!("verified IR: constants match their types") };
        let element = self.elements[id.index()];
        let stride = usize_of(self.stride(id));
        let mut rest = bytes;
        for (count, value) in runs {
            let (run, after) = rest.split_at_mut(usize_of(*count) * stride);
            self.write_run(program, element, value, run);
            rest = after;
        }
    }

    /// Fills `run` with copies of one element.
    fn write_run(&self, program: &Program, element: Type, value: &Const, run: &mut [u8]) {
        let stride = usize_of(self.size(element));
        if matches!(value, Const::Zero) || run.is_empty() {
            return run.fill(0);
        }
        self.write_const(program, element, value, run);
        let mut done = stride;
        while done < run.len() {
            let next = done.min(run.len() - done);
            run.copy_within(..next, done);
            done += next;
        }
    }

    fn write_members(&self, program: &Program, ty: Type, values: &[Const], bytes: &mut [u8]) {
        for (position, value) in values.iter().enumerate() {
            let field = FieldId::next(position);
            let member = program.member(ty, field).expect("verified IR: constants match their types");
            let offset = usize_of(self.offset(ty, field));
            self.write_const(program, member, value, &mut bytes[offset..]);
        }
    }
}

impl Sequence {
    fn new() -> Self {
        Self { size: 0, align: 1 }
    }

    /// The new member's offset; `None` when the sum passes the limit.
    fn push(&mut self, member: Shape) -> Option<u64> {
        let offset = round_up(self.size, member.align)?;
        self.size = within_limit(offset.checked_add(member.size)?)?;
        self.align = self.align.max(member.align);
        Some(offset)
    }

    fn shape(&self) -> Option<Shape> {
        let size = within_limit(round_up(self.size, self.align)?)?;
        Some(Shape { size, align: self.align })
    }
}

/// A size or offset within [`MAX_SIZE`] as an index into memory.
pub fn usize_of(size: u64) -> usize {
    usize::try_from(size).expect("sizes are below the limit of 1 GiB")
}

fn state_of(program: &Program, instance: &crate::Instance) -> StructId {
    program.class(instance.program).state
}

fn repr_shape(repr: Repr) -> Shape {
    let size = u64::from(repr.size());
    Shape { size, align: size }
}

fn block_shape(id: BlockId) -> Shape {
    let info = id.info();
    Shape { size: u64_of(info.size), align: u64_of(info.align) }
}

fn pin_offset(id: BlockId, pin: FieldId) -> u64 {
    u64_of(id.info().pins[pin.index()].offset)
}

fn array_shape(array: Array, element: Shape) -> Option<Shape> {
    let size = within_limit(array.len().checked_mul(element.size)?)?;
    // Elements without a size still have to be counted by an executor.
    within_limit(array.len())?;
    Some(Shape { size, align: element.align })
}

fn round_up(size: u64, align: u64) -> Option<u64> {
    size.checked_next_multiple_of(align)
}

fn within_limit(size: u64) -> Option<u64> {
    (size <= MAX_SIZE).then_some(size)
}

fn u64_of(size: usize) -> u64 {
    u64::try_from(size).expect("a usize fits a u64 on the compiler's hosts")
}

#[cfg(test)]
mod tests;
