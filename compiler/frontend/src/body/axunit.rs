//! The assertions of AxUnit, as overloads that are a part of the compiler. One that fails does not end its test: the
//! first one of a test is reported, with what it compared.

use super::assertion::Claim;
use crate::expr::checker::Checker;
use crate::index::recorder::Named;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::Key;
use crate::testing::exchange;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp};
use rustc_hash::FxHashSet;
use staunch_ir::{Elementary, Expr, Op, Type, Value};
use std::sync::LazyLock;

/// What an assertion compares: its parameters, and how. The first parameter is on the left of the operator.
struct Comparison {
    name: &'static str,
    parameters: [&'static str; 2],
    op: BinaryOp,
    wants: &'static str,
}

const COMPARISONS: [Comparison; 6] = [
    of("AxUnit.Assert.Equal", ["expected", "actual"], BinaryOp::Eq, "to be {}"),
    of("AxUnit.Assert.NotEqual", ["expected", "actual"], BinaryOp::Ne, "to be other than {}"),
    of("AxUnit.Assert.LessThan", ["left", "right"], BinaryOp::Lt, "to be less than {}"),
    of("AxUnit.Assert.GreaterThan", ["left", "right"], BinaryOp::Gt, "to be greater than {}"),
    of("AxUnit.Assert.LessOrEqual", ["left", "right"], BinaryOp::Le, "to be at most {}"),
    of("AxUnit.Assert.GreaterOrEqual", ["left", "right"], BinaryOp::Ge, "to be at least {}"),
];
/// What an assertion of a project's own says to AxUnit.
const SUCCEED: &str = "AxUnit.ResultFunctions.axunit_Succeed";
const FAIL: &str = "AxUnit.ResultFunctions.axunit_Fail";
/// Lets something run in place of another.
const MOCK: &str = "AxUnit.Mocking.Mock";
/// The last parts of all these: most calls are of none.
static NAMES: LazyLock<FxHashSet<Key<'static>>> = LazyLock::new(|| {
    let all = COMPARISONS.iter().map(|it| it.name).chain([SUCCEED, FAIL, MOCK]);
    all.filter_map(|it| it.rsplit('.').next()).map(Key).collect()
});
/// Where these are declared.
const LIBRARIES: [&str; 2] = ["library/axunit.st", "library/axunit.mocking.st"];

const fn of(name: &'static str, parameters: [&'static str; 2], op: BinaryOp, wants: &'static str) -> Comparison {
    Comparison { name, parameters, op, wants }
}

