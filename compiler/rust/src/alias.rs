//! Makes shared storage something Rust can say: after this pass no call hands out two paths to
//! one variable. A call that would do so goes to a copy of its callee, in which the parameters
//! that overlap are places below one root (the globals, the instance, or one shared parameter);
//! array subscripts on the way are checked at the call and arrive by value.
//!
//! Both programs mean the same: the result is IR, and verifies and interprets like its source.

mod call;
mod hoist;
mod naming;
mod overlap;
mod rewrite;

use std::collections::HashMap;

use staunch_ir::effects::{Effects, Rules, effects};
use staunch_ir::{
    Argument, Block, FieldId, For, Mode, Param, Place, Program, Projection, Routine, RoutineId, RoutineKind, Statement,
    StatementKind, Type,
};

use call::Call;
use naming::{copy_name, group_name};
use rewrite::Body;

/// A program without aliases in its calls.
#[derive(Debug)]
pub struct Separated {
    pub program: Program,
    /// For each of its routines.
    pub origins: Vec<Origin>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    Declared,
    /// A copy of a declared POU in which parameters share storage.
    Copy,
}

/// A callee, and what of it shares storage with what.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Key {
    routine: RoutineId,
    /// For the instance, then for each parameter.
    bindings: Vec<Binding>,
    /// The types of the parameters that a copy gets for shared storage.
    groups: Vec<Type>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Binding {
    /// It is handed over as declared.
    Own,
    /// It is part of what the callee reaches anyway.
    Within { root: SharedRoot, steps: Vec<Step> },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum SharedRoot {
    Globals,
    Instance,
    Group(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Step {
    Field(FieldId),
    /// The subscript arrives as a parameter.
    Index,
}

struct Separator<'p> {
    source: &'p Program,
    effects: Vec<Effects>,
    known: HashMap<Key, RoutineId>,
    routines: Vec<Routine>,
    origins: Vec<Origin>,
}

/// Rewrites every call that Rust's rules on `&mut` would refuse.
pub fn separate(source: &Program) -> Separated {
    let effects = effects(source, &Rules::PLAIN);
    let mut separator = Separator { source, effects, known: HashMap::new(), routines: Vec::new(), origins: Vec::new() };
    let ids: Vec<RoutineId> = (0..source.routines.len()).map(|at| separator.declared(RoutineId::next(at))).collect();
    let mut program = Program { routines: separator.routines, ..source.clone() };
    for class in &mut program.classes {
        class.body = ids[class.body.index()];
        class.prescan = class.prescan.map(|it| ids[it.index()]);
    }
    Separated { program, origins: separator.origins }
}

impl Separator<'_> {
    /// The POU as declared, with its calls rewritten.
    fn declared(&mut self, id: RoutineId) -> RoutineId {
        let params = self.source.routine(id).params.len();
        let bindings = vec![Binding::Own; params + 1];
        self.resolve(Key { routine: id, bindings, groups: Vec::new() })
    }

    fn resolve(&mut self, key: Key) -> RoutineId {
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let declared = key.bindings.iter().all(|it| *it == Binding::Own);
        let routine = if declared { self.rewrite_declared(key.routine) } else { self.copy(&key) };
        // Its callees have taken their places meanwhile, so they stand before it.
        let id = RoutineId::next(self.routines.len());
        self.routines.push(routine);
        self.origins.push(if declared { Origin::Declared } else { Origin::Copy });
        self.known.insert(key, id);
        id
    }

    fn rewrite_declared(&mut self, id: RoutineId) -> Routine {
        let source = self.source.routine(id);
        let mut body = Body::declared(source);
        let rewritten = self.block(&mut body, &source.body);
        Routine { locals: body.locals, body: rewritten, ..source.clone() }
    }

    fn copy(&mut self, key: &Key) -> Routine {
        let source = self.source.routine(key.routine);
        let mut body = Body { params: Vec::new(), ..Body::declared(source) };
        body.instance = body.bind(&key.bindings[0], "instance", source.location);
        body.bases = Vec::new();
        for (param, binding) in source.params.iter().zip(&key.bindings[1..]) {
            let base = match binding {
                Binding::Own => body.keep(param),
                Binding::Within { .. } => body.bind(binding, &param.name, source.location),
            };
            body.bases.push(base);
        }
        let first_group = body.params.len();
        for (number, ty) in key.groups.iter().enumerate() {
            let name = group_name(source, key, number);
            body.params.push(Param { name, ty: *ty, doc: None, mode: Mode::Reference });
        }
        body.place_groups(first_group);
        let statements = self.block(&mut body, &source.body);
        let detached = key.bindings[0] != Binding::Own;
        Routine {
            kind: if detached { RoutineKind::Function } else { source.kind },
            name: copy_name(self.source, source, key),
            doc: source.doc.clone(),
            location: source.location,
            state: source.state.filter(|_| !detached),
            params: body.params,
            locals: body.locals,
            result: source.result,
            body: statements,
        }
    }

    fn block(&mut self, body: &mut Body, block: &Block) -> Block {
        let mut rewritten = Block::with_capacity(block.len());
        for statement in block {
            self.statement(body, statement, &mut rewritten);
        }
        rewritten
    }

    fn statement(&mut self, body: &mut Body, statement: &Statement, out: &mut Block) {
        let at = statement.at;
        let kind = match &statement.kind {
            StatementKind::Assign { target, value } => {
                StatementKind::Assign { target: body.place(target), value: body.expr(value) }
            }
            StatementKind::If { condition, then, otherwise } => StatementKind::If {
                condition: body.expr(condition),
                then: self.block(body, then),
                otherwise: self.block(body, otherwise),
            },
            StatementKind::Case { selector, arms, otherwise } => StatementKind::Case {
                selector: body.expr(selector),
                arms: arms
                    .iter()
                    .map(|arm| staunch_ir::Arm { labels: arm.labels.clone(), body: self.block(body, &arm.body) })
                    .collect(),
                otherwise: self.block(body, otherwise),
            },
            StatementKind::Loop { body: inner, continuing } => {
                StatementKind::Loop { body: self.block(body, inner), continuing: self.block(body, continuing) }
            }
            StatementKind::For(it) => StatementKind::For(Box::new(For {
                counter: body.place(&it.counter),
                first: body.expr(&it.first),
                last: body.expr(&it.last),
                step: match &it.step {
                    staunch_ir::Step::Constant(step) => staunch_ir::Step::Constant(*step),
                    staunch_ir::Step::Variable(step) => staunch_ir::Step::Variable(body.expr(step)),
                },
                body: self.block(body, &it.body),
                ..(**it).clone()
            })),
            StatementKind::Turn => StatementKind::Turn,
            StatementKind::Call { callee, instance, arguments, result } => {
                let instance = instance.as_ref().map(|it| body.place(it));
                let arguments = arguments.iter().map(|it| body.argument(it)).collect();
                let result = result.as_ref().map(|it| body.place(it));
                let call = Call { callee: *callee, instance, arguments, result, at };
                return self.call(body, call, out);
            }
            StatementKind::CallBlock { block, instruction, inputs } => StatementKind::CallBlock {
                block: body.place(block),
                instruction: *instruction,
                inputs: inputs.iter().map(|it| body.expr(it)).collect(),
            },
            StatementKind::PrescanBlock { block, instruction } => {
                StatementKind::PrescanBlock { block: body.place(block), instruction: *instruction }
            }
            StatementKind::Exit => StatementKind::Exit,
            StatementKind::Continue => StatementKind::Continue,
            StatementKind::Return => StatementKind::Return,
            StatementKind::Fault(kind) => StatementKind::Fault(*kind),
        };
        out.push(Statement::new(kind, at));
    }

    /// Emits a call whose places and values are already the caller's.
    fn call(&mut self, body: &mut Body, call: Call, out: &mut Block) {
        let uses_globals = self.effects[call.callee.index()].uses_globals();
        let ancestors = overlap::ancestors(&call.references(), uses_globals);
        if ancestors.is_empty() {
            return self.plain_call(body, call, out);
        }
        let (key, groups) = call.key(self.source.routine(call.callee), &ancestors, body, self.source);
        let callee = self.resolve(key.clone());
        let (instance, arguments) = self.hand_over(body, call.clone(), &key, groups, out);
        let kind = StatementKind::Call { callee, instance, arguments, result: call.result };
        out.push(Statement::new(kind, call.at));
    }

    /// A call with nothing shared. Values that are read from what an earlier argument borrows
    /// are read before the call, and then so is everything that might fault.
    fn plain_call(&mut self, body: &mut Body, mut call: Call, out: &mut Block) {
        let callee = self.declared(call.callee);
        if call.reads_borrowed() {
            let mut arguments = Vec::with_capacity(call.arguments.len());
            call.instance = call.instance.map(|place| self.fix_place(body, place, out));
            for argument in call.arguments {
                arguments.push(match argument {
                    Argument::Value(value) => Argument::Value(body.fix_value(value, out)),
                    Argument::Reference(place) => Argument::Reference(self.fix_place(body, place, out)),
                });
            }
            call.arguments = arguments;
        }
        let kind =
            StatementKind::Call { callee, instance: call.instance, arguments: call.arguments, result: call.result };
        out.push(Statement::new(kind, call.at));
    }

    /// The arguments for a copy, everything that might fault evaluated in order before the call.
    fn hand_over(
        &mut self,
        body: &mut Body,
        call: Call,
        key: &Key,
        groups: Vec<Place>,
        out: &mut Block,
    ) -> (Option<Place>, Vec<Argument>) {
        let mut arguments = Vec::new();
        let instance = call.instance.map(|place| self.fix_place(body, place, out));
        let own_instance = match (&key.bindings[0], instance) {
            (Binding::Own, instance) => instance,
            (binding @ Binding::Within { .. }, Some(place)) => {
                capture(binding, &place, &mut arguments);
                None
            }
            (Binding::Within { .. }, None) => unreachable!("only an instance is bound as one"),
        };
        for (argument, binding) in call.arguments.into_iter().zip(&key.bindings[1..]) {
            match argument {
                Argument::Value(value) => arguments.push(Argument::Value(body.fix_value(value, out))),
                Argument::Reference(place) => {
                    let place = self.fix_place(body, place, out);
                    match binding {
                        Binding::Own => arguments.push(Argument::Reference(place)),
                        Binding::Within { .. } => capture(binding, &place, &mut arguments),
                    }
                }
            }
        }
        arguments.extend(groups.into_iter().map(Argument::Reference));
        (own_instance, arguments)
    }

    /// The place with each subscript evaluated into a local and checked.
    fn fix_place(&mut self, body: &mut Body, place: Place, out: &mut Block) -> Place {
        let mut ty = body.root_type(self.source, place.root);
        let mut projections = Vec::with_capacity(place.projections.len());
        for projection in place.projections {
            let next = element(self.source, ty, &projection);
            projections.push(match (projection, ty) {
                (Projection::Index { index, at }, Type::Array(array)) if index.as_const().is_none() => {
                    let array = self.source.array(array);
                    let index = Box::new(body.fix_index(*index, (array.low, array.high), at, out));
                    Projection::Index { index, at }
                }
                (projection, _) => projection,
            });
            ty = next;
        }
        Place { projections, ..place }
    }
}

/// The subscripts of `place` that the callee gets by value.
fn capture(binding: &Binding, place: &Place, arguments: &mut Vec<Argument>) {
    let Binding::Within { steps, .. } = binding else { return };
    let behind = &place.projections[place.projections.len() - steps.len()..];
    for projection in behind {
        if let Projection::Index { index, .. } = projection {
            arguments.push(Argument::Value(index.as_ref().clone()));
        }
    }
}

/// The type behind a projection.
pub fn element(program: &Program, ty: Type, projection: &Projection) -> Type {
    match (projection, ty) {
        (Projection::Field(field), _) => program.member(ty, *field).expect("verified IR: the member exists"),
        (Projection::Index { .. }, Type::Array(array)) => program.array(array).element,
        (Projection::Index { .. }, _) => unreachable!("verified IR: only arrays have elements"),
    }
}

#[cfg(test)]
mod tests;
