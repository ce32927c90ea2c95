//! A pin of a standard block has no address, so in a program with references no VAR_IN_OUT takes one.

use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};
use staunch_ir::visit::statements;
use staunch_ir::{Argument, Location, Place, Program, Routine, StatementKind, Type};

impl Declarations<'_> {
    /// Reports pins that are passed on by reference.
    pub(super) fn check_pins(&mut self) -> Option<()> {
        let program = &self.program;
        if program.references.is_empty() {
            return Some(());
        }
        let mut found: Vec<Location> = Vec::new();
        for routine in &program.routines {
            statements(&routine.body, &mut |it| {
                let StatementKind::Call { arguments, .. } = &it.kind else { return };
                let is_pin = |it: &Argument| match it {
                    Argument::Reference(place) => is_pin(program, routine, place),
                    Argument::Value(_) => false,
                };
                if arguments.iter().any(is_pin) {
                    found.push(it.at);
                }
            });
        }
        for at in &found {
            let span = self.log.name_at(*at);
            self.report(
                Diagnostic::new(
                    Code::E0902,
                    span,
                    "passing a pin to a VAR_IN_OUT in a program with references is not supported yet",
                )
                .label("a pin of a standard block has no address")
                .help("give a variable of your own, and assign it to the pin after the call"),
            );
        }
        found.is_empty().then_some(())
    }
}

fn is_pin(program: &Program, routine: &Routine, place: &Place) -> bool {
    let Some(mut ty) = program.root_type(routine, place.root) else { return false };
    for projection in &place.projections {
        if matches!(ty, Type::Block(_)) {
            return true;
        }
        let Some(part) = program.part(ty, projection) else { return false };
        ty = part;
    }
    false
}
