//! Statements: control flow that leads somewhere, and calls that fit what they call.

use super::Verifier;
use crate::alias::Frame;
use crate::{
    Argument, Arm, Block, ClassKind, Elementary, Expr, ExprKind, ExternalCall, For, Location, Mode, Param, Place,
    Projection, Root, Routine, RoutineId, Statement, StatementKind, Step, Type,
};
use crate::{faults, loops, taking, turns, visit};
use staunch_runtime::BlockInfo;

/// The block that is being checked, and where in it.
#[derive(Clone, Copy)]
pub(super) struct Body<'p> {
    pub(super) routine: &'p Routine,
    id: RoutineId,
    in_loop: bool,
    in_continuing: bool,
}

impl Body<'_> {
    /// A parameter is storage here if it is passed by reference, and passed at all.
    pub(super) fn refers(&self, root: Root) -> bool {
        match root {
            Root::Param(id) => {
                let mode = self.routine.params.get(id.index()).map(|param| param.mode);
                mode == Some(Mode::Reference)
            }
            Root::Instance | Root::Globals | Root::Local(_) => true,
        }
    }
}

impl<'p> Verifier<'p> {
    pub(super) fn bodies(&mut self) {
        self.loopers = taking::loopers(self.program);
        for class in &self.program.classes {
            self.within.clone_from(&class.name);
            let body = self.program.routine(class.body);
            class.variables.iter().for_each(|it| self.variable(body, it));
        }
        for (id, routine) in self.program.routines.iter().enumerate() {
            self.within.clone_from(&routine.name);
            let id = RoutineId::next(id);
            let body = Body { routine, id, in_loop: false, in_continuing: false };
            self.block(&body, &routine.body);
        }
    }

    fn block(&mut self, body: &Body<'p>, block: &Block) {
        for statement in block {
            self.statement(body, statement);
        }
    }

