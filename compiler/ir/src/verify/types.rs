//! Enumerations, arrays, structures, and constants of them.

use super::Verifier;
use crate::layout::Layout;
use crate::{Array, BoundsId, Const, Elementary, FieldId, Location, Repr, Struct, Type, Value};

/// What may be part of a type that is being declared: ids below these.
#[derive(Clone, Copy)]
struct Known {
    arrays: usize,
    structs: usize,
}

impl Verifier<'_> {
    pub(super) fn types(&mut self) {
        let program = self.program;
        for enumeration in &program.enums {
            self.within = format!("enumeration {}", enumeration.name);
            self.location(enumeration.location);
            self.enumeration(enumeration);
        }
        for (id, array) in program.arrays.iter().enumerate() {
            self.within = format!("array {id}");
            self.array(id, *array);
        }
        for (id, structure) in program.structs.iter().enumerate() {
            self.within = format!("structure {}", structure.name);
            self.location(structure.location);
            self.structure(id, structure);
        }
        let is_known = program.reach.references || program.references.is_empty();
        self.require(is_known, Location::default(), "references that bodies were checked without");
        for reference in &program.references {
            self.declared(reference.target, Location::default());
        }
        self.within = "globals".to_owned();
        let known = program.globals.index() < program.structs.len();
        self.require(known, Location::default(), "no such structure");
        if self.violations.is_empty() {
            self.constants();
        }
    }

    fn enumeration(&mut self, enumeration: &crate::Enum) {
        let (at, repr) = (enumeration.location, enumeration.base.repr());
        self.require(repr.is_integer(), at, "the base type is not an integer");
        self.require(!enumeration.values.is_empty(), at, "no values");
        for value in &enumeration.values {
            self.require(value.value.repr() == repr, at, "a value that is not of the base type");
        }
    }

    fn array(&mut self, id: usize, array: Array) {
        let at = Location::default();
        self.require(array.low <= array.high, at, "the lower bound is above the upper");
        let known = Known { arrays: id, structs: self.program.structs.len() };
        self.part(array.element, known, at);
    }

    fn structure(&mut self, id: usize, structure: &Struct) {
        let known = Known { arrays: self.program.arrays.len(), structs: id };
        for field in &structure.fields {
            self.location(field.location);
            self.part(field.ty, known, field.location);
        }
        self.require(structure.align.is_power_of_two(), structure.location, "an alignment that is not a power of two");
        for overlay in &structure.overlays {
            self.part(overlay.ty, known, overlay.location);
            self.require(overlay.field.index() < structure.fields.len(), overlay.location, "no such field");
        }
    }

    fn subrange(&mut self, base: Elementary, id: BoundsId, at: Location) {
        let bounds = self.program.bounds.get(id.index());
        let holds = base.repr().range().filter(|_| base.is_integer() || base.is_bits() && base != Elementary::Bool);
        let inside =
            bounds.zip(holds).is_some_and(|((low, high), (min, max))| min <= *low && low <= high && *high <= max);
        self.require(inside, at, "a subrange that does not fit what it is made of");
    }

    /// A type that is part of another: declared before it, also where an array is in between.
    fn part(&mut self, ty: Type, known: Known, at: Location) {
        let declared = match ty {
            Type::Elementary(_) | Type::String(_) => true,
            Type::Reference(id) => id.index() < self.program.references.len(),
            Type::Subrange(base, id) => return self.subrange(base, id, at),
            Type::Enum(id) => id.index() < self.program.enums.len(),
            Type::Block(id) => id.index() < staunch_runtime::BLOCKS.len(),
            Type::Struct(id) => id.index() < known.structs,
            Type::Array(id) if id.index() < known.arrays => {
                // Arrays may only go down, so that this ends.
                let element = self.program.array(id).element;
                return self.part(element, Known { arrays: id.index(), ..known }, at);
            }
            Type::Array(_) => false,
        };
        self.require(declared, at, format_args!("{ty:?} is not declared before its use"));
    }

    /// Initial values; the types are sound.
    fn constants(&mut self) {
        let program = self.program;
        if let Err(error) = Layout::try_types(program) {
            self.report(error.at.unwrap_or_default(), "a type is larger than the limit");
            return;
        }
        for structure in &program.structs {
            self.within = format!("structure {}", structure.name);
            for field in &structure.fields {
                self.constant(field.ty, &field.initial, field.location);
            }
        }
    }

    /// `value` has the shape of `ty`.
    pub(super) fn constant(&mut self, ty: Type, value: &Const, at: Location) {
        let fits = match value {
            Const::Zero => self.program.range(ty).is_none_or(|(low, high)| (low..=high).contains(&0)),
            Const::Scalar(value) => self.scalar_fits(ty, *value),
            Const::Text(text) => ty.string_type().is_some_and(|it| text.fits(it)),
            Const::Array(runs) => return self.array_constant(ty, runs, at),
            Const::Struct(values) => return self.struct_constant(ty, values, at),
        };
        if !fits {
            let name = self.program.type_name(ty);
            self.report(at, format_args!("a constant that is not of type {name}: {value:?}"));
        }
    }

    /// A value in the type's repr, and within the limits of a subrange.
    pub(super) fn scalar_fits(&self, ty: Type, value: Value) -> bool {
        let inside = |(low, high): (i128, i128)| value.as_integer().is_some_and(|it| (low..=high).contains(&it));
        self.repr(ty) == Some(value.repr()) && self.program.range(ty).is_none_or(inside)
    }

    fn array_constant(&mut self, ty: Type, runs: &[(u64, Const)], at: Location) {
        let Type::Array(id) = ty else {
            return self.report(at, "an array constant of another type");
        };
        let array = self.program.array(id);
        let count = runs.iter().try_fold(0u64, |sum, (count, _)| sum.checked_add(*count));
        self.require(count == Some(array.len()), at, "an array constant of the wrong length");
        for (_, value) in runs {
            self.constant(array.element, value, at);
        }
    }

    fn struct_constant(&mut self, ty: Type, values: &[Const], at: Location) {
        let expected = match ty {
            Type::Struct(id) => self.program.structure(id).fields.len(),
            Type::Block(id) => id.info().pins.len(),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => {
                return self.report(at, "a structure constant of another type");
            }
        };
        self.require(values.len() == expected, at, "a structure constant of the wrong length");
        for (position, value) in values.iter().enumerate() {
            if let Some(member) = self.program.member(ty, FieldId::next(position)) {
                self.constant(member, value, at);
            }
        }
    }

    /// `ty` is declared.
    pub(super) fn declared(&mut self, ty: Type, at: Location) {
        let program = self.program;
        self.part(ty, Known { arrays: program.arrays.len(), structs: program.structs.len() }, at);
    }

    /// The repr of an elementary type; any other type is none.
    pub(super) fn elementary_repr(ty: Type) -> Option<Repr> {
        ty.elementary().map(Elementary::repr)
    }
}
