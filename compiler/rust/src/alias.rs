//! Makes shared storage something Rust can say: after this pass no call hands out two paths to
//! one variable. A call that would do so goes to a copy of its callee, in which the parameters
//! that overlap are places below one root (the instance, or one shared parameter); array subscripts on
//! the way are checked at the call and arrive by value.
//!
//! A callee that uses globals is passed all of them, unless its other arguments are in them:
//! then it gets those that it uses one by one, each a parameter of its own. That form of it serves
//! all such calls, and where there is one the declared form calls it, so that its code exists once.
//!
//! Both programs mean the same: the result is IR, and verifies and interprets like its source.

mod call;
mod hoist;
mod key;
mod naming;
mod overlap;
mod rewrite;

use std::collections::{HashMap, HashSet};

use staunch_ir::effects::{Effects, Rules, effects};
use staunch_ir::stop::{Asked, Stop};
use staunch_ir::{
    Argument, Block, Count, Expr, ExternalCall, FieldId, For, Mode, Param, ParamId, Place, Program, Projection, Root,
    Routine, RoutineId, RoutineKind, Statement, StatementKind, Type,
};

use call::Call;
use key::{Binding, Globals, Key};
use naming::{copy_name, group_name};
use rewrite::Body;

pub use key::{Origin, element};

/// A program without aliases in its calls.
#[derive(Debug)]
pub struct Separated {
    pub program: Program,
    /// For each of its routines.
    pub origins: Vec<Origin>,
}

struct Separator<'p> {
    source: &'p Program,
    effects: Vec<Effects>,
    /// The routines whose declared form calls the one that is handed globals one by one.
    forwarding: HashSet<RoutineId>,
    known: HashMap<Key, RoutineId>,
    routines: Vec<Routine>,
    origins: Vec<Origin>,
}

/// Rewrites every call that Rust's rules on `&mut` would refuse.
pub fn separate(source: &Program) -> Separated {
    if !source.references.is_empty() {
        // All of its storage is shared, in cells.
        return Separated { program: source.clone(), origins: vec![Origin::Declared; source.routines.len()] };
    }
    let effects = effects(source, &Rules::PLAIN);
    let first = Separator::new(source, effects.clone(), HashSet::new()).separated();
    let forwarding = first.known.into_keys().filter(Key::is_apart).map(|it| it.routine).collect::<HashSet<_>>();
    if forwarding.is_empty() {
        return first.separated;
    }
    Separator::new(source, effects, forwarding).separated().separated
}

/// What a pass over the program made.
struct Pass {
    separated: Separated,
    known: HashMap<Key, RoutineId>,
}

impl<'p> Separator<'p> {
    fn new(source: &'p Program, effects: Vec<Effects>, forwarding: HashSet<RoutineId>) -> Self {
        Self { source, effects, forwarding, known: HashMap::new(), routines: Vec::new(), origins: Vec::new() }
    }

    fn separated(mut self) -> Pass {
        let source = self.source;
        let ids: Vec<RoutineId> = (0..source.routines.len()).map(|at| self.declared(RoutineId::next(at))).collect();
        let mut program = Program { routines: self.routines, ..source.clone() };
        for class in &mut program.classes {
            class.body = ids[class.body.index()];
            class.prescan = class.prescan.map(|it| ids[it.index()]);
            class.start = class.start.map(|it| ids[it.index()]);
        }
        Pass { separated: Separated { program, origins: self.origins }, known: self.known }
    }
}

