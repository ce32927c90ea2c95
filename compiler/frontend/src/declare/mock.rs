//! The globals behind the FUNCTIONs that a unit test replaces.

use crate::ast::{self, PouKind};
use crate::names::Entry;
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use crate::types::tests::FunctionMock;
use rustc_hash::FxHashSet;
use staunch_ir::{Const, Field, Place, Retain, Section, Type};

impl<'s> Declarations<'s> {
    /// Gives each of the FUNCTIONs, by their names, the variables of its mock.
    pub(super) fn declare_mocks(&mut self, names: &FxHashSet<Key<'s>>) {
        for slot in 0..self.pous.len() {
            let pou = self.pous[slot].ast;
            let is_mocked = names.contains(&Key(pou.name.text)) && !self.is_generic(slot) && !self.overloads.have(slot);
            if pou.kind != PouKind::Function || !is_mocked {
                continue;
            }
            let Some(result) = self.signature(slot).and_then(|it| it.result.as_ref().map(|it| it.1.ty)) else {
                continue;
            };
            let active = self.mock_variable(pou.name, "mocked", Type::BOOL);
            let value = self.mock_variable(pou.name, "result", result);
            self.tests.mocks.insert(slot, FunctionMock { active, value });
        }
    }

    fn mock_variable(&mut self, function: ast::Name<'s>, what: &str, ty: Type) -> Place {
        let field = Field {
            name: format!("{}_{what}", function.text),
            ty,
            initial: Const::Zero,
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: None,
            location: self.location(function.span),
        };
        let at = self.add_synthetic(field, None);
        self.synthetic_place(at)
    }

    /// The mock of a FUNCTION.
    pub(crate) fn mock_of(&self, name: ast::Name<'s>) -> Option<FunctionMock> {
        let Some(Entry::Pou(slot)) = self.declared(name) else { return None };
        self.tests.mocks.get(&slot).cloned()
    }
}
