//! Statements: branches, writes and calls.

use super::{Frame, Interpreter, Stop, Watch};
use crate::evaluate::{scalar, text};
use crate::layout::usize_of;
use crate::{
    Argument, Arm, BlockId, Expr, ExprKind, Mode, Place, Routine, RoutineId, Statement, StatementKind, Type, Value,
};
use staunch_runtime::{Context, Fault, FaultKind, Instruction};

/// How a statement ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    Next,
    Exit,
    Continue,
    Return,
}

impl<'p, W: Watch> Interpreter<'p, W> {
    pub(super) fn block(&mut self, frame: &Frame, block: &'p [Statement], cx: &Context) -> Result<Flow, Stop> {
        for statement in block {
            let flow = self.statement(frame, statement, cx)?;
            if flow != Flow::Next {
                return Ok(flow);
            }
        }
        Ok(Flow::Next)
    }

    fn statement(&mut self, frame: &Frame, statement: &'p Statement, cx: &Context) -> Result<Flow, Stop> {
        self.step()?;
        match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(frame, target, value)?,
            StatementKind::If { condition, then, otherwise } => {
                let block = if self.condition(frame, condition)? { then } else { otherwise };
                return self.block(frame, block, cx);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                let block = self.arm(frame, selector, arms)?.unwrap_or(otherwise);
                return self.block(frame, block, cx);
            }
            StatementKind::Loop { body, continuing, count } => {
                return self.turns(frame, body, continuing, count.as_deref(), cx);
            }
            StatementKind::For(it) => return self.for_loop(frame, it, statement.at, cx),
            StatementKind::Try { body, kind, handler } => return self.attempt(frame, body, (kind, handler), cx),
            StatementKind::Finally { body, last } => return self.finally(frame, body, last, cx),
            StatementKind::Turn if self.has_few_turns => {}
            StatementKind::Turn => cx.take_turn().map_err(|kind| Fault { kind, at: statement.at })?,
            StatementKind::Exit => return Ok(Flow::Exit),
            StatementKind::Continue => return Ok(Flow::Continue),
            StatementKind::Return => return Ok(Flow::Return),
            StatementKind::Call { callee, instance, arguments, result } => {
                let instance = instance.as_ref().map(|place| self.resolve(frame, place)).transpose()?;
                let inner = self.open(frame, *callee, instance, arguments)?;
                self.watch.enter(&inner, statement.at);
                let ended = self.block(&inner, &self.program.routine(*callee).body, cx);
                ended.map_err(|it| it.of_call(statement.at))?;
                self.watch.leave(self.watch.depth().saturating_sub(1));
                self.close(frame, &inner, result.as_ref())?;
            }
            // What is outside is not here.
            StatementKind::External(_) => {
                return Err(Fault { kind: FaultKind::NotImplemented, at: statement.at }.into());
            }
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.call_block(frame, block, *instruction, inputs, cx)?;
            }
            StatementKind::PrescanBlock { block, instruction } => {
                self.prescan_block(frame, block, *instruction)?;
            }
            StatementKind::Stop(stop) => W::stop(self, stop, statement.at, cx),
            StatementKind::Fault(kind) => {
                return Err(Fault { kind: *kind, at: statement.at }.into());
            }
        }
        Ok(Flow::Next)
    }

    /// Statements whose faults are handled. What a fault has left of the routines that ran is dropped.
    fn attempt(
        &mut self,
        frame: &Frame,
        body: &'p [Statement],
        (kind, handler): (&'p Place, &'p [Statement]),
        cx: &Context,
    ) -> Result<Flow, Stop> {
        let (memory, references, has_few_turns) = (self.memory.len(), self.references.len(), self.has_few_turns);
        let depth = self.watch.depth();
        let fault = match self.block(frame, body, cx) {
            Err(Stop::Fault(fault)) => fault,
            ended => return ended,
        };
        let number = fault.caught()?;
        self.memory.truncate(memory);
        self.references.truncate(references);
        self.watch.leave(depth);
        self.has_few_turns = has_few_turns;
        let offset = self.resolve(frame, kind)?;
        Value::U8(number).write(&mut self.memory[offset..]);
        self.block(frame, handler, cx)
    }

    /// `last` runs however `body` ends.
    fn finally(
        &mut self,
        frame: &Frame,
        body: &'p [Statement],
        last: &'p [Statement],
        cx: &Context,
    ) -> Result<Flow, Stop> {
        let ended = self.block(frame, body, cx);
        self.block(frame, last, cx)?;
        ended
    }

    pub(super) fn step(&mut self) -> Result<(), Stop> {
        if let Some(left) = &mut self.steps_left {
            *left = left.checked_sub(1).ok_or(Stop::OutOfSteps)?;
        }
        Ok(())
    }

    fn condition(&self, frame: &Frame, condition: &Expr) -> Result<bool, Fault> {
        Ok(as_bool(scalar(&self.scope(frame), condition)?))
    }

    /// The body of the arm that a selector takes.
    fn arm(&self, frame: &Frame, selector: &Expr, arms: &'p [Arm]) -> Result<Option<&'p Vec<Statement>>, Fault> {
        let value = scalar(&self.scope(frame), selector)?;
        let number = value.as_integer().expect("verified IR: an integer selector");
        let holds = |arm: &&Arm| arm.labels.iter().any(|(low, high)| (*low..=*high).contains(&number));
        Ok(arms.iter().find(holds).map(|arm| &arm.body))
    }

    pub(super) fn assign(&mut self, frame: &Frame, target: &Place, value: &Expr) -> Result<(), Fault> {
        if let Some(reached) = self.scope(frame).reached(target)? {
            return self.assign_reached(frame, &reached, value);
        }
        let offset = self.resolve(frame, target)?;
        self.store(frame, value, offset)
    }

    /// Writes the value of an expression to an offset in memory.
    fn store(&mut self, frame: &Frame, value: &Expr, offset: usize) -> Result<(), Fault> {
        match value.ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
                let value = scalar(&self.scope(frame), value)?;
                value.write(&mut self.memory[offset..]);
            }
            Type::String(ty) => {
                let value = text(&self.scope(frame), value)?;
                value.write(&mut self.memory[offset..][..usize_of(ty.size().into())]);
            }
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => self.store_aggregate(frame, value, offset)?,
        }
        Ok(())
    }

    fn store_aggregate(&mut self, frame: &Frame, value: &Expr, offset: usize) -> Result<(), Fault> {
        match &value.kind {
            ExprKind::Load(place) => {
                let from = self.resolve(frame, place)?;
                self.copy(from, offset, value.ty);
            }
            ExprKind::Aggregate(constant) => {
                let target = &mut self.memory[offset..];
                self.layout.write_const(self.program, value.ty, constant, target);
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
        Ok(())
    }

    fn copy(&mut self, from: usize, to: usize, ty: Type) {
        let size = usize_of(self.layout.size(ty));
        self.memory.copy_within(from..from + size, to);
    }

    /// Opens the callee's frame and evaluates its arguments into it, left to right.
    fn open(
        &mut self,
        caller: &Frame,
        callee: RoutineId,
        instance: Option<usize>,
        arguments: &'p [Argument],
    ) -> Result<Frame, Fault> {
        let frame = self.enter(callee, instance.unwrap_or_default());
        for (param, argument) in self.program.routine(callee).params.iter().zip(arguments) {
            let reference = match argument {
                Argument::Reference(place) => self.resolve(caller, place)?,
                Argument::Value(value) => {
                    let Mode::Value(local) = param.mode else { unreachable!("verified IR: argument modes") };
                    let offset = frame.locals + self.frames[callee.index()].offsets[local.index()];
                    self.store(caller, value, offset)?;
                    offset
                }
            };
            self.references.push(reference);
        }
        Ok(frame)
    }

    /// Hands a FUNCTION's result to its caller and drops its frame.
    fn close(&mut self, caller: &Frame, callee: &Frame, result: Option<&Place>) -> Result<(), Fault> {
        if let Some(target) = result {
            let routine: &Routine = self.program.routine(callee.routine);
            let local = routine.result.expect("verified IR: a FUNCTION with a result");
            let from = callee.locals + self.frames[callee.routine.index()].offsets[local.index()];
            let to = self.resolve(caller, target)?;
            self.copy(from, to, target.ty);
        }
        self.leave(callee);
        Ok(())
    }

    fn call_block(
        &mut self,
        frame: &Frame,
        block: &Place,
        instruction: usize,
        inputs: &[Expr],
        cx: &Context,
    ) -> Result<(), Fault> {
        let offset = self.resolve(frame, block)?;
        self.inputs.clear();
        for input in inputs {
            let value = scalar(&self.scope(frame), input)?;
            self.inputs.push(value);
        }
        let info = block_id(block).info();
        let instruction = &info.instructions[instruction];
        let bytes = &mut self.memory[offset..offset + info.size];
        let rung = if instruction.takes_rung {
            as_bool(self.inputs[0])
        } else {
            for (pin, value) in info.inputs().zip(&self.inputs) {
                value.write(&mut bytes[pin.offset..]);
            }
            true
        };
        (instruction.run)(bytes, cx, rung);
        if let Some(exchange) = &mut self.exchange {
            exchange.compute(&mut self.memory, offset, cx);
        }
        Ok(())
    }

    fn prescan_block(&mut self, frame: &Frame, block: &Place, instruction: usize) -> Result<(), Fault> {
        let offset = self.resolve(frame, block)?;
        let info = block_id(block).info();
        let instruction: &Instruction = &info.instructions[instruction];
        let prescan = instruction.prescan.expect("verified IR: an instruction with a prescan");
        (prescan.run)(&mut self.memory[offset..offset + info.size]);
        Ok(())
    }
}

fn block_id(place: &Place) -> BlockId {
    match place.ty {
        Type::Block(id) => id,
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::Subrange(..)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_) => {
            unreachable!("verified IR: an instance of a standard block")
        }
    }
}

pub(super) fn integer(value: Value) -> i128 {
    value.as_integer().expect("verified IR: an integer")
}

fn as_bool(value: Value) -> bool {
    let Value::Bool(value) = value else { unreachable!("verified IR: a condition is a BOOL") };
    value
}
