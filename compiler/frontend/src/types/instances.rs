//! The instances of generic FUNCTIONs.

use super::declarations::{Declarations, PouSlot, Slot};
use super::generic::{Instance, class_named};
use super::table::{scalar_initial, struct_initial};
use crate::diagnostic::{Label, wording::all_of};
use crate::names::{Found, Sense};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Const, Elementary, Type};
use staunch_runtime::Class;
use std::cell::Cell;
use std::rc::Rc;

/// A FUNCTION has at most so many instances: generics that call generics with arrays of what they are given could
/// make a number that grows with each level.
const MAX_INSTANCES: usize = 1000;
/// A message names at most so many of the calls that lead to it.
const MAX_CALLS: usize = 3;

/// The type with which a FUNCTION is declared: what most of the class's values are values of.
fn widest(class: Class) -> Type {
    Type::Elementary(match class {
        Class::Any | Class::Elementary | Class::Magnitude | Class::Num | Class::Real => Elementary::Lreal,
        Class::Int | Class::Signed => Elementary::Lint,
        Class::Unsigned => Elementary::Ulint,
        Class::Duration => Elementary::Ltime,
        Class::Date => Elementary::Ldt,
        Class::Bit => Elementary::Lword,
        Class::Char => Elementary::Wchar,
        Class::Chars | Class::String => return Type::string(254),
    })
}

/// Whether an error depends on what types there are.
pub(crate) fn is_about_types(code: Code) -> bool {
    code.name()[1..].starts_with("02")
}

impl<'s> Declarations<'s> {
    pub fn is_generic(&self, slot: usize) -> bool {
        !self.pous[slot].words.is_empty()
    }

    /// What the words of the FUNCTION in a slot mean in it.
    pub fn words_of(&self, slot: usize) -> Vec<(Class, Type)> {
        match &self.pous[slot].instance {
            Some(instance) => {
                self.pous[instance.of].words.iter().copied().zip(instance.types.iter().copied()).collect()
            }
            None => self.pous[slot].words.iter().map(|it| (*it, widest(*it))).collect(),
        }
    }

    /// What a word means in the signature that is being made.
    pub fn type_of_word(&self, class: Class) -> Option<Type> {
        self.generics.words.iter().find(|it| it.0 == class).map(|it| it.1)
    }

    /// What a variable of a type starts with that only a word declares.
    pub fn start_of(&self, ty: Type) -> Const {
        match ty {
            Type::Array(id) => match &self.table.elements[id.index()].initial {
                Const::Zero => Const::Zero,
                element => Const::Array(vec![(self.program.array(id).len(), element.clone())]),
            },
            Type::Struct(id) => struct_initial(&self.program.structure(id).fields),
            Type::Enum(id) => {
                let first = self.program.enumeration(id).values.first();
                first.map_or(Const::Zero, |it| scalar_initial(it.value))
            }
            Type::Elementary(_) | Type::Subrange(..) | Type::String(_) | Type::Reference(_) | Type::Block(_) => {
                self.least(ty)
            }
        }
    }

    /// The slot of the generic FUNCTION `of` with these types; `None` where there cannot be one, which has been
    /// reported. The call at `call` is in the body of `within`.
    pub fn instance_of_generic(
        &mut self,
        of: usize,
        types: Vec<Type>,
        call: Span,
        within: Option<usize>,
    ) -> Option<usize> {
        if let Some(way) = self.calls_itself(of, within) {
            self.report_generic_recursion(way, call);
            return None;
        }
        if let Some(slot) = self.generics.slots.get(&(of, types.clone())) {
            return matches!(self.pous[*slot].slot, Slot::Done(_)).then_some(*slot);
        }
        let count = self.generics.counts.entry(of).or_default();
        *count += 1;
        if *count > MAX_INSTANCES + 1 {
            return None;
        }
        if *count > MAX_INSTANCES {
            let name = self.pous[of].ast.name.text;
            let message = format!("`{name}` is called with more than {MAX_INSTANCES} combinations of types");
            self.report(Diagnostic::new(Code::E0901, call, message).label("each would be a separate FUNCTION"));
            return None;
        }
        let slot = self.pous.len();
        let name = self.instance_name(of, &types);
        let instance = Instance { of, types: types.clone(), name, call, within };
        let PouSlot { ast, names_itself, owner, .. } = self.pous[of];
        self.pous.push(PouSlot { names_itself, owner, instance: Some(instance), ..PouSlot::open(ast) });
        self.generics.slots.insert((of, types), slot);
        let reported = self.log.diagnostics.len();
        let signature = (self.build_signature)(self, slot);
        self.pous[slot].slot = signature.map_or(Slot::Failed, Slot::Done);
        self.say_of_instance(slot, reported);
        matches!(self.pous[slot].slot, Slot::Done(_)).then_some(slot)
    }

    /// The slots on the way from `of` to a call of it, where `within` is on one.
    fn calls_itself(&self, of: usize, within: Option<usize>) -> Option<Vec<usize>> {
        let mut way = Vec::new();
        let mut at = within;
        while let Some(slot) = at {
            way.push(slot);
            if self.as_written(slot) == of {
                way.reverse();
                return Some(way);
            }
            at = self.pous[slot].instance.as_ref().and_then(|it| it.within);
        }
        None
    }

    /// The slot of the FUNCTION that one in a slot is an instance of, or is.
    fn as_written(&self, slot: usize) -> usize {
        self.pous[slot].instance.as_ref().map_or(slot, |it| it.of)
    }

