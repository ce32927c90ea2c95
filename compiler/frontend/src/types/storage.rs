//! What a program's variables take, and where they lie.

use super::address::{self, Storage};
use super::declarations::Declarations;
use super::table::{GLOBALS, scalar_initial};
use crate::ast;
use crate::{Code, Diagnostic};
use staunch_ir::layout::Shape;
use staunch_ir::{Address, Const, EnumId, Field, FieldId, Place, Root, Section, Struct, StructId, Type, Value};

impl<'s> Declarations<'s> {
    pub fn push_struct(&mut self, structure: Struct) -> StructId {
        let id = StructId::next(self.program.structs.len());
        let size = structure.fields.iter().map(|it| self.size_of(it.ty)).fold(0, u64::saturating_add);
        self.table.sizes.push(size);
        let rounded = |it: &Field| self.size_at_most(it.ty).checked_next_multiple_of(8).unwrap_or(u64::MAX);
        let at_most = structure.fields.iter().map(rounded).fold(0, u64::saturating_add);
        self.table.sizes_at_most.push(at_most);
        self.table.index.fields.add(id, structure.fields.iter().map(|it| it.name.as_str()));
        self.program.structs.push(structure);
        id
    }

    /// The first field with that name that the source declares.
    pub fn field_named(&self, id: StructId, name: &str) -> Option<FieldId> {
        let structure = self.program.structure(id);
        let names = structure.fields.iter().map(|it| it.name.as_str());
        let field = self.table.index.fields.find(id, name, names).map(FieldId::next)?;
        (!structure.is_storage(field)).then_some(field)
    }

    /// What can be named of a structure or an instance from outside.
    pub fn members_of(&self, id: StructId) -> impl Iterator<Item = &str> {
        let (structure, instance) = (self.program.structure(id), self.is_instance(id));
        let is_seen = move |at: usize, it: &Field| match instance {
            true => matches!(it.section, Section::Input | Section::Output),
            false => !structure.is_storage(FieldId::next(at)),
        };
        let fields = structure.fields.iter().enumerate().filter(move |(at, it)| is_seen(*at, it));
        fields.map(|(_, it)| it.name.as_str()).chain(structure.overlays.iter().map(|it| it.name.as_str()))
    }

    /// Bytes from the start of a structure to a field.
    pub fn offset_of(&self, id: StructId, field: FieldId) -> u64 {
        let shapes = self.program.structure(id).fields.iter().map(|it| self.shape(it.ty));
        let mut offset = 0;
        for (at, shape) in shapes.enumerate() {
            offset = u64::next_multiple_of(offset, shape.align);
            if at == field.index() {
                break;
            }
            offset += shape.size;
        }
        offset
    }

    /// Bytes from one element of an array to the next.
    pub fn sizeof_element(&self, id: staunch_ir::ArrayId) -> u64 {
        self.shape(self.program.array(id).element).size
    }

    /// What the addresses of a type's variables are multiples of.
    pub fn align_of(&self, ty: Type) -> u64 {
        self.shape(ty).align
    }

    /// The value of the first enumerator with that name.
    pub fn enumerator_named(&self, id: EnumId, name: &str) -> Option<Value> {
        let values = &self.program.enumeration(id).values;
        let at = self.table.index.values.find(id, name, values.iter().map(|it| it.name.as_str()));
        at.map(|it| values[it].value)
    }

    /// The instance of a block that a variable of type `ty` is or holds, and the way to it.
    pub fn instance_in(&self, ty: Type) -> Option<(String, Type)> {
        self.program.instance_in(ty, &|id| self.is_instance(id))
    }

    /// The instance that a variable of type `ty` is or holds, and that is not copied at a place.
    pub fn instance_not_copied(&self, ty: Type, span: crate::Span) -> Option<(String, Type)> {
        if !self.dialect(span).copies_instances() {
            return self.instance_in(ty);
        }
        if self.instance_in(ty).is_some() {
            self.table.copies.set(true);
        }
        self.never_copied(ty)
    }

    /// The instance in it that no dialect copies.
    fn never_copied(&self, ty: Type) -> Option<(String, Type)> {
        let is_block = |id| self.slot_of_instance(id).is_none_or(|it| self.pous[it].ast.kind.is_block());
        self.program.state_in(ty, &|id| self.is_instance(id) && !is_block(id))
    }

    /// Whether some dialect copies what `ty` holds.
    pub fn is_copied_elsewhere(&self, ty: Type) -> bool {
        self.never_copied(ty).is_none()
    }

    /// What `ty` holds that is not copied at a place, in a sentence.
    pub fn held_not_copied(&self, ty: Type, span: crate::Span) -> Option<String> {
        self.instance_not_copied(ty, span).map(|it| self.say_held(ty, it))
    }

    /// What instance `ty` holds, in a sentence.
    pub fn held_instance(&self, ty: Type) -> Option<String> {
        self.instance_in(ty).map(|it| self.say_held(ty, it))
    }

    fn say_held(&self, ty: Type, (way, instance): (String, Type)) -> String {
        let (name, instance) = (self.program.type_name(ty), self.program.type_name(instance));
        match way.as_str() {
            "" => format!("an instance of {instance} is not a value"),
            way => format!("{name} holds an instance of {instance}, at `{way}`, which is never copied"),
        }
    }

