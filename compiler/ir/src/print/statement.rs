//! Statements, each with the line and column it comes from.

use super::Printer;
use crate::{
    Argument, Arm, Block, Count, Expr, ExternalCall, For, Place, Routine, RoutineId, RoutineKind, Statement,
    StatementKind, Step, Taking, Type,
};
use core::fmt;

impl Printer<'_> {
    pub(super) fn block(&mut self, routine: &Routine, block: &Block) -> fmt::Result {
        self.depth += 1;
        block.iter().try_for_each(|statement| self.statement(routine, statement))?;
        self.depth -= 1;
        Ok(())
    }

    fn statement(&mut self, routine: &Routine, statement: &Statement) -> fmt::Result {
        let head = self.head(routine, &statement.kind);
        let at = statement.at;
        match self.has_places {
            true => self.line(format_args!("{head} @{}:{}", at.line, at.column))?,
            false => self.line(format_args!("{head}"))?,
        }
        match &statement.kind {
            StatementKind::If { then, otherwise, .. } => {
                self.block(routine, then)?;
                self.tail(routine, "else", otherwise)
            }
            StatementKind::Case { arms, otherwise, .. } => {
                arms.iter().try_for_each(|arm| self.arm(routine, arm))?;
                self.tail(routine, "else", otherwise)
            }
            StatementKind::Loop { body, continuing, .. } => {
                self.block(routine, body)?;
                self.tail(routine, "continuing", continuing)
            }
            StatementKind::For(it) => self.block(routine, &it.body),
            StatementKind::Try { body, handler, .. } => {
                self.block(routine, body)?;
                self.line(format_args!("caught"))?;
                self.block(routine, handler)
            }
            StatementKind::Finally { body, last } => {
                self.block(routine, body)?;
                self.line(format_args!("last"))?;
                self.block(routine, last)
            }
            StatementKind::Assign { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Call { .. }
            | StatementKind::External(_)
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_)
            | StatementKind::Fault(_) => Ok(()),
        }
    }

    fn tail(&mut self, routine: &Routine, word: &str, block: &Block) -> fmt::Result {
        if block.is_empty() {
            return Ok(());
        }
        self.line(format_args!("{word}"))?;
        self.block(routine, block)
    }

    fn arm(&mut self, routine: &Routine, arm: &Arm) -> fmt::Result {
        let labels: Vec<String> = arm.labels.iter().map(|label| label_text(*label)).collect();
        self.line(format_args!("{}:", labels.join(", ")))?;
        self.block(routine, &arm.body)
    }

    /// The statement's own line.
    fn head(&self, routine: &Routine, kind: &StatementKind) -> String {
        match kind {
            StatementKind::Assign { target, value } => {
                format!("{} := {}", self.place(routine, target), self.expr(routine, value))
            }
            StatementKind::If { condition, .. } => format!("if {}", self.expr(routine, condition)),
            StatementKind::Case { selector, .. } => format!("case {}", self.expr(routine, selector)),
            StatementKind::Loop { count: None, .. } => "loop".to_owned(),
            StatementKind::Loop { count: Some(it), .. } => self.count(routine, it),
            StatementKind::For(it) => self.for_head(routine, it),
            StatementKind::Try { kind, .. } => format!("try {}", self.place(routine, kind)),
            StatementKind::Finally { .. } => "finally".to_owned(),
            StatementKind::Turn => "turn".to_owned(),
            StatementKind::Exit => "exit".to_owned(),
            StatementKind::Continue => "continue".to_owned(),
            StatementKind::Return => "return".to_owned(),
            StatementKind::Call { callee, instance, arguments, result } => {
                self.call_head(routine, *callee, instance.as_ref(), arguments, result.as_ref())
            }
            StatementKind::External(it) => self.external_head(routine, it),
            StatementKind::CallBlock { block, instruction, inputs } => {
                self.block_head(routine, block, *instruction, inputs)
            }
            StatementKind::PrescanBlock { block, instruction } => {
                format!("prescan {}", self.block_head(routine, block, *instruction, &[]))
            }
            StatementKind::Stop(it) => match &it.asked {
                Some(it) if it.is_condition => format!("stop if {}", self.expr(routine, &it.value)),
                Some(it) => format!("stop {}", self.expr(routine, &it.value)),
                None => "stop".to_owned(),
            },
            StatementKind::Fault(kind) => format!("fault {kind:?}"),
        }
    }

    fn for_head(&self, routine: &Routine, it: &For) -> String {
        let step = match &it.step {
            Step::Constant(step) => step.to_string(),
            Step::Variable(step) => self.expr(routine, step),
        };
        let (counter, first, last) =
            (self.place(routine, &it.counter), self.expr(routine, &it.first), self.expr(routine, &it.last));
        let (least, most) = it.range;
        let private = if it.is_private { " private" } else { "" };
        let taking = taking(it.taking);
        format!("for{private} {counter} in {least}..{most} := {first} to {last} by {step}{taking}")
    }

    fn count(&self, routine: &Routine, it: &Count) -> String {
        let (counter, bound) = (self.place(routine, &it.counter), self.expr(routine, &it.bound));
        let way = match (it.step > 0, it.offset) {
            (true, 0) => "to",
            (false, 0) => "down to",
            (true, _) => "below",
            (false, _) => "down above",
        };
        format!("loop {counter} {way} {bound} by {}{}", it.step, taking(it.taking))
    }

    fn call_head(
        &self,
        routine: &Routine,
        callee: RoutineId,
        instance: Option<&Place>,
        arguments: &[Argument],
        result: Option<&Place>,
    ) -> String {
        let target = result.map(|place| format!("{} := ", self.place(routine, place))).unwrap_or_default();
        let instance = instance.map(|place| format!(" {}", self.place(routine, place))).unwrap_or_default();
        let arguments: Vec<String> = arguments.iter().map(|it| self.argument(routine, it)).collect();
        let callee = self.program.routine(callee);
        let prescan = if callee.kind == RoutineKind::Prescan { ".prescan" } else { "" };
        let name = if callee.kind == RoutineKind::Method { self.program.title(callee) } else { callee.name.clone() };
        format!("{target}call {name}{prescan}{instance}({})", arguments.join(", "))
    }

    fn external_head(&self, routine: &Routine, it: &ExternalCall) -> String {
        let target = it.result.as_ref().map(|place| format!("{} := ", self.place(routine, place))).unwrap_or_default();
        let instance = it.instance.as_ref().map(|place| format!(" {}", self.place(routine, place))).unwrap_or_default();
        let arguments: Vec<String> = it.arguments.iter().map(|it| self.argument(routine, it)).collect();
        format!("{target}external {}{instance}({})", it.external.symbol, arguments.join(", "))
    }

    fn argument(&self, routine: &Routine, argument: &Argument) -> String {
        match argument {
            Argument::Value(value) => self.expr(routine, value),
            Argument::Reference(place) => format!("ref {}", self.place(routine, place)),
        }
    }

    fn block_head(&self, routine: &Routine, block: &Place, instruction: usize, inputs: &[Expr]) -> String {
        // What notes a minor fault is given its place.
        let is_given_place = matches!(block.ty, Type::Block(id) if id.info().name == "__MINOR_FAULT");
        let inputs = if is_given_place && !self.has_places { &[] } else { inputs };
        let name = match block.ty {
            Type::Block(id) => match id.info().instructions[instruction].name {
                "" => id.info().name,
                name => name,
            },
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_) => "?",
        };
        format!("{name} {}({})", self.place(routine, block), self.exprs(routine, inputs))
    }
}

fn label_text((low, high): (i128, i128)) -> String {
    if low == high { low.to_string() } else { format!("{low}..{high}") }
}

fn taking(it: Taking) -> &'static str {
    match it {
        Taking::Each => "",
        Taking::EachOfMany => ", each of many turns",
        Taking::Ahead(_) => ", all turns ahead",
        Taking::AheadOfMany(_) => ", all of many turns ahead",
    }
}
