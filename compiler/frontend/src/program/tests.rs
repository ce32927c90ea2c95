//! The unit tests of a program, for who runs them.

use crate::ast::PouKind;
use crate::testing::{Assertion, FAILED, Groups, Test};
use crate::types::declarations::Declarations;
use std::sync::Arc;

/// The tests that were declared, in the order of their instances.
pub(crate) fn tests(declarations: &mut Declarations<'_>, mut groups: Groups) -> Vec<Test> {
    let slots = (0..declarations.pous.len()).filter(|it| declarations.pous[*it].ast.kind == PouKind::Test);
    let shared: Arc<[Assertion]> = declarations.tests.shared.as_slice().into();
    let broken = declarations.tests.broken.as_ref().map_or_else(String::new, |it| it.0.clone());
    let test = |slot: usize| {
        let name = declarations.pous[slot].ast.name;
        let instance = declarations.emitted_name(slot);
        let (suite, fixture) = (groups.suites.remove(&name.span), groups.fixtures.remove(&name.span));
        if suite.is_some() || fixture.is_some() {
            let in_full = fixture.is_some().then(|| declarations.name_in_full(name));
            let (title, assertions) = (in_full.unwrap_or_else(|| name.text.to_owned()), Arc::clone(&shared));
            return Test { title, span: name.span, instance, assertions, failed: broken.clone(), suite, fixture };
        }
        let title = title(name.text);
        let failed = format!("{instance}.{FAILED}");
        let in_test = |it: &Option<String>| it.as_ref().map(|it| format!("{instance}.{it}"));
        let own = declarations.tests.assertions.get(&slot).into_iter().flatten().map(|it| Assertion {
            actual: in_test(&it.actual),
            expected: in_test(&it.expected),
            tolerance: in_test(&it.tolerance),
            message: in_test(&it.message),
            ..it.clone()
        });
        Test { title, span: name.span, assertions: own.collect(), failed, instance, suite: None, fixture: None }
    };
    slots.map(test).collect()
}

/// What is in the quotes, with `$'`, `$"` and `$$` for what they stand for.
fn title(written: &str) -> String {
    let mut characters = written.get(1..written.len() - 1).unwrap_or_default().chars().peekable();
    let mut title = String::new();
    while let Some(character) = characters.next() {
        let escaped = characters.next_if(|it| character == '$' && matches!(it, '\'' | '"' | '$'));
        title.push(escaped.unwrap_or(character));
    }
    title
}
