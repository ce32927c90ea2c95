//! The globals for the FUNCTIONs that a unit test replaces.

use crate::ast::{self, PouKind};
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use crate::types::tests::FunctionMock;
use rustc_hash::FxHashSet;
use staunch_ir::{Const, Elementary, Field, Place, Retain, Section, Type};

impl<'s> Declarations<'s> {
    /// Gives each of the FUNCTIONs, by their names, the variables of its mock.
    pub(super) fn declare_mocks(&mut self, names: &FxHashSet<Key<'s>>) {
        for slot in 0..self.pous.len() {
            let pou = self.pous[slot].ast;
            let is_mocked = names.contains(&Key(pou.name.text)) && !self.is_generic(slot);
            if pou.kind != PouKind::Function || !is_mocked {
                continue;
            }
            let Some(result) = self.signature(slot).and_then(|it| it.result.as_ref().map(|it| it.1.ty)) else {
                continue;
            };
            // Others may have the name in other namespaces, or for other parameters.
            let is_known = self.tests.mocks.keys().any(|it| Key(self.pous[*it].ast.name.text) == Key(pou.name.text));
            let more = if is_known { format!("_{slot}") } else { String::new() };
            let active = self.mock_variable(pou.name, &format!("mocked{more}"), Type::BOOL);
            let value = self.mock_variable(pou.name, &format!("result{more}"), result);
            let calls = self.mock_variable(pou.name, &format!("calls{more}"), Type::Elementary(Elementary::Dint));
            self.tests.mocks.insert(slot, FunctionMock { active, value, calls });
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
            declared: None,
        };
        let at = self.add_synthetic(field, None);
        self.synthetic_place(at)
    }

    /// The mocks of the FUNCTIONs that a path names.
    pub(crate) fn mocks_of(&self, path: &[ast::Name<'s>]) -> Vec<FunctionMock> {
        let Found::One(Meaning::Declared(Entry::Pou(slot))) = self.lookup(path, Sense::Callee) else {
            return Vec::new();
        };
        let all = self.overloads.of(slot);
        let slots = all.as_deref().unwrap_or(core::slice::from_ref(&slot));
        slots.iter().filter_map(|it| self.tests.mocks.get(it).cloned()).collect()
    }
}
