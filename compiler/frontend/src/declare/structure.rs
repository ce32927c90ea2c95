//! Structures and UNIONs, and what is some bits of another member.

use super::specs::Within;
use crate::ast;
use crate::names::{Found, Sense};
use crate::types::declarations::Declarations;
use crate::types::scope::Scope;
use crate::types::table::{Resolved, scalar_initial, struct_initial};
use crate::{Code, Diagnostic, Span};
use staunch_ir::{
    Chars, Const, Elementary, Field, FieldId, Location, Overlay, RefKind, Retain, Section, Struct, StructId, Type,
    Value,
};
use std::rc::Rc;

impl<'s> Declarations<'s> {
    /// The structure that another one EXTENDS.
    pub(super) fn base_structure(&mut self, path: &'s [ast::Name<'s>]) -> Option<StructId> {
        let name = path.last()?;
        let span = path.first()?.span.to(name.span);
        let ty = self.resolve_path(path, span)?.ty;
        match ty {
            Type::Struct(id) if !self.is_instance(id) => Some(id),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => {
                let label = format!("this is {}", self.program.type_name(ty));
                self.report(Diagnostic::new(Code::E0102, span, "a structure can only EXTEND a structure").label(label));
                None
            }
        }
    }

    pub(super) fn report_no_structure(&mut self, base: &[ast::Name<'s>]) {
        if let Some(name) = base.last() {
            self.report(
                Diagnostic::new(Code::E0403, name.span, "only a structure EXTENDS another type")
                    .label("this declares something else"),
            );
        }
    }

    /// The members that a structure starts with: those of its base. What the base has already is reported.
    fn inherited(&mut self, base: Option<StructId>, members: &'s [ast::VarDecl<'s>]) -> Members {
        let Some(base) = base else { return Members::default() };
        for member in members.iter().flat_map(|it| &it.names) {
            if self.members_of(base).any(|it| it.eq_ignore_ascii_case(member.text)) {
                let base = self.program.structure(base).name.clone();
                self.report(
                    Diagnostic::new(Code::E0103, member.span, format!("`{}` is declared twice", member.text))
                        .label(format!("`{base}`, which this structure EXTENDS, has it already")),
                );
            }
        }
        let base = self.program.structure(base);
        Members { fields: base.fields.clone(), overlays: base.overlays.clone(), free_bit: None, align: base.align }
    }

    pub(super) fn structure(
        &mut self,
        members: &'s [ast::VarDecl<'s>],
        (base, most): (Option<StructId>, Option<u64>),
        scope: &Rc<Scope<'s>>,
        name: &str,
        doc: Option<String>,
        span: Span,
    ) -> Option<Resolved> {
        let has_bits = members.iter().any(|it| self.is_bit(&it.ty));
        if base.is_some() || has_bits {
            let what = if base.is_some() { "a structure that EXTENDS another" } else { "a structure with BITs" };
            self.refuse_addresses(members, &format!("the location of a member in {what}"));
        }
        let block = ast::VarBlock::new(ast::VarKind::Var, span);
        let mut seen = Scope::default();
        let mut made = self.inherited(base, members);
        let mut complete = true;
        for decl in members {
            let owner = decl.names.first().map_or(name, |it| it.text);
            let is_bit = self.is_bit(&decl.ty);
            let resolved = match is_bit {
                true => self.initial_bit(decl, scope),
                false => self.declared_type(decl, scope, owner, Within::Structure),
            };
            let Some(resolved) = resolved.map(Rc::new) else {
                complete = false;
                continue;
            };
            for member in &decl.names {
                let place = staunch_ir::Place::root(staunch_ir::Root::Instance, resolved.ty);
                let variable = self.variable(*member, &block, Some(decl), Rc::clone(&resolved), place);
                let field = self.field(*member, &resolved, &block, decl);
                self.enter_variable(&mut seen, variable);
                if is_bit { made.push_bit(field) } else { made.push(field) }
            }
        }
        if made.fields.is_empty() && complete && self.dialect(span).has_empty_structures() {
            // It needs an address anyway, like an empty class.
            let location = self.location(span);
            made.push(storage("empty", Type::Elementary(Elementary::Byte), Const::Zero, None, location));
        }
        if made.fields.is_empty() && complete {
            self.error(Code::E0408, span, "a structure has at least one member");
            return None;
        }
        // A member that was refused has no field.
        let has_all = complete && base.is_none() && !has_bits;
        let extent = if has_all { self.relative_extent(members, &made.fields) } else { None };
        let location = self.location(span);
        let Members { fields, overlays, align, .. } = made;
        let plain = Struct { name: name.to_owned(), doc, location, fields, overlays, align };
        let own = base.map_or(0, |it| self.program.structure(it).fields.len());
        let structure = match most.and_then(|most| self.packed(&plain, own, most)) {
            Some(packed) => packed,
            None => plain,
        };
        let initial = struct_initial(&structure.fields);
        let id = self.push_struct(structure);
        self.table.relative.extend(extent.map(|it| (id, it)));
        self.table.bases.extend(base.map(|it| (id, it)));
        complete.then_some(Resolved { ty: Type::Struct(id), initial })
    }

    fn refuse_addresses(&mut self, members: &[ast::VarDecl<'s>], what: &str) {
        for address in members.iter().filter_map(|it| self.location_of(it)).collect::<Vec<_>>() {
            self.not_supported(address.span, what);
        }
    }

    /// Whether a member is one bit: the type BIT of CODESYS.
    pub(super) fn is_bit(&self, spec: &ast::TypeSpec<'s>) -> bool {
        let ast::TypeKind::Named(path) = &spec.kind else { return false };
        let [name] = path.as_slice() else { return false };
        name.text.eq_ignore_ascii_case("BIT")
            && self.dialect(name.span).has_bits()
            && self.lookup(path, Sense::Type) == Found::Nothing
    }

    pub(super) fn initial_bit(&mut self, decl: &'s ast::VarDecl<'s>, scope: &Rc<Scope<'s>>) -> Option<Resolved> {
        let plain = Resolved::plain(Type::BOOL);
        let Some(initial) = &decl.initial else { return Some(plain) };
        let initial = self.initial(initial, &plain, scope).unwrap_or(plain.initial);
        Some(Resolved { ty: Type::BOOL, initial })
    }

    /// `UNION … END_UNION`, `STRUCT OVERLAP … END_STRUCT`: its members share their bytes, which are kept as unsigned
    /// numbers of as many bytes as the smallest part of a member has, so that each part is some of these; as bytes, where
    /// members have locations. Those without one begin with the first byte.
    pub(super) fn union(
        &mut self,
        members: &'s [ast::VarDecl<'s>],
        scope: &Rc<Scope<'s>>,
        name: &str,
        doc: Option<String>,
        span: Span,
    ) -> Option<Resolved> {
        let block = ast::VarBlock::new(ast::VarKind::Var, span);
        let mut seen = Scope::default();
        let (mut overlays, mut starts) = (Vec::new(), Vec::new());
        let (mut unit, mut size, mut align) = (8, 0, 1);
        let mut complete = true;
        let are_pointers = members.iter().all(is_pointer);
        for decl in members {
            let owner = decl.names.first().map_or(name, |it| it.text);
            let is_bit = self.is_bit(&decl.ty);
            let resolved = match is_bit {
                true => self.initial_bit(decl, scope),
                false => self.declared_type(decl, scope, owner, Within::Structure),
            };
            let resolved = resolved.map(Rc::new);
            let Some((resolved, part)) =
                resolved.and_then(|it| Some((Rc::clone(&it), self.shareable(&it, decl, are_pointers)?)))
            else {
                complete = false;
                continue;
            };
            let Some(offset) = self.offset_in_union(decl, resolved.ty) else {
                complete = false;
                continue;
            };
            let (bit, is_bit) = offset.map_or((0, is_bit), |it| (it.bit, is_bit || it.is_bit));
            unit = if offset.is_some() { 1 } else { part.min(unit) };
            size = (bit / 8 + self.sizeof(resolved.ty)).max(size);
            align = self.align_of(resolved.ty).max(align);
            for member in &decl.names {
                let place = staunch_ir::Place::root(staunch_ir::Root::Instance, resolved.ty);
                let variable = self.variable(*member, &block, Some(decl), Rc::clone(&resolved), place);
                let Field { name, ty, doc, location, .. } = self.field(*member, &resolved, &block, decl);
                self.enter_variable(&mut seen, variable);
                overlays.push(Overlay { name, ty, field: STORAGE, bit, is_bit, is_packed: false, doc, location });
                starts.push(resolved.initial.clone());
            }
        }
        if overlays.is_empty() {
            if complete {
                self.error(Code::E0408, span, "a UNION has at least one member");
            }
            return None;
        }
        let location = self.location(span);
        let field = self.storage_of(&overlays, &starts, size.next_multiple_of(align), unit, location)?;
        let fields = vec![field];
        let initial = struct_initial(&fields);
        let id = self.push_struct(Struct { name: name.to_owned(), doc, location, fields, overlays, align });
        complete.then_some(Resolved { ty: Type::Struct(id), initial })
    }

    /// The field that holds the bytes of a UNION.
    fn storage_of(
        &mut self,
        overlays: &[Overlay],
        starts: &[Const],
        size: u64,
        unit: u64,
        location: Location,
    ) -> Option<Field> {
        let ty = self.units_of(size, unit)?;
        let mut initial = Const::Zero;
        for (overlay, start) in overlays.iter().zip(starts).filter(|(_, it)| **it != Const::Zero) {
            initial = self.with_overlay(ty, &initial, overlay, start);
        }
        let names: Vec<_> = overlays.iter().map(|it| it.name.as_str()).collect();
        let doc = Some(format!("The bytes that {} share.", crate::diagnostic::wording::all_of(&names)));
        Some(storage("bytes", ty, initial, doc, location))
    }

    /// Unsigned numbers of `unit` bytes, which take `size`.
    pub(super) fn units_of(&mut self, size: u64, unit: u64) -> Option<Type> {
        let element = match unit {
            1 => Elementary::Byte,
            2 => Elementary::Word,
            4 => Elementary::Dword,
            _ => Elementary::Lword,
        };
        let last = i64::try_from(size.div_ceil(unit)).ok()? - 1;
        Some(self.intern_array(0, last, Resolved::plain(Type::Elementary(element))))
    }

    /// The bytes of the smallest part of what a member of a UNION holds; what cannot share its bytes is reported.
    /// Pointers are shared among themselves alone: each is made of a variable.
    fn shareable(&mut self, resolved: &Resolved, decl: &ast::VarDecl<'s>, are_pointers: bool) -> Option<u64> {
        if are_pointers {
            return Some(self.size_of(resolved.ty));
        }
        match self.smallest_part(resolved.ty) {
            Ok(size) => Some(size),
            Err((ty, why)) => {
                let name = self.name_of_type(ty);
                self.report(
                    Diagnostic::new(Code::E0412, decl.ty.span, format!("{name} cannot share its bytes with others"))
                        .label(why),
                );
                None
            }
        }
    }

    /// A type's name while declarations are read, when what references lead to is not looked up yet.
    fn name_of_type(&self, ty: Type) -> String {
        let pending = self.table.pending_references.iter().find(|it| ty == Type::Reference(it.id));
        pending.map_or_else(
            || self.program.type_name(ty),
            |it| format!("{} {}", self.program.references[it.id.index()].kind.word(), self.log.sources.text(it.span)),
        )
    }

    /// The bytes of the smallest part; of what cannot share its bytes, which type that is, and why.
    pub(super) fn smallest_part(&self, ty: Type) -> Result<u64, (Type, &'static str)> {
        match ty {
            Type::Elementary(it) => Ok(it.repr().size().into()),
            Type::Enum(_) => Ok(self.size_of(ty)),
            Type::String(it) => Ok(if it.wide { 2 } else { 1 }),
            Type::Array(id) => self.smallest_part(self.program.array(id).element),
            Type::Struct(id) if self.is_instance(id) => Err((ty, "an instance is changed only by its own POU")),
            Type::Struct(id) => {
                let structure = self.program.structure(id);
                let fields = structure.fields.iter().map(|it| it.ty);
                fields
                    .chain(structure.overlays.iter().map(|it| it.ty))
                    .map(|it| self.smallest_part(it))
                    .try_fold(8, |least, part| Ok(part?.min(least)))
            }
            Type::Block(_) => Err((ty, "an instance is changed only by its own POU")),
            Type::Reference(_) => Err((ty, "a reference is made from a variable, never from bytes")),
            Type::Subrange(..) => Err((ty, "other bytes may be outside its limits")),
        }
    }

    /// A storage's constant with that of a member in it.
    pub(super) fn with_overlay(&self, storage: Type, whole: &Const, overlay: &Overlay, value: &Const) -> Const {
        let size = |ty| usize::try_from(self.sizeof(ty)).unwrap_or_default();
        let mut bytes = vec![0; size(storage)];
        self.put(storage, whole, &mut bytes);
        let first = usize::try_from(overlay.bit / 8).unwrap_or_default();
        if overlay.is_bit {
            let bit = 1 << (overlay.bit % 8);
            let is_set = *value == Const::Scalar(Value::Bool(true));
            bytes[first] = if is_set { bytes[first] | bit } else { bytes[first] & !bit };
        } else {
            self.put(overlay.ty, value, &mut bytes[first..first + size(overlay.ty)]);
        }
        self.taken(storage, &bytes)
    }

    /// The bytes of a constant, the lowest first.
    pub(super) fn put(&self, ty: Type, value: &Const, bytes: &mut [u8]) {
        let size = |ty| usize::try_from(self.sizeof(ty)).unwrap_or_default();
        match (value, ty) {
            (Const::Zero, _) => bytes.fill(0),
            (Const::Scalar(value), _) => value.write(bytes),
            (Const::Text(text), _) => {
                bytes.fill(0);
                match text {
                    Chars::Narrow(text) => bytes[..text.len()].copy_from_slice(text),
                    Chars::Wide(text) => {
                        let units = text.iter().flat_map(|it| it.to_ne_bytes());
                        bytes.iter_mut().zip(units).for_each(|(to, from)| *to = from);
                    }
                }
            }
            (Const::Array(runs), Type::Array(id)) => {
                let element = self.program.array(id).element;
                let stride = usize::try_from(self.sizeof_element(id)).unwrap_or_default();
                let all = runs.iter().flat_map(|(count, it)| (0..*count).map(move |_| it));
                for (part, value) in bytes.chunks_exact_mut(stride.max(1)).zip(all) {
                    self.put(element, value, &mut part[..size(element)]);
                }
            }
            (Const::Struct(values), Type::Struct(id)) => {
                for (at, value) in values.iter().enumerate() {
                    let ty = self.program.structure(id).fields[at].ty;
                    let start = usize::try_from(self.offset_of(id, FieldId::next(at))).unwrap_or_default();
                    self.put(ty, value, &mut bytes[start..start + size(ty)]);
                }
            }
            (Const::Array(_) | Const::Struct(_), _) => {}
        }
    }

    /// The constant of numbers that bytes are.
    pub(super) fn taken(&self, ty: Type, bytes: &[u8]) -> Const {
        let Type::Array(id) = ty else {
            let repr = self.program.repr(ty);
            return repr.map_or(Const::Zero, |it| scalar_initial(Value::read(it, bytes)));
        };
        if bytes.iter().all(|it| *it == 0) {
            return Const::Zero;
        }
        let element = self.program.array(id).element;
        let stride = usize::try_from(self.sizeof_element(id)).unwrap_or(1);
        let mut runs: Vec<(u64, Const)> = Vec::new();
        for part in bytes.chunks_exact(stride.max(1)) {
            let value = self.taken(element, part);
            match runs.last_mut() {
                Some((count, last)) if *last == value => *count += 1,
                _ => runs.push((1, value)),
            }
        }
        Const::Array(runs)
    }
}

