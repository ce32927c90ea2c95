//! `{attribute 'instance-path'}`: a STRING of an instance starts with the instance's path, `MAIN.pump.valve`. The path is
//! in the initial values of the PROGRAMs and of the globals, which hold all instances that outlive a call.

use crate::ast::{PouKind, VarDecl};
use crate::declare::starts::members;
use crate::testing::suite::SUITE;
use crate::types::declarations::{Declarations, PouSlot};
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashSet;
use staunch_ir::HELD_PROGRAM;
use staunch_ir::{Chars, Const, Field, FieldId, Place, Projection, StructId, Type};

/// The structures of instances, and which of all hold variables that start with the paths of their instances.
struct Marked<'a, 's> {
    declarations: &'a Declarations<'s>,
    /// Structures that hold any, themselves or further inside.
    holders: FxHashSet<StructId>,
}

impl<'s> Declarations<'s> {
    /// Puts the paths into the initial values of what is not inside of anything.
    pub(super) fn set_instance_paths(&mut self) {
        if !self.has_instance_paths() {
            return;
        }
        let roots = self.path_roots();
        let marked = Marked::new(self);
        let mut found = Vec::new();
        for (structure, field, path) in roots {
            // A program with mistakes may lack some.
            let Some(it) = self.program.structure(structure).fields.get(field.index()) else { continue };
            let value = if marked.is_path(structure, it) {
                // Of the PROGRAM itself.
                let around = path.rsplit_once('.').map_or(path.as_str(), |it| it.0);
                Some(text(it.ty, around))
            } else {
                marked.within(it.ty, &it.initial, &path)
            };
            found.extend(value.map(|it| (structure, field, it)));
        }
        for (structure, field, value) in found {
            self.program.structs[structure.index()].fields[field.index()].initial = value;
        }
    }

    /// Whether variables have the attribute. Reports what is none of an instance.
    fn has_instance_paths(&mut self) -> bool {
        let mut declared: Vec<&'s VarDecl<'s>> =
            self.pous.iter().flat_map(|it| &it.ast.blocks).flat_map(|it| &it.vars).collect();
        declared.extend(self.globals.iter().map(|it| it.decl));
        self.types.iter().for_each(|it| members(&it.decl.ty, &mut declared));
        declared.retain(|it| it.instance_path.is_some());
        if declared.is_empty() {
            return false;
        }
        let structs = self.program.structs.iter().enumerate().map(|(at, it)| (StructId::next(at), it));
        let fields = structs.flat_map(|(id, it)| it.fields.iter().map(move |field| (id, field)));
        let paths = fields.filter(|(id, field)| self.is_instance_path(*id, field));
        let place = |it: Span| (it.file, it.start);
        let mut effective: Vec<_> =
            paths.filter_map(|(_, field)| self.declaration_of(field)).map(|(name, _)| place(name.span)).collect();
        effective.sort_unstable();
        let has_effect = |it: &&VarDecl<'_>| it.names.iter().all(|it| effective.binary_search(&place(it.span)).is_ok());
        let mut elsewhere: Vec<_> =
            declared.iter().filter(|it| !has_effect(it)).filter_map(|it| it.instance_path).collect();
        elsewhere.sort_unstable_by_key(|it| place(*it));
        elsewhere.dedup();
        for span in elsewhere {
            self.report(
                Diagnostic::new(Code::W0102, span, "the attribute 'instance-path' has no effect here")
                    .label("expected before a STRING in the VAR of a FUNCTION_BLOCK or PROGRAM"),
            );
        }
        !effective.is_empty()
    }

    /// Whether a field is a STRING of an instance that starts with the instance's path.
    fn is_instance_path(&self, structure: StructId, field: &Field) -> bool {
        let is_text = matches!(field.ty, Type::String(it) if !it.wide);
        is_text
            && self.slot_of_instance(structure).is_some()
            && self.declaration_of(field).is_some_and(|(_, it)| it.instance_path.is_some())
    }

