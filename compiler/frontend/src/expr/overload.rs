//! Overloads: the arguments of a call are bound to a signature's parameters, evaluated as they are
//! written, and brought to the one type that those have in common which share a generic one. So it is for the
//! standard's functions, where that type is called `T`, and for a user's, where it is called ANY_NUM.

use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::operand::Operand;
use super::operator::{beside, literal_types, mixed_signs};
use crate::diagnostic::Subject;
use crate::dialect::Dialect;
use crate::dialect::rules::{NarrowIntegers, Rules};
use crate::types::coercion::{Join, as_number, join, join_in};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::narrow::is_narrow;
use staunch_ir::{Block, Conversion, Elementary, Expr, Section, Type};
use staunch_runtime::{Class, Kind, Signature};
use std::borrow::Cow;

/// The operands of a call, in the order of its parameters, and their common type.
pub(crate) struct Resolved {
    /// What `T` is; BOOL where no parameter is `T`.
    pub ty: Type,
    /// What `T` counts as, where it is computed at more bits.
    pub own: Type,
    pub operands: Vec<Expr>,
}

/// What a parameter takes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Takes {
    Type(Type),
    /// What other parameters of the call have in common with it; the type that is expected of it.
    Common(Option<Type>),
    /// Any type of the class, whatever the others are.
    Class(Class),
    /// A character string of any length: a WSTRING, a STRING, or either.
    Text(Option<bool>),
}

impl Takes {
    pub(super) fn of(kind: Kind, common: Option<Type>, rules: &Rules) -> Self {
        match kind {
            Kind::T => Self::Common(common),
            Kind::Is(ty) => Self::Type(Type::Elementary(rules.own(ty))),
            Kind::Any(class) => Self::Class(class),
            Kind::String => Self::Text(Some(false)),
            Kind::Wstring => Self::Text(Some(true)),
            Kind::AnyString => Self::Text(None),
        }
    }
}

