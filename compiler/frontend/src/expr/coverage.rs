//! Counts what is executed, where that is asked for: each statement, each arm of a CASE, and with which values of its
//! conditions each decision is made. The counts are globals, so that every executor keeps them.

use crate::Span;
use crate::ast::{self, BinaryOp, ExprKind as Ast, PouKind};
use crate::expr::checker::Checker;
use crate::types::coverage::{Condition, CoverageKind, CoveragePoint, Decision, Formula, Sort};
use crate::types::declarations::Declarations;
use crate::types::table::Resolved;
use staunch_ir::{
    Array, ArrayId, Const, Conversion, Elementary, Expr, ExprKind, Field, FieldId, Location, Op, Place, Retain, Root,
    Section, Statement, StatementKind, Type, Value, visit,
};

const COUNT: Type = Type::Elementary(Elementary::Udint);

/// A decision with more conditions counts as one condition: its table would be too large.
const MOST_CONDITIONS: usize = 10;

/// The name of what an AND_THEN or OR_ELSE gives, among the temporaries.
pub(crate) const JOINED: &str = "both";

/// The conditions of a decision, from left to right.
#[derive(Default)]
struct Conditions<'e> {
    all: Vec<&'e Expr>,
}

impl<'e> Conditions<'e> {
    fn formula(&mut self, expr: &'e Expr) -> Formula {
        if let ExprKind::Apply(op, operands) = &expr.kind
            && expr.ty == Type::BOOL
        {
            let of: Option<fn(Vec<Formula>) -> Formula> = match *op {
                Op::And => Some(Formula::And),
                Op::Or => Some(Formula::Or),
                Op::Xor => Some(Formula::Xor),
                Op::Not => Some(Formula::Not),
                _ => None,
            };
            if let Some(of) = of {
                return of(operands.iter().map(|it| self.formula(it)).collect());
            }
        }
        if let Some(Value::Bool(value)) = expr.as_const() {
            return Formula::Constant(value);
        }
        self.all.push(expr);
        Formula::Condition(self.all.len() - 1)
    }
}

impl<'s> Declarations<'s> {
    /// Whether the body of a POU is counted: tests are not, nor is the library.
    pub(crate) fn is_covered(&self, slot: usize) -> bool {
        let pou = &self.pous[slot];
        let fixtures = &self.tests.fixtures;
        let is_fixture = |slot: usize| fixtures.contains(&self.pous[slot].ast.name.span);
        let is_tests = pou.ast.kind == PouKind::Test || is_fixture(slot) || pou.owner.is_some_and(is_fixture);
        let is_own = |files: u16| pou.ast.name.span.file < files && pou.run.is_none() && !is_tests;
        self.coverage.as_ref().is_some_and(|it| is_own(it.files))
    }

    /// An array of so many counters.
    fn counters(&mut self, rows: i64) -> Type {
        let array = Array { low: 0, high: rows - 1, element: COUNT };
        let known = self.program.arrays.iter().position(|it| *it == array);
        Type::Array(known.map_or_else(
            || {
                self.program.arrays.push(array);
                self.table.elements.push(Resolved::plain(COUNT));
                ArrayId::next(self.program.arrays.len() - 1)
            },
            ArrayId::next,
        ))
    }

    /// The field of the globals that counts a point.
    fn counter(
        &mut self,
        sort: Sort,
        at: Location,
        places: Vec<Location>,
        ty: Type,
        kind: CoverageKind,
    ) -> Option<FieldId> {
        let globals = self.program.globals;
        let fields = &mut self.program.structs[globals.index()].fields;
        let coverage = self.coverage.as_mut()?;
        let key = (sort, places);
        if let Some(known) = coverage.known.get(&key) {
            return Some(*known);
        }
        let field = FieldId::next(fields.len());
        fields.push(Field {
            name: format!("__covered_{}", coverage.points.len()),
            ty,
            initial: Const::Zero,
            section: Section::Global,
            // A power cycle in a table of scans is a part of the test.
            retain: Retain::Kept,
            constant: false,
            address: None,
            doc: None,
            location: at,
        });
        coverage.points.push(CoveragePoint { at, field, kind });
        coverage.known.insert(key, field);
        Some(field)
    }
}

