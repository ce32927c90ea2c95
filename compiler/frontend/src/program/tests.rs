//! The unit tests of a program, for who runs them.

use crate::ast::PouKind;
use crate::testing::Test;
use crate::types::declarations::Declarations;

/// The tests that were declared, in the order of their instances.
pub(crate) fn tests(declarations: &mut Declarations<'_>) -> Vec<Test> {
    let slots = (0..declarations.pous.len()).filter(|it| declarations.pous[*it].ast.kind == PouKind::Test);
    let test = |slot: usize| {
        let name = declarations.pous[slot].ast.name;
        let title = name.text.get(1..name.text.len() - 1).unwrap_or_default().to_owned();
        let assertions = declarations.tests.assertions.get(&slot).cloned().unwrap_or_default();
        Test { title, span: name.span, instance: declarations.emitted_name(slot), assertions }
    };
    slots.map(test).collect()
}
