//! The start of instances: the instances inside of each first, then its FB_init, the values that its declaration
//! gives, and its METHODs with `call_after_init`.

use super::checker::Checker;
use super::generic_call::Called;
use crate::added::{KEPT, RETAINS};
use crate::ast::{self, ArgumentKind, InitialKind, LiteralValue, PouKind};
use crate::spelling::Key;
use crate::start::{EXIT, GLOBALS, MEMBERS, START};
use crate::testing::tree::{literal, named};
use crate::types::declarations::Slot;
use crate::types::scope::Variable;
use crate::types::signature::{Signature, Target};
use crate::types::starts::OF_THE_SYSTEM;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{
    Block, Const, Elementary, Expr, FieldId, For, Local, LocalId, Op, ParamId, Place, Root, RoutineId, Section,
    Statement, StatementKind, StructId, Type, Value,
};
use std::rc::Rc;

pub(crate) fn is_start_of_members(callee: &ast::Expr<'_>) -> bool {
    matches!(&callee.kind, ast::ExprKind::Name(name) if name.text == MEMBERS)
}

/// What a declaration says of an instance, or of what holds some.
#[derive(Clone)]
struct Given<'a, 's> {
    /// What its FB_init is given.
    arguments: &'a [ast::Argument<'s>],
    /// One list of them for each element.
    lists: Option<&'a ast::Construction<'s>>,
    initial: Option<&'a ast::Initial<'s>>,
    /// What it starts as, by the declaration.
    value: Const,
    span: Span,
}

/// A variable that FB_init may write, and what the declaration gives it.
struct Assigned {
    place: Place,
    default: Const,
    value: Const,
}