    /// About how many bytes a value of the type takes: alignment may add some.
    pub fn size_of(&self, ty: Type) -> u64 {
        match ty {
            Type::Elementary(it) | Type::Subrange(it, _) => u64::from(it.repr().size()),
            Type::Reference(_) => 8,
            Type::String(it) => u64::from(it.size()),
            Type::Enum(id) => u64::from(self.program.enumeration(id).base.repr().size()),
            Type::Struct(id) => self.table.sizes[id.index()],
            Type::Block(id) => u64::try_from(id.info().size).unwrap_or(u64::MAX),
            Type::Array(id) => {
                let array = self.program.array(id);
                array.len().saturating_mul(self.size_of(array.element))
            }
        }
    }

    /// SIZEOF: the bytes from where a variable's address points to its end. A string has its characters
    /// there, and a zero.
    pub fn sizeof(&self, ty: Type) -> u64 {
        match ty {
            Type::String(it) => (u64::from(it.capacity) + 1) * u64::from(it.unit_size()),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => self.shape(ty).size,
        }
    }

    /// As the layout has it.
    fn shape(&self, ty: Type) -> Shape {
        match ty {
            Type::Array(id) => {
                let array = self.program.array(id);
                let Shape { size, align } = self.shape(array.element);
                Shape { size: array.len().saturating_mul(size), align }
            }
            Type::Struct(id) => {
                let fields = self.program.structure(id).fields.iter().map(|it| self.shape(it.ty));
                let empty = Shape { size: 0, align: self.program.structure(id).align };
                let whole = fields.fold(empty, |whole, it| Shape {
                    size: whole.size.next_multiple_of(it.align).saturating_add(it.size),
                    align: whole.align.max(it.align),
                });
                Shape { size: whole.size.next_multiple_of(whole.align), ..whole }
            }
            Type::Block(id) => {
                let info = id.info();
                let number = |it| u64::try_from(it).unwrap_or(u64::MAX);
                Shape { size: number(info.size), align: number(info.align) }
            }
            Type::String(it) => Shape { size: it.size().into(), align: 2 },
            Type::Elementary(_) | Type::Subrange(..) | Type::Reference(_) | Type::Enum(_) => {
                Shape { size: self.size_of(ty), align: self.size_of(ty) }
            }
        }
    }

    /// No fewer bytes than a value of the type takes, whatever its alignment adds.
    pub fn size_at_most(&self, ty: Type) -> u64 {
        match ty {
            Type::Struct(id) => self.table.sizes_at_most[id.index()],
            Type::Array(id) => {
                let array = self.program.array(id);
                array.len().saturating_mul(self.size_at_most(array.element))
            }
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => self.size_of(ty),
        }
    }

    /// What a variable starts at that nobody gives a value: a subrange at its lower limit.
    pub fn least(&self, ty: Type) -> Const {
        let low = self.program.range(ty).map_or(0, |(low, _)| low);
        ty.elementary().and_then(|it| it.repr().integer(low)).map_or(Const::Zero, scalar_initial)
    }

    /// Adds a field to the globals, under `field.name` or, where that is taken, one like it.
    pub fn add_synthetic(&mut self, mut field: Field, declared: Option<ast::Name<'s>>) -> usize {
        while self.is_global_name(&field.name) {
            field.name.push('_');
        }
        self.synthetic.names.extend([field.name.to_ascii_uppercase()]);
        self.synthetic.fields.push(field);
        self.synthetic.declared.push(declared);
        self.synthetic.fields.len() - 1
    }

    /// Whether a field of the globals has the name.
    pub fn is_global_name(&mut self, name: &str) -> bool {
        if self.synthetic.names.is_empty() {
            let declared = (0..self.globals.len()).map(|at| self.global_field_name(at).to_ascii_uppercase());
            self.synthetic.names = declared.collect();
        }
        self.synthetic.names.contains(&name.to_ascii_uppercase())
    }

    pub fn synthetic_place(&self, at: usize) -> Place {
        let id = FieldId::next(self.addresses.own_fields().len() + at);
        Place::root(Root::Globals, Type::Struct(GLOBALS)).field(id, self.synthetic.fields[at].ty)
    }

    /// The address that is written; else reports what is wrong with it.
    pub fn address(&mut self, name: ast::Name<'s>) -> Option<Address> {
        let address = address::parse(name.text);
        let beyond = address::beyond(name.text);
        if address.is_none() || beyond.is_some() && !self.dialect(name.span).has_bits_beyond_bytes() {
            self.report(address::wrong(name));
            return None;
        }
        if let Some(meant) = beyond {
            self.report(
                Diagnostic::new(Code::W0414, name.span, format!("`{}` is `{meant}` in OpenPLC", name.text))
                    .label("a byte has the bits 0 to 7")
                    .help(format!("write `{meant}`, if this is what is meant"))
                    .fix(name.span, &meant),
            );
        }
        address
    }

    /// The variable at an address.
    pub fn at_address(&mut self, address: Address) -> Option<Place> {
        match self.addresses.storage.get(&address).copied()? {
            Storage::Global(at) => Some(self.global(at)?.place.clone()),
            Storage::Hidden(at) => Some(self.synthetic_place(at)),
        }
    }
}
