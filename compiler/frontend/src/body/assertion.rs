//! What only a unit test has: assertions, the clock, mocks. An assertion keeps what it compares in variables
//! of the test, so that who runs it can show them, and one that fails leaves the test.

use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::expr::operator::{Sides, beside};
use crate::expr::test_words::WORDS;
use crate::index::recorder::Named;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::testing::{Assertion, CALLS, CLOCK, FAILED, MOCKED};
use crate::types::signature::pin_place;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp, ExprKind as Ast};
use staunch_ir::{
    Const, Conversion, Elementary, Expr, ExprKind, Field, FieldId, Op, Place, Retain, Root, Section, StatementKind,
    Type, Value, Variable,
};

/// The comparisons, by the end of their names after `ASSERT_`, with what they want in words, where `{}` is the right side.
const COMPARISONS: [(&str, BinaryOp, &str); 6] = [
    ("EQ", BinaryOp::Eq, "to be {}"),
    ("NEQ", BinaryOp::Ne, "to be other than {}"),
    ("GT", BinaryOp::Gt, "to be greater than {}"),
    ("LT", BinaryOp::Lt, "to be less than {}"),
    ("GE", BinaryOp::Ge, "to be at least {}"),
    ("LE", BinaryOp::Le, "to be at most {}"),
];

/// What an assertion has checked: its condition, and the variables that keep what it compared.
pub(super) struct Claim {
    pub holds: Expr,
    pub wants: &'static str,
    pub actual: Option<String>,
    pub expected: Option<String>,
    pub tolerance: Option<String>,
    pub compares_texts: bool,
}

impl Claim {
    pub fn new(holds: Expr, wants: &'static str) -> Self {
        Self { holds, wants, actual: None, expected: None, tolerance: None, compares_texts: false }
    }

    pub fn of(holds: Expr, wants: &'static str, actual: String, expected: String) -> Self {
        Self { actual: Some(actual), expected: Some(expected), ..Self::new(holds, wants) }
    }
}

/// Whether a word, or how it is written, is that of an assertion: it may end with a message.
fn is_assertion(word: &str) -> bool {
    word.starts_with("ASSERT_") || word.starts_with("MOCK_VERIFY_")
}

