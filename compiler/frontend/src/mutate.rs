//! Small changes of a program, each of which its tests should notice: other operators, other constants, negated
//! conditions and inputs of counters, statements left out. A change is one of the text.

use crate::ast::{
    Argument, ArgumentKind, BinaryOp, Expr, ExprKind, Item, Literal, LiteralValue, Pou, Statement, StatementKind,
    UnaryOp, each_body, each_expr,
};
use crate::spelling::Key;
use crate::testing::{fixture, suite};
use crate::{Source, Sources, Span, parse};

/// One change of the sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutant {
    /// What is replaced.
    pub span: Span,
    pub text: String,
}

/// The inputs by which blocks see edges, and are reset or loaded.
const EDGES: [&str; 9] = ["CU", "CD", "CLK", "R", "LD", "RESET", "LOAD", "S", "S1"];

/// The changes of the POUs that are not tests, in the order of the sources.
pub fn mutants(sources: &Sources) -> Vec<Mutant> {
    let mut mutants = Mutants { sources, all: Vec::new() };
    let files = sources.files().iter().zip(0u16..);
    let files: Vec<_> = files.map(|(source, number)| parse(number, &source.text, &mut Vec::new())).collect();
    let (tests, fixtures) = (suite::names(&files), fixture::places(&files));
    for item in files.iter().flat_map(|it| &it.items) {
        match item {
            Item::Pou(pou) if tests.contains(&Key(pou.name.text)) || fixtures.contains(&pou.name.span) => {}
            Item::Pou(pou) => mutants.pou(pou),
            Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
        }
    }
    mutants.all.sort_by_key(|it| (it.span.file, it.span.start, it.span.end));
    mutants.all
}

impl Mutant {
    /// The sources with this change. Places of what comes after it are others.
    pub fn apply(&self, sources: &Sources) -> Sources {
        let mut changed = Sources::default();
        for (source, number) in sources.files().iter().zip(0u16..) {
            changed.add(if number == self.span.file { self.changed(source) } else { source.clone() });
        }
        changed.refer(sources.references().iter().cloned());
        changed
    }

    fn changed(&self, source: &Source) -> Source {
        let at = |offset: u32| usize::try_from(offset).unwrap_or(usize::MAX).min(source.text.len());
        let (before, after) = (&source.text[..at(self.span.start)], &source.text[at(self.span.end)..]);
        Source::new(source.path.clone(), format!("{before}{}{after}", self.text))
    }

    /// The first line of the statement or expression as it is, and as it would be.
    pub fn lines(&self, sources: &Sources) -> [String; 2] {
        let text = &sources.get(self.span.file).text;
        let at = |offset: u32| usize::try_from(offset).unwrap_or(usize::MAX).min(text.len());
        let (start, end) = (at(self.span.start), at(self.span.end));
        let from = text[..start].rfind('\n').map_or(0, |it| it + 1);
        let to = text[end..].find('\n').map_or(text.len(), |it| end + it);
        let whole = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        [whole(&text[from..to]), whole(&format!("{}{}{}", &text[from..start], self.text, &text[end..to]))]
    }
}

struct Mutants<'t> {
    sources: &'t Sources,
    all: Vec<Mutant>,
}

