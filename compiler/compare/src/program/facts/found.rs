//! What is known of a program's variables.

use super::numbers::Numbers;
use crate::program::scalar::Way;
use crate::program::walked::Name;
use staunch_ir::{Chars, Const, FieldId, Program, Type, Value};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Texts that may be those of numbers.
const MOST_TEXTS: usize = 16;

/// The number that a text is: `INT_TO_STRING(n) = '5'` compares `n` with it.
fn spelled(text: &Chars) -> Option<Value> {
    let Chars::Narrow(letters) = text else { return None };
    let text = std::str::from_utf8(letters).ok()?.trim();
    text.parse().map(Value::I64).or_else(|_| text.parse().map(Value::F64)).ok()
}

/// What statements say of variables, by their declarations.
#[derive(Debug, Default)]
pub struct Facts {
    pub(super) near: HashMap<Name, Numbers>,
    /// Values of the first go to the second, as they are.
    pub(super) flows: HashSet<(Name, Name)>,
    /// The texts that a string is compared with.
    pub(super) texts: HashMap<Name, Vec<Chars>>,
    /// What is worth trying, and proves nothing: it is found by going back through what is computed.
    pub(super) hints: HashMap<Name, Numbers>,
    /// Used in another way than compared with constants and handed on.
    pub(super) computed: HashSet<Name>,
    /// By statements of others than the PROGRAM that holds it.
    pub(super) written: HashSet<Name>,
    /// From the states of PROGRAMs and the globals.
    pub(super) written_ways: HashSet<Way>,
    pub(super) read: HashSet<Name>,
    /// Arrays that nothing writes: where the elements before an index are others than those from it on.
    pub(super) tables: HashMap<Name, Vec<i128>>,
    /// Every constant of the program that is a whole number or a time.
    pub constants: BTreeSet<i128>,
    /// Every text of the program.
    pub all_texts: Vec<Chars>,
    /// Every time of the program, in nanoseconds.
    pub times: BTreeSet<i64>,
}

impl Facts {
    /// The numbers that decide something about a variable.
    pub fn near(&self, name: Name) -> Numbers {
        self.near.get(&name).cloned().unwrap_or_default()
    }

    /// Those, and numbers for which what is computed of the variable comes near a limit.
    pub fn worth_trying(&self, name: Name) -> Numbers {
        let mut found = self.near(name);
        found.add_all(self.hints.get(&name).cloned().unwrap_or_default());
        if !self.only_compared(name) {
            self.all_texts.iter().take(MOST_TEXTS).filter_map(spelled).for_each(|it| found.add(it));
        }
        found
    }

    pub fn texts(&self, name: Name) -> Vec<Chars> {
        self.texts.get(&name).cloned().unwrap_or_default()
    }

    /// Whether its value goes to another variable, as it is.
    pub fn is_handed_on(&self, name: Name) -> bool {
        self.flows.iter().any(|it| it.0 == name)
    }

    pub(super) fn near_to_text(&mut self, name: Name, text: &Chars) -> bool {
        let known = self.texts.entry(name).or_default();
        let is_new = !known.contains(text);
        if is_new {
            known.push(text.clone());
        }
        is_new
    }

    /// Whether nothing but comparisons with those numbers depends on a variable's value.
    pub fn only_compared(&self, name: Name) -> bool {
        !self.computed.contains(&name)
    }

    /// Whether a statement writes a variable, or what it is in, or something in it.
    pub fn is_written(&self, name: Name, way: &Way) -> bool {
        self.written.contains(&name) || self.written_ways.iter().any(|it| it.meets(way))
    }

    /// Whether a statement writes anything in the variable that `whole` leads to, which this is a part of.
    pub fn is_written_around(&self, name: Name, way: &Way, whole: usize) -> bool {
        let is_member = way.members.len() > whole;
        let beside = |it: &Name| match (*it, name) {
            (Name::Field(a, _), Name::Field(b, _)) => is_member && a == b,
            (Name::Field(..) | Name::Local(..) | Name::Param(..), _) => false,
        };
        let all = Way { from: way.from, members: way.members[..whole].to_vec() };
        self.is_written(name, &all) || self.written.iter().any(beside)
    }

    /// Whether it is an element of an array whose elements count as constants.
    pub fn is_of_table(&self, name: Name) -> bool {
        self.tables.contains_key(&name)
    }

    /// Whether some statement writes the variable of this declaration, in whatever it is.
    pub(super) fn is_written_somewhere(&self, name: Name) -> bool {
        let is_it = |way: &Way| match name {
            Name::Field(_, field) => way.members.contains(&field),
            Name::Local(..) | Name::Param(..) => false,
        };
        self.written.contains(&name) || self.written_ways.iter().any(is_it)
    }

    pub fn is_read(&self, name: Name) -> bool {
        self.read.contains(&name)
    }

    pub(super) fn text(&mut self, text: &Chars) {
        if !self.all_texts.contains(text) {
            self.all_texts.push(text.clone());
        }
    }

    pub(super) fn constant(&mut self, ty: Option<Type>, value: Value) {
        match value {
            Value::I64(time) if ty.and_then(Type::elementary).is_some_and(|it| it.is_time()) => {
                self.times.insert(time);
                self.constants.insert(i128::from(time));
            }
            Value::Bool(_) => {}
            other => self.constants.extend(other.as_integer()),
        }
    }

    pub(super) fn initial(&mut self, ty: Option<Type>, value: &Const) {
        let pin = |at: usize| match ty {
            Some(Type::Block(id)) => id.pin_type(FieldId::next(at)),
            _ => None,
        };
        match value {
            Const::Scalar(it) => self.constant(ty, *it),
            Const::Zero | Const::Text(_) => {}
            Const::Array(runs) => runs.iter().for_each(|it| self.initial(None, &it.1)),
            Const::Struct(fields) => fields.iter().enumerate().for_each(|(at, it)| self.initial(pin(at), it)),
        }
    }

    /// What a variable holds that nothing writes is a constant of the program: what it is compared with is worth
    /// being that.
    pub(super) fn unwritten(&mut self, program: &Program, name: Name, ty: Type, initial: &Const) {
        match (initial, ty) {
            (Const::Scalar(Value::Bool(_)) | Const::Zero, _) => {}
            (Const::Text(it), _) if !self.is_written_somewhere(name) => {
                self.near_to_text(name, it);
            }
            (Const::Text(_), _) => {}
            (Const::Scalar(it), _) if !self.is_written_somewhere(name) => self.near_to(name, *it),
            (Const::Scalar(_), _) => {}
            (Const::Array(runs), Type::Array(id)) => {
                let element = program.array(id).element;
                runs.iter().for_each(|it| self.unwritten(program, name, element, &it.1));
            }
            (Const::Struct(values), Type::Struct(id)) => {
                for (at, value) in values.iter().enumerate() {
                    let field = FieldId::next(at);
                    if let Some(ty) = program.member(ty, field) {
                        self.unwritten(program, Name::Field(id, field), ty, value);
                    }
                }
            }
            (Const::Array(_) | Const::Struct(_), _) => {}
        }
    }

    pub(super) fn near_to(&mut self, name: Name, value: Value) {
        self.near.entry(name).or_default().add(value);
    }
}