impl<'s> Checker<'_, 's> {
    /// A call of one of AxUnit's own FUNCTIONs; `None` where it is none.
    pub(super) fn axunit_statement(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let slot = self.axunit_callee(callee)?;
        let Some(slot) = self.meant(slot, callee.span, arguments, None) else {
            self.check_arguments(arguments);
            self.left_out.get_or_insert(span);
            return Some(());
        };
        if let Some(path) = callee.path() {
            self.decl.note_path(&path, &Found::One(Meaning::Declared(Entry::Pou(slot))));
        }
        let name = self.decl.pous[slot].ast.name;
        let source = self.decl.log.sources.get(name.span.file);
        if !LIBRARIES.iter().any(|it| source.is_unit(it)) {
            return None;
        }
        let in_full = self.decl.name_in_full(name);
        let called = ast::Name { text: name.text, span: callee.span };
        let made = match COMPARISONS.iter().find(|it| it.name == in_full) {
            Some(comparison) => self.axunit_comparison(comparison, called, arguments, span),
            None if in_full == SUCCEED => return Some(()),
            None if in_full == FAIL => self.axunit_failure(called, arguments, span),
            None if in_full == MOCK => self.axunit_mock(called, arguments, span),
            None => return None,
        };
        if made.is_none() {
            self.compared.clear();
            self.left_out.get_or_insert(span);
        }
        Some(())
    }

    /// The FUNCTION, found by the first one with its name, which may be a project's own.
    fn axunit_callee(&self, callee: &ast::Expr<'s>) -> Option<usize> {
        let (ast::ExprKind::Name(last) | ast::ExprKind::Member(_, last)) = &callee.kind else { return None };
        if !NAMES.contains(&Key(last.text)) {
            return None;
        }
        let path = callee.path()?;
        let first = path[0];
        if self.scope.get(first.text).is_some() || path.len() == 1 && self.own_routine(first).is_some() {
            return None;
        }
        match self.decl.lookup(&path, Sense::Callee) {
            Found::One(Meaning::Declared(Entry::Pou(slot))) => {
                let name = self.decl.pous[slot].ast.name;
                let is_function = self.decl.pous[slot].ast.kind == ast::PouKind::Function;
                (is_function && self.decl.name_in_full(name).starts_with("AxUnit.")).then_some(slot)
            }
            Found::One(_) | Found::Several(_) | Found::Nothing => None,
        }
    }

    fn axunit_comparison(
        &mut self,
        comparison: &Comparison,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let Comparison { parameters, op, wants, .. } = *comparison;
        let [Some(first), Some(second)] = self.axunit_arguments(name, parameters, arguments, span)? else {
            return self.wrong_arguments(name, &parameters, span);
        };
        let claim = self.comparison([first, second], op, wants, span)?;
        // `Equal(expected, actual)` has what is wanted first.
        let is_swapped = parameters[0] == "expected";
        let (actual, expected) =
            if is_swapped { (claim.expected, claim.actual) } else { (claim.actual, claim.expected) };
        self.assert_in_fixture(Claim { actual, expected, ..claim }, None, span)
    }

    /// `axunit_Fail(message, file, line)`, by an assertion of the project's: the place of its call is what is wanted.
    fn axunit_failure(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>], span: Span) -> Option<()> {
        let parameters = ["message", "file", "line"];
        let [message, file, line] = self.axunit_arguments(name, parameters, arguments, span)?;
        let Some(message) = message else { return self.wrong_arguments(name, &parameters, span) };
        if let Some(file) = file {
            self.operand(file, None)?;
        }
        let at = self.at(span);
        let fails = Expr::constant(Elementary::Bool, Value::Bool(false), at);
        let mut claim = Claim::new(fails, "to succeed");
        if let Some(line) = line {
            let value = self.value(line, Type::Elementary(Elementary::Dint))?;
            claim.wants = "to succeed, where line {} calls it";
            claim.expected = Some(self.keep("expected", value, line.span)?.1);
        }
        self.assert_in_fixture(claim, Some(message), span)
    }

    /// What is given for each parameter.
    /// `Mock(NAME_OF(A), NAME_OF(B), payload)`: a call of what changes the number of what runs in place of A.
    fn axunit_mock(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>], span: Span) -> Option<()> {
        let parameters = ["mockeeFn", "mockFn", "payload"];
        let [Some(mockee), Some(mock), payload] = self.axunit_arguments(name, parameters, arguments, span)? else {
            return self.wrong_arguments(name, &parameters, span);
        };
        let (a, b) = (self.exchangeable(mockee)?, self.exchangeable(mock)?);
        if !self.decl.log.options.tests {
            return payload.map_or(Some(()), |it| self.operand(it, None).map(drop));
        }
        let places = (self.decl.pous[a].ast.name.span, self.decl.pous[b].ast.name.span);
        let Some((exchanged, which)) = self.decl.tests.exchanged.numbers.get(&places).copied() else {
            let [a, b] = [a, b].map(|it| self.decl.name_in_full(self.decl.pous[it].ast.name));
            self.report(
                Diagnostic::new(Code::E0316, mock.span, format!("`{b}` cannot run in place of `{a}`"))
                    .label("expected a FUNCTION for a FUNCTION, or a FUNCTION_BLOCK for one, with the same parameters")
                    .help("METHODs, and FUNCTION_BLOCKs that EXTEND others or are extended, cannot be replaced yet"),
            );
            return None;
        };
        let argument = |it: ast::Expr<'s>| ast::Argument { span: it.span, kind: ArgumentKind::Positional(it) };
        let numbers = [exchanged, which].map(|it| exchange::number(it, span));
        let given: Vec<_> = numbers.into_iter().chain(payload.cloned()).map(argument).collect();
        let callee = exchange::function(if payload.is_some() { exchange::WITH } else { exchange::ALONE }, span);
        let kind = ast::ExprKind::Call(Box::new(callee.clone()), given.clone());
        self.call_statement(&ast::Expr { kind, span }, &callee, &given);
        Some(())
    }

    /// The slot of the FUNCTION or FUNCTION_BLOCK that `NAME_OF(A)`, or a text with its name, means.
    fn exchangeable(&mut self, expr: &ast::Expr<'s>) -> Option<usize> {
        let path = exchange::names(expr, self.decl.log.sources).unwrap_or_default();
        let found = [Sense::Callee, Sense::Type].into_iter().find_map(|sense| match self.decl.lookup(&path, sense) {
            found @ Found::One(Meaning::Declared(Entry::Pou(slot))) => {
                self.decl.note_path(&path, &found);
                Some(slot)
            }
            Found::One(_) | Found::Several(_) | Found::Nothing => None,
        });
        if found.is_none() {
            let text = self.decl.log.sources.text(expr.span).to_owned();
            self.report(
                Diagnostic::new(Code::E0316, expr.span, format!("`{text}` does not name a FUNCTION or FUNCTION_BLOCK"))
                    .label("expected the name of the POU to replace, or of its replacement")
                    .help("write `NAME_OF(Name)`, or its name in full, `'Space.Name'`"),
            );
        }
        found
    }

    fn axunit_arguments<'a, const N: usize>(
        &mut self,
        name: ast::Name<'s>,
        parameters: [&str; N],
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<[Option<&'a ast::Expr<'s>>; N]> {
        let mut given = [None; N];
        for (at, argument) in arguments.iter().enumerate() {
            let (at, value) = match &argument.kind {
                ArgumentKind::Positional(value) => (at, value),
                ArgumentKind::Input(word, value) => {
                    let Some(at) = parameters.iter().position(|it| it.eq_ignore_ascii_case(word.text)) else {
                        let message = format!("`{}` has no parameter `{}`", name.text, word.text);
                        let names = format!("its parameters are {}", parameters.join(", "));
                        self.report(Diagnostic::new(Code::E0301, word.span, message).label(names));
                        return None;
                    };
                    self.decl.log.note(word.span, || Named::Parameter);
                    (at, value)
                }
                ArgumentKind::Output { .. } => return self.wrong_arguments(name, &parameters, span),
            };
            match given.get_mut(at) {
                Some(place) if place.is_none() => *place = Some(value),
                Some(_) | None => return self.wrong_arguments(name, &parameters, span),
            }
        }
        Some(given)
    }

    fn wrong_arguments<T>(&mut self, name: ast::Name<'s>, parameters: &[&str], span: Span) -> Option<T> {
        let error = Diagnostic::new(Code::E0302, span, format!("wrong arguments for `{}`", name.text));
        let named: Vec<_> = parameters.iter().map(|it| format!("{it} := …")).collect();
        self.report(error.help(format!("write `{}({})`", name.text, named.join(", "))));
        None
    }

    /// Notes the first assertion that fails; the test continues.
    fn assert_in_fixture(&mut self, claim: Claim, message: Option<&ast::Expr<'s>>, span: Span) -> Option<()> {
        if self.is_test() {
            return self.assert(claim, message, span);
        }
        if !self.decl.log.options.tests {
            // Nothing runs it: it is checked alone.
            self.compared.clear();
            return message.map_or(Some(()), |it| self.operand(it, None).map(drop));
        }
        let at = self.at(span);
        let none = Expr::constant(Elementary::Dint, Value::I32(0), at);
        let broken = Expr::load(self.broken(at), at);
        let is_first = self.apply(Op::Eq, Type::Elementary(Elementary::Dint), vec![broken, none], Type::BOOL, span);
        self.assert_shared(claim, message, |_| is_first, span)
    }
}