impl Mutants<'_> {
    fn pou(&mut self, pou: &Pou<'_>) {
        self.body(&pou.body);
        pou.routines.iter().for_each(|it| self.body(&it.body));
    }

    fn body(&mut self, body: &[Statement<'_>]) {
        each_expr(body, &mut |it| self.expr(it));
        self.statements(body);
    }

    fn add(&mut self, span: Span, text: impl Into<String>) {
        self.all.push(Mutant { span, text: text.into() });
    }

    fn statements(&mut self, body: &[Statement<'_>]) {
        for statement in body {
            self.statement(statement);
            each_body(statement, &mut |inner| self.statements(inner));
        }
    }

    fn statement(&mut self, statement: &Statement<'_>) {
        if suite::runs_suites(statement) {
            return;
        }
        match &statement.kind {
            StatementKind::Assign { .. }
            | StatementKind::AssignAll { .. }
            | StatementKind::SetReset { .. }
            | StatementKind::SetResetAll { .. }
            | StatementKind::Bind { .. }
            | StatementKind::Attempt { .. }
            | StatementKind::Expr(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Jump(_)
            | StatementKind::Return => self.add(statement.span, ";"),
            StatementKind::If { branches, .. } => branches.iter().for_each(|it| self.negated(&it.0)),
            StatementKind::While { condition, .. } | StatementKind::ReturnIf(condition) => self.negated(condition),
            StatementKind::Repeat { until, .. } => self.negated(until),
            StatementKind::Empty
            | StatementKind::Case { .. }
            | StatementKind::For { .. }
            | StatementKind::Try(_)
            | StatementKind::Label(_)
            | StatementKind::Error => {}
        }
    }

    /// What is negated already has the negation taken away.
    fn negated(&mut self, condition: &Expr<'_>) {
        if !matches!(condition.bare().kind, ExprKind::Unary(UnaryOp::Not, _)) {
            self.add(condition.span, format!("NOT ({})", self.sources.text(condition.span)));
        }
    }

    fn expr(&mut self, expr: &Expr<'_>) {
        match &expr.kind {
            ExprKind::Binary(_, op, span) => other(*op).into_iter().for_each(|it| self.add(*span, it.text())),
            ExprKind::Unary(UnaryOp::Not, inner) => self.add(expr.span, format!("({})", self.sources.text(inner.span))),
            ExprKind::Literal(literal) => self.literal(literal, expr.span),
            ExprKind::Call(_, arguments) => arguments.iter().for_each(|it| self.argument(it)),
            ExprKind::Unary(UnaryOp::Neg | UnaryOp::Plus, _)
            | ExprKind::Name(_)
            | ExprKind::Address(_)
            | ExprKind::Member(..)
            | ExprKind::Part(..)
            | ExprKind::Index(..)
            | ExprKind::Deref(_)
            | ExprKind::Paren(_)
            | ExprKind::Assign(..)
            | ExprKind::Error(_) => {}
        }
    }

    /// A counter that sees the other edge.
    fn argument(&mut self, argument: &Argument<'_>) {
        let ArgumentKind::Input(pin, value) = &argument.kind else { return };
        if EDGES.iter().any(|it| pin.text.eq_ignore_ascii_case(it)) {
            self.negated(value);
        }
    }

    fn literal(&mut self, literal: &Literal<'_>, span: Span) {
        match &literal.value {
            LiteralValue::Bool(value) => self.add(span, if *value { "FALSE" } else { "TRUE" }),
            LiteralValue::Integer { value, .. } => {
                let prefix = literal.prefix.as_ref().map(|it| format!("{}#", it.text)).unwrap_or_default();
                let near = value.checked_add(1).or_else(|| value.checked_sub(1));
                near.into_iter().for_each(|it| self.add(span, format!("{prefix}{it}")));
                if *value > 0 {
                    self.add(span, format!("{prefix}{}", value - 1));
                }
            }
            LiteralValue::Time { .. }
            | LiteralValue::Real(_)
            | LiteralValue::String { .. }
            | LiteralValue::Enumerator(_)
            | LiteralValue::Error => {}
        }
    }
}

/// The operators that take another's place.
fn other(op: BinaryOp) -> Vec<BinaryOp> {
    match op {
        BinaryOp::Add => vec![BinaryOp::Sub],
        BinaryOp::Sub => vec![BinaryOp::Add],
        BinaryOp::Mul => vec![BinaryOp::Div],
        BinaryOp::Div => vec![BinaryOp::Mul],
        BinaryOp::Mod => vec![BinaryOp::Div],
        BinaryOp::Power => vec![BinaryOp::Mul],
        // The edge of the comparison, and its other side.
        BinaryOp::Lt => vec![BinaryOp::Le, BinaryOp::Ge],
        BinaryOp::Le => vec![BinaryOp::Lt, BinaryOp::Gt],
        BinaryOp::Gt => vec![BinaryOp::Ge, BinaryOp::Le],
        BinaryOp::Ge => vec![BinaryOp::Gt, BinaryOp::Lt],
        BinaryOp::Eq => vec![BinaryOp::Ne],
        BinaryOp::Ne => vec![BinaryOp::Eq],
        BinaryOp::And => vec![BinaryOp::Or],
        BinaryOp::Or => vec![BinaryOp::And],
        BinaryOp::Xor => vec![BinaryOp::Or],
        BinaryOp::AndThen => vec![BinaryOp::OrElse],
        BinaryOp::OrElse => vec![BinaryOp::AndThen],
    }
}
