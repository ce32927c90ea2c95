//! What each statement and expression of a routine says.

use super::found::Facts;
use super::numbers::Number;
use super::table::MAX_CHANGES;
use crate::program::scalar::Way;
use crate::program::walked::{Name, Walked};
use staunch_ir::{
    Argument, Block, Chars, Conversion, Expr, ExprKind, FieldId, Mode, Op, ParamId, Place, Program, Projection, Root,
    Routine, RoutineId, Statement, StatementKind, Step, StructId, TextOp, Type, Value, visit,
};
use std::collections::HashSet;

/// Characters before those that are asked for.
const MAX_BEFORE: usize = 300;

/// One routine's statements, and what they add to what is known.
pub struct Walk<'p, 'f> {
    pub program: &'p Program,
    pub routine: &'p Routine,
    pub id: RoutineId,
    pub facts: &'f mut Facts,
    /// Variables, and what each is assigned that is more than another variable.
    pub computed: Vec<(Name, &'p Expr)>,
}

impl<'p> Walk<'p, '_> {
    /// The innermost declaration that a place is an element of; a pin of a block is none.
    pub(super) fn name(&self, place: &Place) -> Option<Name> {
        Walked::of(self.program, (self.routine, self.id), place).variable()
    }

    /// The variable whose value an expression is, unchanged but for a wider type.
    pub(super) fn variable(&self, expr: &Expr) -> Option<Name> {
        match &expr.kind {
            ExprKind::Load(place) => self.name(place),
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) if self.widens(inner.ty, expr.ty) => {
                self.variable(inner)
            }
            ExprKind::Convert(..)
            | ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..) => None,
        }
    }

    fn widens(&self, from: Type, to: Type) -> bool {
        if let (Some(from), Some(to)) = (from.string_type(), to.string_type()) {
            return from.wide == to.wide && from.capacity <= to.capacity;
        }
        let range = |ty| self.program.repr(ty).and_then(staunch_runtime::Repr::range);
        match (range(from), range(to)) {
            (Some(from), Some(to)) => to.0 <= from.0 && from.1 <= to.1,
            _ => from == to,
        }
    }

    pub fn block(&mut self, block: &'p Block) {
        let mut found = Vec::new();
        visit::statements(block, &mut |it| found.push(it));
        found.into_iter().for_each(|it| self.statement(it));
    }

    fn statement(&mut self, statement: &'p Statement) {
        visit::targets(statement, &mut |place| {
            self.note_written(place);
            self.indices(place);
        });
        match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(self.name(target), value),
            StatementKind::Case { selector, arms, .. } => {
                for (low, high) in arms.iter().flat_map(|it| &it.labels) {
                    [*low, *high].into_iter().for_each(|it| self.compared(selector, Number::Integer(it)));
                }
                self.operand(selector);
            }
            StatementKind::If { condition, .. } => self.expr(condition),
            StatementKind::For(it) => {
                let step = if let Step::Variable(step) = &it.step { Some(step) } else { None };
                [Some(&it.first), Some(&it.last), step].into_iter().flatten().for_each(|it| self.expr(it));
            }
            StatementKind::Call { callee, arguments, result, .. } => {
                arguments.iter().enumerate().for_each(|(at, it)| self.argument(*callee, at, it));
                let returned = self.program.routine(*callee).result.map(|it| Name::Local(*callee, it));
                let target = result.as_ref().and_then(|it| self.name(it));
                self.facts.flows.extend(returned.zip(target));
            }
            StatementKind::CallBlock { inputs, .. } => inputs.iter().for_each(|it| self.expr(it)),
            StatementKind::Loop { .. }
            | StatementKind::Try { .. }
            | StatementKind::Finally { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_)
            | StatementKind::Fault(_) => {}
        }
    }

    fn assign(&mut self, target: Option<Name>, value: &'p Expr) {
        match (self.variable(value), target) {
            (Some(from), Some(to)) => {
                self.facts.flows.insert((from, to));
                self.note_read(from);
                visit::reads(value, &mut |it| self.indices(it));
            }
            (_, target) => {
                self.computed.extend(target.map(|it| (it, value)));
                self.expr(value);
            }
        }
    }

    fn argument(&mut self, callee: RoutineId, at: usize, argument: &'p Argument) {
        let Some(param) = self.program.routine(callee).params.get(at) else { return };
        let name = match param.mode {
            Mode::Value(local) => Name::Local(callee, local),
            Mode::Reference => Name::Param(callee, ParamId::next(at)),
        };
        match argument {
            Argument::Value(value) => self.assign(Some(name), value),
            Argument::Reference(place) => {
                if let Some(own) = self.name(place) {
                    self.facts.flows.extend([(own, name), (name, own)]);
                    self.note_read(own);
                }
            }
        }
    }

    /// A statement writes a place, and with it all that is in it.
    fn note_written(&mut self, place: &Place) {
        match self.way(place) {
            Some(way) => {
                self.facts.written_ways.insert(way);
            }
            None => {
                let found = self.all_in(place);
                self.facts.written.extend(found);
            }
        }
    }

    /// The members down to a place, from the globals or the state of a PROGRAM.
    fn way(&self, place: &Place) -> Option<Way> {
        let is_program =
            |state: StructId| self.program.instances.iter().any(|it| self.program.class(it.program).state == state);
        let from = match place.root {
            Root::Globals => self.program.globals,
            Root::Instance => self.routine.state.filter(|it| is_program(*it))?,
            Root::Local(_) | Root::Param(_) => return None,
        };
        let mut members = Vec::new();
        for projection in &place.projections {
            match projection {
                Projection::Field(field) => members.push(*field),
                Projection::Index { .. } => {}
                Projection::Deref { .. } => return None,
            }
        }
        Some(Way { from, members })
    }

    pub(super) fn note_read(&mut self, name: Name) {
        self.facts.read.insert(name);
    }

    /// What an array is indexed with is worth being at its ends, and beyond.
    pub(super) fn indices(&mut self, place: &Place) {
        let mut ty = self.program.root_type(self.routine, place.root);
        let mut whole = None;
        for projection in &place.projections {
            (ty, whole) = match (projection, ty) {
                (Projection::Field(field), Some(owner)) => {
                    let name = if let Type::Struct(id) = owner { Some(Name::Field(id, *field)) } else { None };
                    (self.program.member(owner, *field), name)
                }
                (Projection::Index { index, .. }, Some(Type::Array(id))) => {
                    let array = self.program.array(id);
                    for edge in [array.low - 1, array.low, array.high, array.high.saturating_add(1)] {
                        self.compared(index, Number::Integer(i128::from(edge)));
                    }
                    self.index(whole, index);
                    (Some(array.element), None)
                }
                (_, other) => (other, None),
            };
        }
    }

    /// An index of a table decides what is read by where the elements change, any other one by its value.
    fn index(&mut self, array: Option<Name>, index: &Expr) {
        let changes = array.and_then(|it| self.facts.tables.get(&it)).cloned();
        for at in changes.iter().flatten().take(MAX_CHANGES) {
            self.compared(index, Number::Integer(*at));
        }
        match changes {
            Some(all) if all.len() <= MAX_CHANGES => self.operand(index),
            Some(_) | None => self.expr(index),
        }
    }

    /// An expression whose value matters as a whole.
    pub(super) fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(value) => self.facts.constant(Some(expr.ty), *value),
            ExprKind::Text(text) => self.facts.text(text),
            ExprKind::Aggregate(value) => self.facts.initial(Some(expr.ty), value),
            ExprKind::AddressOf(place) => {
                self.indices(place);
                self.lent(place);
            }
            ExprKind::Load(place) => {
                self.indices(place);
                if let Some(name) = self.name(place) {
                    self.note_read(name);
                    self.facts.computed.insert(name);
                }
            }
            ExprKind::Apply(op, operands) => match operands.as_slice() {
                [a, b] if let (ExprKind::ApplyText(TextOp::Compare, texts), Some(_)) = (&a.kind, number(b)) => {
                    let is_exact = matches!(op, Op::Eq | Op::Ne);
                    self.texts(&texts[0], &texts[1], is_exact);
                    self.texts(&texts[1], &texts[0], is_exact);
                }
                [a, b] if compares(*op) => {
                    self.comparison(a, b);
                    self.comparison(b, a);
                }
                _ => {
                    for limit in operands.iter().filter_map(number) {
                        operands.iter().for_each(|it| self.compared(it, limit));
                    }
                    operands.iter().for_each(|it| self.expr(it));
                }
            },
            ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|it| self.expr(it));
                self.together(operands);
            }
            ExprKind::Convert(_, inner) => self.expr(inner),
        }
    }

    /// What a text is sought in, or joined with, is worth being that text.
    fn together(&mut self, operands: &[Expr]) {
        for (at, operand) in operands.iter().enumerate() {
            let ExprKind::Text(text) = &operand.kind else { continue };
            let others = operands.iter().enumerate().filter(|it| it.0 != at);
            others.for_each(|it| self.reaches(it.1, text));
        }
    }

    /// Notes for which texts of its variables an expression is, or has in it, a text.
    pub fn reaches(&mut self, expr: &Expr, text: &Chars) {
        match &expr.kind {
            ExprKind::Load(place) => {
                if let Some(name) = self.name(place) {
                    self.facts.near_to_text(name, text);
                }
            }
            ExprKind::Convert(_, inner) => self.reaches(inner, text),
            ExprKind::ApplyText(TextOp::Mid, operands) => {
                let before = operands.last().and_then(Expr::as_const).and_then(Value::as_integer).unwrap_or(1) - 1;
                self.reaches(&operands[0], &text.after(few(before)));
            }
            ExprKind::ApplyText(TextOp::FromChar | TextOp::FromWchar, operands) => {
                if let (1, Some(unit)) = (text.len(), text.unit(0)) {
                    self.compared(&operands[0], Number::Integer(unit.into()));
                }
            }
            ExprKind::ApplyText(TextOp::Widen, operands) => {
                text.of_width(false).iter().for_each(|it| self.reaches(&operands[0], it));
            }
            ExprKind::ApplyText(TextOp::Narrow, operands) => {
                text.of_width(true).iter().for_each(|it| self.reaches(&operands[0], it));
            }
            ExprKind::ApplyText(_, operands) => operands.iter().for_each(|it| self.reaches(it, text)),
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..) => {}
        }
    }

    /// A number is a character of a text, after so many others.
    pub(super) fn is_character(&mut self, op: TextOp, operands: &[Expr], limit: Number) {
        let Number::Integer(limit) = limit else { return };
        let before = match op {
            TextOp::CharAt | TextOp::WcharAt => {
                let at = operands.get(1).and_then(Expr::as_const).and_then(Value::as_integer);
                few(at.unwrap_or(0))
            }
            TextOp::ToChar | TextOp::ToWchar => 0,
            _ => return,
        };
        let text = match op {
            TextOp::WcharAt | TextOp::ToWchar => u16::try_from(limit).ok().map(|it| Chars::Wide(vec![it])),
            _ => u8::try_from(limit).ok().map(|it| Chars::Narrow(vec![it])),
        };
        if let (Some(text), Some(from)) = (text, operands.first()) {
            self.reaches(from, &text.after(before));
        }
    }

    /// What a reference leads to may be used in any way, and with it all that is in it.
    fn lent(&mut self, place: &Place) {
        let found = self.all_in(place);
        self.facts.read.extend(found.iter().copied());
        self.facts.written.extend(found.iter().copied());
        self.facts.computed.extend(found);
    }

    /// The variable that a place is a part of, and all that are in the place.
    fn all_in(&self, place: &Place) -> HashSet<Name> {
        let mut open: Vec<Type> = vec![place.ty];
        let mut found: HashSet<Name> = self.name(place).into_iter().collect();
        while let Some(ty) = open.pop() {
            match ty {
                Type::Array(id) => open.push(self.program.array(id).element),
                Type::Struct(id) => {
                    for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                        if found.insert(Name::Field(id, FieldId::next(at))) {
                            open.push(field.ty);
                        }
                    }
                }
                Type::Elementary(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_)
                | Type::Reference(_) => {}
            }
        }
        found
    }
}

pub(super) fn number(expr: &Expr) -> Option<Number> {
    match expr.as_const()? {
        Value::F32(it) => Some(Number::Real(f64::from(it))),
        Value::F64(it) => Some(Number::Real(it)),
        Value::Bool(_) => None,
        other => other.as_integer().map(Number::Integer),
    }
}

/// Characters before others: of far ones a string is too short.
fn few(count: i128) -> usize {
    usize::try_from(count).unwrap_or(0).min(MAX_BEFORE)
}

fn compares(op: Op) -> bool {
    matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne)
}
