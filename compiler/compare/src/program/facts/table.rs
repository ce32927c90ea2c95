//! Arrays that are only read: their elements are constants, and what they are indexed with is compared with where these
//! change.

use super::found::Facts;
use crate::program::walked::Name;
use staunch_ir::{ArrayId, Const, Field, FieldId, Program, Retain, Section, StructId, Type};
use std::collections::HashMap;

/// An array that changes at more indices is not followed.
pub const MAX_CHANGES: usize = 64;

/// Of each, the indices at which its elements change.
pub fn find(program: &Program, facts: &Facts) -> HashMap<Name, Vec<i128>> {
    let mut found = HashMap::new();
    for (owner, structure) in program.structs.iter().enumerate() {
        let id = StructId::next(owner);
        for (at, field) in structure.fields.iter().enumerate() {
            let name = Name::Field(id, FieldId::next(at));
            let Type::Array(array) = field.ty else { continue };
            if has_one_value(program, id, field) && !facts.is_written_somewhere(name) {
                found.insert(name, changes(program, array, &field.initial));
            }
        }
    }
    found
}

/// Whether all instances start with the same elements, and nothing outside is meant to write them.
fn has_one_value(program: &Program, owner: StructId, field: &Field) -> bool {
    let is_program = program.instances.iter().any(|it| program.class(it.program).state == owner);
    let is_inside = !matches!(field.section, Section::Input | Section::InOut);
    let is_ours = field.address.is_none() && field.retain != Retain::Kept && is_inside;
    field.constant || (is_program || owner == program.globals) && is_ours
}

fn changes(program: &Program, array: ArrayId, initial: &Const) -> Vec<i128> {
    let Const::Array(runs) = initial else { return Vec::new() };
    let mut at = i128::from(program.array(array).low);
    let mut found = Vec::new();
    for (count, _) in runs {
        found.push(at);
        at += i128::from(*count);
    }
    found
}
