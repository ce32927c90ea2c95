//! Statements: writes and control flow.

use crate::address::Address;
use crate::function::{Flow, Function};
use crate::looked_up::local;
use crate::place::PlaceValue;
use cranelift_codegen::ir::{self as clif, InstBuilder};
use staunch_ir::{Block, Expr, ExprKind, Op, Place, Statement, StatementKind, Type};

impl<'p> Function<'_, 'p> {
    /// What comes after a statement that control does not pass is left out.
    pub(crate) fn block(&mut self, block: &'p [Statement]) -> Flow {
        self.block_after(&[], block)
    }

    /// A block that control comes to only from the statements `before` it.
    pub(crate) fn block_after(&mut self, before: &'p [Statement], block: &'p [Statement]) -> Flow {
        self.fresh = None;
        let mut rest = block;
        while let Some((statement, further)) = rest.split_first() {
            let flow = match self.next_run(rest) {
                Some(run) => {
                    let (statements, others) = rest.split_at(run.len);
                    rest = others;
                    let flow = self.looked_up_once(&run, statements);
                    self.seen.forget_variables();
                    flow
                }
                None => {
                    let at = block.len() - rest.len();
                    self.before = if at == 0 { before } else { &block[..at] };
                    rest = further;
                    self.statement(statement)
                }
            };
            if flow == Flow::Leaves {
                return Flow::Leaves;
            }
        }
        Flow::Continues
    }

    fn statement(&mut self, statement: &'p Statement) -> Flow {
        let assigned = self.assigned(statement);
        let flow = self.emit(statement);
        // What a branch or a loop has made at its end is made on one way alone.
        if !matches!(statement.kind, StatementKind::Assign { .. }) {
            self.fresh = None;
        }
        self.note_written(statement, assigned);
        flow
    }

    fn emit(&mut self, statement: &'p Statement) -> Flow {
        self.fresh = None;
        self.release_temporaries();
        self.note_statement(statement.at);
        match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(target, value),
            StatementKind::If { condition, then, otherwise } => {
                return self.branch(condition, then, otherwise);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                return self.case(selector, arms, otherwise);
            }
            StatementKind::Loop { body, continuing, count } => {
                return self.turns(body, continuing, count.as_deref(), statement.at);
            }
            StatementKind::For(it) => return self.for_loop(it, statement.at),
            StatementKind::Try { body, kind, handler } => return self.attempt(body, kind, handler),
            StatementKind::Finally { body, last } => return self.finally(body, last),
            StatementKind::Turn => self.take_turn(statement.at),
            StatementKind::Exit => {
                self.note_jump();
                return self.leave_loop();
            }
            StatementKind::Continue => {
                self.note_jump();
                return self.continue_loop();
            }
            StatementKind::Return => {
                self.note_jump();
                return self.return_from_loops();
            }
            StatementKind::Call { callee, instance, arguments, result } => {
                self.call(*callee, instance.as_ref(), arguments, result.as_ref(), statement.at);
            }
            StatementKind::External(it) => self.external(it),
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.call_block(block, *instruction, inputs);
            }
            StatementKind::PrescanBlock { block, instruction } => {
                self.prescan_block(block, *instruction);
            }
            StatementKind::Stop(_) => {}
            StatementKind::Fault(kind) => {
                self.fault(*kind, statement.at);
                return Flow::Leaves;
            }
        }
        Flow::Continues
    }

    pub(crate) fn assign(&mut self, target: &Place, value: &Expr) {
        if let Some(reached) = self.reached(target) {
            if matches!(value.ty, Type::String(_)) {
                return self.store_reached_text(reached, value);
            }
            let value = self.scalar(value);
            return self.store_reached(reached, value);
        }
        match self.place_value(target) {
            PlaceValue::Variable(variable) => {
                let value = self.scalar(value);
                self.builder.def_var(variable, value);
                let made = self.made.filter(|it| it.reference == value);
                self.fresh = local(target).zip(made);
            }
            PlaceValue::Memory(address) => self.assign_to(value, target, address),
        }
    }

    fn assign_to(&mut self, value: &Expr, place: &Place, target: Address) {
        match value.ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                let value = self.scalar(value);
                self.store(value, target);
            }
            Type::String(_) => self.assign_text(value, place, target),
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                self.assign_aggregate(value, target);
            }
        }
    }

    fn assign_aggregate(&mut self, value: &Expr, target: Address) {
        if let ExprKind::Aggregate(constant) = &value.kind {
            return self.store_const(value.ty, constant, target);
        }
        let from = self.aggregate(value);
        self.copy(from, target, value.ty);
    }

    /// An array or structure for reading.
    pub(crate) fn aggregate(&mut self, value: &Expr) -> Address {
        match &value.kind {
            ExprKind::Load(place) => self.address(place),
            ExprKind::Aggregate(constant) => {
                let shape = self.module.layout.shape(value.ty);
                let address = self.temporary(shape);
                self.store_const(value.ty, constant, address);
                address
            }
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => {
                unreachable!("verified IR: an aggregate is read or constant")
            }
        }
    }

    fn branch(&mut self, condition: &Expr, then: &'p Block, otherwise: &'p Block) -> Flow {
        let (then_block, after) = (self.builder.create_block(), self.builder.create_block());
        if otherwise.is_empty() {
            self.test(condition, then_block, after);
            let seen = self.seen.at(self.builder.current_block());
            self.seen = seen.in_way(then_block);
            self.arm(then_block, then, after);
            self.go_on_in(after);
            self.seen = seen.after_ways(after);
            return Flow::Continues;
        }
        let otherwise_block = self.builder.create_block();
        self.test(condition, then_block, otherwise_block);
        let seen = self.seen.at(self.builder.current_block());
        let flow = [(then_block, then), (otherwise_block, otherwise)].map(|(block, body)| {
            self.seen = seen.in_way(block);
            self.arm(block, body, after)
        });
        let flow = self.join(&flow, after);
        self.seen = seen.after_ways(after);
        flow
    }

    /// Flow one way or the other. A NOT costs nothing here.
    pub(crate) fn test(&mut self, condition: &Expr, holds: clif::Block, fails: clif::Block) {
        if let ExprKind::Apply(Op::Not, operands) = &condition.kind {
            return self.test(&operands[0], fails, holds);
        }
        let condition = self.scalar(condition);
        self.ins().brif(condition, holds, &[], fails, &[]);
    }

    /// One way through a branch, from `block` to `after`.
    pub(crate) fn arm(&mut self, block: clif::Block, body: &'p Block, after: clif::Block) -> Flow {
        self.go_on_in(block);
        let flow = self.block(body);
        if flow == Flow::Continues {
            self.ins().jump(after, &[]);
        }
        flow
    }

    /// Flow on after a branch, if one of its ways leads there.
    pub(crate) fn join(&mut self, ways: &[Flow], after: clif::Block) -> Flow {
        if !ways.contains(&Flow::Continues) {
            return Flow::Leaves;
        }
        self.go_on_in(after);
        Flow::Continues
    }

    pub(crate) fn go(&mut self, block: clif::Block) -> Flow {
        self.ins().jump(block, &[]);
        Flow::Leaves
    }
}