impl<'s> Checker<'_, 's> {
    /// What is given for a parameter, `parameter` in messages about the callee. What takes a type in common is
    /// brought to that when all operands are known.
    pub(crate) fn taken(
        &mut self,
        takes: Takes,
        value: &ast::Expr<'s>,
        parameter: &str,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        match takes {
            Takes::Common(expected) => self.operand(value, expected),
            Takes::Type(ty) => self.value(value, ty).map(Operand::Typed),
            Takes::Class(class) => self.of_class(class, value, parameter, name),
            Takes::Text(wide) => self.text(value, wide, name).map(Operand::Typed),
        }
    }

    /// Operands of `signature` for the arguments that were bound to its parameters.
    pub(crate) fn resolve(
        &mut self,
        signature: &Signature,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Resolved> {
        self.resolve_inputs(signature, values, expected, name, None)
    }

    /// As [`resolve`](Self::resolve), of a function whose first parameter chooses one of the others: what each of
    /// these does before its value is known is a list of its own, to run where it is chosen.
    pub(crate) fn resolve_choice(
        &mut self,
        signature: &Signature,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<(Resolved, Vec<Block>)> {
        let mut before = vec![Block::new(); values.len()];
        let resolved = self.resolve_inputs(signature, values, expected, name, Some(&mut before))?;
        Some((resolved, before))
    }

    fn resolve_inputs(
        &mut self,
        signature: &Signature,
        values: &[&ast::Expr<'s>],
        expected: Option<Type>,
        name: ast::Name<'s>,
        mut before: Option<&mut [Block]>,
    ) -> Option<Resolved> {
        let hint = expected
            .filter(|it| signature.result == Kind::T && self.admits_operand(signature.class, *it, name.span, name));
        let evaluate = |this: &mut Self, at: usize, side: Option<Type>| {
            let takes = Takes::of(kind(signature, at), hint.or(side), this.decl.dialect(name.span).rules());
            this.taken(takes, values[at], &parameter_name(signature, at), name)
        };
        let operands = match before.as_deref_mut() {
            None => self.as_written(values, evaluate)?,
            Some(before) => self.of_choice(before, evaluate)?,
        };
        self.of_one_kind(signature, &operands, values, name)?;
        let at_t = (0..values.len()).filter(|at| kind(signature, *at) == Kind::T);
        let at_t: Vec<_> = at_t.map(|at| (&operands[at], values[at].span)).collect();
        let own = match at_t.is_empty() {
            true => Type::BOOL,
            false => self.common_type(signature.class, &at_t, hint, name)?,
        };
        let ty = self.computed_type(signature.class, own, at_t.iter().map(|it| it.0), name.span);
        let cuts = self.cuts_counts(signature, name.span);
        let mut done = Vec::new();
        for (at, operand) in operands.into_iter().enumerate() {
            let kind = kind(signature, at);
            let operand = if cuts && kind != Kind::T { operand.cut() } else { operand };
            done.push(match (operand, kind) {
                (operand, Kind::T) => {
                    self.set_apart(before.as_deref_mut(), at, |this| this.at_type(operand, ty, values[at].span))?
                }
                (Operand::Typed(expr) | Operand::Promoted(expr, _), _) => expr,
                (Operand::Integer(_) | Operand::Real { .. }, _) => return None,
            });
        }
        Some(Resolved { ty, own, operands: done })
    }

    /// Whether a count or a position is an argument like another, which counts as stored: to CODESYS the functions on texts are a
    /// library's, and its shifts operators; MATIEC makes every function one of C. STruC++ takes it as it was computed.
    fn cuts_counts(&self, signature: &Signature, span: Span) -> bool {
        let rules = self.decl.dialect(span).rules();
        match rules.narrow_integers.choice {
            NarrowIntegers::At32Bits => takes_text(signature) && !rules.ranks_numbers(),
            NarrowIntegers::AsCPromotes => true,
            NarrowIntegers::AtTheirType | NarrowIntegers::MixedAsCPromotes => false,
        }
    }

    /// What chooses is evaluated before all inputs, wherever it is written: of these only the one that is chosen
    /// runs, so none is evaluated before another.
    fn of_choice(
        &mut self,
        before: &mut [Block],
        evaluate: impl Fn(&mut Self, usize, Option<Type>) -> Option<Operand>,
    ) -> Option<Vec<Operand>> {
        let mut operands: Vec<Option<Operand>> = Vec::new();
        for at in 0..before.len() {
            let side = operands.iter().flatten().next_back().and_then(|it| beside(it, None));
            operands.push(self.set_apart(Some(&mut *before), at, |this| evaluate(this, at, side)));
        }
        operands.into_iter().collect()
    }

    /// Runs `evaluate`; what it adds goes to the list of its input, if each has one. What chooses has none.
    fn set_apart<T>(
        &mut self,
        before: Option<&mut [Block]>,
        at: usize,
        evaluate: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        let Some(own) = before.and_then(|it| it.get_mut(at)).filter(|_| at > 0) else { return evaluate(self) };
        let mut value = None;
        own.extend(self.nested(|this| value = evaluate(this)));
        value
    }

    /// The argument expressions of a standard function, in the order of its parameters.
    pub(crate) fn arguments<'a>(
        &mut self,
        signature: &Signature,
        name: ast::Name<'s>,
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<Vec<&'a ast::Expr<'s>>> {
        let names = parameter_names(signature, arguments.len());
        let names: Vec<_> = names.iter().map(|it| &**it).collect();
        let parameters: Vec<_> = names.iter().map(|name| Parameter::of_library(name, Section::Input)).collect();
        let given = self.bind(name.text, &parameters, arguments, |argument| {
            Diagnostic::new(Code::E0301, argument.span, format!("`{}` has no parameter `{}`", name.text, argument.text))
                .label("unknown parameter")
                .help(format!("its parameters are {}", crate::diagnostic::wording::all_of(&names)))
        })?;
        let values: Vec<_> = given.iter().filter_map(value_of).collect();
        if values.len() < names.len() {
            let least = if signature.extensible { "at least " } else { "" };
            let wants = super::binding::plural(names.len());
            let message = format!("`{}` takes {least}{wants}, {} given", name.text, values.len());
            let error = Diagnostic::new(Code::E0302, span, message);
            self.report(error.label(format!("expected {}", names.join(", "))));
            return None;
        }
        Some(values)
    }

    /// Evaluates operands in the order in which they are written, whatever their parameters are: the
    /// first fault wins, and what is evaluated before a call keeps the value that it had then.
    /// `evaluate` gets the operand's position, and the type that the one before it asks for.
    pub(crate) fn as_written(
        &mut self,
        values: &[&ast::Expr<'s>],
        mut evaluate: impl FnMut(&mut Self, usize, Option<Type>) -> Option<Operand>,
    ) -> Option<Vec<Operand>> {
        let mut order: Vec<_> = (0..values.len()).collect();
        order.sort_by_key(|at| values[*at].span.start);
        let mut written: Vec<Operand> = Vec::new();
        let mut complete = true;
        for at in &order {
            let side = written.last().and_then(|it| beside(it, None));
            let mut done: Vec<_> = written.iter_mut().filter_map(Operand::typed_mut).collect();
            // All operands are checked before giving up, so that one run reports every mistake.
            let next = values[*at].span;
            let mark = self.block.len();
            let evaluated = self.after(&mut done, |this| {
                this.late_target_if(|it| it.is_before(next))?;
                evaluate(this, *at, side)
            });
            self.note_siblings(mark, evaluated.as_ref().and_then(Operand::typed));
            match evaluated {
                Some(operand) => written.push(operand),
                None => complete = false,
            }
        }
        let mut done: Vec<_> = written.iter_mut().filter_map(Operand::typed_mut).collect();
        self.after(&mut done, |this| this.late_target_if(|it| it.is_among(values)))?;
        if !complete {
            return None;
        }
        if !order.is_sorted() {
            self.fault_in_order(written.iter_mut().filter_map(Operand::typed_mut));
        }
        let mut placed: Vec<_> = order.into_iter().zip(written).collect();
        placed.sort_by_key(|it| it.0);
        Some(placed.into_iter().map(|it| it.1).collect())
    }

    /// Evaluates now what may fault, in this order: before a branch that uses one of the operands, or
    /// where an operation would take them in another order.
    pub(crate) fn fault_in_order<'e>(&mut self, operands: impl Iterator<Item = &'e mut Expr>) {
        for expr in operands {
            self.save_parts(expr, &Self::can_fault);
        }
    }

    /// An operand of a class by itself, at its own type.
    fn of_class(
        &mut self,
        class: Class,
        value: &ast::Expr<'s>,
        parameter: &str,
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        let operand = match self.operand(value, None)? {
            typed @ (Operand::Typed(_) | Operand::Promoted(..)) => typed,
            literal @ Operand::Real { .. } if class != Class::Int => {
                return self.coerce(literal, Type::LREAL, value.span).map(Operand::Typed);
            }
            literal => return self.coerce(literal, Type::LINT, value.span).map(Operand::Typed),
        };
        let ty = operand.computed_at()?;
        if self.admits(class, ty, value.span) {
            return Some(operand);
        }
        let found = self.type_name(ty);
        let message = format!("`{}` takes {} as {parameter}, but this is {found}", name.text, wanted(class));
        let mut error = Diagnostic::new(Code::E0201, value.span, message).label(format!("this is {found}"));
        if let Type::Elementary(it) = ty
            && class == Class::Int
            && (it.is_real() || it.is_bits())
        {
            error = error.help(format!("convert it with `{}_TO_{}(…)`", it.name(), integer_for(it).name()));
        }
        self.report(error);
        None
    }

    /// The type that operands have in common which are of one generic type, each with its place.
    pub(crate) fn common_type(
        &mut self,
        class: Class,
        operands: &[(&Operand, Span)],
        expected: Option<Type>,
        name: ast::Name<'s>,
    ) -> Option<Type> {
        let mut common: Option<Type> = None;
        for (operand, span) in operands.iter().copied() {
            let Some(own) = operand.ty() else { continue };
            if !self.admits_operand(class, own, span, name) && !self.becomes_real(class, own, span) {
                self.report_class(class, own, span, name);
                return None;
            }
            common = Some(match common.map(|so_far| (so_far, self.join_types(so_far, own, span))) {
                None => own,
                Some((_, Some(joined))) => joined,
                Some((so_far, None)) => {
                    self.report_apart(so_far, own, span, name);
                    return None;
                }
            });
        }
        let literals = || operands.iter().map(|it| it.0);
        let ty = match common {
            Some(ty) => widened_by_literals(
                self.beside_negatives(class, ty, literals(), expected, name.span),
                literals(),
                self.decl.dialect(name.span),
                join_in(self.decl.dialect(name.span)),
            ),
            None if class == Class::Real => expected.unwrap_or(Type::LREAL),
            None => literals_type(literals(), expected),
        };
        let ty = if class == Class::Real { real(ty, join_in(self.decl.dialect(name.span))) } else { ty };
        if !self.admits_operand(class, ty, name.span, name) {
            let span = operands.first().map_or(name.span, |it| it.1);
            self.report_class(class, ty, span, name);
            return None;
        }
        Some(ty)
    }

    /// A bit string with a number below 0 is a number, where a dialect mixes them and the place does not ask for bits.
    fn beside_negatives<'o>(
        &self,
        class: Class,
        ty: Type,
        mut operands: impl Iterator<Item = &'o Operand>,
        expected: Option<Type>,
        span: Span,
    ) -> Type {
        let Type::Elementary(it) = ty else { return ty };
        let is_below = |operand: &Operand| matches!(operand, Operand::Integer(value) if *value < 0);
        let mixes = class != Class::Bit && expected != Some(ty) && self.decl.dialect(span).mixes_bits_and_integers();
        if mixes && operands.any(is_below) { Type::Elementary(as_number(it)) } else { ty }
    }

    /// The type at which operands are computed that count as one of `own`. Bits are those of that type.
    fn computed_type<'o>(
        &self,
        class: Class,
        own: Type,
        operands: impl Iterator<Item = &'o Operand> + Clone,
        span: Span,
    ) -> Type {
        let Type::Elementary(it) = own else { return own };
        let is_promoted = operands.clone().any(|it| matches!(it, Operand::Promoted(..)));
        let keeps = is_promoted
            && (is_narrow(it) || it == Elementary::Real)
            && self.decl.dialect(span).rules().keeps_one_type();
        if class == Class::Bit || !(keeps || self.promotes_in_functions(it, span)) {
            return own;
        }
        // What is narrow has its value at a DINT, whatever its sign.
        let meet: Join =
            |a, b| Some(join(a, b).or_else(|| join(as_number(a), as_number(b))).unwrap_or(Elementary::Dint));
        let types = operands.clone().filter_map(|it| it.computed_at()?.elementary());
        let ty = types.reduce(|a, b| if a == b { a } else { meet(a, b).unwrap_or(a) }).unwrap_or(it);
        let ty = if it.is_integer() { as_number(ty) } else { ty };
        widened_by_literals(Type::Elementary(ty), operands, self.decl.dialect(span), meet)
    }

    /// The operand at the type that was found for all.
    pub(crate) fn at_type(&mut self, operand: Operand, ty: Type, span: Span) -> Option<Expr> {
        match operand {
            // The standard's functions of reals take integers too, a LINT as an LREAL.
            Operand::Typed(expr)
                if matches!((expr.ty, ty), (Type::Elementary(from), Type::Elementary(to))
                    if to.is_real() && as_number(from).is_integer()) =>
            {
                Some(self.convert(Conversion::Value, ty, expr))
            }
            // `MAX(a AND b, c)` of WORDs is one of `int`s in C++.
            operand if self.is_promoted_bits(&operand, ty, span) => self.side(operand, ty.elementary()?, span),
            operand => self.coerce(operand, ty, span),
        }
    }

    fn is_promoted_bits(&self, operand: &Operand, ty: Type, span: Span) -> bool {
        let is_bits = operand.ty().and_then(Type::elementary).is_some_and(|it| it.is_bits() && is_narrow(it));
        is_bits && ty == Type::Elementary(Elementary::Dint) && self.decl.dialect(span).rules().keeps_one_type()
    }

    /// Whether values of `ty` are of the class, also where a dialect mixes bit strings and integers.
    pub(crate) fn admits(&self, class: Class, ty: Type, span: Span) -> bool {
        let mixes = self.decl.dialect(span).mixes_bits_and_integers();
        match ty {
            Type::Elementary(it) | Type::Subrange(it, _) => {
                let as_bits = class == Class::Bit && it.is_integer();
                it.is(class) || mixes && (as_bits || as_number(it).is(class))
            }
            Type::String(_) => class.contains(Class::String),
            // It is a value of its base type where it is compared or chosen, and no number.
            Type::Enum(_) => class.contains(Class::Elementary),
            Type::Array(_) | Type::Struct(_) | Type::Block(_) | Type::Reference(_) => class == Class::Any,
        }
    }

    /// The same of an operand of a function: those of S7 that shift take integers, too.
    fn admits_operand(&self, class: Class, ty: Type, span: Span, function: ast::Name<'s>) -> bool {
        let is_integer = matches!(ty, Type::Elementary(it) | Type::Subrange(it, _) if it.is_integer());
        let shifts = ["SHL", "SHR"].iter().any(|it| it.eq_ignore_ascii_case(function.text));
        shifts && is_integer && self.decl.dialect(span).shifts_integers() || self.admits(class, ty, span)
    }

    fn becomes_real(&self, class: Class, ty: Type, span: Span) -> bool {
        class == Class::Real && self.admits(Class::Int, ty, span)
    }

    pub(crate) fn report_class(&mut self, class: Class, found: Type, span: Span, name: ast::Name<'s>) {
        let found = self.type_name(found);
        let message = format!("`{}` takes {}, but this is {found}", name.text, wanted(class));
        self.report(Diagnostic::new(Code::E0204, span, message).label(format!("this is {found}")));
    }

    fn report_apart(&mut self, a: Type, b: Type, span: Span, name: ast::Name<'s>) {
        let (first, second) = (self.type_name(a), self.type_name(b));
        let message = format!("`{}` does not take {first} and {second}", name.text);
        let error = Diagnostic::new(Code::E0204, name.span, message)
            .label("its arguments need one type")
            .other(span, format!("this is {second}"));
        self.report(match (a, b) {
            (Type::Elementary(a), Type::Elementary(b)) => error.about(Subject::Mismatch(a, b)),
            _ => error,
        });
    }

    fn join_types(&self, a: Type, b: Type, span: Span) -> Option<Type> {
        match (a, b) {
            (Type::Elementary(x), Type::Elementary(y)) => {
                let dialect = self.decl.dialect(span);
                let join = join_in(dialect);
                let mixes = dialect.mixes_bits_and_integers();
                let numbers = || join(as_number(x), as_number(y)).or_else(|| mixed_signs(x, y, mixes));
                let mixed = || mixes.then(numbers).flatten();
                join(x, y).or_else(mixed).map(Type::Elementary)
            }
            (Type::String(x), Type::String(y)) if x.wide == y.wide => Some(Type::String(x.max(y))),
            (Type::String(it), Type::Elementary(char)) | (Type::Elementary(char), Type::String(it))
                if char.is_char() && (char == Elementary::Wchar) == it.wide =>
            {
                Some(Type::String(it))
            }
            _ => (a == b).then_some(a),
        }
    }

    /// Strings of a call are STRINGs or WSTRINGs, all of them.
    fn of_one_kind(
        &mut self,
        signature: &Signature,
        operands: &[Operand],
        values: &[&ast::Expr<'s>],
        name: ast::Name<'s>,
    ) -> Option<()> {
        let strings = operands.iter().enumerate().filter(|(at, _)| kind(signature, *at) == Kind::AnyString);
        let mut strings = strings.filter_map(|(at, it)| Some((it.ty()?, values[at].span)));
        let Some((first, _)) = strings.next() else { return Some(()) };
        let wide = |ty: Type| ty.string_type().is_some_and(|it| it.wide);
        let Some((other, span)) = strings.find(|it| wide(it.0) != wide(first)) else { return Some(()) };
        self.report_apart(first, other, span, name);
        None
    }

    /// A character string, of a kind if one is asked for; a character is a string of one.
    pub(super) fn text(&mut self, value: &ast::Expr<'s>, wide: Option<bool>, name: ast::Name<'s>) -> Option<Expr> {
        let text = self.typed(value, None)?;
        let text = match text.ty {
            Type::Elementary(it) if it.is_char() => self.text_of(text, it == Elementary::Wchar, value.span, name)?,
            _ => text,
        };
        match (text.ty, wide) {
            (Type::String(it), Some(wide)) if it.wide != wide => {
                self.report_other_string(&text, it.of_kind(wide), value.span);
                return None;
            }
            (Type::String(_), _) => return Some(self.shallow(text)),
            _ => {}
        }
        let found = self.type_name(text.ty);
        let wanted = if wide == Some(true) { "WSTRING" } else { "STRING" };
        let message = format!("`{}` takes a {wanted}, but this is {found}", name.text);
        let error = Diagnostic::new(Code::E0201, value.span, message).label(format!("expected {wanted}"));
        self.report(match (text.ty, self.short_text(value.span)) {
            (Type::Elementary(it), Some(text)) => {
                let meant = format!("{}_TO_{wanted}({text})", it.name());
                error.help(format!("write `{meant}`")).fix(value.span, meant)
            }
            _ => error,
        });
        None
    }
}

fn takes_text(signature: &Signature) -> bool {
    signature.parameters.iter().any(|it| matches!(it.kind, Kind::String | Kind::Wstring | Kind::AnyString))
}

/// What the parameter at a position takes; those past the last are as the last.
pub(super) fn kind(signature: &Signature, at: usize) -> Kind {
    let last = signature.parameters.len() - 1;
    signature.parameters[at.min(last)].kind
}

/// The names of the parameters for so many arguments: IN1, IN2, … continue as long as arguments do.
pub(super) fn parameter_names(signature: &Signature, arguments: usize) -> Vec<Cow<'static, str>> {
    let own = signature.parameters.len();
    let count = if signature.extensible { arguments.max(own) } else { own };
    (0..count).map(|at| parameter_name(signature, at)).collect()
}

