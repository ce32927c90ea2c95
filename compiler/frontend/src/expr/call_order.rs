//! What a program makes of the order in which a call is done, as far as a compiler does it in another one.

use super::argument::{Parts, Role};
use super::binding::Parameter;
use super::checker::Checker;
use super::order::Held;
use crate::dialect::rules::is_followed;
use crate::types::siblings::Siblings;
use crate::types::signature::pin_place;
use crate::{Span, ast};
use ast::ArgumentKind;
use staunch_ir::{
    Argument, Expr, Location, Part, Place, Root, RoutineId, Section, Statement, StatementKind, Type, Use, alias, visit,
};

impl<'s> Checker<'_, 's> {
    /// An input that another argument reads, and a target that is another one after the call. `call` is its statements.
    pub(crate) fn note_order(&mut self, parts: &Parts, call: &[Statement]) {
        let dialect = parts.parts.last().map(|it| self.decl.dialect(it.span));
        if dialect.is_none_or(|it| is_followed(it, Part::InputReadInCall)) {
            return;
        }
        let instance = parts.parts.first().filter(|it| matches!(it.role, Role::Instance)).and(parts.instance());
        let copied = if instance.is_some() { Part::InOutCopied } else { Part::InOutOfFunctionCopied };
        self.note_target_passed(parts, copied);
        let Some(instance) = instance else { return };
        let stored: Vec<_> = parts.parts.iter().map(|it| input_of(instance, &it.role)).collect();
        self.note_calls_in_arguments(parts, &stored, call);
        for (at, (part, written)) in parts.parts.iter().zip(&parts.written).enumerate() {
            let found = match part.role {
                Role::Stored(..) | Role::Passed(_) => {
                    let others = stored.iter().enumerate().filter(|it| it.0 != at).filter_map(|it| it.1.clone());
                    let stores: Vec<_> = others.map(|it| stored_as_it_is(&it)).collect();
                    self.held_changes(&stores, &written.held).then_some(Part::InputReadInCall)
                }
                Role::Target(..) | Role::Count(..) => {
                    self.held_changes(&call[..written.last], &written.held).then_some(Part::TargetChanged)
                }
                Role::Instance | Role::Copied(..) => None,
            };
            if let Some(found) = found {
                self.note_use(Use::Part(found), part.span);
            }
        }
    }

    /// Calls of an operand, which its statements from `mark` on have, and what it reads, with the calls of the operands before it.
    pub(crate) fn note_siblings(&mut self, mark: usize, value: Option<&Expr>) {
        let Some(from) = self.statement_from.filter(|it| *it < mark) else { return };
        let (first, second) = (Calls::of(&self.block[from..mark]), Calls::of(&self.block[mark..]));
        let Some(at) = second.at.or(value.map(|it| it.at)).filter(|_| !first.callees.is_empty()) else { return };
        let share = first.given.iter().any(|it| self.changed_by(&self.block[mark..], it))
            || second.given.iter().any(|it| self.changed_by(&self.block[from..mark], it));
        let reads = value.map_or([false; 2], |it| self.reads_of(it, &first.given));
        self.decl.siblings.push(Siblings { first: first.callees, second: second.callees, reads, share, at });
    }

    /// Whether a value depends on what calls were given, and on what all can reach.
    fn reads_of(&self, value: &Expr, given: &[Place]) -> [bool; 2] {
        let frame = self.frame();
        let mut shared = false;
        visit::reads(value, &mut |it| shared |= matches!(it.root, Root::Globals) || it.is_followed());
        [given.iter().any(|it| alias::reads(&frame, value, it)), shared]
    }

    /// A place that is written before an operand, where the order matters.
    pub(crate) fn kept_order(&self, place: &Place) -> Option<Held> {
        self.statement_from.map(|_| Held::Place(place.clone()))
    }

    /// What is written before an operand, and what the operand changes, whose statements are those from `mark` on.
    pub(crate) fn note_reordered(&mut self, mark: usize, before: Option<&Held>, span: Span) {
        if before.is_some_and(|it| self.held_changes(&self.block[mark..], it)) {
            self.note_use(Use::Part(Part::EvaluationOrder), span);
        }
    }

    fn changed_by(&self, block: &[Statement], place: &Place) -> bool {
        self.held_changes(block, &Held::Value(loaded(place)))
    }

    /// Calls in arguments and targets that get the instance: what they read of it may be what the call stores.
    fn note_calls_in_arguments(&mut self, parts: &Parts, stored: &[Option<Place>], call: &[Statement]) {
        let mut given = Vec::new();
        for hoisted in self.block.iter().skip(parts.before) {
            if let StatementKind::Call { instance, arguments, .. } = &hoisted.kind {
                let passed = arguments.iter().filter_map(|it| match it {
                    Argument::Reference(place) => Some(place),
                    Argument::Value(_) => None,
                });
                given.extend(instance.iter().chain(passed).map(|it| Held::Value(loaded(it))));
            }
        }
        let Some(span) = parts.parts.last().map(|it| it.span) else { return };
        let stores: Vec<_> = stored.iter().flatten().map(stored_as_it_is).collect();
        let has_target = parts.parts.iter().any(|it| matches!(it.role, Role::Target(..)));
        if given.iter().any(|it| self.held_changes(&stores, it)) {
            self.note_use(Use::Part(Part::InputReadInCall), span);
        }
        if has_target && given.iter().any(|it| self.held_changes(call, it)) {
            self.note_use(Use::Part(Part::TargetChanged), span);
        }
    }

    /// A variable that is given for an output and for a VAR_IN_OUT.
    fn note_target_passed(&mut self, parts: &Parts, copied: Part) {
        let places = |is: fn(&Role) -> bool| {
            let all = parts.parts.iter().zip(&parts.written).filter(move |it| is(&it.0.role));
            all.filter_map(|(part, written)| Some((written.place()?, part.span)))
        };
        let passed = places(|it| matches!(it, Role::Passed(_) | Role::Copied(..)));
        let passed: Vec<_> = passed.map(|it| Held::Value(loaded(it.0))).collect();
        let is_passed = |target: &Place| {
            let stored = [stored_as_it_is(target)];
            passed.iter().any(|it| self.held_changes(&stored, it))
        };
        let found = places(|it| matches!(it, Role::Target(..))).find(|it| is_passed(it.0));
        if let Some((_, span)) = found {
            self.note_use(Use::Part(copied), span);
        }
    }

    /// Named arguments of a METHOD that do not come as it declares them.
    pub(crate) fn note_named_order(&mut self, parameters: &[Parameter<'_>], arguments: &[ast::Argument<'s>]) {
        let is_other = |(argument, parameter): (&ast::Argument<'s>, Option<&Parameter<'_>>)| match &argument.kind {
            ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. } => {
                parameter.is_none_or(|it| !it.name.eq_ignore_ascii_case(name.text))
            }
            ArgumentKind::Positional(_) => false,
        };
        let declared = parameters.iter().map(Some).chain(std::iter::repeat(None));
        if let Some((first, _)) = arguments.iter().zip(declared).find(|it| is_other(*it)) {
            self.note_use(Use::Part(Part::NamedOrder), first.span);
        }
    }

    /// Arguments by position for a block that has a VAR_IN_OUT.
    pub(crate) fn note_positions(
        &mut self,
        parameters: &[Parameter<'_>],
        arguments: &[ast::Argument<'s>],
        callee: Span,
    ) {
        let is_positional = |it: &ast::Argument<'s>| matches!(it.kind, ArgumentKind::Positional(_));
        if parameters.iter().any(|it| it.section == Section::InOut) && arguments.iter().any(is_positional) {
            self.note_use(Use::Part(Part::PositionsOfBlock), callee);
        }
    }
}

/// The calls among statements.
#[derive(Default)]
struct Calls {
    callees: Vec<RoutineId>,
    /// The instances and variables that they are given.
    given: Vec<Place>,
    at: Option<Location>,
}

impl Calls {
    fn of(block: &[Statement]) -> Self {
        let mut calls = Self::default();
        visit::statements(block, &mut |statement| {
            let StatementKind::Call { callee, instance, arguments, .. } = &statement.kind else { return };
            calls.callees.push(*callee);
            calls.at = calls.at.or(Some(statement.at));
            let passed = arguments.iter().filter_map(|it| match it {
                Argument::Reference(place) => Some(place),
                Argument::Value(_) => None,
            });
            calls.given.extend(instance.iter().chain(passed).cloned());
        });
        calls
    }
}

fn loaded(place: &Place) -> Expr {
    Expr::load(place.clone(), Location::default())
}

fn stored_as_it_is(place: &Place) -> Statement {
    Statement::assign(place.clone(), loaded(place), Location::default())
}

/// The input that a part of a call is stored in.
fn input_of(instance: &Place, role: &Role) -> Option<Place> {
    match (role, instance.ty) {
        (Role::Stored(field, ty), _) => Some(instance.clone().field(*field, *ty)),
        (Role::Passed(number), Type::Block(block)) => {
            let name = block.info().inputs().nth(*number)?.name;
            Some(pin_place(instance.clone(), block, name))
        }
        _ => None,
    }
}
