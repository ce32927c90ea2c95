//! The assertions of TcUnit's suites. One that fails does not end its test: the first one of a test is reported, with
//! what it compared. The rest of TcUnit is Structured Text, in the library.

use super::assertion::Claim;
use super::near::WITHIN;
use crate::expr::any_input::class_of;
use crate::expr::checker::Checker;
use crate::expr::method::is_this;
use crate::expr::operand::Operand;
use crate::index::recorder::Named;
use crate::inherit::is_super;
use crate::testing::Assertion;
use crate::testing::suite::{FAILS, LIBRARY};
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp, ExprKind as Ast};
use staunch_ir::{
    Chars, Const, Elementary, Expr, ExprKind, Field, FieldId, Op, Place, Retain, Root, Section, StatementKind,
    StringType, Type, Value,
};

/// What an assertion compares.
#[derive(Clone, Copy, Debug)]
enum Compared<'n> {
    Condition(bool),
    /// `AssertEquals`
    Any,
    Texts,
    Values(Elementary),
    Reals(Elementary),
    /// The METHOD of the suite that compares them, and whether it takes a distance.
    Arrays {
        dimensions: &'static str,
        element: &'n str,
        is_real: bool,
    },
}

impl<'n> Compared<'n> {
    fn named(name: &'n str) -> Option<Self> {
        let is = |word: &str| name.eq_ignore_ascii_case(word);
        if is("AssertTrue") || is("AssertFalse") {
            return Some(Self::Condition(is("AssertTrue")));
        }
        if is("AssertEquals") {
            return Some(Self::Any);
        }
        if is("AssertEquals_STRING") || is("AssertEquals_WSTRING") {
            return Some(Self::Texts);
        }
        let (before, ty) = name.split_once('_')?;
        let is = |word: &str| before.eq_ignore_ascii_case(word);
        let element = Elementary::named(ty);
        let is_real = matches!(element, Some(Elementary::Real | Elementary::Lreal));
        if is("AssertEquals") {
            return element.map(|it| if is_real { Self::Reals(it) } else { Self::Values(it) });
        }
        let dimensions = [("AssertArrayEquals", ""), ("AssertArray2dEquals", "2"), ("AssertArray3dEquals", "3")];
        let (_, dimensions) = dimensions.into_iter().find(|it| is(it.0))?;
        let is_known = element.is_some_and(|it| !it.is_time()) && (is_real || dimensions.is_empty());
        is_known.then_some(Self::Arrays { dimensions, element: ty, is_real })
    }

    /// The parameters before the message, in order.
    fn parameters(self) -> &'static [&'static str] {
        match self {
            Self::Condition(_) => &["Condition"],
            Self::Any | Self::Texts | Self::Values(_) => &["Expected", "Actual"],
            Self::Reals(_) => &["Expected", "Actual", "Delta"],
            Self::Arrays { is_real: false, .. } => &["Expecteds", "Actuals"],
            Self::Arrays { is_real: true, .. } => &["Expecteds", "Actuals", "Delta"],
        }
    }
}

