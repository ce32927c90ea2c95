//! What FUNCTIONs of one name are called: by the types that they take.

use super::declarations::Declarations;
use crate::ast::VarKind;

impl Declarations<'_> {
    /// Gives each of them a name of its own: `Scale_INT_INT`.
    pub fn name_overloads(&mut self) {
        let mut slots: Vec<_> = self.overloads.sets.values().flatten().copied().collect();
        slots.sort_unstable();
        for slot in slots {
            let mut name = self.name_in_full(self.pous[slot].ast.name);
            for ty in self.parameter_types(slot) {
                let parts = ty.split(|it: char| !it.is_ascii_alphanumeric()).filter(|it| !it.is_empty());
                parts.for_each(|it| name.extend(["_", it]));
            }
            let name = self.own_name(name);
            self.overloads.names.insert(slot, name);
        }
    }

    /// The types of the parameters of a FUNCTION, as they are written.
    pub fn parameter_types(&self, slot: usize) -> Vec<&str> {
        let is_parameter = |it: VarKind| matches!(it, VarKind::Input | VarKind::InOut | VarKind::Output);
        let blocks = self.pous[slot].ast.blocks.iter().filter(|it| is_parameter(it.kind));
        let declared = blocks.flat_map(|it| &it.vars);
        declared.flat_map(|it| it.names.iter().map(|_| self.log.sources.text(it.ty.span))).collect()
    }
}
