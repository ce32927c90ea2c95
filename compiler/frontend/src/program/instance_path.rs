//! `{attribute 'instance-path'}`: a STRING of an instance starts with the instance's path, `MAIN.pump.valve`. The path is
//! in the initial values of the PROGRAMs and of the globals, which hold all instances that outlive a call.

use crate::ast::{PouKind, VarDecl};
use crate::declare::starts::members;
use crate::testing::suite::SUITE;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::HELD_PROGRAM;
use staunch_ir::{Chars, Const, FieldId, Location, Program, StructId, Type};

/// The variables that start with the paths of their instances, by where they are declared, and what each variable of the
/// program is called there.
struct Marked<'s> {
    program: &'s Program,
    marks: FxHashSet<Location>,
    names: FxHashMap<Location, String>,
    /// Structures that hold any, themselves or further inside.
    holders: FxHashSet<StructId>,
}

impl<'s> Declarations<'s> {
    /// Puts the paths into the initial values of what is not inside of anything.
    pub(super) fn set_instance_paths(&mut self) {
        let marks = self.instance_path_marks();
        if marks.is_empty() {
            return;
        }
        let names = self.declared_names();
        let roots = self.path_roots();
        let marked = Marked::new(&self.program, marks, names);
        let mut found = Vec::new();
        for (structure, field, path) in roots {
            let it = &self.program.structure(structure).fields[field.index()];
            let value = if marked.is_path(it.location, it.ty) {
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

    /// Where the variables with the attribute are declared. Reports what is none of an instance.
    fn instance_path_marks(&mut self) -> FxHashSet<Location> {
        let mut marks = FxHashSet::default();
        let mut elsewhere: FxHashSet<Span> = FxHashSet::default();
        let mut declared: Vec<&'s VarDecl<'s>> =
            self.pous.iter().flat_map(|it| &it.ast.blocks).flat_map(|it| &it.vars).collect();
        declared.extend(self.globals.iter().map(|it| it.decl));
        self.types.iter().for_each(|it| members(&it.decl.ty, &mut declared));
        declared.retain(|it| it.instance_path.is_some());
        let structs = self.program.structs.iter().enumerate();
        let of_instances = structs.filter(|(at, _)| self.slot_of_instance(StructId::next(*at)).is_some());
        let is_text = |ty: Type| matches!(ty, Type::String(it) if !it.wide);
        let fields = of_instances.flat_map(|(_, it)| &it.fields).filter(|it| is_text(it.ty)).map(|it| it.location);
        let texts: FxHashSet<_> = if declared.is_empty() { FxHashSet::default() } else { fields.collect() };
        for decl in declared {
            for name in &decl.names {
                let at = self.location(name.span);
                match texts.contains(&at) {
                    true => drop(marks.insert(at)),
                    false => elsewhere.extend(decl.instance_path),
                }
            }
        }
        for span in elsewhere {
            self.report(
                Diagnostic::new(Code::W0102, span, "the attribute 'instance-path' has no effect here")
                    .label("expected before a STRING in the VAR of a FUNCTION_BLOCK or PROGRAM"),
            );
        }
        marks
    }

    fn declared_names(&mut self) -> FxHashMap<Location, String> {
        let of_pous = self.pous.iter().flat_map(|it| &it.ast.blocks).flat_map(|it| &it.vars);
        let names: Vec<_> = of_pous.flat_map(|it| &it.names).copied().collect();
        names.into_iter().map(|it| (self.location(it.span), it.text.to_owned())).collect()
    }

    /// All variables that are not inside of others, with their paths.
    fn path_roots(&mut self) -> Vec<(StructId, FieldId, String)> {
        let mut roots = Vec::new();
        let mut of_globals: FxHashMap<Location, String> = FxHashMap::default();
        let globals: Vec<_> = self.globals.iter().map(|it| (it.name, it.space)).collect();
        for (name, space) in globals {
            let path = self.names.in_full(space, name.text);
            of_globals.insert(self.location(name.span), path);
        }
        for slot in 0..self.pous.len() {
            let (pou, owner) = (self.pous[slot].ast, self.pous[slot].owner);
            if pou.kind == PouKind::Program {
                of_globals.insert(self.location(pou.name.span), self.name_in_full(pou.name));
            }
            // VAR_STAT, which is declared once.
            let around = owner.map_or(String::new(), |it| format!("{}.", self.pous[it].ast.name.text));
            for name in pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names) {
                if self.synthetic.statics.contains_key(&name.span) {
                    let at = self.location(name.span);
                    of_globals.entry(at).or_insert_with(|| format!("{around}{}.{}", pou.name.text, name.text));
                }
            }
        }
        let program = &self.program;
        for (at, field) in program.structure(program.globals).fields.iter().enumerate() {
            if let Some(path) = of_globals.get(&field.location) {
                roots.push((program.globals, FieldId::next(at), path.clone()));
            }
        }
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

impl<'s> Marked<'s> {
    fn new(program: &'s Program, marks: FxHashSet<Location>, names: FxHashMap<Location, String>) -> Self {
        let mut marked = Self { program, marks, names, holders: FxHashSet::default() };
        // A structure is after those it contains.
        for (at, structure) in program.structs.iter().enumerate() {
            let holds = |it: &staunch_ir::Field| marked.is_path(it.location, it.ty) || marked.holds(it.ty);
            if structure.fields.iter().any(holds) {
                marked.holders.insert(StructId::next(at));
            }
        }
        marked
    }

    fn is_path(&self, at: Location, ty: Type) -> bool {
        matches!(ty, Type::String(_)) && self.marks.contains(&at)
    }

    fn holds(&self, ty: Type) -> bool {
        match ty {
            Type::Struct(id) => self.holders.contains(&id),
            Type::Array(id) => self.holds(self.program.array(id).element),
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
        let fields = self.program.structure(id).fields.iter().enumerate();
        let member = |(at, field): (usize, &staunch_ir::Field)| {
            let value = value.part(at);
            if self.is_path(field.location, field.ty) {
                return text(field.ty, path);
            }
            let name = self.names.get(&field.location).map_or(field.name.as_str(), String::as_str);
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
        let array = self.program.array(id);
        let one = |(at, index): (usize, i64)| {
            indices.push(index.to_string());
            let value = self.elements(array.element, &value.part(at), path, indices);
            indices.pop();
            (1, value)
        };
        Const::Array((array.low..=array.high).enumerate().map(one).collect())
    }
}

/// What a STRING keeps of the path.
fn text(ty: Type, path: &str) -> Const {
    let capacity = if let Type::String(it) = ty { it.capacity } else { 0 };
    let mut chars = Chars::Narrow(path.bytes().collect());
    chars.cut(capacity);
    if chars.is_empty() { Const::Zero } else { Const::Text(chars) }
}
