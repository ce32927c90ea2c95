//! Overloaded FUNCTIONs and METHODs: which exist, and what they are called, by the types that they take.

use super::declarations::{Declarations, Slot};
use super::signature::Formal;
use crate::ast::VarKind;
use staunch_ir::Type;

impl Declarations<'_> {
    /// Gives each of them a name of its own: `Scale_INT_INT`.
    pub fn name_overloads(&mut self) {
        let mut slots: Vec<_> = self.overloads.sets.values().flatten().copied().collect();
        slots.sort_unstable();
        for slot in slots {
            let is_method = self.pous[slot].owner.is_some();
            let mut name = self.emitted_name(slot);
            for ty in self.parameter_types(slot) {
                let parts = ty.split(|it: char| !it.is_ascii_alphanumeric()).filter(|it| !it.is_empty());
                parts.for_each(|it| name.extend(["_", it]));
            }
            // METHODs of other classes may have the name, too.
            let name = if is_method { name } else { self.own_name(name) };
            self.overloads.names.insert(slot, name);
        }
    }

    /// The types of the parameters of a FUNCTION or METHOD, as they are written.
    pub fn parameter_types(&self, slot: usize) -> Vec<&str> {
        let is_parameter = |it: VarKind| matches!(it, VarKind::Input | VarKind::InOut | VarKind::Output);
        let blocks = self.pous[slot].ast.blocks.iter().filter(|it| is_parameter(it.kind));
        let declared = blocks.flat_map(|it| &it.vars);
        declared.flat_map(|it| it.names.iter().map(|_| self.log.sources.text(it.ty.span))).collect()
    }

    /// All that the name of the one in a slot means, where it is the first of them.
    pub fn all_of_a_name(&self, first: usize) -> Vec<usize> {
        self.overloads.sets.get(&first).cloned().unwrap_or_else(|| vec![first])
    }

    /// Whether two take the same arguments. Of what was refused that is not known.
    pub fn have_same_parameters(&self, a: usize, b: usize) -> bool {
        let (Slot::Done(a), Slot::Done(b)) = (&self.pous[a].slot, &self.pous[b].slot) else { return false };
        a.formals.len() == b.formals.len() && a.formals.iter().zip(&b.formals).all(|(a, b)| is_same(a, b))
    }
}

/// Whether two parameters take the same arguments.
fn is_same(a: &Formal<'_>, b: &Formal<'_>) -> bool {
    let types = a.resolved.ty.read() == b.resolved.ty.read()
        || matches!((a.resolved.ty, b.resolved.ty), (Type::String(a), Type::String(b)) if a.wide == b.wide);
    a.section == b.section && a.word == b.word && types
}
