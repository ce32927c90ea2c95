//! What a block of a POU needs and may do, found before any code is made for it: its function
//! takes no more than it needs, and a caller checks only calls that may fault.

use crate::{inline_block, inline_op};
use staunch_ir::loops::{constant_position, is_within};
use staunch_ir::{
    Argument, Expr, ExprKind, For, Place, Pou, PouId, Program, Projection, Root, Statement, StatementKind, Step, Type,
};

#[derive(Clone, Debug, Default)]
pub(crate) struct Facts {
    pub(crate) may_fault: bool,
    pub(crate) uses_context: bool,
    pub(crate) uses_globals: bool,
    /// For each local, whether a call gets a reference to it.
    pub(crate) referred: Vec<bool>,
}

/// The facts of a POU's body and of its prescan.
#[derive(Clone, Debug, Default)]
pub(crate) struct PouFacts {
    pub(crate) body: Facts,
    pub(crate) prescan: Facts,
}

/// The facts of every POU. A callee stands before its callers, so one pass is enough.
pub(crate) fn of_program(program: &Program) -> Vec<PouFacts> {
    let mut known = Vec::with_capacity(program.pous.len());
    for pou in &program.pous {
        let body = of_block(program, &known, pou, &pou.body);
        let prescan = of_block(program, &known, pou, &pou.prescan);
        known.push(PouFacts { body, prescan });
    }
    known
}

fn of_block(program: &Program, known: &[PouFacts], pou: &Pou, block: &[Statement]) -> Facts {
    let facts = Facts { referred: vec![false; pou.locals.len()], ..Facts::default() };
    let mut finder = Finder { program, known, pou, counters: Vec::new(), facts };
    finder.block(block);
    finder.facts
}

struct Finder<'a> {
    program: &'a Program,
    known: &'a [PouFacts],
    pou: &'a Pou,
    /// The loops around whose counters are in registers.
    counters: Vec<&'a For>,
    facts: Facts,
}

impl<'a> Finder<'a> {
    fn block(&mut self, block: &'a [Statement]) {
        block.iter().for_each(|it| self.statement(it));
    }

    fn statement(&mut self, statement: &'a Statement) {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                self.place(target);
                self.expr(value);
            }
            StatementKind::If { condition, then, otherwise } => {
                self.expr(condition);
                self.block(then);
                self.block(otherwise);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                self.expr(selector);
                arms.iter().for_each(|arm| self.block(&arm.body));
                self.block(otherwise);
            }
            StatementKind::Loop { body, continuing } => {
                self.block(body);
                self.block(continuing);
            }
            StatementKind::For(it) => self.for_loop(it),
            StatementKind::Turn => {
                self.facts.may_fault = true;
                self.facts.uses_context = true;
            }
            StatementKind::Exit | StatementKind::Continue | StatementKind::Return => {}
            StatementKind::Call { callee, instance, arguments, result: _ } => {
                self.instance(instance.as_ref());
                arguments.iter().for_each(|argument| self.argument(argument));
                self.callee(*callee, |facts| &facts.body);
            }
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.instance(Some(block));
                inputs.iter().for_each(|input| self.expr(input));
                self.facts.uses_context |= inline_block::find(block, *instruction).is_none();
            }
            StatementKind::PrescanBlock { block, instruction: _ } => self.instance(Some(block)),
            StatementKind::PrescanInstance { callee, instance } => {
                self.instance(Some(instance));
                self.callee(*callee, |facts| &facts.prescan);
            }
            StatementKind::Fault(_) => self.facts.may_fault = true,
        }
    }

    fn for_loop(&mut self, it: &'a For) {
        self.place(&it.counter);
        self.expr(&it.first);
        self.expr(&it.last);
        if let Step::Variable(step) = &it.step {
            self.expr(step);
        }
        let lane = self.program.lane(it.counter.ty);
        self.facts.may_fault |= it.step_may_fault(lane.and_then(|lane| lane.range()));
        self.counters.extend(it.is_private.then_some(it));
        self.block(&it.body);
        self.counters.truncate(self.counters.len() - usize::from(it.is_private));
    }

    fn callee(&mut self, callee: PouId, part: fn(&PouFacts) -> &Facts) {
        let callee = part(&self.known[callee.index()]);
        self.facts.may_fault |= callee.may_fault;
        self.facts.uses_context |= callee.uses_context;
        self.facts.uses_globals |= callee.uses_globals;
    }

    /// A place whose address is taken.
    fn instance(&mut self, place: Option<&Place>) {
        let Some(place) = place else { return };
        self.place(place);
        if let Root::Local(id) = place.root {
            self.facts.referred[id.index()] = true;
        }
    }

    fn argument(&mut self, argument: &Argument) {
        match argument {
            Argument::Value(value) => self.expr(value),
            Argument::Reference(place) => self.instance(Some(place)),
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
            ExprKind::Load(place) => self.place(place),
            ExprKind::Apply(op, operands) => {
                operands.iter().for_each(|operand| self.expr(operand));
                self.facts.may_fault |= inline_op::may_fault(self.program, *op, operands);
            }
            ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|operand| self.expr(operand));
            }
            ExprKind::Convert(_, operand) => self.expr(operand),
        }
    }

    fn place(&mut self, place: &Place) {
        self.facts.uses_globals |= place.root == Root::Globals;
        let mut ty = self.program.root_type(self.pou, place.root);
        for projection in &place.projections {
            ty = match projection {
                Projection::Field(field) => ty.and_then(|ty| self.program.member(ty, *field)),
                Projection::Index { index, .. } => {
                    self.expr(index);
                    self.element(ty, index)
                }
            };
        }
    }

    fn element(&mut self, ty: Option<Type>, index: &Expr) -> Option<Type> {
        let Some(Type::Array(id)) = ty else { unreachable!("verified IR: an index into an array") };
        self.facts.may_fault |=
            constant_position(self.program, index, id).is_none() && !is_within(self.program, index, id, &self.counters);
        Some(self.program.array(id).element)
    }
}