pub(super) fn parameter_name(signature: &Signature, at: usize) -> Cow<'static, str> {
    let Some(extra) = at.checked_sub(signature.parameters.len()) else {
        return Cow::Borrowed(signature.parameters[at].name);
    };
    let last = signature.parameters.last().map_or("", |it| it.name);
    let stem = last.trim_end_matches(|it: char| it.is_ascii_digit());
    let number: usize = last[stem.len()..].parse().unwrap_or(0);
    Cow::Owned(format!("{stem}{}", number + 1 + extra))
}

/// A class in the words of a message.
fn wanted(class: Class) -> &'static str {
    match class {
        Class::Any => "a value",
        Class::Elementary => "a value of an elementary type",
        Class::Magnitude => "a number or a TIME",
        Class::Num => "a number",
        Class::Real => "a REAL or LREAL",
        Class::Int => "an integer",
        Class::Unsigned => "an unsigned integer",
        Class::Signed => "a signed integer",
        Class::Duration => "a TIME",
        Class::Date => "a date or a time of day",
        Class::Bit => "a BOOL or a bit string",
        Class::Chars => "a character or a string",
        Class::Char => "a CHAR or WCHAR",
        Class::String => "a STRING or WSTRING",
    }
}

/// The integer type that a value is converted to, in a message.
fn integer_for(ty: Elementary) -> Elementary {
    match as_number(ty) {
        Elementary::Real => Elementary::Dint,
        Elementary::Lreal => Elementary::Lint,
        Elementary::Bool => Elementary::Int,
        number => number,
    }
}