impl<'s> Checker<'_, 's> {
    /// A call of what only unit tests have; `None` where it is none, or a POU of the user's has its name.
    pub(super) fn test_statement(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let Ast::Name(name) = &callee.kind else { return None };
        let (word, count, form) = *WORDS.iter().find(|it| name.text.eq_ignore_ascii_case(it.0))?;
        if self.is_declared(*name) {
            return None;
        }
        if word == "MOCK" && arguments.len() > 1 {
            // Siemens AX's, after `USING AxUnit.Mocking`.
            return None;
        }
        if !self.is_test() {
            self.outside_of_a_test(*name);
            return Some(());
        }
        self.decl.log.note(name.span, || Named::Function);
        let Some(given) = self.positional(*name, arguments) else { return Some(()) };
        let made = match given.split_at_checked(count) {
            Some((values, [])) => self.test_step(word, values, None, span),
            Some((values, [message])) if is_assertion(word) => self.test_step(word, values, Some(message), span),
            Some(_) | None => {
                self.wrong_count(*name, form, span);
                None
            }
        };
        if made.is_none() {
            self.left_out.get_or_insert(span);
        }
        Some(())
    }

    /// What a word of [`WORDS`] does with as many values as it takes.
    fn test_step(
        &mut self,
        word: &str,
        values: &[&ast::Expr<'s>],
        message: Option<&ast::Expr<'s>>,
        span: Span,
    ) -> Option<()> {
        let claim = match (word, values) {
            ("MOCK", [instance]) => return self.mock(instance),
            ("MOCK_FUNCTION", [function, value]) => return self.mock_function(function, value, span),
            ("ADVANCE_TIME", [duration]) => return self.advance_time(duration, span),
            ("MOCK_VERIFY_CALLED", [instance]) => self.called_more_than(instance, span),
            ("MOCK_VERIFY_CALL_COUNT", [instance, count]) => self.call_count(instance, count, span),
            ("ASSERT_NEAR", [actual, expected, tolerance]) => self.near([actual, expected], tolerance, span),
            (_, [condition]) => self.claim_of(condition, word == "ASSERT_TRUE"),
            (_, [actual, expected]) => {
                let (_, op, wants) = *COMPARISONS.iter().find(|it| word.strip_prefix("ASSERT_") == Some(it.0))?;
                self.comparison([actual, expected], op, wants, span)
            }
            _ => None,
        };
        self.assert(claim?, message, span)
    }

    /// Whether the user has declared a variable, a POU, or a METHOD around with this name.
    fn is_declared(&self, name: ast::Name<'s>) -> bool {
        self.scope.get(name.text).is_some() || self.decl.declared(name).is_some() || self.own_routine(name).is_some()
    }

    fn outside_of_a_test(&mut self, name: ast::Name<'s>) {
        self.report(
            Diagnostic::new(Code::E0305, name.span, format!("`{}` belongs to a unit test", name.text))
                .label("it is written between TEST and END_TEST, or in SETUP"),
        );
    }

    fn wrong_count(&mut self, name: ast::Name<'s>, form: &str, span: Span) {
        let error = Diagnostic::new(Code::E0302, span, format!("wrong number of arguments for `{}`", name.text));
        let message = if is_assertion(form) { "; a message may follow" } else { "" };
        self.report(error.help(format!("write `{form}`{message}")));
    }

    fn positional<'a>(
        &mut self,
        name: ast::Name<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<Vec<&'a ast::Expr<'s>>> {
        let mut values = Vec::new();
        for argument in arguments {
            let ArgumentKind::Positional(value) = &argument.kind else {
                self.report(
                    Diagnostic::new(Code::E0301, argument.span, format!("`{}` has no named parameters", name.text))
                        .label("write the value alone"),
                );
                self.left_out.get_or_insert(argument.span);
                return None;
            };
            values.push(value);
        }
        Some(values)
    }

    /// Leaves the test, with the number of the assertion and what it compared, unless the claim holds.
    pub(super) fn assert(&mut self, claim: Claim, message: Option<&ast::Expr<'s>>, span: Span) -> Option<()> {
        let slot = self.test_slot()?;
        let at = self.at(span);
        let number = self.decl.tests.assertions.entry(slot).or_default().len() + 1;
        let failed = self.scope.get(FAILED)?.place.clone();
        let holds = Expr::apply(Op::Not, Type::BOOL, vec![claim.holds], at);
        let mut shown = None;
        let then = self.nested(|this| {
            if let Some(message) = message {
                shown = this.operand(message, None).and_then(|it| {
                    let text = this.materialise(it, None, message.span)?;
                    this.keep("message", text, message.span).map(|it| it.1)
                });
            }
            let value = i32::try_from(number).unwrap_or(i32::MAX);
            this.assign(failed, Expr::constant(Elementary::Dint, Value::I32(value), at), span);
            this.push(StatementKind::Return, span);
        });
        self.push(StatementKind::If { condition: holds, then, otherwise: Vec::new() }, span);
        let Claim { wants, actual, expected, tolerance, compares_texts, .. } = claim;
        self.decl.tests.assertions.entry(slot).or_default().push(Assertion {
            span,
            wants,
            compares_texts,
            actual,
            expected,
            tolerance,
            message: shown,
        });
        Some(())
    }

    pub(super) fn claim_of(&mut self, condition: &ast::Expr<'s>, wanted: bool) -> Option<Claim> {
        let value = self.condition(condition)?;
        let at = value.at;
        let holds = if wanted { value } else { Expr::apply(Op::Not, Type::BOOL, vec![value], at) };
        let wants = if wanted { "to be TRUE" } else { "to be FALSE" };
        Some(Claim::new(holds, wants))
    }

    pub(super) fn comparison(
        &mut self,
        [left, right]: [&ast::Expr<'s>; 2],
        op: BinaryOp,
        wants: &'static str,
        span: Span,
    ) -> Option<Claim> {
        let sides = self.sides([left, right], op, span)?;
        self.comparison_of(sides, [left, right], wants)
    }

    pub(super) fn comparison_of(
        &mut self,
        sides: Sides,
        [left, right]: [&ast::Expr<'s>; 2],
        wants: &'static str,
    ) -> Option<Claim> {
        let (op, span) = (sides.op, sides.span);
        if let (Some(Type::String(_)), Some(Type::String(_))) = (sides.a.ty(), sides.b.ty()) {
            let (Operand::Typed(a), Operand::Typed(b)) = (sides.a, sides.b) else { return None };
            let (a, actual) = self.keep("actual", a, left.span)?;
            let (b, expected) = self.keep("expected", b, right.span)?;
            let holds = self.compare_texts(crate::expr::operator::comparison(op), a, b, span)?;
            return Some(Claim { compares_texts: true, ..Claim::of(holds, wants, actual, expected) });
        }
        let constants = [sides.a.clone(), sides.b.clone()];
        let are_references = matches!(sides.a.ty(), Some(Type::Reference(_)));
        let compared = self.combine(sides)?.typed()?.clone();
        if are_references {
            // Which objects they are, no number says.
            let wants = if op == BinaryOp::Eq { "to refer to the same object" } else { "to refer to another object" };
            return Some(Claim::new(compared, wants));
        }
        let ExprKind::Apply(op, operands) = compared.kind else {
            let [actual, expected] = self.keep_constants(constants, [left, right])?;
            return Some(Claim::of(compared, wants, actual, expected));
        };
        let [a, b] = <[Expr; 2]>::try_from(operands).ok()?;
        let (a, actual) = self.keep("actual", a, left.span)?;
        let (b, expected) = self.keep("expected", b, right.span)?;
        let holds = Expr::new(compared.ty, ExprKind::Apply(op, vec![a, b]), compared.at);
        Some(Claim::of(holds, wants, actual, expected))
    }

    pub(super) fn sides(&mut self, [left, right]: [&ast::Expr<'s>; 2], op: BinaryOp, span: Span) -> Option<Sides> {
        let mut a = self.operand(left, None)?;
        let hint = beside(&a, None);
        let b = self.after(a.typed_mut().as_mut_slice(), |this| this.operand(right, hint))?;
        Some(Sides { a, b, left: left.span, right: right.span, op, op_span: span, span, hint: None })
    }

    /// The names of what keeps two constants, whose comparison is known.
    pub(super) fn keep_constants(&mut self, constants: [Operand; 2], both: [&ast::Expr<'s>; 2]) -> Option<[String; 2]> {
        let [actual, expected] = constants;
        let [left, right] = both.map(|it| it.span);
        let actual = self.materialise(actual, None, left)?;
        let expected = self.materialise(expected, None, right)?;
        Some([self.keep("actual", actual, left)?.1, self.keep("expected", expected, right)?.1])
    }

    /// The value in a new variable of the test, and the variable's name.
    pub(super) fn keep(&mut self, what: &str, value: Expr, span: Span) -> Option<(Expr, String)> {
        if !self.is_test() {
            return Some(self.note(what, value));
        }
        let slot = self.test_slot()?;
        let state = self.signature.as_ref()?.state?;
        let at = self.at(span);
        let ty = value.ty;
        let fields = &mut self.decl.program.structs[state.index()].fields;
        let id = FieldId::next(fields.len());
        let name = format!("__{what}_{}", fields.len());
        fields.push(Field {
            name: name.clone(),
            ty,
            initial: Const::Zero,
            section: Section::Internal,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: None,
            location: at,
            declared: None,
        });
        let place = Place::root(Root::Instance, Type::Struct(state)).field(id, ty);
        let variable = Variable { name: name.clone(), section: Section::Internal, place: place.clone(), view: None };
        self.decl.tests.kept.entry(slot).or_default().push(variable);
        self.assign(place.clone(), value, span);
        Some((Expr::load(place, at), name))
    }

    /// A TIME, or a number of nanoseconds.
    fn advance_time(&mut self, duration: &ast::Expr<'s>, span: Span) -> Option<()> {
        let operand = self.operand(duration, None)?;
        let time = Type::Elementary(Elementary::Time);
        let value = match operand.ty() {
            Some(Type::Elementary(it)) if it.is_time() => self.coerce(operand, time, duration.span)?,
            _ => {
                let number = self.coerce(operand, Type::Elementary(Elementary::Lint), duration.span)?;
                self.convert(Conversion::Same, time, number)
            }
        };
        let value = self.time_to_come(value, duration.span)?;
        let clock = ast::Name { text: CLOCK, span };
        let clock = ast::Expr { kind: Ast::Name(clock), span };
        let place = self.place(&clock)?.place;
        let Type::Block(block) = place.ty else { return None };
        self.assign(pin_place(place, block, "IN"), value, span);
        self.instance_call(&clock, &[], span)
    }

    /// Time does not go back: a constant that would is refused, and a value fails the test.
    fn time_to_come(&mut self, duration: Expr, span: Span) -> Option<Expr> {
        if let Some(value) = duration.as_const() {
            if matches!(value, Value::I64(it) if it < 0) {
                self.report(
                    Diagnostic::new(Code::E0202, span, "time cannot go backwards")
                        .label("this duration is negative")
                        .help("write how much time passes: `ADVANCE_TIME(T#100ms)`"),
                );
                return None;
            }
            return Some(duration);
        }
        let (time, at) = (Type::Elementary(Elementary::Time), self.at(span));
        let (duration, actual) = self.keep("actual", duration, span)?;
        let none = Expr::constant(Elementary::Time, Value::I64(0), at);
        let holds = self.apply(Op::Ge, time, vec![duration.clone(), none], Type::BOOL, span)?;
        let claim =
            Claim { actual: Some(actual), ..Claim::new(holds, "not to be negative, since time cannot go backwards") };
        self.assert(claim, None, span)?;
        Some(duration)
    }

    /// A hidden variable of a FUNCTION_BLOCK's instance.
    fn hidden_member(&mut self, instance: &ast::Expr<'s>, member: &str) -> Option<Place> {
        let found = self.place(instance)?;
        let field = match found.place.ty {
            Type::Struct(id) if self.decl.is_instance(id) => {
                let fields = &self.decl.program.structure(id).fields;
                fields.iter().position(|it| it.name == member).map(|at| (FieldId::next(at), fields[at].ty))
            }
            Type::Struct(_) | Type::Block(_) | Type::Array(_) => None,
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => None,
        };
        if field.is_none() {
            let text = self.decl.log.sources.text(instance.span).to_owned();
            let ty = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(Code::E0316, instance.span, format!("`{text}` cannot be replaced by a mock"))
                    .label(format!("it is {}", crate::diagnostic::wording::article(&ty)))
                    .help("only an instance of a FUNCTION_BLOCK that the sources declare can be mocked"),
            );
        }
        let (field, ty) = field?;
        Some(found.place.field(field, ty))
    }

    fn mock(&mut self, instance: &ast::Expr<'s>) -> Option<()> {
        let mocked = self.hidden_member(instance, MOCKED)?;
        let at = self.at(instance.span);
        self.assign(mocked, Expr::bool(true, at), instance.span);
        Some(())
    }

    /// How often a mocked instance, or a FUNCTION that is replaced, was called.
    fn calls(&mut self, mocked: &ast::Expr<'s>) -> Option<(Expr, String)> {
        let (at, span) = (self.at(mocked.span), mocked.span);
        let dint = Type::Elementary(Elementary::Dint);
        let path = mocked.path().unwrap_or_default();
        let of_functions = if path.is_empty() { Vec::new() } else { self.decl.mocks_of(&path) };
        if !of_functions.is_empty() {
            self.decl.note_path(&path, &self.decl.lookup(&path, Sense::Callee));
        }
        let mut counts = of_functions.into_iter().map(|it| Expr::load(it.calls, at));
        let mut total = match counts.next() {
            Some(first) => first,
            None if !path.is_empty() && self.names_function(&path) => return self.not_replaced(span),
            None => Expr::load(self.hidden_member(mocked, CALLS)?, at),
        };
        for count in counts {
            total = self.apply(Op::Add, dint, vec![total, count], dint, span)?;
        }
        self.keep("actual", total, span)
    }

    fn names_function(&self, path: &[ast::Name<'s>]) -> bool {
        let Found::One(Meaning::Declared(Entry::Pou(slot))) = self.decl.lookup(path, Sense::Callee) else {
            return false;
        };
        self.decl.pous[slot].ast.kind == ast::PouKind::Function
    }

    /// Reports a FUNCTION of which no call is counted.
    fn not_replaced<T>(&mut self, span: Span) -> Option<T> {
        let name = self.decl.log.sources.text(span).to_owned();
        self.report(
            Diagnostic::new(Code::E0316, span, format!("calls of the FUNCTION `{name}` are not counted"))
                .label("it is not mocked in any test")
                .help(format!("replace it first: `MOCK_FUNCTION {name} RETURNS value;`")),
        );
        None
    }

    /// `calls := calls + 1`
    fn count_call(&mut self, calls: &Place, span: Span) {
        let (at, dint) = (self.at(span), calls.ty);
        let one = Expr::constant(Elementary::Dint, Value::I32(1), at);
        let more = self.apply(Op::Add, dint, vec![Expr::load(calls.clone(), at), one], dint, span);
        if let Some(more) = more {
            self.assign(calls.clone(), more, span);
        }
    }

    fn called_more_than(&mut self, instance: &ast::Expr<'s>, span: Span) -> Option<Claim> {
        let (calls, actual) = self.calls(instance)?;
        let at = self.at(span);
        let zero = Expr::constant(Elementary::Dint, Value::I32(0), at);
        let holds = self.apply(Op::Gt, Type::Elementary(Elementary::Dint), vec![calls, zero], Type::BOOL, span)?;
        Some(Claim { actual: Some(actual), ..Claim::new(holds, "at least one call") })
    }

    fn call_count(&mut self, instance: &ast::Expr<'s>, count: &ast::Expr<'s>, span: Span) -> Option<Claim> {
        let (calls, actual) = self.calls(instance)?;
        let dint = Type::Elementary(Elementary::Dint);
        let wanted = self.value(count, dint)?;
        let (wanted, expected) = self.keep("expected", wanted, count.span)?;
        let holds = self.apply(Op::Eq, dint, vec![calls, wanted], Type::BOOL, span)?;
        Some(Claim::of(holds, "{} calls", actual, expected))
    }

    fn mock_function(&mut self, function: &ast::Expr<'s>, value: &ast::Expr<'s>, span: Span) -> Option<()> {
        let Some(path) = function.path() else {
            self.report(Diagnostic::new(Code::E0316, function.span, "the name of a FUNCTION is expected here"));
            return None;
        };
        let mocks = self.decl.mocks_of(&path);
        self.decl.note_path(&path, &self.decl.lookup(&path, Sense::Callee));
        if mocks.is_empty() {
            let name = self.decl.log.sources.text(function.span).to_owned();
            self.report(
                Diagnostic::new(Code::E0316, function.span, format!("`{name}` cannot be replaced by a mock"))
                    .label("only a FUNCTION with a result that the sources declare can be mocked"),
            );
            return None;
        }
        let at = self.at(span);
        for mock in mocks {
            let value = self.value(value, mock.value.ty)?;
            self.assign(mock.value, value, span);
            self.assign(mock.active, Expr::bool(true, at), span);
        }
        Some(())
    }

    /// Before the body of a FUNCTION that some test replaces.
    pub(super) fn mocked_result(&mut self, slot: usize, span: Span) {
        let Some(mock) = self.decl.tests.mocks.get(&slot).cloned() else { return };
        let result = self.signature.as_ref().and_then(|it| it.result.as_ref()).map(|it| it.0);
        let Some(result) = result else { return };
        let at = self.at(span);
        let then = self.nested(|this| {
            let ty = mock.value.ty;
            this.count_call(&mock.calls, span);
            this.assign(Place::root(Root::Local(result), ty), Expr::load(mock.value, at), span);
            this.push(StatementKind::Return, span);
        });
        self.push(StatementKind::If { condition: Expr::load(mock.active, at), then, otherwise: Vec::new() }, span);
    }
}
