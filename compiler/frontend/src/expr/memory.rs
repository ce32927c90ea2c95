//! `MEMCPY`, `MEMMOVE`, `MEMSET` and `MEMCMP`, as TwinCAT has them. They are loops over bytes, so that each
//! byte is checked as an access through a reference is.

use super::checker::Checker;
use super::operand::Operand;
use crate::dialect::library;
use crate::names::Sense;
use crate::{Span, ast};
use ast::ExprKind as Ast;
use staunch_ir::{
    Block, Conversion, Elementary, Expr, For, Location, Op, Place, RefKind, Statement, StatementKind, Type, Value,
};

#[derive(Clone, Copy)]
enum Function {
    Copy,
    Fill,
    Compare,
}

const BYTE: Type = Type::Elementary(Elementary::Byte);
const LWORD: Type = Type::Elementary(Elementary::Lword);
const UDINT: Type = Type::Elementary(Elementary::Udint);

/// What MEMCMP gives where an address or the number of bytes is 0.
const BAD_PARAMETERS: i32 = 0xFF;

/// The function, and the names of its parameters.
fn function(name: &str) -> Option<(Function, [&'static str; 3])> {
    let functions = [
        ("MEMCPY", Function::Copy, ["destAddr", "srcAddr", "n"]),
        ("MEMMOVE", Function::Copy, ["destAddr", "srcAddr", "n"]),
        ("MEMSET", Function::Fill, ["destAddr", "fillByte", "n"]),
        ("MEMCMP", Function::Compare, ["pBuf1", "pBuf2", "n"]),
    ];
    functions.into_iter().find(|(it, ..)| it.eq_ignore_ascii_case(name)).map(|(_, function, names)| (function, names))
}

/// The arguments, each found once.
struct Arguments {
    first: Place,
    second: Second,
    /// A LINT.
    count: Expr,
    at: Location,
}

enum Second {
    Address(Place),
    Byte(Expr),
}

impl<'s> Checker<'_, 's> {
    /// A call of one of them; `None` where `callee` is something else.
    pub(crate) fn memory_function(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        let path = match &callee.kind {
            Ast::Name(name) => vec![*name],
            // `Tc2_System.MEMCPY`
            Ast::Member(owner, name) => match owner.kind {
                Ast::Name(owner)
                    if library::is_library(self.decl.dialect(span), owner.text)
                        && library::is_one_of(library::of_built_in(name.text), owner.text) =>
                {
                    vec![owner, *name]
                }
                _ => return None,
            },
            _ => return None,
        };
        let name = path.last()?;
        let (function, names) = function(name.text)?;
        if self.means_anything(&path, Sense::Callee) || self.signature.is_none() {
            return None;
        }
        let Some(given) = self.in_order(*name, names, arguments, span) else {
            self.check_arguments(arguments);
            return Some(None);
        };
        let made = self.memory_arguments(function, given, span);
        Some(made.map(|arguments| Operand::Typed(self.memory_loop(function, &arguments))))
    }

    /// Evaluates them from left to right.
    fn memory_arguments(&mut self, function: Function, given: [&ast::Expr<'s>; 3], span: Span) -> Option<Arguments> {
        let [first, second, count] = given;
        let first = self.byte_pointer(first);
        let second = match function {
            Function::Copy | Function::Compare => self.byte_pointer(second).map(Second::Address),
            Function::Fill => self.memory_number(second, Type::Elementary(Elementary::Usint), BYTE).map(Second::Byte),
        };
        let count = self.memory_number(count, UDINT, Type::LINT);
        Some(Arguments { first: first?, second: second?, count: count?, at: self.at(span) })
    }

    /// Any reference, as a pointer to bytes in a local.
    fn byte_pointer(&mut self, expr: &ast::Expr<'s>) -> Option<Place> {
        let ty = self.decl.reference_type(RefKind::PointerTo, BYTE);
        let operand = self.operand(expr, Some(ty))?;
        let value = match operand {
            Operand::Typed(value) if matches!(value.ty, Type::Reference(_)) => {
                if value.ty == ty {
                    value
                } else {
                    self.convert(Conversion::Same, ty, value)
                }
            }
            other => self.coerce(other, ty, expr.span)?,
        };
        let place = self.temporary("address", ty);
        self.assign(place.clone(), value, expr.span);
        Some(place)
    }

    /// A value of a parameter's type, as another of the same numbers; a constant, or a local.
    fn memory_number(&mut self, expr: &ast::Expr<'s>, ty: Type, wanted: Type) -> Option<Expr> {
        let value = self.value(expr, ty)?;
        let how = if wanted == BYTE { Conversion::Same } else { Conversion::Value };
        let value = self.convert(how, wanted, value);
        if value.as_const().is_some() {
            return Some(value);
        }
        let place = self.temporary("number", wanted);
        self.assign(place.clone(), value, expr.span);
        let at = self.at(expr.span);
        Some(Expr::load(place, at))
    }

    fn memory_loop(&mut self, function: Function, given: &Arguments) -> Expr {
        let at = given.at;
        let (ty, otherwise) = match function {
            Function::Copy | Function::Fill => (UDINT, Expr::constant(Elementary::Udint, Value::U32(0), at)),
            Function::Compare => (Type::DINT, Expr::constant(Elementary::Dint, Value::I32(BAD_PARAMETERS), at)),
        };
        let result = self.temporary("result", ty);
        let then = match (&given.second, function) {
            (Second::Byte(byte), _) => self.fill_memory(given, byte, &result),
            (Second::Address(second), Function::Compare) => self.compare_memory(given, second, &result),
            (Second::Address(second), Function::Copy | Function::Fill) => self.copy_memory(given, second, &result),
        };
        let otherwise = vec![Statement::assign(result.clone(), otherwise, at)];
        let condition = has_memory(given);
        self.block.push(Statement::new(StatementKind::If { condition, then, otherwise }, at));
        Expr::load(result, at)
    }

    /// From the far end where the target is above the source, so that they may overlap.
    fn copy_memory(&mut self, given: &Arguments, source: &Place, result: &Place) -> Block {
        let at = given.at;
        let by = self.temporary("step", Type::LINT);
        let before = operation(Op::Sub, Type::LINT, vec![given.count.clone(), lint(1, at)], at);
        let to_end = [&given.first, source].map(|it| moved(it, before.clone(), at));
        let mut downward = vec![Statement::assign(by.clone(), lint(-1, at), at)];
        downward.extend(to_end);
        let upward = vec![Statement::assign(by.clone(), lint(1, at), at)];
        let is_above = operation(Op::Gt, Type::BOOL, vec![address(&given.first, at), address(source, at)], at);
        let step = Expr::load(by, at);
        let body = vec![
            Statement::assign(byte(&given.first, at), Expr::load(byte(source, at), at), at),
            moved(&given.first, step.clone(), at),
            moved(source, step, at),
        ];
        vec![
            Statement::new(StatementKind::If { condition: is_above, then: downward, otherwise: upward }, at),
            self.each_byte(given, body),
            Statement::assign(result.clone(), counted(given), at),
        ]
    }

    fn fill_memory(&mut self, given: &Arguments, value: &Expr, result: &Place) -> Block {
        let at = given.at;
        let body =
            vec![Statement::assign(byte(&given.first, at), value.clone(), at), moved(&given.first, lint(1, at), at)];
        vec![self.each_byte(given, body), Statement::assign(result.clone(), counted(given), at)]
    }

    fn compare_memory(&mut self, given: &Arguments, second: &Place, result: &Place) -> Block {
        let at = given.at;
        let dint = |value| Expr::constant(Elementary::Dint, Value::I32(value), at);
        let set = |value| Statement::assign(result.clone(), dint(value), at);
        let [a, b] = [&given.first, second].map(|it| self.saved_byte(it, at));
        let bytes = || vec![Expr::load(a.0.clone(), at), Expr::load(b.0.clone(), at)];
        let found = |op, value| {
            let condition = operation(op, Type::BOOL, bytes(), at);
            let then = vec![set(value), Statement::new(StatementKind::Exit, at)];
            Statement::new(StatementKind::If { condition, then, otherwise: Vec::new() }, at)
        };
        let body = vec![
            a.1.clone(),
            b.1.clone(),
            found(Op::Lt, -1),
            found(Op::Gt, 1),
            moved(&given.first, lint(1, at), at),
            moved(second, lint(1, at), at),
        ];
        vec![set(0), self.each_byte(given, body)]
    }

    /// A local, and the statement that reads a byte to it.
    fn saved_byte(&mut self, pointer: &Place, at: Location) -> (Place, Statement) {
        let place = self.temporary("byte", BYTE);
        (place.clone(), Statement::assign(place, Expr::load(byte(pointer, at), at), at))
    }

    fn each_byte(&mut self, given: &Arguments, body: Block) -> Statement {
        let at = given.at;
        For::over(self.temporary("turn", Type::LINT), lint(1, at), given.count.clone(), body, at)
    }
}

/// Whether no address and not the number of bytes is 0.
fn has_memory(given: &Arguments) -> Expr {
    let at = given.at;
    let null = || Expr::constant(Elementary::Lword, Value::U64(0), at);
    let is_some = |it: &Expr| operation(Op::Ne, Type::BOOL, vec![bits(it, at), null()], at);
    let some = operation(Op::Ne, Type::BOOL, vec![given.count.clone(), lint(0, at)], at);
    let mut all = operation(Op::And, Type::BOOL, vec![is_some(&Expr::load(given.first.clone(), at)), some], at);
    if let Second::Address(second) = &given.second {
        all = operation(Op::And, Type::BOOL, vec![all, is_some(&Expr::load(second.clone(), at))], at);
    }
    all
}

fn operation(op: Op, ty: Type, operands: Vec<Expr>, at: Location) -> Expr {
    Expr::apply(op, ty, operands, at)
}

fn lint(value: i64, at: Location) -> Expr {
    Expr::constant(Elementary::Lint, Value::I64(value), at)
}

fn bits(reference: &Expr, at: Location) -> Expr {
    Expr::convert(Conversion::Same, LWORD, reference.clone(), at)
}

/// The lower half of a reference.
fn address(pointer: &Place, at: Location) -> Expr {
    let mask = Expr::constant(Elementary::Lword, Value::U64(0xFFFF_FFFF), at);
    operation(Op::And, LWORD, vec![bits(&Expr::load(pointer.clone(), at), at), mask], at)
}

/// `p^`
fn byte(pointer: &Place, at: Location) -> Place {
    pointer.clone().deref(BYTE, at)
}

/// `p := p + by;`
fn moved(pointer: &Place, by: Expr, at: Location) -> Statement {
    let from = bits(&Expr::load(pointer.clone(), at), at);
    let to = operation(Op::Advance, LWORD, vec![from, by], at);
    Statement::assign(pointer.clone(), Expr::convert(Conversion::Same, pointer.ty, to, at), at)
}

/// The number of bytes, as the result.
fn counted(given: &Arguments) -> Expr {
    match given.count.as_const().and_then(|it| staunch_ir::Repr::U32.integer(it.as_integer()?)) {
        Some(count) => Expr::constant(Elementary::Udint, count, given.at),
        None => Expr::convert(Conversion::Value, UDINT, given.count.clone(), given.at),
    }
}