impl Separator<'_> {
    /// The POU as declared, with its calls rewritten.
    fn declared(&mut self, id: RoutineId) -> RoutineId {
        self.resolve(Key::declared(id, self.source.routine(id).params.len()))
    }

    fn resolve(&mut self, key: Key) -> RoutineId {
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let origin = key.origin();
        let routine = match origin {
            Origin::Declared if self.forwarding.contains(&key.routine) => self.forward(key.routine),
            Origin::Declared => self.rewrite_declared(key.routine),
            Origin::Apart | Origin::Copy => self.copy(&key),
        };
        // Its callees have taken their places meanwhile, so they are before it.
        let id = RoutineId::next(self.routines.len());
        self.routines.push(routine);
        self.origins.push(origin);
        self.known.insert(key, id);
        id
    }

    fn rewrite_declared(&mut self, id: RoutineId) -> Routine {
        let source = self.source.routine(id);
        let mut body = Body::declared(source);
        let rewritten = self.block(&mut body, &source.body);
        Routine { locals: body.locals, body: rewritten, ..source.clone() }
    }

    /// The declared form of a routine that has its code in the form with separate globals.
    fn forward(&mut self, id: RoutineId) -> Routine {
        let source = self.source.routine(id);
        let fields = self.effects[id.index()].names.globals().map(|it| (it, Binding::Own)).collect();
        let declared = Key::declared(id, source.params.len());
        let callee = self.resolve(Key { globals: Globals::Apart(fields), ..declared });
        let handed = source.params.iter().enumerate().map(|(at, param)| match param.mode {
            Mode::Value(local) => Argument::Value(Expr::load(Place::local(local, param.ty), source.location)),
            Mode::Reference => Argument::Reference(Place::root(Root::Param(ParamId::next(at)), param.ty)),
        });
        let globals = self.globals_of(id).into_iter().map(|(_, place)| Argument::Reference(place));
        let kind = StatementKind::Call {
            callee,
            instance: source.state.map(|it| Place::root(Root::Instance, Type::Struct(it))),
            arguments: handed.chain(globals).collect(),
            result: source.result.map(|it| Place::local(it, source.locals[it.index()].ty)),
        };
        Routine { body: vec![Statement::new(kind, source.location)], ..source.clone() }
    }

    /// The variables of the globals that a routine uses.
    fn globals_of(&self, id: RoutineId) -> Vec<(FieldId, Place)> {
        let globals = self.source.globals;
        let place = |field: FieldId| {
            let ty = self.source.structure(globals).fields[field.index()].ty;
            Place::root(Root::Globals, Type::Struct(globals)).field(field, ty)
        };
        self.effects[id.index()].names.globals().map(|it| (it, place(it))).collect()
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
        if let Globals::Apart(bindings) = &key.globals {
            body.globals = Some(HashMap::new());
            bindings.iter().for_each(|(field, binding)| self.bind_global(&mut body, *field, binding));
        }
        let first_group = body.params.len();
        for (number, ty) in key.groups.iter().enumerate() {
            let name = group_name(self.source, source, key, number);
            body.params.push(Param { name, ty: *ty, doc: None, mode: Mode::Reference, bounds: Vec::new() });
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

    fn bind_global(&self, body: &mut Body, field: FieldId, binding: &Binding) {
        let declared = &self.source.structure(self.source.globals).fields[field.index()];
        let (name, ty, doc) = (declared.name.clone(), declared.ty, declared.doc.clone());
        let base = match binding {
            Binding::Own => body.keep(&Param { name, ty, doc, mode: Mode::Reference, bounds: Vec::new() }),
            Binding::Within { .. } => body.bind(binding, &name, declared.location),
        };
        body.globals.get_or_insert_default().insert(field, base);
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
            StatementKind::Loop { body: inner, continuing, count } => {
                let count = count.as_ref().map(|it| {
                    let (counter, bound) = (body.place(&it.counter), body.expr(&it.bound));
                    Box::new(Count { counter, bound, ..**it })
                });
                StatementKind::Loop { body: self.block(body, inner), continuing: self.block(body, continuing), count }
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
            StatementKind::Try { body: inner, kind, handler } => StatementKind::Try {
                body: self.block(body, inner),
                kind: body.place(kind),
                handler: self.block(body, handler),
            },
            StatementKind::Finally { body: inner, last } => {
                StatementKind::Finally { body: self.block(body, inner), last: self.block(body, last) }
            }
            StatementKind::Turn => StatementKind::Turn,
            StatementKind::Call { callee, instance, arguments, result } => {
                let instance = instance.as_ref().map(|it| body.place(it));
                let arguments = arguments.iter().map(|it| body.argument(it)).collect();
                let result = result.as_ref().map(|it| body.place(it));
                let call = Call { callee: *callee, instance, arguments, globals: Vec::new(), result, at };
                return self.call(body, call, out);
            }
            StatementKind::External(it) => StatementKind::External(Box::new(ExternalCall {
                external: it.external.clone(),
                instance: it.instance.as_ref().map(|it| body.place(it)),
                arguments: it.arguments.iter().map(|it| body.argument(it)).collect(),
                result: it.result.as_ref().map(|it| body.place(it)),
            })),
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
            StatementKind::Stop(it) => {
                let asked = |it: &Asked| Asked { value: body.expr(&it.value), ..*it };
                StatementKind::Stop(Box::new(Stop { asked: it.asked.as_ref().map(asked), ..**it }))
            }
            StatementKind::Fault(kind) => StatementKind::Fault(*kind),
        };
        out.push(Statement::new(kind, at));
    }

    /// Emits a call whose places and values are already the caller's.
    fn call(&mut self, body: &mut Body, call: Call, out: &mut Block) {
        let globals: Vec<_> =
            self.globals_of(call.callee).into_iter().map(|(field, place)| (field, body.place(&place))).collect();
        // The globals as a whole would be a second way to the variables in them.
        let in_globals = call.references().iter().any(|it| it.place.root == Root::Globals);
        let apart = !globals.is_empty() && (in_globals || body.globals.is_some());
        let call = Call { globals: if apart { globals } else { Vec::new() }, ..call };
        let ancestors = overlap::ancestors(&call.references());
        let (key, groups) = call.key(self.source.routine(call.callee), &ancestors, body, self.source);
        let callee = self.resolve(key.clone());
        if ancestors.is_empty() {
            return self.plain_call(body, Call { callee, ..call }, out);
        }
        let (instance, arguments) = self.hand_over(body, call.clone(), &key, groups, out);
        let kind = StatementKind::Call { callee, instance, arguments, result: call.result };
        out.push(Statement::new(kind, call.at));
    }

    /// A call with nothing shared. Values that are read from what an earlier argument borrows
    /// are read before the call, and then so is everything that might fault.
    fn plain_call(&mut self, body: &mut Body, mut call: Call, out: &mut Block) {
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
        call.arguments.extend(call.globals.into_iter().map(|(_, place)| Argument::Reference(place)));
        let Call { callee, instance, arguments, result, .. } = call;
        let kind = StatementKind::Call { callee, instance, arguments, result };
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
        if let Globals::Apart(bindings) = &key.globals {
            for ((_, place), (_, binding)) in call.globals.into_iter().zip(bindings) {
                match binding {
                    Binding::Own => arguments.push(Argument::Reference(place)),
                    Binding::Within { .. } => capture(binding, &place, &mut arguments),
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
    let after = &place.projections[place.projections.len() - steps.len()..];
    for projection in after {
        if let Projection::Index { index, .. } = projection {
            arguments.push(Argument::Value(index.as_ref().clone()));
        }
    }
}

#[cfg(test)]
mod tests;