    /// All variables that are not inside of others, with their paths.
    fn path_roots(&mut self) -> Vec<(StructId, FieldId, String)> {
        let globals = self.program.globals;
        let mut roots = Vec::new();
        for (at, global) in self.globals.iter().enumerate() {
            let field = self.addresses.field_of_global(at).map(FieldId::next);
            roots.extend(field.map(|it| (globals, it, self.names.in_full(global.space, global.name.text))));
        }
        let named = self.named_programs.iter().map(|(slot, it)| (self.pous[*slot].ast.name, &it.variable.place));
        let named = named.filter_map(|(name, place)| Some((globals, global_field(place)?, self.name_in_full(name))));
        roots.extend(named);
        // VAR_STAT is declared once, also where heirs have it.
        let mut known = vec![false; self.synthetic.fields.len()];
        for PouSlot { ast: pou, owner, .. } in &self.pous {
            let around = owner.map_or(String::new(), |it| format!("{}.", self.pous[it].ast.name.text));
            for name in pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names) {
                let Some(at) = self.synthetic.statics.get(&name.span).copied() else { continue };
                if !std::mem::replace(&mut known[at], true) {
                    let path = format!("{around}{}.{}", pou.name.text, name.text);
                    roots.extend(global_field(&self.synthetic_place(at)).map(|it| (globals, it, path)));
                }
            }
        }
        let program = &self.program;
        for instance in &program.instances {
            let state = program.class(instance.program).state;
            let slot = self.slot_of_instance(state);
            let kind = slot.map(|it| self.pous[it].ast.kind);
            for (at, field) in program.structure(state).fields.iter().enumerate() {
                let path = match field.name.as_str() {
                    HELD_PROGRAM => instance.name.clone(),
                    SUITE => program.type_name(field.ty),
                    name if kind == Some(PouKind::Test) => name.to_owned(),
                    name => format!("{}.{name}", instance.name),
                };
                roots.push((state, FieldId::next(at), path));
            }
        }
        roots
    }
}

impl<'a, 's> Marked<'a, 's> {
    fn new(declarations: &'a Declarations<'s>) -> Self {
        let mut marked = Self { declarations, holders: FxHashSet::default() };
        // A structure is after those it contains.
        for (at, structure) in declarations.program.structs.iter().enumerate() {
            let id = StructId::next(at);
            let holds = |it: &Field| marked.is_path(id, it) || marked.holds(it.ty);
            if structure.fields.iter().any(holds) {
                marked.holders.insert(id);
            }
        }
        marked
    }

    fn is_path(&self, structure: StructId, field: &Field) -> bool {
        self.declarations.is_instance_path(structure, field)
    }

    fn holds(&self, ty: Type) -> bool {
        match ty {
            Type::Struct(id) => self.holders.contains(&id),
            Type::Array(id) => self.holds(self.declarations.program.array(id).element),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Block(_) => false,
        }
    }

    /// The initial value of the variable at `path`, with the paths in it, if it has any.
    fn within(&self, ty: Type, value: &Const, path: &str) -> Option<Const> {
        match ty {
            Type::Struct(id) if self.holders.contains(&id) => Some(self.members(id, value, path)),
            Type::Array(_) if self.holds(ty) => Some(self.elements(ty, value, path, &mut Vec::new())),
            Type::Struct(_)
            | Type::Array(_)
            | Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Block(_) => None,
        }
    }

    fn members(&self, id: StructId, value: &Const, path: &str) -> Const {
        let fields = self.declarations.program.structure(id).fields.iter().enumerate();
        let member = |(at, field): (usize, &Field)| {
            let value = value.part(at);
            if self.is_path(id, field) {
                return text(field.ty, path);
            }
            let name = self.declarations.declaration_of(field).map_or(field.name.as_str(), |(name, _)| name.text);
            self.within(field.ty, &value, &format!("{path}.{name}")).unwrap_or(value)
        };
        Const::Struct(fields.map(member).collect())
    }

    /// `a[1, 2]`: an array of several dimensions is one of arrays.
    fn elements(&self, ty: Type, value: &Const, path: &str, indices: &mut Vec<String>) -> Const {
        let Type::Array(id) = ty else {
            let path = format!("{path}[{}]", indices.join(","));
            return self.within(ty, value, &path).unwrap_or_else(|| value.clone());
        };
        let array = self.declarations.program.array(id);
        let one = |(at, index): (usize, i64)| {
            indices.push(index.to_string());
            let value = self.elements(array.element, &value.part(at), path, indices);
            indices.pop();
            (1, value)
        };
        Const::Array((array.low..=array.high).enumerate().map(one).collect())
    }
}

/// The field of the globals that a place is.
fn global_field(place: &Place) -> Option<FieldId> {
    match place.projections.as_slice() {
        [Projection::Field(field)] => Some(*field),
        _ => None,
    }
}

/// What a STRING keeps of the path.
fn text(ty: Type, path: &str) -> Const {
    let capacity = if let Type::String(it) = ty { it.capacity } else { 0 };
    let mut chars = Chars::Narrow(path.bytes().collect());
    chars.cut(capacity);
    if chars.is_empty() { Const::Zero } else { Const::Text(chars) }
}