    fn statement(&mut self, body: &Body<'p>, statement: &Statement) {
        let at = statement.at;
        self.location(at);
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                self.writable(body, target, at);
                self.expr_of(body, value, target.ty);
                // An instance with fixed storage that lives for one call starts anew by its initial value.
                if !matches!(value.kind, ExprKind::Aggregate(_)) {
                    self.copied(value.ty, at);
                }
            }
            StatementKind::If { condition, then, otherwise } => {
                self.expr_of(body, condition, Type::BOOL);
                self.block(body, then);
                self.block(body, otherwise);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                self.case(body, selector, arms, at);
                self.block(body, otherwise);
            }
            StatementKind::Loop { body: block, continuing, count } => {
                let frame = Frame::of(self.program, body.routine);
                let is_ahead = count.as_ref().is_some_and(|it| it.taking.is_ahead());
                let ends = is_ahead || block.iter().any(is_turn) || turns::divides(&frame, block, continuing);
                self.require(ends, at, "a loop that takes no turns");
                if let Some(count) = count {
                    self.count(body, block, continuing, count, at);
                }
                let inside = Body { in_loop: true, in_continuing: false, ..*body };
                self.block(&inside, block);
                self.block(&Body { in_continuing: true, ..inside }, continuing);
            }
            StatementKind::For(it) => self.for_loop(body, it, at),
            StatementKind::Try { body: block, kind, handler } => {
                self.writable(body, kind, at);
                let local = matches!(kind.root, Root::Local(_)) && kind.projections.is_empty();
                self.require(
                    local && kind.ty == Type::Elementary(Elementary::Usint),
                    at,
                    "the kind of a fault that goes to no local USINT",
                );
                self.block(body, block);
                self.block(body, handler);
            }
            StatementKind::Finally { body: block, last } => self.finally(body, block, last, at),
            StatementKind::Exit => {
                self.require(body.in_loop, at, "EXIT outside of a loop");
            }
            StatementKind::Continue => {
                let holds = body.in_loop && !body.in_continuing;
                self.require(holds, at, "CONTINUE outside of a loop's body");
            }
            StatementKind::Stop(it) => {
                it.asked.iter().for_each(|it| match it.is_condition {
                    true => self.expr_of(body, &it.value, Type::BOOL),
                    false => self.expr(body, &it.value),
                });
                self.require(it.declared <= body.routine.locals.len(), at, "a stop with more locals than there are");
            }
            StatementKind::Return | StatementKind::Turn | StatementKind::Fault(_) => {}
            StatementKind::Call { callee, instance, arguments, result } => {
                self.call(body, *callee, instance.as_ref(), arguments, at);
                self.call_result(body, *callee, result.as_ref(), at);
            }
            StatementKind::External(it) => self.external(body, it, at),
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.call_block(body, block, *instruction, inputs, at);
            }
            StatementKind::PrescanBlock { block, instruction } => {
                self.prescan_block(body, block, *instruction, at);
            }
        }
    }

    fn finally(&mut self, body: &Body<'p>, block: &Block, last: &Block, at: Location) {
        let inside = Body { in_loop: false, in_continuing: false, ..*body };
        self.block(&inside, block);
        self.block(&inside, last);
        let mut returns = false;
        visit::statements(block, &mut |it| returns |= matches!(it.kind, StatementKind::Return));
        self.require(!returns, at, "RETURN where something is left to do");
        let faults = |it: &Projection| faults::projection_faults(self.program, it);
        let is_plain = last.iter().all(|it| match &it.kind {
            StatementKind::Assign { target, value } => {
                !target.projections.iter().any(faults) && !faults::expr_faults(self.program, value)
            }
            _ => false,
        });
        self.require(is_plain, at, "what may fault where something is left to do");
    }

    fn for_loop(&mut self, body: &Body<'p>, it: &For, at: Location) {
        let ty = it.counter.ty;
        self.writable(body, &it.counter, at);
        self.require(!it.counter.is_followed(), at, "a counter reached through a reference");
        self.expr_of(body, &it.first, ty);
        let number = self.program.counted(ty);
        self.expr_of(body, &it.last, number);
        self.location(it.step_at);
        let repr = self.repr(ty).filter(|repr| repr.is_integer());
        let Some((min, max)) = repr.and_then(|repr| repr.range()) else {
            return self.report(at, "a counter that is not an integer");
        };
        let range = self.program.range(ty).unwrap_or((min, max));
        self.require(it.range == range, at, "a counter's range that is not of its type");
        match &it.step {
            Step::Constant(step) => {
                self.require(
                    *step != 0 && step.abs() <= max,
                    at,
                    "a step that is 0, or greater than the counter's type",
                );
            }
            Step::Variable(step) => self.expr_of(body, step, number),
        }
        let frame = Frame::of(self.program, body.routine);
        let private = !it.is_private || loops::is_private(&frame, &it.counter, &it.body);
        self.require(private, at, "a counter that others write is called private");
        self.require(it.is_short() || it.takes_turns(), at, "a loop that takes no turns");
        self.taking(it.taking, it.is_private, &[], &it.body, at);
        self.block(&Body { in_loop: true, in_continuing: false, ..*body }, &it.body);
    }

    fn case(&mut self, body: &Body<'p>, selector: &Expr, arms: &[Arm], at: Location) {
        self.expr(body, selector);
        let repr = self.repr(selector.ty);
        let range = repr.filter(|repr| repr.is_integer()).and_then(|repr| repr.range());
        let Some((min, max)) = range else {
            return self.report(selector.at, "a selector that is not an integer");
        };
        let mut labels: Vec<_> = arms.iter().flat_map(|arm| arm.labels.iter().copied()).collect();
        let fit = labels.iter().all(|(low, high)| min <= *low && low <= high && *high <= max);
        self.require(fit, at, "a label outside the selector's type");
        labels.sort_unstable();
        let disjoint = labels.windows(2).all(|pair| pair[0].1 < pair[1].0);
        self.require(disjoint, at, "labels that overlap");
        for arm in arms {
            self.block(body, &arm.body);
        }
    }

    /// The callee, if it may be called here with this instance.
    fn callee(
        &mut self,
        body: &Body<'p>,
        callee: RoutineId,
        instance: Option<&Place>,
        at: Location,
    ) -> Option<&'p Routine> {
        let before = self.require(callee < body.id, at, "a callee that is not before its caller");
        let routine = before.then(|| self.program.routine(callee))?;
        let fits = instance.map(|it| it.ty) == routine.state.map(Type::Struct);
        let is_program = self.program.classes.iter().any(|it| it.kind == ClassKind::Program && it.body == callee);
        self.require(!is_program, at, "a PROGRAM is called");
        self.require(fits, at, format_args!("{} is not called on what it wants", routine.name)).then_some(routine)
    }

    fn call(
        &mut self,
        body: &Body<'p>,
        callee: RoutineId,
        instance: Option<&Place>,
        arguments: &[Argument],
        at: Location,
    ) {
        let Some(routine) = self.callee(body, callee, instance, at) else { return };
        if let Some(instance) = instance {
            self.writable(body, instance, at);
        }
        self.require(arguments.len() == routine.params.len(), at, format_args!("{}: argument count", routine.name));
        for (param, argument) in routine.params.iter().zip(arguments) {
            self.argument(body, param, argument, at);
        }
    }

    fn argument(&mut self, body: &Body<'p>, param: &Param, argument: &Argument, at: Location) {
        match (param.mode, argument) {
            (Mode::Value(_), Argument::Value(value)) => {
                self.expr_of(body, value, param.ty);
                self.copied(value.ty, at);
            }
            (Mode::Reference, Argument::Reference(place)) => {
                self.writable(body, place, at);
                self.require(place.ty == param.ty, at, format_args!("{}: a place of another type", param.name));
            }
            (Mode::Value(_), Argument::Reference(_)) | (Mode::Reference, Argument::Value(_)) => {
                self.report(at, format_args!("{}: passed the wrong way", param.name));
            }
        }
    }

    /// What is passed is of the declared types, and no two of it share storage: all but a single reference are the
    /// instance and locals.
    fn external(&mut self, body: &Body<'p>, it: &ExternalCall, at: Location) {
        let external = &it.external;
        self.location(external.location);
        if let Some(instance) = &it.instance {
            self.writable(body, instance, at);
        }
        let state = it.instance.as_ref().map(|it| it.ty);
        self.require(state == external.state.map(Type::Struct), at, "an external block without its instance");
        let mut references = usize::from(it.instance.is_some());
        self.require(it.arguments.len() == external.params.len(), at, "an external's argument count");
        for (param, argument) in external.params.iter().zip(&it.arguments) {
            match argument {
                Argument::Value(value) => self.expr_of(body, value, param.ty),
                Argument::Reference(place) => {
                    self.writable(body, place, at);
                    references += usize::from(!matches!(place.root, Root::Local(_)));
                }
            }
            let ty = argument.value().map(|it| it.ty).or(argument.place().map(|it| it.ty));
            let fits = ty == Some(param.ty) && argument.place().is_some() == param.by_reference;
            self.require(fits, at, format_args!("{}: passed the wrong way", param.name));
        }
        self.require(references < 2, at, "what an external is passed may share storage");
        if let Some(target) = &it.result {
            self.place(body, target, at);
        }
        let result = it.result.as_ref().map(|it| it.ty);
        self.require(result == external.result, at, "an external's result of another type");
    }

    /// An instance is copied where the program says that it does so.
    fn copied(&mut self, ty: Type, at: Location) {
        let program = self.program;
        let holds_state = program.instance_in(ty, &|id| program.class_of_state(id).is_some()).is_some();
        self.require(
            program.reach.copies || !holds_state,
            at,
            "a copy of an instance that bodies were checked without",
        );
    }

    /// A result goes to a local as a whole.
    fn call_result(&mut self, body: &Body<'p>, callee: RoutineId, result: Option<&Place>, at: Location) {
        let Some(target) = result else { return };
        self.place(body, target, at);
        let local = matches!(target.root, Root::Local(_)) && target.projections.is_empty();
        self.require(local, at, "a result that does not go to a local");
        let routine = self.program.routines.get(callee.index());
        let ty = routine.and_then(|routine| Some(routine.locals.get(routine.result?.index())?.ty));
        self.require(ty == Some(target.ty), at, "a result of another type");
    }

    fn block_info(&mut self, place: &Place, at: Location) -> Option<&'static BlockInfo> {
        match place.ty {
            Type::Block(id) => Some(id.info()),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_) => {
                self.report(at, "not a standard block");
                None
            }
        }
    }

    fn call_block(&mut self, body: &Body<'p>, block: &Place, instruction: usize, inputs: &[Expr], at: Location) {
        let before = self.violations.len();
        self.writable(body, block, at);
        inputs.iter().for_each(|input| self.expr(body, input));
        if self.violations.len() > before {
            return;
        }
        let Some(info) = self.block_info(block, at) else { return };
        let Some(instruction) = info.instructions.get(instruction) else {
            return self.report(at, format_args!("{} has no such instruction", info.name));
        };
        let found: Vec<_> = inputs.iter().map(|input| Self::elementary_repr(input.ty)).collect();
        let wanted: Vec<_> = if instruction.takes_rung {
            vec![Some(crate::Repr::Bool)]
        } else {
            info.inputs().map(|pin| Some(pin.repr())).collect()
        };
        self.require(found == wanted, at, format_args!("{}: inputs in {found:?}", info.name));
    }

    fn prescan_block(&mut self, body: &Body<'p>, block: &Place, instruction: usize, at: Location) {
        let before = self.violations.len();
        self.writable(body, block, at);
        if self.violations.len() > before {
            return;
        }
        let Some(info) = self.block_info(block, at) else { return };
        let prescan = info.instructions.get(instruction).and_then(|it| it.prescan);
        self.require(prescan.is_some(), at, format_args!("{} has no such prescan", info.name));
    }
}

pub(super) fn is_turn(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::Turn)
}