    /// With other types it still calls itself: its arguments do not decide what it calls. Wherever a call
    /// enters the circle, that is said of the first of it in the text, so that it is said once.
    fn report_generic_recursion(&mut self, mut way: Vec<usize>, last: Span) {
        let again = self.pous[way[0]].ast.name.text;
        let first = (0..way.len()).min_by_key(|it| self.as_written(way[*it])).unwrap_or_default();
        way.rotate_left(first);
        let name = self.pous[way[0]].ast.name;
        let way: Vec<_> = way.iter().chain([&way[0]]).map(|it| self.pous[*it].ast.name.text).collect();
        let error = Diagnostic::new(Code::E0310, name.span, format!("`{}` calls itself", name.text))
            .label("recursion could need an unlimited amount of stack")
            .other(last, format!("`{again}` is called here"))
            .note(format!("the chain of calls is {}", way.join(" -> ")))
            .help("write it as a loop");
        self.report(error);
    }

    /// `Largest_INT`; where something else has that name, one like it.
    fn instance_name(&mut self, of: usize, types: &[Type]) -> String {
        let pou = self.pous[of].ast;
        let is_method = self.pous[of].owner.is_some();
        let mut name = if is_method { pou.name.text.to_owned() } else { self.name_in_full(pou.name) };
        for ty in types {
            let text = self.program.type_name(*ty);
            let parts = text.split(|it: char| !it.is_ascii_alphanumeric()).filter(|it| !it.is_empty());
            parts.for_each(|it| name.extend(["_", it]));
        }
        self.own_name(name)
    }

    /// A name that back ends have for nothing else, that or one like it.
    pub fn own_name(&mut self, mut name: String) -> String {
        let taken = |this: &Self, name: &str| {
            this.names.root(name).is_some() || this.generics.names.contains(&name.to_ascii_uppercase())
        };
        let stem = name.clone();
        let mut number = 2;
        while taken(self, &name) {
            name = format!("{stem}_{number}");
            number += 1;
        }
        self.generics.names.insert(name.to_ascii_uppercase());
        name
    }

    /// Adds to what was reported since then which instance it is about. A message that applies to all types is given once.
    pub fn say_of_instance(&mut self, slot: usize, since: usize) {
        let calls = self.calls_of(slot);
        for mut it in self.log.diagnostics.split_off(since) {
            if self.generics.reported.insert((it.code, it.span, it.message.clone())) {
                it.others.extend(calls.iter().cloned());
                // What mends it for this type is wrong for another.
                if is_about_types(it.code) {
                    (it.help, it.fix) = (None, None);
                }
                self.log.report(it);
            }
        }
    }

    /// The calls that lead to an instance, from its own to one in a FUNCTION or program that is not generic.
    fn calls_of(&self, slot: usize) -> Vec<Label> {
        let mut calls = Vec::new();
        let mut at = Some(slot);
        while let Some(instance) = at.and_then(|it| self.pous[it].instance.as_ref()) {
            let pou = &self.pous[instance.of];
            let types = pou.words.iter().zip(&instance.types);
            let types: Vec<_> =
                types.map(|(word, ty)| format!("{} = {}", word.name(), self.program.type_name(*ty))).collect();
            let types: Vec<_> = types.iter().map(String::as_str).collect();
            let text = format!("`{}` is called here with {}", pou.ast.name.text, all_of(&types));
            calls.push(Label { span: instance.call, text });
            at = instance.within;
        }
        calls.truncate(MAX_CALLS);
        calls
    }

    /// What was reported of a FUNCTION as it is written, since then: nobody gives its words their types, so what
    /// these decide is left out.
    pub fn say_of_generic(&mut self, since: usize, is_certain: impl Fn(&Diagnostic) -> bool) {
        for it in self.log.diagnostics.split_off(since) {
            if is_certain(&it) && self.generics.reported.insert((it.code, it.span, it.message.clone())) {
                self.log.report(it);
            }
        }
    }

    /// The word that a type is, and not only has in it.
    pub fn word(&self, spec: &ast::TypeSpec<'s>) -> Option<Class> {
        let ast::TypeKind::Named(path) = &spec.kind else { return None };
        let [name] = path.as_slice() else { return None };
        self.class_word(*name)
    }

    /// The class that a name means, unless something is declared by that name.
    pub fn class_word(&self, name: ast::Name<'s>) -> Option<Class> {
        class_named(name.text).filter(|_| {
            self.lookup(&[name], Sense::Type) == Found::Nothing && !self.table.any.words.contains(&name.span)
        })
    }

    /// Whether variables of an instance count as used because those of the FUNCTION do.
    pub fn used_in_generic(&self, slot: usize, name: &str) -> Option<Rc<Cell<bool>>> {
        let of = self.pous[slot].instance.as_ref()?.of;
        let Slot::Done(signature) = &self.pous[of].slot else { return None };
        Some(Rc::clone(&signature.scope.get(name)?.used))
    }

    /// Lets go of instances, and of routines that choose by a class, that only FUNCTIONs asked for which nobody calls.
    pub fn forget_instances(&mut self, from: usize) {
        self.pous.truncate(from);
        self.generics.slots.retain(|_, slot| *slot < from);
        self.dispatches.retain(|_, slot| *slot < from);
    }

    /// Whether calls ask for an instance of the FUNCTION in a slot.
    pub fn has_instances(&self, slot: usize) -> bool {
        self.generics.counts.contains_key(&slot)
    }
}