/// The type at which a function of reals takes a number.
fn real(ty: Type, join: Join) -> Type {
    match ty {
        Type::Elementary(it) if as_number(it).is_integer() => {
            Type::Elementary(join(as_number(it), Elementary::Real).unwrap_or(Elementary::Lreal))
        }
        other => other,
    }
}

fn widened_by_literals<'o>(
    ty: Type,
    operands: impl Iterator<Item = &'o Operand>,
    dialect: Dialect,
    join: Join,
) -> Type {
    let Type::Elementary(mut ty) = ty else { return ty };
    for operand in operands {
        let real = matches!(operand, Operand::Real { .. });
        if real && ty.is_integer() {
            ty = join(ty, Elementary::Real).unwrap_or(Elementary::Lreal);
        }
        if let Operand::Integer(value) = operand
            && ty.is_integer()
            && ty.repr().integer(*value).is_none()
        {
            let own = literal_types(*value, ty, dialect).into_iter().find(|it| it.repr().integer(*value).is_some());
            ty = own.and_then(|own| join(ty, own)).unwrap_or(ty);
        }
    }
    Type::Elementary(ty)
}

fn literals_type<'o>(operands: impl Iterator<Item = &'o Operand> + Clone, expected: Option<Type>) -> Type {
    let real = operands.clone().any(|it| matches!(it, Operand::Real { .. }));
    match expected {
        Some(ty @ Type::Elementary(it)) if it.is_real() || (!real && it.repr().is_integer() && it.is_integral()) => ty,
        _ if real => Type::LREAL,
        _ => {
            let fits = |ty: &Elementary| {
                operands.clone().all(|it| matches!(it, Operand::Integer(value) if ty.repr().integer(*value).is_some()))
            };
            let ty = [Elementary::Int, Elementary::Dint, Elementary::Lint].into_iter().find(fits);
            Type::Elementary(ty.unwrap_or(Elementary::Ulint))
        }
    }
}

fn value_of<'a, 's>(given: &Given<'a, 's>) -> Option<&'a ast::Expr<'s>> {
    match given {
        Given::Value(expr) => Some(expr),
        Given::Nothing | Given::Output { .. } => None,
    }
}