impl<'s> Checker<'_, 's> {
    /// Starts the instances that live for one call, but for those that it is given.
    pub(crate) fn start_locals(&mut self, signature: &Signature<'s>) {
        if !self.decl.starts.is_any {
            return;
        }
        let is_given = |it: &Variable<'s>| matches!(it.section, Section::InOut | Section::Input);
        let is_local = |it: &&Rc<Variable<'s>>| matches!(it.place.root, Root::Local(_)) && !is_given(it);
        let locals: Vec<_> = signature.scope.variables.iter().filter(is_local).map(Rc::clone).collect();
        for variable in locals {
            self.start_variable(&variable);
        }
        self.start_given_back(signature);
    }

    /// Starts the result and the outputs of a FUNCTION or METHOD: members of theirs may have addresses.
    fn start_given_back(&mut self, signature: &Signature<'s>) {
        let Some(span) = self.slot.map(|it| self.decl.pous[it].ast.name.span) else { return };
        let is_function = self.slot.is_some_and(|it| self.decl.pous[it].ast.kind.is_function());
        let outputs = signature.formals.iter().filter(|it| is_function && it.section == Section::Output);
        let outputs = outputs.filter_map(|it| match it.target {
            Target::Param(at) => Some(Place::root(Root::Param(ParamId::next(at)), it.resolved.ty)),
            Target::Field(_) => None,
        });
        let result = signature.result.as_ref().map(|(id, it)| Place::local(*id, it.ty));
        for place in outputs.chain(result).collect::<Vec<_>>() {
            self.start_declared(place, None, Const::Zero, span);
        }
    }

    /// Starts what the POU around holds; the FUNCTION for that starts what is global.
    pub(crate) fn start_members(&mut self, span: Span) {
        let covered = std::mem::replace(&mut self.is_covered, false);
        let Some(slot) = self.slot else { return };
        let owner = self.decl.pous[slot].owner.unwrap_or(slot);
        let kind = self.decl.pous[owner].ast.kind;
        let is_named = self.decl.named_programs.contains_key(&owner);
        if kind == PouKind::Program && slot == owner {
            self.start_program(owner, is_named, span);
            self.is_covered = covered;
            return;
        }
        let variables = match kind {
            PouKind::Function => self.global_instances(),
            PouKind::Program
            | PouKind::FunctionBlock
            | PouKind::Class
            | PouKind::Interface
            | PouKind::Test
            | PouKind::Action
            | PouKind::Method
            | PouKind::Getter
            | PouKind::Setter => self.own_instances(owner),
        };
        if matches!(kind, PouKind::Program | PouKind::Test) && !is_named {
            self.start_globals(span);
        }
        let kept = KEPT[usize::from(kind == PouKind::Function)];
        let (kept_ones, anew): (Vec<_>, Vec<_>) = variables.into_iter().partition(|it| it.retain);
        anew.iter().for_each(|it| self.start_variable(it));
        let once = self.nested(|this| kept_ones.iter().for_each(|it| this.start_variable(it)));
        self.start_once(kept, once, span);
        self.is_covered = covered;
    }

    /// A PROGRAM that others name is one of the globals, and starts with them.
    fn start_program(&mut self, slot: usize, is_named: bool, span: Span) {
        let state = self.decl.signature(slot).and_then(|it| it.state).filter(|_| !is_named);
        match state {
            Some(state) => self.call_start(slot, Place::root(Root::Instance, Type::Struct(state)), span),
            None => self.start_globals(span),
        }
    }

    /// What RETAIN keeps is started when it has its initial values, and not again.
    fn start_once(&mut self, flag: &'static str, mut then: Block, span: Span) {
        if then.is_empty() {
            return;
        }
        let Some(flag) = self.place(&named(flag, span)).map(|it| it.place) else { return };
        let at = self.at(span);
        let truth = Expr::bool(true, at);
        then.push(Statement::assign(flag.clone(), truth, at));
        let condition = Expr::apply(Op::Not, Type::BOOL, vec![Expr::load(flag, at)], at);
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
    }

    /// The instances in the state of the POU in a slot.
    fn own_instances(&mut self, slot: usize) -> Vec<Rc<Variable<'s>>> {
        let Some(signature) = self.decl.signature(slot) else { return Vec::new() };
        let mut found: Vec<_> =
            signature.scope.variables.iter().filter(|it| is_held(it, Root::Instance)).cloned().collect();
        let routines = (slot + 1..self.decl.pous.len()).take_while(|it| self.decl.pous[*it].owner == Some(slot));
        for routine in routines.collect::<Vec<_>>() {
            let Some(signature) = self.decl.signature(routine) else { continue };
            if self.decl.pous[routine].ast.kind != PouKind::Action {
                found.extend(signature.scope.variables.iter().filter(|it| is_held(it, Root::Instance)).cloned());
            }
        }
        found.sort_by_key(|it| it.place.projections.first().and_then(field));
        found.dedup_by_key(|it| it.place.projections.first().and_then(field));
        found
    }

    /// Those among the globals: declared ones, PROGRAMs that are named, and VAR_STAT.
    fn global_instances(&mut self) -> Vec<Rc<Variable<'s>>> {
        let known = self.decl.globals.iter().filter_map(|it| match &it.slot {
            Slot::Done(variable) => Some(Rc::clone(variable)),
            Slot::Open | Slot::Failed => None,
        });
        let mut found: Vec<_> = known.collect();
        found.extend(self.decl.named_programs.values().map(|it| Rc::clone(&it.variable)));
        for slot in 0..self.decl.written_pous().len() {
            let Some(signature) = self.decl.signature(slot) else { continue };
            let is_static = |it: &&Rc<Variable<'s>>| is_held(it, Root::Globals) && it.section == Section::Internal;
            found.extend(signature.scope.variables.iter().filter(is_static).cloned());
        }
        let mut seen = rustc_hash::FxHashSet::default();
        found.retain(|it| seen.insert(it.place.projections.first().and_then(field)));
        found
    }

    fn start_globals(&mut self, span: Span) {
        let is_it = |pou: &crate::types::declarations::PouSlot<'s>| {
            pou.ast.kind == PouKind::Function && pou.ast.name.text == GLOBALS
        };
        let Some(slot) = self.decl.pous.iter().position(is_it) else { return };
        let callee = RoutineId::next(slot);
        self.push(StatementKind::Call { callee, instance: None, arguments: Vec::new(), result: None }, span);
    }

    fn start_variable(&mut self, variable: &Variable<'s>) {
        if !self.decl.is_started(variable.place.ty) {
            return;
        }
        if variable.constant && !matches!(variable.section, Section::Input | Section::InOut) {
            let name = variable.name;
            return self.report(
                Diagnostic::new(Code::E0403, name.span, format!("`{}` is CONSTANT but has FB_init", name.text))
                    .label("FB_init writes to it")
                    .help("declare it without CONSTANT"),
            );
        }
        if variable.retain && self.decl.holds_addresses(variable.place.ty) {
            let name = variable.name;
            return self.report(
                Diagnostic::new(
                    Code::E0902,
                    name.span,
                    format!("`{}` is RETAIN, and its type has an address as an initial value", name.text),
                )
                .label("a restart keeps the variable, but its references become null")
                .help("declare it without RETAIN, or assign the address in the body"),
            );
        }
        let (span, value) = (variable.name.span, variable.resolved.initial.clone());
        // Globals whose addresses overlap others have moved them; an instance shares no bits itself.
        let (place, _) = self.decl.image.stored(&variable.place);
        self.start_declared(place, variable.declared, value, span);
    }

    /// Starts what `__NEW` has made, with the arguments for its FB_init.
    pub(super) fn start_made(&mut self, place: Place, arguments: &[ast::Argument<'s>], span: Span) {
        let value = self.decl.start_of(place.ty);
        self.start_place(place, &Given { arguments, lists: None, initial: None, value, span });
    }

    /// Calls the METHODs FB_exit of an instance that `__DELETE` is given, an heir's before its base's.
    pub(super) fn exit(&mut self, class: usize, place: &Place, span: Span) {
        for method in self.decl.system_methods(class, EXIT).into_iter().rev() {
            let given = Given { arguments: &[], lists: None, initial: None, value: Const::Zero, span };
            let arguments = self.arguments_of(method, &given);
            if self.may_be_called_by_delete(method, arguments.len()) {
                self.call_system(method, place.clone(), &arguments, span);
            }
        }
    }

    /// Reports an FB_exit with inputs that the system does not give.
    fn may_be_called_by_delete(&mut self, method: usize, given: usize) -> bool {
        let signature = self.decl.signature(method);
        let other = signature.filter(|it| it.formals.len() > given).and_then(|it| {
            let is_given = |name: &str| OF_THE_SYSTEM.iter().any(|it| Key(it) == Key(name));
            it.formals.iter().map(|it| it.name).find(|it| !is_given(it.text))
        });
        let Some(other) = other else { return true };
        self.report(
            Diagnostic::new(Code::E0403, other.span, "FB_exit has one input, `bInCopyCode`")
                .label(format!("`__DELETE` does not pass `{}`", other.text))
                .help("declare `VAR_INPUT bInCopyCode : BOOL; END_VAR` in it, and nothing else"),
        );
        false
    }

    /// Starts what a declaration declares.
    fn start_declared(&mut self, place: Place, declared: Option<&'s ast::VarDecl<'s>>, value: Const, span: Span) {
        let construction = declared.and_then(|it| it.construction.as_deref());
        if construction.is_some_and(|it| it.is_of_elements) && !matches!(place.ty, Type::Array(_)) {
            // Lists for elements that there are not have been reported.
            return;
        }
        let arguments = construction.filter(|it| !it.is_of_elements).and_then(|it| it.lists.first());
        let given = Given {
            arguments: arguments.map_or(&[], Vec::as_slice),
            lists: construction.filter(|it| it.is_of_elements),
            initial: declared.and_then(|it| it.initial.as_ref()),
            value,
            span: construction.map_or(span, |it| it.span),
        };
        self.start_place(place, &given);
    }

    fn start_place(&mut self, place: Place, given: &Given<'_, 's>) {
        if !self.decl.is_started(place.ty) {
            return;
        }
        match place.ty {
            Type::Struct(id) => match self.decl.slot_of_instance(id) {
                Some(class) => self.start_instance(place, id, class, given),
                None => self.start_structure(place, id, given),
            },
            Type::Array(_) => self.start_elements(place, given),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Reference(_)
            | Type::Block(_) => {}
        }
    }

    fn start_instance(&mut self, place: Place, id: StructId, class: usize, given: &Given<'_, 's>) {
        let initial = self.decl.initial_methods(class);
        let mut values = Vec::new();
        if let Some(written) = given.initial {
            // FB_init sees what the class itself says.
            let default = self.decl.start_of(place.ty);
            let is_written = !initial.is_empty() || self.decl.assigns_at_start(class);
            self.values_given((place.clone(), is_written), written, (&default, &given.value), &mut values);
        }
        for Assigned { place, default, .. } in &values {
            self.assign_constant(place, default, given.span);
        }
        if self.decl.pous[class].ast.kind == PouKind::Program || self.decl.has_started_parts(id) {
            self.call_start(class, place.clone(), given.span);
        }
        if self.is_too_many(class, initial.last().copied(), given.arguments) {
            return;
        }
        let named = self.by_name(initial.last().copied(), given.arguments);
        let given = &Given { arguments: &named, ..given.clone() };
        for method in initial {
            let arguments = self.arguments_of(method, given);
            self.call_system(method, place.clone(), &arguments, given.span);
        }
        for Assigned { place, value, .. } in &values {
            self.assign_constant(place, value, given.span);
        }
        for method in self.decl.methods_after(class) {
            // Another one has been reported.
            if self.decl.signature(method).is_some_and(|it| !it.formals.is_empty()) {
                continue;
            }
            self.call_system(method, place.clone(), &[], given.span);
        }
    }

    /// Calls the METHOD that starts what is in an instance.
    fn call_start(&mut self, class: usize, place: Place, span: Span) {
        let start = self.decl.pous[class].routines.get(&Key(START)).and_then(|it| it.called);
        let Some((slot, _)) = start else { return };
        let callee = RoutineId::next(slot);
        self.push(StatementKind::Call { callee, instance: Some(place), arguments: Vec::new(), result: None }, span);
    }

    fn call_system(&mut self, slot: usize, place: Place, arguments: &[ast::Argument<'s>], span: Span) {
        let name = ast::Name { text: self.decl.pous[slot].ast.name.text, span };
        let called = Called { slot, name, expected: None, span };
        self.user_function(called, Some((place, span)), arguments);
    }

    /// What an FB_init is given by declarations, and not by the system.
    fn names_of_own(&mut self, method: Option<usize>) -> Vec<&'s str> {
        let Some(signature) = method.and_then(|it| self.decl.signature(it)) else { return Vec::new() };
        let is_own = |name: &&str| !OF_THE_SYSTEM.iter().any(|it| Key(it) == Key(name));
        signature.formals.iter().map(|it| it.name.text).filter(is_own).collect()
    }

    /// Reports the first argument by position that FB_init does not have.
    fn is_too_many(&mut self, class: usize, last: Option<usize>, arguments: &[ast::Argument<'s>]) -> bool {
        // Of what was refused it is not known what it takes.
        let signature = last.and_then(|it| self.decl.signature(it));
        if signature.is_none_or(|it| it.scope.has_refused()) || self.decl.has_unknown_base(class) {
            return false;
        }
        let names = self.names_of_own(last);
        let mut positional = arguments.iter().filter(|it| matches!(it.kind, ArgumentKind::Positional(_)));
        let Some(first) = positional.nth(names.len()) else { return false };
        let (class, count) = (self.decl.pous[class].ast.name.text, names.len());
        let plural = if count == 1 { "" } else { "s" };
        let error =
            Diagnostic::new(Code::E0302, first.span, format!("FB_init of `{class}` takes {count} argument{plural}"));
        let error = error.label("one too many").in_this_dialect();
        self.report(match names.is_empty() {
            true => error,
            false => error.note(format!("written here: {}", names.join(", "))),
        });
        true
    }

    /// Arguments by position are those of the last FB_init: a base's takes what it has by the same name.
    fn by_name(&mut self, last: Option<usize>, arguments: &[ast::Argument<'s>]) -> Vec<ast::Argument<'s>> {
        let names = self.names_of_own(last);
        let named = |(at, argument): (usize, &ast::Argument<'s>)| match (&argument.kind, names.get(at)) {
            (ArgumentKind::Positional(value), Some(text)) => {
                let name = ast::Name { text, span: argument.span };
                ast::Argument { kind: ArgumentKind::Input(name, value.clone()), span: argument.span }
            }
            _ => argument.clone(),
        };
        arguments.iter().enumerate().map(named).collect()
    }

    /// What FB_init is given: of what the declaration writes, a base's takes what it knows.
    fn arguments_of(&mut self, method: usize, given: &Given<'_, 's>) -> Vec<ast::Argument<'s>> {
        let Some(signature) = self.decl.signature(method) else { return Vec::new() };
        let has = |name: &str| signature.formals.iter().any(|it| Key(it.name.text) == Key(name));
        let span = given.span;
        let told = self.scope_has_retains(span);
        let values = [told, literal(LiteralValue::Bool(false), span)];
        let of_system = OF_THE_SYSTEM.into_iter().zip(values).filter(|(name, _)| has(name));
        let mut arguments: Vec<_> = of_system
            .map(|(text, value)| ast::Argument { kind: ArgumentKind::Input(ast::Name { text, span }, value), span })
            .collect();
        let is_base = self.decl.pous[method].ast.is_hidden;
        for argument in given.arguments {
            let is_known = match &argument.kind {
                ArgumentKind::Positional(_) => false,
                ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. } => has(name.text),
            };
            if is_known || !is_base {
                arguments.push(argument.clone());
            }
        }
        arguments
    }

    /// What `bInitRetains` is: whether what is retained has its initial values.
    fn scope_has_retains(&mut self, span: Span) -> ast::Expr<'s> {
        let is_it = |it: &crate::types::declarations::GlobalSlot<'s>| it.name.text == RETAINS;
        match self.decl.globals.iter().any(is_it) {
            true => named(RETAINS, span),
            false => literal(LiteralValue::Bool(true), span),
        }
    }

    /// What the members' declarations say is in the words of the TYPE, which sees nothing of the POU around.
    fn start_structure(&mut self, place: Place, id: StructId, given: &Given<'_, 's>) {
        let own = std::mem::take(&mut self.scope);
        let outer = self.this_structure.replace(place.clone());
        self.start_members_of(place, id, given);
        (self.scope, self.this_structure) = (own, outer);
    }

    fn start_members_of(&mut self, place: Place, id: StructId, given: &Given<'_, 's>) {
        let fields = self.decl.program.structure(id).fields.clone();
        for (at, field) in fields.into_iter().enumerate() {
            let member = place.clone().field(FieldId::next(at), field.ty);
            let declared = self.decl.declaration_of(&field).map(|it| it.1);
            let initial = given.initial.and_then(|it| member_of(it, &field.name));
            if let (Some(address), None) = (declared.and_then(|it| it.started.as_ref()), initial) {
                self.assign_address(member.clone(), address);
            }
            if !self.decl.is_started(field.ty) {
                continue;
            }
            let value = given.value.part(at);
            match initial {
                Some(initial) => {
                    let construction = declared.and_then(|it| it.construction.as_deref());
                    let list = construction.filter(|it| !it.is_of_elements).and_then(|it| it.lists.first());
                    let lists = construction.filter(|it| it.is_of_elements);
                    let arguments = list.map_or(&[][..], Vec::as_slice);
                    let initial = Some(initial);
                    self.start_place(member, &Given { arguments, lists, initial, value, span: given.span });
                }
                None => self.start_declared(member, declared, value, given.span),
            }
        }
    }

    /// Assigns a member the address that its TYPE says.
    fn assign_address(&mut self, member: Place, address: &ast::Initial<'s>) {
        let ty = member.ty;
        let value = match &address.kind {
            InitialKind::Value(value) => self.value(value, ty),
            InitialKind::Bind(value) => match self.bound_value(value, ty) {
                Some(value) => value,
                None => self.value(value, ty),
            },
            InitialKind::Elements(_) | InitialKind::Fields(_) | InitialKind::Indexed(_) | InitialKind::Members(_) => {
                None
            }
        };
        if let Some(value) = value {
            self.assign(member, value, address.span);
        }
    }

    /// Elements that are given something are started one by one, others in a loop.
    fn start_elements(&mut self, place: Place, given: &Given<'_, 's>) {
        let mut shape = Vec::new();
        let mut ty = place.ty;
        while let Type::Array(id) = ty {
            let array = self.decl.program.array(id);
            shape.push((array.low, array.high, array.element));
            ty = array.element;
        }
        let at = self.at(given.span);
        if given.lists.is_none() && given.initial.is_none() && is_uniform(&given.value, shape.len()) {
            let nested = Given { lists: None, initial: None, ..given.clone() };
            return self.start_in_loops(place, &shape, &nested);
        }
        let total: i64 = shape.iter().map(|(low, high, _)| high - low + 1).product();
        if let Some(lists) = given.lists.filter(|it| i64::try_from(it.lists.len()).ok() != Some(total)) {
            let count = lists.lists.len();
            self.report(
                Diagnostic::new(Code::E0206, lists.span, format!("{count} lists of arguments for {total} elements"))
                    .label("FB_init of each element needs its own list"),
            );
            return;
        }
        let mut written = Vec::new();
        if let Some(initial) = given.initial {
            self.written_elements(initial, usize::try_from(total).unwrap_or(usize::MAX), &mut written);
        }
        for number in 0..total {
            let (mut element, mut rest, mut stride) = (place.clone(), number, total);
            let mut value = given.value.clone();
            for (low, high, ty) in &shape {
                stride /= high - low + 1;
                let index = rest / stride;
                rest %= stride;
                let position = usize::try_from(index).unwrap_or_default();
                value = value.part(position);
                let lint = Expr::constant(Elementary::Lint, Value::I64(low + index), at);
                element = element.index(lint, *ty, at);
            }
            let position = usize::try_from(number).unwrap_or_default();
            let list = given.lists.and_then(|it| it.lists.get(position));
            let arguments = list.map_or(given.arguments, Vec::as_slice);
            let initial = written.get(position).copied().flatten();
            let span = list.and_then(|it| it.first()).map_or(given.span, |it| it.span);
            self.start_place(element, &Given { arguments, lists: None, initial, value, span });
        }
    }

    fn start_in_loops(&mut self, place: Place, shape: &[(i64, i64, Type)], given: &Given<'_, 's>) {
        let Some(((low, high, element), inner)) = shape.split_first() else { return self.start_place(place, given) };
        let at = self.at(given.span);
        let counter = LocalId::next(self.locals.len());
        self.locals.push(Local { name: "element".to_owned(), ty: Type::LINT, initial: Const::Zero, doc: None });
        let counter = Place::local(counter, Type::LINT);
        let one = place.index(Expr::load(counter.clone(), at), *element, at);
        let alike = Given { value: given.value.part(0), ..given.clone() };
        let body = self.nested(|this| this.start_in_loops(one, inner, &alike));
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        self.block.push(For::over(counter, lint(*low), lint(*high), body, at));
    }

    /// The initial values of an array's elements, and of those of arrays in it, in one row; `4()` has none.
    fn written_elements<'a>(
        &mut self,
        initial: &'a ast::Initial<'s>,
        most: usize,
        found: &mut Vec<Option<&'a ast::Initial<'s>>>,
    ) {
        let InitialKind::Elements(elements) = &initial.kind else { return found.push(Some(initial)) };
        let scope = Rc::clone(&self.scope);
        for element in elements {
            let count = element.count.as_ref().map_or(Some(1), |it| self.decl.constant_integer(it, &scope));
            for _ in 0..count.unwrap_or(0) {
                if found.len() >= most {
                    return;
                }
                if element.values.is_empty() {
                    found.push(None);
                }
                element.values.iter().for_each(|it| self.written_elements(it, most, found));
            }
        }
    }

    /// The variables of an instance that its declaration gives values, and that an FB_init may write: its own, or that of
    /// an instance inside.
    fn values_given(
        &mut self,
        (place, is_written): (Place, bool),
        written: &ast::Initial<'s>,
        (default, value): (&Const, &Const),
        found: &mut Vec<Assigned>,
    ) {
        if let (InitialKind::Fields(fields), Type::Struct(id)) = (&written.kind, place.ty) {
            for (name, written) in fields {
                let Some(field) = self.decl.field_named(id, name.text) else { continue };
                let Some(ty) = self.decl.program.member(place.ty, field) else { continue };
                let parts = (&default.part(field.index()), &value.part(field.index()));
                let is_written = is_written || self.decl.is_started(ty);
                self.values_given((place.clone().field(field, ty), is_written), written, parts, found);
            }
            return;
        }
        // An instance is not a value.
        if is_written && self.decl.program.instance_in(place.ty, &|it| self.decl.is_instance(it)).is_none() {
            found.push(Assigned { place, default: default.clone(), value: value.clone() });
        }
    }

    fn assign_constant(&mut self, place: &Place, value: &Const, span: Span) {
        let resolved = Resolved { ty: place.ty, initial: value.clone() };
        let value = self.initial_value(&resolved, span);
        self.assign(place.clone(), value, span);
    }
}

/// Whether a variable is storage of its own below a root.
fn is_held(variable: &Variable<'_>, root: Root) -> bool {
    let is_own = matches!(variable.section, Section::Internal | Section::Input | Section::Output | Section::Global);
    is_own && variable.place.root == root
}

fn field(projection: &staunch_ir::Projection) -> Option<FieldId> {
    match projection {
        staunch_ir::Projection::Field(field) => Some(*field),
        staunch_ir::Projection::Index { .. } | staunch_ir::Projection::Deref { .. } => None,
    }
}

/// What an initial value says of a member.
fn member_of<'a, 's>(initial: &'a ast::Initial<'s>, name: &str) -> Option<&'a ast::Initial<'s>> {
    let InitialKind::Fields(fields) = &initial.kind else { return None };
    fields.iter().find(|(it, _)| Key(it.text) == Key(name)).map(|it| &it.1)
}

/// Whether all elements of an array of so many dimensions have one value.
fn is_uniform(value: &Const, dimensions: usize) -> bool {
    match value {
        Const::Array(runs) if dimensions > 0 => {
            runs.len() <= 1 && runs.iter().all(|(_, element)| is_uniform(element, dimensions - 1))
        }
        Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) | Const::Struct(_) => true,
    }
}
