//! Statements, each with the line and column it comes from.

use super::Printer;
use crate::{Argument, Arm, Block, Expr, For, Place, Pou, PouId, Statement, StatementKind, Step, Type};
use core::fmt;

impl Printer<'_> {
    pub(super) fn block(&mut self, pou: &Pou, block: &Block) -> fmt::Result {
        self.depth += 1;
        block.iter().try_for_each(|statement| self.statement(pou, statement))?;
        self.depth -= 1;
        Ok(())
    }

    fn statement(&mut self, pou: &Pou, statement: &Statement) -> fmt::Result {
        let head = self.head(pou, &statement.kind);
        let at = statement.at;
        self.line(format_args!("{head} @{}:{}", at.line, at.column))?;
        match &statement.kind {
            StatementKind::If { then, otherwise, .. } => {
                self.block(pou, then)?;
                self.tail(pou, "else", otherwise)
            }
            StatementKind::Case { arms, otherwise, .. } => {
                arms.iter().try_for_each(|arm| self.arm(pou, arm))?;
                self.tail(pou, "else", otherwise)
            }
            StatementKind::Loop { body, continuing } => {
                self.block(pou, body)?;
                self.tail(pou, "continuing", continuing)
            }
            StatementKind::For(it) => self.block(pou, &it.body),
            StatementKind::Assign { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Call { .. }
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::PrescanInstance { .. }
            | StatementKind::Fault(_) => Ok(()),
        }
    }

    fn tail(&mut self, pou: &Pou, word: &str, block: &Block) -> fmt::Result {
        if block.is_empty() {
            return Ok(());
        }
        self.line(format_args!("{word}"))?;
        self.block(pou, block)
    }

    fn arm(&mut self, pou: &Pou, arm: &Arm) -> fmt::Result {
        let labels: Vec<String> = arm.labels.iter().map(|label| label_text(*label)).collect();
        self.line(format_args!("{}:", labels.join(", ")))?;
        self.block(pou, &arm.body)
    }

    /// The statement's own line.
    fn head(&self, pou: &Pou, kind: &StatementKind) -> String {
        match kind {
            StatementKind::Assign { target, value } => {
                format!("{} := {}", self.place(pou, target), self.expr(pou, value))
            }
            StatementKind::If { condition, .. } => format!("if {}", self.expr(pou, condition)),
            StatementKind::Case { selector, .. } => format!("case {}", self.expr(pou, selector)),
            StatementKind::Loop { .. } => "loop".to_owned(),
            StatementKind::For(it) => self.for_head(pou, it),
            StatementKind::Turn => "turn".to_owned(),
            StatementKind::Exit => "exit".to_owned(),
            StatementKind::Continue => "continue".to_owned(),
            StatementKind::Return => "return".to_owned(),
            StatementKind::Call { callee, instance, arguments, result } => {
                self.call_head(pou, *callee, instance.as_ref(), arguments, result.as_ref())
            }
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.block_head(pou, block, *instruction, inputs)
            }
            StatementKind::PrescanBlock { block, instruction } => {
                format!("prescan {}", self.block_head(pou, block, *instruction, &[]))
            }
            StatementKind::PrescanInstance { callee, instance } => {
                format!("prescan {} {}", self.program.pou(*callee).name, self.place(pou, instance))
            }
            StatementKind::Fault(kind) => format!("fault {kind:?}"),
        }
    }

    fn for_head(&self, pou: &Pou, it: &For) -> String {
        let step = match &it.step {
            Step::Constant(step) => step.to_string(),
            Step::Variable(step) => self.expr(pou, step),
        };
        let (counter, first, last) =
            (self.place(pou, &it.counter), self.expr(pou, &it.first), self.expr(pou, &it.last));
        let (least, most) = it.range;
        let private = if it.is_private { " private" } else { "" };
        format!("for{private} {counter} in {least}..{most} := {first} to {last} by {step}")
    }

    fn call_head(
        &self,
        pou: &Pou,
        callee: PouId,
        instance: Option<&Place>,
        arguments: &[Argument],
        result: Option<&Place>,
    ) -> String {
        let target = result.map(|place| format!("{} := ", self.place(pou, place))).unwrap_or_default();
        let instance = instance.map(|place| format!(" {}", self.place(pou, place))).unwrap_or_default();
        let arguments: Vec<String> = arguments.iter().map(|it| self.argument(pou, it)).collect();
        let name = &self.program.pou(callee).name;
        format!("{target}call {name}{instance}({})", arguments.join(", "))
    }

    fn argument(&self, pou: &Pou, argument: &Argument) -> String {
        match argument {
            Argument::Value(value) => self.expr(pou, value),
            Argument::Reference(place) => format!("ref {}", self.place(pou, place)),
        }
    }

    fn block_head(&self, pou: &Pou, block: &Place, instruction: usize, inputs: &[Expr]) -> String {
        let name = match block.ty {
            Type::Block(id) => match id.info().instructions[instruction].name {
                "" => id.info().name,
                name => name,
            },
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_) => "?",
        };
        format!("{name} {}({})", self.place(pou, block), self.exprs(pou, inputs))
    }
}

fn label_text((low, high): (i128, i128)) -> String {
    if low == high { low.to_string() } else { format!("{low}..{high}") }
}
