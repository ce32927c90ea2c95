//! Variables that nothing reads or writes.

use crate::ast::PouKind;
use crate::testing;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashSet;
use staunch_ir::{Section, Type};

/// Reports them, when all bodies have been checked: a variable may be read from outside as well.
pub(crate) fn report(decl: &mut Declarations<'_>) {
    let mut used = FxHashSet::default();
    for slot in 0..decl.pous.len() {
        let Some(signature) = decl.signature(slot) else { continue };
        used.extend(signature.scope.variables.iter().filter(|it| it.used.get()).map(|it| it.name.span));
    }
    let is_written =
        |it: &usize| decl.pous[*it].instance.is_none() && !decl.is_head(*it) && decl.pous[*it].ast.external.is_none();
    for slot in (0..decl.pous.len()).filter(is_written).collect::<Vec<_>>() {
        of_pou(decl, slot, &used);
    }
}

/// What is inherited is one with the base's, and is used where one of them is.
fn of_pou(decl: &mut Declarations<'_>, slot: usize, used: &FxHashSet<Span>) {
    let Some(signature) = decl.signature(slot) else { return };
    let pou = decl.pous[slot].ast;
    // What SETUP declares is for several tests.
    let own = |it: Span| pou.kind != PouKind::Test || (pou.span.start <= it.start && it.end <= pou.span.end);
    for variable in &signature.scope.variables {
        let internal = matches!(variable.section, Section::Internal | Section::Temp | Section::External);
        if internal
            && own(variable.name.span)
            && !used.contains(&variable.name.span)
            && !variable.name.text.starts_with(['_', '%'])
            && !is_suite(decl, variable.place.ty)
        {
            decl.report(
                Diagnostic::new(Code::W0501, variable.name.span, format!("`{}` is never used", variable.name.text))
                    .label("declared here, but never read or written"),
            );
        }
    }
}

/// Whether it is a suite of TcUnit, which runs where there is an instance of it.
fn is_suite(decl: &Declarations<'_>, ty: Type) -> bool {
    let Type::Struct(state) = ty else { return false };
    let slot = decl.slot_of_instance(state);
    slot.is_some_and(|it| testing::suite::is_suite(decl.pous[it].ast))
}