/// The field of a UNION.
const STORAGE: FieldId = FieldId(0);

/// The members of a structure.
struct Members {
    fields: Vec<Field>,
    overlays: Vec<Overlay>,
    /// The next bit of the last field, which holds BITs.
    free_bit: Option<u8>,
    align: u64,
}

impl Default for Members {
    fn default() -> Self {
        Self { fields: Vec::new(), overlays: Vec::new(), free_bit: None, align: 1 }
    }
}

impl Members {
    fn push(&mut self, field: Field) {
        self.free_bit = None;
        self.fields.push(field);
    }

    /// Eight BITs after one another are a byte.
    fn push_bit(&mut self, bit: Field) {
        let at = self.free_bit.unwrap_or_default();
        if at == 0 {
            let count = self.overlays.iter().map(|it| it.field).max().map_or(1, |_| self.bytes() + 1);
            let name = if count == 1 { "bits".to_owned() } else { format!("bits_{count}") };
            self.fields.push(storage(&name, Type::Elementary(Elementary::Byte), Const::Zero, None, bit.location));
        }
        let Some(byte) = self.fields.last_mut() else { return };
        let set = match (&byte.initial, &bit.initial) {
            (initial, Const::Scalar(Value::Bool(true))) => number(initial) | 1 << at,
            (initial, _) => number(initial),
        };
        byte.initial = scalar_initial(Value::U8(set));
        let word = if at == 0 { "The BITs" } else { "," };
        byte.doc = Some(format!("{}{word} `{}`", byte.doc.take().unwrap_or_default(), bit.name));
        let field = FieldId::next(self.fields.len() - 1);
        let Field { name, ty, doc, location, .. } = bit;
        let (is_bit, is_packed) = (true, false);
        self.overlays.push(Overlay { name, ty, field, bit: at.into(), is_bit, is_packed, doc, location });
        self.free_bit = (at < 7).then_some(at + 1);
    }

    /// How many fields hold BITs.
    fn bytes(&self) -> usize {
        let mut fields: Vec<_> = self.overlays.iter().map(|it| it.field).collect();
        fields.dedup();
        fields.len()
    }
}

fn number(byte: &Const) -> u8 {
    match byte {
        Const::Scalar(Value::U8(it)) => *it,
        Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) | Const::Struct(_) => 0,
    }
}

/// A field that holds the bits of other members.
pub(super) fn storage(name: &str, ty: Type, initial: Const, doc: Option<String>, location: Location) -> Field {
    Field {
        name: name.to_owned(),
        ty,
        initial,
        section: Section::Internal,
        retain: Retain::Inherited,
        constant: false,
        address: None,
        doc,
        location,
        declared: None,
    }
}

/// `p : POINTER TO INT`
fn is_pointer(decl: &ast::VarDecl<'_>) -> bool {
    matches!(decl.ty.kind, ast::TypeKind::Reference { kind: RefKind::PointerTo | RefKind::RefTo, .. })
}