impl<'s> Checker<'_, 's> {
    /// A call of what only a suite has; `None` where it is none.
    pub(super) fn suite_statement(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        if !self.is_suite() {
            return None;
        }
        let name = match &callee.kind {
            Ast::Name(name) => *name,
            Ast::Member(base, name) if is_own(base) => *name,
            _ => return None,
        };
        let compared = Compared::named(name.text)?;
        if self.assertion_of_suite(name, compared, arguments, span).is_none() {
            self.compared.clear();
            self.left_out.get_or_insert(span);
        }
        Some(())
    }

    fn assertion_of_suite(
        &mut self,
        name: ast::Name<'s>,
        compared: Compared<'_>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let given = self.given(name, compared.parameters(), arguments, span)?;
        let (values, message) = given.split_at(compared.parameters().len());
        let values: Vec<&ast::Expr<'s>> = values.iter().copied().flatten().collect();
        let claim = match (compared, &values[..]) {
            (Compared::Condition(wanted), [condition]) => self.claim_of(condition, wanted),
            (Compared::Any, [expected, actual]) => self.equal_of_any([expected, actual], span),
            (Compared::Texts, [expected, actual]) => {
                let claim = self.comparison([expected, actual], BinaryOp::Eq, "to be {}", span)?;
                let (actual, expected) = (claim.expected, claim.actual);
                Some(Claim { actual, expected, ..claim })
            }
            (Compared::Values(ty), [expected, actual]) => self.equal(ty, [expected, actual], span),
            (Compared::Reals(ty), [expected, actual, delta]) => self.within(ty, [expected, actual, delta], span),
            (Compared::Arrays { dimensions, element, .. }, _) => {
                let differ = format!("__ARRAYS{dimensions}_{}", element.to_ascii_uppercase());
                self.equal_arrays(&differ, &values, span)
            }
            (
                Compared::Condition(_) | Compared::Any | Compared::Texts | Compared::Values(_) | Compared::Reals(_),
                _,
            ) => None,
        }?;
        self.assert_in_suite(claim, message.first().copied().flatten(), span)
    }

    /// The arguments in the order of the parameters, the message last.
    fn given<'a>(
        &mut self,
        name: ast::Name<'s>,
        parameters: &[&str],
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<Vec<Option<&'a ast::Expr<'s>>>> {
        let mut given = vec![None; parameters.len() + 1];
        for (at, argument) in arguments.iter().enumerate() {
            let (at, value) = match &argument.kind {
                ArgumentKind::Positional(value) => (at, value),
                ArgumentKind::Input(word, value) => (self.place_of_parameter(name, parameters, *word)?, value),
                ArgumentKind::Output { .. } => return self.wrong_assertion(name, parameters, span),
            };
            match given.get_mut(at) {
                Some(place) if place.is_none() => *place = Some(value),
                Some(_) | None => return self.wrong_assertion(name, parameters, span),
            }
        }
        if given[..parameters.len()].iter().any(Option::is_none) {
            return self.wrong_assertion(name, parameters, span);
        }
        Some(given)
    }

    /// The place of a parameter.
    fn place_of_parameter(&mut self, name: ast::Name<'s>, parameters: &[&str], word: ast::Name<'s>) -> Option<usize> {
        let at = parameters.iter().chain(&["Message"]).position(|it| it.eq_ignore_ascii_case(word.text));
        self.decl.log.note(word.span, || Named::Parameter);
        if at.is_none() {
            let message = format!("`{}` has no parameter `{}`", name.text, word.text);
            let names = format!("its parameters are {}, Message", parameters.join(", "));
            self.report(Diagnostic::new(Code::E0301, word.span, message).label(names));
        }
        at
    }

    fn wrong_assertion<T>(&mut self, name: ast::Name<'s>, parameters: &[&str], span: Span) -> Option<T> {
        let error = Diagnostic::new(Code::E0302, span, format!("wrong arguments for `{}`", name.text));
        self.report(error.help(format!("write `{}({}, Message)`", name.text, parameters.join(", "))));
        None
    }

    /// `AssertEquals`: of two classes of types, the values are not looked at.
    fn equal_of_any(&mut self, both: [&ast::Expr<'s>; 2], span: Span) -> Option<Claim> {
        let mut sides = self.sides(both, BinaryOp::Eq, span)?;
        let [expected, actual] = both;
        let classes = [self.class_of(expected, &sides.a), self.class_of(actual, &sides.b)];
        if let [Some(expected), Some(actual)] = classes
            && expected != actual
        {
            // What is evaluated for its effects, and may fault, is so.
            for value in [sides.a.typed_mut(), sides.b.typed_mut()].into_iter().flatten() {
                match &mut value.kind {
                    // Nothing is copied that holds an instance.
                    ExprKind::Load(place) if self.decl.instance_in(value.ty).is_some() => self.fix(place),
                    _ => self.save("compared", value),
                }
            }
            return self.other_classes([expected, actual], span);
        }
        if Self::is_made_of_others(&sides.a) || Self::is_made_of_others(&sides.b) {
            return self.equal_wholes([sides.a, sides.b], both, span);
        }
        let claim = self.comparison_of(sides, both, "to be {}")?;
        let (actual, expected) = (claim.expected, claim.actual);
        Some(Claim { actual, expected, ..claim })
    }

    /// The class that is handed on of an argument. What a literal without a type has of it, and what is computed of
    /// numbers, is that of the other side.
    fn class_of(&self, written: &ast::Expr<'s>, value: &Operand) -> Option<&'static str> {
        if let Some(ty) = self.static_type(written) {
            return Some(class_of(ty).1);
        }
        let ty = value.ty()?;
        let is_computed = matches!(written.bare().kind, Ast::Unary(..) | Ast::Binary(..));
        let is_number = matches!(ty, Type::Elementary(it) if it != Elementary::Bool && !it.is_time());
        (!is_computed || !is_number).then_some(class_of(ty).1)
    }

    fn other_classes(&mut self, classes: [&'static str; 2], span: Span) -> Option<Claim> {
        let at = self.at(span);
        let [expected, actual] = classes.map(|it| {
            let text = format!("(Type class = {it})").into_bytes();
            let ty = Type::String(StringType { wide: false, capacity: u16::try_from(text.len()).unwrap_or(u16::MAX) });
            Expr::new(ty, ExprKind::Text(Chars::Narrow(text)), at)
        });
        let (expected, actual) = (self.keep("expected", expected, span)?.1, self.keep("actual", actual, span)?.1);
        Some(Claim::of(Expr::bool(false, at), "{}", actual, expected))
    }

    /// Two values of a type, each of which becomes that type as an input does.
    fn values_of(&mut self, ty: Type, [expected, actual]: [&ast::Expr<'s>; 2]) -> Option<[(Expr, String); 2]> {
        let mut first = self.value(expected, ty)?;
        let second = self.after(&mut [&mut first], |this| this.value(actual, ty))?;
        Some([self.keep("expected", first, expected.span)?, self.keep("actual", second, actual.span)?])
    }

    fn equal(&mut self, ty: Elementary, both: [&ast::Expr<'s>; 2], span: Span) -> Option<Claim> {
        let ty = Type::Elementary(ty);
        let [(a, expected), (b, actual)] = self.values_of(ty, both)?;
        let holds = self.apply(Op::Eq, ty, vec![a, b], Type::BOOL, span)?;
        Some(Claim::of(holds, "to be {}", actual, expected))
    }

    /// `expected = actual OR ABS(expected - actual) <= delta`: what is not a number is near nothing, and infinity is itself.
    fn within(&mut self, ty: Elementary, [expected, actual, delta]: [&ast::Expr<'s>; 3], span: Span) -> Option<Claim> {
        let ty = Type::Elementary(ty);
        let [(a, wanted), (b, found)] = self.values_of(ty, [expected, actual])?;
        let limit = self.value(delta, ty)?;
        let (limit, tolerance) = self.keep("tolerance", limit, delta.span)?;
        let is_same = self.apply(Op::Eq, ty, vec![a.clone(), b.clone()], Type::BOOL, span)?;
        let difference = self.apply(Op::Sub, ty, vec![a, b], ty, span)?;
        let distance = self.apply(Op::Abs, ty, vec![difference], ty, span)?;
        let is_near = self.apply(Op::Le, ty, vec![distance, limit], Type::BOOL, span)?;
        let holds = self.apply(Op::Or, Type::BOOL, vec![is_same, is_near], Type::BOOL, span)?;
        Some(Claim { tolerance: Some(tolerance), ..Claim::of(holds, WITHIN, found, wanted) })
    }

    /// By a METHOD of the suite, which leaves where they differ.
    fn equal_arrays(&mut self, differ: &str, values: &[&ast::Expr<'s>], span: Span) -> Option<Claim> {
        let owner = self.decl.slot_of_instance(self.signature.as_ref()?.state?)?;
        let method = self.decl.pous[owner].ast.routines.iter().find(|it| it.name.text == differ)?.name.text;
        let argument =
            |it: &&ast::Expr<'s>| ast::Argument { kind: ArgumentKind::Positional((*it).clone()), span: it.span };
        let differs = self.condition(&call(method, values.iter().map(argument).collect(), span))?;
        let at = self.at(span);
        let holds = Expr::apply(Op::Not, Type::BOOL, vec![differs], at);
        let mut kept = |name: &'static str, what| {
            let text = self.scope.get(name)?.place.clone();
            self.keep(what, Expr::load(text, at), span).map(|it| it.1)
        };
        let (expected, actual) = (kept("__expected", "expected")?, kept("__actual", "actual")?);
        Some(Claim::of(holds, "{}", actual, expected))
    }

    /// Keeps a value in a local, which goes to a new global where the assertion fails; the value, and that global's name.
    pub(super) fn note(&mut self, what: &str, mut value: Expr) -> (Expr, String) {
        self.save(what, &mut value);
        if !self.decl.log.options.tests {
            return (value, String::new());
        }
        let (name, place) = self.new_global(what, value.ty, value.at);
        self.compared.push((place, value.clone()));
        (value, name)
    }

    fn new_global(&mut self, what: &str, ty: Type, at: staunch_ir::Location) -> (String, Place) {
        let globals = self.decl.program.globals;
        let fields = &mut self.decl.program.structs[globals.index()].fields;
        let (id, name) = (FieldId::next(fields.len()), format!("__{what}_{}", fields.len()));
        fields.push(Field {
            name: name.clone(),
            ty,
            initial: Const::Zero,
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: None,
            location: at,
            declared: None,
        });
        (name, Place::root(Root::Globals, Type::Struct(globals)).field(id, ty))
    }

    /// Notes an assertion that fails; the test continues.
    fn assert_in_suite(&mut self, claim: Claim, message: Option<&ast::Expr<'s>>, span: Span) -> Option<()> {
        self.assert_shared(claim, message, |this| this.condition(&call(FAILS, Vec::new(), span)), span)
    }

    /// Where an assertion fails and `is_kept` says so, keeps which it is and what it compared.
    pub(super) fn assert_shared(
        &mut self,
        claim: Claim,
        message: Option<&ast::Expr<'s>>,
        is_kept: impl FnOnce(&mut Self) -> Option<Expr>,
        span: Span,
    ) -> Option<()> {
        let compared = std::mem::take(&mut self.compared);
        let at = self.at(span);
        let Claim { holds, wants, actual, expected, tolerance, compares_texts } = claim;
        let is_run = self.decl.log.options.tests;
        let mut shown = None;
        let number = self.decl.tests.shared.len() + 1;
        let mut is_whole = Some(());
        let then = self.nested(|this| {
            let fails = is_kept(this);
            let kept = this.nested(|this| {
                if let Some(message) = message {
                    is_whole = this.keep_message(message).map(|it| shown = Some(it));
                }
                for (place, value) in compared {
                    this.assign(place, value, span);
                }
                if is_run {
                    let failed = this.broken(at);
                    let number = i32::try_from(number).unwrap_or(i32::MAX);
                    this.assign(failed, Expr::constant(Elementary::Dint, Value::I32(number), at), span);
                }
            });
            match fails {
                Some(condition) => {
                    this.push(StatementKind::If { condition, then: kept, otherwise: Vec::new() }, span);
                }
                None => is_whole = None,
            }
        });
        is_whole?;
        let condition = Expr::apply(Op::Not, Type::BOOL, vec![holds], at);
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        if is_run {
            let assertion = Assertion { span, wants, compares_texts, actual, expected, tolerance, message: shown };
            self.decl.tests.shared.push(assertion);
        }
        Some(())
    }

    /// The global that the text is assigned to, by its name.
    fn keep_message(&mut self, message: &ast::Expr<'s>) -> Option<String> {
        let text = self.operand(message, None)?;
        let text = self.materialise(text, None, message.span)?;
        if !self.decl.log.options.tests {
            return Some(String::new());
        }
        let (name, place) = self.new_global("message", text.ty, text.at);
        self.assign(place, text, message.span);
        Some(name)
    }

    /// The global that is the number of the assertion that failed.
    pub(super) fn broken(&mut self, at: staunch_ir::Location) -> Place {
        if let Some((_, place)) = &self.decl.tests.broken {
            return place.clone();
        }
        let made = self.new_global("broken", Type::Elementary(Elementary::Dint), at);
        self.decl.tests.broken = Some(made.clone());
        made.1
    }
}

/// `THIS^`, `SUPER^`, and the library's namespace.
fn is_own(base: &ast::Expr<'_>) -> bool {
    let is_library = matches!(&base.kind, Ast::Name(name) if name.text.eq_ignore_ascii_case(LIBRARY));
    let is_this = matches!(&base.bare().kind, Ast::Deref(inner) if is_this(inner)) || is_this(base);
    is_library || is_this || is_super(base)
}

fn call<'s>(name: &'s str, arguments: Vec<ast::Argument<'s>>, span: Span) -> ast::Expr<'s> {
    let callee = ast::Expr { kind: Ast::Name(ast::Name { text: name, span }), span };
    ast::Expr { kind: Ast::Call(Box::new(callee), arguments), span }
}