impl<'s> Checker<'_, 's> {
    pub(crate) fn count_statement(&mut self, span: Span) {
        self.count_point(Sort::Statement, CoverageKind::Statement, span);
    }

    /// What a mock adds to a body is where the POU's name is, or where a test names what runs in its place.
    fn is_made_up(&self, span: Span) -> bool {
        let is_name = self.slot.is_some_and(|slot| self.decl.pous[slot].ast.name.span == span);
        is_name || self.decl.tests.exchanged.places.contains(&span)
    }

    /// An arm of a CASE, by its first label, or that no label holds the value, by the CASE.
    pub(crate) fn count_arm(&mut self, label: Option<Span>, case: Span) {
        let at = self.at(case);
        match label {
            Some(label) => self.count_point(Sort::Arm, CoverageKind::Arm(at), label),
            None => self.count_point(Sort::Otherwise, CoverageKind::Otherwise, case),
        }
    }

    fn count_point(&mut self, sort: Sort, kind: CoverageKind, span: Span) {
        if !self.is_covered || self.is_made_up(span) {
            return;
        }
        let at = self.at(span);
        let Some(field) = self.decl.counter(sort, at, vec![at], COUNT, kind) else { return };
        self.block.push(one_more(counter_place(field, COUNT), at));
    }

    /// Counts the values that a condition of an IF or a loop, and the conditions it is made of, have now.
    pub(crate) fn count_condition(&mut self, written: &ast::Expr<'s>, value: Option<&Expr>) {
        if let Some(value) = value.filter(|_| self.is_covered && !self.is_made_up(written.span)) {
            // The operands are decisions of their own.
            let is_known = matches!(written.bare().kind, Ast::Binary(_, BinaryOp::AndThen | BinaryOp::OrElse, _));
            let at = self.at(written.span);
            self.count_decision(value, Some(at), is_known);
        }
    }

    /// An operand of AND_THEN or OR_ELSE is a decision of its own: the second may not be evaluated.
    pub(crate) fn count_operand(&mut self, value: Option<&Expr>) {
        if let Some(value) = value.filter(|_| self.is_covered) {
            self.count_decision(value, None, false);
        }
    }

    /// `branch` is where the condition is written, if one of a branch is.
    fn count_decision(&mut self, value: &Expr, branch: Option<Location>, is_known: bool) {
        let mut conditions = Conditions::default();
        let mut formula = conditions.formula(value);
        if conditions.all.len() > MOST_CONDITIONS {
            (conditions.all, formula) = (vec![value], Formula::Condition(0));
        }
        let all = conditions.all;
        let Some(rows) = u32::try_from(all.len()).ok().filter(|it| *it > 0).map(|it| 1_i64 << it) else { return };
        let places: Vec<_> = all.iter().map(|it| start(it)).collect();
        let branches = branch.is_some();
        let key = if branches { places.iter().copied().chain([Location::default()]).collect() } else { places };
        let condition = |it: &&Expr| Condition { at: start(it), is_joined: self.is_joined(it) };
        let conditions = if is_known { Vec::new() } else { all.iter().map(condition).collect() };
        let kind = CoverageKind::Decision(Decision { branches, conditions, formula });
        let counters = self.decl.counters(rows);
        let at = branch.unwrap_or_else(|| start(value));
        let Some(field) = self.decl.counter(Sort::Decision, at, key, counters, kind) else { return };
        let kept = self.temporary("row", Type::LINT);
        self.block.push(Statement::assign(kept.clone(), row(&all, value.at), value.at));
        let row = Expr::load(kept, value.at);
        let place = counter_place(field, counters).index(row, COUNT, value.at);
        self.block.push(one_more(place, value.at));
        all.into_iter().for_each(|it| self.count_within(it));
    }

    /// Whether it is what an AND_THEN or OR_ELSE gives.
    fn is_joined(&self, condition: &Expr) -> bool {
        let ExprKind::Load(Place { root: Root::Local(local), .. }) = condition.kind else { return false };
        self.locals[local.index()].name == JOINED
    }

    /// Counts the decisions inside of what is no decision itself.
    fn count_within(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|it| self.count_value(it));
            }
            ExprKind::Convert(_, value) => self.count_value(value),
            ExprKind::Load(place) => place.indices().for_each(|it| self.count_value(it)),
            ExprKind::AddressOf(place) => place.indices().for_each(|it| self.count_value(it)),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => {}
        }
    }

    /// A value is a decision where it is made of two conditions or more.
    pub(crate) fn count_value(&mut self, value: &Expr) {
        let mut conditions = Conditions::default();
        conditions.formula(value);
        match conditions.all.as_slice() {
            [] => {}
            [one] => self.count_within(one),
            [_, _, ..] => self.count_decision(value, None, false),
        }
    }

    /// Counts the decisions in what a statement is about to evaluate.
    pub(crate) fn count_values_of(&mut self, statement: &Statement) {
        // The condition of an IF is counted where the source writes one.
        if self.is_covered && !matches!(statement.kind, StatementKind::If { .. }) {
            let mut values: Vec<&Expr> = Vec::new();
            visit::values(statement, &mut |it| values.push(it));
            values.into_iter().for_each(|it| self.count_value(it));
        }
    }
}

/// Where an expression begins: its own place may be that of its operator.
fn start(expr: &Expr) -> Location {
    let mut first = expr.at;
    let mut see = |it: &Expr| {
        if it.at.file == first.file && (it.at.line, it.at.column) < (first.line, first.column) && it.at.line > 0 {
            first = it.at;
        }
    };
    visit::within(expr, &mut see);
    first
}

fn counter_place(field: FieldId, ty: Type) -> Place {
    Place::root(Root::Globals, ty).field(field, ty)
}

/// `place := place + 1`
fn one_more(place: Place, at: Location) -> Statement {
    let one = Expr::constant(Elementary::Udint, Value::U32(1), at);
    let sum = Expr::apply(Op::Add, COUNT, vec![Expr::load(place.clone(), at), one], at);
    Statement::assign(place, sum, at)
}

/// The number of the row that the conditions are in, the first as the lowest bit.
fn row(conditions: &[&Expr], at: Location) -> Expr {
    let bit = |(number, condition): (u32, &&Expr)| {
        let value = Expr::convert(Conversion::Value, Type::LINT, (**condition).clone().read(), at);
        match number {
            0 => value,
            _ => {
                let weight = Expr::constant(Elementary::Lint, Value::I64(1 << number), at);
                Expr::apply(Op::Mul, Type::LINT, vec![value, weight], at)
            }
        }
    };
    let add = |a, b| Expr::apply(Op::Add, Type::LINT, vec![a, b], at);
    let zero = || Expr::constant(Elementary::Lint, Value::I64(0), at);
    (0..).zip(conditions).map(bit).reduce(add).unwrap_or_else(zero)
}
