//! Counts what is executed, where that is asked for: each statement, each arm of a CASE, and with which values of its
//! conditions each decision is made. The counts are globals, so that every executor keeps them.

use crate::Span;
use crate::ast::{self, BinaryOp, ExprKind as Ast, PouKind};
use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::types::coverage::{Condition, CoverageKind, CoveragePoint, Decision, Formula, Role, Sort};
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

/// How a BOOL is made of others; `None` for what is a condition.
fn connective(expr: &Expr) -> Option<fn(Vec<Formula>) -> Formula> {
    match expr.kind {
        ExprKind::Apply(Op::And, _) if expr.ty == Type::BOOL => Some(Formula::And),
        ExprKind::Apply(Op::Or, _) if expr.ty == Type::BOOL => Some(Formula::Or),
        ExprKind::Apply(Op::Xor, _) if expr.ty == Type::BOOL => Some(Formula::Xor),
        ExprKind::Apply(Op::Not, _) if expr.ty == Type::BOOL => Some(Formula::Not),
        _ => None,
    }
}

/// Whether a BOOL is made of others by AND, OR, XOR or NOT.
pub(crate) fn is_decision(expr: &Expr) -> bool {
    connective(expr).is_some()
}

/// The conditions of a decision, from left to right.
#[derive(Default)]
struct Conditions<'e> {
    all: Vec<&'e Expr>,
}

impl<'e> Conditions<'e> {
    fn formula(&mut self, expr: &'e Expr) -> Formula {
        if let (ExprKind::Apply(_, operands), Some(of)) = (&expr.kind, connective(expr)) {
            return of(operands.iter().map(|it| self.formula(it)).collect());
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
        let is_tests = pou.ast.kind == PouKind::Test || self.is_of_fixture(slot);
        let is_own = |files: u16| pou.ast.name.span.file < files && pou.run.is_none() && !is_tests;
        self.coverage.as_ref().is_some_and(|it| is_own(it.files))
    }

    /// Whether a POU is one of AxUnit's fixtures, or a METHOD of one.
    pub(crate) fn is_of_fixture(&self, slot: usize) -> bool {
        let is_fixture = |slot: usize| self.tests.fixtures.contains(&self.pous[slot].ast.name.span);
        is_fixture(slot) || self.pous[slot].owner.is_some_and(is_fixture)
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
            declared: None,
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

    /// What a mock adds to a body is where the POU's name is, or where a test names what runs in its place. What a chart becomes is
    /// nowhere.
    pub(crate) fn is_made_up(&self, span: Span) -> bool {
        if span.start == span.end {
            return true;
        }
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
            self.count_decision(value, Some(written.span), is_known);
        }
    }

    /// An operand of AND_THEN or OR_ELSE is a decision of its own: the second may not be evaluated.
    pub(crate) fn count_operand(&mut self, value: Option<&Expr>) {
        if let Some(value) = value.filter(|_| self.is_covered) {
            self.count_decision(value, None, false);
        }
    }

    /// `branch` is what is written, if it is the condition of a branch.
    fn count_decision(&mut self, value: &Expr, branch: Option<Span>, is_known: bool) {
        let mut conditions = Conditions::default();
        let formula = conditions.formula(value);
        let within = conditions.all;
        let is_large = within.len() > MOST_CONDITIONS;
        let (all, formula) = if is_large { (vec![value], Formula::Condition(0)) } else { (within.clone(), formula) };
        let Some(rows) = u32::try_from(all.len()).ok().filter(|it| *it > 0).map(|it| 1_i64 << it) else { return };
        let conditions: Vec<_> = all.iter().map(|it| self.condition_of(it)).collect();
        let mut key: Vec<_> = conditions.iter().map(|it| it.at).collect();
        key.extend(branch.map(|_| Location::default()));
        let at = branch.map(|it| self.at(it)).or_else(|| key.first().copied()).unwrap_or_default();
        let conditions = if is_known { Vec::new() } else { conditions };
        let kind = CoverageKind::Decision(Decision { branches: branch.is_some(), span: branch, conditions, formula });
        let counters = self.decl.counters(rows);
        let Some(field) = self.decl.counter(Sort::Decision, at, key, counters, kind) else { return };
        let kept = self.temporary("row", Type::LINT);
        self.block.push(Statement::assign(kept.clone(), row(&all, value.at), value.at));
        let row = Expr::load(kept, value.at);
        let place = counter_place(field, counters).index(row, COUNT, value.at);
        self.block.push(one_more(place, value.at));
        within.into_iter().for_each(|it| self.count_within(it));
    }

    /// Where a condition is written.
    fn condition_of(&mut self, value: &Expr) -> Condition {
        let span = self.written.get(&(value.at, self.role(value))).copied();
        Condition { at: span.map_or_else(|| start(value), |it| self.at(it)), span }
    }

    /// Notes where a BOOL is written, if it may be counted.
    pub(super) fn note_written(&mut self, written: &ast::Expr<'s>, operand: &Operand) {
        let value = operand.typed().filter(|it| self.is_covered && it.ty == Type::BOOL);
        if let (Some(value), false) = (value, matches!(written.kind, Ast::Paren(_))) {
            self.written.insert((value.at, self.role(value)), written.span);
        }
    }

    fn role(&self, value: &Expr) -> Role {
        match &value.kind {
            ExprKind::Load(Place { root: Root::Local(local), .. }) if self.locals[local.index()].name == JOINED => {
                Role::Joined
            }
            _ if is_decision(value) => Role::Decision,
            _ => Role::Condition,
        }
    }

    /// Counts the decisions inside an expression that is not a decision itself.
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
